//! Filling a pattern's holes, the largest first.

use bn_core::{DVec2, Observer, PointSet, Progress, torus};
use bn_geometry::{EmptyCircles, Triangulation};

use crate::SampleError;
use crate::error::observe;

/// Points between two looks at the observer.
const POINTS_PER_LOOK: usize = 1 << 10;

/// Adds points, each at the centre of the largest empty circle, until there are `n`; returns the
/// radius of the last circle that was filled, infinite if none was.
///
/// Afterwards no two of the added points, and no added and old one, are nearer to each other than
/// that radius, and no place is farther from all points. O(n log n).
pub(crate) fn fill_holes(
    points: &mut Vec<DVec2>,
    n: usize,
    observer: &dyn Observer,
) -> Result<f64, SampleError> {
    let mut filled = f64::INFINITY;
    if points.len() >= n {
        return Ok(filled);
    }
    let set = PointSet::new(std::mem::take(points)).expect("points of the unit torus");
    let mut triangulation = Triangulation::new(&set);
    *points = set.into_points();
    let mut holes = EmptyCircles::new(&triangulation);
    while points.len() < n {
        if points.len().is_multiple_of(POINTS_PER_LOOK) {
            let progress = Progress::new("filling holes", points.len() as u64, Some(n as u64));
            observe(observer, &progress)?;
        }
        let face = holes.largest().expect("a triangulation of a point has faces");
        let circle = triangulation.circumcircle(face);
        let centre = torus::wrap_point(circle.center);
        triangulation.insert_near(points.len(), centre, face);
        holes.update(&triangulation);
        points.push(centre);
        filled = circle.radius();
    }
    Ok(filled)
}
