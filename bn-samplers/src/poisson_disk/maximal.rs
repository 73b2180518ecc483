//! Maximal Poisson disk sampling: dart throwing until nothing is free.

use bn_core::{Density, NormalizedDistance, Observer, PointSet, Seed};

use super::dart_throwing::JAMMING;
use super::thrower::{Ending, Thrower};
use crate::error::check_count;
use crate::{
    CountRule, DefaultValue, Method, OptionKind, OptionSpec, PointOrder, Report, Sample,
    SampleError, Sampler,
};

/// Dart throwing until provably no point is left that is as far as `radius` from all others, so
/// that `R_c` < radius ≤ `d_min`.
///
/// The radius is in units of `d_hex` of the n asked for, and the count follows from it: about
/// n·(0.7766/radius)² with a standard deviation of 0.245·√count. Thesis §4.1.2; M. S. Ebeida et
/// al., "A simple algorithm for maximal Poisson-disk sampling in high dimensions", Computer
/// Graphics Forum 31(2), 2012. (The thesis's condition speaks of the circle's diameter; it is the
/// radius of the largest empty circle that has to be below `d_min`.)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaximalPoissonDisk {
    /// The smallest distance, from 0.1 to 2 `d_hex`.
    pub radius: NormalizedDistance,
}

impl Default for MaximalPoissonDisk {
    fn default() -> Self {
        Self { radius: NormalizedDistance::new(JAMMING) }
    }
}

/// The registry's entry.
pub(crate) const METHOD: Method = Method {
    name: "maximal-poisson-disk",
    aliases: &["mps", "maximal"],
    summary: "dart throwing until no room is left; about n points",
    page: Some(52),
    citation: "M. S. Ebeida et al., A simple algorithm for maximal Poisson-disk sampling in high dimensions, Comput. Graph. Forum 31(2), 2012",
    complexity: "O(n)",
    order: PointOrder::Arrival,
    counts: CountRule::Approximate,
    seeded: true,
    options: &[OptionSpec {
        name: "radius",
        kind: OptionKind::Real { min: SMALLEST, max: LARGEST },
        default: DefaultValue::Value("0.7766"),
        help: "smallest distance of two points; the count follows from it",
        unit: "d_hex",
    }],
    build: |options| {
        let defaults = MaximalPoissonDisk::default();
        let radius = options.real("radius").map_or(defaults.radius, NormalizedDistance::new);
        Ok(Box::new(MaximalPoissonDisk { radius }))
    },
    version: 1,
};

/// The smallest radius in `d_hex`: 60 points for each one asked for.
const SMALLEST: f64 = 0.1;
/// The largest radius in `d_hex`: a seventh of the points asked for.
const LARGEST: f64 = 2.0;

impl Sampler for MaximalPoissonDisk {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        check_count(METHOD.name, n)?;
        let normalized = self.radius;
        if !(SMALLEST..=LARGEST).contains(&normalized.value()) {
            let reason =
                format!("{normalized} is not a distance from {SMALLEST} to {LARGEST} d_hex");
            return Err(SampleError::InvalidOption { option: "radius", reason });
        }
        let expected = n as f64 * (JAMMING / normalized.value()).powi(2);
        if expected > PointSet::MAX_POINTS as f64 {
            let reason = format!("{normalized} d_hex would make about {expected:.0} points");
            return Err(SampleError::InvalidOption { option: "radius", reason });
        }
        let radius = normalized.to_unit_lengths(Density::new(n));
        let mut thrower = Thrower::new(radius, expected as usize, seed)?;
        let ending = thrower.throw(None, observer)?;
        let unresolved = if let Ending::Full { unresolved } = ending { unresolved } else { 0 };
        let count = thrower.points().len();
        let report = Report::new()
            .with("points", count)
            .with("radius_d_hex", normalized.value())
            .with("darts", thrower.darts())
            .with("unresolved_squares", unresolved)
            .with_note(format!("made {count} points"));
        Ok(Sample::new(thrower.into_points(), report))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::{DVec2, Unobserved, torus};

    fn nearest_two(points: &[DVec2], p: DVec2) -> [f64; 2] {
        points.iter().fold([f64::INFINITY; 2], |[first, second], &q| {
            let d = torus::distance(p, q);
            if d < first { [d, first] } else { [first, d.min(second)] }
        })
    }

    /// The largest distance of any place on the torus from its nearest point lies below a bound
    /// from a lattice of probes: the distance is 1-Lipschitz.
    #[test]
    fn nothing_is_free() {
        for (n, radius) in [(1, 0.7), (1, 0.3), (2, 0.63), (3, 0.5), (40, 0.7766), (60, 1.3)] {
            let method = MaximalPoissonDisk { radius: NormalizedDistance::new(radius) };
            for seed in 0..5 {
                let sample = method.sample(n, Seed::new(seed), &Unobserved).expect("valid");
                assert_eq!(sample.report.get("unresolved_squares"), Some(0_u64.into()));
                let points = sample.points.points();
                let r = radius * Density::new(n).hexagonal_spacing();
                for &p in points {
                    let [own, other] = nearest_two(points, p);
                    assert!(own == 0.0 && other >= r, "{other} < {r}");
                }
                let probes = 300;
                let slack = 0.5_f64.sqrt() / f64::from(probes);
                for i in 0..probes * probes {
                    let at = |k: i32| (f64::from(k) + 0.5) / f64::from(probes);
                    let probe = DVec2::new(at(i % probes), at(i / probes));
                    let distance = nearest_two(points, probe)[0];
                    assert!(distance < r + slack, "{n} points, seed {seed}: {distance} at {probe}");
                }
            }
        }
    }

    #[test]
    fn the_count_follows_from_the_radius() {
        for radius in [0.5, 0.7766, 1.0] {
            let method = MaximalPoissonDisk { radius: NormalizedDistance::new(radius) };
            let n = 20_000;
            let sample = method.sample(n, Seed::new(2), &Unobserved).expect("valid");
            let expected = n as f64 * (JAMMING / radius).powi(2);
            let error = sample.points.len() as f64 - expected;
            // Five standard deviations, and 0.1 % for the constant's own rounding.
            assert!(error.abs() < 5.0 * 0.245 * expected.sqrt() + 1e-3 * expected, "{error}");
        }
        let wide = MaximalPoissonDisk { radius: NormalizedDistance::new(0.1) };
        let error = wide.sample(1 << 28, Seed::new(1), &Unobserved).expect_err("too many");
        assert!(error.is_usage(), "{error}");
    }
}
