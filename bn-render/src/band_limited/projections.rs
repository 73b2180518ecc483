//! Alternating projections: POCS, or the frame algorithm with adaptive weights.

use bn_core::Observer;

use super::convergence::{Convergence, ROUNDING, Stop, Stopping};
use super::error::BandLimitedError;
use super::fit::observe;
use super::modes::Modes;
use super::scattered::{Scattered, UNKNOWN};

/// Corrects the function at the samples, each correction smeared over the sample's cell, low-passes
/// the correction, and again: a ← a + μ P Σ wⱼ rⱼ δ(x − xⱼ) with the residuals rⱼ = fⱼ − p(xⱼ).
///
/// That is the simultaneous projection onto the sets of functions that have one of the samples,
/// alternating with that onto band-limited functions (P. L. Combettes, *The foundations of set
/// theoretic estimation*, Proc. IEEE 81, 1993), and the frame algorithm with adaptive weights
/// (Feichtinger and Gröchenig 1994). With a fixed relaxation between 0 and 2/‖T‖ it converges by
/// (κ − 1)/(κ + 1) an iteration at best, κ the condition number of T. Here it is the one that leaves
/// the least Σ wⱼ rⱼ², μ = ‖g‖²/Σ wⱼ g(xⱼ)² with g the correction: no bound need be known, and the
/// misfit never grows, also where no band-limited function has all the samples.
///
/// An iteration costs one pair of NUFFTs.
pub(super) fn solve(
    samples: &mut Scattered,
    values: &[f64],
    b: &Modes,
    stopping: &Stopping,
    observer: &dyn Observer,
) -> Result<(Modes, Convergence), BandLimitedError> {
    let mut a = Modes::zeros(b.degree());
    let (mut residuals, mut correction) = (values.to_vec(), b.clone());
    let mut at_points = vec![0.0; values.len()];
    let start = b.norm_squared();
    let mut square = start;
    let mut history = Vec::new();
    let relative = |square: f64| if start > 0.0 { (square / start).sqrt() } else { 0.0 };
    let stop = loop {
        if relative(square) <= stopping.tolerance.max(ROUNDING) {
            break Stop::Tolerance;
        }
        if history.len() == stopping.iterations {
            break Stop::Iterations;
        }
        observe(observer, history.len(), stopping)?;
        samples.sum_points(&correction, &mut at_points);
        let weighted = samples.weights().iter().zip(&at_points);
        let energy: f64 = weighted.map(|(w, g)| w * g * g).sum();
        let step = square / energy;
        if !(energy > UNKNOWN * square && step.is_finite()) {
            break Stop::Exhausted;
        }
        a.add(step, &correction);
        for (r, g) in residuals.iter_mut().zip(&at_points) {
            *r -= step * g;
        }
        samples.sum_modes(&residuals, &mut correction);
        square = correction.norm_squared();
        history.push(relative(square));
    };
    // The residuals at the points were updated; computed anew they are what they are.
    samples.sum_points(&a, &mut at_points);
    for ((r, value), p) in residuals.iter_mut().zip(values).zip(&at_points) {
        *r = value - p;
    }
    samples.sum_modes(&residuals, &mut correction);
    let residual = relative(correction.norm_squared());
    let convergence = Convergence {
        stop: stop.confirmed(residual, stopping.tolerance),
        residual,
        history,
        condition: None,
        coefficients: b.degree().coefficients(),
        samples: samples.len(),
    };
    Ok((a, convergence))
}
