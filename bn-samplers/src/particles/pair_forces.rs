//! Forces between pairs of particles that are near each other.

use bn_core::{CellGrid, DVec2, PointSet, torus};
use rayon::prelude::*;

/// Particles whose forces are computed as one piece of work.
const BLOCK: usize = 256;

/// The force on each particle, Σⱼ f(|d|²)·d over all others and all their periodic copies at a
/// distance |d| below `cutoff`, where d leads from j to the particle; the particle's own copies
/// cancel out. Particles nearer than 10⁻¹⁰⁰ exert no force on each other.
///
/// Sums run in an order that doesn't depend on the number of threads. O(n) for a cutoff of a few
/// spacings.
pub(super) fn pair_forces(
    points: &PointSet,
    cutoff: f64,
    factor: impl Fn(f64) -> f64 + Sync,
) -> Vec<DVec2> {
    // Cells of a third of the cutoff leave out most that is beyond it.
    let side = ((3.0 / cutoff) as usize).min(points.len().isqrt());
    if side < 2 * REACH + 1 {
        let force = |&p: &DVec2| force_of_all_copies(p, points.points(), cutoff, &factor);
        return points.points().par_iter().with_min_len(16).map(force).collect();
    }
    let grid = CellGrid::with_cells_per_side(points, side);
    let all = grid.all();
    let blocks: Vec<Vec<DVec2>> = all
        .points
        .par_chunks(BLOCK)
        .map(|block| block.iter().map(|&p| force_of_near(p, &grid, cutoff, &factor)).collect())
        .collect();
    let mut forces = vec![DVec2::ZERO; points.len()];
    for (&index, force) in all.indices.iter().zip(blocks.into_iter().flatten()) {
        forces[index as usize] = force;
    }
    forces
}

/// Cells that a cutoff of up to three cells reaches over.
const REACH: usize = 3;

/// Squared distance below which the direction between particles is lost.
const COINCIDENT: f64 = 1e-200;

fn force_of_near(p: DVec2, grid: &CellGrid, cutoff: f64, factor: &impl Fn(f64) -> f64) -> DVec2 {
    let side = grid.cells_per_side();
    let reach = ((cutoff * side as f64).ceil() as usize).min((side - 1) / 2);
    let limit = cutoff * cutoff;
    let (column, row) = grid.cell_of(p);
    let (first, end) = (column + side - reach, column + side + reach + 1);
    // The columns of the neighbourhood in the unit square: one stretch, or two around the seam.
    let stretches = if first < side {
        [first..side, 0..end - side]
    } else if end > 2 * side {
        [first - side..side, 0..end - 2 * side]
    } else {
        [first - side..end - side, 0..0]
    };
    let mut force = DVec2::ZERO;
    for near in row + side - reach..=row + side + reach {
        for columns in stretches.clone() {
            for &q in grid.row_cells(near % side, columns).points {
                let d = torus::delta(q, p);
                let squared = d.length_squared();
                if (COINCIDENT..limit).contains(&squared) {
                    force += factor(squared) * d;
                }
            }
        }
    }
    force
}

fn force_of_all_copies(
    p: DVec2,
    points: &[DVec2],
    cutoff: f64,
    factor: &impl Fn(f64) -> f64,
) -> DVec2 {
    let reach = cutoff.ceil() as i32;
    let limit = cutoff * cutoff;
    let mut force = DVec2::ZERO;
    for &q in points {
        let d = torus::delta(q, p);
        for i in -reach..=reach {
            for j in -reach..=reach {
                let d = d + DVec2::new(f64::from(i), f64::from(j));
                let squared = d.length_squared();
                if (COINCIDENT..limit).contains(&squared) {
                    force += factor(squared) * d;
                }
            }
        }
    }
    force
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stochastic::uniform_points;
    use bn_core::Seed;

    #[test]
    fn cells_and_copies_agree() {
        for n in [1, 2, 50, 3000] {
            let points = uniform_points(n, Seed::new(6), 0).expect("few points");
            let set = PointSet::new(points).expect("valid");
            for cutoff in [0.05, 0.11, 0.3, 0.45, 1.3] {
                let factor = |squared: f64| 1.0 / (0.01 + squared);
                let got = pair_forces(&set, cutoff, factor);
                for (&p, got) in set.points().iter().zip(got).step_by(n.div_ceil(50)) {
                    let want = force_of_all_copies(p, set.points(), cutoff, &factor);
                    // Up to 3000·9 terms of at most 10 in size, in another order.
                    assert!((got - want).length() < 1e-9, "{got} against {want}");
                }
            }
        }
    }
}
