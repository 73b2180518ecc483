//! Choice of grid and kernel: the cheapest pair that meets the tolerance.

use super::kernel::{KaiserBessel, MAX_WIDTH};

/// Grid and kernel of a transform.
#[derive(Clone, Debug)]
pub(super) struct Design {
    /// Cells a side.
    pub(super) grid: usize,
    pub(super) kernel: KaiserBessel,
    /// Largest error of the polynomials for the kernel, relative to its maximum.
    pub(super) polynomial_error: f64,
    /// Kernel width rounded up to what the loops are compiled for.
    pub(super) taps: usize,
    /// Predicted relative l2 error.
    pub(super) error: f64,
    /// Estimated nanoseconds of an evaluation, without points and for each point.
    fixed_cost: f64,
    point_cost: f64,
}

impl Design {
    /// The number of points up to which direct sums are cheaper.
    pub(super) fn crossover(&self, max_frequency: usize) -> usize {
        let modes = ((max_frequency + 1) * (2 * max_frequency + 1)) as f64;
        let gain = modes * cost::DIRECT - self.point_cost;
        if gain <= 0.0 { usize::MAX } else { (self.fixed_cost / gain) as usize }
    }
}

/// Nanoseconds on a 2 GHz AVX2 core with FMA; only ratios matter.
mod cost {
    /// Per point: index, sort, cache misses.
    pub(super) const POINT: f64 = 25.0;
    /// Per tap of two rows of cells.
    pub(super) const CELL: f64 = 0.35;
    /// Per tap and degree of a kernel polynomial, both axes.
    pub(super) const POLYNOMIAL: f64 = 0.35;
    /// Per cell of moving and scaling it, besides the FFT.
    pub(super) const MOVE: f64 = 2.0;
    /// Per mode and point of a direct sum.
    pub(super) const DIRECT: f64 = 0.3;
}

/// The cheapest design for modes |k| ≤ `max_frequency` at relative l2 error `tolerance` with about
/// `points` points, in arithmetic of precision `epsilon`; the most accurate there is if none
/// reaches it.
pub(super) fn design(max_frequency: usize, tolerance: f64, points: usize, epsilon: f64) -> Design {
    let modes = 2 * max_frequency + 1;
    let least = (modes as f64 * 1.06).ceil().max(2.0 * MAX_WIDTH as f64) as usize;
    let most = (modes as f64 * 2.3).ceil().max(6.0 * MAX_WIDTH as f64) as usize;
    let mut best: Option<(f64, Design)> = None;
    let mut finest: Option<Design> = None;
    for grid in smooth_sizes(least, most) {
        let Some(candidate) = narrowest(grid, modes, tolerance, epsilon) else { continue };
        let cost = candidate.fixed_cost + points as f64 * candidate.point_cost;
        if candidate.error <= tolerance && best.as_ref().is_none_or(|(least, _)| cost < *least) {
            best = Some((cost, candidate.clone()));
        }
        if finest.as_ref().is_none_or(|f| candidate.error < f.error) {
            finest = Some(candidate);
        }
    }
    best.map(|(_, design)| design)
        .or(finest)
        .expect("the range of sizes always holds a smooth number")
}

/// The narrowest kernel on this grid that meets the tolerance, or the most accurate one.
fn narrowest(grid: usize, modes: usize, tolerance: f64, epsilon: f64) -> Option<Design> {
    let upsampling = grid as f64 / modes as f64;
    // The error of the best kernel of width w is close to exp(−πw√(1 − 1/σ)).
    let decay = std::f64::consts::PI * (1.0 - 1.0 / upsampling).max(1e-3).sqrt();
    let guess = (-tolerance.ln() / decay - 1.0).max(2.0) as usize;
    let mut best: Option<Design> = None;
    for width in guess.clamp(2, MAX_WIDTH)..=MAX_WIDTH.min(guess.max(2) + 4) {
        let kernel = KaiserBessel::new(width, upsampling);
        let errors = kernel.errors(upsampling);
        // Rounding measured at 1 to 3 ε; the polynomials get a tenth of the tolerance.
        let rounding = 3.0 * epsilon * errors.magnification.powi(2);
        let error = 1.4 * errors.aliasing.hypot(rounding).hypot(0.1 * tolerance);
        let better = best.as_ref().is_none_or(|b| error < b.error);
        if better {
            best = Some(Design {
                grid,
                kernel,
                polynomial_error: 0.1 * tolerance / errors.magnification,
                taps: width.next_multiple_of(4),
                error,
                fixed_cost: fft_cost(grid, modes, epsilon),
                point_cost: point_cost(width, tolerance),
            });
        }
        if error <= tolerance || !better {
            break;
        }
    }
    best
}

fn point_cost(width: usize, tolerance: f64) -> f64 {
    let taps = width.next_multiple_of(4) as f64;
    let rows = 0.5 * width as f64 + 1.0;
    let degree = width as f64 - 0.2 * tolerance.ln();
    cost::POINT + taps * (rows * cost::CELL + degree * cost::POLYNOMIAL)
}

/// Two passes of FFTs, half of the rows and the wanted columns, and the moves between them.
fn fft_cost(grid: usize, modes: usize, epsilon: f64) -> f64 {
    let cells = grid as f64 * (grid as f64 / 2.0 + modes as f64 / 2.0);
    let precision = if epsilon > 1e-10 { 0.5 } else { 1.0 };
    precision * cells * (cost::MOVE + fft_cost_per_cell(grid))
}

/// Nanoseconds per number of a complex FFT of this size: fitted to rustfft with AVX.
fn fft_cost_per_cell(mut size: usize) -> f64 {
    let mut cost = 2.3;
    for (prime, each) in PRIMES {
        while size.is_multiple_of(prime) {
            size /= prime;
            cost += each;
        }
    }
    cost
}

const PRIMES: [(usize, f64); 5] = [(2, 0.24), (3, 0.41), (5, 0.68), (7, 1.05), (11, 1.14)];

/// Multiples of 4 in the range without a prime factor above 11; the first one beyond if none is.
fn smooth_sizes(least: usize, most: usize) -> impl Iterator<Item = usize> {
    let smooth = |mut size: usize| {
        for (prime, _) in PRIMES {
            while size.is_multiple_of(prime) {
                size /= prime;
            }
        }
        size == 1
    };
    // At most a few dozen designs are looked at: the steps grow with the size.
    let ratio = 1.01;
    let mut next = least.next_multiple_of(4);
    std::iter::from_fn(move || {
        while next <= most.max(least.next_power_of_two().max(4)) {
            let size = next;
            next += 4;
            if smooth(size) {
                next = next.max((size as f64 * ratio) as usize).next_multiple_of(4);
                return Some(size);
            }
        }
        None
    })
}
