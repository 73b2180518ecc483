//! A table as data: what is printed, written as Markdown and as JSON.

use bn_cli::analysis::Estimate;
use serde::Serialize;

use crate::thesis::{Judgement, Verdict};

/// A table of the thesis with our values beside.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Table {
    /// Its number in the thesis: `"3.1"`, …, `"B"` for appendix B.
    pub(crate) id: &'static str,
    pub(crate) title: &'static str,
    /// Decimals that the thesis prints; ours have one more.
    #[serde(skip)]
    pub(crate) decimals: usize,
    pub(crate) rows: Vec<Row>,
}

/// A row: one method, or one entry of another kind.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Row {
    pub(crate) label: String,
    /// The method's name in the registry.
    pub(crate) method: String,
    /// The options that are not the method's defaults, as typed.
    pub(crate) options: String,
    /// Why this method with these options.
    pub(crate) why: String,
    /// What went wrong, if the method gave no points.
    pub(crate) failure: Option<String>,
    pub(crate) cells: Vec<Cell>,
}

/// One number of a row.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Cell {
    pub(crate) quantity: String,
    pub(crate) ours: Option<f64>,
    pub(crate) std_error: Option<f64>,
    /// Ours less the thesis's.
    pub(crate) difference: Option<f64>,
    #[serde(flatten)]
    pub(crate) judgement: Judgement,
}

impl Cell {
    pub(crate) fn new(
        quantity: &impl ToString,
        ours: Option<Estimate>,
        judgement: Judgement,
    ) -> Self {
        let value = ours.map(|ours| ours.value);
        Self {
            quantity: quantity.to_string(),
            ours: value,
            std_error: ours.and_then(|ours| ours.std_error),
            difference: value.zip(judgement.thesis).map(|(ours, thesis)| ours - thesis),
            judgement,
        }
    }

    pub(crate) fn verdict(&self) -> Verdict {
        self.judgement.verdict
    }
}

impl Table {
    pub(crate) fn cells(&self) -> impl Iterator<Item = &Cell> {
        self.rows.iter().flat_map(|row| &row.cells)
    }
}
