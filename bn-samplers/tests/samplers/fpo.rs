//! What farthest-point optimisation promises, whatever it starts from.

use std::sync::Arc;

use bn_core::{DVec2, Density, NormalizedDistance, PointSet, Seed, StreamRng, Unobserved, torus};
use bn_geometry::{Coverage, Spacing, Triangulation, bond_orientational_order};
use bn_samplers::{
    FarthestPointOptimization, FpoStart, FpoUntil, FpoVariant, Sample, Sampler, find,
};
use bn_spectral::{PeriodogramOptions, RadialPower};
use rand::RngExt;
use rayon::prelude::*;

const VARIANTS: [FpoVariant; 4] =
    [FpoVariant::Global, FpoVariant::Local, FpoVariant::Hybrid, FpoVariant::Constrained];

fn at(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

fn random_points(n: usize, rng: &mut StreamRng) -> Vec<DVec2> {
    (0..n).map(|_| at(rng.random(), rng.random())).collect()
}

fn optimize(method: &FarthestPointOptimization, n: usize) -> Sample {
    method.sample(n, Seed::new(3), &Unobserved).expect("valid")
}

/// So many iterations, from these points.
fn iterate(start: &[DVec2], variant: FpoVariant, iterations: u32) -> Sample {
    let n = start.len();
    let start = FpoStart::Points(Arc::new(PointSet::new(start.to_vec()).expect("valid")));
    let method = FarthestPointOptimization {
        variant,
        until: FpoUntil::Converged,
        iterations,
        start,
        ..Default::default()
    };
    optimize(&method, n)
}

#[test]
fn the_default_reaches_its_goal_and_is_maximal() {
    for variant in VARIANTS {
        let method = FarthestPointOptimization { variant, ..Default::default() };
        for seed in 1..=3 {
            let sample = method.sample(1024, Seed::new(seed), &Unobserved).expect("valid");
            // As single-precision files hold it.
            let single = |x: f64| torus::wrap(f64::from(x as f32));
            let written = sample.points.points().iter().map(|p| at(single(p.x), single(p.y)));
            let written = PointSet::new(written.collect()).expect("valid");
            let density = Density::new(1024);
            let spacing = Spacing::new(&written);
            let d_min = density.normalize_distance(spacing.min()).value();
            let d_avg = density.normalize_distance(spacing.mean()).value();
            assert!(d_min >= 0.925 && d_avg >= 0.93, "{variant:?}: {d_min}, {d_avg}");
            let coverage = Coverage::of(&Triangulation::new(&written)).expect("points");
            assert!(coverage.radius < spacing.min(), "{variant:?}: not maximal");
            assert_eq!(sample.report.get("converged"), Some(true.into()));
        }
    }
}

/// The moves' invariants: neither the smallest nor, in its first difference, the sorted list of
/// distances falls.
#[test]
fn distances_grow_lexicographically() {
    let mut rng = Seed::new(8).stream(0);
    for (case, variant) in (0..12).flat_map(|case| VARIANTS.map(|variant| (case, variant))) {
        let start = random_points([5, 17, 48, 200][case % 4], &mut rng);
        let distances = |points: &PointSet| {
            let mut list = Spacing::new(points).nearest_distances().to_vec();
            list.sort_by(f64::total_cmp);
            list
        };
        let mut points = PointSet::new(start).expect("valid");
        let mut before = distances(&points);
        for _ in 0..12 {
            points = iterate(points.points(), variant, 1).points;
            let after = distances(&points);
            // Rounding of coordinates to multiples of 2⁻⁵⁰.
            let tolerance = 4e-15;
            assert!(after[0] >= before[0] - tolerance, "d_min fell");
            let first = before.iter().zip(&after).find(|(a, b)| (*a - *b).abs() > tolerance);
            assert!(first.is_none_or(|(a, b)| b > a), "{variant:?} case {case}: {first:?}");
            before = after;
        }
    }
}

/// A point of a square lattice, upright or turned, is in the largest hole that the others leave.
#[test]
fn lattices_stay_put() {
    let turned = |n: u32, step: u32| -> Vec<DVec2> {
        (0..n).map(|i| at(f64::from(i), f64::from(i * step % n)) / f64::from(n)).collect()
    };
    let upright = (0..64).map(|i| at(f64::from(i % 8), f64::from(i / 8)) / 8.0).collect();
    let diagonal: Vec<DVec2> = (0..98)
        .map(|i| at(f64::from(i % 7) + f64::from(i / 7 % 2) / 2.0, f64::from(i / 7) / 2.0) / 7.0)
        .collect();
    // Sums of two squares: 1 + 8², 16² + 9².
    for points in [upright, diagonal, turned(65, 8), turned(337, 189)] {
        for variant in VARIANTS {
            let sample = iterate(&points, variant, 50);
            assert_eq!(sample.report.get("iterations"), Some(1_u64.into()), "{variant:?}");
            for (p, q) in points.iter().zip(sample.points.points()) {
                assert!(torus::distance(*p, *q) <= 2.0_f64.powi(-50));
            }
        }
    }
}

/// One point is missing; the disorder spreads far beyond the eight around its place.
#[test]
fn a_lattice_with_a_defect_breaks_up() {
    let mut points: Vec<DVec2> =
        (0..256).map(|i| at(f64::from(i % 16), f64::from(i / 16)) / 16.0).collect();
    points.remove(100);
    for variant in VARIANTS {
        let sample = iterate(&points, variant, 200);
        let pairs = points.iter().zip(sample.points.points());
        let stayed = pairs.filter(|(p, q)| torus::distance(**p, **q) < 0.01).count();
        assert!(stayed < 225, "{variant:?}: {stayed} points stayed");
    }
}

#[test]
fn degenerate_starts_spread_out() {
    let n = 300;
    let line = |i: usize| i as f64 / n as f64;
    let starts: [(&str, Vec<DVec2>); 6] = [
        ("all equal", vec![at(0.25, 0.5); n]),
        ("collinear", (0..n).map(|i| at(0.5, line(i))).collect()),
        ("diagonal", (0..n).map(|i| at(line(i), line(i))).collect()),
        ("1e-300 apart", (0..n).map(|i| at(1e-300 * i as f64, 0.0)).collect()),
        ("in pairs", (0..n).map(|i| at(line(i / 2), torus::wrap(line(i / 2) * 7.3))).collect()),
        (
            "clustered",
            random_points(n, &mut Seed::new(1).stream(0)).iter().map(|&p| p * 1e-9).collect(),
        ),
    ];
    for (name, start) in &starts {
        for variant in VARIANTS {
            let sample = iterate(start, variant, 400);
            let density = sample.points.density();
            let d_min = density.normalize_distance(Spacing::new(&sample.points).min()).value();
            assert!(d_min > 0.8, "{name} {variant:?}: {d_min}");
        }
    }
}

#[test]
fn a_few_points_are_spread_as_far_as_can_be() {
    for variant in VARIANTS {
        let spread = |points: &[DVec2]| Spacing::new(&iterate(points, variant, 100).points).min();
        assert_eq!(spread(&[at(0.3, 0.4)]), 1.0);
        assert!((spread(&[at(0.3, 0.4), at(0.31, 0.4)]) - torus::DIAMETER).abs() < 1e-15);
        for n in [3, 4, 5] {
            let same = spread(&vec![at(0.9, 0.1); n]);
            assert!(same >= 0.5_f64.sqrt() / (n - 1) as f64, "{n} points: {same}");
        }
    }
}

/// Blocks: enough points for four at a time, and for one.
#[test]
fn blocks_keep_what_is_promised_and_do_not_depend_on_threads() {
    let mut rng = Seed::new(4).stream(0);
    let clustered: Vec<DVec2> =
        random_points(4000, &mut rng).iter().map(|p| *p * p.x.max(0.2)).collect();
    let starts = [random_points(1000, &mut rng), random_points(4100, &mut rng), clustered];
    for start in starts {
        let mut points = PointSet::new(start).expect("valid");
        let distances = |points: &PointSet| {
            let mut list = Spacing::new(points).nearest_distances().to_vec();
            list.sort_by(f64::total_cmp);
            list
        };
        for _ in 0..3 {
            let run = |threads: usize| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
                let run = || iterate(points.points(), FpoVariant::Constrained, 1).points;
                pool.expect("threads").install(run)
            };
            let after = run(1);
            assert!(after == run(2) && after == run(3), "depends on threads");
            let (old, new) = (distances(&points), distances(&after));
            let first = old.iter().zip(&new).find(|(a, b)| (*a - *b).abs() > 4e-15);
            assert!(first.is_some_and(|(a, b)| b > a), "{} points: {first:?}", points.len());
            points = after;
        }
    }
}

