//! The circle through three points.

use bn_core::DVec2;

use crate::predicates::cross_exactly;

/// A circle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Circle {
    /// Its centre.
    pub center: DVec2,
    /// Its squared radius.
    pub radius_squared: f64,
}

impl Circle {
    /// The circle through the corners of a triangle, given counter-clockwise: its area must be
    /// positive and its corners or their differences those of a [`Triangulation`](crate::Triangulation)'s
    /// points. The relative error of the squared radius is below 4e-13, however flat the triangle is,
    /// and some 1e-15 unless it is.
    #[inline]
    pub fn through(corners: [DVec2; 3]) -> Self {
        circumcircle(corners)
    }

    /// Its radius.
    pub fn radius(&self) -> f64 {
        self.radius_squared.sqrt()
    }
}

/// Squared sine of the angle at a corner below which area and centre would cancel.
const FLAT: f64 = 1e-6;

/// The circle through the corners of a triangle of positive area on the coordinate grid.
///
/// The relative error of the squared radius is below 4e-13, however flat the triangle is, and some
/// 1e-15 unless it is: where the sine of the angle at the first corner is below a thousandth, the
/// area is taken exactly and from the corner with the widest angle. Inlined, so that who needs the
/// radius alone does not pay for the centre.
#[inline]
pub fn circumcircle([a, b, c]: [DVec2; 3]) -> Circle {
    let (u, v) = (b - a, c - a);
    let (u2, v2) = (u.length_squared(), v.length_squared());
    let area = u.x * v.y - u.y * v.x;
    if area * area > FLAT * (u2 * v2) {
        through_origin(a, u, v, area)
    } else {
        circumcircle_of_sliver([a, b, c])
    }
}

/// The circle through `origin`, origin + u and origin + v, given u × v.
#[inline]
fn through_origin(origin: DVec2, u: DVec2, v: DVec2, cross: f64) -> Circle {
    let w = (u * v.length_squared() - v * u.length_squared()) * (0.5 / cross);
    let center = origin + DVec2::new(-w.y, w.x);
    Circle { center, radius_squared: radius_squared(u, v, cross) }
}

/// The product of the sides over four times the area, squared.
#[inline]
fn radius_squared(u: DVec2, v: DVec2, cross: f64) -> f64 {
    let sides = u.length_squared() * v.length_squared() * (v - u).length_squared();
    sides / (4.0 * (cross * cross))
}

#[cold]
fn circumcircle_of_sliver(corners: [DVec2; 3]) -> Circle {
    let side = |i: usize| corners[(i + 2) % 3] - corners[(i + 1) % 3];
    let mut apex = 0;
    for i in 1..3 {
        if side(i).length_squared() > side(apex).length_squared() {
            apex = i;
        }
    }
    let u = corners[(apex + 1) % 3] - corners[apex];
    let v = corners[(apex + 2) % 3] - corners[apex];
    through_origin(corners[apex], u, v, cross_exactly(u, v))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(k: f64) -> f64 {
        k / (1_u64 << 50) as f64
    }

    #[test]
    fn known_circles() {
        let at = DVec2::new;
        let circle = circumcircle([at(0.25, 0.25), at(0.75, 0.25), at(0.25, 0.75)]);
        assert_eq!(circle, Circle { center: at(0.5, 0.5), radius_squared: 0.125 });
        // Needles and flat triangles, exact up to rounding: (−s, 0), (s, 0), (0, h) have the
        // radius (s² + h²)/2h and the centre (0, h − r).
        for (s, h) in [(unit(1.0), 0.5), (0.25, unit(3e12)), (unit(4.0), unit(1.0)), (0.4, 0.1)] {
            let r = (s * s + h * h) / (2.0 * h);
            let corners = [at(-s, 0.0), at(s, 0.0), at(0.0, h)];
            for turn in 0..3 {
                let circle = circumcircle([0, 1, 2].map(|i| corners[(i + turn) % 3]));
                assert!((circle.radius() / r - 1.0).abs() < 1e-13, "{circle:?}, radius {r}");
                assert!((circle.center - at(0.0, h - r)).length() < 1e-13 * (r + s + h));
            }
        }
    }
}
