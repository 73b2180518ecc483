//! Reconstruction kernels: what a sample contributes to the pixels around it.

mod functions;
mod table;
mod transfer;

use functions::{
    Bicubic, BlackmanSinc, Box, Gaussian, Lanczos2, Lanczos3, Lanczos4, Mitchell, Tent,
};
pub use table::KernelTable;
pub use transfer::KernelTransfer;

/// A separable reconstruction kernel r(x)·r(y), with x and y in pixels.
///
/// `x` is a pixel's centre minus a sample's place. The support is half-open, (−radius, radius], so
/// that a box has exactly one pixel for every sample.
pub trait Kernel: Send + Sync {
    /// The name on the command line.
    fn name(&self) -> &'static str;

    /// Half the width of the support in pixels: a multiple of ½, at most [`MAX_RADIUS`].
    ///
    /// Within the support, r may bend or jump only at whole distances from ±radius: the tables
    /// rely on smooth pieces in between.
    fn radius(&self) -> f64;

    /// r(x) = r(−x), save at jumps; 0 outside the support.
    fn value(&self, x: f64) -> f64;

    /// ∫ r(x) dx over the support, exact to rounding: what plain convolution divides by, squared.
    fn integral(&self) -> f64;
}

/// The largest radius of a kernel, in pixels.
pub const MAX_RADIUS: f64 = 8.0;

/// All kernels, in the order in which they are listed.
///
/// Their stated errors ([`grid_error`](crate::grid_error), normalised by density): by how much waves up
/// to so many cycles per pixel along each axis, sampled on a square grid of so many samples per pixel,
/// may differ after reconstruction, as a part of the sum of their amplitudes.
///
/// | kernel | radius | ∫r | to 0.1, from 1 | to ¼, from 1 | to ¼, from 4 | to ½, from 4 |
/// |---|---|---|---|---|---|---|
/// | `box` | 0.5 | 1.000000 | 0.6180 | 1.4142 | 0.7221 | 1.1180 |
/// | `tent` | 1 | 1.000000 | 0.0955 | 0.5000 | 0.3781 | 0.8750 |
/// | `gaussian` | 2 | 1.253235 | 0.1079 | 0.5353 | 0.4603 | 0.9152 |
/// | `mitchell` | 2 | 1.000000 | 0.0469 | 0.3515 | 0.2890 | 0.8570 |
/// | `bicubic` | 2 | 1.000000 | 0.0089 | 0.2187 | 0.1231 | 0.7637 |
/// | `lanczos2` | 2 | 1.009790 | 0.0271 | 0.2187 | 0.1162 | 0.7547 |
/// | `lanczos3` | 3 | 0.997055 | 0.0125 | 0.0540 | 0.0280 | 0.7486 |
/// | `lanczos4` | 4 | 1.001256 | 0.0070 | 0.0195 | 0.0103 | 0.7506 |
/// | `sinc` | 8 | 1.000065 | 0.0005 | 0.0007 | 0.0004 | 0.7500 |
pub const KERNELS: &[&dyn Kernel] =
    &[&Box, &Tent, &Gaussian, &Mitchell, &Bicubic, &Lanczos2, &Lanczos3, &Lanczos4, &BlackmanSinc];

/// The kernel of this name.
pub fn kernel(name: &str) -> Option<&'static dyn Kernel> {
    KERNELS.iter().copied().find(|kernel| kernel.name() == name)
}

/// # Panics
/// If the kernel breaks what its trait demands: a radius that is not a multiple of ½ in (0, 8], an
/// integral that is not positive, or (at 16 places a pixel) values that differ from those on the other
/// side.
pub(crate) fn assert_contract(kernel: &dyn Kernel) {
    let (name, radius, integral) = (kernel.name(), kernel.radius(), kernel.integral());
    assert!(
        radius > 0.0 && (2.0 * radius).fract() == 0.0 && radius <= MAX_RADIUS,
        "a kernel's radius is a multiple of ½ up to {MAX_RADIUS}, not {radius}"
    );
    assert!(integral > 0.0 && integral.is_finite(), "{name}'s integral is {integral}");
    // Between sixteenths, so that no jump is met.
    for place in (0..(16.0 * radius) as u32).map(|i| (f64::from(i) + 0.5) / 16.0) {
        let (right, left) = (kernel.value(place), kernel.value(-place));
        let rounding = 1e-12 * (1.0 + right.abs());
        assert!(
            (right - left).abs() <= rounding,
            "{name} is not even: {left}, {right} at ±{place}"
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Radius, slope and integral.
    struct Strange(f64, f64, f64);

    impl Kernel for Strange {
        fn name(&self) -> &'static str {
            "strange"
        }
        fn radius(&self) -> f64 {
            self.0
        }
        fn value(&self, x: f64) -> f64 {
            1.0 + self.1 * x
        }
        fn integral(&self) -> f64 {
            self.2
        }
    }

    #[test]
    fn kernels_that_break_their_contract_are_refused() {
        let accepted = |radius, slope, integral| {
            let kernel = Strange(radius, slope, integral);
            let table = std::panic::catch_unwind(|| KernelTable::new(&kernel).taps()).is_ok();
            let transfer = std::panic::catch_unwind(|| KernelTransfer::new(&kernel, 1.0)).is_ok();
            assert_eq!(table, transfer);
            table
        };
        assert!(accepted(1.5, 0.0, 3.0) && accepted(8.0, 0.0, 16.0));
        for radius in [0.0, -1.0, 1.2, 8.5, f64::NAN, f64::INFINITY] {
            assert!(!accepted(radius, 0.0, 1.0), "radius {radius}");
        }
        for integral in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(!accepted(1.0, 0.0, integral), "integral {integral}");
        }
        for slope in [1e-3, f64::NAN] {
            assert!(!accepted(1.0, slope, 2.0), "slope {slope}");
        }
    }
}
