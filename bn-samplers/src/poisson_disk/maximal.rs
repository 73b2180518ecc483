//! Maximal Poisson disk sampling: dart throwing until nothing is free.

use bn_core::{Density, NormalizedDistance, Observer, PointSet, Seed};

use super::dart_throwing::JAMMING;
use super::thrower::{Ending, Thrower};
use crate::error::check_count;
use crate::farthest_points::fill_holes;
use crate::{
    CountRule, DefaultValue, Method, OptionError, OptionKind, OptionSpec, PointOrder, Report,
    Sample, SampleError, Sampler,
};

/// Dart throwing until provably no point is left that is as far as the radius from all others, so
/// that `R_c` < radius ≤ `d_min`.
///
/// The radius is in units of `d_hex` of the n asked for, and the count follows from it: about
/// n·(0.7766/radius)² with a standard deviation of 0.245·√count. Thesis §4.1.2; M. S. Ebeida et
/// al., "A simple algorithm for maximal Poisson-disk sampling in high dimensions", Computer
/// Graphics Forum 31(2), 2012. (The thesis's condition speaks of the circle's diameter; it is the
/// radius of the largest empty circle that has to be below `d_min`.)
///
/// With `exact`, the radius follows from the count. Disks with room for a few points fewer are
/// thrown first (two standard deviations, 0.8 % at n = 4096). Then the radius shrinks to the
/// distance at which one more point fits, the centre of the largest empty circle; and so on. At
/// each step the pattern is maximal, and the count grows by one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MaximalPoissonDisk {
    /// What is given, and what follows from it.
    pub target: MaximalTarget,
}

/// What is given of a maximal pattern.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MaximalTarget {
    /// The smallest distance, from 0.1 to 2 `d_hex`; the count follows.
    Radius(NormalizedDistance),
    /// The count; the smallest distance follows.
    Count,
}

impl Default for MaximalTarget {
    fn default() -> Self {
        Self::Radius(NormalizedDistance::new(JAMMING))
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
    options: &[
        OptionSpec {
            name: "radius",
            kind: OptionKind::Real { min: SMALLEST, max: LARGEST },
            default: DefaultValue::Absent("0.7766, for about n points"),
            help: "smallest distance of two points; the count follows from it",
            unit: "d_hex",
        },
        OptionSpec {
            name: "exact",
            kind: OptionKind::Flag,
            default: DefaultValue::Value("false"),
            help: "make exactly n points; the radius follows",
            unit: "",
        },
    ],
    build: |options| {
        let target = match (options.real("radius"), options.flag("exact")) {
            (Some(_), true) => {
                let reason = "the radius follows from the count; leave out --radius".to_owned();
                return Err(OptionError::Conflict { option: "exact", reason });
            }
            (None, true) => MaximalTarget::Count,
            (Some(radius), false) => MaximalTarget::Radius(NormalizedDistance::new(radius)),
            (None, false) => MaximalTarget::default(),
        };
        Ok(Box::new(MaximalPoissonDisk { target }))
    },
    version: 2,
};

/// The smallest radius in `d_hex`: 60 points for each one asked for.
const SMALLEST: f64 = 0.1;
/// The largest radius in `d_hex`: a seventh of the points asked for.
const LARGEST: f64 = 2.0;

/// Times that disks are thrown in search of a count.
const ATTEMPTS: u32 = 64;

impl Sampler for MaximalPoissonDisk {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        check_count(METHOD.name, n)?;
        match self.target {
            MaximalTarget::Radius(radius) => with_radius(n, radius, seed, observer),
            MaximalTarget::Count => with_count(n, seed, observer),
        }
    }
}

