//! Simulated annealing of the pair correlation.

use bn_core::{Curve, DVec2, Observer, PointSet, Progress, Seed, torus};
use bn_spectral::{PairHistogram, Target};
use rand::RngExt as _;

use super::{End, Outcome};
use crate::SampleError;
use crate::common_options::check_range;
use crate::error::observe;

/// Spectrum matching by simulated annealing: M. D. Rintoul and S. Torquato, "Reconstruction of the
/// structure of dispersions", J. Colloid Interface Sci. 186, 1997.
///
/// One random point at a time is moved at random; the move is kept if it lowers the energy, the
/// squared difference of pair counts from those wanted over what their noise would be, and else with
/// the probability e^(−ΔE/T). After each sweep over all points T and, where too few moves are kept,
/// their length are lowered. A move costs O(n), and so do the counts that it changes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Annealing {
    /// Bins to a unit of 1/√n, over [0, ½); 1000 at most.
    pub resolution: f64,
    /// T of the first sweep, in units of the energy's noise of one bin.
    pub temperature: f64,
    /// The factor of T after each sweep, 1 at most.
    pub cooling: f64,
    /// T to stop at.
    pub coldest: f64,
    /// The most sweeps.
    pub iterations: u32,
}

impl Default for Annealing {
    fn default() -> Self {
        // 405 sweeps.
        Self { resolution: 20.0, temperature: 1.0, cooling: 0.95, coldest: 1e-9, iterations: 1000 }
    }
}

/// Distances computed between two looks of the observer: some tens of milliseconds.
const UNOBSERVED: usize = 1 << 22;
/// The stream of a seed that moves are drawn from; starting points have the first ones.
const TASK: u32 = u32::MAX;

impl Annealing {
    /// Fields are public.
    fn check(&self) -> Result<(), SampleError> {
        check_range("resolution", self.resolution, 0.0, 1000.0)?;
        check_range("temperature", self.temperature, 0.0, 1e9)?;
        check_range("cooling", self.cooling, 0.0, 1.0)?;
        check_range("coldest", self.coldest, 0.0, 1e9)
    }

    pub(super) fn run(
        &self,
        target: &Target,
        start: &PointSet,
        seed: Seed,
        observer: &dyn Observer,
    ) -> Result<Outcome, SampleError> {
        self.check()?;
        let n = start.len();
        let root = (n as f64).sqrt();
        let bins = ((0.5 * self.resolution * root) as usize).clamp(2, 1 << 20);
        let mut state = State::new(target, start, bins);
        let mut rng = seed.stream(TASK);
        let (mut temperature, mut length, mut sweep) = (self.temperature, 0.5, 0);
        while temperature >= self.coldest && sweep < self.iterations {
            observer.iterated(sweep.into(), &|| state.points.clone());
            let mut kept = 0;
            for step in 0..n {
                if step.is_multiple_of((UNOBSERVED / n).max(1)) {
                    let figures = [("energy", state.energy()), ("temperature", temperature)];
                    let most = Some(self.iterations.into());
                    let progress = Progress::new("annealing", sweep.into(), most);
                    observe(observer, &progress.with_figures(&figures))?;
                }
                let index = rng.random_range(0..n as u32) as usize;
                let step = DVec2::new(rng.random::<f64>() - 0.5, rng.random::<f64>() - 0.5);
                let chance: f64 = rng.random();
                let place = torus::wrap_point(state.points[index] + step * (2.0 * length / root));
                let change = state.change(index, place);
                if change <= 0.0 || chance < libm::exp(-change / temperature) {
                    state.keep(index, place);
                    kept += 1;
                }
            }
            temperature *= self.cooling;
            length = if 5 * kept < n { (0.9 * length).max(1e-4) } else { (1.05 * length).min(0.5) };
            sweep += 1;
        }
        let end = if temperature < self.coldest { End::Temperature } else { End::Iterations };
        Ok(Outcome { points: state.points, iterations: sweep, end })
    }
}

/// The points, their pair counts and the counts wanted.
struct State {
    points: Vec<DVec2>,
    bins_per_unit: f64,
    /// Count less the count wanted, by bin.
    excess: Vec<f64>,
    /// One over the variance of each count, of independent points.
    weights: Vec<f64>,
    /// Changes of counts by the move at hand, and the bins that change.
    delta: Vec<f64>,
    touched: Vec<usize>,
    /// Whether a bin is among them.
    is_touched: Vec<bool>,
}

