//! Rings of modes: what the target asks of each, and what a power spectrum costs there.

use bn_spectral::Target;
use rayon::prelude::*;

/// Rings to one cycle per unit: half a cycle wide.
const PER_CYCLE: f64 = 2.0;
/// Mean target below which a ring is to be empty.
const EMPTY: f64 = 1e-3;
/// Where the target was measured, deviations count the more the less power there is, down to this:
/// that of order is small, and would else be drowned.
const QUIET: f64 = 0.02;
/// Rows of modes that make one piece of work.
const ROWS: usize = 64;

/// What a deviation from the target costs, by frequency.
///
/// The cost is the mean over all modes 0 < |k| < K of λ·(ν₀/ν)^p·P on rings that are to be empty and
/// of μ·(ν₀/ν)²·(P̄ − P)² on the others, ν₀ the end of the empty region, ring means in P̄; ν₀/ν counts
/// as 1 below ν₀ on rings that aren't empty.
///
/// Of a target that was measured on point sets, μ is μ·1.02/(P + 0.02): without, imitations of well
/// ordered points have five times the power of their models at low frequencies.
///
/// The curvature of a mode's power by the points' positions grows like ν². With p = 2 and μ = λ/4 the
/// cost's is about the same at every frequency, but of measured targets: that is what makes the search
/// short.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Weights {
    /// λ, for power where there should be none; by default [`Weights::ATTAINABLE`] or
    /// [`Weights::NEAREST`], as the target is realizable or not.
    pub empty: Option<f64>,
    /// p, how fast λ grows towards low frequencies. With p = 0 the few lowest modes get more than their
    /// share of a misfit, and the points leave holes: of 1.38 `d_hex` instead of 0.80 for single-peak blue
    /// noise.
    pub exponent: f64,
    /// μ, for the ring means.
    pub ring: f64,
}

impl Default for Weights {
    fn default() -> Self {
        Self { empty: None, exponent: 2.0, ring: 25.0 }
    }
}

impl Weights {
    /// λ for spectra that point sets can have: well conditioned.
    pub const ATTAINABLE: f64 = 100.0;
    /// λ for spectra that no set can have: the misfit is spread so that the rest stays flat.
    pub const NEAREST: f64 = 4.0;

    /// With λ as the target wants it, if it isn't chosen.
    pub(super) fn completed(self, attainable: bool) -> Self {
        let default = if attainable { Self::ATTAINABLE } else { Self::NEAREST };
        Self { empty: self.empty.or(Some(default)), ..self }
    }
}

/// Rings of width ½ of the integer modes 0 < |k| < K, and what each is to hold.
#[derive(Clone, Debug)]
pub(in super::super) struct Rings {
    max_frequency: usize,
    goals: Vec<Goal>,
    /// Modes of all rings.
    modes: f64,
}

/// What is wanted of one ring.
#[derive(Clone, Copy, Debug)]
struct Goal {
    /// Number of modes, k and −k both counted.
    modes: f64,
    /// Mean of the target over them.
    power: f64,
    empty: bool,
    weight: f64,
}

/// How far a set is from its target.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Residual {
    /// Root mean square of ring mean less target, over all modes.
    pub rms: f64,
    /// Mean power of the modes where the target has none; 0 if it has some everywhere.
    pub empty_power: f64,
}

impl Rings {
    /// The rings up to K = `max_frequency`.
    pub(in super::super) fn new(target: &Target, max_frequency: usize, weights: Weights) -> Self {
        let (modes, sums) = count_modes(target, max_frequency);
        let count = modes.len();
        let power = |ring: usize| if modes[ring] > 0.0 { sums[ring] / modes[ring] } else { 0.0 };
        let empty = |ring: usize| modes[ring] > 0.0 && power(ring) < EMPTY;
        let middle = |ring: usize| (ring as f64 + 0.5) / PER_CYCLE;
        // Without an empty region the weights' scale is that of the spacing.
        let root = target.density().points_per_unit_area().sqrt();
        let edge = (0..count).rev().find(|&ring| empty(ring)).map_or(0.5 * root, middle);
        let lambda = weights.empty.unwrap_or(Weights::ATTAINABLE);
        let measured = target.is_measured();
        let share = |power: f64| if measured { (1.0 + QUIET) / (power + QUIET) } else { 1.0 };
        let goal = |ring: usize| Goal {
            modes: modes[ring],
            power: power(ring),
            empty: empty(ring),
            weight: if empty(ring) {
                lambda * libm::pow(edge / middle(ring), weights.exponent)
            } else {
                weights.ring * (edge / middle(ring)).min(1.0).powi(2) * share(power(ring))
            },
        };
        let goals: Vec<Goal> = (0..count).map(goal).collect();
        Self { max_frequency, goals, modes: modes.iter().sum() }
    }

