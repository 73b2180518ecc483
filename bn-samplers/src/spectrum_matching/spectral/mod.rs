//! Matching the periodogram itself: ring means by L-BFGS, all gradients by non-uniform FFTs.

mod lbfgs;
mod objective;
mod rings;

use bn_core::{DVec2, Observer, PointSet, Progress, torus};
use bn_spectral::{NufftError, NufftOptions, Real, Target};

use super::{Attainable, End, MEASURED, Outcome};
use crate::SampleError;
use crate::common_options::check_range;
use crate::error::observe;

use lbfgs::Lbfgs;
pub(super) use objective::Match;
pub(super) use rings::Rings;
pub use rings::{Residual, Weights};

/// Relative error of the Fourier sums: a power of 1e-8 is still told from 0.
pub(super) const TOLERANCE: f64 = 1e-4;
/// The same in double precision, for residuals that single precision can't resolve …
pub(super) const FINE_TOLERANCE: f64 = 1e-7;
/// … below this.
pub(super) const FINE_RESIDUAL: f64 = 1e-4;
/// The range of frequencies, in √n, that shapes a pattern.
const COARSE_RANGE: f64 = 1.5;
/// Evaluations of a stage …
const EVALUATIONS: u32 = 150;
/// … and where the target was measured.
const MEASURED_EVALUATIONS: u32 = 1000;
/// How far the fastest point goes at the first trial of a stage, in 1/√n.
const FIRST_MOVE: f64 = 0.1;
/// The cost to end at where no residual is asked for.
const COST: f64 = 1e-6;
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
/// number of evaluations doesn't grow with n. Realizable spectra are met to any accuracy. Of others
/// the search ends where it stops paying: where ten line searches gain less than 1 %.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Spectral {
    /// The highest frequency that is matched in each stage, K/√n, coarse to fine.
    pub ranges: Vec<f64>,
    /// The most evaluations of each stage. None: 150, and 1000 for a spectrum that was measured, which is
    /// known to be one of point sets, perhaps well ordered ones that are found slowly.
    pub evaluations: Option<u32>,
    /// The most evaluations of all stages together; each but the last may take half of what is left.
    pub iterations: Option<u32>,
    /// Stop at this residual: the root mean square of ring means less the target over all modes up
    /// to the last range. None: at a cost, the mean square weighted by `weights`, of 1e-6. Earlier
    /// stages end at 1000 times the cost, or its root times the residual.
    pub tolerance: Option<f64>,
    /// What deviations cost.
    pub weights: Weights,
}

impl Default for Spectral {
    fn default() -> Self {
        Self {
            ranges: Self::staged(MEASURED, 2),
            evaluations: None,
            iterations: None,
            tolerance: None,
            weights: Weights::default(),
        }
    }
}

/// K for `range`·√n; modes beyond the NUFFT's largest are left alone.
pub(super) fn max_frequency(range: f64, n: usize) -> usize {
    let wanted = (range * (n as f64).sqrt()).ceil();
    (wanted as usize).clamp(2, NufftOptions::MAX_FREQUENCY)
}

impl Spectral {
    /// The ranges of `stages` stages, growing in equal ratios from 1.5, or from `range` where that is
    /// less, to `range`.
    pub fn staged(range: f64, stages: u32) -> Vec<f64> {
        let ratio = (range / COARSE_RANGE).max(1.0);
        let part = |left: u32| f64::from(left) / f64::from(stages.max(2) - 1);
        (0..stages).rev().map(|left| range * libm::pow(ratio, -part(left))).collect()
    }

    /// Checks what the ranges of the options promise: fields are public.
    fn check(&self) -> Result<(), SampleError> {
        let Weights { empty, exponent, ring } = self.weights;
        check_range("weight-exponent", exponent, 0.0, 8.0)?;
        for weight in [empty.unwrap_or(ring), ring] {
            check_range("weights", weight, 0.0, 1e9)?;
        }
        check_range("tolerance", self.tolerance.unwrap_or(0.0), 0.0, f64::MAX)?;
        self.ranges.iter().try_for_each(|&range| check_range("range", range, 0.0, 16.0))
    }

    /// Bytes that a search among `n` points takes, about.
    pub(super) fn bytes(&self, n: usize) -> usize {
        let highest = self.ranges.iter().map(|&range| max_frequency(range, n)).max().unwrap_or(0);
        let cost = if Goal::of(self.tolerance).is_fine() {
            Match::<f64>::bytes(highest, n)
        } else {
            Match::<f32>::bytes(highest, n)
        };
        Lbfgs::bytes(n).saturating_add(cost)
    }

