//! The Kaiser–Bessel spreading kernel: its values, its Fourier transform and the error it makes.
//!
//! φ(t) = I₀(β√(1 − (2t/w)²)) / I₀(β) for |t| ≤ w/2 grid cells, else 0, with
//! β = π√(w²(1 − 1/2σ)² − 0.65) for upsampling σ: the shape of Beatty et al. (2005), its constant
//! refitted to the least root-mean-square error over the band. Its Fourier transform is
//! φ̂(ξ) = w·sinh(s)/(s·I₀(β)), s = √(β² − (πwξ)²), at ξ cycles a cell.

use std::f64::consts::PI;

/// The widest kernel, in grid cells.
pub(super) const MAX_WIDTH: usize = 16;

/// A Kaiser–Bessel function of a given width and shape.
#[derive(Clone, Copy, Debug)]
pub(super) struct KaiserBessel {
    pub(super) width: usize,
    beta: f64,
    /// 1/I₀(β)
    scale: f64,
}

impl KaiserBessel {
    /// The kernel of `width` cells for frequencies below 1/2σ cycles a cell.
    pub(super) fn new(width: usize, upsampling: f64) -> Self {
        let extent = width as f64 * (1.0 - 0.5 / upsampling);
        let beta = PI * (extent * extent - 0.65).sqrt();
        Self { width, beta, scale: 1.0 / bessel_i0(beta) }
    }

    /// φ(t), t in cells, |t| ≤ w/2.
    fn value(&self, t: f64) -> f64 {
        let u = 2.0 * t / self.width as f64;
        bessel_i0(self.beta * (1.0 - u * u).max(0.0).sqrt()) * self.scale
    }

    /// φ̂(ξ), ξ in cycles a cell.
    pub(super) fn transform(&self, xi: f64) -> f64 {
        let w = self.width as f64;
        let square = self.beta * self.beta - (PI * w * xi).powi(2);
        let s = square.abs().sqrt();
        let shape = if s < 1e-4 {
            1.0 + square / 6.0
        } else if square > 0.0 {
            libm::sinh(s) / s
        } else {
            libm::sin(s) / s
        };
        w * shape * self.scale
    }

    /// The kernel's effect on the error over the band |ξ| < 1/2σ.
    pub(super) fn errors(&self, upsampling: f64) -> KernelErrors {
        const NODES: usize = 32;
        const ALIASES: i32 = 6;
        let (mut alias, mut gain, mut energy) = (0.0, 0.0, 0.0);
        for node in 0..NODES {
            // Aliases grow steeply towards the band's end: nodes ξ ∝ 1 − u² crowd there.
            let u = (node as f64 + 0.5) / NODES as f64;
            let weight = 2.0 * u / NODES as f64;
            let xi = (1.0 - u * u) * 0.5 / upsampling;
            let own = self.transform(xi).powi(2);
            let folded: f64 = (1..=ALIASES)
                .map(|m| {
                    let m = f64::from(m);
                    self.transform(xi - m).powi(2) + self.transform(xi + m).powi(2)
                })
                .sum();
            alias += weight * folded / own;
            gain += weight / own;
            energy += weight * own;
        }
        // One of the two axes aliases at a time, to first order.
        KernelErrors { aliasing: (2.0 * alias).sqrt(), magnification: (gain * energy).sqrt() }
    }

    /// Polynomials of the w taps in z ∈ [−1, 1]: tap i is φ((z + 1)/2 + i − w/2), padded with
    /// zero taps to `taps`; highest power first, a row of `taps` numbers a power. Relative to
    /// the kernel's maximum, 1, they are within `error` and rounding.
    pub(super) fn polynomials(&self, taps: usize, error: f64) -> Vec<f64> {
        const NODES: usize = 24;
        let chebyshev: Vec<[f64; NODES]> = (0..self.width)
            .map(|tap| {
                chebyshev_coefficients(|z| {
                    self.value(0.5 * (z + 1.0) + tap as f64 - 0.5 * self.width as f64)
                })
            })
            .collect();
        let tail = |degree: usize| -> f64 {
            let beyond = |c: &[f64; NODES]| c[degree + 1..].iter().map(|x| x.abs()).sum::<f64>();
            chebyshev.iter().map(beyond).fold(0.0, f64::max)
        };
        let degree = (1..NODES - 1).find(|&d| tail(d) <= error).unwrap_or(NODES - 2);
        let mut rows = vec![0.0; (degree + 1) * taps];
        for (tap, coefficients) in chebyshev.iter().enumerate() {
            let powers = monomials(&coefficients[..=degree]);
            for (power, &c) in powers.iter().enumerate() {
                rows[(degree - power) * taps + tap] = c;
            }
        }
        rows
    }
}