/// To the end: 0.93, as the thesis says (§4.3.1).
#[test]
fn convergence_ends_above_the_thesis_s_least() {
    let method = FarthestPointOptimization { until: FpoUntil::Converged, ..Default::default() };
    for seed in 1..=2 {
        let sample = method.sample(2048, Seed::new(seed), &Unobserved).expect("valid");
        assert_eq!(sample.report.get("converged"), Some(true.into()));
        let density = sample.points.density();
        let spacing = Spacing::new(&sample.points);
        let d_min = density.normalize_distance(spacing.min()).value();
        let d_avg = density.normalize_distance(spacing.mean()).value();
        assert!(d_min >= 0.93 && d_avg >= 0.93, "{d_min} {d_avg}");
    }
}

/// The thesis's figures (§4.3.2): `R_c` about 0.76, `d_min` about 0.90, the rest as it was.
#[test]
fn plugging_closes_the_holes_and_changes_little_else() {
    let n = 4096;
    let sets = |plug| -> Vec<PointSet> {
        let method = FarthestPointOptimization { plug, ..Default::default() };
        let sample = |set| method.sample(n, Seed::new(2).for_set(set), &Unobserved);
        (0..3).map(|set| sample(set).expect("valid").points).collect()
    };
    let (plain, plugged) = (sets(false), sets(true));
    let density = plain[0].density();
    for (plain, plugged) in plain.iter().zip(&plugged) {
        assert_eq!(plugged.len(), n);
        let measure = |points: &PointSet| {
            let triangulation = Triangulation::new(points);
            let (spacing, coverage) =
                (Spacing::new(points), Coverage::of(&triangulation).expect("points"));
            let value = |distance| density.normalize_distance(distance).value();
            let q6 = bond_orientational_order(&triangulation, 6).expect("points");
            [value(spacing.min()), value(spacing.mean()), value(coverage.radius), q6]
        };
        let [_, d_avg_before, hole, q6_before] = measure(plain);
        let [d_min, d_avg, r_c, q6] = measure(plugged);
        assert!(hole > 0.82 && r_c <= 0.7601 && d_min >= 0.8999, "{hole} {r_c} {d_min}");
        assert!((d_avg - d_avg_before).abs() < 0.003, "{d_avg_before} {d_avg}");
        assert!((q6 - q6_before).abs() < 0.005, "{q6_before} {q6}");
    }
    let spectrum = |sets: &[PointSet]| RadialPower::of(sets, PeriodogramOptions::new(400));
    let (before, after) =
        (spectrum(&plain).expect("planned"), spectrum(&plugged).expect("planned"));
    let nu = |power: &RadialPower| power.effective_nyquist().expect("a blue spectrum").value();
    assert!((nu(&before) - nu(&after)).abs() < 0.01, "{} {}", nu(&before), nu(&after));
    let omega = |power: &RadialPower| power.oscillation().expect("rings");
    assert!(
        (omega(&before) / omega(&after) - 1.0).abs() < 0.05,
        "{} {}",
        omega(&before),
        omega(&after)
    );
}

