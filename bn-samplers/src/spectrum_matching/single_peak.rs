//! Single-peak blue noise.

use bn_core::{Density, Observer, Seed};
use bn_spectral::{SinglePeak as Peak, Target};

use super::options::with_algorithms;
use super::{Algorithm, SpectrumMatching, frequency, invalid_target};
use crate::error::check_count;
use crate::{CountRule, Method, PointOrder, Sample, SampleError, Sampler};

/// No power below a frequency, a peak at it and constant power above: the price of a higher
/// effective Nyquist frequency than [`Step`](super::step::Step) has.
///
/// The defaults are the thesis's reference pattern (figure 5.7 d), which no point set can have quite:
/// the result is near it, and says how near. Thesis §5.3.3 and p. 120; see [`bn_spectral::SinglePeak`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SinglePeak {
    /// ν₀ in cycles per unit, where the peak begins; 60·√(n/4096) if it isn't given.
    pub nu0: Option<f64>,
    /// The peak's power above that of the step, in cycles per unit; 19·√(n/4096).
    pub peak: Option<f64>,
    /// Deviation of the Gaussian that smooths it, in cycles per unit; 2.5·√(n/4096).
    pub sigma: Option<f64>,
    /// How to come near that spectrum.
    pub algorithm: Algorithm,
}

/// The registry's entry.
pub(crate) const METHOD: Method = Method {
    name: "single-peak",
    aliases: &["single-peak-blue-noise", "peak"],
    summary: "no power below a frequency, a peak, constant power above: single-peak blue noise",
    page: Some(120),
    citation: "D. Heck, T. Schlömer and O. Deussen, Blue noise sampling with controlled aliasing, \
               ACM Trans. Graph. 32(3), 2013",
    complexity: "O(n log n) an iteration, some 100 iterations",
    order: PointOrder::Random,
    counts: CountRule::Any,
    seeded: true,
    options: &with_algorithms::<_, { 3 + Algorithm::OPTIONS.len() }>([
        frequency("nu0", "60 sqrt(n/4096)", "where the peak begins"),
        frequency("peak", "19 sqrt(n/4096)", "the peak's power above 1: (height - 1) times width"),
        frequency("sigma", "2.5 sqrt(n/4096)", "deviation of the Gaussian that smooths the peak"),
    ]),
    build: |options| {
        Ok(Box::new(SinglePeak {
            nu0: options.real("nu0"),
            peak: options.real("peak"),
            sigma: options.real("sigma"),
            algorithm: Algorithm::from_options(options)?,
        }))
    },
    version: 3,
};

impl SinglePeak {
    /// The spectrum for `n` points.
    fn spectrum(&self, n: usize) -> Peak {
        let default = Peak::thesis(Density::new(n));
        Peak {
            nu0: self.nu0.unwrap_or(default.nu0),
            peak: self.peak.unwrap_or(default.peak),
            sigma: self.sigma.unwrap_or(default.sigma),
            width: default.width,
        }
    }
}

impl Sampler for SinglePeak {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        check_count(METHOD.name, n)?;
        let target = Target::single_peak(Density::new(n), self.spectrum(n))
            .map_err(|error| invalid_target("nu0", &error))?;
        SpectrumMatching::new(target, self.algorithm.clone()).sample(n, seed, observer)
    }
}
