//! How distances are measured where points are wanted at different densities.

use std::sync::Arc;

use bn_core::{DVec2, DensityFunction, torus};
use bn_geometry::Circle;

/// A hole between three points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hole {
    /// Its middle.
    pub(super) center: DVec2,
    /// The squared distance from there to the points.
    pub(super) size: f64,
}

/// A measure of distances: δ² = |x − y|²·√(ϱ(x)·ϱ(y)) for a density ϱ, so that points equally far
/// apart in this sense are as dense as ϱ wants them.
///
/// It is the same from x to y as from y to x. If the size of a hole depended on the density in its
/// middle alone, that middle would be as far from the corners that should be near as from those that
/// should be far, and differences of density would wear away.
///
/// Places are in the plane, relative to an origin.
pub(super) trait Field {
    /// Whether ϱ = 1 everywhere.
    const IS_EVEN: bool;

    /// √ϱ at a place.
    fn root(&self, p: DVec2) -> f64;

    /// The least √ϱ at a point: those that are where none should be count as if they were wanted a
    /// little.
    fn least_root(&self) -> f64;

    /// The hole between the corners of a face.
    #[inline]
    fn hole(&self, origin: DVec2, corners: [DVec2; 3]) -> Hole {
        hole_between(self, origin, corners)
    }

    /// The squared distance from a point at the origin to another point.
    #[inline]
    fn distance_squared(&self, origin: DVec2, way: DVec2) -> f64 {
        if Self::IS_EVEN {
            return way.length_squared();
        }
        // A point that is where none should be has no room at all there.
        way.length_squared() * self.root(origin) * self.root(origin + way).max(self.least_root())
    }
}

/// The same density everywhere.
#[derive(Clone, Copy, Debug)]
pub(super) struct Even;

impl Field for Even {
    const IS_EVEN: bool = true;

    #[inline]
    fn root(&self, _: DVec2) -> f64 {
        1.0
    }

    fn least_root(&self) -> f64 {
        1.0
    }
}

/// The least density of a point, relative to the largest.
const LEAST: f64 = 1e-4;

impl Field for Arc<DensityFunction> {
    const IS_EVEN: bool = false;

    #[inline]
    fn root(&self, p: DVec2) -> f64 {
        self.at(torus::wrap_point(p)).sqrt()
    }

    fn least_root(&self) -> f64 {
        (LEAST * self.max()).sqrt()
    }
}

/// Steps on the way to the middle of a hole; each makes the error smaller by the ratio of the spacing
/// to the length over which the density changes.
const STEPS: usize = 3;

/// As [`Field::hole`].
#[inline]
pub(super) fn hole_between<F>(field: &F, origin: DVec2, corners: [DVec2; 3]) -> Hole
where
    F: Field + ?Sized,
{
    let circle = Circle::through(corners);
    if F::IS_EVEN {
        return Hole { center: circle.center, size: circle.radius_squared };
    }
    let roots = corners.map(|corner| field.root(origin + corner).max(field.least_root()));
    let center = weighted_center(circle, corners, roots.map(f64::recip));
    let distances = (0..3).map(|i| corners[i].distance_squared(center) * roots[i]);
    let nearest = distances.fold(f64::INFINITY, f64::min);
    Hole { center, size: nearest * field.root(origin + center) }
}

/// The place c whose squared distances from the corners are in proportion to the weights, reached by
/// solving |c − yᵢ|² = R·wᵢ for c with R as it was at the place before; the circle's centre if there
/// is no such place near it, as where a density jumps.
fn weighted_center(circle: Circle, corners: [DVec2; 3], weights: [f64; 3]) -> DVec2 {
    let [u, v] = [corners[1] - corners[0], corners[2] - corners[0]];
    let area = u.perp_dot(v);
    let mut center = circle.center;
    for _ in 0..STEPS {
        let squares: f64 = corners.iter().map(|corner| corner.distance_squared(center)).sum();
        let unit = squares / weights.iter().sum::<f64>();
        let p = 0.5 * (u.length_squared() - unit * (weights[1] - weights[0]));
        let q = 0.5 * (v.length_squared() - unit * (weights[2] - weights[0]));
        center = corners[0] + DVec2::new(p * v.y - q * u.y, q * u.x - p * v.x) / area;
    }
    let is_near = center.distance_squared(circle.center) <= 0.25 * circle.radius_squared;
    if is_near { center } else { circle.center }
}
