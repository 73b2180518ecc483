//! One suite over all methods: what every sampler promises.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU32, Ordering};

use bn_core::{Observer, PointSet, Progress, Seed, Unobserved, torus};
use bn_samplers::{
    BestCandidate, Bnot, Cccvt, CountRule, DartThrowing, DefaultValue, Electrostatic,
    FarthestPointOptimization, FarthestPointStrategy, Halton, Hexagonal, Jittered, KernelDensity,
    Lloyd, METHODS, MaximalPoissonDisk, Method, Net, OptionError, OptionKind, R2, Regular, Sample,
    SampleError, Sampler, SinglePeak, Sobol, Step, Stochastic, find,
};

const SMALL: [usize; 9] = [1, 2, 3, 4, 5, 7, 16, 64, 100];

fn sample(method: &Method, n: usize, seed: u64) -> Result<Sample, SampleError> {
    let sampler = method.with_options([]).expect("defaults are valid");
    sampler.sample(n, Seed::new(seed), &Unobserved)
}

/// Options that keep the work small where nothing but its kind matters.
fn brief(method: &Method) -> Vec<(&'static str, &'static str)> {
    let brief = [("iterations", "20"), ("steps", "5"), ("candidates", "1")];
    let takes = |name: &str| method.options.iter().any(|spec| spec.name == name);
    brief.into_iter().filter(|(name, _)| takes(name)).collect()
}

/// The possible count nearest to `n`.
fn possible(method: &Method, n: usize) -> usize {
    match method.counts {
        CountRule::Square => n.isqrt().pow(2),
        CountRule::PowerOfTwo => n.next_power_of_two(),
        _ => n,
    }
}

fn assert_valid(method: &Method, n: usize, set: &PointSet) {
    if method.counts != CountRule::Approximate {
        assert_eq!(set.len(), n, "{}", method.name);
    }
    for p in set.points() {
        assert!(torus::contains(*p), "{} of {n} points has {p}", method.name);
    }
}

#[test]
fn names_are_unique_and_found() {
    let mut names = std::collections::BTreeSet::new();
    for method in METHODS {
        for name in method.aliases.iter().chain([&method.name]) {
            assert!(names.insert(*name), "{name} is used twice");
            assert_eq!(find(name).expect("known").name, method.name);
            assert_eq!(
                find(&name.to_uppercase().replace('-', "_")).expect("known").name,
                method.name
            );
        }
    }
    assert_eq!(find("stochastik").expect_err("misspelt").nearest, Some("stochastic"));
    assert_eq!(find("nosuch").expect_err("unknown").nearest, None);
}

#[test]
fn small_counts_are_exact_or_refused_with_the_nearest() {
    for method in METHODS {
        for n in SMALL {
            match sample(method, n, 1) {
                Ok(sample) => assert_valid(method, n, &sample.points),
                Err(error @ SampleError::InvalidCount { nearest, .. }) => {
                    assert_ne!(possible(method, n), n, "{}: {error}", method.name);
                    assert!(error.is_usage());
                    assert!(sample(method, nearest, 1).is_ok(), "{}: {error}", method.name);
                }
                Err(error) => panic!("{} of {n} points: {error}", method.name),
            }
        }
    }
}

#[test]
fn impossible_counts_are_refused_at_once() {
    for method in METHODS {
        for (n, nearest) in [(0, 1), (usize::MAX, PointSet::MAX_POINTS)] {
            let error = sample(method, n, 1).expect_err("no such count");
            assert!(error.is_usage(), "{}: {error}", method.name);
            let named = matches!(error, SampleError::InvalidCount { nearest: named, .. } if named == nearest);
            assert!(named, "{}: {error}", method.name);
        }
    }
}

