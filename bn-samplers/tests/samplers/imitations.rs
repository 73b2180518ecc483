//! Imitations of other methods (thesis §5.2.3): how near `spectral` and `force` come to their models.

use bn_core::{Density, PointSet, Seed, Unobserved};
use bn_samplers::{Algorithm, Sampler, SpectrumMatching, find};
use bn_spectral::{PairHistogram, PeriodogramOptions, RadialPower, Target};

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

/// `spectral`, from the model's power, comes within the stated bounds for P and g, nearer than
/// `force`, from its RDF, in P, and in g nearer than `of_force` times what that reaches.
#[track_caller]
fn check(model: &str, bounds: [f64; 2], of_force: f64) {
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
    let [p, g] = [spectral[0] / force[0], spectral[1] / force[1]];
    assert!(p < 1.0 && g < of_force, "{model}: {spectral:?} {force:?}");
    assert!(spectral[0] < bounds[0] && spectral[1] < bounds[1], "{model}: {spectral:?}");
}

#[test]
fn jitter() {
    check("jittered", [0.02, 0.04], 1.0);
}

#[test]
fn dart_throwing() {
    check("dart-throwing", [0.02, 0.04], 1.0);
}

#[test]
fn cccvt() {
    check("cccvt", [0.03, 0.04], 1.0);
}

/// The one model whose g `force` meets better, which aims at nothing else: 0.026 against 0.032, while
/// P is met ten times better, 0.005 against 0.043. Steeper weights take g to 0.030 at twice the error of
/// P, wider ranges and longer searches gain nothing: what is left are misplaced points in crystals
/// that are all but perfect. Both are far below what sets of Lloyd's own differ by.
#[test]
fn lloyd() {
    check("lloyd", [0.01, 0.035], 1.3);
    let lloyd = find("lloyd").expect("a method").with_options([]).expect("defaults");
    let [p, g] = differences(&ensemble(&*lloyd, 0), &ensemble(&*lloyd, 300));
    assert!(p > 0.09 && g > 0.09, "{p} {g}");
}
