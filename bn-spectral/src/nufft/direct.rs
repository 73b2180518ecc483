//! The sums themselves: the fastest way for few points, and what the transforms are held against.
//!
//! Phasors e^(−2πi k x) for k = 0 … K come from two short tables, e^(−2πi·32a·x) and
//! e^(−2πi b x), one product each, with the phases reduced exactly: about 3ε each, whatever K.

use std::f64::consts::TAU;

use bn_core::DVec2;
use bn_fft::Complex;

use super::modes::{FullPlane, HalfPlane};
use super::simd::{Job, Simd, multiply_add};
use super::taps::Strengths;

/// The most points a block: their phasors should stay in the second-level cache.
pub(super) const BLOCK: usize = 128;
/// Frequencies ky a step of the inner loops.
const LANES: usize = 8;

/// The phasors of a block of points.
#[derive(Debug, Default)]
pub(super) struct Phasors {
    points: usize,
    max_frequency: usize,
    /// e^(−2πi kx x), kx = 0 … K, point by point.
    x: Vec<Complex<f64>>,
    /// Cosine and sine of −2π ky y for 8 frequencies ky ≥ 0, then the next point, then the next 8.
    y: Vec<[[f64; LANES]; 2]>,
}

impl Phasors {
    /// The phasors of `points` for frequencies up to `max_frequency`, into the old buffers.
    pub(super) fn prepare(&mut self, points: &[DVec2], max_frequency: usize) {
        let count = max_frequency + 1;
        let chunks = count.div_ceil(LANES);
        self.points = points.len();
        self.max_frequency = max_frequency;
        self.x.clear();
        self.y.clear();
        self.y.resize(chunks * points.len(), [[0.0; LANES]; 2]);
        for (j, p) in points.iter().enumerate() {
            self.x.extend(powers(p.x, count));
            for (k, phasor) in powers(p.y, count).enumerate() {
                let [cos, sin] = &mut self.y[k / LANES * points.len() + j];
                (cos[k % LANES], sin[k % LANES]) = (phasor.re, phasor.im);
            }
        }
    }

    /// e^(−2πi kx x) of point j, for kx of either sign.
    fn across(&self, j: usize, kx: i64) -> Complex<f64> {
        let phasor = self.x[j * (self.max_frequency + 1) + kx.unsigned_abs() as usize];
        if kx < 0 { phasor.conj() } else { phasor }
    }
}

/// e^(−2πi k x) for k = 0, 1, … (`count` of them).
fn powers(x: f64, count: usize) -> impl Iterator<Item = Complex<f64>> {
    const STEP: usize = 32;
    let fine: Vec<_> = (0..STEP.min(count)).map(|k| phasor(k as f64, x)).collect();
    let coarse: Vec<_> = (0..count.div_ceil(STEP)).map(|k| phasor((k * STEP) as f64, x)).collect();
    (0..count).map(move |k| coarse[k / STEP] * fine[k % STEP])
}

/// e^(−2πi k x), the phase reduced to half a turn before it is rounded.
fn phasor(k: f64, x: f64) -> Complex<f64> {
    let product = k * x;
    let residue = k.mul_add(x, -product);
    let turns = (product - product.round()) + residue;
    let (sin, cos) = libm::sincos(-TAU * turns);
    Complex::new(cos, sin)
}

/// Adds one column of type 1 sums: for ky = −K … K, Σⱼ aⱼ e^(−2πi ky yⱼ).
struct AddColumn<'a> {
    phasors: &'a Phasors,
    /// aⱼ: the strengths times e^(−2πi kx xⱼ).
    strengths: &'a [Complex<f64>],
    out: &'a mut [Complex<f64>],
}

