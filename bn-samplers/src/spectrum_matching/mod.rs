//! Point sets made from the spectrum that they are to have (thesis chapter 5).

mod annealing;
mod force;
mod gradient;
mod options;
pub(crate) mod single_peak;
mod spectral;
pub(crate) mod step;
mod table_forces;

use std::sync::OnceLock;

use bn_core::{DVec2, Observer, PointSet, Seed};
use bn_spectral::{Real, Realizability, Target};

use crate::error::{check_count, check_room};
use crate::{
    DefaultValue, OptionKind, OptionSpec, Report, Sample, SampleError, Sampler, Stochastic,
};

pub use annealing::Annealing;
pub use force::Force;
pub use gradient::Gradient;
use spectral::{Match, Rings};
pub use spectral::{Residual, Spectral, Weights};

/// The range of frequencies, in √n, over which results are compared with their target.
const MEASURED: f64 = 6.0;

/// How point sets are matched to a spectrum.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Algorithm {
    /// The periodogram's ring means by L-BFGS: the fastest and most accurate.
    Spectral(Spectral),
    /// The thesis's: forces from the difference of the RDFs.
    Force(Force),
    /// Gradient descent on the pair correlation (Zhou et al. 2012).
    Gradient(Gradient),
    /// Simulated annealing of the pair correlation (Rintoul and Torquato 1997).
    Annealing(Annealing),
}

impl Default for Algorithm {
    fn default() -> Self {
        Self::Spectral(Spectral::default())
    }
}

impl Algorithm {
    /// The names of all algorithms, the default first.
    pub const NAMES: &'static [&'static str] = &["spectral", "force", "gradient", "annealing"];

    /// The algorithm of this name with its defaults.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "spectral" => Some(Self::default()),
            "force" => Some(Self::Force(Force::default())),
            "gradient" => Some(Self::Gradient(Gradient::default())),
            "annealing" => Some(Self::Annealing(Annealing::default())),
            _ => None,
        }
    }

    /// The same with at most this many iterations, in all stages together where there are several.
    #[must_use]
    pub fn with_iterations(mut self, iterations: u32) -> Self {
        match &mut self {
            Self::Spectral(spectral) => spectral.iterations = Some(iterations),
            Self::Force(force) => force.iterations = iterations,
            Self::Gradient(gradient) => gradient.iterations = iterations,
            Self::Annealing(annealing) => annealing.iterations = iterations,
        }
        self
    }
}

/// What a search made.
struct Outcome {
    points: Vec<DVec2>,
    iterations: u32,
    end: End,
}

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    /// The goal is met.
    Tolerance,
    /// Nothing lower was found along the gradient: a minimum, as far as rounding lets it be seen.
    Gradient,
    /// Line searches have all but ceased to gain.
    Stalled,
    /// The budget of evaluations is spent.
    Evaluations,
    /// The schedule of temperatures is through.
    Temperature,
    /// Steps have become too short to matter.
    Step,
    /// The budget of iterations is spent.
    Iterations,
}

impl End {
    fn name(self) -> &'static str {
        match self {
            Self::Tolerance => "tolerance",
            Self::Gradient => "gradient",
            Self::Stalled => "stalled",
            Self::Evaluations => "evaluations",
            Self::Temperature => "temperature",
            Self::Step => "step",
            Self::Iterations => "iterations",
        }
    }

    /// Whether the algorithm came to its own end.
    fn is_convergence(self) -> bool {
        matches!(self, Self::Tolerance | Self::Temperature | Self::Step)
    }
}

/// Point sets with the power spectrum of a [`Target`], as nearly as `algorithm` comes to it from
/// random points or from `start`.
///
/// Never refuses a target: the report's `residual` says how near the result is, as the root mean
/// square of its ring means less the target over all modes up to 6√n; `empty_power` is the mean power
/// where the target has none. `ended_by` says why the search ended: `tolerance` (met), `temperature`
/// or `step` (its schedule is through), `gradient` (no way down), `stalled` (next to nothing gained),
/// `evaluations` or `iterations` (the budget is spent); of these the first three count as `converged`.
///
/// ```
/// use bn_core::{Density, Seed, Unobserved};
/// use bn_samplers::{Algorithm, FigureValue, Sampler as _, SpectrumMatching};
/// use bn_spectral::Target;
///
/// let step = Target::step(Density::new(256), 8.0)?;
/// let matching = SpectrumMatching::new(step, Algorithm::default());
/// let sample = matching.sample(256, Seed::new(1), &Unobserved)?;
/// let Some(FigureValue::Real(residual)) = sample.report.get("residual") else { panic!() };
/// assert!(residual < 0.01);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct SpectrumMatching {
    target: Target,
    attainable: OnceLock<Attainable>,
    /// How.
    pub algorithm: Algorithm,
    /// Where to begin; random points if there is nothing.
    pub start: Option<PointSet>,
}

/// What is known of a target.
#[derive(Clone, Copy, Debug)]
struct Attainable {
    /// P ≥ 0 and g ≥ 0.
    realizable: bool,
    /// Nor does anything else stand in its way.
    unobjectionable: bool,
}

impl Attainable {
    fn of(verdict: &Realizability) -> Self {
        Self { realizable: verdict.realizable, unobjectionable: verdict.is_unobjectionable() }
    }
}

