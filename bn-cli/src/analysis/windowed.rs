//! What comes from pair distances through the thesis's window.

use bn_core::{Curve, Density, PointSet};
use bn_spectral::WindowedSpectrum;

use super::Estimate;

/// The spectra of an ensemble by the thesis's estimator; see [`WindowedSpectrum`].
#[derive(Clone, Debug)]
pub struct Windowed {
    density: Density,
    each: Vec<WindowedSpectrum>,
    mean: WindowedSpectrum,
}

impl Windowed {
    pub(super) fn of(sets: &[PointSet]) -> Self {
        let spectra = WindowedSpectrum::of_each(sets)
            .and_then(|each| Ok((WindowedSpectrum::mean(&each)?, each)));
        let (mean, each) = spectra.expect("an analysis holds sets of one size");
        Self { density: sets[0].density(), each, mean }
    }

    /// The radial power spectrum, mean over the sets.
    pub fn power(&self) -> &Curve {
        self.mean.power()
    }

    pub(super) fn effective_nyquist(&self) -> Option<Estimate> {
        let estimate = self.estimate(|spectrum| Some(spectrum.effective_nyquist()?.value()))?;
        // It is a multiple of half the samples' distance.
        let step = 0.5 * self.power().step() / self.density.grid_nyquist();
        Some(estimate.rounded_to(step))
    }

    pub(super) fn oscillation(&self) -> Option<Estimate> {
        self.estimate(WindowedSpectrum::oscillation)
    }

    /// A figure of the mean spectrum, its error from the means with each set left out.
    fn estimate(&self, figure: impl Fn(&WindowedSpectrum) -> Option<f64>) -> Option<Estimate> {
        let sets = self.each.len();
        let others = self.each.iter().filter(|_| sets > 1);
        let left_out = others.map(|one| figure(&self.mean.without(one, sets)));
        Some(Estimate::jackknife(figure(&self.mean)?, &left_out.collect::<Vec<_>>()))
    }
}
