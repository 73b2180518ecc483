//! The kernels, one short impl each.

use std::f64::consts::PI;

use super::Kernel;

/// Si(kπ) = ∫₀^{kπ} sin(t)/t dt for k = 0 … 10, from the power series with 80 digits.
const SINE_INTEGRAL: [f64; 11] = [
    0.0,
    1.851_937_051_982_466_3,
    1.418_151_576_132_628_4,
    1.674_761_798_979_961_2,
    1.492_161_225_584_46,
    1.633_964_846_102_835_3,
    1.518_033_961_467_180_5,
    1.616_085_517_451_644,
    1.531_131_284_990_665_8,
    1.606_076_891_817_98,
    1.539_029_079_577_564_5,
];

/// sin(πx)/(πx).
fn sinc(x: f64) -> f64 {
    // Below this the series' second term, (πx)²/6, is less than half an ulp of 1.
    if x.abs() < 1e-9 { 1.0 } else { libm::sin(PI * x) / (PI * x) }
}

/// `inside` on the half-open support (−radius, radius], 0 elsewhere.
fn on_support(x: f64, radius: f64, inside: impl FnOnce() -> f64) -> f64 {
    if x > -radius && x <= radius { inside() } else { 0.0 }
}

/// 1 on (−½, ½]: the average over the pixel's square.
#[derive(Clone, Copy, Debug)]
pub(super) struct Box;

impl Kernel for Box {
    fn name(&self) -> &'static str {
        "box"
    }
    fn radius(&self) -> f64 {
        0.5
    }
    fn value(&self, x: f64) -> f64 {
        on_support(x, 0.5, || 1.0)
    }
    fn integral(&self) -> f64 {
        1.0
    }
}

/// 1 − |x| on [−1, 1]; as an interpolation, bilinear.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tent;

impl Kernel for Tent {
    fn name(&self) -> &'static str {
        "tent"
    }
    fn radius(&self) -> f64 {
        1.0
    }
    fn value(&self, x: f64) -> f64 {
        on_support(x, 1.0, || 1.0 - x.abs())
    }
    fn integral(&self) -> f64 {
        1.0
    }
}

/// exp(−x²/2σ²) with σ = ½ pixel, cut at 2 pixels, where it is e⁻⁸ = 3.4e-4.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gaussian;

impl Kernel for Gaussian {
    fn name(&self) -> &'static str {
        "gaussian"
    }
    fn radius(&self) -> f64 {
        2.0
    }
    fn value(&self, x: f64) -> f64 {
        on_support(x, 2.0, || libm::exp(-2.0 * x * x))
    }
    /// √(π/2)·erf(2√2).
    fn integral(&self) -> f64 {
        1.253_234_749_285_228_5
    }
}

/// The family of cubics of D. P. Mitchell and A. N. Netravali, *Reconstruction filters in computer
/// graphics*, SIGGRAPH 1988, eq. 8, on [−2, 2].
fn mitchell_netravali(x: f64, b: f64, c: f64) -> f64 {
    let x = x.abs();
    let sixfold = if x < 1.0 {
        ((12.0 - 9.0 * b - 6.0 * c) * x + (-18.0 + 12.0 * b + 6.0 * c)) * x * x + 6.0 - 2.0 * b
    } else {
        (((-b - 6.0 * c) * x + (6.0 * b + 30.0 * c)) * x + (-12.0 * b - 48.0 * c)) * x
            + 8.0 * b
            + 24.0 * c
    };
    sixfold / 6.0
}

/// The cubic of Mitchell and Netravali with B = C = ⅓ on [−2, 2].
#[derive(Clone, Copy, Debug)]
pub(super) struct Mitchell;

impl Kernel for Mitchell {
    fn name(&self) -> &'static str {
        "mitchell"
    }
    fn radius(&self) -> f64 {
        2.0
    }
    fn value(&self, x: f64) -> f64 {
        on_support(x, 2.0, || mitchell_netravali(x, 1.0 / 3.0, 1.0 / 3.0))
    }
    fn integral(&self) -> f64 {
        1.0
    }
}

/// The interpolating cubic (B = 0, C = ½; Keys's a = −½, Catmull–Rom) on [−2, 2]; as an
/// interpolation, bicubic.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bicubic;

impl Kernel for Bicubic {
    fn name(&self) -> &'static str {
        "bicubic"
    }
    fn radius(&self) -> f64 {
        2.0
    }
    fn value(&self, x: f64) -> f64 {
        on_support(x, 2.0, || mitchell_netravali(x, 0.0, 0.5))
    }
    fn integral(&self) -> f64 {
        1.0
    }
}

