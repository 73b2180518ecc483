//! Distances between nearest neighbours.

use bn_core::{CellGrid, DVec2, PointSet};
use rayon::prelude::*;

use crate::Triangulation;

/// The distance of every point to its nearest neighbour on the torus, in unit lengths.
///
/// Taken from the points as given: points 1e-300 apart are that far apart, coincident ones 0. A
/// single point has only its own copies for neighbours, the nearest of them at distance 1.
///
/// Cost: O(n) for points spread evenly, O(n log n) at worst; no triangulation. From 32,768 points on
/// rayon's threads share the work; the result does not depend on their number.
///
/// ```
/// use bn_core::{DVec2, PointSet};
/// use bn_geometry::Spacing;
///
/// let set = PointSet::new(vec![DVec2::ZERO, DVec2::new(0.9, 0.0), DVec2::new(0.5, 0.5)])?;
/// let spacing = Spacing::new(&set);
/// assert!((spacing.min() - 0.1).abs() < 1e-15); // across the seam
/// assert_eq!(spacing.nearest_distances().len(), 3);
/// # Ok::<(), bn_core::PointSetError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Spacing {
    nearest: Vec<f64>,
}

/// Points that one task looks at.
const CHUNK: usize = 4096;

/// Below this many points threads take longer to wake up than the work takes.
const PARALLEL: usize = 8 * CHUNK;

impl Spacing {
    /// The spacing of a set.
    pub fn new(set: &PointSet) -> Self {
        Self::from_grid(&CellGrid::new(set))
    }

    /// The spacing of the points in a grid, whose cells should hold a few points each.
    pub fn from_grid(grid: &CellGrid) -> Self {
        if grid.len() == 1 {
            return Self { nearest: vec![1.0] };
        }
        let all = grid.all();
        let mut by_cell = vec![0.0; grid.len()];
        let tasks = all.points.chunks(CHUNK).zip(all.indices.chunks(CHUNK));
        if grid.len() < PARALLEL {
            tasks
                .zip(by_cell.chunks_mut(CHUNK))
                .for_each(|((points, indices), out)| measure(grid, points, indices, out));
        } else {
            let tasks = all.points.par_chunks(CHUNK).zip(all.indices.par_chunks(CHUNK));
            tasks
                .zip(by_cell.par_chunks_mut(CHUNK))
                .for_each(|((points, indices), out)| measure(grid, points, indices, out));
        }
        let mut nearest = vec![0.0; grid.len()];
        for (&index, distance) in all.indices.iter().zip(by_cell) {
            nearest[index as usize] = distance;
        }
        Self { nearest }
    }

    /// The spacing of triangulated points, in the order of their indices. O(n), and several times
    /// faster than from the points alone.
    ///
    /// Taken from their places on the triangulation's coordinate grid: within 2⁻⁵⁰ of the distances
    /// of the points as given.
    pub fn of(triangulation: &Triangulation) -> Self {
        let mut nearest = vec![f64::INFINITY; triangulation.index_bound()];
        for face in triangulation.faces() {
            for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                let squared = face.corners[i].distance_squared(face.corners[j]);
                for vertex in [face.vertices[i], face.vertices[j]] {
                    nearest[vertex] = squared.min(nearest[vertex]);
                }
            }
        }
        for index in triangulation.shared_places() {
            nearest[index] = 0.0;
        }
        if triangulation.point_count() < nearest.len() {
            nearest.retain(|squared| squared.is_finite());
        }
        for squared in &mut nearest {
            *squared = squared.sqrt();
        }
        Self { nearest }
    }

    /// `d_min`: the smallest distance between two points.
    pub fn min(&self) -> f64 {
        self.nearest.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// `d_avg`: the mean over all points of the distance to the nearest neighbour, added up in the
    /// order of the points.
    pub fn mean(&self) -> f64 {
        self.nearest.iter().sum::<f64>() / self.nearest.len() as f64
    }

    /// For each point, in the order of indices, the distance to its nearest neighbour.
    pub fn nearest_distances(&self) -> &[f64] {
        &self.nearest
    }
}

fn measure(grid: &CellGrid, points: &[DVec2], indices: &[u32], out: &mut [f64]) {
    for ((&p, &index), out) in points.iter().zip(indices).zip(out) {
        *out = grid.nearest(p, Some(index)).map_or(1.0, |(_, distance)| distance);
    }
}
