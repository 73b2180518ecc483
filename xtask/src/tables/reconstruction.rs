//! What the thesis's outlook leaves open: error and time of reconstruction by convolution and by
//! iteration.

use bn_cli::analysis::Estimate;
use bn_cli::{Failure, Outcome};
use bn_core::PointSet;

use super::{Cell, Context, Row, Table, TableSpec};
use crate::measure::reconstruction::{Cells, Made, PATTERNS, Subject, Way};
use crate::measure::{Plan, make};
use crate::thesis::{Judgement, RowSpec};

pub(super) const SPEC: TableSpec = TableSpec {
    id: "reconstruction",
    title: "PSNR in dB and time in ms of convolution and of iterative reconstruction",
    quantities: &[],
    make: table,
};

/// Samples per pixel, and pixels a side.
const RATES: &[f64] = &[1.0, 4.0, 16.0];
const SIDE: u32 = 128;

/// The same where only few points are made.
const QUICK_RATES: &[f64] = &[1.0, 4.0];
const QUICK_SIDE: u32 = 40;
const QUICK_POINTS: usize = 256;

fn table(spec: &TableSpec, context: &Context<'_>) -> Outcome<Table> {
    let plan = context.workbench.plan();
    let quick = plan.n < 4096;
    let (rates, side) = if quick { (QUICK_RATES, QUICK_SIDE) } else { (RATES, SIDE) };
    let subjects = Subject::both(side)?;
    let mut rows = Vec::new();
    // Milliseconds by way and rate, summed over patterns and scenes.
    let mut time = vec![vec![0.0; rates.len()]; Way::ALL.len()];
    for method in PATTERNS {
        let row = context.rows.iter().find(|row| row.method == method);
        let row = row.ok_or_else(|| Failure::misuse(format!("no row of {method}")))?;
        let cells = Cells::of(&points(row, plan, quick, context)?);
        let mut numbers = vec![cell("R_c", cells.coverage)];
        for subject in &subjects {
            for (way, time) in Way::ALL.into_iter().zip(&mut time) {
                for (&rate, time) in rates.iter().zip(time) {
                    let Made { psnr, seconds, .. } = subject.image(&cells, rate, way)?;
                    *time += 1e3 * seconds;
                    let what = format!("{}, {rate} spp: {}", subject.name, way.name());
                    numbers.push(cell(&what, psnr));
                }
            }
        }
        rows.push(line(context.judge.thesis().method_name(&row.thesis), row, numbers));
    }
    let images = (PATTERNS.len() * subjects.len()) as f64;
    let of = |(way, times): (Way, Vec<f64>)| {
        let at = |(rate, time): (&f64, f64)| {
            cell(&format!("time in ms, {rate} spp: {}", way.name()), time / images)
        };
        rates.iter().zip(times).map(at).collect::<Vec<_>>()
    };
    let times = Way::ALL.into_iter().zip(time).flat_map(of).collect();
    rows.push(Row {
        label: "Mean of all".to_owned(),
        method: String::new(),
        options: String::new(),
        why: String::new(),
        failure: None,
        cells: times,
    });
    Ok(Table { id: spec.id, title: spec.title, decimals: 1, rows })
}

/// The row's first set; few points where only few are wanted, and those are not kept.
fn points(row: &RowSpec, plan: Plan, quick: bool, context: &Context<'_>) -> Outcome<PointSet> {
    let method =
        row.method().ok_or_else(|| Failure::misuse(format!("no method {}", row.method)))?;
    let n = if quick { QUICK_POINTS } else { plan.n };
    let plan = Plan { n, sets: 1, ..plan };
    let made = make::sets(row, method, plan, context.workbench.store())?;
    Ok(made.map_err(Failure::failed)?.0.remove(0))
}

fn cell(what: &str, value: f64) -> Cell {
    let judgement = Judgement::shown("no table of the thesis has it; shown, not judged");
    Cell::new(&what, Some(Estimate { value, std_error: None }), judgement)
}

fn line(label: &str, row: &RowSpec, cells: Vec<Cell>) -> Row {
    Row {
        label: label.to_owned(),
        method: row.method.clone(),
        options: row.options_text(),
        why: row.why.clone(),
        failure: None,
        cells,
    }
}
