//! The tables that print statistics of point sets, method by method: 3.1, 4.2, 5.2 and appendix B.

use bn_cli::Outcome;

use super::{Cell, Context, Row, Table, TableSpec};
use crate::measure::Measured;
use crate::thesis::{Quantity, RowSpec};

/// The table `spec` with the rows that the thesis prints in it, in its order; several methods of
/// ours may share one.
pub(super) fn table(spec: &TableSpec, context: &Context<'_>) -> Outcome<Table> {
    let mut rows = Vec::new();
    for key in context.judge.thesis().methods_of(spec.id) {
        for row in context.rows.of(key) {
            rows.push(measured_row(spec, row, context)?);
        }
    }
    Ok(Table { id: spec.id, title: spec.title, decimals: 2, rows })
}

fn measured_row(spec: &TableSpec, row: &RowSpec, context: &Context<'_>) -> Outcome<Row> {
    let measured = context.workbench.measure(row)?;
    let cell = |&quantity: &Quantity| match &*measured {
        Measured::NotYet => {
            Cell::new(&quantity, None, context.judge.not_yet(spec.id, row, quantity))
        }
        Measured::Failed(_) => {
            Cell::new(&quantity, None, context.judge.judge(spec.id, row, quantity, None))
        }
        Measured::Values(values) => {
            let ours = values.get(&quantity).copied().flatten();
            let value = ours.map(|ours| ours.value);
            Cell::new(&quantity, ours, context.judge.judge(spec.id, row, quantity, value))
        }
    };
    let failure = match &*measured {
        Measured::Failed(reason) => Some(reason.clone()),
        _ => None,
    };
    Ok(Row {
        label: context.judge.thesis().method_name(&row.thesis).to_owned(),
        method: row.method.clone(),
        options: row.options_text(),
        why: row.why.clone(),
        failure,
        cells: spec.quantities.iter().map(cell).collect(),
    })
}
