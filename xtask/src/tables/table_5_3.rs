//! Table 5.3: PSNR of an image made smaller, at high sampling rates.

use std::hash::{DefaultHasher, Hasher as _};
use std::time::Instant;

use bn_cli::analysis::Estimate;
use bn_cli::{Failure, Outcome};
use bn_core::{PointSet, Seed, Unobserved};
use bn_render::Normalization;
use bn_samplers::{Sampler as _, Stochastic};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::{Cell, Context, Row, Table, TableSpec};
use crate::measure::Store;
use crate::measure::downsampling::{Downsampling, Expected, Psnr};
use crate::thesis::{Judgement, RowSpec, Verdict};

pub(super) const SPEC: TableSpec = TableSpec {
    id: "5.3",
    title: "PSNR in dB of an image downsampled at high sampling rates",
    quantities: &[],
    make: table,
};

/// The thesis's samples per pixel; methods are ranked at the last.
const RATES: [u32; 4] = [16, 32, 64, 128];
const HIGHEST: usize = RATES.len() - 1;

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

/// What a row's sets gave.
#[derive(Serialize, Deserialize)]
struct Values {
    /// By image and rate, normalised by density and plain.
    density: Vec<[Psnr; RATES.len()]>,
    plain: Vec<[Psnr; RATES.len()]>,
    /// What spectra let one expect at the highest rate.
    expected: Expected,
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
            (Ok(sets), Some(cache)) => Ok(cache.values(&contender, &sets)?),
            (Ok(sets), None) => Ok(Values::told(&contender, &sets, images, &test)?),
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

impl Values {
    /// The values of a row, and a word on how long that took.
    fn told(
        contender: &Contender,
        sets: &[PointSet],
        images: u32,
        test: &Downsampling,
    ) -> Outcome<Self> {
        let start = Instant::now();
        let values = Self::of(sets, images, test)?;
        eprintln!(
            "{:<24} {} images from {} sets in {:.2} s",
            contender.spec.method,
            2 * images as usize * RATES.len(),
            sets.len(),
            start.elapsed().as_secs_f64()
        );
        Ok(values)
    }

    fn of(sets: &[PointSet], images: u32, test: &Downsampling) -> Outcome<Self> {
        let image = |index: u32, normalization| -> Outcome<[Psnr; RATES.len()]> {
            let set = &sets[index as usize % sets.len()];
            let at = |rate: u32| test.psnr(set, index, f64::from(rate), normalization);
            let [a, b, c, d] = RATES.map(at);
            Ok([a?, b?, c?, d?])
        };
        let all = |normalization| -> Outcome<Vec<_>> {
            (0..images).into_par_iter().map(|index| image(index, normalization)).collect()
        };
        let (density, plain) = (all(Normalization::Density)?, all(Normalization::None)?);
        let expected = test.predicted(sets, f64::from(RATES[HIGHEST]))?;
        Ok(Self { density, plain, expected })
    }

    /// What is measured of where a difference from the thesis's value at one of the rates may come from.
    fn evidence(&self, i: usize, thesis: f64) -> String {
        let mean_square = |images: &[[Psnr; RATES.len()]], of: fn(&Psnr) -> f64| {
            let squares = images.iter().map(|image| 10.0_f64.powf(-0.1 * of(&image[i])));
            -10.0 * (squares.sum::<f64>() / images.len() as f64).log10()
        };
        let plain = mean_square(&self.plain, |psnr| psnr.value);
        let [value, dense] = [|psnr: &Psnr| psnr.value, |psnr: &Psnr| psnr.dense]
            .map(|of| mean_square(&self.density, of));
        let expected = match i {
            HIGHEST => format!(" ({:.1} expected of spectra)", self.expected.plain),
            _ => String::new(),
        };
        let so = if (plain.min(value)..=plain.max(value)).contains(&thesis) {
            "the thesis's lies between both normalisations"
        } else if (plain - thesis).abs() + FITS < (value - thesis).abs() {
            "plain convolution is nearer to the thesis's"
        } else if (dense - value).abs() < FITS {
            "neither normalisation nor the reference makes the difference; the sets or the picture do"
        } else {
            "the reference makes some of the difference"
        };
        format!(
            "by mean square error {value:.1} dB normalised by density, {plain:.1} by plain convolution{expected}, \
             {dense:.1} against a denser reference: {so}"
        )
    }

    /// A digest of every number.
    fn digest(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        for image in self.density.iter().chain(&self.plain) {
            let numbers = image.iter().flat_map(|psnr| [psnr.value, psnr.dense]);
            numbers.for_each(|x| hasher.write_u64(x.to_bits()));
        }
        let Expected { plain, about_mean } = self.expected;
        for x in [plain, about_mean] {
            hasher.write_u64(x.to_bits());
        }
        hasher.finish()
    }

    /// Mean and error over the images, of what `value` picks.
    fn mean(images: &[[Psnr; RATES.len()]], value: impl Fn(&[Psnr]) -> f64) -> Option<Estimate> {
        Estimate::mean(&images.iter().map(|image| value(image)).collect::<Vec<_>>())
    }
}

/// Values that are kept by a digest of all that decides them.
struct Cache<'a> {
    store: &'a Store,
    test: &'a Downsampling,
    images: u32,
    /// A digest of what is measured of a few points: other rates, shifts, bands, kernels or
    /// normalisations give something else.
    how: u64,
}

/// How many points those are.
const PROBE: usize = 256;

impl<'a> Cache<'a> {
    fn new(store: &'a Store, test: &'a Downsampling, images: u32) -> Outcome<Self> {
        let probe = Stochastic::default()
            .sample(PROBE, Seed::new(1), &Unobserved)
            .map_err(Failure::failed)?;
        let how = Values::of(&[probe.points], 1, test)?.digest();
        Ok(Self { store, test, images, how })
    }

    /// The values that were measured before of the same sets in the same way, or new ones.
    fn values(&self, contender: &Contender, sets: &[PointSet]) -> Outcome<Values> {
        let folder = format!("psnr_of_{}_images", self.images);
        let notes = self.store.measured(&folder, self.test.digest(sets, self.how));
        if let Some(values) = notes.read() {
            return Ok(values);
        }
        let values = Values::told(contender, sets, self.images, self.test)?;
        notes.write(&values)?;
        Ok(values)
    }
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
/// Values no further apart than this, in dB, are taken for the same.
const FITS: f64 = 1.0;

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_measured_number_decides_what_is_kept() {
        let values = |change: &dyn Fn(&mut Values)| {
            let psnr = |i: usize| Psnr { value: 30.0 + i as f64, dense: 40.0 + i as f64 };
            let image: [Psnr; RATES.len()] = std::array::from_fn(psnr);
            let mut values = Values {
                density: vec![image],
                plain: vec![image],
                expected: Expected { plain: 50.0, about_mean: 60.0 },
            };
            change(&mut values);
            values.digest()
        };
        let mut digests = vec![
            values(&|_| {}),
            values(&|v| v.expected.plain += 1e-9),
            values(&|v| v.expected.about_mean += 1e-9),
        ];
        for rate in 0..RATES.len() {
            digests.push(values(&|v| v.density[0][rate].value += 1e-9));
            digests.push(values(&|v| v.density[0][rate].dense += 1e-9));
            digests.push(values(&|v| v.plain[0][rate].value += 1e-9));
        }
        let count = digests.len();
        digests.sort_unstable();
        digests.dedup();
        assert_eq!(digests.len(), count);
    }
}
