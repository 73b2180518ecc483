//! Imitations of other methods (thesis §5.2.3): how near `spectral` and `force` come to their models.

use bn_core::{Density, PointSet, Seed, Unobserved};
use bn_samplers::{Algorithm, Sampler, SpectrumMatching, find};
use bn_spectral::{PairHistogram, PeriodogramOptions, RadialPower, Target, power_below};

const N: usize = 400;
const SETS: u32 = 6;

fn ensemble(sampler: &dyn Sampler, first: u32) -> Vec<PointSet> {
    let one = |set| sampler.sample(N, Seed::new(5).for_set(set), &Unobserved);
    (first..first + SETS).map(|set| one(set).expect("possible").points).collect()
}

fn imitated(target: Target, algorithm: &str) -> Vec<PointSet> {
    let algorithm = Algorithm::named(algorithm).expect("listed");
    ensemble(&SpectrumMatching::new(target, algorithm), 100)
}

/// The mean g of sets up to `range`.
fn rdf(sets: &[PointSet], range: f64, bins: usize) -> Vec<f64> {
    let mut mean = vec![0.0; bins];
    for set in sets {
        for (mean, g) in mean.iter_mut().zip(PairHistogram::within(set, range, bins).rdf().values())
        {
            *mean += g / sets.len() as f64;
        }
    }
    mean
}

/// Root mean square of the differences of ring means up to 6√n, weighted by their modes, and of g up
/// to 5/√n in bins of 0.1/√n.
fn differences(a: &[PointSet], b: &[PointSet]) -> [f64; 2] {
    let power = |sets| RadialPower::of(sets, PeriodogramOptions::new(120)).expect("small");
    let (pa, pb) = (power(a), power(b));
    let (mut modes, mut squares) = (0.0, 0.0);
    for ((&m, a), b) in pa.modes().iter().zip(pa.means()).zip(pb.means()).filter(|r| *r.0.0 > 0) {
        modes += m as f64;
        squares += m as f64 * (a - b).powi(2);
    }
    let (ga, gb) = (rdf(a, 0.25, 50), rdf(b, 0.25, 50));
    let g: f64 = ga.iter().zip(&gb).map(|(a, b)| (a - b).powi(2)).sum();
    [(squares / modes).sqrt(), (g / 50.0).sqrt()]
}

/// `spectral`, from the model's power, comes within the stated bounds for P and g, in both nearer than
/// `force` does from the model's RDF.
#[track_caller]
fn check(model: &str, bounds: [f64; 2]) {
    let sampler = find(model).expect("a method").with_options([]).expect("defaults");
    let models = ensemble(&*sampler, 0);
    let g = rdf(&models, 0.5, N);
    let middle = |i: usize| (i as f64 + 0.5) * 0.5 / N as f64;
    let samples: Vec<_> = g.iter().enumerate().map(|(i, &g)| (middle(i), g)).collect();
    let like = Target::imitating(&models, N).expect("measurable");
    let spectral = differences(&models, &imitated(like, "spectral"));
    let from_rdf = Target::rdf_curve(Density::new(N), &samples).expect("a curve");
    let force = differences(&models, &imitated(from_rdf, "force"));
    println!("{model}: spectral {spectral:.4?}, force {force:.4?}");
    assert!(spectral[0] < force[0] && spectral[1] < force[1], "{model}: {spectral:?} {force:?}");
    assert!(spectral[0] < bounds[0] && spectral[1] < bounds[1], "{model}: {spectral:?}");
}

#[test]
fn jitter() {
    check("jittered", [0.02, 0.04]);
}

#[test]
fn dart_throwing() {
    check("dart-throwing", [0.02, 0.04]);
}

#[test]
fn cccvt() {
    check("cccvt", [0.03, 0.04]);
}

/// Crystals, whose sets differ among themselves by more than an imitation does from its models, and
/// with next to no power at low frequencies, 0.003.
#[test]
fn lloyd() {
    check("lloyd", [0.01, 0.02]);
    let lloyd = find("lloyd").expect("a method").with_options([]).expect("defaults");
    let models = ensemble(&*lloyd, 0);
    let [p, g] = differences(&models, &ensemble(&*lloyd, 300));
    assert!(p > 0.09 && g > 0.09, "{p} {g}");
    let imitations = imitated(Target::imitating(&models, N).expect("measurable"), "spectral");
    let low = |sets: &[PointSet]| {
        let below = |set| power_below(set, 13.0).expect("small").expect("has modes");
        sets.iter().map(below).sum::<f64>() / sets.len() as f64
    };
    let (model, imitation) = (low(&models), low(&imitations));
    assert!(model < 0.004 && imitation < 2.0 * model, "{imitation} instead of {model}");
}
