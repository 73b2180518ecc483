//! Areas of Voronoi cells, by counting.

use bn_core::{CellGrid, DVec2, PointSet};

/// The share of the torus that is nearest to each point, from `side`² places.
pub fn cell_areas(set: &PointSet, side: u32) -> Vec<f64> {
    let grid = CellGrid::new(set);
    let mut areas = vec![0.0; set.len()];
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(side);
    for place in 0..side * side {
        let p = DVec2::new(at(place % side), at(place / side));
        if let Some((nearest, _)) = grid.nearest(p, None) {
            areas[nearest as usize] += 1.0 / f64::from(side).powi(2);
        }
    }
    areas
}
