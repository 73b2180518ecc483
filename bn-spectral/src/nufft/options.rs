//! What a transform is asked to do.

use thiserror::Error;

use super::Nufft;
use super::design::design;
use super::direct::BLOCK;
use super::real::Real;
use super::tables::Tables;

/// Why a transform can't be planned.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum NufftError {
    /// The tolerance is NaN, zero or negative.
    #[error("a tolerance of {tolerance} can't be met; it must be a positive number")]
    Tolerance {
        /// The tolerance that was asked for.
        tolerance: f64,
    },
    /// The largest frequency is beyond [`NufftOptions::MAX_FREQUENCY`].
    #[error(
        "frequencies up to {max_frequency} are too many; the largest may be {}",
        NufftOptions::MAX_FREQUENCY
    )]
    Frequency {
        /// The largest frequency that was asked for.
        max_frequency: usize,
    },
}

/// Range, accuracy and manner of a transform; makes its plan.
///
/// ```
/// use bn_spectral::{Nufft, NufftOptions};
///
/// let plan: Nufft = NufftOptions::new(320, 1e-6).expecting(4096).sequential().plan()?;
/// assert!(plan.error() <= 1e-6);
/// # Ok::<(), bn_spectral::NufftError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct NufftOptions {
    max_frequency: usize,
    tolerance: f64,
    points: usize,
    parallel: bool,
    portable: bool,
}

impl NufftOptions {
    /// The largest K that can be asked for.
    pub const MAX_FREQUENCY: usize = 1 << 16;

    /// Modes with |kx|, |ky| ≤ K = `max_frequency`, to a relative l2 error of `tolerance` for points in
    /// general position, up to three times that on lattices, whose errors add up in single modes;
    /// values outside [1e-13, 1e-2] count as the nearest in it. Single precision reaches about 1e-5.
    ///
    /// Expects (K/5)² points: a range of ten times their √n/2.
    pub fn new(max_frequency: usize, tolerance: f64) -> Self {
        let points = (max_frequency / 5).saturating_pow(2).max(1);
        Self { max_frequency, tolerance, points, parallel: true, portable: false }
    }

    /// The number of points to choose the fastest grid and kernel for. Any number may come.
    #[must_use]
    pub fn expecting(self, points: usize) -> Self {
        Self { points, ..self }
    }

    /// Keeps to the calling thread. Otherwise all threads of the current rayon pool take part;
    /// the result is the same.
    #[must_use]
    pub fn sequential(self) -> Self {
        Self { parallel: false, ..self }
    }

    /// Keeps to instructions that every CPU has, so that no digit depends on the one at hand.
    #[must_use]
    pub fn portable(self) -> Self {
        Self { portable: true, ..self }
    }

    /// Chooses grid and kernel and computes the tables. Cost: some milliseconds.
    ///
    /// # Errors
    /// If the tolerance is no positive number or K is beyond [`Self::MAX_FREQUENCY`].
    pub fn plan<T: Real>(self) -> Result<Nufft<T>, NufftError> {
        let Self { max_frequency, tolerance, points, parallel, portable } = self;
        if tolerance.is_nan() || tolerance <= 0.0 {
            return Err(NufftError::Tolerance { tolerance });
        }
        if max_frequency > Self::MAX_FREQUENCY {
            return Err(NufftError::Frequency { max_frequency });
        }
        let tolerance = tolerance.clamp(1e-13, 1e-2);
        let design = design(max_frequency, tolerance, points, T::EPSILON);
        let crossover = design.crossover(max_frequency).min(BLOCK);
        let tables = Tables::new(design, max_frequency, portable);
        Ok(Nufft::new(tables, crossover, parallel))
    }
}
