//! Bessel functions: time per value and error against 25-digit references.

use std::hint::black_box;

use anyhow::Context as _;
use bn_cli::{Failure, Outcome};
use bn_core::{Seed, StreamRng};

use super::chapter::{Chapter, Curve, Diagram, Value};
use super::{Effort, SEED};

/// A function in both forms.
struct Function {
    name: &'static str,
    /// Its column in the reference file.
    column: usize,
    scalar: fn(f64) -> f64,
    slice: fn(&[f64], &mut [f64]),
}

const FUNCTIONS: [Function; 3] = [
    Function { name: "j0", column: 1, scalar: bn_spectral::j0, slice: bn_spectral::j0_slice },
    Function { name: "j1", column: 2, scalar: bn_spectral::j1, slice: bn_spectral::j1_slice },
    Function { name: "jinc", column: 3, scalar: bn_spectral::jinc, slice: bn_spectral::jinc_slice },
];

const RANGES: [(f64, f64); 3] = [(0.0, 25.0), (25.0, 1e3), (1e3, 1e6)];

/// Values in a run.
const VALUES: usize = 4096;

pub(super) fn measure(effort: Effort) -> Outcome<Chapter> {
    let reference = reference()?;
    let mut rows = Vec::new();
    let mut curves = Vec::new();
    for function in &FUNCTIONS {
        for (form, slice) in [("scalar", false), ("slice", true)] {
            let name = format!("{} {form}", function.name);
            let mut points = Vec::new();
            for (low, high) in RANGES {
                let run = |x: &[f64], out: &mut [f64]| {
                    if slice {
                        (function.slice)(x, out);
                    } else {
                        out.iter_mut().zip(x).for_each(|(out, &x)| *out = (function.scalar)(x));
                    }
                };
                let x = arguments(low, high);
                let mut out = vec![0.0; x.len()];
                let timing = effort.budget.median(|| run(black_box(&x), black_box(&mut out)));
                let nanoseconds = timing.seconds * 1e9 / VALUES as f64;
                let error = largest_error(&reference, function.column, (low, high), run);
                points.push([nanoseconds, error]);
                rows.push(vec![
                    name.as_str().into(),
                    low.into(),
                    high.into(),
                    nanoseconds.into(),
                    error.into(),
                    Value::Count(timing.runs),
                ]);
            }
            curves.push(Curve { name, points });
        }
    }
    Ok(Chapter {
        id: "bessel",
        title: "Bessel functions",
        method: format!(
            "Scalar: libm, value by value; slice: vectorised. Time: {VALUES} uniform arguments in \
             the range, one thread. Error: largest over the reference arguments in the range, in \
             units of the bound 4ε·min(1, √(2/πx)) (jinc: that over max(1, x))."
        ),
        columns: &["function", "from x", "to x", "time / ns", "error / bound", "runs"],
        rows,
        diagrams: vec![Diagram {
            title: "each range of arguments".to_owned(),
            x: "time per value / ns",
            y: "largest error / bound",
            curves,
        }],
    })
}

/// Uniform arguments in a range.
fn arguments(low: f64, high: f64) -> Vec<f64> {
    let mut rng = Seed::new(SEED).stream(0);
    (0..VALUES).map(|_| low + (high - low) * uniform(&mut rng)).collect()
}

/// A uniform number in [0, 1) of 53 bits.
pub(super) fn uniform(rng: &mut StreamRng) -> f64 {
    use rand::RngExt as _;
    rng.random()
}

/// The reference's rows: x, J₀, J₁, J₁(x)/x.
fn reference() -> Outcome<Vec<[f64; 4]>> {
    let text = include_str!("../../../bn-spectral/tests/data/bessel.csv");
    let row = |line: &str| -> anyhow::Result<[f64; 4]> {
        let numbers: Result<Vec<f64>, _> = line.split(',').map(|v| v.trim().parse()).collect();
        <[f64; 4]>::try_from(numbers?).ok().context("not four columns")
    };
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines
        .map(|line| row(line).with_context(|| format!("reference row {line}")))
        .collect::<anyhow::Result<_>>()
        .map_err(Failure::failed)
}

/// The largest error over the reference arguments in a range, in units of the stated bound.
fn largest_error(
    reference: &[[f64; 4]],
    column: usize,
    (low, high): (f64, f64),
    run: impl Fn(&[f64], &mut [f64]),
) -> f64 {
    let rows = || reference.iter().filter(|row| (low..=high).contains(&row[0]));
    let x: Vec<f64> = rows().map(|row| row[0]).collect();
    let mut out = vec![0.0; x.len()];
    run(&x, &mut out);
    let bound = |x: f64| {
        let envelope = (std::f64::consts::FRAC_2_PI / x).sqrt().min(1.0);
        4.0 * f64::EPSILON * envelope / if column == 3 { x.max(1.0) } else { 1.0 }
    };
    rows().zip(&out).map(|(row, got)| (got - row[column]).abs() / bound(row[0])).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_found_in_every_range() {
        let reference = reference().expect("the file parses");
        assert!(reference.len() > 300);
        for range in RANGES {
            let off = |x: &[f64], out: &mut [f64]| {
                out.iter_mut().zip(x).for_each(|(out, &x)| *out = bn_spectral::j0(x) + 1e-12);
            };
            assert!(largest_error(&reference, 1, range, off) > 1000.0);
            let good = largest_error(&reference, 1, range, bn_spectral::j0_slice);
            assert!(good > 0.0 && good <= 1.0, "{good}");
        }
    }
}
