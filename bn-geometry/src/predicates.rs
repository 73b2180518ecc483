//! Exact signs of the orientation and in-circle determinants, and the grid that makes them cheap.
//!
//! Coordinates are rounded once to multiples of 2⁻⁵⁰. Sums of such coordinates with small integers
//! and differences of such sums are then exact in f64, so that a predicate only has to evaluate a
//! polynomial: in f64 with an error bound, and where that leaves the sign open (about never on
//! random points, always on lattices) in integers of 128 and 256 bits.

use bn_core::DVec2;

/// Vectors handed to the predicates are whole multiples of 1/`UNITS` of size below 8.
const UNITS: f64 = (1_u64 << 50) as f64;

/// The nearest point of the coordinate grid, modulo 1; moves a point of [0, 1)² by at most 2⁻⁵¹ in
/// each coordinate.
#[inline]
pub fn snap(p: DVec2) -> DVec2 {
    DVec2::new(snap_coordinate(p.x), snap_coordinate(p.y))
}

#[inline]
fn snap_coordinate(x: f64) -> f64 {
    // In [4, 8) the spacing of f64 is 2⁻⁵⁰; the subtraction is exact.
    let snapped = (x + 4.0) - 4.0;
    if snapped >= 1.0 { 0.0 } else { snapped }
}

/// u × v, with exact sign: positive if v points to the left of u.
#[inline]
pub fn cross(u: DVec2, v: DVec2) -> f64 {
    // Two products and a difference: error below 3·2⁻⁵³ (|left| + |right|).
    const BOUND: f64 = 2.0 * f64::EPSILON;
    let (left, right) = (u.x * v.y, u.y * v.x);
    let det = left - right;
    if det.abs() >= BOUND * (left.abs() + right.abs()) { det } else { cross_exactly(u, v) }
}

/// u × v of grid vectors, rounded once.
#[cold]
pub fn cross_exactly(u: DVec2, v: DVec2) -> f64 {
    Units::new(u).cross(Units::new(v)) as f64 / (UNITS * UNITS)
}

/// The angle at a point from one vector to another: |u||v| times its cosine and its sine.
#[derive(Clone, Copy, Debug)]
pub struct Angle {
    dot: f64,
    cross: f64,
}

impl Angle {
    /// The angle from u counter-clockwise to v.
    #[inline]
    pub fn between(u: DVec2, v: DVec2) -> Self {
        Self { dot: u.dot(v), cross: u.perp_dot(v) }
    }

    /// The angle from v to u.
    #[inline]
    pub fn reversed(self) -> Self {
        Self { dot: self.dot, cross: -self.cross }
    }

    /// At least |u||v|, up to rounding.
    #[inline]
    fn size(self) -> f64 {
        self.dot.abs() + self.cross.abs()
    }

    /// The angle from any vector to itself.
    pub const ZERO: Self = Self { dot: 1.0, cross: 0.0 };

    /// Whether the angle lies in (0, π), where this is sure to be told from (−π, 0).
    #[inline]
    pub fn is_left(self) -> Sign {
        // Dot and cross product have errors below 2·2⁻⁵³ |u||v|.
        const BOUND: f64 = 2.0 * f64::EPSILON;
        Sign { is_positive: self.cross > 0.0, is_sure: self.cross.abs() > BOUND * self.size() }
    }
}

/// The sign of a number that was computed with rounding.
#[derive(Clone, Copy, Debug)]
pub struct Sign {
    /// The sign of the number as computed.
    pub is_positive: bool,
    /// Whether it is that of the exact number.
    pub is_sure: bool,
}

impl Sign {
    /// Whether the exact number is positive; asks `exactly` where rounding leaves that open.
    #[inline]
    pub fn or_else(self, exactly: impl FnOnce() -> bool) -> bool {
        if self.is_sure { self.is_positive } else { exactly() }
    }
}

/// Whether q lies inside the circle through u, v and p, which turn counter-clockwise, given the
/// angle at p from u to v and the angle at q from v to u: whether they add up to more than π, or,
/// with p and q on the same side, the one at q is the larger.
#[inline]
pub fn is_inside(at_p: Angle, at_q: Angle) -> Sign {
    // The products have errors below 4·2⁻⁵³ of the product of sizes by those of the factors and
    // 2·2⁻⁵³ by their own rounding and that of the sum.
    const BOUND: f64 = 5.0 * f64::EPSILON;
    let sine = at_p.cross * at_q.dot + at_p.dot * at_q.cross;
    let is_sure = sine.abs() > BOUND * (at_p.size() * at_q.size());
    Sign { is_positive: sine < 0.0, is_sure }
}

