//! Every method: points per second.

use std::hint::black_box;
use std::time::Duration;

use bn_cli::{Failure, Outcome};
use bn_core::{Seed, Unobserved};
use bn_samplers::{METHODS, Method};

use super::chapter::{Chapter, Curve, Diagram, Value};
use super::{Effort, SEED};

/// A size is left out when the one before took longer than this times the growth in points.
const PATIENCE: Duration = Duration::from_secs(2);

/// A method's name, its options and a number of points.
type Case = (&'static str, &'static [(&'static str, &'static str)], usize);

/// What is of interest by itself: the sizes at which public Poisson disk samplers are compared.
const CASES: [Case; 2] = [
    ("dart-throwing", &[("radius", "0.7")], 100_000),
    ("maximal-poisson-disk", &[("radius", "0.7")], 100_000),
];

pub(super) fn measure(effort: Effort) -> Outcome<Chapter> {
    // Squares of powers of 2, so that every method can make them.
    let sizes: &[usize] =
        if effort.quick { &[256, 1024] } else { &[1024, 4096, 16_384, 65_536, 262_144] };
    let mut rows = Vec::new();
    let mut curves = Vec::new();
    for method in METHODS {
        let points = measure_sizes(method, sizes, effort, &mut rows)?;
        curves.push(Curve { name: method.name.to_owned(), points });
    }
    for (name, options, n) in CASES.iter().filter(|_| !effort.quick) {
        if let Ok(method) = bn_samplers::find(name) {
            rows.push(measure_one(method, options, *n, effort)?.0);
        }
    }
    let diagrams = curves
        .chunks(6)
        .map(|curves| Diagram {
            title: String::new(),
            x: "points *n*",
            y: "time / s",
            curves: curves.to_vec(),
        })
        .collect();
    Ok(Chapter {
        id: "samplers",
        title: "Samplers",
        method: format!(
            "One set, all threads. A size is left out where it would take longer than {} s.",
            PATIENCE.as_secs()
        ),
        columns: &["method", "options", "points", "time / s", "points / s", "runs"],
        rows,
        diagrams,
    })
}

/// Points and seconds with the default options, as far as patience reaches.
fn measure_sizes(
    method: &'static Method,
    sizes: &[usize],
    effort: Effort,
    rows: &mut Vec<Vec<Value>>,
) -> Outcome<Vec<[f64; 2]>> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    for &n in sizes {
        if let Some([last, seconds]) = points.last()
            && seconds * (n as f64 / last) > PATIENCE.as_secs_f64()
        {
            break;
        }
        let (row, point) = measure_one(method, &[], n, effort)?;
        rows.push(row);
        points.push(point);
    }
    Ok(points)
}

/// A row of the table, and points and seconds.
fn measure_one(
    method: &'static Method,
    options: &[(&'static str, &'static str)],
    n: usize,
    effort: Effort,
) -> Outcome<(Vec<Value>, [f64; 2])> {
    let sampler = method.with_options(options.iter().copied()).map_err(Failure::usage)?;
    let mut made = Ok(0);
    let timing = effort.budget.median(|| {
        let sample = sampler.sample(black_box(n), Seed::new(SEED), &Unobserved);
        made = sample.map(|sample| sample.points.len());
    });
    let made =
        made.map_err(|error| Failure::failed(anyhow::anyhow!("{}: {error}", method.name)))?;
    let typed: Vec<_> = options.iter().map(|(name, value)| format!("--{name} {value}")).collect();
    let row = vec![
        method.name.into(),
        typed.join(" ").as_str().into(),
        made.into(),
        timing.seconds.into(),
        (made as f64 / timing.seconds).into(),
        timing.runs.into(),
    ];
    Ok((row, [made as f64, timing.seconds]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_can_be_made() {
        for (name, options, _) in CASES {
            let Ok(method) = bn_samplers::find(name) else { continue };
            let sampler = method.with_options(options.iter().copied()).expect("its options");
            assert!(sampler.sample(64, Seed::new(SEED), &Unobserved).is_ok(), "{name}");
        }
    }
}