impl SpectrumMatching {
    /// The matching from random points.
    pub fn new(target: Target, algorithm: Algorithm) -> Self {
        Self { target, attainable: OnceLock::new(), algorithm, start: None }
    }

    /// The same with the verdict on its target, which must be just that, if it has been found before: the
    /// weights depend on it.
    #[must_use]
    pub fn judged(self, verdict: &Realizability) -> Self {
        Self { attainable: OnceLock::from(Attainable::of(verdict)), ..self }
    }

    /// What to match, at the density of the points to make.
    pub fn target(&self) -> &Target {
        &self.target
    }

    /// Found out once for all sets; for curves of many samples it takes longer than they do.
    fn attainable(&self) -> Attainable {
        // Threads don't wait for each other: the work is parallel itself, and would wait for itself.
        if let Some(known) = self.attainable.get() {
            return *known;
        }
        let attainable = Attainable::of(&Realizability::of(&self.target));
        *self.attainable.get_or_init(|| attainable)
    }

    /// How far `set` is from the target over frequencies up to 6√n; in double precision where single
    /// can't tell.
    ///
    /// # Errors
    /// If the set is so large that its spectrum can't be had.
    pub fn residual(&self, set: &PointSet) -> Result<Residual, SampleError> {
        let coarse = self.residual_to::<f32>(set, spectral::TOLERANCE)?;
        if coarse.rms >= spectral::FINE_RESIDUAL {
            return Ok(coarse);
        }
        self.residual_to::<f64>(set, spectral::FINE_TOLERANCE)
    }

    /// Bytes that a set of `n` points takes to make and to measure, beyond the points.
    fn bytes(&self, n: usize) -> usize {
        let measure = Match::<f32>::bytes(spectral::max_frequency(MEASURED, n), n);
        match &self.algorithm {
            Algorithm::Spectral(spectral) => spectral.bytes(n).max(measure),
            _ => measure,
        }
    }

    fn residual_to<T: Real>(
        &self,
        set: &PointSet,
        tolerance: f64,
    ) -> Result<Residual, SampleError> {
        let limit = spectral::max_frequency(MEASURED, set.len());
        let rings = Rings::new(&self.target, limit, Weights::default());
        let mut measure = spectral::plan(Match::<T>::new(rings, set.len(), tolerance))?;
        Ok(measure.residual_of(set.points()))
    }
}

impl Sampler for SpectrumMatching {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        check_count("spectrum matching", n)?;
        check_room(n, self.bytes(n))?;
        let wanted = self.target.density().points_per_unit_area();
        let start = match &self.start {
            Some(start) => start.clone(),
            None => Stochastic::default().sample(n, seed, observer)?.points,
        };
        if wanted != n as f64 || start.len() != n {
            return Err(SampleError::InvalidCount {
                method: "spectrum matching",
                n,
                need: "as many as its target and its starting points are for",
                nearest: wanted as usize,
            });
        }
        let outcome = match &self.algorithm {
            Algorithm::Spectral(spectral) => {
                spectral.run(&self.target, self.attainable(), &start, observer)?
            }
            Algorithm::Force(force) => force.run(&self.target, &start, observer)?,
            Algorithm::Gradient(gradient) => gradient.run(&self.target, &start, observer)?,
            Algorithm::Annealing(annealing) => {
                annealing.run(&self.target, &start, seed, observer)?
            }
        };
        let points = PointSet::new(outcome.points).expect("algorithms wrap what they move");
        let residual = self.residual(&points)?;
        let report = Report::new()
            .with("iterations", u64::from(outcome.iterations))
            .with("residual", residual.rms)
            .with("empty_power", residual.empty_power)
            .with("converged", outcome.end.is_convergence())
            .with("ended_by", outcome.end.name());
        Ok(Sample { points, report })
    }
}

/// The error for a target that can't be made from these options.
fn invalid_target(option: &'static str, error: &bn_spectral::TargetError) -> SampleError {
    SampleError::InvalidOption { option, reason: error.to_string() }
}

/// An option that is a frequency or a power times a frequency.
const fn frequency(name: &'static str, default: &'static str, help: &'static str) -> OptionSpec {
    OptionSpec {
        name,
        kind: OptionKind::Real { min: 0.0, max: 1e9 },
        default: DefaultValue::Absent(default),
        help,
        unit: "cycles per unit",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::{Density, Unobserved};

    #[test]
    fn a_target_is_judged_once() {
        let target = Target::step(Density::new(20), 2.0).expect("valid");
        let matching = SpectrumMatching::new(target, Algorithm::default().with_iterations(1));
        matching.sample(20, Seed::new(1), &Unobserved).expect("possible");
        // What is kept is what counts from then on.
        let known = *matching.attainable.get().expect("judged");
        assert!(known.realizable && known.unobjectionable);
        let other = OnceLock::from(Attainable { realizable: false, unobjectionable: false });
        let matching = SpectrumMatching { attainable: other, ..matching };
        assert!(!matching.attainable().realizable);
        let beyond = Target::step(Density::new(20), 9.0).expect("valid");
        let verdict = Realizability::of(&beyond);
        let judged = SpectrumMatching::new(beyond, Algorithm::default()).judged(&verdict);
        assert!(judged.attainable.get().is_some_and(|known| !known.realizable));
    }
}
