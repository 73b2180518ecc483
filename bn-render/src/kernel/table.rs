//! Kernels as piecewise polynomials: all weights of a sample from one table row.

#![expect(clippy::inline_always, reason = "must be compiled anew under the features of the caller")]

use super::{Kernel, assert_contract};
use crate::simd::ROUND;

/// Pieces that the unit interval of sample places is cut into.
const PIECES: usize = 32;
/// Coefficients of each piece's polynomial: degree 5.
const TERMS: usize = 6;

/// A kernel tabulated for rendering: for a sample at a place t ∈ [0, 1) between two pixel
/// centres (or pixel edges, for odd numbers of taps), the weights of all pixels along an axis.
///
/// Each weight is a polynomial of degree 5 on each of 32 pieces of [0, 1), interpolating the
/// kernel at Chebyshev nodes. Weights differ from [`Kernel::value`] by at most
/// [`KernelTable::ERROR`]; box, tent and cubics are exact to rounding. The table takes 1.5 KB for
/// each tap and is made in some 10 µs.
#[derive(Clone, Debug)]
pub struct KernelTable {
    name: &'static str,
    radius: f64,
    integral: f64,
    taps: usize,
    lanes: usize,
    coefficients: Vec<f64>,
}

impl KernelTable {
    /// The largest difference between a tabulated weight and the kernel.
    pub const ERROR: f64 = 2e-12;

    /// The table of `kernel`.
    ///
    /// # Panics
    /// If the kernel breaks its contract: a radius that is not a multiple of ½ in (0, 8], an integral
    /// that is not positive, or values that are not even.
    pub fn new(kernel: &dyn Kernel) -> Self {
        assert_contract(kernel);
        let radius = kernel.radius();
        let taps = (2.0 * radius) as usize;
        let lanes = [1, 2, 4, 6, 8, 12, 16].into_iter().find(|&l| l >= taps).unwrap_or(taps);
        let mut coefficients = vec![0.0; PIECES * TERMS * lanes];
        for (piece, block) in coefficients.chunks_exact_mut(TERMS * lanes).enumerate() {
            for tap in 0..taps {
                // The pixel's centre lies (tap + 1 − radius) − t from the sample.
                let start = (tap + 1) as f64 - radius;
                let weight = |s: f64| kernel.value(start - (piece as f64 + s) / PIECES as f64);
                for (term, c) in interpolating_polynomial(weight).into_iter().enumerate() {
                    block[term * lanes + tap] = c;
                }
            }
        }
        let (name, integral) = (kernel.name(), kernel.integral());
        Self { name, radius, integral, taps, lanes, coefficients }
    }

    /// The kernel's name.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// The kernel's radius in pixels.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// ∫ r of the kernel.
    pub fn integral(&self) -> f64 {
        self.integral
    }

    /// Number of pixels along an axis that a sample reaches, twice the radius.
    pub fn taps(&self) -> usize {
        self.taps
    }

    /// Taps rounded up to a number the inner loops are built for; the weights beyond are 0.
    pub(crate) fn lanes(&self) -> usize {
        self.lanes
    }

    /// Where the cells of samples that reach the same pixels begin, modulo 1: a sample at u
    /// belongs to cell ⌊u − phase⌋. ½ between pixel centres for even taps, else 0.
    pub(crate) fn phase(&self) -> f64 {
        if self.taps.is_multiple_of(2) { 0.5 } else { 0.0 }
    }

    /// The first pixel that the samples of cell 0 reach; not above 0.
    pub(crate) fn first_tap(&self) -> i64 {
        // The first pixel is ⌊u − ½ − radius⌋ + 1 and u = phase + t.
        (self.phase() - 0.5 - self.radius) as i64 + 1
    }

