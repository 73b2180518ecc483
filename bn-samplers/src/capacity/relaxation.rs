//! Points on their way to the centroids of cells of equal area.

use std::sync::Arc;

use bn_core::{
    CellGrid, DVec2, Density, DensityFunction, DensityIntegrals, NormalizedDistance, PointSet,
    StreamRng, torus,
};
use bn_geometry::{Balance, BalancedDiagram, VoronoiCell};

use super::regularity::{self, HEXAGON};

/// A line search gives up after so many halvings: the slope is rounding by then.
const MOST_HALVINGS: u32 = 20;

/// Points and the power diagram in which each has the same area, between one move and the next.
pub(super) struct Relaxation {
    /// In the order of places, so that neighbours in the plane are neighbours in memory.
    points: PointSet,
    /// Which point of the caller's stands at each place of the list.
    order: Vec<u32>,
    balanced: BalancedDiagram,
    /// Whether cells are measured by a density.
    is_weighed: bool,
}

/// Densities are raised to this, relative to their mean: Newton's method needs some mass on the edges of
/// every cell, and so little moves no centroid visibly.
const FAINTEST: f64 = 1e-6;

/// Areas need to be no better than this, relative to 1/n, for centroids to move towards.
pub(super) const LOOSE: f64 = 1e-3;

/// The most Newton steps for one diagram; five are rarely needed.
const MOST_STEPS: u32 = 100;

impl Relaxation {
    /// Points in cells of equal mass by this density, evenly if there is none.
    pub(super) fn new(points: &PointSet, density: Option<&DensityFunction>) -> Self {
        let grid = CellGrid::new(points);
        let order = grid.all().indices.to_vec();
        let sorted = grid.all().points.to_vec();
        let points = PointSet::new(sorted).expect("points of a set");
        let balanced = density.map_or_else(BalancedDiagram::default, |density| {
            let raised = density.map(|value| value.max(FAINTEST));
            let raised = raised.expect("densities of mean 1 have finite sums");
            BalancedDiagram::of_density(Arc::new(DensityIntegrals::new(&raised)))
        });
        Self { points, order, balanced, is_weighed: density.is_some() }
    }

    /// Finds the weights that make no area wrong by more than `tolerance`, relative to 1/n.
    pub(super) fn balance(&mut self, tolerance: f64) -> Balance {
        self.balanced.balance(&self.points, tolerance, MOST_STEPS)
    }

    /// n·Σ ∫ |x − p|² over the cells, the cost of transport in units that do not depend on n: 5/(18√3) =
    /// 0.1604 for the hexagonal lattice, the least possible for an even density.
    pub(super) fn energy(&self) -> f64 {
        self.balanced.transport_cost() * self.points.len() as f64
    }

    /// The root mean square of the points' distances to the centroids of their cells. With a density each
    /// distance is taken relative to the size of its cell, and told as if cells were of the mean size.
    pub(super) fn unrest(&self) -> NormalizedDistance {
        let cells = self.balanced.diagram().cells().iter();
        let squares: f64 = if self.is_weighed {
            // A regular hexagon of the area 1/n has the mean square HEXAGON/n.
            let unit = HEXAGON / self.points.len() as f64;
            let size = |cell: &VoronoiCell| cell.second_moment / (cell.area * unit);
            cells
                .filter(|cell| cell.second_moment > 0.0)
                .map(|cell| cell.to_centroid.length_squared() / size(cell))
                .sum()
        } else {
            cells.map(|cell| cell.to_centroid.length_squared()).sum()
        };
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

    /// Moves the points towards the centroids, `longest` times their way or a half, a quarter … of
    /// that: the first at which the energy falls by a tenth of what the slope promises, areas
    /// being balanced to `tolerance`. False, and nothing moved, if there is no such step.
    pub(super) fn descend(&mut self, longest: f64, tolerance: f64) -> bool {
        let from = self.points.points().to_vec();
        let cells = self.balanced.diagram().cells();
        let ways: Vec<DVec2> = cells.iter().map(|cell| cell.to_centroid).collect();
        // The gradient of n·Σ ∫ |x − p|² is −2 times the way to the centroid.
        let slope: f64 = ways.iter().map(|way| -2.0 * way.length_squared()).sum();
        let energy = self.energy();
        let mut part = longest;
        for _ in 0..MOST_HALVINGS {
            let moved = from.iter().zip(&ways).map(|(p, way)| torus::wrap_point(*p + *way * part));
            self.points = PointSet::new(moved.collect()).expect("wrapped points are on the torus");
            self.balance(tolerance);
            if self.energy() <= energy + 0.1 * part * slope {
                return true;
            }
            part *= 0.5;
        }
        self.points = PointSet::new(from).expect("where the points were");
        self.balance(tolerance);
        false
    }

    /// The places in the list of points whose cells have the shape of those around; see
    /// [`regularity::regular_points`]. None where a density makes cells differ.
    pub(super) fn regular_points(&self, threshold: f64) -> Vec<usize> {
        if self.is_weighed {
            return Vec::new();
        }
        regularity::regular_points(self.balanced.diagram(), threshold)
    }

    /// Disturbs these points and their neighbours; see [`regularity::break_up`].
    pub(super) fn break_up(&mut self, regular: &[usize], rng: &mut StreamRng) {
        let mut points = self.points.points().to_vec();
        regularity::break_up(&mut points, self.balanced.diagram(), regular, rng);
        self.points = PointSet::new(points).expect("wrapped points are on the torus");
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
