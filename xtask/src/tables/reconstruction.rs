//! What the thesis's outlook leaves open: error and time of reconstruction by convolution and by
//! iteration.

use std::hash::{DefaultHasher, Hasher as _};

use bn_cli::analysis::Estimate;
use bn_cli::{Failure, Outcome};
use bn_core::PointSet;
use serde::{Deserialize, Serialize};

use super::{Cell, Context, Row, Table, TableSpec};
use crate::measure::reconstruction::{Cells, Made, PATTERNS, Subject, Way};
use crate::measure::{Plan, Store, hash_points, make, program_digest};
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

/// What one pattern gave.
#[derive(Debug, Serialize, Deserialize)]
struct Values {
    /// `R_c` over `d_hex`.
    coverage: f64,
    /// By scene, way and rate.
    images: Vec<Value>,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Value {
    psnr: f64,
    seconds: f64,
}

/// Renders what was not rendered before.
struct Renderings<'a> {
    rates: &'static [f64],
    side: u32,
    store: Option<&'a Store>,
    /// Made when they are first needed: their references take seconds.
    subjects: Option<[Subject; 2]>,
}

impl Renderings<'_> {
    /// The values that this program measured before of the same points, or new ones.
    fn values(&mut self, set: &PointSet) -> Outcome<Values> {
        let Some(store) = self.store else { return self.measured(set) };
        let mut hasher = DefaultHasher::new();
        hasher.write_u64(program_digest()?);
        hasher.write_u32(self.side);
        hash_points(set, &mut hasher);
        let notes = store.measured("reconstruction", hasher.finish());
        if let Some(values) = notes.read() {
            return Ok(values);
        }
        let values = self.measured(set)?;
        notes.write(&values)?;
        Ok(values)
    }

    fn measured(&mut self, set: &PointSet) -> Outcome<Values> {
        let subjects = match &mut self.subjects {
            Some(subjects) => subjects,
            missing => missing.insert(Subject::both(self.side)?),
        };
        let cells = Cells::of(set);
        let mut images = Vec::new();
        for subject in subjects {
            for way in Way::ALL {
                for &rate in self.rates {
                    let Made { psnr, seconds, .. } = subject.image(&cells, rate, way)?;
                    images.push(Value { psnr, seconds });
                }
            }
        }
        Ok(Values { coverage: cells.coverage, images })
    }
}

fn table(spec: &TableSpec, context: &Context<'_>) -> Outcome<Table> {
    let plan = context.workbench.plan();
    let quick = plan.n < 4096;
    let (rates, side) = if quick { (QUICK_RATES, QUICK_SIDE) } else { (RATES, SIDE) };
    let mut renderings =
        Renderings { rates, side, store: context.workbench.store(), subjects: None };
    let of_scene =
        || Way::ALL.into_iter().flat_map(|way| rates.iter().map(move |rate| (way, rate)));
    // Seconds by way and rate, summed over patterns and scenes.
    let mut times = vec![0.0; of_scene().count()];
    let mut rows = Vec::new();
    for method in PATTERNS {
        let row = context.rows.iter().find(|row| row.method == method);
        let row = row.ok_or_else(|| Failure::misuse(format!("no row of {method}")))?;
        let values = renderings.values(&points(row, plan, quick, context)?)?;
        let mut numbers = vec![cell("R_c", values.coverage)];
        for (scene, images) in Subject::NAMES.iter().zip(values.images.chunks(times.len())) {
            for (((way, rate), image), time) in of_scene().zip(images).zip(&mut times) {
                numbers.push(cell(&format!("{scene}, {rate} spp: {}", way.name()), image.psnr));
                *time += image.seconds;
            }
        }
        rows.push(line(context.judge.thesis().method_name(&row.thesis), row, numbers));
    }
    let images = (PATTERNS.len() * Subject::NAMES.len()) as f64;
    let time = |((way, rate), time): ((Way, &f64), f64)| {
        cell(&format!("time in ms, {rate} spp: {}", way.name()), 1e3 * time / images)
    };
    rows.push(Row {
        label: "Mean of all".to_owned(),
        method: String::new(),
        options: String::new(),
        why: String::new(),
        failure: None,
        cells: of_scene().zip(times).map(time).collect(),
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