/// What a kernel does to the relative l2 error.
#[derive(Clone, Copy, Debug)]
pub(super) struct KernelErrors {
    /// Root mean square over the modes of the aliased part, for random phases.
    pub(super) aliasing: f64,
    /// Factor from errors that are white along one axis of the grid to those of the modes: what
    /// the division by φ̂ makes of them. Rounding is white along both axes.
    pub(super) magnification: f64,
}

/// I₀(x) = Σ (x/2)²ᵐ/m!², all terms positive: relative error a few ε for the x ≤ 50 in use.
fn bessel_i0(x: f64) -> f64 {
    let quarter = 0.25 * x * x;
    let (mut term, mut sum) = (1.0, 1.0);
    for m in 1..200 {
        term *= quarter / f64::from(m * m);
        sum += term;
        if term < 1e-17 * sum {
            break;
        }
    }
    sum
}

/// Coefficients of the Chebyshev interpolant of `f` at N nodes of [−1, 1].
fn chebyshev_coefficients<const N: usize>(f: impl Fn(f64) -> f64) -> [f64; N] {
    let n = N as f64;
    let values: [f64; N] = std::array::from_fn(|j| f(libm::cos(PI * (j as f64 + 0.5) / n)));
    std::array::from_fn(|k| {
        let sum: f64 =
            (0..N).map(|j| values[j] * libm::cos(PI * k as f64 * (j as f64 + 0.5) / n)).sum();
        sum * if k == 0 { 1.0 } else { 2.0 } / n
    })
}

/// The power series of Σ cₖ Tₖ(z), lowest power first.
fn monomials(chebyshev: &[f64]) -> Vec<f64> {
    let n = chebyshev.len();
    let (mut previous, mut current) = (vec![0.0; n + 1], vec![0.0; n + 1]);
    let mut sum = vec![0.0; n];
    current[0] = 1.0;
    for (k, &c) in chebyshev.iter().enumerate() {
        for (s, &t) in sum.iter_mut().zip(&current) {
            *s += c * t;
        }
        // T₁ = z, then Tₖ₊₁ = 2z Tₖ − Tₖ₋₁.
        let double = if k == 0 { 1.0 } else { 2.0 };
        let mut next = vec![0.0; n + 1];
        for i in 0..n {
            next[i + 1] = double * current[i];
        }
        for (x, &p) in next.iter_mut().zip(&previous) {
            *x -= p;
        }
        previous = std::mem::replace(&mut current, next);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transform_is_the_integral_of_the_kernel() {
        for (width, sigma) in [(4, 2.0), (9, 1.25), (15, 1.1)] {
            let kernel = KaiserBessel::new(width, sigma);
            for xi in [0.0, 0.2, 0.45, 0.9] {
                // Trapezoid rule: the kernel jumps to 0 at its ends, the error is O(h²).
                let (n, w) = (40_000, width as f64);
                let h = w / f64::from(n);
                let f = |i: i32| {
                    let t = f64::from(i) * h - 0.5 * w;
                    kernel.value(t) * libm::cos(2.0 * PI * xi * t)
                };
                let sum: f64 = (1..n).map(f).sum::<f64>() + 0.5 * (f(0) + f(n));
                let want = kernel.transform(xi);
                assert!((sum * h - want).abs() < 1e-6, "w {width}, ξ {xi}: {} {want}", sum * h);
            }
        }
    }

    #[test]
    fn polynomials_meet_their_error() {
        for error in [1e-3, 1e-8, 1e-14] {
            let kernel = KaiserBessel::new(11, 1.5);
            let rows = kernel.polynomials(12, error);
            let mut worst: f64 = 0.0;
            for step in 0..=50 {
                let z = f64::from(step) / 25.0 - 1.0;
                for tap in 0..12 {
                    let got = rows.chunks(12).fold(0.0, |sum, row| sum * z + row[tap]);
                    let t = 0.5 * (z + 1.0) + tap as f64 - 5.5;
                    let want = if tap < 11 { kernel.value(t) } else { 0.0 };
                    worst = worst.max((got - want).abs());
                }
            }
            assert!(worst <= error + 4e-15, "{worst} for {error}");
        }
    }
}