/// Whether the origin lies inside the circle through a, b, c, which turn counter-clockwise.
///
/// An origin on the circle counts as inside or outside by the *perturbed* metric
/// x² + y² + ε·xy + ε²·x² with infinitesimal ε > 0. It decides every case, because the affine
/// dependence of four points in convex position is orthogonal to at most some but never to all
/// quadratic forms. A metric is the same everywhere, so cocircular points are triangulated alike
/// wherever they lie, in whatever order they come, and there is exactly one triangulation in which
/// no point lies inside the circle of a triangle.
#[inline]
pub fn in_circle(a: DVec2, b: DVec2, c: DVec2) -> bool {
    let inside = is_inside(Angle::between(a - c, b - c), Angle::between(b, a));
    inside.or_else(|| in_circle_exactly(a, b, c))
}

/// [`in_circle`] in integers.
#[cold]
pub fn in_circle_exactly(a: DVec2, b: DVec2, c: DVec2) -> bool {
    let points = [Units::new(a), Units::new(b), Units::new(c)];
    let [a, b, c] = points;
    let weights = [b.cross(c), c.cross(a), a.cross(b)];
    let det = |form: fn(Units) -> i128| {
        let mut sum = Wide::ZERO;
        for (weight, point) in weights.into_iter().zip(points) {
            sum = sum.plus(Wide::product(weight, form(point)));
        }
        sum.signum()
    };
    let sign = match det(|p| p.x * p.x + p.y * p.y) {
        0 => match det(|p| p.x * p.y) {
            0 => det(|p| p.x * p.x),
            sign => sign,
        },
        sign => sign,
    };
    sign > 0
}

/// A vector in units of the grid: below 2⁵³ in size, so that products take 106 bits.
#[derive(Clone, Copy)]
struct Units {
    x: i128,
    y: i128,
}

impl Units {
    fn new(v: DVec2) -> Self {
        let exact = |x: f64| {
            debug_assert!(x.abs() < 8.0 && (x * UNITS).fract() == 0.0, "{x} is off the grid");
            i128::from((x * UNITS) as i64)
        };
        Self { x: exact(v.x), y: exact(v.y) }
    }

    fn cross(self, other: Self) -> i128 {
        self.x * other.y - self.y * other.x
    }
}

/// A 256-bit integer in two's complement.
#[derive(Clone, Copy)]
struct Wide {
    high: i128,
    low: u128,
}

impl Wide {
    const ZERO: Self = Self { high: 0, low: 0 };

    /// a·b, for factors below 2¹²⁰ in size.
    fn product(a: i128, b: i128) -> Self {
        const HALF: u32 = 64;
        const MASK: u128 = u64::MAX as u128;
        let (p, q) = (a.unsigned_abs(), b.unsigned_abs());
        let (p1, p0, q1, q0) = (p >> HALF, p & MASK, q >> HALF, q & MASK);
        let (low, middle) = (p0 * q0, p1 * q0 + p0 * q1);
        let (low, carry) = low.overflowing_add(middle << HALF);
        let high = p1 * q1 + (middle >> HALF) + u128::from(carry);
        let magnitude = Self { high: high as i128, low };
        if (a < 0) == (b < 0) { magnitude } else { magnitude.negated() }
    }

    fn negated(self) -> Self {
        let (low, carry) = (!self.low).overflowing_add(1);
        Self { high: !self.high + i128::from(carry), low }
    }

    fn plus(self, other: Self) -> Self {
        let (low, carry) = self.low.overflowing_add(other.low);
        Self { high: self.high + other.high + i128::from(carry), low }
    }

