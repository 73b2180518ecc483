//! The power of patterns by frequency, from measurement or from a formula.

use bn_core::{DVec2, PointSet};
use bn_spectral::{NufftError, Periodogram, PeriodogramOptions, RadialPower};

/// The power spectrum of a tiled point set without its peak at 0, P(k) at the integer wave vectors
/// |kx|, |ky| ≤ K in cycles per *tile*; 1 beyond. Normalised so that independent points have P = 1
/// (the thesis's P̌(ν) is n times that).
///
/// 8·(K + 1)(2K + 1) bytes.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct PatternPower {
    points: usize,
    max_frequency: usize,
    /// ky = −K … K of kx = 0, then those of kx = 1, …
    power: Vec<f64>,
}

impl PatternPower {
    /// The mean periodogram of sets of equally many points, up to K = `max_frequency`; 4√n is
    /// enough for most patterns to have become white. P is good to 1e-6 of the largest.
    ///
    /// # Errors
    /// If the periodogram can't be planned for.
    ///
    /// # Panics
    /// If there is no set, or they differ in size.
    pub fn of(sets: &[PointSet], max_frequency: usize) -> Result<Self, NufftError> {
        let points = common_size(sets);
        let measured = Periodogram::of(sets, PeriodogramOptions::new(max_frequency))?;
        let at = |kx: usize, ky: i64| measured.power(kx as i64, ky);
        Ok(Self::tabulated(points, max_frequency, at))
    }

    /// The same without directions: each mode has the mean of its ring, interpolated.
    ///
    /// # Errors
    /// If the periodogram can't be planned for.
    ///
    /// # Panics
    /// If there is no set, or they differ in size.
    pub fn radial(sets: &[PointSet], max_frequency: usize) -> Result<Self, NufftError> {
        let points = common_size(sets);
        // The corners of the square lie beyond K.
        let reach = (max_frequency as f64 * std::f64::consts::SQRT_2).ceil() as usize;
        let rings = RadialPower::of(sets, PeriodogramOptions::new(reach))?;
        let curve = rings.curve();
        let power = |k: DVec2| curve.as_ref().map_or(1.0, |curve| curve.interpolate(k.length()));
        Ok(Self::from_fn(points, max_frequency, power))
    }

    /// The power by a formula: `power` of a wave vector in cycles per tile.
    ///
    /// ```
    /// use bn_render::PatternPower;
    /// use bn_spectral::JitteredGrid;
    ///
    /// let grid = JitteredGrid::new(32);
    /// let power = PatternPower::from_fn(1024, 128, |k| grid.power(k.x, k.y));
    /// assert!(power.power(3, -4) < 0.1 && power.power(60, 90) > 0.9);
    /// ```
    ///
    /// # Panics
    /// If `points` is 0.
    pub fn from_fn(points: usize, max_frequency: usize, power: impl Fn(DVec2) -> f64) -> Self {
        assert!(points > 0, "a pattern has points");
        let at = |kx: usize, ky: i64| power(DVec2::new(kx as f64, ky as f64));
        Self::tabulated(points, max_frequency, at)
    }

    fn tabulated(points: usize, limit: usize, power: impl Fn(usize, i64) -> f64) -> Self {
        let rows = -(limit as i64)..=limit as i64;
        let column = |kx: usize| rows.clone().map(move |ky| (kx, ky));
        let mut power: Vec<f64> =
            (0..=limit).flat_map(column).map(|(kx, ky)| power(kx, ky)).collect();
        power[limit] = 0.0;
        Self { points, max_frequency: limit, power }
    }

    /// Points of the set.
    pub fn points(&self) -> usize {
        self.points
    }

    /// K.
    pub fn max_frequency(&self) -> usize {
        self.max_frequency
    }

