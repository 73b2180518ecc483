//! Sums of J₀ over a lattice of radii and frequencies, in about linear time.

use std::ops::Range;

use bn_fft::Complex;
use bn_fft::Planner;
use bn_fft::num_traits::Zero;

use super::chirp::{ChirpPlan, chirps};
use crate::j0_slice;

type C64 = Complex<f64>;

/// Hankel's expansion serves from here on.
const ASYMPTOTIC: f64 = 20.0;
/// Its terms: the first one left out is 110/20¹⁰ = 1.1e-11 of the envelope √(2/(20π)) = 0.18.
const TERMS: usize = 10;
/// Frequencies are taken in blocks, each so many times as far up as the one before.
const GROWTH: usize = 2;
/// The longest table of J₀ (32 MB). Lattices so fine that they would need more evaluate each value.
const LONGEST_TABLE: usize = 1 << 22;
/// Values of J₀ that are made and used together.
const CHUNK: usize = 256;

/// The sums Sⱼ = Σᵢ cᵢ J₀(2πα i j) for i < radii, j < frequencies: Hankel transforms between
/// uniform grids r = i·Δr and u = j·Δu with α = Δr Δu, planned once and applied often.
///
/// With cᵢ = 2π rᵢ Δr f(rᵢ) this is the trapezoid rule for a function that vanishes at its outer
/// end; which weights belong to an integral is the caller's affair. The absolute error is at most
/// 4e-12·Σ|cᵢ| however large i·j is.
///
/// Where x = 2πα i j ≥ 20, J₀ is the real part of Hankel's expansion (DLMF 10.17.5), each term of
/// which is a Fourier sum of cᵢ i^(−m−½): ten chirp transforms for each doubling of j. What is
/// below, of the order of (4/α)·log(frequencies) terms, is summed with J₀ from a table. For 3200
/// radii and 6400 frequencies, α = 1/40000, that takes a few milliseconds, against 60 and more for
/// evaluating every J₀. After Townsend, "A fast analysis-based discrete Hankel transform using
/// asymptotic expansions" (SIAM J. Numer. Anal. 53, 2015), with the lattice's own partition.
pub struct BesselSums {
    radii: usize,
    frequencies: usize,
    alpha: f64,
    /// J₀(2πα k); empty if it would be too long.
    table: Vec<f64>,
    /// The first block is summed directly.
    blocks: Vec<Block>,
}

/// The frequencies of one range, with what is needed for their sums over i ≥ `first_radius`.
struct Block {
    outputs: Range<usize>,
    first_radius: usize,
    chirp: Option<ChirpPlan>,
    /// [`expansion`] at the block's first radius and frequency.
    coefficients: [C64; TERMS],
}

/// What [`BesselSums::apply_into`] works in; made by [`BesselSums::scratch`].
#[derive(Clone, Debug)]
pub struct BesselSumsScratch {
    input: Vec<f64>,
    output_factor: Vec<f64>,
    sum: Vec<C64>,
    convolution: Vec<C64>,
    fft: Vec<C64>,
}

impl BesselSums {
    /// The plan for `radii` × `frequencies` and α = Δr·Δu.
    ///
    /// # Panics
    /// If a count is 0 or above 2²⁶, α is not a positive number, or the largest α i j exceeds 2⁵⁰.
    pub fn new(radii: usize, frequencies: usize, alpha: f64) -> Self {
        let counts = 1..=1 << 26;
        assert!(
            counts.contains(&radii) && counts.contains(&frequencies),
            "{radii} radii and {frequencies} frequencies: both must be in 1..=2^26"
        );
        let turns = alpha * radii as f64 * frequencies as f64;
        assert!(alpha > 0.0 && turns < f64::from(1 << 30) * f64::from(1 << 20), "α = {alpha}");
        // The least product i·j that the expansion serves.
        let product = (ASYMPTOTIC / (std::f64::consts::TAU * alpha)).ceil();
        let product = if product < 1e15 { product as usize } else { 1_000_000_000_000_000 };
        // Up to here every i·j is below GROWTH·product.
        let direct = (GROWTH * product / radii).clamp(1, frequencies);
        let needed = if direct < frequencies { radii.max(frequencies) } else { 0 };
        let (chirps, mut planner) = (chirps(alpha, needed), Planner::<f64>::new());
        let mut blocks = vec![Block {
            outputs: 0..direct,
            first_radius: radii,
            chirp: None,
            coefficients: [C64::zero(); TERMS],
        }];
        while let start = blocks[blocks.len() - 1].outputs.end
            && start < frequencies
        {
            let outputs = start..(GROWTH * start).min(frequencies);
            let first_radius = product.div_ceil(start);
            let chirp = (first_radius < radii).then(|| {
                let inputs = (first_radius, radii - first_radius);
                ChirpPlan::new(&chirps, inputs, (outputs.start, outputs.len()), &mut planner)
            });
            let x = std::f64::consts::TAU * alpha * first_radius as f64 * start as f64;
            let first_radius = first_radius.min(radii);
            blocks.push(Block { outputs, first_radius, chirp, coefficients: expansion(x) });
        }
        let longest = |b: &Block| (b.first_radius - 1) * (b.outputs.end - 1) + 1;
        let length = blocks.iter().map(longest).max().unwrap_or(0);
        let mut table = vec![0.0; if length <= LONGEST_TABLE { length } else { 0 }];
        for (first, values) in (0..length).step_by(CHUNK).zip(table.chunks_mut(CHUNK)) {
            bessel_multiples(std::f64::consts::TAU * alpha, first, values);
        }
        Self { radii, frequencies, alpha, table, blocks }
    }

