//! Weights that give all cells the same area.

use std::sync::Arc;

use bn_core::{DensityIntegrals, PointSet};

use super::PowerDiagram;
use super::laplacian::Laplacian;

/// A power diagram whose cells have equal areas: a capacity-constrained Voronoi tessellation, the
/// optimal transport of the uniform distribution to the points.
///
/// The weights maximise a concave function (Aurenhammer, Hoffmann and Aronov, "Minkowski-type
/// theorems and least-squares clustering", Algorithmica 20(1), 1998), whose gradient is what cells
/// lack of their areas. [`BalancedDiagram::balance`] climbs it by Newton's method, damped so
/// that no cell falls below half of the least area at the start (or of 1/n) and the norm of what cells
/// lack falls: it converges
/// from the Voronoi diagram of any distinct points (Kitagawa, Mérigot and Thibert, "Convergence of a
/// Newton algorithm for semi-discrete optimal transport", J. Eur. Math. Soc. 21(9), 2019), quadratically
/// in the end, and in two or three steps where the weights are about right already.
///
/// Cost: a [`PowerDiagram`] and some √n steps of the conjugate gradient method for each step.
///
/// ```
/// use bn_core::{DVec2, PointSet};
/// use bn_geometry::BalancedDiagram;
///
/// let places = [(0.1, 0.1), (0.15, 0.2), (0.7, 0.6), (0.4, 0.9), (0.9, 0.3)];
/// let set = PointSet::new(places.map(|(x, y)| DVec2::new(x, y)).to_vec())?;
/// let mut balanced = BalancedDiagram::default();
/// assert!(balanced.balance(&set, 1e-12, 50).converged);
/// assert!(balanced.diagram().cells().iter().all(|cell| (cell.area - 0.2).abs() < 1e-12));
/// # Ok::<(), bn_core::PointSetError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct BalancedDiagram {
    diagram: PowerDiagram,
    weights: Vec<f64>,
    laplacian: Laplacian,
    /// What cells lack, and the Newton step; weights before a step.
    lack: Vec<f64>,
    step: Vec<f64>,
    before: Vec<f64>,
}

/// How a balance came out.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Balance {
    /// Newton steps taken.
    pub steps: u32,
    /// The largest error of an area, relative to the wanted one.
    pub residual: f64,
    /// Whether the residual is within the tolerance.
    pub converged: bool,
}

/// A step is halved this often before the search for a better diagram is given up.
const MOST_HALVINGS: u32 = 30;

/// Linear systems are solved so well that their error is of the size of what the areas' curvature
/// leaves anyway, about the residual, within these limits: rounding leaves no better than the lower.
const ACCURACY: (f64, f64) = (1e-6, 0.02);

impl BalancedDiagram {
    /// A diagram, to be balanced, of cells of equal masses by this density.
    ///
    /// Newton's method needs mass on every edge: a density that is 0 somewhere should be raised a
    /// little there.
    pub fn of_density(density: Arc<DensityIntegrals>) -> Self {
        Self { diagram: PowerDiagram::of_density(density), ..Self::default() }
    }

    /// Balances the cells of `set` until no area is off by more than `tolerance` relative to 1/n,
    /// in at most `most_steps` Newton steps, from the weights of the last call if it had as many points.
    ///
    /// Not converged if points coincide, as they can't all have cells, or if the tolerance is
    /// below what rounding allows, some 1e-15·√n.
    pub fn balance(&mut self, set: &PointSet, tolerance: f64, most_steps: u32) -> Balance {
        let mut least = self.start(set);
        let mut steps = 0;
        let mut residual = self.measure_lack();
        // Cells may become this small on the way.
        let floor = 0.5 * least.min(1.0 / set.len() as f64);
        while residual > tolerance && steps < most_steps && least > 0.0 {
            self.laplacian.assemble(&self.diagram);
            let accuracy = residual.clamp(ACCURACY.0, ACCURACY.1);
            let most = 100 + 20 * set.len().isqrt() as u32;
            self.laplacian.solve(&self.lack, &mut self.step, accuracy, most);
            let Some(better) = self.advance(set, residual, floor) else { break };
            (residual, least) = better;
            steps += 1;
        }
        Balance { steps, residual, converged: residual <= tolerance }
    }

    /// The diagram as last balanced.
    pub fn diagram(&self) -> &PowerDiagram {
        &self.diagram
    }

    /// The cost of carrying the uniform distribution to the points, equal parts to each, at best: the
    /// concave function that balanced weights maximise. Wrong only by the square of what the areas
    /// are wrong, and never too large; [`PowerDiagram::transport_cost`] is wrong by as much itself.
    pub fn transport_cost(&self) -> f64 {
        let lack = self.lack.iter().zip(&self.weights);
        self.diagram.transport_cost() + lack.map(|(lack, w)| lack * w).sum::<f64>()
    }

    /// Its weights; their mean is 0 up to rounding.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Begins with the weights there are, or with none where these hide a point. Returns the least
    /// area.
    fn start(&mut self, set: &PointSet) -> f64 {
        if self.weights.len() == set.len() {
            self.diagram.update(set, &self.weights);
            let least = self.least_area();
            if least > 0.0 {
                return least;
            }
        }
        self.weights.clear();
        self.weights.resize(set.len(), 0.0);
        self.diagram.update(set, &self.weights);
        self.least_area()
    }

    fn least_area(&self) -> f64 {
        self.diagram.cells().iter().map(|cell| cell.area).fold(f64::INFINITY, f64::min)
    }

    /// Notes what each cell lacks; the largest error, relative to the wanted area.
    fn measure_lack(&mut self) -> f64 {
        let n = self.diagram.len() as f64;
        self.lack.clear();
        self.lack.extend(self.diagram.cells().iter().map(|cell| 1.0 / n - cell.area));
        self.lack.iter().map(|lack| lack.abs()).fold(0.0, f64::max) * n
    }

    /// Takes as much of the Newton step as makes things better and leaves no cell below `floor`.
    /// Returns the new residual and least area; none, and everything as it was, if there is no such
    /// part.
    fn advance(&mut self, set: &PointSet, residual: f64, floor: f64) -> Option<(f64, f64)> {
        self.before.clone_from(&self.weights);
        let norm = norm(&self.lack);
        let mut part = 1.0;
        for _ in 0..MOST_HALVINGS {
            for ((w, before), step) in self.weights.iter_mut().zip(&self.before).zip(&self.step) {
                *w = before + part * step;
            }
            self.diagram.update(set, &self.weights);
            let least = self.least_area();
            let next = self.measure_lack();
            let is_better =
                self::norm(&self.lack) <= (1.0 - 0.5 * part) * norm || next <= 0.5 * residual;
            if least >= floor && is_better {
                return Some((next, least));
            }
            part *= 0.5;
        }
        self.weights.clone_from(&self.before);
        self.diagram.update(set, &self.weights);
        self.measure_lack();
        None
    }
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>().sqrt()
}
