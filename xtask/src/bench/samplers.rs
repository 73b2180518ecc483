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

pub(super) fn measure(effort: Effort) -> Outcome<Chapter> {
    // Squares of powers of 2, so that every method can make them.
    let sizes: &[usize] =
        if effort.quick { &[256, 1024] } else { &[1024, 4096, 16_384, 65_536, 262_144] };
    let mut rows = Vec::new();
    let mut curves = Vec::new();
    for method in METHODS {
        let points = measure_method(method, sizes, effort, &mut rows)?;
        curves.push(Curve { name: method.name.to_owned(), points });
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
            "Each method with its default options, one set, all threads. A size is left out where \
             it would take longer than {} s.",
            PATIENCE.as_secs()
        ),
        columns: &["method", "n", "time / s", "points / s", "runs"],
        rows,
        diagrams,
    })
}

fn measure_method(
    method: &'static Method,
    sizes: &[usize],
    effort: Effort,
    rows: &mut Vec<Vec<Value>>,
) -> Outcome<Vec<[f64; 2]>> {
    let sampler = method.with_options([]).map_err(Failure::usage)?;
    let mut points: Vec<[f64; 2]> = Vec::new();
    for &n in sizes {
        if let Some([last, seconds]) = points.last()
            && seconds * (n as f64 / last) > PATIENCE.as_secs_f64()
        {
            break;
        }
        let mut made = Ok(0);
        let timing = effort.budget.median(|| {
            let sample = sampler.sample(black_box(n), Seed::new(SEED), &Unobserved);
            made = sample.map(|sample| sample.points.len());
        });
        let made =
            made.map_err(|error| Failure::failed(anyhow::anyhow!("{}: {error}", method.name)))?;
        points.push([made as f64, timing.seconds]);
        rows.push(vec![
            method.name.into(),
            made.into(),
            timing.seconds.into(),
            (made as f64 / timing.seconds).into(),
            timing.runs.into(),
        ]);
    }
    Ok(points)
}
