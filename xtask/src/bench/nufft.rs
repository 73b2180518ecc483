//! The non-uniform FFT: time against the error measured on direct sums, both types.

use std::hint::black_box;

use bn_cli::{Failure, Outcome};
use bn_core::{DVec2, Seed};
use bn_spectral::{Complex, HalfPlane, Nufft, NufftOptions, direct_modes, direct_sums};

use super::bessel::uniform;
use super::chapter::{Chapter, Curve, Diagram, Value};
use super::{Effort, SEED};

/// A transform whose exact result is known.
struct Case {
    points: Vec<DVec2>,
    max_frequency: usize,
    /// Type 1 with unit strengths, by direct sums.
    modes: HalfPlane,
    /// Random modes, the input of type 2 …
    input: HalfPlane,
    /// … and its result by direct sums.
    sums: Vec<f64>,
}

pub(super) fn measure(effort: Effort) -> Outcome<Chapter> {
    let sizes: &[usize] = if effort.quick { &[256, 1024] } else { &[1024, 4096, 16_384] };
    let tolerances: Vec<f64> = (2..=13)
        .step_by(if effort.quick { 4 } else { 1 })
        .map(|i| libm::exp10(-f64::from(i)))
        .collect();
    let mut rows = Vec::new();
    let mut diagrams = [1, 2].map(|kind| Diagram {
        title: format!("type {kind}, one thread"),
        x: "relative *l*_{2} error",
        y: "time / ms",
        curves: Vec::new(),
    });
    for &n in sizes {
        let case = Case::new(n);
        let mut points = [Vec::new(), Vec::new()];
        for &tolerance in &tolerances {
            for kind in [1, 2] {
                let (row, point) = case.measure(kind, tolerance, effort)?;
                rows.push(row);
                points[kind - 1].push(point);
            }
        }
        for (diagram, points) in diagrams.iter_mut().zip(points) {
            diagram.curves.push(Curve { name: format!("*n* = {n}"), points });
        }
    }
    Ok(Chapter {
        id: "nufft",
        title: "NUFFT",
        method:
            "Random points, modes |kx|, |ky| ≤ K = 5√n, planned beforehand, points given anew. \
                 Type 1: unit strengths to modes; type 2: random modes to points. Error: l2 \
                 distance from direct sums over their l2 norm."
                .to_owned(),
        columns: &[
            "type",
            "n",
            "K",
            "tolerance",
            "error",
            "predicted",
            "time / ms, 1 thread",
            "time / ms, all threads",
            "runs",
        ],
        rows,
        diagrams: diagrams.into(),
    })
}

impl Case {
    fn new(n: usize) -> Self {
        let mut rng = Seed::new(SEED).stream(1);
        let mut random = || uniform(&mut rng);
        let points: Vec<_> = (0..n).map(|_| DVec2::new(random(), random())).collect();
        let max_frequency = 5 * (n as f64).sqrt().round() as usize;
        let mut input = HalfPlane::zeros(max_frequency);
        for column in input.columns_mut() {
            column.fill_with(|| Complex::new(random() - 0.5, random() - 0.5));
        }
        let modes = direct_modes(&points, None, max_frequency);
        let sums = direct_sums(&points, &input);
        Self { points, max_frequency, modes, input, sums }
    }

    /// A row of the table and the point (error, milliseconds on one thread) of the diagram.
    fn measure(
        &self,
        kind: usize,
        tolerance: f64,
        effort: Effort,
    ) -> Outcome<(Vec<Value>, [f64; 2])> {
        let n = self.points.len();
        let options = NufftOptions::new(self.max_frequency, tolerance).expecting(n);
        let mut sequential: Nufft = options.sequential().plan().map_err(Failure::failed)?;
        let mut parallel: Nufft = options.plan().map_err(Failure::failed)?;
        let mut modes = HalfPlane::zeros(self.max_frequency);
        let mut sums = vec![0.0; n];
        let mut run = |plan: &mut Nufft| match kind {
            1 => plan.points_to_modes(black_box(&self.points), None, &mut modes),
            _ => plan.modes_to_points(&self.input, black_box(&self.points), &mut sums),
        };
        let all = effort.budget.median(|| run(&mut parallel));
        let one = effort.budget.median(|| run(&mut sequential));
        let error = match kind {
            1 => relative_error(modes.values(), self.modes.values(), Complex::norm_sqr),
            _ => relative_error(&sums, &self.sums, |x| x * x),
        };
        let row = vec![
            Value::Count(kind),
            n.into(),
            self.max_frequency.into(),
            tolerance.into(),
            error.into(),
            sequential.error().into(),
            (one.seconds * 1e3).into(),
            (all.seconds * 1e3).into(),
            one.runs.into(),
        ];
        Ok((row, [error, one.seconds * 1e3]))
    }
}

/// √(Σ|got − want|² / Σ|want|²).
fn relative_error<T: Copy + std::ops::Sub<Output = T>>(
    got: &[T],
    want: &[T],
    squared: impl Fn(&T) -> f64,
) -> f64 {
    let error: f64 = got.iter().zip(want).map(|(&got, &want)| squared(&(got - want))).sum();
    (error / want.iter().map(squared).sum::<f64>()).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_relative_to_the_norm() {
        let error = relative_error(&[3.0, 4.5], &[3.0, 4.0], |x| x * x);
        assert!((error - 0.1).abs() < 1e-15, "{error}");
    }

    #[test]
    fn transforms_meet_their_tolerance_on_the_case() {
        let case = Case::new(256);
        let effort = Effort {
            quick: true,
            budget: super::super::Budget { time: std::time::Duration::ZERO, runs: 1 },
        };
        for (kind, tolerance) in [(1, 1e-4), (2, 1e-9)] {
            let (row, [error, time]) = case.measure(kind, tolerance, effort).expect("planned");
            assert_eq!(row[0], Value::Count(kind));
            assert!(error > 0.0 && error <= tolerance, "type {kind}: {error}");
            assert!(time > 0.0);
        }
    }
}