impl Job for AddColumn<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let limit = self.phasors.max_frequency;
        for (chunk, points) in self.phasors.y.chunks_exact(self.phasors.points.max(1)).enumerate() {
            // Σ a cos, Σ a sin: together they give ky and −ky.
            let mut sums = [[0.0; LANES]; 4];
            for ([cos, sin], a) in points.iter().zip(self.strengths) {
                for l in 0..LANES {
                    sums[0][l] = multiply_add::<f64, FUSED>(a.re, cos[l], sums[0][l]);
                    sums[1][l] = multiply_add::<f64, FUSED>(a.im, cos[l], sums[1][l]);
                    sums[2][l] = multiply_add::<f64, FUSED>(a.re, sin[l], sums[2][l]);
                    sums[3][l] = multiply_add::<f64, FUSED>(a.im, sin[l], sums[3][l]);
                }
            }
            let first = chunk * LANES;
            for l in 0..LANES.min(limit + 1 - first) {
                let (even, odd) =
                    (Complex::new(sums[0][l], sums[1][l]), Complex::new(-sums[3][l], sums[2][l]));
                let ky = first + l;
                self.out[limit + ky] += even + odd;
                if ky > 0 {
                    self.out[limit - ky] += even - odd;
                }
            }
        }
    }
}

/// Type 2 sums along one column: for each point, Σ f(ky) e^(+2πi ky y) over ky.
struct SumColumn<'a> {
    phasors: &'a Phasors,
    modes: &'a [Complex<f64>],
    sums: &'a mut [Complex<f64>],
}

impl Job for SumColumn<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let limit = self.phasors.max_frequency;
        self.sums.fill(Complex::new(0.0, 0.0));
        for (chunk, points) in self.phasors.y.chunks_exact(self.phasors.points.max(1)).enumerate() {
            let first = chunk * LANES;
            let mut even = [Complex::new(0.0, 0.0); LANES];
            let mut odd = even;
            for l in 0..LANES.min(limit + 1 - first) {
                let ky = first + l;
                let (plus, minus) = (self.modes[limit + ky], self.modes[limit - ky]);
                (even[l], odd[l]) =
                    if ky == 0 { (plus, odd[l]) } else { (plus + minus, plus - minus) };
            }
            for ([cos, sin], sum) in points.iter().zip(self.sums.iter_mut()) {
                let (mut re, mut im) = ([0.0; LANES], [0.0; LANES]);
                for l in 0..LANES {
                    // even·cos − i odd·sin; the table's sine is that of the negative phase.
                    re[l] = multiply_add::<f64, FUSED>(odd[l].im, sin[l], even[l].re * cos[l]);
                    im[l] = multiply_add::<f64, FUSED>(-odd[l].re, sin[l], even[l].im * cos[l]);
                }
                *sum += Complex::new(re.iter().sum::<f64>(), im.iter().sum::<f64>());
            }
        }
    }
}

impl Phasors {
    /// Adds the modes (kx, −K … K) of the points with these strengths (from `offset` on) to `out`.
    pub(super) fn add_modes(
        &self,
        strengths: Strengths<'_>,
        offset: usize,
        kx: i64,
        simd: Simd,
        out: &mut [Complex<f64>],
    ) {
        let mut turned = [Complex::new(0.0, 0.0); BLOCK];
        for (j, a) in turned[..self.points].iter_mut().enumerate() {
            *a = strengths.get((offset + j) as u32) * self.across(j, kx);
        }
        simd.run(AddColumn { phasors: self, strengths: &turned[..self.points], out });
    }

    /// Adds what column kx adds to the sum at each point.
    pub(super) fn add_sums(
        &self,
        modes: &[Complex<f64>],
        kx: i64,
        simd: Simd,
        out: &mut [Complex<f64>],
    ) {
        let mut along = [Complex::new(0.0, 0.0); BLOCK];
        let along = &mut along[..self.points];
        simd.run(SumColumn { phasors: self, modes, sums: &mut *along });
        for ((j, out), sum) in out.iter_mut().enumerate().zip(along) {
            *out += *sum * self.across(j, kx).conj();
        }
    }

