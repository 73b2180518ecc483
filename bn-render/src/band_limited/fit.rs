//! From samples on the unit torus to the polynomial that fits them.

use std::ops::ControlFlow;

use bn_core::{DVec2, Observer, Progress};

use super::convergence::{Convergence, Stopping};
use super::domain::check_degree;
use super::error::BandLimitedError;
use super::modes::{Degree, Modes};
use super::polynomial::TrigonometricPolynomial;
use super::scattered::Scattered;
use super::toeplitz::Toeplitz;
use super::{conjugate_gradients, projections};

/// Fits trigonometric polynomials to values at irregular points of the unit torus, in the sense of
/// the least Σ wⱼ (p(xⱼ) − fⱼ)².
///
/// A function that is such a polynomial is found again, from any points without too large holes
/// (1/(4K) or a little more between a place and the nearest point; the sufficient conditions that are
/// proved are stricter). Values that no polynomial of the degree has are approximated.
///
/// ```
/// use bn_core::{DVec2, Unobserved};
/// use bn_render::{BandLimitedFit, Degree, Stopping};
///
/// // An 8 × 8 lattice with every point moved a little.
/// let place = |i: usize| DVec2::new((i % 8) as f64 + (i * i % 5) as f64 / 15.0, (i / 8) as f64) / 8.0;
/// let points: Vec<DVec2> = (0..64).map(place).collect();
/// let wave = |p: &DVec2| 0.5 + 0.3 * libm::cos(std::f64::consts::TAU * (2.0 * p.x - p.y));
/// let values: Vec<f64> = points.iter().map(wave).collect();
/// let mut fit = BandLimitedFit::new(points, &[1.0; 64], Degree { x: 2, y: 2 })?;
/// let (polynomial, told) = fit.act(&values, &Stopping::default(), &Unobserved)?;
/// assert!(told.converged());
/// assert!((polynomial.coefficient(2, -1).re - 0.15).abs() < 1e-5);
/// # Ok::<(), bn_render::BandLimitedError>(())
/// ```
pub struct BandLimitedFit {
    samples: Scattered,
    toeplitz: Option<Toeplitz>,
}

impl BandLimitedFit {
    /// A fit at these points; `weights` are the areas of their Voronoi cells, in any unit (equal ones
    /// do, at the price of more iterations and of fits that follow clusters).
    ///
    /// # Errors
    /// If a weight is negative or not finite, none is positive, or the degree is too large: transforms
    /// take 16 bytes for each of up to 8.5 (2k + 1) K or 4.3 K² places, K the larger of x and y and k the
    /// lesser, and may take 2 GB.
    ///
    /// # Panics
    /// If there isn't one weight a point.
    pub fn new(
        points: Vec<DVec2>,
        weights: &[f64],
        degree: Degree,
    ) -> Result<Self, BandLimitedError> {
        check_degree(degree)?;
        Ok(Self { samples: Scattered::new(points, weights, degree)?, toeplitz: None })
    }

    /// Adaptive weights, conjugate gradients, Toeplitz (ACT): O(K² log K) an iteration, and once
    /// O(n + K² log K) for matrix and right-hand side.
    ///
    /// # Errors
    /// If a value is not finite or the observer asks to stop.
    ///
    /// # Panics
    /// If there isn't one value a point.
    pub fn act(
        &mut self,
        values: &[f64],
        stopping: &Stopping,
        observer: &dyn Observer,
    ) -> Result<(TrigonometricPolynomial, Convergence), BandLimitedError> {
        if self.toeplitz.is_none() {
            self.toeplitz = Some(Toeplitz::new(&self.samples)?);
        }
        let Self { samples, toeplitz } = self;
        let toeplitz = toeplitz.as_mut().expect("was just made");
        solved(samples, values, |samples, _, b| {
            conjugate_gradients::solve(samples, toeplitz, b, stopping, observer)
        })
    }

    /// Alternating projections (POCS), with the relaxation that lowers the misfit most:
    /// O(n + K² log K) an iteration, of which it needs about as many as T's condition number.
    ///
    /// # Errors
    /// As [`BandLimitedFit::act`].
    ///
    /// # Panics
    /// As [`BandLimitedFit::act`].
    pub fn pocs(
        &mut self,
        values: &[f64],
        stopping: &Stopping,
        observer: &dyn Observer,
    ) -> Result<(TrigonometricPolynomial, Convergence), BandLimitedError> {
        solved(&mut self.samples, values, |samples, values, b| {
            projections::solve(samples, values, b, stopping, observer)
        })
    }
}

impl std::fmt::Debug for BandLimitedFit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("BandLimitedFit")
            .field("samples", &self.samples.len())
            .field("degree", &self.samples.degree())
            .finish_non_exhaustive()
    }
}

/// Where the right-hand side is this small beside the values, nothing of them lies in the band but
/// what the transforms' error puts there.
const NOTHING: f64 = 1e-10;

/// Takes constant and scale from the values, solves for what is left, and puts them back: constants
/// come out exactly, and squares stay within the range of numbers.
fn solved(
    samples: &mut Scattered,
    values: &[f64],
    solve: impl FnOnce(&mut Scattered, &[f64], &Modes) -> Result<(Modes, Convergence), BandLimitedError>,
) -> Result<(TrigonometricPolynomial, Convergence), BandLimitedError> {
    assert_eq!(values.len(), samples.len(), "one value a sample");
    // The values themselves first: one that is no number would spoil the mean, and all differences.
    finite(values)?;
    let constant = level(values, samples.weights());
    let mut relative: Vec<f64> = values.iter().map(|value| value - constant).collect();
    finite(&relative)?;
    let scale = relative.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    if scale > 0.0 {
        for value in &mut relative {
            *value /= scale;
        }
    }
    let mut b = Modes::zeros(samples.degree());
    samples.sum_modes(&relative, &mut b);
    let energy: f64 = samples.weights().iter().zip(&relative).map(|(w, f)| w * f * f).sum();
    if b.norm_squared() <= NOTHING * NOTHING * energy {
        b.scale(0.0);
    }
    let (mut modes, convergence) = solve(samples, &relative, &b)?;
    modes.scale(scale);
    Ok((TrigonometricPolynomial { constant, modes }, convergence))
}

fn finite(values: &[f64]) -> Result<(), BandLimitedError> {
    match values.iter().position(|value| !value.is_finite()) {
        Some(index) => Err(BandLimitedError::Value { index }),
        None => Ok(()),
    }
}

/// The weighted mean, as the first value and what the others differ from it: that of equal values is
/// their value, to the bit.
pub(super) fn level(values: &[f64], weights: &[f64]) -> f64 {
    let Some(first) = values.first() else { return 0.0 };
    let weighted = values.iter().zip(weights);
    let (sum, total) = weighted
        .fold((0.0, 0.0), |(sum, total), (value, w)| (sum + w * (value - first), total + w));
    first + if total > 0.0 { sum / total } else { 0.0 }
}

/// Tells of an iteration; an error if it is not to be made.
pub(super) fn observe(
    observer: &dyn Observer,
    done: usize,
    stopping: &Stopping,
) -> Result<(), BandLimitedError> {
    let progress = Progress::new("reconstructing", done as u64, Some(stopping.iterations as u64));
    match observer.observe(&progress) {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(BandLimitedError::Cancelled),
    }
}
