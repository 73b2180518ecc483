//! Table 5.3: PSNR of an image made smaller, at high sampling rates.

mod psnr;

use std::time::Instant;

use bn_cli::Outcome;
use bn_cli::analysis::Estimate;

use self::psnr::{Cache, HIGHEST, RATES, Values};
use super::{Cell, Context, Row, Table, TableSpec};
use crate::measure::downsampling::{Downsampling, Psnr};
use crate::thesis::{Judgement, RowSpec, Verdict};

pub(super) const SPEC: TableSpec = TableSpec {
    id: "5.3",
    title: "PSNR in dB of an image downsampled at high sampling rates",
    quantities: &[],
    make: table,
};

/// Images of each row, as in the thesis, whatever the number of sets.
const IMAGES: u32 = 10;
/// The same where only few points are made: enough to see that it works.
const QUICK_IMAGES: u32 = 2;

/// The methods that the thesis made by its own slow algorithm; as many sets as time allows.
const BY_FORCE: [&str; 2] = ["step", "single-peak"];
const FORCE_SETS: u32 = 2;

/// Iterations where the points are fewer than the thesis's and nothing is judged.
const FEW_ITERATIONS: &str = "100";

/// A row to be measured.
struct Contender {
    spec: RowSpec,
    label: String,
    /// The thesis's row is meant, not one beside it.
    is_thesis: bool,
    most_sets: u32,
}

/// A row before it is judged; values, or why there are none.
struct Measured {
    contender: Contender,
    values: Result<Values, String>,
}

fn table(spec: &TableSpec, context: &Context<'_>) -> Outcome<Table> {
    let start = Instant::now();
    let test = Downsampling::new()?;
    eprintln!("{:<24} rendered in {:.2} s", "references", start.elapsed().as_secs_f64());
    let contenders = contenders(context);
    let wanted: Vec<_> = contenders.iter().map(|c| (c.spec.clone(), c.most_sets)).collect();
    let sets = context.workbench.point_sets(&wanted)?;
    let images = if few_points(context) { QUICK_IMAGES } else { IMAGES };
    let cache = context.workbench.store().map(|store| Cache::new(store, &test, images));
    let cache = cache.transpose()?;
    let measured = contenders.into_iter().zip(sets).map(|(contender, sets)| {
        let values = match (sets, &cache) {
            (Ok(sets), Some(cache)) => Ok(cache.values(&contender.spec.method, &sets)?),
            (Ok(sets), None) => Ok(Values::told(&contender.spec.method, &sets, images, &test)?),
            (Err(reason), _) => Err(reason),
        };
        Ok(Measured { contender, values })
    });
    let measured = measured.collect::<Outcome<Vec<_>>>()?;
    let ranking = Ranking::of(&measured, context);
    let mut rows: Vec<Row> = measured.iter().map(|row| row.judged(&ranking, context)).collect();
    rows.push(reference(&test)?);
    Ok(Table { id: spec.id, title: spec.title, decimals: 1, rows })
}

/// Whether the points are fewer than the thesis's, enough to see that it works.
fn few_points(context: &Context<'_>) -> bool {
    context.workbench.plan().n < 4096
}

/// The rows: the thesis's in its order, those of step and single-peak sets by its own algorithm, and
/// beside them by ours.
fn contenders(context: &Context<'_>) -> Vec<Contender> {
    let thesis = context.judge.thesis();
    let mut contenders = Vec::new();
    for key in thesis.methods_of(SPEC.id) {
        let name = thesis.method_name(key);
        for row in context.rows.of(key) {
            if !BY_FORCE.contains(&&*row.method) {
                let (spec, label) = (row.clone(), name.to_owned());
                contenders.push(Contender { spec, label, is_thesis: true, most_sets: IMAGES });
                continue;
            }
            let few = few_points(context);
            let options = [("algorithm", "force")].into_iter();
            let options = options.chain(few.then_some(("iterations", FEW_ITERATIONS)));
            let options = options.map(|(name, value)| (name.to_owned(), value.to_owned()));
            let why = format!("the thesis's algorithm; {FORCE_SETS} sets, shifted for each image");
            contenders.push(Contender {
                spec: RowSpec { options: options.collect(), why, ..row.clone() },
                label: format!("{name} by force"),
                is_thesis: true,
                most_sets: FORCE_SETS,
            });
            let label = format!("{name} by spectral, not in the thesis");
            let spec = row.clone();
            contenders.push(Contender { spec, label, is_thesis: false, most_sets: IMAGES });
        }
    }
    contenders
}

/// The methods at the highest rate.
struct Ranking<'a> {
    /// The thesis's rows, without those known to be out of place: the others are not to blame.
    places: Vec<(&'a str, f64)>,
}

impl<'a> Ranking<'a> {
    fn of(measured: &'a [Measured], context: &Context<'_>) -> Self {
        let thesis = measured.iter().filter(|row| row.contender.is_thesis);
        let last: Vec<_> = thesis.filter_map(|row| Some((row.key(), row.highest()?))).collect();
        let known = |key: &str| context.judge.is_misplaced(key);
        Self { places: last.into_iter().filter(|(key, _)| !known(key)).collect() }
    }
}