macro_rules! lanczos {
    ($($(#[$doc:meta])* $name:ident, $text:literal, $a:literal;)+) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub(super) struct $name;

        impl Kernel for $name {
            fn name(&self) -> &'static str {
                $text
            }
            fn radius(&self) -> f64 {
                f64::from($a)
            }
            fn value(&self, x: f64) -> f64 {
                let a = f64::from($a);
                on_support(x, a, || sinc(x) * sinc(x / a))
            }
            /// [(a + 1) Si((a + 1)π) − (a − 1) Si((a − 1)π)]/π: the product of the sines as a
            /// difference of cosines, integrated by parts; what stands at the ends cancels.
            fn integral(&self) -> f64 {
                let a = f64::from($a);
                ((a + 1.0) * SINE_INTEGRAL[$a + 1] - (a - 1.0) * SINE_INTEGRAL[$a - 1]) / PI
            }
        }
    )+};
}

lanczos! {
    /// sinc(x)·sinc(x/2) on [−2, 2]: the thesis's "Lanczos with a support of width 4".
    Lanczos2, "lanczos2", 2;
    /// sinc(x)·sinc(x/3) on [−3, 3].
    Lanczos3, "lanczos3", 3;
    /// sinc(x)·sinc(x/4) on [−4, 4].
    Lanczos4, "lanczos4", 4;
}

/// sinc(x) under a Blackman window of half-width 8: sinc(x)·(0.42 + 0.5 cos(πx/8) + 0.08 cos(πx/4)).
#[derive(Clone, Copy, Debug)]
pub(super) struct BlackmanSinc;

impl Kernel for BlackmanSinc {
    fn name(&self) -> &'static str {
        "sinc"
    }
    fn radius(&self) -> f64 {
        8.0
    }
    fn value(&self, x: f64) -> f64 {
        on_support(x, 8.0, || {
            let phase = PI * x / 8.0;
            sinc(x) * (0.42 + 0.5 * libm::cos(phase) + 0.08 * libm::cos(2.0 * phase))
        })
    }
    /// [0.84 Si(8π) + ½ (Si(9π) + Si(7π)) + 0.08 (Si(10π) + Si(6π))]/π, as
    /// sin(πx) cos(kπx/8) = ½ [sin((8 + k)πx/8) + sin((8 − k)πx/8)].
    fn integral(&self) -> f64 {
        let si = SINE_INTEGRAL;
        (0.84 * si[8] + 0.5 * (si[9] + si[7]) + 0.08 * (si[10] + si[6])) / PI
    }
}

#[cfg(test)]
mod tests {
    use crate::kernel::KERNELS;

    /// ∫ over [a, b] by Simpson's rule with `n` (even) intervals.
    fn simpson(f: impl Fn(f64) -> f64, a: f64, b: f64, n: u32) -> f64 {
        let h = (b - a) / f64::from(n);
        let inner: f64 =
            (1..n).map(|i| f(a + f64::from(i) * h) * if i % 2 == 1 { 4.0 } else { 2.0 }).sum();
        h / 3.0 * (f(a) + inner + f(b))
    }

    #[test]
    fn integrals_agree_with_quadrature() {
        for kernel in KERNELS {
            // Piece by piece between the places where kernels may bend; the open end of the
            // support is approached from inside.
            let r = kernel.radius();
            let inside = |x: f64| kernel.value(x.clamp(-r * (1.0 - 1e-15), r));
            let pieces = (2.0 * r) as u32;
            let sum: f64 = (0..pieces)
                .map(|i| simpson(inside, f64::from(i) - r, f64::from(i + 1) - r, 600))
                .sum();
            // Simpson: h⁴/180 times the fourth derivative, < 80 for all of these: 4e-12 a piece.
            let error = (sum - kernel.integral()).abs();
            assert!(error < 1e-11, "{}: {sum} against {}", kernel.name(), kernel.integral());
        }
    }

    #[test]
    fn kernels_end_at_their_radius_and_are_even() {
        for kernel in KERNELS {
            let r = kernel.radius();
            for x in [r * (1.0 + 1e-12), -r, r + 0.3, 100.0, f64::INFINITY, f64::NAN] {
                assert_eq!(kernel.value(x), 0.0, "{} at {x}", kernel.name());
                assert!(x == -r || kernel.value(-x) == 0.0, "{} at −{x}", kernel.name());
            }
            for i in 1..200 {
                let x = r * f64::from(i) / 200.0;
                assert_eq!(kernel.value(x), kernel.value(-x), "{} at {x}", kernel.name());
            }
            assert!(kernel.value(0.0) > 0.5 && r <= crate::kernel::MAX_RADIUS);
        }
    }

    #[test]
    fn interpolating_kernels_are_zero_at_other_pixels() {
        for name in ["tent", "bicubic", "lanczos2", "lanczos3", "lanczos4", "sinc"] {
            let kernel = crate::kernel::kernel(name).expect("a kernel");
            assert!((kernel.value(0.0) - 1.0).abs() < 1e-15, "{name}");
            for i in 1..8 {
                assert!(kernel.value(f64::from(i)).abs() < 1e-15, "{name} at {i}");
            }
        }
    }
}
