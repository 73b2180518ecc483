//! Closing the holes that optimised patterns keep.

use bn_core::{DVec2, Density, PointSet, torus};
use bn_geometry::{Circle, Coverage, Face, Spacing, Triangulation};

/// The radius of the largest hole that may stay, and the distance that no two points may fall below,
/// over `d_hex`. A regular pentagon of points 0.9 apart has the radius 0.766: rings of five points, of
/// which nearly all holes of an optimised pattern consist, leave no room for much less.
const HOLE: f64 = 0.76;
const SPACING: f64 = 0.9;

/// What forces aim at lies beyond the goal by this factor, so that the goal is reached in finite time.
const BEYOND: f64 = 1.006;

/// The part of the way that a point goes at a time towards the middle of a hole, and from another
/// point. With these, patterns of 1024 to 65,536 points take some 20 steps.
const PULL: f64 = 0.3;
const PUSH: f64 = 0.25;

/// The most steps.
const STEPS: u32 = 300;

/// What became of a pattern's holes. Lengths are in `d_hex`.
#[derive(Clone, Debug)]
pub(super) struct Plugged {
    pub(super) points: Vec<DVec2>,
    pub(super) steps: u32,
    /// `d_min` and `d_avg`.
    pub(super) distances: [f64; 2],
    /// The radius of the largest hole that is left.
    pub(super) hole: f64,
    /// Whether no hole is left that should be closed.
    pub(super) is_tight: bool,
}

/// Moves the points around large holes inwards, and points apart that come too near to each other
/// by that, until no hole is left: all at a time, O(n) a step. Points elsewhere stay.
pub(super) fn plug(points: Vec<DVec2>) -> Plugged {
    let unit = Density::new(points.len()).hexagonal_spacing();
    let set = PointSet::new(points).expect("points of the unit torus");
    let mut triangulation = Triangulation::new(&set);
    // Who starts with less room keeps that.
    let least = Spacing::of(&triangulation).min().min(SPACING * unit);
    let aim = Aim { hole: HOLE * unit / BEYOND, apart: least * BEYOND };
    let mut ways = vec![DVec2::ZERO; set.len()];
    let mut steps = 0;
    loop {
        let spacing = Spacing::of(&triangulation);
        let hole = Coverage::of(&triangulation).map_or(0.0, |coverage| coverage.radius) / unit;
        let is_tight = hole <= HOLE && spacing.min() >= least;
        if is_tight || steps == STEPS {
            let points = (0..set.len()).map(|i| triangulation.position(i)).collect();
            let distances = [spacing.min() / unit, spacing.mean() / unit];
            return Plugged { points, steps, distances, hole, is_tight };
        }
        ways.fill(DVec2::ZERO);
        for (face, circle) in triangulation.circumcircles() {
            aim.add_ways(&face, circle, &mut ways);
        }
        triangulation.relocate_all(|i, p| torus::wrap_point(p + ways[i]));
        steps += 1;
    }
}

/// Radius and distance to reach.
struct Aim {
    hole: f64,
    apart: f64,
}

impl Aim {
    /// Adds the ways on which a face sends its corners.
    fn add_ways(&self, face: &Face, circle: Circle, ways: &mut [DVec2]) {
        let radius = circle.radius();
        for i in 0..3 {
            let (here, there) = (face.vertices[i], face.vertices[(i + 1) % 3]);
            if radius > self.hole {
                let inwards = circle.center - face.corners[i];
                ways[here] += inwards * (PULL * (1.0 - self.hole / radius));
            }
            let side = face.corners[(i + 1) % 3] - face.corners[i];
            let length = side.length();
            if length < self.apart && length > 0.0 {
                // Half of it from either face at the side.
                let apart = side * (0.5 * PUSH * (self.apart / length - 1.0));
                ways[there] += apart;
                ways[here] -= apart;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, y: f64) -> DVec2 {
        DVec2::new(x, y)
    }

    /// A ring of five points around a hole in a lattice moves inwards, and far points stay.
    #[test]
    fn a_hole_is_closed_by_those_around_it() {
        let side = 24;
        let mut points: Vec<DVec2> = (0..side * side)
            .map(|i| at(f64::from(i % side), f64::from(i / side)) / f64::from(side))
            .collect();
        let centre = at(0.5, 0.5);
        // Stretched around the centre: the lattice's cell there grows into a hole.
        for p in &mut points {
            let way = torus::delta(centre, *p) + at(0.5, 0.5) / f64::from(side);
            let far = way.length() * f64::from(side);
            *p = torus::wrap_point(*p + way * (0.25 * libm::exp(-far * far / 4.0)));
        }
        let unit = Density::new(points.len()).hexagonal_spacing();
        let set = PointSet::new(points.clone()).expect("valid");
        let before = Coverage::of(&Triangulation::new(&set)).expect("points").radius / unit;
        assert!(before > 0.77, "{before}");
        let plugged = plug(points.clone());
        assert!(plugged.is_tight, "{plugged:?}");
        let stayed =
            points.iter().zip(&plugged.points).filter(|(a, b)| torus::distance(**a, **b) < 1e-12);
        assert!(stayed.count() > points.len() / 2);
    }

    #[test]
    fn tight_and_tiny_patterns_stay() {
        for points in [vec![at(0.3, 0.2)], vec![at(0.1, 0.1), at(0.6, 0.6)]] {
            let plugged = plug(points.clone());
            assert_eq!((plugged.steps, plugged.is_tight), (0, true), "{plugged:?}");
            for (a, b) in points.iter().zip(&plugged.points) {
                assert!(torus::distance(*a, *b) < 1e-15);
            }
        }
        // No way to help a heap: an end all the same.
        let heap = plug(vec![at(0.5, 0.5); 30]);
        assert!(!heap.is_tight && heap.points.len() == 30);
    }
}
