//! The error of sampled images, by frequency and after reconstruction.

use bn_core::DVec2;
use rayon::prelude::*;

use super::white_noise::WhiteNoise;
use super::{ImageSpectrum, PatternPower, SpectralLine};
use crate::pattern::check_rate;
use crate::{Kernel, KernelTransfer, PatternError};

/// Predicts the error of an image that is sampled by a pattern at a rate (thesis section 3.2.1).
///
/// With s samples per pixel and tiles of side L = √(n/s) pixels, the sampled signal divided by s
/// is the image plus an error whose power spectrum, in cycles per pixel, is
/// ε(ν) = `P_I` ⋆ P̌/s² = (1/s) ∫ `P_I`(ν') P((ν − ν')L) dν' (3.10), P being [`PatternPower`].
///
/// *Assumption*: the pattern is independent of the image. For a given set that means: the mean over
/// all shifts of the pattern against the image. Of that mean [`Prediction::noise`] is exact to some
/// 1e-11/s times the image's power if P is the set's own spectrum; beyond K, P counts as 1, which
/// is wrong by at most the largest |P − 1| there times the part of the kernel's energy beyond
/// K/L − |f| cycles per pixel for power of the image at f; from |f| = K/L on, that says nothing. One image with one shift deviates by chance.
#[derive(Clone, Copy, Debug)]
pub struct Prediction<'a> {
    pattern: &'a PatternPower,
    samples_per_pixel: f64,
}

impl<'a> Prediction<'a> {
    /// The prediction for this pattern at `samples_per_pixel`.
    ///
    /// # Errors
    /// If `samples_per_pixel` is not a number from 2⁻¹⁶ to 2¹⁶.
    pub fn new(pattern: &'a PatternPower, samples_per_pixel: f64) -> Result<Self, PatternError> {
        check_rate(samples_per_pixel)?;
        Ok(Self { pattern, samples_per_pixel })
    }

    /// The tile's side L in pixels.
    pub fn side(&self) -> f64 {
        (self.pattern.points() as f64 / self.samples_per_pixel).sqrt()
    }

    /// ε(ν) at `frequency` cycles per pixel: power for each squared cycle per pixel (3.10). Of a
    /// wave it is (α²/4s)(P((ν − f)L) + P((ν + f)L)) (3.19), of a constant (α²/s) P(νL) (3.16).
    ///
    /// P is interpolated between the tile's modes. Cost: a few nanoseconds for each line.
    pub fn error_spectrum(&self, image: &ImageSpectrum, frequency: DVec2) -> f64 {
        let side = self.side();
        let one = |line: &SpectralLine| {
            line.power * self.pattern.interpolated((frequency - line.frequency) * side)
        };
        image.lines().iter().map(one).sum::<f64>() / self.samples_per_pixel
    }

    /// The variance of the pixels about the noiseless image, the scene's convolution with the
    /// kernel, when they are made by plain convolution
    /// ([`Normalization::None`](crate::Normalization::None)): ∫ ε(ν) |R(ν)|² dν with the kernel's
    /// transfer function R, for a tiled pattern the sum over its modes.
    ///
    /// Cost: (2K + 1)² products for each ordinate that lines have, 2K + 1 for each line; and 2K + 1
    /// values of R for each abscissa and ordinate, of some 64 cosines a unit of the kernel's radius each
    /// at low frequencies, which is most of it for few lines.
    ///
    /// # Panics
    /// If a line's frequency and K/L together are above 10⁶ cycles per pixel, or the kernel breaks its
    /// contract.
    pub fn noise(&self, image: &ImageSpectrum, kernel: &dyn Kernel) -> f64 {
        let mut lines = image.lines().to_vec();
        lines.sort_by(|a, b| {
            let (a, b) = (a.frequency, b.frequency);
            a.y.total_cmp(&b.y).then(a.x.total_cmp(&b.x))
        });
        let filter = Filter::new(self, &lines, kernel);
        let rows: Vec<&[SpectralLine]> =
            lines.chunk_by(|a, b| a.frequency.y == b.frequency.y).collect();
        let noises: Vec<f64> =
            rows.into_par_iter().map(|row| filter.noise_of_row(self, row)).collect();
        noises.iter().sum()
    }
}

/// The kernel as the modes of a tile see it.
struct Filter {
    transfer: KernelTransfer,
    white: WhiteNoise,
    /// The abscissae of the lines, ascending, and |R|² of each at the modes around it.
    columns: Vec<(f64, Vec<f64>)>,
}

impl Filter {
    fn new(prediction: &Prediction<'_>, lines: &[SpectralLine], kernel: &dyn Kernel) -> Self {
        let side = prediction.side();
        let far = lines.iter().map(|line| line.frequency.abs().max_element()).fold(0.0, f64::max);
        let highest = far + prediction.pattern.max_frequency() as f64 / side;
        let transfer = KernelTransfer::new(kernel, highest);
        let mut abscissae: Vec<f64> = lines.iter().map(|line| line.frequency.x).collect();
        abscissae.sort_unstable_by(f64::total_cmp);
        abscissae.dedup();
        let column = |nu: f64| (nu, modes_around(prediction, &transfer, nu));
        let columns = abscissae.into_par_iter().map(column).collect();
        Self { transfer, white: WhiteNoise::new(kernel, side), columns }
    }

    /// The noise of lines that share an ordinate.
    fn noise_of_row(&self, prediction: &Prediction<'_>, row: &[SpectralLine]) -> f64 {
        let pattern = prediction.pattern;
        let (limit, points) = (pattern.max_frequency(), pattern.points() as f64);
        let y = row[0].frequency.y;
        let gains = modes_around(prediction, &self.transfer, y);
        // Σ over ky of (P − 1)·|R|², for kx = −K … K; P(−k) = P(k).
        let mut sums = vec![0.0; 2 * limit + 1];
        for kx in 0..=limit {
            let dot = |gains: &mut dyn Iterator<Item = &f64>| -> f64 {
                pattern.excess_column(kx).zip(gains).map(|(p, r)| p * r).sum()
            };
            sums[limit + kx] = dot(&mut gains.iter());
            sums[limit - kx] = dot(&mut gains.iter().rev());
        }
        let one = |line: &SpectralLine| {
            let x = line.frequency.x;
            let found = self.columns.partition_point(|&(at, _)| at < x);
            let colored: f64 =
                sums.iter().zip(&self.columns[found].1).map(|(sum, r)| sum * r).sum();
            let white = self.white.at(x) * self.white.at(y) / prediction.samples_per_pixel;
            line.power * (white + colored / points)
        };
        row.iter().map(one).sum()
    }
}

/// |R|² along one axis at the frequencies ν + k/L, k = −K … K.
fn modes_around(prediction: &Prediction<'_>, transfer: &KernelTransfer, nu: f64) -> Vec<f64> {
    let limit = prediction.pattern.max_frequency() as i64;
    let side = prediction.side();
    (-limit..=limit).map(|k| transfer.axis(nu + k as f64 / side).powi(2)).collect()
}
