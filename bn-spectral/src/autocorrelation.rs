//! The two-dimensional autocorrelation of point sets.

use std::ops::Range;

use bn_core::{CellGrid, PointSet, torus};
use rayon::prelude::*;

/// Points whose surroundings are looked at as one piece of work.
const POINTS: usize = 4096;

/// The pair correlation g(r) of displacements r = (rx, ry) in a square window (thesis section 5.1
/// and figure 5.1), mean over the sets: how many times as many ordered pairs have that displacement
/// as independent points would have on the average, without the peak at 0 of each point with
/// itself. Symmetric under r → −r but for displacements that lie exactly on a cell's bounds, as a
/// lattice's may: each belongs to one cell.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Autocorrelation {
    half_width: f64,
    side: usize,
    values: Vec<f64>,
}

impl Autocorrelation {
    /// The most cells that a side can have.
    pub const MAX_SIDE: usize = 1 << 12;

    /// g over [−`half_width`, `half_width`)² (unit lengths) in `side` × `side` cells. A cell's value
    /// that c ordered pairs make up has a relative error of about √(2/c): each comes with its reverse.
    ///
    /// Cost O(n·(1 + n·`half_width`²)) a set of points that are spread evenly and O(n²) if they crowd
    /// in one place; O(side²) memory a thread.
    ///
    /// # Panics
    /// If there is no set, `half_width` is not in (0, ½], or `side` is 0 or above
    /// [`Self::MAX_SIDE`].
    pub fn of(sets: &[PointSet], half_width: f64, side: usize) -> Self {
        assert!(!sets.is_empty(), "an autocorrelation needs a set");
        assert!(
            half_width > 0.0 && half_width <= 0.5,
            "half width {half_width} is not in (0, 0.5]"
        );
        assert!(
            (1..=Self::MAX_SIDE).contains(&side),
            "{side} cells a side; 1 to 4096 are possible"
        );
        let window = Window { half_width, side };
        let mut values = vec![0.0; side * side];
        let area = (2.0 * half_width / side as f64).powi(2);
        for set in sets {
            let pairs = set.len() as f64 * (set.len() as f64 - 1.0);
            // A single point has no pairs; like its RDF, its g is 1.
            if set.len() < 2 {
                for g in &mut values {
                    *g += 1.0 / sets.len() as f64;
                }
                continue;
            }
            let scale = 1.0 / (pairs * area * sets.len() as f64);
            for (g, count) in values.iter_mut().zip(window.counts(set)) {
                *g += scale * count as f64;
            }
        }
        Self { half_width, side, values }
    }

    /// Half the side of the window in unit lengths.
    pub fn half_width(&self) -> f64 {
        self.half_width
    }

    /// Cells a side.
    pub fn side(&self) -> usize {
        self.side
    }

    /// g by cell, row by row from the lowest ry.
    pub fn values(&self) -> &[f64] {
        &self.values
    }
}

struct Window {
    half_width: f64,
    side: usize,
}

impl Window {
    /// Number of ordered pairs by cell of their displacement.
    fn counts(&self, set: &PointSet) -> Vec<u64> {
        let grid = CellGrid::new(set);
        // At most 64 pieces, each of which has counts of its own.
        let piece = POINTS.max(set.len().div_ceil(64));
        let pieces: Vec<Vec<u64>> = (0..set.len())
            .into_par_iter()
            .step_by(piece)
            .map(|first| self.count_piece(set, &grid, first..(first + piece).min(set.len())))
            .collect();
        let mut total = vec![0_u64; self.side * self.side];
        for piece in &pieces {
            for (total, &count) in total.iter_mut().zip(piece) {
                *total += count;
            }
        }
        total
    }

    fn count_piece(&self, set: &PointSet, grid: &CellGrid, piece: Range<usize>) -> Vec<u64> {
        let mut counts = vec![0_u64; self.side * self.side];
        let radius = self.half_width * std::f64::consts::SQRT_2;
        for from in piece {
            let p = set.points()[from];
            grid.for_each_within(p, radius, |to, _| {
                if to as usize != from {
                    let d = torus::delta(p, set.points()[to as usize]);
                    if let (Some(ix), Some(iy)) = (self.cell(d.x), self.cell(d.y)) {
                        counts[iy * self.side + ix] += 1;
                    }
                }
            });
        }
        counts
    }

    fn cell(&self, d: f64) -> Option<usize> {
        let scaled = (d + self.half_width) / (2.0 * self.half_width) * self.side as f64;
        // A displacement of ±½ is its own negative: both ends are one cell.
        let scaled = if self.half_width == 0.5 && d >= 0.5 { 0.0 } else { scaled };
        (scaled >= 0.0 && scaled < self.side as f64).then_some(scaled as usize)
    }
}
