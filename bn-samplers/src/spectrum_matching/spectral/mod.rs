//! Matching the periodogram itself: ring means by L-BFGS, all gradients by non-uniform FFTs.

mod lbfgs;
mod objective;
mod rings;

use bn_core::{DVec2, Observer, PointSet, Progress, torus};
use bn_spectral::{NufftError, NufftOptions, Real, Realizability, Target};

use super::Outcome;
use crate::SampleError;
use crate::error::observe;

use lbfgs::Lbfgs;
pub(super) use objective::Match;
pub(super) use rings::Rings;
pub use rings::{Residual, Weights};

/// Relative error of the Fourier sums: a power of 1e-8 is still told from 0.
pub(super) const TOLERANCE: f64 = 1e-4;
/// The same in double precision, for costs that single precision can't resolve …
const FINE_TOLERANCE: f64 = 1e-7;
/// … below this.
const FINE_COST: f64 = 1e-9;
/// How far the fastest point goes at the first trial of a stage, in 1/√n.
const FIRST_MOVE: f64 = 0.1;
/// Earlier stages may end at this many times the cost that the last one ends at.
const COARSE: f64 = 1000.0;
/// The most evaluations of earlier stages if no set can have the spectrum: more bring order into the
/// points, but not their spectrum nearer.
const UNATTAINABLE: u32 = 60;
/// A stage has got stuck when this many line searches …
const PATIENCE: usize = 10;
/// … lower the cost by less than this part of it.
const LEAST_GAIN: f64 = 0.01;

/// The default way of matching: makes the ring means of the periodogram those of the target and
/// takes the power away from every mode where there should be none, by moving all points along the
/// L-BFGS direction of that cost ([`Weights`]).
///
/// In stages, from a range of frequencies that shapes the pattern to one that covers all that Ω
/// looks at. An evaluation costs two non-uniform FFTs, O(n·w² + K² log K), whose plans are kept; the
/// number of evaluations doesn't grow with n. Realizable spectra are met to any accuracy: the cost
/// falls below `tolerance`. Of others the search ends where it stops paying.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Spectral {
    /// Ranges and budgets, coarse to fine.
    pub stages: Vec<Stage>,
    /// Stop at this cost, about a mean square error weighted by [`Weights`].
    pub tolerance: f64,
    /// None: as the target allows, [`Weights::ATTAINABLE`] or [`Weights::NEAREST`].
    pub weights: Option<Weights>,
}

/// A stage of [`Spectral`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Stage {
    /// K/√n: the highest frequency that is matched.
    pub range: f64,
    /// The most evaluations.
    pub evaluations: u32,
}

impl Default for Spectral {
    fn default() -> Self {
        Self {
            stages: vec![
                Stage { range: 1.5, evaluations: 150 },
                Stage { range: 6.0, evaluations: 150 },
            ],
            tolerance: 1e-6,
            weights: None,
        }
    }
}

/// K for `range`·√n; modes beyond the NUFFT's largest are left alone.
pub(super) fn max_frequency(range: f64, n: usize) -> usize {
    let wanted = (range * (n as f64).sqrt()).ceil();
    (wanted as usize).clamp(2, NufftOptions::MAX_FREQUENCY)
}

impl Spectral {
    /// Lowers the budgets to `evaluations` in all, the first stage's share first.
    pub(super) fn limit(&mut self, mut evaluations: u32) {
        for stage in &mut self.stages {
            stage.evaluations = stage.evaluations.min(evaluations);
            evaluations -= stage.evaluations;
        }
    }

    pub(super) fn run(
        &self,
        target: &Target,
        start: &PointSet,
        observer: &dyn Observer,
    ) -> Result<Outcome, SampleError> {
        let verdict = Realizability::of(target);
        let weights = self.weights.unwrap_or_else(|| default_weights(&verdict));
        let n = start.len();
        let root = (n as f64).sqrt();
        let mut x: Vec<DVec2> = start.points().iter().map(|p| *p * root).collect();
        let (mut iterations, mut before, mut converged) = (0, 0, false);
        for (number, stage) in self.stages.iter().enumerate() {
            let last = number + 1 == self.stages.len();
            let goal = if last { self.tolerance } else { COARSE * self.tolerance };
            let rings = Rings::new(target, max_frequency(stage.range, n), weights);
            let most = if last || verdict.realizable { u32::MAX } else { UNATTAINABLE };
            let budget = stage.evaluations.min(most);
            let search = Search { budget, goal, observer, number, before };
            let found = if goal < FINE_COST {
                search.run(&mut plan(Match::<f64>::new(rings, n, FINE_TOLERANCE))?, x)?
            } else {
                search.run(&mut plan(Match::<f32>::new(rings, n, TOLERANCE))?, x)?
            };
            x = found.x;
            iterations += found.evaluations;
            before += found.searches;
            converged = found.converged;
        }
        let points = x.iter().map(|x| torus::wrap_point(*x / root)).collect();
        Ok(Outcome { points, iterations, converged })
    }
}

/// A plan, or which option asks for too much.
pub(super) fn plan<P>(made: Result<P, NufftError>) -> Result<P, SampleError> {
    made.map_err(|error| SampleError::InvalidOption { option: "range", reason: error.to_string() })
}

/// Spectra that leave less than 0.7 √n empty and are realizable as far as is known can be met.
fn default_weights(verdict: &Realizability) -> Weights {
    if verdict.realizable && verdict.warnings.is_empty() {
        Weights::ATTAINABLE
    } else {
        Weights::NEAREST
    }
}

/// One stage's search.
struct Search<'a> {
    budget: u32,
    goal: f64,
    observer: &'a dyn Observer,
    number: usize,
    /// Line searches of earlier stages.
    before: u64,
}

/// Where a stage ended.
struct Found {
    x: Vec<DVec2>,
    evaluations: u32,
    searches: u64,
    converged: bool,
}

impl Search<'_> {
    fn run<T: Real>(&self, cost: &mut Match<T>, x: Vec<DVec2>) -> Result<Found, SampleError> {
        let mut search = Lbfgs::new(x, cost);
        let mut history = vec![search.value()];
        let places = |x: &[DVec2]| {
            let root = (x.len() as f64).sqrt();
            x.iter().map(|x| torus::wrap_point(*x / root)).collect()
        };
        let stage = ["matching coarsely", "matching"][self.number.min(1)];
        loop {
            let value = search.value();
            let figures = [("cost", value), ("rms", cost.residual().rms)];
            let done = u64::from(search.evaluations().min(self.budget));
            let progress = Progress::new(stage, done, Some(self.budget.into()));
            observe(self.observer, &progress.with_figures(&figures))?;
            let iteration = self.before + (history.len() - 1) as u64;
            self.observer.iterated(iteration, &|| places(search.x()));
            let earlier = history.len().checked_sub(PATIENCE + 1).map(|i| history[i]);
            let stuck = earlier.is_some_and(|earlier| value > (1.0 - LEAST_GAIN) * earlier);
            let over = value <= self.goal || search.evaluations() >= self.budget || stuck;
            if over || !search.step(cost, FIRST_MOVE) {
                break;
            }
            history.push(search.value());
        }
        let (evaluations, converged) = (search.evaluations(), search.value() <= self.goal);
        let searches = (history.len() - 1) as u64;
        Ok(Found { x: search.into_x(), evaluations, searches, converged })
    }
}
