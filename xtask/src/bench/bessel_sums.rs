//! The lattice sums behind the radial power of an RDF: planned against term by term.

use std::f64::consts::TAU;
use std::hint::black_box;

use bn_cli::Outcome;
use bn_core::Seed;
use bn_spectral::{BesselSums, j0_slice};

use super::bessel::uniform;
use super::chapter::{Chapter, Curve, Diagram, Value};
use super::{Effort, SEED};

/// Δr·Δν of the thesis's estimator for any n: 1/(200√n) · √n/200.
const ALPHA: f64 = 1.0 / 40_000.0;

#[expect(clippy::unnecessary_wraps, reason = "chapters may fail")]
pub(super) fn measure(effort: Effort) -> Outcome<Chapter> {
    let sizes: &[usize] = if effort.quick { &[400, 800] } else { &[800, 1600, 3200, 6400, 12_800] };
    let (mut planned, mut plain) = (Vec::new(), Vec::new());
    let mut rows = Vec::new();
    for &radii in sizes {
        let [plan, apply, each, error] = measure_size(radii, effort);
        planned.push([radii as f64, apply * 1e3]);
        plain.push([radii as f64, each * 1e3]);
        let mut row: Vec<Value> = vec![radii.into(), (2 * radii).into()];
        row.extend([plan * 1e3, apply * 1e3, each * 1e3, each / apply, error].map(Value::Real));
        rows.push(row);
    }
    let curve = |name: &str, points| Curve { name: name.to_owned(), points };
    Ok(Chapter {
        id: "bessel-sums",
        title: "Lattice sums of Bessel functions",
        method: "Σ c_i J0(2π α i j) for i < radii, j < frequencies, α = 1/40000, random c: the \
                 transform of an RDF at n = (radii/50)². Term by term: every J0 by the slice \
                 function. One thread. Error: largest over every 37th frequency, over Σ|c_i|."
            .to_owned(),
        columns: &[
            "radii",
            "frequencies",
            "plan / ms",
            "apply / ms",
            "term by term / ms",
            "ratio",
            "error",
        ],
        rows,
        diagrams: vec![Diagram {
            title: String::new(),
            x: "radii",
            y: "time / ms",
            curves: vec![curve("planned", planned), curve("term by term", plain)],
        }],
    })
}

/// Seconds for planning, for applying, for all sums term by term, and the error.
fn measure_size(radii: usize, effort: Effort) -> [f64; 4] {
    let frequencies = 2 * radii;
    let mut rng = Seed::new(SEED).stream(2);
    let coefficients: Vec<f64> = (0..radii).map(|_| uniform(&mut rng) - 0.5).collect();
    let planning = effort.budget.median(|| {
        black_box(BesselSums::new(radii, frequencies, black_box(ALPHA)));
    });
    let plan = BesselSums::new(radii, frequencies, ALPHA);
    let mut scratch = plan.scratch();
    let mut sums = vec![0.0; frequencies];
    let applying = effort.budget.median(|| {
        plan.apply_into(black_box(&coefficients), black_box(&mut sums), &mut scratch);
    });
    let (mut x, mut bessel) = (vec![0.0; radii], vec![0.0; radii]);
    let mut term_by_term = |j: usize| -> f64 {
        for (i, x) in x.iter_mut().enumerate() {
            *x = TAU * ALPHA * (i * j) as f64;
        }
        j0_slice(&x, &mut bessel);
        bessel.iter().zip(&coefficients).map(|(b, c)| b * c).sum()
    };
    let total: f64 = coefficients.iter().map(|c| c.abs()).sum();
    let error = (0..frequencies)
        .step_by(37)
        .map(|j| (sums[j] - term_by_term(j)).abs() / total)
        .fold(0.0, f64::max);
    let one = effort.budget.median(|| {
        black_box(term_by_term(black_box(radii)));
    });
    [planning.seconds, applying.seconds, one.seconds * frequencies as f64, error]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_is_what_the_plan_states() {
        let budget = super::super::Budget { time: std::time::Duration::ZERO, runs: 1 };
        let [.., error] = measure_size(400, Effort { quick: true, budget });
        assert!(error > 0.0 && error < 4e-12, "{error}");
    }
}