    /// Number of radii: the length of the coefficients.
    pub fn radii(&self) -> usize {
        self.radii
    }

    /// Number of frequencies: the length of the result.
    pub fn frequencies(&self) -> usize {
        self.frequencies
    }

    /// What [`apply_into`](Self::apply_into) works in; every thread needs its own.
    pub fn scratch(&self) -> BesselSumsScratch {
        let chirps = || self.blocks.iter().filter_map(|block| block.chirp.as_ref());
        let longest = |of: fn(&ChirpPlan) -> usize| chirps().map(of).max().unwrap_or(0);
        let outputs = longest(|chirp| chirp.output_chirp().len());
        BesselSumsScratch {
            input: vec![0.0; self.radii],
            output_factor: vec![0.0; outputs],
            sum: vec![C64::zero(); outputs],
            convolution: vec![C64::zero(); longest(ChirpPlan::length)],
            fft: vec![C64::zero(); longest(ChirpPlan::scratch_length)],
        }
    }

    /// The sums for `coefficients` cᵢ into `sums`. Neither allocates nor starts a thread.
    ///
    /// # Panics
    /// If a length is not that of the plan, or the scratch is another plan's.
    pub fn apply_into(
        &self,
        coefficients: &[f64],
        sums: &mut [f64],
        scratch: &mut BesselSumsScratch,
    ) {
        assert_eq!(coefficients.len(), self.radii, "one coefficient for every radius");
        assert_eq!(sums.len(), self.frequencies, "one result for every frequency");
        for block in &self.blocks {
            let sums = &mut sums[block.outputs.clone()];
            for (j, sum) in block.outputs.clone().zip(&mut *sums) {
                *sum = self.near_sum(&coefficients[..block.first_radius], j);
            }
            block.add_far_sums(coefficients, sums, scratch);
        }
    }

    /// Σ cᵢ J₀(2πα i j), i from 0.
    fn near_sum(&self, coefficients: &[f64], j: usize) -> f64 {
        if j == 0 {
            return coefficients.iter().sum();
        }
        if !self.table.is_empty() {
            let bessel = self.table.iter().step_by(j);
            return bessel.zip(coefficients).map(|(bessel, c)| bessel * c).sum();
        }
        let step = std::f64::consts::TAU * self.alpha * j as f64;
        let mut bessel = [0.0; CHUNK];
        let mut sum = 0.0;
        for (first, c) in (0..).step_by(CHUNK).zip(coefficients.chunks(CHUNK)) {
            bessel_multiples(step, first, &mut bessel[..c.len()]);
            sum += bessel.iter().zip(c).map(|(bessel, c)| bessel * c).sum::<f64>();
        }
        sum
    }
}

/// J₀(k·step) for k from `first` on.
fn bessel_multiples(step: f64, first: usize, values: &mut [f64]) {
    let mut x = [0.0; CHUNK];
    for (k, x) in (first..).zip(&mut x) {
        *x = step * k as f64;
    }
    j0_slice(&x[..values.len()], values);
}

/// Hankel's expansion √(2/πx) e^{−iπ/4} Σ cₘ/xᵐ, cₘ = (−i)ᵐ 1²·3²…(2m − 1)²/(m! 8ᵐ), without e^{ix}.
fn expansion(x: f64) -> [C64; TERMS] {
    let envelope = (std::f64::consts::FRAC_2_PI / x).sqrt();
    let mut term = C64::from_polar(envelope, -std::f64::consts::FRAC_PI_4);
    std::array::from_fn(|m| {
        let this = term;
        let odd = (2 * m + 1) as f64;
        term *= C64::new(0.0, -odd * odd / (8.0 * (m + 1) as f64 * x));
        this
    })
}

impl Block {
    /// Adds the sums over i ≥ `first_radius`.
    fn add_far_sums(&self, c: &[f64], sums: &mut [f64], scratch: &mut BesselSumsScratch) {
        let Some(chirp) = &self.chirp else { return };
        let first = self.first_radius as f64;
        // Term m has (first·start/(i j))^(m + ½), a factor of the input times one of the output.
        let input = &mut scratch.input[..c.len() - self.first_radius];
        for ((i, input), c) in (self.first_radius..).zip(&mut *input).zip(&c[self.first_radius..]) {
            *input = c * (first / i as f64).sqrt();
        }
        let start = self.outputs.start as f64;
        let factor = &mut scratch.output_factor[..sums.len()];
        for (j, factor) in self.outputs.clone().zip(&mut *factor) {
            *factor = (start / j as f64).sqrt();
        }
        let total = &mut scratch.sum[..sums.len()];
        total.fill(C64::zero());
        let buffer = &mut scratch.convolution[..chirp.length()];
        for coefficient in &self.coefficients {
            let fourier = chirp.convolve(input, buffer, &mut scratch.fft);
            for ((total, fourier), factor) in total.iter_mut().zip(fourier).zip(&*factor) {
                *total += coefficient * fourier * factor;
            }
            for (i, input) in (self.first_radius..).zip(&mut *input) {
                *input *= first / i as f64;
            }
            for (j, factor) in self.outputs.clone().zip(&mut *factor) {
                *factor *= start / j as f64;
            }
        }
        for ((sum, total), chirp) in sums.iter_mut().zip(total).zip(chirp.output_chirp()) {
            *sum += (*total * chirp).re;
        }
    }
}
