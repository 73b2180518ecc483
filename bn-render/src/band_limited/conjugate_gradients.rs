//! Adaptive weights, conjugate gradients, Toeplitz matrices: ACT.

use bn_core::Observer;

use super::convergence::{Convergence, Lanczos, ROUNDING, Stop, Stopping};
use super::error::BandLimitedError;
use super::fit::observe;
use super::modes::Modes;
use super::scattered::{Scattered, UNKNOWN};
use super::toeplitz::Toeplitz;

/// Solves T a = b by conjugate gradients from a = 0; of many solutions this finds the least.
///
/// An iteration costs one product with T: two FFTs on a grid of (4K + 1)² places, whatever the number
/// of samples.
pub(super) fn solve(
    samples: &Scattered,
    toeplitz: &mut Toeplitz,
    b: &Modes,
    stopping: &Stopping,
    observer: &dyn Observer,
) -> Result<(Modes, Convergence), BandLimitedError> {
    let (mut a, mut residual) = (Modes::zeros(b.degree()), b.clone());
    let (mut direction, mut product) = (b.clone(), Modes::zeros(b.degree()));
    let start = b.norm_squared();
    let mut rho = start;
    let mut lanczos = Lanczos::default();
    let mut history = Vec::new();
    let relative = |square: f64| if start > 0.0 { (square / start).sqrt() } else { 0.0 };
    let stop = loop {
        if relative(rho) <= stopping.tolerance.max(ROUNDING) {
            break Stop::Tolerance;
        }
        if history.len() == stopping.iterations {
            break Stop::Iterations;
        }
        observe(observer, history.len(), stopping)?;
        toeplitz.apply(&direction, &mut product);
        let curvature = direction.dot(&product);
        let alpha = rho / curvature;
        // The mean of T's eigenvalues is 1, its diagonal; those below its error are unknown.
        if !(curvature > UNKNOWN * direction.norm_squared() && alpha.is_finite()) {
            break Stop::Exhausted;
        }
        a.add(alpha, &direction);
        residual.add(-alpha, &product);
        let next = residual.norm_squared();
        let beta = next / rho;
        lanczos.step(alpha, beta);
        history.push(relative(next));
        rho = next;
        direction.scale_and_add(beta, &residual);
    };
    // Updated residuals drift from the true one.
    toeplitz.apply(&a, &mut product);
    product.scale_and_add(-1.0, b);
    let residual = relative(product.norm_squared());
    let convergence = Convergence {
        stop: stop.confirmed(residual, stopping.tolerance),
        residual,
        history,
        condition: lanczos.condition(),
        coefficients: b.degree().coefficients(),
        samples: samples.len(),
    };
    Ok((a, convergence))
}
