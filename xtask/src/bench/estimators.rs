//! The spectral statistics ν_eff and Ω: ensemble size against spread and time, by both estimators.

use std::hint::black_box;
use std::time::Instant;

use bn_cli::analysis::{Analysis, Statistic};
use bn_cli::{Failure, Outcome};
use bn_core::{PointSet, Seed, Unobserved};
use rayon::prelude::*;

use super::chapter::{Chapter, Curve, Diagram, Value};
use super::{Effort, SEED};

/// Patterns from white to blue; one that the registry doesn't have is left out.
const METHODS: [&str; 3] = ["stochastic", "dart-throwing", "farthest-point-strategy"];

/// The estimators and their statistics: ν_eff, Ω.
const ESTIMATORS: [(&str, [Statistic; 2]); 2] = [
    ("windowed", [Statistic::NuEff, Statistic::Omega]),
    ("direct", [Statistic::NuEffDirect, Statistic::OmegaDirect]),
];

/// Sizes to try.
struct Design {
    points: usize,
    /// Ensemble sizes, ascending.
    sets: &'static [usize],
    /// Disjoint ensembles of each size.
    ensembles: usize,
}

const FULL: Design = Design { points: 1024, sets: &[1, 2, 4, 8, 16], ensembles: 16 };
const QUICK: Design = Design { points: 256, sets: &[1, 2, 4], ensembles: 6 };

/// Mean and standard deviation of ν_eff and of Ω over the ensembles, and the time of one.
struct Spread {
    nu_eff: [f64; 2],
    omega: [f64; 2],
    seconds: f64,
}

pub(super) fn measure(effort: Effort) -> Outcome<Chapter> {
    let design = if effort.quick { QUICK } else { FULL };
    let mut rows = Vec::new();
    let mut diagrams = ["spread of Ω", "spread of ν_{eff}", "time / ms"].map(|y| Diagram {
        title: String::new(),
        x: "sets",
        y,
        curves: Vec::new(),
    });
    for name in METHODS {
        let Ok(method) = bn_samplers::find(name) else { continue };
        let pool = pool(method, &design)?;
        for (estimator, statistics) in ESTIMATORS {
            let mut curves = [const { Vec::new() }; 3];
            for &sets in design.sets {
                let spread = spread(&pool[..sets * design.ensembles], sets, statistics);
                let Spread { nu_eff, omega, seconds } = &spread;
                let size = sets as f64;
                curves[0].push([size, omega[1]]);
                curves[1].push([size, nu_eff[1]]);
                curves[2].push([size, seconds * 1e3]);
                let mut row: Vec<Value> = vec![name.into(), estimator.into(), sets.into()];
                let figures = [nu_eff[0], nu_eff[1], omega[0], omega[1], seconds * 1e3];
                row.extend(figures.map(Value::Real));
                rows.push(row);
            }
            for (diagram, points) in diagrams.iter_mut().zip(curves) {
                diagram.curves.push(Curve { name: format!("{name}, {estimator}"), points });
            }
        }
    }
    Ok(Chapter {
        id: "estimators",
        title: "Estimators of the effective Nyquist frequency and the oscillation",
        method: format!(
            "{} disjoint ensembles of each size, sets of {} points: mean and standard deviation \
             over the ensembles, median time of one (all threads, standard errors included). \
             Windowed: from the RDF as in the thesis; direct: from the periodogram's ring means.",
            design.ensembles, design.points
        ),
        columns: &[
            "pattern",
            "estimator",
            "sets",
            "nu_eff",
            "sd of nu_eff",
            "omega",
            "sd of omega",
            "time / ms",
        ],
        rows,
        diagrams: diagrams.into(),
    })
}

/// Sets for the largest ensembles.
fn pool(method: &bn_samplers::Method, design: &Design) -> Outcome<Vec<PointSet>> {
    let sampler = method.with_options([]).map_err(Failure::usage)?;
    let largest = design.sets[design.sets.len() - 1];
    (0..(design.ensembles * largest) as u32)
        .into_par_iter()
        .map(|set| {
            let seed = Seed::new(SEED).for_set(set);
            let sample = sampler.sample(design.points, seed, &Unobserved);
            sample
                .map(|sample| sample.points)
                .map_err(|error| Failure::failed(anyhow::anyhow!("{}: {error}", method.name)))
        })
        .collect()
}

/// What ensembles of `sets` sets give; NaN where a statistic is not defined.
fn spread(pool: &[PointSet], sets: usize, statistics: [Statistic; 2]) -> Spread {
    let mut values = [const { Vec::new() }; 2];
    let mut times = Vec::new();
    for ensemble in pool.chunks_exact(sets) {
        let start = Instant::now();
        let analysis = Analysis::of(black_box(ensemble));
        for (values, statistic) in values.iter_mut().zip(statistics) {
            values.push(analysis.estimate(statistic).map_or(f64::NAN, |estimate| estimate.value));
        }
        times.push(start.elapsed());
    }
    times.sort_unstable();
    let [nu_eff, omega] = values.map(|values| mean_and_deviation(&values));
    Spread { nu_eff, omega, seconds: times[times.len() / 2].as_secs_f64() }
}

/// Mean and the sample's standard deviation.
fn mean_and_deviation(values: &[f64]) -> [f64; 2] {
    let m = values.len() as f64;
    let mean = values.iter().sum::<f64>() / m;
    let squares: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    [mean, (squares / (m - 1.0)).sqrt()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deviations_are_those_of_a_sample() {
        let [mean, deviation] = mean_and_deviation(&[1.0, 2.0, 3.0, 6.0]);
        assert_eq!(mean, 3.0);
        assert!((deviation - (14.0_f64 / 3.0).sqrt()).abs() < 1e-15);
    }

    #[test]
    fn larger_ensembles_spread_less() {
        let design = Design { points: 256, sets: &[1, 16], ensembles: 8 };
        let pool = pool(bn_samplers::find("stochastic").expect("there"), &design).expect("made");
        let omega = |sets: usize| spread(&pool[..8 * sets], sets, ESTIMATORS[0].1).omega;
        // E Omega falls as the root of the number of sets: to a quarter from 1 to 16.
        let ratio = omega(1)[0] / omega(16)[0];
        assert!((2.0..8.0).contains(&ratio), "{ratio}");
    }
}
