//! Table 5.3: PSNR of an image made smaller, at high sampling rates.

use bn_cli::Outcome;
use bn_cli::analysis::Estimate;
use bn_core::PointSet;
use bn_render::Normalization;
use rayon::prelude::*;

use super::{Cell, Context, Row, Table, TableSpec};
use crate::measure::downsampling::Downsampling;
use crate::thesis::{Judgement, RowSpec};

pub(super) const SPEC: TableSpec = TableSpec {
    id: "5.3",
    title: "PSNR in dB of an image downsampled at high sampling rates",
    quantities: &[],
    make: table,
};

/// The thesis's samples per pixel.
const RATES: [u32; 4] = [16, 32, 64, 128];

/// Images of each row, as in the thesis, whatever the number of sets.
const IMAGES: u32 = 10;

/// The methods that the thesis made by its own slow algorithm, with as many iterations as their
/// spectra need, and as many sets as time allows.
const BY_FORCE: [(&str, &str); 2] = [("step", "1000"), ("single-peak", "2000")];
const FORCE_SETS: u32 = 1;

/// Iterations where the points are fewer than the thesis's and nothing is judged.
const FEW_ITERATIONS: &str = "100";

/// A row before it is judged.
struct Measured {
    spec: RowSpec,
    /// Whether the thesis's row is meant, not one beside it.
    is_thesis: bool,
    /// PSNR of all images, rate by rate: normalised by density, and plain.
    values: Result<Values, String>,
}

fn table(spec: &TableSpec, context: &Context<'_>) -> Outcome<Table> {
    let test = Downsampling::new()?;
    let contenders = contenders(context);
    let wanted: Vec<_> = contenders.iter().map(|(row, _)| (row.clone(), most_sets(row))).collect();
    let mut measured = Vec::new();
    for ((spec, is_thesis), sets) in
        contenders.into_iter().zip(context.workbench.point_sets(&wanted)?)
    {
        let values = sets.map(|sets| measure(&spec, &sets, &test));
        let values = match values {
            Ok(values) => Ok(values?),
            Err(reason) => Err(reason),
        };
        measured.push(Measured { spec, is_thesis, values });
    }
    let last: Vec<(&str, f64)> = (measured.iter())
        .filter(|row| row.is_thesis)
        .filter_map(|row| Some((&*row.spec.thesis, row.mean(0, RATES.len() - 1)?)))
        .collect();
    let mut rows: Vec<Row> = measured.iter().map(|row| judged(row, &last, context)).collect();
    rows.push(reference(&test)?);
    Ok(Table { id: spec.id, title: spec.title, decimals: 1, rows })
}

/// The rows: the thesis's in its order, those of step and single-peak sets by its own algorithm, and
/// beside them by ours.
fn contenders(context: &Context<'_>) -> Vec<(RowSpec, bool)> {
    let mut rows = Vec::new();
    for key in context.judge.thesis().methods_of(SPEC.id) {
        for row in context.rows.of(key) {
            let by_force = BY_FORCE.iter().find(|(method, _)| *method == row.method);
            if let Some((_, iterations)) = by_force {
                let few = context.workbench.plan().n < 4096;
                let iterations = if few { FEW_ITERATIONS } else { iterations };
                let options = [("algorithm", "force"), ("iterations", iterations)];
                let options = options.map(|(name, value)| (name.to_owned(), value.to_owned()));
                let why =
                    format!("the thesis's algorithm; {FORCE_SETS} set, shifted for each image");
                rows.push((RowSpec { options: options.into(), why, ..row.clone() }, true));
            }
            rows.push((row.clone(), by_force.is_none()));
        }
    }
    rows
}

fn most_sets(row: &RowSpec) -> u32 {
    let by_force = row.options.get("algorithm").is_some_and(|algorithm| algorithm == "force");
    if by_force { FORCE_SETS } else { IMAGES }
}

/// PSNR of all images, by normalisation, image and rate.
type Values = [Vec<[f64; RATES.len()]>; 2];