#[test]
fn repeatable_on_any_number_of_threads() {
    for (name, _, options, _) in GOLDEN {
        let method = find(name).expect("known");
        let is_new = |(name, _): &(&str, &str)| options.iter().all(|given| given.0 != *name);
        // Most methods share their work out by blocks of thousands of points.
        let sizes = if options.is_empty() { [100, 9000] } else { [100, 2000] };
        let options = options.iter().copied().chain(brief(method).into_iter().filter(is_new));
        let sampler = method.with_options(options).expect("valid");
        for n in sizes {
            let n = possible(method, n);
            let on_threads = |threads: usize| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
                let run = || sampler.sample(n, Seed::new(5), &Unobserved);
                pool.expect("threads").install(run).expect("possible")
            };
            let one = on_threads(1);
            assert!(one == on_threads(2), "{sampler:?} of {n} points");
            assert_valid(method, n, &one.points);
        }
    }
}

/// Threads that settle the same dart must agree: more threads than cores, over and over.
#[test]
fn poisson_disks_do_not_depend_on_the_timing_of_threads() {
    let crowd = rayon::ThreadPoolBuilder::new().num_threads(8).build().expect("threads");
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    for name in ["dart-throwing", "maximal-poisson-disk"] {
        let sampler = find(name).expect("known").with_options([]).expect("valid");
        for seed in 0..30 {
            let run = || sampler.sample(8000, Seed::new(seed), &Unobserved).expect("possible");
            let one = alone.install(run);
            for repeat in 0..3 {
                assert!(crowd.install(run) == one, "{name}, seed {seed}, repeat {repeat}");
            }
        }
    }
}

#[test]
fn seeds_matter_where_stated() {
    for method in METHODS {
        let n = possible(method, 64);
        let set = |seed| method.with_options([]).expect("valid").sample(n, seed, &Unobserved);
        let first = set(Seed::new(1)).expect("possible").points;
        for other in [Seed::new(2), Seed::new(1).for_set(1)] {
            let differs = set(other).expect("possible").points != first;
            assert_eq!(differs, method.seeded, "{}", method.name);
        }
    }
}

#[test]
fn default_values_change_nothing() {
    for method in METHODS {
        let defaults: Vec<_> = method
            .options
            .iter()
            .filter_map(|spec| match spec.default {
                DefaultValue::Value(text) => Some((spec.name, text)),
                DefaultValue::Absent(_) => None,
            })
            .collect();
        let given = method.with_options(defaults).expect("defaults are valid");
        let none = method.with_options([]).expect("valid");
        assert_eq!(format!("{given:?}"), format!("{none:?}"), "{}", method.name);
    }
}

#[test]
fn registered_defaults_are_those_of_the_structs() {
    let structs: [(&str, Box<dyn Sampler>); 20] = [
        ("stochastic", Box::new(Stochastic::default())),
        ("jittered", Box::new(Jittered::default())),
        ("dart-throwing", Box::new(DartThrowing::default())),
        ("maximal-poisson-disk", Box::new(MaximalPoissonDisk::default())),
        ("best-candidate", Box::new(BestCandidate::default())),
        ("farthest-point-strategy", Box::new(FarthestPointStrategy::default())),
        ("kernel-density", Box::new(KernelDensity::default())),
        ("electrostatic", Box::new(Electrostatic::default())),
        ("cccvt", Box::new(Cccvt::default())),
        ("lloyd", Box::new(Lloyd::default())),
        ("net", Box::new(Net::default())),
        ("regular", Box::new(Regular)),
        ("hexagonal", Box::new(Hexagonal)),
        ("fpo", Box::new(FarthestPointOptimization::default())),
        ("step", Box::new(Step::default())),
        ("single-peak", Box::new(SinglePeak::default())),
        ("halton", Box::new(Halton::default())),
        ("sobol", Box::new(Sobol::default())),
        ("r2", Box::new(R2::default())),
        ("bnot", Box::new(Bnot::default())),
    ];
    assert_eq!(structs.len(), METHODS.len(), "list the new method as well");
    for (name, default) in structs {
        let registered = find(name).expect("known").with_options([]).expect("valid");
        assert_eq!(format!("{default:?}"), format!("{registered:?}"));
    }
}