/// Rings of independent modes: the squared deviation of each mode's mean power over m sets from the
/// ring's mean has the mean P²/m; over N pairs of modes its mean varies by √((2 + 6/m)/N) of that
/// (gamma distribution of shape m). Where the mean power changes across a ring that adds to it.
#[test]
fn patterns_are_isotropic() {
    let (n, count) = (4096, 10);
    let sample = |set| {
        let method = FarthestPointOptimization::default();
        method.sample(n, Seed::new(1).for_set(set), &Unobserved).expect("valid").points
    };
    let sets: Vec<PointSet> = (0..count).into_par_iter().map(sample).collect();
    let power = RadialPower::of(&sets, PeriodogramOptions::new(200)).expect("planned");
    let anisotropy = power.anisotropy_db().expect("rings");
    let means = power.means();
    let m = f64::from(count);
    let (mut outside, mut rings) = (0, 0);
    for ring in 1..means.len() - 1 {
        // The zero region.
        if means[ring] < 0.1 {
            continue;
        }
        let slope = (means[ring + 1] - means[ring - 1]) / (2.0 * means[ring]);
        let expected = 1.0 / m + slope * slope / 12.0;
        let pairs = power.modes()[ring] as f64 / 2.0;
        let deviation = ((2.0 + 6.0 / m) / pairs).sqrt();
        let relative = libm::pow(10.0, anisotropy.values()[ring] / 10.0) / expected;
        rings += 1;
        outside += u32::from((relative - 1.0).abs() > 3.0 * deviation);
        assert!((relative - 1.0).abs() < 6.0 * deviation, "ring {ring}: {relative} ± {deviation}");
    }
    // 0.3 % of normally distributed numbers are beyond three standard deviations.
    assert!(rings > 150 && outside <= 4, "{outside} of {rings} rings");
}