fn measure(spec: &RowSpec, sets: &[PointSet], test: &Downsampling) -> Outcome<Values> {
    let start = std::time::Instant::now();
    let image = |index: u32, normalization| -> Outcome<[f64; RATES.len()]> {
        let set = &sets[index as usize % sets.len()];
        let mut values = [0.0; RATES.len()];
        for (value, rate) in values.iter_mut().zip(RATES) {
            *value = test.psnr(set, index, f64::from(rate), normalization)?;
        }
        Ok(values)
    };
    let all = |normalization| -> Outcome<Vec<_>> {
        (0..IMAGES).into_par_iter().map(|index| image(index, normalization)).collect()
    };
    let values = [all(Normalization::Density)?, all(Normalization::None)?];
    eprintln!(
        "{:<24} {} images from {} sets in {:.2} s",
        spec.method,
        2 * IMAGES as usize * RATES.len(),
        sets.len(),
        start.elapsed().as_secs_f64()
    );
    Ok(values)
}

impl Measured {
    /// The images' values at one rate.
    fn at(&self, plain: usize, rate: usize) -> Option<Estimate> {
        let images = &self.values.as_ref().ok()?[plain];
        let values: Vec<f64> = images.iter().map(|image| image[rate]).collect();
        Estimate::mean(&values)
    }

    fn mean(&self, plain: usize, rate: usize) -> Option<f64> {
        Some(self.at(plain, rate)?.value)
    }
}

/// The row with its cells judged; `last` holds the ranking at the highest rate.
fn judged(row: &Measured, last: &[(&str, f64)], context: &Context<'_>) -> Row {
    let (judge, key) = (context.judge, &*row.spec.thesis);
    let mut cells = Vec::new();
    for (i, rate) in RATES.into_iter().enumerate() {
        let ours = row.at(0, i);
        let judgement = match ours {
            Some(ours) if row.is_thesis => judge.judge_psnr(key, rate, ours.value),
            _ => judge.show_psnr(key, rate, None),
        };
        cells.push(Cell::new(&format!("{rate} spp"), ours, judgement));
    }
    for (i, rate) in RATES.into_iter().enumerate() {
        let reason = Some("plain convolution, without the division by the density of samples");
        let judgement = judge.show_psnr(key, rate, reason);
        cells.push(Cell::new(&format!("{rate} spp, plain"), row.at(1, i), judgement));
    }
    let highest = RATES.len() - 1;
    if let (true, Some(value)) = (row.is_thesis, row.mean(0, highest)) {
        let misplaced = judge.misplaced(key, value, last, RATES[highest]);
        let why = "how far, in dB, from the thesis's order of methods; not judged";
        let judgement = Judgement::shown(why);
        cells.push(Cell::new(
            &format!("misplaced at {} spp", RATES[highest]),
            Some(alone(misplaced)),
            judgement,
        ));
    }
    if let ("random", Some(first), Some(value)) = (key, row.mean(0, 0), row.mean(0, highest)) {
        let gain = (value - first) / highest as f64;
        cells.push(Cell::new(&"gain per doubling", Some(alone(gain)), judge.judge_doubling(gain)));
    }
    Row {
        label: judge.thesis().method_name(key).to_owned(),
        method: row.spec.method.clone(),
        options: row.spec.options_text(),
        why: row.spec.why.clone(),
        failure: row.values.as_ref().err().cloned(),
        cells,
    }
}

/// How good the reference itself is.
fn reference(test: &Downsampling) -> Outcome<Row> {
    let judgement = Judgement::shown("the reference against the convolution by quadrature");
    Ok(Row {
        label: "Reference".to_owned(),
        method: "hexagonal".to_owned(),
        options: String::new(),
        why: String::new(),
        failure: None,
        cells: vec![Cell::new(&"512 spp", Some(alone(test.reference_psnr()?)), judgement)],
    })
}

/// A value without an error.
fn alone(value: f64) -> Estimate {
    Estimate { value, std_error: None }
}