    fn signum(self) -> i32 {
        match self.high {
            0 => i32::from(self.low != 0),
            high => high.signum() as i32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::Seed;
    use proptest::prelude::*;
    use rand::RngExt;
    use robust::Coord;

    fn coord(v: DVec2) -> Coord<f64> {
        Coord { x: v.x, y: v.y }
    }

    fn grid_vector() -> impl Strategy<Value = DVec2> {
        let small = -3_i64..=3;
        let step = prop_oneof![Just(1_i64), Just(1 << 25), Just(1 << 50)];
        let near = (small.clone(), small, step).prop_map(|(x, y, s)| (x * s, y * s));
        let any = (-(1_i64 << 51)..1 << 51, -(1_i64 << 51)..1 << 51);
        prop_oneof![near, any].prop_map(|(x, y)| DVec2::new(x as f64 / UNITS, y as f64 / UNITS))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn cross_has_the_sign_of_robust(u in grid_vector(), v in grid_vector()) {
            let want = robust::orient2d(coord(DVec2::ZERO), coord(u), coord(v));
            prop_assert_eq!(cross(u, v).partial_cmp(&0.0), want.partial_cmp(&0.0));
        }

        #[test]
        fn in_circle_has_the_sign_of_robust(
            a in grid_vector(), b in grid_vector(), c in grid_vector()
        ) {
            let (b, c) = if cross(b - a, c - a) < 0.0 { (c, b) } else { (b, c) };
            let want = robust::incircle(coord(a), coord(b), coord(c), coord(DVec2::ZERO));
            prop_assert_eq!(in_circle_exactly(a, b, c), in_circle(a, b, c));
            prop_assert!(want == 0.0 || in_circle(a, b, c) == (want > 0.0));
        }

        #[test]
        fn wide_arithmetic_agrees_modulo_a_prime(a in any::<i128>(), b in any::<i128>()) {
            let (a, b) = (a >> 8, b >> 8);
            let modulus = 1_000_000_007_i128;
            let residue = |w: Wide| {
                // 2¹²⁸ modulo the prime.
                let scale = ((u128::MAX % modulus as u128) as i128 + 1) % modulus;
                let low = (w.low % modulus as u128) as i128;
                (w.high.rem_euclid(modulus) * scale + low).rem_euclid(modulus)
            };
            let product = Wide::product(a, b);
            let want = a.rem_euclid(modulus) * b.rem_euclid(modulus) % modulus;
            prop_assert_eq!(residue(product), want);
            prop_assert_eq!(product.signum(), (a.signum() * b.signum()) as i32);
            prop_assert_eq!(product.plus(product.negated()).signum(), 0);
        }
    }

    #[test]
    fn near_cocircular_points_get_exact_signs() {
        // Points of a lattice circle moved by single grid units: f64 alone can't tell.
        let mut rng = Seed::new(1).stream(0);
        let on_circle = [(5, 0), (3, 4), (-4, 3), (0, -5), (4, -3), (-3, -4), (4, 3), (-5, 0)];
        let mut undecided = 0;
        for _ in 0..20_000 {
            let mut p = [0, 1, 2, 3].map(|_| {
                let (x, y) = on_circle[rng.random_range(0..8_usize)];
                let jitter = |rng: &mut bn_core::StreamRng| f64::from(rng.random_range(-1..=1));
                let unit = DVec2::new(jitter(&mut rng), jitter(&mut rng)) / UNITS;
                DVec2::new(f64::from(x), f64::from(y)) / 8.0 + unit
            });
            match cross(p[1] - p[0], p[2] - p[0]) {
                0.0 => continue,
                area if area < 0.0 => p.swap(1, 2),
                _ => {}
            }
            let want = robust::incircle(coord(p[0]), coord(p[1]), coord(p[2]), coord(p[3]));
            let got = in_circle(p[0] - p[3], p[1] - p[3], p[2] - p[3]);
            if want == 0.0 {
                undecided += 1;
            } else {
                assert_eq!(got, want > 0.0, "{p:?}");
            }
        }
        assert!(undecided < 10_000, "{undecided} cases tell nothing");
    }

    #[test]
    fn cocircular_points_are_decided_one_way() {
        // Of the two diagonals of a convex cocircular quadrilateral exactly one is chosen.
        let on_circle = [(5, 0), (4, 3), (3, 4), (0, 5), (-3, 4), (-4, 3), (-5, 0), (0, -5)];
        let at = |i: usize| DVec2::new(f64::from(on_circle[i].0), f64::from(on_circle[i].1)) / 8.0;
        for i in 0..8 {
            for j in i + 1..8 {
                for k in j + 1..8 {
                    for l in k + 1..8 {
                        let inside =
                            |a, b, c, p| in_circle(at(a) - at(p), at(b) - at(p), at(c) - at(p));
                        let first = inside(i, j, k, l);
                        assert_eq!(inside(k, l, i, j), first, "the same diagonal {i}-{k}");
                        assert_eq!(inside(j, k, l, i), !first, "the other diagonal {j}-{l}");
                        assert_eq!(inside(l, i, j, k), !first);
                    }
                }
            }
        }
    }

    #[test]
    fn snapping_moves_little_and_stays_in_the_square() {
        let mut rng = Seed::new(2).stream(0);
        for _ in 0..1000 {
            let p = DVec2::new(rng.random(), rng.random());
            let moved = bn_core::torus::delta(p, snap(p));
            assert!(moved.abs().max_element() <= 0.5 / UNITS);
            assert_eq!((snap(p) * UNITS).fract(), DVec2::ZERO);
        }
        let last = bn_core::torus::ONE_MINUS_EPSILON;
        assert_eq!(snap(DVec2::new(last, 1e-300)), DVec2::ZERO);
    }
}