#[test]
fn convergence_goes_further() {
    let until = FpoUntil::Spacing(NormalizedDistance::new(0.929));
    let method = FarthestPointOptimization { until, ..Default::default() };
    let sample = optimize(&method, 512);
    assert_eq!(sample.report.get("converged"), Some(true.into()));
    let short = FarthestPointOptimization { iterations: 3, ..method };
    let report = optimize(&short, 512).report;
    assert_eq!(report.get("converged"), Some(false.into()));
    assert_eq!(report.notes.len(), 1, "says that it fell short");
}

#[test]
fn a_distance_contradicts_convergence() {
    let fpo = find("fpo").expect("known");
    let error = fpo.with_options([("until", "converged"), ("d-min", "0.9")]).expect_err("both");
    assert!(error.to_string().starts_with("--d-min: --until converged"), "{error}");
    assert!(fpo.with_options([("until", "spacing"), ("d-min", "0.9")]).is_ok());
    assert!(fpo.with_options([("until", "converged")]).is_ok());
}

#[test]
fn a_start_of_another_size_is_refused() {
    let start = PointSet::new(vec![DVec2::ZERO; 5]).expect("valid");
    let start = FpoStart::Points(Arc::new(start));
    let method = FarthestPointOptimization { start, ..Default::default() };
    let error = method.sample(4, Seed::new(1), &Unobserved).expect_err("5 are not 4");
    assert!(error.is_usage() && error.to_string().contains("5 points"), "{error}");
}

#[test]
fn any_method_can_begin() {
    let fpo = |options: &[(&str, &str)]| {
        find("fpo").expect("known").with_options(options.iter().copied())
    };
    let begun = fpo(&[("initial-method", "sobol"), ("iterations", "0")]).expect("valid");
    let sobol = find("sobol").expect("known").with_options([]).expect("valid");
    let sample = |sampler: &dyn Sampler| sampler.sample(64, Seed::new(1), &Unobserved);
    let (begun, sobol) = (sample(&*begun).expect("valid"), sample(&*sobol).expect("valid"));
    assert_eq!(begun.points, sobol.points);
    let error = fpo(&[("initial-method", "soboll")]).expect_err("misspelt");
    assert!(error.to_string().contains("did you mean sobol?"), "{error}");
}
