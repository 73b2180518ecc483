//! Table 4.1: iterations until `d_min` and `d_avg` are reached from random points.

use bn_cli::Outcome;
use bn_cli::analysis::Estimate;

use super::{Cell, Context, Row, Table, TableSpec};
use crate::measure::trace::{self, LEVELS, Reached};
use crate::thesis::{Counts, RowSpec};

pub(super) const SPEC: TableSpec = TableSpec {
    id: "4.1",
    title: "Iterations until d_min and d_avg are reached from random points",
    quantities: &[],
    make: table,
};

/// A row of the table.
struct Contender {
    /// The thesis's key.
    thesis: &'static str,
    label: &'static str,
    method: &'static str,
    options: &'static [(&'static str, &'static str)],
    counts: Counts,
}

const CONTENDERS: [Contender; 4] = [
    Contender {
        thesis: "lloyd",
        label: "Lloyd",
        method: "lloyd",
        options: &[("iterations", "1000"), ("tolerance", "0")],
        counts: Counts::Alike,
    },
    Contender {
        thesis: "cccvt",
        label: "CCCVT",
        method: "cccvt",
        options: &[],
        counts: Counts::NotComparable(
            "iterations of the continuous power-diagram form, which the thesis doesn't have, and only as \
             far as the method's own stop",
        ),
    },
    Contender {
        thesis: "fpo_local",
        label: "Local FPO",
        method: "fpo",
        options: &[("variant", "local")],
        counts: Counts::AtMost,
    },
    Contender {
        thesis: "fpo_global",
        label: "Global FPO",
        method: "fpo",
        options: &[("variant", "global")],
        counts: Counts::AtMost,
    },
];

fn table(spec: &TableSpec, context: &Context<'_>) -> Outcome<Table> {
    let rows =
        CONTENDERS.iter().map(|contender| row(contender, context)).collect::<Outcome<_>>()?;
    Ok(Table { id: spec.id, title: spec.title, decimals: 0, rows })
}

fn row(contender: &Contender, context: &Context<'_>) -> Outcome<Row> {
    let spec = RowSpec {
        thesis: contender.thesis.to_owned(),
        method: contender.method.to_owned(),
        options: contender.options.iter().map(|&(k, v)| (k.to_owned(), v.to_owned())).collect(),
        why: String::new(),
    };
    let workbench = context.workbench;
    let runs = match spec.method() {
        Some(_) => Some(trace::runs(&spec, workbench.plan(), workbench.store())?),
        None => None,
    };
    let mut cells = Vec::new();
    for (quantity, column) in [("d_min", 0), ("d_avg", 1)] {
        for (i, level) in LEVELS.iter().enumerate() {
            let key = format!("iterations_to_{quantity}_{level}");
            let of_run = |run: &Reached| [run.d_min, run.d_avg][column][i];
            let reached: Option<Vec<Option<u64>>> =
                runs.as_ref().map(|runs| runs.iter().map(of_run).collect());
            let judgement = context.judge.judge_count(
                SPEC.id,
                contender.thesis,
                &key,
                reached.as_deref(),
                contender.counts,
            );
            cells.push(Cell::new(&format!("{quantity} {level}"), mean(reached), judgement));
        }
    }
    let (label, method) = (contender.label.to_owned(), contender.method.to_owned());
    let options = spec.options_text();
    Ok(Row { label, method, options, why: String::new(), failure: None, cells })
}

/// The mean over the runs that got there.
fn mean(reached: Option<Vec<Option<u64>>>) -> Option<Estimate> {
    let counts: Vec<f64> = reached?.into_iter().flatten().map(|count| count as f64).collect();
    Estimate::mean(&counts)
}
