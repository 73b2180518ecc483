//! Spectrum matching: what each algorithm reaches, and what it must survive.

use bn_core::{DVec2, Density, PointSet, Seed, Unobserved};
use bn_samplers::{
    Algorithm, FigureValue, Jittered, Sample, SampleError, Sampler, SinglePeak, SpectrumMatching,
    Step, Stochastic,
};
use bn_spectral::{Target, WindowedSpectrum, highest_step, power_below};

fn figure(sample: &Sample, name: &str) -> f64 {
    match sample.report.get(name) {
        Some(FigureValue::Real(value)) => value,
        other => panic!("{name} is {other:?}"),
    }
}

fn step(n: usize) -> Target {
    Target::step(Density::new(n), highest_step(n as f64)).expect("valid")
}

fn random(n: usize) -> PointSet {
    Stochastic::default().sample(n, Seed::new(1), &Unobserved).expect("valid").points
}

#[test]
fn the_step_is_met() {
    let n = 1024;
    let sets: Vec<PointSet> = (0..4)
        .map(|set| {
            let sample = Step::default().sample(n, Seed::new(3).for_set(set), &Unobserved);
            let sample = sample.expect("possible");
            assert_eq!(sample.report.get("converged"), Some(true.into()));
            assert!(figure(&sample, "residual") < 4e-3);
            let low = power_below(&sample.points, 0.95 * highest_step(n as f64));
            assert!(low.expect("small").expect("modes") < 2e-6);
            sample.points
        })
        .collect();
    let spectrum = WindowedSpectrum::of(&sets).expect("alike");
    // The step at √(n/π), 1.128 in √n/2, blurred by the window.
    let nu_eff = spectrum.effective_nyquist().expect("exists").value();
    assert!((0.56..0.61).contains(&nu_eff), "{nu_eff}");
    // Four independent random sets of 1024 have 0.10 ± 0.01 here.
    assert!(spectrum.oscillation().expect("exists") < 0.06);
}

/// What no set can have is approached, and what is left is told.
#[test]
fn the_peak_is_approached() {
    let sample = SinglePeak::default().sample(1024, Seed::new(1), &Unobserved).expect("possible");
    assert_eq!(sample.report.get("converged"), Some(false.into()));
    let low = power_below(&sample.points, 24.0).expect("small").expect("modes");
    assert!(low < 0.12, "power {low} below 48 cycles at n = 4096");
    let residual = figure(&sample, "residual");
    assert!((0.01..0.1).contains(&residual), "{residual}");
}

#[test]
fn every_algorithm_improves_on_random_points_and_repeats_itself() {
    let n = 200;
    for name in Algorithm::NAMES {
        let algorithm = Algorithm::named(name).expect("listed").with_iterations(60);
        let matching = SpectrumMatching::new(step(n), algorithm);
        let sample = matching.sample(n, Seed::new(1), &Unobserved).expect("possible");
        let before = matching.residual(&random(n)).expect("small");
        let after = matching.residual(&sample.points).expect("small");
        assert!(after.empty_power < 0.5 * before.empty_power, "{name}: {after:?}, {before:?}");
        assert_eq!(figure(&sample, "residual"), after.rms);
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
        let again = one.install(|| matching.sample(n, Seed::new(1), &Unobserved));
        assert!(again.expect("possible") == sample, "{name}");
    }
    assert_eq!(Algorithm::named("nosuch"), None);
}

#[test]
fn models_are_imitated() {
    let n = 400;
    let model: Vec<PointSet> = (0..20)
        .map(|set| {
            let model = Jittered::default().sample(n, Seed::new(9).for_set(set), &Unobserved);
            model.expect("a square number").points
        })
        .collect();
    let target = Target::imitating(&model, n).expect("measurable");
    let matching = SpectrumMatching::new(target, Algorithm::default());
    let sample = matching.sample(n, Seed::new(1), &Unobserved).expect("possible");
    // The ring means of a single model set have 1/√20 of their noise left in the target.
    assert!(figure(&sample, "residual") < 0.02, "{:?}", sample.report);
}

#[test]
fn a_start_is_where_the_search_begins() {
    let n = 300;
    let mut matching = SpectrumMatching::new(step(n), Algorithm::default().with_iterations(0));
    let start = random(n).translated(DVec2::new(0.25, 0.5));
    matching.start = Some(start.clone());
    let sample = matching.sample(n, Seed::new(7), &Unobserved).expect("possible");
    for (a, b) in sample.points.points().iter().zip(start.points()) {
        assert!((*a - *b).length() < 1e-12);
    }
    let error = matching.sample(n + 1, Seed::new(7), &Unobserved).expect_err("another count");
    assert!(matches!(error, SampleError::InvalidCount { nearest: 300, .. }), "{error}");
}

/// Coincident points, lattices, few points, targets that ask for everything.
#[test]
fn nothing_upsets_an_algorithm() {
    for n in [1_usize, 2, 3, 9] {
        let side = (n as f64).sqrt().ceil() as u32;
        let lattice = (0..n as u32)
            .map(|i| DVec2::new(f64::from(i % side), f64::from(i / side)) / f64::from(side));
        let starts = [
            PointSet::new(lattice.collect()).expect("valid"),
            PointSet::new(vec![DVec2::new(0.5, 0.5); n]).expect("valid"),
            PointSet::new(vec![DVec2::new(0.0, 1e-300); n]).expect("valid"),
        ];
        let flat = Target::step(Density::new(n), 0.0).expect("valid");
        let all = Target::step(Density::new(n), 1e9).expect("valid");
        for target in [flat, all, step(n)] {
            for name in Algorithm::NAMES {
                let algorithm = Algorithm::named(name).expect("listed").with_iterations(5);
                for start in &starts {
                    let mut matching = SpectrumMatching::new(target.clone(), algorithm.clone());
                    matching.start = Some(start.clone());
                    let sample = matching.sample(n, Seed::new(1), &Unobserved).expect("possible");
                    assert_eq!(sample.points.len(), n);
                }
            }
        }
    }
}
