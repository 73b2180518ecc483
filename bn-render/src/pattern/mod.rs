//! Point sets laid over the image plane.

mod buckets;
mod samples;
mod variation;

use std::ops::{Range, RangeInclusive};

use bn_core::{DVec2, PointSet};
use thiserror::Error;

use crate::Rect;
use buckets::{Buckets, Interval};
pub use samples::SampleList;
use variation::Change;
pub use variation::TileVariation;

/// Why a point set can't be laid over the image plane as asked.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum PatternError {
    /// A number of samples per pixel that is not a number, or beyond all use.
    #[error("{samples_per_pixel:?} samples per pixel are not possible; ask for 2⁻¹⁶ to 2¹⁶")]
    SamplesPerPixel {
        /// The number asked for.
        samples_per_pixel: f64,
    },
    /// Not one weight a point.
    #[error("{weights} weights for {points} points")]
    WeightCount {
        /// Weights given.
        weights: usize,
        /// Points of the set.
        points: usize,
    },
    /// A weight that is negative or not a finite number.
    #[error("weight {weight} of point {index} is no weight; they are finite and not negative")]
    Weight {
        /// The point's index.
        index: usize,
        /// Its weight.
        weight: f64,
    },
    /// All weights are 0, or their sum is beyond all numbers.
    #[error("the weights' sum is {sum}; it must be a positive number")]
    WeightSum {
        /// The sum.
        sum: f64,
    },
}

/// A point set tiled over the whole image plane.
///
/// A set of n points at s samples per pixel fills a square tile of side L = √(n/s) pixels, a real
/// number; the sample of point (x, y) in tile (a, b) lies at ((a + x)·L, (b + y)·L), for all
/// integers a and b: tile (0, 0) starts at the image's corner. With n = s the set is a pattern for
/// one pixel.
#[derive(Clone, Debug)]
pub struct Pattern {
    buckets: Buckets,
    samples_per_pixel: f64,
    side: f64,
    variation: TileVariation,
}

impl Pattern {
    /// The set tiled at `samples_per_pixel`.
    ///
    /// # Errors
    /// If `samples_per_pixel` is not a number from 2⁻¹⁶ to 2¹⁶.
    pub fn tiled(set: &PointSet, samples_per_pixel: f64) -> Result<Self, PatternError> {
        Self::with_weights(set, &[], samples_per_pixel)
    }

    /// The set tiled at `samples_per_pixel`, its points weighing as `weights` say, in the order of
    /// the set and in any unit: they are divided by their mean.
    ///
    /// A sample then counts as that many: its kernel and the density that it stands for are
    /// multiplied by its weight. With the areas of the points' Voronoi cells (on the torus: those of
    /// the tiled set, as long as tiles are alike) sums over samples become integrals over the cells,
    /// and gaps and clusters no longer show as changes of brightness.
    ///
    /// # Errors
    /// If `samples_per_pixel` is not a number from 2⁻¹⁶ to 2¹⁶, there isn't one weight a point, one
    /// is negative or not finite, or their sum is not positive and finite.
    pub fn weighted(
        set: &PointSet,
        weights: &[f64],
        samples_per_pixel: f64,
    ) -> Result<Self, PatternError> {
        if weights.len() != set.len() {
            return Err(PatternError::WeightCount { weights: weights.len(), points: set.len() });
        }
        let bad = weights.iter().position(|weight| !(weight.is_finite() && *weight >= 0.0));
        if let Some(index) = bad {
            return Err(PatternError::Weight { index, weight: weights[index] });
        }
        let sum: f64 = weights.iter().sum();
        if !(sum > 0.0 && sum.is_finite()) {
            return Err(PatternError::WeightSum { sum });
        }
        let mean = sum / set.len() as f64;
        let relative: Vec<f64> = weights.iter().map(|weight| weight / mean).collect();
        Self::with_weights(set, &relative, samples_per_pixel)
    }

    fn with_weights(
        set: &PointSet,
        weights: &[f64],
        samples_per_pixel: f64,
    ) -> Result<Self, PatternError> {
        check_rate(samples_per_pixel)?;
        let side = (set.len() as f64 / samples_per_pixel).sqrt();
        let variation = TileVariation::Repeated;
        Ok(Self { buckets: Buckets::new(set, weights), samples_per_pixel, side, variation })
    }

    /// The same with tiles that differ.
    #[must_use]
    pub fn varied(self, variation: TileVariation) -> Self {
        Self { variation, ..self }
    }

    /// Samples per pixel s.
    pub fn samples_per_pixel(&self) -> f64 {
        self.samples_per_pixel
    }

    /// The tile's side L in pixels.
    pub fn side(&self) -> f64 {
        self.side
    }

    /// Whether points weigh differently.
    pub fn is_weighted(&self) -> bool {
        !self.buckets.weights().is_empty()
    }

    /// Points in a tile.
    pub fn points_per_tile(&self) -> usize {
        self.buckets.len()
    }

    /// Appends the samples with `min ≤ (u, v) < max` to `list`.
    ///
    /// In the order of tiles (row by row), then of a fixed order of the points in a tile: the
    /// samples of a smaller rectangle come in the same order as within a larger one. Cost: some 2
    /// ns for each sample in the rectangle grown by a few samples' distance.
    pub fn samples_in(&self, rect: &Rect, list: &mut SampleList) {
        self.for_each_tile(rect, |tile| self.append(rect, tile, list));
    }

