//! Dart throwing: random points, each at least a given distance from all earlier ones.

use std::sync::Arc;

use bn_core::{DVec2, Density, DensityFunction, NormalizedDistance, Observer, Progress, Seed};
use rand::RngExt;

use super::thrower::{Ending, Thrower};
use super::uneven::UnevenThrower;
use crate::bucket_grid::BucketGrid;
use crate::common_options::{DENSITY_OPTION, check_range, uneven};
use crate::error::{check_count, observe};
use crate::{
    CountRule, DefaultValue, Method, OptionKind, OptionSpec, PointOrder, Report, Sample,
    SampleError, Sampler,
};

/// Random points, each uniform in what the earlier ones leave free at distance `radius`, until
/// there are exactly n.
///
/// Thesis §2.5 and p. 109; R. L. Cook, "Stochastic sampling in computer graphics", ACM Trans.
/// Graph. 5(1), 1986. No dart is wasted on what is known to be covered, which changes nothing in
/// the distribution, so that even the last points before the torus is full take O(1) time.
///
/// When the torus is full, 0.6965/r² points (r in unit lengths) fit on average: with a radius of
/// 0.7766 `d_hex` just about n. [`DartThrowing::reliable_radius`] stays below it by six
/// standard deviations of that number; beyond, the method may end with an error that tells the
/// count reached.
///
/// With a density ρ, darts are thrown by it, and two points keep the distance r/√ρ with the larger of the
/// densities at both. By default r shrinks by 1 % where fewer than one dart in 200 sticks, so that there
/// will be n (`McCool` and Fiume, "Hierarchical Poisson disk sampling distributions", Graphics Interface
/// 1992); a radius that is given stays. One thread does this, at some µs a dart.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DartThrowing {
    /// The smallest distance, from 0 to 2 `d_hex`; by default [`DartThrowing::reliable_radius`].
    /// Where there is a density, where it is the mean.
    pub radius: Option<NormalizedDistance>,
    /// The density of the points, uniform if there is none.
    pub density: Option<Arc<DensityFunction>>,
}

/// The registry's entry.
pub(crate) const METHOD: Method = Method {
    name: "dart-throwing",
    aliases: &["dart", "poisson-disk"],
    summary: "random points that keep a minimum distance",
    page: Some(109),
    citation: "R. L. Cook, Stochastic sampling in computer graphics, ACM Trans. Graph. 5(1), 1986",
    complexity: "O(n)",
    order: PointOrder::Arrival,
    counts: CountRule::Any,
    seeded: true,
    options: &[
        OptionSpec {
            name: "radius",
            kind: OptionKind::Real { min: 0.0, max: LARGEST },
            default: DefaultValue::Absent(
                "the largest that is reliably reached, 0.768 at n = 4096",
            ),
            help: "smallest distance of two points; more than the default may fit fewer than n",
            unit: "d_hex",
        },
        DENSITY_OPTION,
    ],
    build: |options| {
        let radius = options.real("radius").map(NormalizedDistance::new);
        Ok(Box::new(DartThrowing { radius, density: options.density("density") }))
    },
    version: 2,
};

/// The largest radius in `d_hex`; beyond 1 not even the hexagonal lattice has n points.
const LARGEST: f64 = 2.0;

/// The radius in `d_hex` at which the torus is full with n points on average: jamming of random
/// sequential adsorption at the covered fraction 0.547 of disks of half that radius.
pub(super) const JAMMING: f64 = 0.7766;

/// Below this radius in `d_hex` so much stays free that darts may be thrown anywhere.
const SPARSE: f64 = 0.3;

impl DartThrowing {
    /// The largest radius at which n points fit in all but about one of 10⁹ runs:
    /// 0.7766·√(1 − 1.47/√n) `d_hex`, for few points 0.45.
    ///
    /// The number that fits has a standard deviation of 0.245·√n (measured from n = 16 to 10⁵).
    ///
    /// # Panics
    /// If n is 0.
    pub fn reliable_radius(n: usize) -> NormalizedDistance {
        assert!(n > 0, "there is no radius for no point");
        let share = 1.0 - 6.0 * 0.245 / (n as f64).sqrt();
        NormalizedDistance::new(JAMMING * share.max(0.336).sqrt())
    }
}

impl Sampler for DartThrowing {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        check_count(METHOD.name, n)?;
        let normalized = self.radius.unwrap_or_else(|| Self::reliable_radius(n));
        check_range("radius", normalized.value(), 0.0, LARGEST)?;
        let radius = normalized.to_unit_lengths(Density::new(n));
        if let Some(density) = uneven(self.density.as_ref()) {
            let thrower = UnevenThrower::new(&density, n, radius);
            return self.throw_unevenly(thrower, n, seed, observer);
        }
        let report = Report::new().with("radius_d_hex", normalized.value());
        if normalized.value() < SPARSE {
            let (points, darts) = throw_anywhere(n, radius, seed, observer)?;
            return Ok(Sample::new(points, report.with("darts", darts)));
        }
        let mut thrower = Thrower::new(radius, n, seed)?;
        if let Ending::Full { .. } = thrower.throw(Some(n), observer)? {
            return Err(not_reached(n, thrower.points().len()));
        }
        let report = report.with("darts", thrower.darts());
        Ok(Sample::new(thrower.into_points(), report))
    }
}

