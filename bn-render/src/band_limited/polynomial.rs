//! Real trigonometric polynomials on the unit torus.

use bn_core::DVec2;
use bn_spectral::Complex;

use super::error::BandLimitedError;
use super::modes::{Degree, Modes};
use super::scattered::values_at;

/// p(x) = c + Σ a(k) exp(2πi k·x) over |kx| ≤ `degree.x`, |ky| ≤ `degree.y`, real.
#[derive(Clone, Debug, PartialEq)]
pub struct TrigonometricPolynomial {
    /// Kept apart, so that constants stay exact.
    pub(super) constant: f64,
    pub(super) modes: Modes,
}

impl TrigonometricPolynomial {
    /// The degree.
    pub fn degree(&self) -> Degree {
        self.modes.degree()
    }

    /// The coefficient of exp(2πi k·x), the constant part of k = 0 included; 0 beyond the degree.
    pub fn coefficient(&self, kx: i64, ky: i64) -> Complex<f64> {
        let Degree { x, y } = self.degree();
        if kx.unsigned_abs() > x as u64 || ky.unsigned_abs() > y as u64 {
            return Complex::new(0.0, 0.0);
        }
        let conjugate = kx < 0;
        let (kx, ky) = if conjugate { (-kx, -ky) } else { (kx, ky) };
        let value = self.modes.column(kx as usize)[(ky + y as i64) as usize];
        let constant = if (kx, ky) == (0, 0) { self.constant } else { 0.0 };
        constant + if conjugate { value.conj() } else { value }
    }

    /// The values at points of the torus, by NUFFT to some 1e-11 of the polynomial's norm.
    ///
    /// # Errors
    /// If the degree is beyond what can be transformed.
    pub fn values(&self, points: &[DVec2]) -> Result<Vec<f64>, BandLimitedError> {
        let mut values = values_at(&self.modes, points)?;
        for value in &mut values {
            *value += self.constant;
        }
        Ok(values)
    }
}
