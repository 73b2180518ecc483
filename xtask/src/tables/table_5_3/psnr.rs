//! What the images of one row give, and where a difference from the thesis may come from.

use std::hash::{DefaultHasher, Hasher as _};
use std::time::Instant;

use bn_cli::analysis::Estimate;
use bn_cli::{Failure, Outcome};
use bn_core::{PointSet, Seed, Unobserved};
use bn_render::Normalization;
use bn_samplers::{Sampler as _, Stochastic};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::measure::Store;
use crate::measure::downsampling::{Downsampling, Expected, Psnr};

/// The thesis's samples per pixel; methods are ranked at the last.
pub(super) const RATES: [u32; 4] = [16, 32, 64, 128];
pub(super) const HIGHEST: usize = RATES.len() - 1;

/// Values no further apart than this, in dB, are taken for the same.
const FITS: f64 = 1.0;

/// What a row's sets gave.
#[derive(Serialize, Deserialize)]
pub(super) struct Values {
    /// By image and rate, normalised by density and plain.
    pub(super) density: Vec<[Psnr; RATES.len()]>,
    pub(super) plain: Vec<[Psnr; RATES.len()]>,
    /// What spectra let one expect at the highest rate.
    pub(super) expected: Expected,
}

impl Values {
    /// The values of a row, and a word on how long that took.
    pub(super) fn told(
        method: &str,
        sets: &[PointSet],
        images: u32,
        test: &Downsampling,
    ) -> Outcome<Self> {
        let start = Instant::now();
        let values = Self::of(sets, images, test)?;
        eprintln!(
            "{:<24} {} images from {} sets in {:.2} s",
            method,
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
    pub(super) fn evidence(&self, i: usize, thesis: f64) -> String {
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
    pub(super) fn mean(
        images: &[[Psnr; RATES.len()]],
        value: impl Fn(&[Psnr]) -> f64,
    ) -> Option<Estimate> {
        Estimate::mean(&images.iter().map(|image| value(image)).collect::<Vec<_>>())
    }
}

/// Values that are kept by a digest of all that decides them.
pub(super) struct Cache<'a> {
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
    pub(super) fn new(store: &'a Store, test: &'a Downsampling, images: u32) -> Outcome<Self> {
        let probe = Stochastic::default()
            .sample(PROBE, Seed::new(1), &Unobserved)
            .map_err(Failure::failed)?;
        let how = Values::of(&[probe.points], 1, test)?.digest();
        Ok(Self { store, test, images, how })
    }

    /// The values that were measured before of the same sets in the same way, or new ones.
    pub(super) fn values(&self, method: &str, sets: &[PointSet]) -> Outcome<Values> {
        let folder = format!("psnr_of_{}_images", self.images);
        let notes = self.store.measured(&folder, self.test.digest(sets, self.how));
        if let Some(values) = notes.read() {
            return Ok(values);
        }
        let values = Values::told(method, sets, self.images, self.test)?;
        notes.write(&values)?;
        Ok(values)
    }
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