fn with_radius(
    n: usize,
    normalized: NormalizedDistance,
    seed: Seed,
    observer: &dyn Observer,
) -> Result<Sample, SampleError> {
    if !(SMALLEST..=LARGEST).contains(&normalized.value()) {
        let reason = format!("{normalized} is not a distance from {SMALLEST} to {LARGEST} d_hex");
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
    let count = thrower.points().len();
    let unresolved = unresolved(ending);
    let report = Report::new()
        .with("points", count)
        .with("radius_d_hex", normalized.value())
        .with("darts", thrower.darts())
        .with("unresolved_squares", unresolved)
        .with_note(format!("made {count} points"));
    let report = match unresolved {
        0 => report,
        _ => report.with_note(format!(
            "{unresolved} squares of less than 1e-8 radii may have room for a point"
        )),
    };
    Ok(Sample::new(thrower.into_points(), report))
}

fn with_count(n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
    let density = Density::new(n);
    // Jamming's count and its spread; a single point takes any radius above the torus's diameter.
    let wanted = (n as f64 - 2.0 * 0.245 * (n as f64).sqrt()).max(0.5);
    let mut radius = JAMMING * (n as f64 / wanted).sqrt() * density.hexagonal_spacing();
    for attempt in 1..=ATTEMPTS {
        let mut thrower = Thrower::new(radius, n, seed)?;
        let ending = thrower.throw(None, observer)?;
        let (darts, thrown) = (thrower.darts(), thrower.points().len());
        if thrown > n || unresolved(ending) > 0 {
            // By the spread of counts, less for many points.
            radius *= 1.0 + 0.25 / (n as f64).sqrt();
            continue;
        }
        let mut points = thrower.into_points();
        let filled = fill_holes(&mut points, n, observer)?;
        let reached = density.normalize_distance(filled.min(radius));
        let report = Report::new()
            .with("radius_d_hex", reached.value())
            .with("attempts", u64::from(attempt))
            .with("thrown", thrown)
            .with("darts", darts);
        return Ok(Sample::new(points, report));
    }
    let advice = "no radius was found that leaves room for no more; try another seed".to_owned();
    Err(SampleError::NotReached { method: METHOD.name, n, reached: 0, advice })
}

fn unresolved(ending: Ending) -> usize {
    if let Ending::Full { unresolved } = ending { unresolved } else { 0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FigureValue;
    use bn_core::{DVec2, Unobserved, torus};
    use bn_geometry::{Coverage, Spacing, Triangulation};

    fn with(radius: f64) -> MaximalPoissonDisk {
        let radius = NormalizedDistance::new(radius);
        MaximalPoissonDisk { target: MaximalTarget::Radius(radius) }
    }

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
            let method = with(radius);
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

    /// By the exact coverage radius.
    #[test]
    fn coverage_radius_is_below_the_disks() {
        for (n, radius) in [(10, 0.6), (100, 0.7766), (5000, 0.7766), (5000, 1.1), (5000, 0.4)] {
            for seed in 0..4 {
                let sample = with(radius).sample(n, Seed::new(seed), &Unobserved).expect("valid");
                let r = radius * Density::new(n).hexagonal_spacing();
                let coverage = Coverage::of(&Triangulation::new(&sample.points)).expect("points");
                assert!(coverage.radius < r, "{} of {r}", coverage.radius);
                let spacing = Spacing::new(&sample.points);
                assert!(spacing.min() >= r);
            }
        }
    }

    #[test]
    fn exact_counts_are_exact_and_maximal() {
        let method = MaximalPoissonDisk { target: MaximalTarget::Count };
        for n in [1, 2, 3, 4, 5, 7, 12, 30, 100, 1000, 4096] {
            for seed in 0..5 {
                let sample = method.sample(n, Seed::new(seed), &Unobserved).expect("reached");
                assert_eq!(sample.points.len(), n);
                let Some(FigureValue::Real(radius)) = sample.report.get("radius_d_hex") else {
                    panic!("the radius is told")
                };
                let r = radius * Density::new(n).hexagonal_spacing();
                let coverage = Coverage::of(&Triangulation::new(&sample.points)).expect("points");
                // The last circle that was filled, up to its own rounding.
                assert!(coverage.radius <= r * (1.0 + 1e-12), "{} of {r}", coverage.radius);
                let spacing = Spacing::new(&sample.points);
                let d_min = spacing.min();
                // A lone point has only its own copies.
                assert!(n == 1 || d_min >= r * (1.0 - 1e-12), "{d_min} of {r}");
                // Few points lie where a circle was filled.
                assert!(n < 1000 || (radius - JAMMING).abs() < 0.02, "{radius}");
            }
        }
        let both = METHOD.with_options([("exact", "true"), ("radius", "0.7")]);
        assert!(both.expect_err("a contradiction").to_string().contains("--exact"));
    }

    #[test]
    fn the_count_follows_from_the_radius() {
        for radius in [0.5, 0.7766, 1.0] {
            let method = with(radius);
            let n = 20_000;
            let sample = method.sample(n, Seed::new(2), &Unobserved).expect("valid");
            let expected = n as f64 * (JAMMING / radius).powi(2);
            let error = sample.points.len() as f64 - expected;
            // Five standard deviations, and 0.1 % for the constant's own rounding.
            assert!(error.abs() < 5.0 * 0.245 * expected.sqrt() + 1e-3 * expected, "{error}");
        }
        let wide = with(0.1);
        let error = wide.sample(1 << 28, Seed::new(1), &Unobserved).expect_err("too many");
        assert!(error.is_usage(), "{error}");
    }
}