/// Texts at and beyond the ends of an option's range: (valid, invalid).
fn extremes(kind: OptionKind) -> (Vec<String>, Vec<String>) {
    let (valid, mut invalid): (Vec<String>, Vec<String>) = match kind {
        OptionKind::Flag => (vec!["true".into(), "false".into()], vec!["maybe".into()]),
        OptionKind::Integer { min, max } => {
            (vec![min.to_string(), max.to_string()], vec!["-1".into(), "1e3".into()])
        }
        OptionKind::Real { min, max } => (
            vec![min.to_string(), max.to_string()],
            ["nan", "inf", "-inf", "1e400", "0x1"].map(String::from).to_vec(),
        ),
        OptionKind::Choice(words) => {
            (words.iter().map(|&word| word.into()).collect(), vec!["nosuch".into()])
        }
        OptionKind::Text => (vec![], vec![]),
        OptionKind::Points | OptionKind::Density => (vec![], vec!["text".into()]),
    };
    if kind != OptionKind::Text {
        invalid.push(String::new());
    }
    (valid, invalid)
}

#[test]
fn absurd_options_end_in_a_pattern_or_a_clear_error() {
    for method in METHODS {
        for spec in method.options {
            let (valid, invalid) = extremes(spec.kind);
            for text in &invalid {
                let error = method.with_options([(spec.name, &**text)]).expect_err(text);
                assert!(error.to_string().contains(spec.name), "{error}");
            }
            for text in &valid {
                let Ok(sampler) = method.with_options([(spec.name, &**text)]) else { continue };
                // The largest budgets cost what they allow; a few points show that they are kept.
                let is_budget = matches!(spec.kind, OptionKind::Integer { .. });
                let sizes: &[usize] = if is_budget { &[1, 16] } else { &[1, 16, 64] };
                for &n in sizes {
                    match sampler.sample(n, Seed::new(1), &Unobserved) {
                        Ok(sample) => assert_valid(method, n, &sample.points),
                        Err(error) => assert!(!error.to_string().is_empty()),
                    }
                }
            }
        }
    }
}

#[test]
fn misspelt_options_are_named() {
    let jittered = find("jittered").expect("known");
    let error = jittered.with_options([("widht", "1")]).expect_err("misspelt");
    assert!(error.to_string().ends_with("did you mean --width?"), "{error}");
    let error = jittered.with_options([("distribution", "gausian")]).expect_err("misspelt");
    assert!(error.to_string().ends_with("did you mean gaussian?"), "{error}");
    let error = jittered.with_options([("width", "-2")]).expect_err("out of range");
    assert!(error.to_string().contains("a number from 0 to"), "{error}");
    let error = jittered.with_options([("width", "1"), ("width", "2")]).expect_err("repeated");
    assert_eq!(error, OptionError::Repeated { option: "width" });
    let error = find("regular").expect("known").with_options([("x", "1")]).expect_err("none");
    assert!(error.to_string().ends_with("it has no options"), "{error}");
}

/// Asks to stop at the call numbered `at`.
struct StopAt {
    at: u32,
    calls: AtomicU32,
}