    /// K.
    pub(super) fn max_frequency(&self) -> usize {
        self.max_frequency
    }

    /// Room for the ring of any mode |kx|, |ky| ≤ K: those from |k| = K on count nowhere.
    pub(super) fn room(&self) -> usize {
        Self::ring(2.0 * (self.max_frequency as f64).powi(2)) + 1
    }

    /// The ring of a mode with |k|² = `square`.
    #[inline]
    pub(super) fn ring(square: f64) -> usize {
        (square.sqrt() * PER_CYCLE) as usize
    }

    /// The cost of a spectrum whose rings have these sums of power, and its derivative by the power
    /// of each mode, ring by ring.
    pub(super) fn cost(&self, sums: &[f64], derivatives: &mut [f64]) -> f64 {
        let mut cost = 0.0;
        for ((goal, &sum), derivative) in self.goals.iter().zip(sums).zip(derivatives) {
            if goal.modes == 0.0 {
                continue;
            }
            let deviation = sum / goal.modes - goal.power;
            let (each, slope) = if goal.empty {
                (sum / goal.modes, 1.0)
            } else {
                (deviation * deviation, 2.0 * deviation)
            };
            cost += goal.weight * goal.modes * each;
            *derivative = goal.weight * slope / self.modes;
        }
        if self.modes > 0.0 { cost / self.modes } else { 0.0 }
    }

    /// How far a spectrum with these sums is from the target.
    pub(super) fn residual(&self, sums: &[f64]) -> Residual {
        let (mut squares, mut power, mut empty) = (0.0, 0.0, 0.0);
        for (goal, &sum) in self.goals.iter().zip(sums).filter(|(goal, _)| goal.modes > 0.0) {
            squares += goal.modes * (sum / goal.modes - goal.power).powi(2);
            if goal.empty {
                power += sum;
                empty += goal.modes;
            }
        }
        let mean = |sum: f64, count: f64| if count > 0.0 { sum / count } else { 0.0 };
        Residual { rms: mean(squares, self.modes).sqrt(), empty_power: mean(power, empty) }
    }
}

/// Number of modes and sum of the target over them, ring by ring up to the last whole one: kx ≥ 0, ky > 0 is a quarter of the
/// plane with one of its axes and stands for all four.
fn count_modes(target: &Target, max_frequency: usize) -> (Vec<f64>, Vec<f64>) {
    let limit = (max_frequency as f64).powi(2);
    let rings = Rings::ring(limit);
    let piece = |first: usize| {
        let (mut modes, mut sums) = (vec![0.0; rings], vec![0.0; rings]);
        for kx in first..(first + ROWS).min(max_frequency + 1) {
            for ky in 1..=max_frequency {
                let square = (kx * kx + ky * ky) as f64;
                if square < limit {
                    let ring = Rings::ring(square);
                    modes[ring] += 4.0;
                    sums[ring] += 4.0 * target.power(square.sqrt());
                }
            }
        }
        (modes, sums)
    };
    let firsts: Vec<usize> = (0..=max_frequency).step_by(ROWS).collect();
    let pieces: Vec<_> = firsts.into_par_iter().map(piece).collect();
    let (mut modes, mut sums) = (vec![0.0; rings], vec![0.0; rings]);
    for (more_modes, more_sums) in pieces {
        for ring in 0..rings {
            modes[ring] += more_modes[ring];
            sums[ring] += more_sums[ring];
        }
    }
    (modes, sums)
}
