//! The two-dimensional autocorrelation of point sets.

use std::ops::Range;

use bn_core::{DVec2, PointSet, torus};
use rayon::prelude::*;

use crate::cell_pairs::CellPairs;

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
    /// Cost O(n·(1 + n·`half_width`²)) a set of points that are spread evenly, a few ns a pair and core,
    /// and O(n²) if they crowd in one place; O(n) memory and O(side²) a thread.
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
        let Some(pairs) = CellPairs::within(set, self.half_width) else {
            let (n, points) = (set.len(), set.points());
            return self.in_pieces(n, |i, counts| self.count(points, i, i + 1..n, counts));
        };
        self.in_pieces(pairs.rows(), |row, counts| {
            pairs.for_each_in_row(row, |point, others| {
                self.count(pairs.points(), point, others, counts);
            });
        })
    }

    /// The sum of what `count` adds for each of `tasks` numbers: every thread takes every so many-th
    /// and has counts of its own.
    fn in_pieces(&self, tasks: usize, count: impl Fn(usize, &mut [u64]) + Sync) -> Vec<u64> {
        let threads = rayon::current_num_threads().min(tasks);
        let of_thread = |first: usize| {
            let mut counts = vec![0_u64; self.side * self.side];
            (first..tasks).step_by(threads).for_each(|task| count(task, &mut counts));
            counts
        };
        let add = |mut sum: Vec<u64>, counts: Vec<u64>| {
            sum.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
            sum
        };
        let counts = (0..threads).into_par_iter().map(of_thread).reduce_with(add);
        counts.expect("an n of 2 or more makes a task")
    }

    /// Counts the pairs of a point with `others`, in both directions.
    fn count(&self, points: &[DVec2], point: usize, others: Range<usize>, counts: &mut [u64]) {
        let from = points[point];
        for &to in &points[others] {
            let d = torus::delta(from, to);
            // What lies outside this way does so the other way, but for the ends themselves.
            if d.x.abs() > self.half_width || d.y.abs() > self.half_width {
                continue;
            }
            for d in [d, -d] {
                if let (Some(ix), Some(iy)) = (self.cell(d.x), self.cell(d.y)) {
                    counts[iy * self.side + ix] += 1;
                }
            }
        }
    }

    fn cell(&self, d: f64) -> Option<usize> {
        let scaled = (d + self.half_width) / (2.0 * self.half_width) * self.side as f64;
        // A displacement of ±½ is its own negative: both ends are one cell.
        let scaled = if self.half_width == 0.5 && d >= 0.5 { 0.0 } else { scaled };
        (scaled >= 0.0 && scaled < self.side as f64).then_some(scaled as usize)
    }
}
