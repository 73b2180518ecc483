//! Pair distances: exact histograms and the radial distribution function.

mod counter;

use bn_core::{Curve, PointSet};
use rayon::prelude::*;

use crate::cell_pairs::CellPairs;
use counter::{Coordinates, Counter};

/// Rows of the triangle of all pairs that make one piece of work.
const ROWS: usize = 64;
/// Columns that are compared with all of those rows while they are in the first-level cache.
const COLUMNS: usize = 1024;
/// Below this number of pairs (a few milliseconds) the work stays on the calling thread.
const PARALLEL_PAIRS: u64 = 1 << 21;

/// How many pairs of a point set lie at which torus distance.
///
/// Every unordered pair of points with distance r < range is counted in bin ⌊r·bins/range⌋. The
/// counts are exact for the distances as they are in double precision, and the same on any number
/// of threads.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct PairHistogram {
    points: usize,
    /// Bins per unit length; an integer where range is ½.
    bins_per_unit: f64,
    counts: Vec<u64>,
}

impl PairHistogram {
    /// The largest number of bins.
    pub const MAX_BINS: usize = 1 << 28;

    /// The histogram of all pairs closer than ½, the largest distance whose circle fits the torus.
    ///
    /// O(n²) time, about 1 ns a pair and core with AVX2; O(n + bins) memory a thread.
    ///
    /// # Panics
    /// If `bins` is 0 or above [`Self::MAX_BINS`].
    pub fn new(set: &PointSet, bins: usize) -> Self {
        Self::within(set, 0.5, bins)
    }

    /// The histogram of the pairs closer than `range` ≤ ½ only.
    ///
    /// O(n·(1 + n·range²)) time if the points are spread evenly: where range is below ⅓, only points of
    /// neighbouring cells of that size are compared.
    ///
    /// # Panics
    /// If `bins` is 0 or above [`Self::MAX_BINS`], or `range` is not in (0, ½].
    pub fn within(set: &PointSet, range: f64, bins: usize) -> Self {
        assert!((1..=Self::MAX_BINS).contains(&bins), "{bins} bins; a histogram has 1 to 2^28");
        assert!(range > 0.0 && range <= 0.5, "range {range} is not in (0, 0.5]");
        let bins_per_unit = bins as f64 / range;
        assert!(bins_per_unit.is_finite(), "{bins} bins in {range} are too narrow");
        let n = set.len();
        let new = || Counter::new(bins, bins_per_unit);
        let counts = match CellPairs::within(set, range) {
            None => count_all(&Coordinates::of(set.points()), new),
            Some(pairs) => count_near(&pairs, new),
        };
        Self { points: n, bins_per_unit, counts }
    }

    /// Number of points n of the set.
    pub fn points(&self) -> usize {
        self.points
    }

    /// Number of unordered pairs by bin.
    pub fn counts(&self) -> &[u64] {
        &self.counts
    }

    /// Width Δr of a bin in unit lengths; bin i holds distances in [i·Δr, (i + 1)·Δr).
    pub fn bin_width(&self) -> f64 {
        1.0 / self.bins_per_unit
    }

    /// The radial distribution function g(r): the count of each bin over that expected of
    /// independent points, n(n − 1)/2 · π Δr² (2i + 1), which is exact for annuli below ½.
    ///
    /// The abscissae are the lower edges of the bins. For independent points the mean of a bin is
    /// 1 and its variance (1 − p)/(M p), M = n(n − 1)/2, p the annulus' area. A single point has no
    /// pairs; its g is 1, which is what belongs to its power spectrum P = 1.
    pub fn rdf(&self) -> Curve {
        let dr = self.bin_width();
        if self.points < 2 {
            return Curve::new(0.0, dr, vec![1.0; self.counts.len()]);
        }
        let pairs = self.points as f64 * (self.points - 1) as f64 / 2.0;
        let unit = pairs * std::f64::consts::PI * dr * dr;
        let g = |(i, &count): (usize, &u64)| count as f64 / (unit * (2 * i + 1) as f64);
        Curve::new(0.0, dr, self.counts.iter().enumerate().map(g).collect())
    }
}

/// All pairs: rows of the triangle in blocks, each against the columns to its right.
fn count_all(points: &Coordinates, new: impl Fn() -> Counter + Sync) -> Vec<u64> {
    let n = points.len();
    let count_block = |mut counter: Counter, block: usize| {
        let rows = block * ROWS..((block + 1) * ROWS).min(n);
        for row in rows.clone() {
            counter.count(points, row, row + 1..rows.end);
        }
        for first in (rows.end..n).step_by(COLUMNS) {
            for row in rows.clone() {
                counter.count(points, row, first..(first + COLUMNS).min(n));
            }
        }
        counter
    };
    let pairs = n as u64 * (n as u64 - 1) / 2;
    in_blocks(n.div_ceil(ROWS), pairs < PARALLEL_PAIRS, new, count_block)
}

/// Pairs of the same or neighbouring cells.
fn count_near(pairs: &CellPairs, new: impl Fn() -> Counter + Sync) -> Vec<u64> {
    let points = Coordinates::of(pairs.points());
    let count_row = |mut counter: Counter, iy: usize| {
        pairs.for_each_in_row(iy, |point, others| counter.count(&points, point, others));
        counter
    };
    in_blocks(pairs.rows(), pairs.expected_pairs() < PARALLEL_PAIRS, new, count_row)
}

/// The sum of what `count` adds in each block; integers, so the order is of no consequence.
fn in_blocks(
    blocks: usize,
    sequential: bool,
    new: impl Fn() -> Counter + Sync,
    count: impl Fn(Counter, usize) -> Counter + Sync,
) -> Vec<u64> {
    if sequential {
        return (0..blocks).fold(new(), count).into_counts();
    }
    // Early rows of a triangle are longer; rayon's stealing evens that out.
    let counters = (0..blocks).into_par_iter().fold(&new, &count);
    counters.map(Counter::into_counts).reduce_with(add).unwrap_or_default()
}

fn add(mut a: Vec<u64>, b: Vec<u64>) -> Vec<u64> {
    for (a, b) in a.iter_mut().zip(b) {
        *a += b;
    }
    a
}