    /// P(k), 1 beyond K; 0 at the mode 0.
    pub fn power(&self, kx: i64, ky: i64) -> f64 {
        let limit = self.max_frequency as i64;
        if kx.unsigned_abs().max(ky.unsigned_abs()) > limit.unsigned_abs() {
            return 1.0;
        }
        let (kx, ky) = if kx < 0 { (-kx, -ky) } else { (kx, ky) };
        self.power[(kx * (2 * limit + 1) + ky + limit) as usize]
    }

    /// P between the modes, bilinearly; the mode 0 counts as the mean of its four neighbours, so
    /// that the peak which was left out leaves no hole.
    pub fn interpolated(&self, k: DVec2) -> f64 {
        let corner = k.floor();
        let t = k - corner;
        let (kx, ky) = (corner.x as i64, corner.y as i64);
        let at = |dx: i64, dy: i64| match (kx.saturating_add(dx), ky.saturating_add(dy)) {
            (0, 0) => 0.5 * (self.power(1, 0) + self.power(0, 1)),
            (kx, ky) => self.power(kx, ky),
        };
        let row = |dy: i64| at(0, dy) * (1.0 - t.x) + at(1, dy) * t.x;
        row(0) * (1.0 - t.y) + row(1) * t.y
    }

    /// P − 1 at ky = −K … K of column kx ≥ 0; −1 at the mode 0.
    pub(super) fn excess_column(&self, kx: usize) -> impl Iterator<Item = f64> {
        let side = 2 * self.max_frequency + 1;
        self.power[kx * side..][..side].iter().map(|p| p - 1.0)
    }
}

fn common_size(sets: &[PointSet]) -> usize {
    let points = sets.first().expect("a spectrum needs a set").len();
    assert!(sets.iter().all(|set| set.len() == points), "the sets differ in size");
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::Seed;
    use rand::RngExt;

    fn random_sets(n: usize, count: u32) -> Vec<PointSet> {
        let set = |i: u32| {
            let mut rng = Seed::new(5).for_set(i).stream(0);
            let points = (0..n).map(|_| DVec2::new(rng.random(), rng.random())).collect();
            PointSet::new(points).expect("a set")
        };
        (0..count).map(set).collect()
    }

    #[test]
    fn power_is_that_of_the_periodogram_and_white_beyond() {
        let sets = random_sets(100, 3);
        let power = PatternPower::of(&sets, 12).expect("small");
        let direct = Periodogram::of(&sets, PeriodogramOptions::new(12)).expect("small");
        for (kx, ky) in [(3, -7), (-3, 7), (0, 1), (12, 12), (-12, 5)] {
            assert_eq!(power.power(kx, ky), direct.power(kx, ky));
            assert_eq!(power.interpolated(DVec2::new(kx as f64, ky as f64)), power.power(kx, ky));
        }
        assert_eq!(power.power(0, 0), 0.0);
        assert_eq!(power.power(13, 0), 1.0);
        assert_eq!(power.interpolated(DVec2::new(1e300, -1e300)), 1.0);
        assert_eq!((power.power(0, i64::MIN), power.power(i64::MIN, 0)), (1.0, 1.0));
        assert_eq!(power.interpolated(DVec2::new(0.0, -1e19)), 1.0);
        let hole = power.interpolated(DVec2::ZERO);
        assert_eq!(hole, 0.5 * (power.power(1, 0) + power.power(0, 1)));
        assert_eq!((power.points(), power.max_frequency()), (100, 12));
    }

    #[test]
    fn rings_have_the_mean_of_their_modes() {
        let sets = random_sets(64, 40);
        let power = PatternPower::radial(&sets, 10).expect("small");
        assert_eq!(power.power(3, 4), power.power(-5, 0));
        // About 2π·10 modes in 40 sets: a standard error of 0.03.
        assert!((power.power(0, 10) - 1.0).abs() < 0.15, "{}", power.power(0, 10));
    }

    #[test]
    #[should_panic(expected = "differ in size")]
    fn sets_of_different_sizes_have_no_mean() {
        let sets = [random_sets(3, 1), random_sets(4, 1)].concat();
        let _ = PatternPower::of(&sets, 2);
    }
}