impl State {
    fn new(target: &Target, start: &PointSet, bins: usize) -> Self {
        let histogram = PairHistogram::new(start, bins);
        let wanted: Curve = target.rdf_histogram(bins);
        let pairs = start.len() as f64 * (start.len() as f64 - 1.0) / 2.0;
        let unit = pairs * std::f64::consts::PI * histogram.bin_width().powi(2);
        let expected = |i: usize| unit * (2 * i + 1) as f64;
        let counts = histogram.counts().iter().zip(wanted.values()).enumerate();
        Self {
            points: start.points().to_vec(),
            bins_per_unit: 1.0 / histogram.bin_width(),
            excess: counts.map(|(i, (&count, g))| count as f64 - g * expected(i)).collect(),
            weights: (0..bins).map(|i| 1.0 / expected(i).max(1.0)).collect(),
            delta: vec![0.0; bins],
            touched: Vec::new(),
            is_touched: vec![false; bins],
        }
    }

    /// Σ (count − wanted)²/variance: about the number of bins for independent points.
    fn energy(&self) -> f64 {
        self.excess.iter().zip(&self.weights).map(|(e, w)| w * e * e).sum()
    }

    /// By how much the energy changes if the point goes to `place`; remembers the changes of counts.
    fn change(&mut self, index: usize, place: DVec2) -> f64 {
        for bin in self.touched.drain(..) {
            self.delta[bin] = 0.0;
            self.is_touched[bin] = false;
        }
        let from = self.points[index];
        for (other, &q) in self.points.iter().enumerate() {
            if other == index {
                continue;
            }
            for (p, sign) in [(from, -1.0), (place, 1.0)] {
                let bin = (torus::distance(p, q) * self.bins_per_unit) as usize;
                if bin < self.delta.len() {
                    self.delta[bin] += sign;
                    // Bins come up several times; each counts once.
                    if !self.is_touched[bin] {
                        self.is_touched[bin] = true;
                        self.touched.push(bin);
                    }
                }
            }
        }
        let change = |&bin: &usize| {
            let (delta, excess) = (self.delta[bin], self.excess[bin]);
            self.weights[bin] * delta * (2.0 * excess + delta)
        };
        self.touched.iter().map(change).sum()
    }

    /// Makes the move that was looked at last.
    fn keep(&mut self, index: usize, place: DVec2) {
        self.points[index] = place;
        for &bin in &self.touched {
            self.excess[bin] += self.delta[bin];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stochastic::uniform_points;
    use bn_core::Density;
    use std::ops::ControlFlow;
    use std::sync::atomic::{AtomicU32, Ordering};

    #[test]
    fn changes_of_the_energy_are_its_differences() {
        let n = 60;
        let set = PointSet::new(uniform_points(n, Seed::new(4), 0).expect("few")).expect("valid");
        let target = Target::step(Density::new(n), 4.0).expect("valid");
        let mut state = State::new(&target, &set, 80);
        for (index, place) in
            uniform_points(n, Seed::new(5), 0).expect("few").into_iter().enumerate()
        {
            let before = state.energy();
            let change = state.change(index, place);
            state.keep(index, place);
            let now = PointSet::new(state.points.clone()).expect("on the torus");
            let fresh = State::new(&target, &now, 80).energy();
            assert!((before + change - state.energy()).abs() < 1e-9 * before);
            assert!((fresh - state.energy()).abs() < 1e-9 * before, "{fresh} {}", state.energy());
        }
    }

    /// Ends at its third look.
    #[derive(Default)]
    struct Impatient(AtomicU32);

    impl Observer for Impatient {
        fn observe(&self, _: &Progress<'_>) -> ControlFlow<()> {
            match self.0.fetch_add(1, Ordering::Relaxed) {
                2 => ControlFlow::Break(()),
                _ => ControlFlow::Continue(()),
            }
        }
    }

    #[test]
    fn a_sweep_can_be_ended_halfway() {
        let n = 4096;
        let set = PointSet::new(uniform_points(n, Seed::new(4), 0).expect("few")).expect("valid");
        let target = Target::step(Density::new(n), 30.0).expect("valid");
        let sweep = Annealing { iterations: 1, ..Annealing::default() };
        let result = sweep.run(&target, &set, Seed::new(1), &Impatient::default());
        assert!(matches!(result, Err(SampleError::Cancelled)));
    }

    #[test]
    fn the_schedule_has_an_end() {
        let target = Target::step(Density::new(9), 1.0).expect("valid");
        let set = PointSet::new(uniform_points(9, Seed::new(4), 0).expect("few")).expect("valid");
        let outcome = Annealing::default().run(&target, &set, Seed::new(1), &bn_core::Unobserved);
        let outcome = outcome.expect("possible");
        assert_eq!((outcome.iterations, outcome.end), (405, End::Temperature));
    }
}
