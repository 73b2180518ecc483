//! The metric of the unit torus: [0, 1)² with opposite sides identified.

use glam::DVec2;

/// The largest number below 1: the end of the half-open interval [0, 1).
pub const ONE_MINUS_EPSILON: f64 = 1.0 - f64::EPSILON / 2.0;

/// The largest distance of two points on the unit torus, √½.
pub const DIAMETER: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// The representative of `x` modulo 1 in [0, 1).
///
/// Exact wherever the result is representable; a negative number closer to 0 than 2⁻⁵⁴ lies nearest
/// to 1, that is, to 0. NaN and infinities give NaN.
#[inline]
pub fn wrap(x: f64) -> f64 {
    let fraction = x - x.floor();
    // -1e-17 - floor(-1e-17) rounds to exactly 1, which is the point 0.
    if fraction >= 1.0 { 0.0 } else { fraction }
}

/// [`wrap`] of both coordinates.
#[inline]
pub fn wrap_point(p: DVec2) -> DVec2 {
    DVec2::new(wrap(p.x), wrap(p.y))
}

/// Whether `p` lies in [0, 1)², NaN excluded. −0 counts as 0.
#[inline]
pub fn contains(p: DVec2) -> bool {
    (0.0..1.0).contains(&p.x) && (0.0..1.0).contains(&p.y)
}

/// The shortest representative in [−½, ½] of a difference of coordinates in (−1, 1).
#[inline]
fn shortest(d: f64) -> f64 {
    // Subtractions of nearby numbers: exact (Sterbenz) wherever they change anything.
    if d > 0.5 {
        d - 1.0
    } else if d < -0.5 {
        d + 1.0
    } else {
        d
    }
}

/// The shortest displacement from `from` to `to`, components in [−½, ½]; both points in [0, 1)².
#[inline]
pub fn delta(from: DVec2, to: DVec2) -> DVec2 {
    let d = to - from;
    DVec2::new(shortest(d.x), shortest(d.y))
}

/// The squared torus distance of two points of [0, 1)², in [0, ½].
#[inline]
pub fn distance_squared(a: DVec2, b: DVec2) -> f64 {
    delta(a, b).length_squared()
}

/// The torus distance of two points of [0, 1)², in [0, √½].
#[inline]
pub fn distance(a: DVec2, b: DVec2) -> f64 {
    let d = delta(a, b);
    // Scaled only where squares would underflow: points may be 1e-300 apart.
    if d.x.abs().max(d.y.abs()) < 1e-150 { libm::hypot(d.x, d.y) } else { d.length() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn wrap_is_half_open_at_the_seam() {
        for (x, want) in [
            (0.0, 0.0),
            (1.0, 0.0),
            (-1e-17, 0.0),
            (-1e-300, 0.0),
            (ONE_MINUS_EPSILON, ONE_MINUS_EPSILON),
            (-0.25, 0.75),
            (17.5, 0.5),
            (-1.0, 0.0),
        ] {
            assert_eq!(wrap(x), want, "wrap({x})");
        }
        assert!(wrap(f64::NAN).is_nan() && wrap(f64::INFINITY).is_nan());
    }

    #[test]
    fn tiny_distances_do_not_underflow() {
        let d = distance(DVec2::new(3e-300, 0.0), DVec2::new(0.0, 4e-300));
        assert!((d / 5e-300 - 1.0).abs() < 1e-15, "{d}");
    }

    proptest! {
        #[test]
        fn wrap_lands_in_the_domain(x in -1e6_f64..1e6) {
            let w = wrap(x);
            prop_assert!((0.0..1.0).contains(&w));
            let off = (x - w) - (x - w).round();
            prop_assert!(off.abs() <= 1e-9);
        }

        #[test]
        fn distance_is_the_least_over_nine_copies(
            ax in 0.0..1.0_f64, ay in 0.0..1.0_f64, bx in 0.0..1.0_f64, by in 0.0..1.0_f64,
        ) {
            let (a, b) = (DVec2::new(ax, ay), DVec2::new(bx, by));
            let mut least = f64::INFINITY;
            for i in -1..=1 {
                for j in -1..=1 {
                    least = least.min((b + DVec2::new(f64::from(i), f64::from(j)) - a).length());
                }
            }
            prop_assert!((distance(a, b) - least).abs() < 4e-16);
            prop_assert!(distance(a, b) <= DIAMETER * (1.0 + 1e-15));
            prop_assert_eq!(distance(a, b), distance(b, a));
        }
    }
}
