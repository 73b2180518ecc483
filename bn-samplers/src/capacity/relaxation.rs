//! Points on their way to the centroids of cells of equal area.

use bn_core::{CellGrid, DVec2, Density, NormalizedDistance, PointSet, torus};
use bn_geometry::{Balance, BalancedDiagram};

/// Points and the power diagram in which each has the same area, between one move and the next.
pub(super) struct Relaxation {
    /// In the order of places, so that neighbours in the plane are neighbours in memory.
    points: PointSet,
    /// Which point of the caller's stands at each place of the list.
    order: Vec<u32>,
    balanced: BalancedDiagram,
}

/// The most Newton steps for one diagram; five are rarely needed.
const MOST_STEPS: u32 = 100;

impl Relaxation {
    pub(super) fn new(points: &PointSet) -> Self {
        let grid = CellGrid::new(points);
        let order = grid.all().indices.to_vec();
        let sorted = grid.all().points.to_vec();
        let points = PointSet::new(sorted).expect("points of a set");
        Self { points, order, balanced: BalancedDiagram::default() }
    }

    /// Finds the weights that make no area wrong by more than `tolerance`, relative to 1/n.
    pub(super) fn balance(&mut self, tolerance: f64) -> Balance {
        self.balanced.balance(&self.points, tolerance, MOST_STEPS)
    }

    /// n·Σ ∫ |x − p|² over the cells, the cost of transport in units that do not depend on n: 5/(18√3) =
    /// 0.1604 for the hexagonal lattice, the least possible.
    pub(super) fn energy(&self) -> f64 {
        self.balanced.transport_cost() * self.points.len() as f64
    }

    /// The root mean square of the points' distances to the centroids of their cells.
    pub(super) fn unrest(&self) -> NormalizedDistance {
        let cells = self.balanced.diagram().cells();
        let squares: f64 = cells.iter().map(|cell| cell.to_centroid.length_squared()).sum();
        let n = self.points.len();
        Density::new(n).normalize_distance((squares / n as f64).sqrt())
    }

    /// Moves each point `part` of its way to the centroid.
    pub(super) fn advance(&mut self, part: f64) {
        let cells = self.balanced.diagram().cells();
        let moved = self.points.points().iter().zip(cells);
        let moved = moved.map(|(p, cell)| torus::wrap_point(*p + cell.to_centroid * part));
        self.points = PointSet::new(moved.collect()).expect("wrapped points are on the torus");
    }

    /// The points in the caller's order.
    pub(super) fn points(&self) -> Vec<DVec2> {
        let mut points = vec![DVec2::ZERO; self.points.len()];
        for (&index, &p) in self.order.iter().zip(self.points.points()) {
            points[index as usize] = p;
        }
        points
    }
}
