//! The Hankel transform of order 0: nodes and time against error on closed-form pairs.

use std::f64::consts::{PI, TAU};
use std::hint::black_box;

use anyhow::Context as _;
use bn_cli::{Failure, Outcome};
use bn_spectral::{HankelPlan, j0, j1};

use super::Effort;
use super::chapter::{Chapter, Curve, Diagram, Value};

/// A pair with a closed form on both sides.
struct Pair {
    /// As in the reference file.
    name: &'static str,
    parameters: &'static str,
    f: fn(f64) -> f64,
    /// Where f is cut off, from coarse to good.
    ranges: &'static [f64],
}

const PAIRS: [Pair; 4] = [
    Pair {
        name: "gaussian",
        parameters: "a=1",
        f: |r| libm::exp(-PI * r * r),
        ranges: &[0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0],
    },
    Pair {
        name: "exp",
        parameters: "a=1",
        f: |r| libm::exp(-r),
        ranges: &[2.0, 4.0, 8.0, 12.0, 16.0, 24.0, 32.0, 40.0],
    },
    Pair {
        name: "gauss_windowed_jinc",
        parameters: "a=1/sqrt(pi);s=0.25",
        f: |r| {
            let a = PI.sqrt().recip();
            a * j1(TAU * a * r) / r * libm::exp(-PI * (0.25 * r) * (0.25 * r))
        },
        ranges: &[2.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0],
    },
    Pair {
        name: "inverse_cubic",
        parameters: "",
        f: |r| (1.0 + r * r).powf(-1.5),
        ranges: &[4.0, 16.0, 64.0, 256.0, 1024.0],
    },
];

/// The scale on which all of these are smooth.
const SCALE: f64 = 0.5;

pub(super) fn measure(effort: Effort) -> Outcome<Chapter> {
    let mut rows = Vec::new();
    let mut plans = Vec::new();
    let mut trapezoids = Vec::new();
    for pair in &PAIRS {
        let reference = reference(pair)?;
        let (mut by_plan, mut by_trapezoid) = (Vec::new(), Vec::new());
        for &range in pair.ranges.iter().step_by(if effort.quick { 3 } else { 1 }) {
            let (row, nodes, error) = measure_plan(pair, range, &reference, effort);
            let naive = error_of(&reference, |u| trapezoid(pair.f, range, nodes, u));
            by_plan.push([nodes as f64, error]);
            by_trapezoid.push([nodes as f64, naive]);
            rows.push([row, vec![naive.into()]].concat());
        }
        let name = pair.name.replace('_', " ");
        plans.push(Curve { name: name.clone(), points: by_plan });
        trapezoids.push(Curve { name, points: by_trapezoid });
    }
    let diagram = |title: &str, curves| Diagram {
        title: title.to_owned(),
        x: "nodes",
        y: "largest error / largest value",
        curves,
    };
    Ok(Chapter {
        id: "hankel",
        title: "Hankel transform",
        method: "Pairs with closed forms, f cut off at a range that grows, at the 16 frequencies \
                 (0 to 5) of the reference; error: largest over them, relative to the largest \
                 value; beside it that of the trapezoid rule with as many nodes."
            .to_owned(),
        columns: &[
            "transform",
            "range",
            "nodes",
            "plan / us",
            "apply / us",
            "error",
            "trapezoid's",
        ],
        rows,
        diagrams: vec![
            diagram("Gauss panels (HankelPlan)", plans),
            diagram("trapezoid rule", trapezoids),
        ],
    })
}

/// A row, the number of nodes and the error of a plan for `range`.
fn measure_plan(
    pair: &Pair,
    range: f64,
    reference: &[[f64; 2]],
    effort: Effort,
) -> (Vec<Value>, usize, f64) {
    let frequencies: Vec<f64> = reference.iter().map(|row| row[0]).collect();
    let plan = HankelPlan::new(&[0.0, range], SCALE, &frequencies);
    let planning = effort.budget.median(|| {
        black_box(HankelPlan::new(black_box(&[0.0, range]), SCALE, &frequencies));
    });
    let values: Vec<f64> = plan.nodes().iter().map(|&r| (pair.f)(r)).collect();
    let mut transform = vec![0.0; frequencies.len()];
    let applying =
        effort.budget.median(|| plan.apply_into(black_box(&values), black_box(&mut transform)));
    let mut got = transform.iter();
    let error = error_of(reference, |_| got.next().copied().unwrap_or(f64::NAN));
    let row = vec![
        format!("{} {}", pair.name, pair.parameters).trim().into(),
        range.into(),
        values.len().into(),
        (planning.seconds * 1e6).into(),
        (applying.seconds * 1e6).into(),
        error.into(),
    ];
    (row, values.len(), error)
}

/// 2π ∫ r f(r) J₀(2πru) dr up to `range` by the trapezoid rule; the integrand vanishes at 0.
fn trapezoid(f: fn(f64) -> f64, range: f64, nodes: usize, u: f64) -> f64 {
    let step = range / nodes as f64;
    let term = |i: usize| {
        let r = i as f64 * step;
        r * f(r) * j0(TAU * r * u) * if i == nodes { 0.5 } else { 1.0 }
    };
    TAU * step * (1..=nodes).map(term).sum::<f64>()
}

/// The largest error of `transform`, asked for in the reference's order, over the largest value.
fn error_of(reference: &[[f64; 2]], mut transform: impl FnMut(f64) -> f64) -> f64 {
    let largest = reference.iter().map(|row| row[1].abs()).fold(0.0, f64::max);
    reference.iter().map(|row| (transform(row[0]) - row[1]).abs()).fold(0.0, f64::max) / largest
}

/// Frequencies and transform of a pair, from the reference file.
fn reference(pair: &Pair) -> Outcome<Vec<[f64; 2]>> {
    let text = include_str!("../../../bn-spectral/tests/data/hankel_pairs.csv");
    let mut rows = Vec::new();
    for line in text.lines() {
        let columns: Vec<_> = line.split(',').collect();
        if let [name, parameters, u, value] = columns[..]
            && (name, parameters) == (pair.name, pair.parameters)
        {
            let number = |text: &str| -> Outcome<f64> {
                let number = text.trim().parse().with_context(|| format!("reference row {line}"));
                number.map_err(Failure::failed)
            };
            rows.push([number(u)?, number(value)?]);
        }
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pair_is_in_the_reference_and_converges_to_it() {
        for pair in &PAIRS {
            let reference = reference(pair).expect("the file parses");
            assert_eq!(reference.len(), 16, "{}", pair.name);
            let error = |range: f64| {
                error_of(&reference, |u| {
                    HankelPlan::new(&[0.0, range], SCALE, &[u]).transform(pair.f)[0]
                })
            };
            let (coarse, good) = (pair.ranges[0], pair.ranges[pair.ranges.len() - 1]);
            // A tail that falls off as 1/r² leaves 2π/range; the others end in rounding.
            let limit = if pair.name == "inverse_cubic" { 1.0 / good } else { 1e-12 };
            assert!(error(good) <= limit, "{}: {}", pair.name, error(good));
            assert!(error(coarse) > 10.0 * limit, "{}", pair.name);
        }
    }

    #[test]
    fn the_trapezoid_rule_converges_quadratically() {
        let f = |r: f64| libm::exp(-r);
        let exact = TAU / (1.0 + TAU * TAU).powf(1.5);
        let error = |nodes| (trapezoid(f, 40.0, nodes, 1.0) - exact).abs();
        let ratio = error(4000) / error(8000);
        assert!((ratio - 4.0).abs() < 0.1, "{ratio}");
    }
}