impl DartThrowing {
    fn throw_unevenly(
        &self,
        mut thrower: UnevenThrower<'_>,
        n: usize,
        seed: Seed,
        observer: &dyn Observer,
    ) -> Result<Sample, SampleError> {
        thrower.throw(n, self.radius.is_none(), seed, observer)?;
        let points = thrower.points();
        if points.len() < n {
            let advice = "hardly a dart keeps the distance; leave out --radius".to_owned();
            let reached = points.len();
            return Err(SampleError::NotReached { method: METHOD.name, n, reached, advice });
        }
        let radius = Density::new(n).normalize_distance(thrower.radius());
        let report =
            Report::new().with("radius_d_hex", radius.value()).with("darts", thrower.darts());
        Ok(Sample::new(points, report))
    }
}

fn not_reached(n: usize, reached: usize) -> SampleError {
    let reliable = DartThrowing::reliable_radius(n);
    let advice = format!(
        "no further point keeps the distance; --radius {:.3} is reliably reached",
        // Rounded down.
        (reliable.value() * 1000.0).floor() / 1000.0
    );
    SampleError::NotReached { method: METHOD.name, n, reached, advice }
}

/// Throws at the whole torus. Of all darts at least 1 − 0.3²·2π/√3 = 67 % hit.
fn throw_anywhere(
    n: usize,
    radius: f64,
    seed: Seed,
    observer: &dyn Observer,
) -> Result<(Vec<DVec2>, u64), SampleError> {
    let mut rng = seed.stream(0);
    let mut grid = BucketGrid::for_points(n);
    let mut darts = 0;
    while grid.points().len() < n {
        if darts % (1 << 16) == 0 {
            let placed = grid.points().len() as u64;
            observe(observer, &Progress::new("throwing darts", placed, Some(n as u64)))?;
        }
        darts += 1;
        let dart = DVec2::new(rng.random(), rng.random());
        if !grid.any_within(dart, radius) {
            grid.insert(dart);
        }
    }
    Ok((grid.into_points(), darts))
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::{Unobserved, torus};

    fn with_radius(radius: NormalizedDistance) -> DartThrowing {
        DartThrowing { radius: Some(radius), density: None }
    }

    fn smallest_distance(points: &[DVec2]) -> f64 {
        let pairs =
            points.iter().enumerate().flat_map(|(i, p)| points[..i].iter().map(move |q| (p, q)));
        pairs.map(|(&p, &q)| torus::distance(p, q)).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn keeps_the_distance_at_every_radius() {
        for n in [2, 3, 10, 300] {
            for radius in [0.0, 0.05, 0.29, 0.31, 0.5] {
                let dart = with_radius(NormalizedDistance::new(radius));
                let set = dart.sample(n, Seed::new(4), &Unobserved).expect("fits").points;
                assert_eq!(set.len(), n);
                let d_min = set.density().normalize_distance(smallest_distance(set.points()));
                assert!(d_min.value() >= radius, "{d_min} of {n} points at {radius}");
            }
        }
    }

    #[test]
    fn default_radius_is_reliable() {
        for n in [1, 2, 3, 4, 5, 6, 8, 13, 20, 50, 200] {
            for seed in 0..200 {
                let result = DartThrowing::default().sample(n, Seed::new(seed), &Unobserved);
                assert_eq!(result.expect("fits").points.len(), n);
            }
        }
    }

    #[test]
    fn tells_the_count_it_reached() {
        let dart = with_radius(NormalizedDistance::new(0.85));
        let error = dart.sample(1000, Seed::new(1), &Unobserved).expect_err("does not fit");
        assert!(!error.is_usage());
        let SampleError::NotReached { reached, .. } = error else { panic!("{error}") };
        // Jamming: 1000·(0.7766/0.85)² = 835 with a standard deviation of 7.
        assert!(reached.abs_diff(835) < 35, "{reached}");
        assert!(error.to_string().contains("--radius 0.758"), "{error}");
        let whole = with_radius(NormalizedDistance::new(f64::NAN));
        assert!(whole.sample(9, Seed::new(1), &Unobserved).expect_err("NaN").is_usage());
    }

    /// Of two points the second is uniform outside the first one's disk, by either way of throwing.
    #[test]
    fn accepted_darts_are_uniform_in_what_is_free() {
        for radius in [0.3, 0.28] {
            let dart = with_radius(NormalizedDistance::new(radius));
            let length = radius * Density::new(2).hexagonal_spacing();
            let runs = 20_000;
            // Rings of equal area between the radius and 1/2, where a disk begins to wrap.
            let mut rings = [0.0; 8];
            let (inner, outer) = (length * length, 0.25);
            for seed in 0..runs {
                let set = dart.sample(2, Seed::new(seed), &Unobserved).expect("fits").points;
                let d2 = torus::distance_squared(set.points()[0], set.points()[1]);
                let ring = (d2 - inner) / (outer - inner) * rings.len() as f64;
                if let Some(count) = rings.get_mut(ring as usize) {
                    *count += 1.0;
                }
            }
            let share =
                std::f64::consts::PI * (outer - inner) / 8.0 / (1.0 - std::f64::consts::PI * inner);
            let expected = share * runs as f64;
            for count in rings {
                // Binomial: at most 5 standard deviations off.
                let sd = (expected * (1.0 - share)).sqrt();
                assert!((count - expected).abs() < 5.0 * sd, "{count}, expected {expected}");
            }
        }
    }
}