    pub(super) fn run(
        &self,
        target: &Target,
        attainable: Attainable,
        start: &PointSet,
        observer: &dyn Observer,
    ) -> Result<Outcome, SampleError> {
        self.check()?;
        let weights = self.weights.completed(attainable.unobjectionable);
        let n = start.len();
        let root = (n as f64).sqrt();
        let mut x: Vec<DVec2> = start.points().iter().map(|p| *p * root).collect();
        let (mut iterations, mut before, mut end) = (0, 0, End::Evaluations);
        let usual = if target.is_measured() { MEASURED_EVALUATIONS } else { EVALUATIONS };
        let mut left = self.iterations.unwrap_or(u32::MAX);
        for (number, &range) in self.ranges.iter().enumerate() {
            let last = number + 1 == self.ranges.len();
            let goal =
                if last { Goal::of(self.tolerance) } else { Goal::of(self.tolerance).coarse() };
            let share = if last { left } else { left / 2 };
            let most = share.min(self.evaluations.unwrap_or(u32::MAX));
            if most == 0 {
                continue;
            }
            let pays = if last || attainable.realizable { u32::MAX } else { UNATTAINABLE };
            let usual = self.evaluations.unwrap_or(usual).min(pays);
            let rings = Rings::new(target, max_frequency(range, n), weights);
            let search = Search { usual, most, goal, observer, number, before };
            let found = if goal.is_fine() {
                search.run(&mut plan(Match::<f64>::new(rings, n, FINE_TOLERANCE))?, x)?
            } else {
                search.run(&mut plan(Match::<f32>::new(rings, n, TOLERANCE))?, x)?
            };
            x = found.x;
            left -= found.evaluations;
            iterations += found.evaluations;
            before += found.searches;
            end = found.end;
        }
        let points = x.iter().map(|x| torus::wrap_point(*x / root)).collect();
        Ok(Outcome { points, iterations, end })
    }
}

/// A plan, or which option asks for too much.
pub(super) fn plan<P>(made: Result<P, NufftError>) -> Result<P, SampleError> {
    made.map_err(|error| SampleError::InvalidOption { option: "range", reason: error.to_string() })
}

/// Where a stage may end.
#[derive(Clone, Copy)]
enum Goal {
    Cost(f64),
    Residual(f64),
}

impl Goal {
    fn of(tolerance: Option<f64>) -> Self {
        tolerance.map_or(Self::Cost(COST), Self::Residual)
    }

    /// What will do before the last stage.
    fn coarse(self) -> Self {
        match self {
            Self::Cost(cost) => Self::Cost(COARSE * cost),
            Self::Residual(residual) => Self::Residual(COARSE.sqrt() * residual),
        }
    }

    fn is_met(self, cost: f64, residual: f64) -> bool {
        match self {
            Self::Cost(most) => cost <= most,
            Self::Residual(most) => residual <= most,
        }
    }

    /// Whether it takes double precision to see that it is met.
    fn is_fine(self) -> bool {
        matches!(self, Self::Residual(most) if most < FINE_RESIDUAL)
    }
}

/// One stage's search.
struct Search<'a> {
    /// Evaluations after which it ends with the line search at hand.
    usual: u32,
    /// The most evaluations.
    most: u32,
    goal: Goal,
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
    end: End,
}

impl Search<'_> {
    fn run<T: Real>(&self, cost: &mut Match<T>, x: Vec<DVec2>) -> Result<Found, SampleError> {
        let mut search = Lbfgs::new(x, cost, self.most);
        let budget = self.usual.min(self.most);
        let mut history = vec![search.value()];
        let places = |x: &[DVec2]| {
            let root = (x.len() as f64).sqrt();
            x.iter().map(|x| torus::wrap_point(*x / root)).collect()
        };
        let stage = ["matching coarsely", "matching"][self.number.min(1)];
        let end = loop {
            let (value, rms) = (search.value(), cost.residual().rms);
            let figures = [("cost", value), ("rms", rms)];
            let done = u64::from(search.evaluations().min(budget));
            let progress = Progress::new(stage, done, Some(budget.into()));
            observe(self.observer, &progress.with_figures(&figures))?;
            let iteration = self.before + (history.len() - 1) as u64;
            // Where a stage begins, the one before has ended.
            if history.len() > 1 || self.number == 0 {
                self.observer.iterated(iteration, &|| places(search.x()));
            }
            let earlier = history.len().checked_sub(PATIENCE + 1).map(|i| history[i]);
            if self.goal.is_met(value, rms) {
                break End::Tolerance;
            } else if search.evaluations() >= budget {
                break End::Evaluations;
            } else if earlier.is_some_and(|earlier| value > (1.0 - LEAST_GAIN) * earlier) {
                break End::Stalled;
            } else if !search.step(cost, FIRST_MOVE) {
                let spent = search.evaluations() >= self.most;
                break if spent { End::Evaluations } else { End::Gradient };
            }
            history.push(search.value());
        };
        let searches = (history.len() - 1) as u64;
        Ok(Found { evaluations: search.evaluations(), x: search.into_x(), searches, end })
    }
}