    /// The real sum at each point of Hermitian modes, of which `fill` writes column kx ≥ 0.
    pub(super) fn real_sums(
        &self,
        sums: &mut [f64],
        simd: Simd,
        mut fill: impl FnMut(usize, &mut [Complex<f64>]),
    ) {
        let mut modes = vec![Complex::new(0.0, 0.0); 2 * self.max_frequency + 1];
        let mut totals = [Complex::new(0.0, 0.0); BLOCK];
        for kx in 0..=self.max_frequency {
            fill(kx, &mut modes);
            if kx == 0 {
                // Both of each pair ±(0, ky) are there, one of each ±(kx, ky).
                for mode in &mut modes {
                    *mode *= 0.5;
                }
            }
            self.add_sums(&modes, kx as i64, simd, &mut totals[..self.points]);
        }
        for (sum, total) in sums.iter_mut().zip(totals) {
            *sum = 2.0 * total.re;
        }
    }
}

/// Σⱼ wⱼ exp(−2πi k·xⱼ) for all |kx|, |ky| ≤ K = `max_frequency`, summed term by term; wⱼ = 1
/// without `strengths`.
///
/// Relative l2 error below 1e-15·√n. Cost O(n·K²): 0.1 to 0.3 ns a term.
///
/// # Panics
/// If there are strengths, but not one a point.
pub fn direct_modes(
    points: &[DVec2],
    strengths: Option<&[f64]>,
    max_frequency: usize,
) -> HalfPlane<f64> {
    let mut modes = HalfPlane::zeros(max_frequency);
    let strengths = Strengths::real(strengths, points.len());
    each_block(points, max_frequency, |phasors, offset, simd| {
        for (kx, column) in modes.columns_mut().enumerate() {
            phasors.add_modes(strengths, offset, kx as i64, simd, column);
        }
    });
    modes
}

/// The same for complex strengths.
///
/// # Panics
/// If there is not one strength a point.
pub fn direct_complex_modes(
    points: &[DVec2],
    strengths: &[Complex<f64>],
    max_frequency: usize,
) -> FullPlane<f64> {
    let mut modes = FullPlane::zeros(max_frequency);
    let strengths = Strengths::complex(strengths, points.len());
    each_block(points, max_frequency, |phasors, offset, simd| {
        for (column, kx) in modes.columns_mut().zip(-(max_frequency as i64)..) {
            phasors.add_modes(strengths, offset, kx, simd, column);
        }
    });
    modes
}

/// Re Σₖ f(k) exp(+2πi k·xⱼ) over the whole plane, f(−k) = f(k)*, summed term by term.
pub fn direct_sums(points: &[DVec2], modes: &HalfPlane<f64>) -> Vec<f64> {
    let mut sums = vec![0.0; points.len()];
    each_block(points, modes.max_frequency(), |phasors, offset, simd| {
        let count = phasors.points;
        phasors.real_sums(&mut sums[offset..offset + count], simd, |kx, column| {
            column.copy_from_slice(modes.column(kx));
        });
    });
    sums
}

/// Σₖ f(k) exp(+2πi k·xⱼ) for complex modes, summed term by term.
pub fn direct_complex_sums(points: &[DVec2], modes: &FullPlane<f64>) -> Vec<Complex<f64>> {
    let mut sums = vec![Complex::new(0.0, 0.0); points.len()];
    each_block(points, modes.max_frequency(), |phasors, offset, simd| {
        for kx in -(modes.max_frequency() as i64)..=modes.max_frequency() as i64 {
            phasors.add_sums(
                modes.column(kx),
                kx,
                simd,
                &mut sums[offset..offset + phasors.points],
            );
        }
    });
    sums
}

fn each_block(points: &[DVec2], max_frequency: usize, mut task: impl FnMut(&Phasors, usize, Simd)) {
    let mut phasors = Phasors::default();
    for (block, points) in points.chunks(BLOCK).enumerate() {
        phasors.prepare(points, max_frequency);
        task(&phasors, block * BLOCK, Simd::detect());
    }
}