impl Observer for StopAt {
    fn observe(&self, progress: &Progress<'_>) -> ControlFlow<()> {
        assert!(!progress.stage.is_empty());
        assert!(progress.total.is_none_or(|total| progress.done <= total), "{progress:?}");
        if self.calls.fetch_add(1, Ordering::Relaxed) >= self.at {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

#[test]
fn every_method_can_be_stopped() {
    for method in METHODS {
        let sampler = method.with_options([]).expect("valid");
        let n = possible(method, 2000);
        for at in [0, 1, 5] {
            let observer = StopAt { at, calls: AtomicU32::new(0) };
            let result = sampler.sample(n, Seed::new(1), &observer);
            let asked_to_stop = observer.calls.into_inner() > at;
            assert!(at > 0 || asked_to_stop, "{} never asks", method.name);
            if asked_to_stop {
                assert_eq!(result.err(), Some(SampleError::Cancelled), "{}", method.name);
            } else {
                assert!(result.is_ok());
            }
        }
    }
}

/// FNV-1a over the coordinates' bytes, little-endian.
fn digest(set: &PointSet) -> u64 {
    let bytes = set.points().iter().flat_map(|p| [p.x, p.y]).flat_map(f64::to_le_bytes);
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// Method, version, options, digest of 256 points with seed 1.
///
/// Printed by the test below and kept. A digest that changes means that users' patterns change:
/// raise the method's version with it.
type Golden = (&'static str, u32, &'static [(&'static str, &'static str)], u64);
const GOLDEN: &[Golden] = &[
    ("stochastic", 1, &[], 0x2a91_7d2d_2d62_cd10),
    ("jittered", 1, &[], 0x57df_9610_05b1_0fbe),
    ("jittered", 1, &[("distribution", "gaussian"), ("width", "0.5")], 0xe341_082c_c71f_0b64),
    ("dart-throwing", 2, &[], 0x42de_6ac9_2ae1_1167),
    ("dart-throwing", 2, &[("radius", "0.2")], 0xc45d_a87f_dbb9_7eec),
    ("maximal-poisson-disk", 2, &[], 0x352a_ef5a_d857_23d0),
    ("maximal-poisson-disk", 2, &[("exact", "true")], 0x850b_41c7_7bd8_da32),
    ("best-candidate", 2, &[], 0x4598_74dc_c34d_31a3),
    ("kernel-density", 1, &[], 0xc6e8_c0c6_18ac_df63),
    ("electrostatic", 1, &[("iterations", "20")], 0x5d48_b846_e1df_1868),
    ("farthest-point-strategy", 2, &[], 0xf4dd_bca8_7323_7965),
    ("fpo", 2, &[], 0xfd97_0dec_8bb6_566d),
    ("fpo", 2, &[("variant", "global")], 0xfd97_0dec_8bb6_566d),
    ("fpo", 2, &[("variant", "local"), ("iterations", "20")], 0x9f2c_4ab3_7dc2_d6d1),
    ("bnot", 1, &[], 0x562a_2627_b116_acff),
    ("cccvt", 2, &[], 0x8e3c_5e6e_b458_a543),
    ("cccvt", 2, &[("discrete", "true"), ("samples-per-site", "256")], 0x55e7_a696_e989_17d0),
    ("lloyd", 2, &[("iterations", "50")], 0xa3c2_92e1_5542_e387),
    ("net", 1, &[], 0xcc75_e36f_cd1d_4505),
    ("net", 1, &[("construction", "larcher-pillichshammer")], 0x1cc8_4e7b_423f_894d),
    ("regular", 1, &[], 0xe998_254e_3a49_0485),
    ("hexagonal", 1, &[], 0xd09f_ae10_f2c2_f528),
    ("step", 3, &[], 0xf0b2_cf42_7053_71cf),
    ("step", 3, &[("algorithm", "force"), ("iterations", "30")], 0x23d0_57c2_7b6c_7136),
    ("single-peak", 3, &[], 0x7f2c_b2c8_92f2_4614),
    ("halton", 1, &[], 0x961a_89fc_6f48_ac61),
    ("halton", 1, &[("scramble", "owen")], 0x6f1d_2a21_6e44_df29),
    ("sobol", 1, &[], 0x3361_4760_9877_062d),
    ("sobol", 1, &[("scramble", "xor")], 0x8fce_2bb3_5bc2_6d89),
    ("sobol", 1, &[("scramble", "owen")], 0x9743_a69e_8055_119c),
    ("r2", 1, &[], 0x7370_8453_ec40_401a),
    ("r2", 1, &[("shift", "true")], 0xfc7b_fb1f_c305_d0d5),
];

#[test]
fn value_stability() {
    let mut changed = Vec::new();
    for (name, version, options, want) in GOLDEN {
        let method = find(name).expect("known");
        assert_eq!(method.version, *version, "{name}");
        let sampler = method.with_options(options.iter().copied()).expect("valid");
        let points = sampler.sample(256, Seed::new(1), &Unobserved).expect("possible").points;
        let got = digest(&points);
        if got != *want {
            changed.push(format!("({name:?}, {version}, &{options:?}, {got:#018x}),"));
        }
    }
    assert!(changed.is_empty(), "changed:\n{}", changed.join("\n"));
    for method in METHODS {
        let listed = GOLDEN.iter().any(|golden| golden.0 == method.name);
        assert!(listed, "{} has no digest", method.name);
    }
}