    /// The number of samples with `min ≤ (u, v) < max`; the cost is that of the samples along its
    /// border, and a few ns for each tile there.
    pub fn count_in(&self, rect: &Rect) -> u64 {
        let Some([columns, rows]) = self.tiles(rect) else { return 0 };
        let (whole_columns, whole_rows) = (columns.whole(), rows.whole());
        let length = |whole: &Range<i64>| whole.end.abs_diff(whole.start);
        let whole = length(&whole_columns).saturating_mul(length(&whole_rows));
        let mut count = whole.saturating_mul(self.points_per_tile() as u64);
        let mut list = SampleList::default();
        let mut add = |a: i64, b: i64| {
            list.clear();
            self.append(rect, &columns.tile(&rows, a, b), &mut list);
            count = count.saturating_add(list.len() as u64);
        };
        for b in rows.outside(&whole_rows) {
            columns.indices.clone().for_each(|a| add(a, b));
        }
        for a in columns.outside(&whole_columns) {
            whole_rows.clone().for_each(|b| add(a, b));
        }
        count
    }

    /// Calls `visit` for each tile that meets the rectangle, row by row.
    fn for_each_tile(&self, rect: &Rect, mut visit: impl FnMut(&Tile)) {
        let Some([columns, rows]) = self.tiles(rect) else { return };
        for b in rows.indices.clone() {
            for a in columns.indices.clone() {
                visit(&columns.tile(&rows, a, b));
            }
        }
    }

    /// The columns and rows of tiles that meet the rectangle; none if it is no rectangle.
    fn tiles(&self, rect: &Rect) -> Option<[TileRange; 2]> {
        let (low, high) = (rect.min / self.side, rect.max / self.side);
        let finite = low.is_finite() && high.is_finite();
        finite.then(|| [TileRange::new(low.x, high.x), TileRange::new(low.y, high.y)])
    }

    fn append(&self, rect: &Rect, tile: &Tile, list: &mut SampleList) {
        let (xs, ys) = (self.buckets.xs(), self.buckets.ys());
        let weights = self.buckets.weights();
        let corner = DVec2::new(tile.a as f64, tile.b as f64);
        let Some(change) = self.variation.of_tile(tile.a, tile.b) else {
            for run in self.buckets.runs(tile.x, tile.y) {
                let points = xs[run.clone()].iter().zip(&ys[run.clone()]);
                let places = points.map(|(&x, &y)| (corner + DVec2::new(x, y)) * self.side);
                list.append(rect, places, weights.get(run));
            }
            return;
        };
        let place = |p: DVec2| (corner + change.apply(p)) * self.side;
        let [from_x, from_y] = clamped_sources(change, tile);
        // Sorted and read once each, so that the order is that of the points whatever the
        // rectangle.
        let mut runs: Vec<_> = (from_y.into_iter())
            .flat_map(|y| from_x.into_iter().flat_map(move |x| self.buckets.runs(x, y)))
            .collect();
        runs.sort_unstable_by_key(|run| run.start);
        let mut read_to = 0;
        for run in runs {
            let fresh = run.start.max(read_to)..run.end;
            read_to = read_to.max(run.end);
            let places = fresh.clone().map(|i| place(DVec2::new(xs[i], ys[i])));
            list.append(rect, places, weights.get(fresh));
        }
    }
}

/// What a coordinate over a tile's side may be off, with room: relative to the tile's index for
/// the rounding of the division, and a little more.
fn slack(index: f64) -> f64 {
    1e-9 + 1e-15 * index.abs()
}

fn clamped_sources(change: Change, tile: &Tile) -> [[Interval; 2]; 2] {
    let clamp = |(low, high): Interval| (low.max(0.0), high.min(1.0));
    change.sources(clamp(tile.x), clamp(tile.y))
}

/// A tile, and what is wanted of it in its own coordinates.
struct Tile {
    a: i64,
    b: i64,
    x: Interval,
    y: Interval,
}

/// What is wanted along one axis, in tiles, and the tiles that it meets.
struct TileRange {
    low: f64,
    high: f64,
    indices: RangeInclusive<i64>,
}

impl TileRange {
    fn new(low: f64, high: f64) -> Self {
        let indices = (low - slack(low)).floor() as i64..=(high + slack(high)).floor() as i64;
        Self { low, high, indices }
    }

    /// Tile (a, b) of these columns and those rows.
    fn tile(&self, rows: &Self, a: i64, b: i64) -> Tile {
        Tile { a, b, x: self.overlap(a), y: rows.overlap(b) }
    }

    fn overlap(&self, index: i64) -> Interval {
        let slack = slack(index as f64);
        (self.low - index as f64 - slack, self.high - index as f64 + slack)
    }

    /// Whether all of a tile is wanted along this axis, beyond doubt.
    fn is_whole(&self, index: i64) -> bool {
        // The intervals are generous by one slack; two more make sure.
        let (slack, (low, high)) = (slack(index as f64), self.overlap(index));
        low < -3.0 * slack && high > 1.0 + 3.0 * slack
    }

    /// The tiles that are wanted whole, which lie together. Cost: a few ns for each before and
    /// after them.
    fn whole(&self) -> Range<i64> {
        let end = self.indices.end().saturating_add(1);
        let first = self.indices.clone().find(|&index| self.is_whole(index));
        let last = self.indices.clone().rev().find(|&index| self.is_whole(index));
        first.zip(last).map_or(end..end, |(first, last)| first..last.saturating_add(1))
    }

    /// The tiles before and after these.
    fn outside(&self, whole: &Range<i64>) -> impl Iterator<Item = i64> + use<> {
        (*self.indices.start()..whole.start).chain(whole.end..=*self.indices.end())
    }
}

/// Refuses what is no number of samples per pixel.
pub(crate) fn check_rate(samples_per_pixel: f64) -> Result<(), PatternError> {
    let limit = f64::from(1 << 16);
    if (1.0 / limit..=limit).contains(&samples_per_pixel) {
        Ok(())
    } else {
        Err(PatternError::SamplesPerPixel { samples_per_pixel })
    }
}