    /// The weights of all lanes for a sample at place `t` ∈ [0, 1) of its cell.
    #[inline(always)]
    pub(crate) fn weights<const M: usize>(&self, t: f64) -> [f64; M] {
        // The nearest integer to scaled − ½ is the piece; at a border between two either will do.
        // Its bits stand at the end of the rounded sum: no conversion, which would have to check.
        let scaled = t * PIECES as f64;
        let rounded = (scaled - 0.5) + ROUND;
        let piece = ((rounded.to_bits() & 0xffff) as usize).min(PIECES - 1);
        let s = scaled - (rounded - ROUND);
        let block = &self.coefficients[piece * TERMS * M..][..TERMS * M];
        let mut w: [f64; M] = std::array::from_fn(|k| block[(TERMS - 1) * M + k]);
        for term in (0..TERMS - 1).rev() {
            let row = &block[term * M..][..M];
            for k in 0..M {
                w[k] = w[k] * s + row[k];
            }
        }
        w
    }

    /// The weights along one axis of the pixels that a sample at `u` reaches, and the first of
    /// these pixels: what the renderer's inner loops compute, for checks and small tasks.
    pub fn weights_at(&self, u: f64) -> (i64, Vec<f64>) {
        let shifted = u - self.phase();
        let cell = shifted.floor();
        let t = shifted - cell;
        let mut weights = match self.lanes {
            1 => self.weights::<1>(t).to_vec(),
            2 => self.weights::<2>(t).to_vec(),
            4 => self.weights::<4>(t).to_vec(),
            6 => self.weights::<6>(t).to_vec(),
            8 => self.weights::<8>(t).to_vec(),
            12 => self.weights::<12>(t).to_vec(),
            _ => self.weights::<16>(t).to_vec(),
        };
        weights.truncate(self.taps);
        (cell as i64 + self.first_tap(), weights)
    }
}

/// The monomial coefficients of the polynomial that equals `f` at the six Chebyshev nodes of
/// [0, 1]: Newton's divided differences, multiplied out.
fn interpolating_polynomial(f: impl Fn(f64) -> f64) -> [f64; TERMS] {
    let node = |i: usize| {
        let angle = std::f64::consts::PI * (2 * i + 1) as f64 / (2 * TERMS) as f64;
        0.5 - 0.5 * libm::cos(angle)
    };
    let nodes: [f64; TERMS] = std::array::from_fn(node);
    let mut newton: [f64; TERMS] = std::array::from_fn(|i| f(nodes[i]));
    for order in 1..TERMS {
        for i in (order..TERMS).rev() {
            newton[i] = (newton[i] - newton[i - 1]) / (nodes[i] - nodes[i - order]);
        }
    }
    let mut p = [0.0; TERMS];
    for i in (0..TERMS).rev() {
        // p ← p·(s − nodes[i]) + newton[i]
        for k in (1..TERMS).rev() {
            p[k] = p[k - 1] - nodes[i] * p[k];
        }
        p[0] = newton[i] - nodes[i] * p[0];
    }
    p
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::KERNELS;

    #[test]
    fn tables_agree_with_their_kernels() {
        for kernel in KERNELS {
            let table = KernelTable::new(*kernel);
            let mut worst = 0.0_f64;
            for i in 0..20_011 {
                let u = 3.0 + f64::from(i) / 20_011.0 * 2.0;
                let (first, weights) = table.weights_at(u);
                assert_eq!(weights.len(), table.taps());
                for (k, w) in weights.iter().enumerate() {
                    let d = (first + k as i64) as f64 + 0.5 - u;
                    worst = worst.max((w - kernel.value(d)).abs());
                }
                // Nothing within the support is missed on either side.
                let beyond = (first + weights.len() as i64) as f64 + 0.5 - u;
                assert!(kernel.value(beyond) == 0.0 && kernel.value(first as f64 - 0.5 - u) == 0.0);
            }
            let bound = match kernel.name() {
                "box" => 0.0,
                "tent" | "mitchell" | "bicubic" => 1e-14,
                _ => KernelTable::ERROR,
            };
            assert!(worst <= bound, "{}: {worst:e}", kernel.name());
        }
    }

    #[test]
    fn a_box_gives_each_sample_one_pixel() {
        let table = KernelTable::new(crate::kernel("box").expect("a kernel"));
        for (u, pixel) in [(0.0, 0), (0.999, 0), (1.0, 1), (-0.25, -1), (7.5, 7)] {
            assert_eq!(table.weights_at(u), (pixel, vec![1.0]), "at {u}");
        }
    }
}