impl Measured {
    /// The thesis's key of the row.
    fn key(&self) -> &str {
        &self.contender.spec.thesis
    }

    /// PSNR at the highest rate.
    fn highest(&self) -> Option<f64> {
        let values = self.values.as_ref().ok()?;
        Some(Values::mean(&values.density, |image| image[HIGHEST].value)?.value)
    }

    fn judged(&self, ranking: &Ranking<'_>, context: &Context<'_>) -> Row {
        let Contender { spec, label, .. } = &self.contender;
        let cells = match &self.values {
            Ok(values) => self.cells(values, ranking, context),
            // No place at all.
            Err(_) => vec![Cell::new(
                &format!("misplaced at {} spp", RATES[HIGHEST]),
                None,
                context.judge.judge_place(self.key(), f64::NAN),
            )],
        };
        Row {
            label: label.clone(),
            method: spec.method.clone(),
            options: spec.options_text(),
            why: spec.why.clone(),
            failure: self.values.as_ref().err().cloned(),
            cells,
        }
    }

    fn cells(&self, values: &Values, ranking: &Ranking<'_>, context: &Context<'_>) -> Vec<Cell> {
        let (judge, key, is_thesis) = (context.judge, self.key(), self.contender.is_thesis);
        let few = few_points(context);
        let mut cells = Vec::new();
        for (i, rate) in RATES.into_iter().enumerate() {
            let ours = Values::mean(&values.density, |image| image[i].value);
            let judgement = match ours {
                Some(ours) if is_thesis => {
                    let judged = judge.judge_psnr(key, rate, ours.value);
                    let off = |thesis: &f64| (ours.value - thesis).abs() > DIFFERENT;
                    match judged.thesis.filter(off) {
                        Some(thesis) if judged.verdict == Verdict::NotJudged && !few => {
                            judge.show_psnr(key, rate, Some(&values.evidence(i, thesis)))
                        }
                        _ => judged,
                    }
                }
                _ => judge.show_psnr(key, rate, None),
            };
            cells.push(Cell::new(&format!("{rate} spp"), ours, judgement));
        }
        for (i, rate) in RATES.into_iter().enumerate() {
            let ours = Values::mean(&values.plain, |image| image[i].value);
            let judgement = judge.show_psnr(key, rate, Some(PLAIN));
            cells.push(Cell::new(&format!("{rate} spp, plain"), ours, judgement));
        }
        let rate = RATES[HIGHEST];
        let dense = Values::mean(&values.density, |image| image[HIGHEST].dense);
        cells.push(Cell::new(&format!("{rate} spp, dense"), dense, Judgement::shown(DENSE)));
        for (how, value, why) in [
            ("plain, expected", values.expected.plain, EXPECTED),
            ("expected without its mean", values.expected.about_mean, ABOUT_MEAN),
        ] {
            let what = format!("{rate} spp, {how}");
            cells.push(Cell::new(&what, Some(alone(value)), Judgement::shown(why)));
        }
        if let (true, Some(value)) = (is_thesis, self.highest()) {
            let misplaced = judge.misplaced(key, value, &ranking.places, rate);
            let judgement = judge.judge_place(key, misplaced);
            cells.push(Cell::new(
                &format!("misplaced at {rate} spp"),
                Some(alone(misplaced)),
                judgement,
            ));
        }
        if key == "random" {
            let gain = |image: &[Psnr]| (image[HIGHEST].value - image[0].value) / HIGHEST as f64;
            if let Some(gain) = Values::mean(&values.density, gain) {
                let judgement = judge.judge_doubling(gain.value);
                cells.push(Cell::new(&"gain per doubling", Some(gain), judgement));
            }
        }
        cells
    }
}

const PLAIN: &str = "plain convolution, without the division by the density of samples";
const DENSE: &str = "against a hexagonal grid at 4096 spp instead of the thesis's reference";
const EXPECTED: &str = "what the sets' mean spectrum and the picture's make of plain convolution (section 3.2), a mean over all \
                        shifts of the points";
const ABOUT_MEAN: &str = "the same without the noise of the picture's mean, which normalisation by density reproduces: a lower \
                          bound in practice, as that takes more of what changes slowly (up to 7 dB)";

/// Values further than this from the thesis's, in dB, say what was measured of the reason.
const DIFFERENT: f64 = 2.0;
/// How good the reference itself is.
fn reference(test: &Downsampling) -> Outcome<Row> {
    let limit = "PSNR of the reference against a hexagonal grid at 4096 spp: a limit for every row";
    Ok(Row {
        label: "Reference, hexagonal grid at 512 spp".to_owned(),
        method: String::new(),
        options: String::new(),
        why: String::new(),
        failure: None,
        cells: vec![Cell::new(
            &"512 spp, dense",
            Some(alone(test.reference_psnr()?)),
            Judgement::shown(limit),
        )],
    })
}

/// A value without an error.
fn alone(value: f64) -> Estimate {
    Estimate { value, std_error: None }
}
