//! Methods that move points: quality against run time.

use bn_cli::{Failure, Outcome};
use bn_core::{PointSet, Seed};
use bn_geometry::{Spacing, Triangulation, voronoi_cells};

use super::chapter::{Chapter, Curve, Diagram, Value};

use super::{Effort, SEED};
use crate::measure::course::{self, Moment};

/// Methods that are after the same.
struct Contest {
    quantities: &'static [Quantity],
    contenders: &'static [Contender],
    /// Number of points.
    n: usize,
}

/// What is to grow or to shrink.
struct Quantity {
    name: &'static str,
    of: fn(&PointSet) -> f64,
}

/// A method and its options.
struct Contender {
    label: &'static str,
    method: &'static str,
    options: &'static [(&'static str, &'static str)],
}

const CONTESTS: [Contest; 2] = [
    Contest {
        quantities: &[
            Quantity { name: "d_{min}", of: d_min },
            Quantity { name: "d_{avg}", of: d_avg },
        ],
        contenders: &[
            Contender { label: "global", method: "fpo", options: &[("variant", "global")] },
            Contender { label: "local", method: "fpo", options: &[("variant", "local")] },
            Contender { label: "hybrid", method: "fpo", options: &[("variant", "hybrid")] },
            Contender {
                label: "constrained",
                method: "fpo",
                options: &[("variant", "constrained")],
            },
            Contender { label: "Lloyd", method: "lloyd", options: &[("iterations", "1000")] },
        ],
        n: 4096,
    },
    Contest {
        quantities: &[
            Quantity { name: "energy excess", of: energy_excess },
            Quantity { name: "d_{avg}", of: d_avg },
        ],
        contenders: &[
            Contender { label: "Lloyd", method: "lloyd", options: &[("iterations", "1000")] },
            Contender { label: "CCCVT", method: "cccvt", options: &[("tolerance", "0.004")] },
            Contender { label: "by swaps", method: "cccvt", options: &[("discrete", "true")] },
            Contender { label: "BNOT", method: "bnot", options: &[("tolerance", "0.003")] },
            Contender { label: "kernel density", method: "kernel-density", options: &[] },
            Contender { label: "electrostatic", method: "electrostatic", options: &[] },
        ],
        n: 4096,
    },
];

/// n·∫ d² over the torus, with d the distance to the nearest point, for the hexagonal lattice: 5/(18√3).
const LEAST_ENERGY: f64 = 0.160_375_074_774_896;

/// By how much that energy exceeds the least possible, as a fraction of it.
fn energy_excess(points: &PointSet) -> f64 {
    let cells = voronoi_cells(&Triangulation::new(points));
    let energy: f64 = cells.iter().map(|cell| cell.second_moment).sum();
    energy * points.len() as f64 / LEAST_ENERGY - 1.0
}

fn d_min(points: &PointSet) -> f64 {
    points.density().normalize_distance(Spacing::new(points).min()).value()
}

fn d_avg(points: &PointSet) -> f64 {
    points.density().normalize_distance(Spacing::new(points).mean()).value()
}

/// Points of a quick run: enough for every variant to be itself.
const QUICK: usize = 1024;

pub(super) fn measure(effort: Effort) -> Outcome<Chapter> {
    let mut rows = Vec::new();
    let mut diagrams = Vec::new();
    for contest in &CONTESTS {
        let n = if effort.quick { contest.n.min(QUICK) } else { contest.n };
        let runs = contest.contenders.iter().map(|contender| contender.run(n));
        let runs = runs.collect::<Outcome<Vec<_>>>()?;
        for quantity in contest.quantities {
            let mut curves = Vec::new();
            for (contender, moments) in contest.contenders.iter().zip(&runs) {
                let values = moments.iter().map(|moment| (quantity.of)(&moment.points));
                let values: Vec<f64> = values.collect();
                rows.extend(contender.rows(quantity, n, moments, &values));
                curves.push(curve(contender.label, moments, &values));
            }
            diagrams.push(Diagram {
                title: String::new(),
                x: "time / s",
                y: quantity.name,
                curves,
            });
        }
    }
    Ok(Chapter {
        id: "optimizers",
        title: "Methods that move points",
        method: "One run each from random points, all threads; the table shows every fourth \
                 recorded moment of the curves, and the last. The energy is n times the mean \
                 squared distance to the nearest point, its excess that over the hexagonal \
                 lattice's."
            .to_owned(),
        columns: &["method", "options", "points", "quantity", "iterations", "time / s", "value"],
        rows,
        diagrams,
    })
}

impl Contender {
    fn run(&self, n: usize) -> Outcome<Vec<Moment>> {
        let method = bn_samplers::find(self.method).map_err(Failure::usage)?;
        let sampler = method.with_options(self.options.iter().copied()).map_err(Failure::usage)?;
        course::follow(&*sampler, n, Seed::new(SEED))
    }

    fn rows(
        &self,
        quantity: &Quantity,
        n: usize,
        moments: &[Moment],
        values: &[f64],
    ) -> Vec<Vec<Value>> {
        let options: Vec<_> = self.options.iter().map(|(k, v)| format!("--{k} {v}")).collect();
        let last = moments.len() - 1;
        let shown = (0..=last).filter(|&i| i % 4 == 0 || i == last);
        let row = |i: usize| {
            vec![
                self.method.into(),
                options.join(" ").as_str().into(),
                n.into(),
                quantity.name.into(),
                (moments[i].iteration as usize).into(),
                moments[i].seconds.into(),
                values[i].into(),
            ]
        };
        shown.map(row).collect()
    }
}

/// The course from where half of the last value, or double, is reached: what comes before takes
/// hardly any time and would press the rest together.
fn curve(label: &str, moments: &[Moment], values: &[f64]) -> Curve {
    let last = values.last().copied().unwrap_or(f64::NAN);
    let is_near = |value: f64| (0.5..2.0).contains(&(value / last));
    let points = moments.iter().zip(values).map(|(moment, &value)| [moment.seconds, value]);
    let points = points.skip(1).skip_while(|point| !is_near(point[1])).collect();
    Curve { name: label.to_owned(), points }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_contender_improves() {
        for contest in &CONTESTS {
            for contender in contest.contenders {
                let moments = contender.run(64).expect("valid");
                assert!(moments.len() > 2, "{}", contender.label);
                for quantity in contest.quantities {
                    let [first, last] =
                        [0, moments.len() - 1].map(|i| (quantity.of)(&moments[i].points));
                    assert!(last != first, "{} of {}", quantity.name, contender.label);
                }
            }
        }
    }
}
