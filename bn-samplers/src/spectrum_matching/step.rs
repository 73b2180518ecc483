//! Step blue noise.

use bn_core::{Density, Observer, Seed};
use bn_spectral::{Target, highest_step};

use super::options::with_algorithms;
use super::{Algorithm, SpectrumMatching, frequency, invalid_target};
use crate::error::check_count;
use crate::{CountRule, Method, PointOrder, Sample, SampleError, Sampler};

/// No power below a frequency and none but the mean above it: P(ν) = H(ν − ν₀).
///
/// The least aliasing that irregular points can have: what lies below ν₀ stays free of noise, and
/// what lies above becomes noise without structure. Realizable up to ν₀ = √(n/π), the default; beyond,
/// the nearest that is reached. Thesis §5.3.2 and p. 119.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Step {
    /// ν₀ in cycles per unit; √(n/π) if it isn't given.
    pub nu0: Option<f64>,
    /// How to come near that spectrum.
    pub algorithm: Algorithm,
}

/// The registry's entry.
pub(crate) const METHOD: Method = Method {
    name: "step",
    aliases: &["step-blue-noise"],
    summary: "no power below a frequency, constant power above: step blue noise",
    page: Some(119),
    citation: "D. Heck, T. Schlömer and O. Deussen, Blue noise sampling with controlled aliasing, \
               ACM Trans. Graph. 32(3), 2013",
    complexity: "O(n log n) an iteration, some 50 iterations",
    order: PointOrder::Random,
    counts: CountRule::Any,
    seeded: true,
    options: &with_algorithms::<_, { 1 + Algorithm::OPTIONS.len() }>([frequency(
        "nu0",
        "sqrt(n/pi), the highest that is realizable",
        "the frequency of the step",
    )]),
    build: |options| {
        Ok(Box::new(Step {
            nu0: options.real("nu0"),
            algorithm: Algorithm::from_options(options)?,
        }))
    },
    version: 3,
};

impl Sampler for Step {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        check_count(METHOD.name, n)?;
        let nu0 = self.nu0.unwrap_or_else(|| highest_step(n as f64));
        let target =
            Target::step(Density::new(n), nu0).map_err(|error| invalid_target("nu0", &error))?;
        SpectrumMatching::new(target, self.algorithm.clone()).sample(n, seed, observer)
    }
}
