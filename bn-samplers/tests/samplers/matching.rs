//! Spectrum matching: what each algorithm reaches, and what it must survive.

use bn_core::{DVec2, Density, PointSet, Seed, Unobserved};
use bn_samplers::{
    Algorithm, Annealing, FigureValue, Force, Given, Gradient, Jittered, OptionError, OptionKind,
    OptionValues, Sample, SampleError, Sampler, SinglePeak, Spectral, SpectrumMatching, Step,
    Stochastic, find,
};
use bn_spectral::{Target, WindowedSpectrum, highest_step, power_below};

fn figure(sample: &Sample, name: &str) -> f64 {
    match sample.report.get(name) {
        Some(FigureValue::Real(value)) => value,
        other => panic!("{name} is {other:?}"),
    }
}

fn iterations(sample: &Sample) -> u64 {
    match sample.report.get("iterations") {
        Some(FigureValue::Count(count)) => count,
        other => panic!("{other:?}"),
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

fn from_options(given: &[(&str, &str)]) -> Result<Algorithm, OptionError> {
    let given = given.iter().map(|&(name, text)| (name, Given::Text(text)));
    Algorithm::from_options(&OptionValues::parse("step", Algorithm::OPTIONS, given)?)
}

fn spectral(given: &[(&str, &str)]) -> Spectral {
    match from_options(given) {
        Ok(Algorithm::Spectral(spectral)) => spectral,
        other => panic!("{other:?}"),
    }
}

#[test]
fn options_become_fields() {
    assert_eq!(spectral(&[]), Spectral::default());
    let ranges = |given: &[(&str, &str)]| spectral(given).ranges;
    assert_eq!(ranges(&[]), [1.5, 6.0]);
    assert_eq!(ranges(&[("stages", "1")]), [6.0]);
    assert_eq!(ranges(&[("stages", "3")]), [1.5, 3.0, 6.0]);
    assert_eq!(ranges(&[("range", "3")]), [1.5, 3.0]);
    assert_eq!(ranges(&[("range", "0.75")]), [0.75, 0.75]);
    let tuned = spectral(&[("tolerance", "1e-3"), ("weight-exponent", "0"), ("evaluations", "7")]);
    assert_eq!((tuned.tolerance, tuned.weights.exponent), (Some(1e-3), 0.0));
    assert_eq!((tuned.evaluations, tuned.iterations), (Some(7), None));
    assert_eq!(spectral(&[("iterations", "160")]).iterations, Some(160));

    let force = [("algorithm", "force"), ("smoothing", "4"), ("patience", "5"), ("coldest", "0.1")];
    let want = Force { smoothing: 4.0, patience: 5, coldest: 0.1, ..Force::default() };
    assert_eq!(from_options(&force), Ok(Algorithm::Force(want)));
    let cooled = from_options(&[("cooling", "0.5"), ("algorithm", "force")]);
    assert_eq!(cooled, Ok(Algorithm::Force(Force { cooling: 0.5, ..Force::default() })));
}

/// Each option is refused, even with its default value, where another algorithm is chosen.
#[test]
fn options_of_other_algorithms_are_refused() {
    let mut refused = 0;
    for spec in Algorithm::OPTIONS.iter().filter(|spec| spec.name != "algorithm") {
        let text = match spec.kind {
            OptionKind::Integer { min, .. } => min.to_string(),
            OptionKind::Real { max, .. } => max.to_string(),
            other => panic!("{other:?}"),
        };
        for algorithm in Algorithm::NAMES {
            let made = from_options(&[("algorithm", algorithm), (spec.name, &text)]);
            assert_eq!(made.is_ok(), Algorithm::takes(algorithm, spec.name), "{}", spec.name);
            let Err(error) = made else { continue };
            refused += 1;
            let message = error.to_string();
            assert!(message.starts_with(&format!("--{}: it belongs to", spec.name)), "{message}");
            assert!(message.contains(algorithm), "{message}");
            // The help says whose they are.
            let owner = Algorithm::NAMES.iter().find(|name| Algorithm::takes(name, spec.name));
            assert!(spec.help.starts_with(owner.expect("someone's")), "{}", spec.help);
        }
    }
    assert_eq!(refused, 9 * 3);
    let step = find("step").expect("known");
    let error = step.with_options([("smoothing", "8")]).expect_err("force's");
    assert_eq!(error.to_string(), "--smoothing: it belongs to --algorithm force, not to spectral");
}

/// What ends a search is told, and is what the options say.
#[test]
fn searches_end_as_they_are_told_to() {
    let n = 256;
    let run = |target: &Target, algorithm: Algorithm| {
        let matching = SpectrumMatching::new(target.clone(), algorithm);
        matching.sample(n, Seed::new(2), &Unobserved).expect("possible")
    };
    let ended = |sample: &Sample, why: &'static str, converged: bool| {
        assert_eq!(sample.report.get("ended_by"), Some(why.into()), "{:?}", sample.report);
        assert_eq!(sample.report.get("converged"), Some(converged.into()), "{:?}", sample.report);
    };
    ended(&run(&step(n), Algorithm::default()), "tolerance", true);
    let mut before = 0;
    for tolerance in ["1e-1", "1e-2", "1e-3", "1e-6"] {
        let given = [("tolerance", tolerance), ("evaluations", "3000")];
        let sample = run(&step(n), Algorithm::Spectral(spectral(&given)));
        ended(&sample, "tolerance", true);
        let bound: f64 = tolerance.parse().expect("a number");
        assert!(figure(&sample, "residual") <= 1.01 * bound, "{tolerance}: {:?}", sample.report);
        assert!(iterations(&sample) > before, "{tolerance}");
        before = iterations(&sample);
        // The empty modes are one in (6²·π) = 113 of all.
        assert!(figure(&sample, "empty_power") < 11.0 * bound, "{:?}", sample.report);
    }
    let few = run(&step(n), Algorithm::Spectral(spectral(&[("evaluations", "5")])));
    ended(&few, "evaluations", false);
    assert_eq!(iterations(&few), 10, "{:?}", few.report);
    let peak =
        Target::single_peak(Density::new(n), bn_spectral::SinglePeak::thesis(Density::new(n)));
    let long = spectral(&[("evaluations", "3000")]);
    ended(&run(&peak.expect("valid"), Algorithm::Spectral(long)), "stalled", false);
    let flat = Target::step(Density::new(n), 0.0).expect("valid");
    let cold = from_options(&[("algorithm", "force"), ("coldest", "0.5"), ("patience", "2")]);
    ended(&run(&flat, cold.expect("force's")), "temperature", true);
    for name in ["force", "gradient", "annealing"] {
        let algorithm = Algorithm::named(name).expect("listed").with_iterations(3);
        ended(&run(&step(n), algorithm), "iterations", false);
    }
}

/// No evaluation too many, and none withheld from the last stage by what earlier ones leave.
#[test]
fn budgets_are_kept_to_and_spent() {
    let run = |n: usize, target: &Target, most: u32| {
        let algorithm = Algorithm::default().with_iterations(most);
        let matching = SpectrumMatching::new(target.clone(), algorithm);
        matching.sample(n, Seed::new(2), &Unobserved).expect("possible")
    };
    let thesis = bn_spectral::SinglePeak::thesis(Density::new(100));
    let peak = Target::single_peak(Density::new(100), thesis).expect("valid");
    for target in [step(100), peak] {
        for most in 0..20 {
            let sample = run(100, &target, most);
            assert_eq!(iterations(&sample), u64::from(most));
            assert_eq!(sample.report.get("ended_by"), Some("evaluations".into()));
        }
    }
    let sample = run(1024, &step(1024), 150);
    assert_eq!(sample.report.get("ended_by"), Some("tolerance".into()), "{:?}", sample.report);
    assert!(figure(&sample, "residual") < 4e-3, "{:?}", sample.report);
}

/// Whatever the options' ranges allow ends in points, and what they don't in an error.
#[test]
fn fields_out_of_range_are_refused() {
    let n = 16;
    let run = |algorithm: Algorithm| {
        SpectrumMatching::new(step(n), algorithm).sample(n, Seed::new(1), &Unobserved)
    };
    for owner in ["spectral", "force"] {
        for spec in Algorithm::OPTIONS.iter().filter(|spec| Algorithm::takes(owner, spec.name)) {
            let ends = match spec.kind {
                OptionKind::Integer { min, max } => [min.to_string(), max.to_string()],
                OptionKind::Real { min, max } => [min.to_string(), max.to_string()],
                _ => continue,
            };
            for text in ends {
                let given = [("algorithm", owner), (spec.name, &*text)];
                let algorithm = from_options(&given).expect("in range");
                assert_eq!(run(algorithm).expect("possible").points.len(), n);
            }
        }
    }
    for wrong in [-1.0, f64::NAN, f64::INFINITY, 1e3] {
        let mut spectral = Spectral::default();
        spectral.weights.exponent = wrong;
        assert!(run(Algorithm::Spectral(spectral)).is_err());
        let mut spectral = Spectral::default();
        spectral.ranges[0] = wrong;
        assert!(run(Algorithm::Spectral(spectral)).is_err());
        assert!(run(Algorithm::Force(Force { cooling: wrong, ..Force::default() })).is_err());
        assert!(run(Algorithm::Force(Force { coldest: wrong, ..Force::default() })).is_err());
        let fields: [fn(&mut Gradient) -> &mut f64; 2] =
            [|g| &mut g.kernel, |g| &mut g.smallest_step];
        for field in fields {
            let mut gradient = Gradient::default();
            *field(&mut gradient) = wrong;
            assert!(run(Algorithm::Gradient(gradient)).is_err());
        }
        let annealing = Annealing { cooling: wrong, ..Annealing::default() };
        assert!(run(Algorithm::Annealing(annealing)).is_err());
    }
    for wrong in [-1.0, f64::NAN, f64::INFINITY] {
        let gradient = Gradient { resolution: wrong, ..Gradient::default() };
        assert!(run(Algorithm::Gradient(gradient)).is_err());
        let fields: [fn(&mut Annealing) -> &mut f64; 3] =
            [|a| &mut a.resolution, |a| &mut a.temperature, |a| &mut a.coldest];
        for field in fields {
            let mut annealing = Annealing::default();
            *field(&mut annealing) = wrong;
            assert!(run(Algorithm::Annealing(annealing)).is_err());
        }
    }
    // The least that they allow.
    let gradient = Gradient { kernel: 0.0, resolution: 0.0, smallest_step: 0.0, iterations: 20 };
    assert_eq!(run(Algorithm::Gradient(gradient)).expect("possible").points.len(), n);
    let annealing =
        Annealing { resolution: 0.0, temperature: 0.0, cooling: 0.0, coldest: 0.0, iterations: 20 };
    assert_eq!(run(Algorithm::Annealing(annealing)).expect("possible").points.len(), n);
    assert!(
        run(Algorithm::Spectral(Spectral { tolerance: Some(-1.0), ..Spectral::default() }))
            .is_err()
    );
    assert!(run(Algorithm::Force(Force { smoothing: f64::NAN, ..Force::default() })).is_err());
}
