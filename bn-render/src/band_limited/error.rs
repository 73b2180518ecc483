//! Why there is no reconstruction.

use bn_spectral::NufftError;
use thiserror::Error;

use crate::ImageError;

/// Why samples can't be reconstructed as a band-limited function.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BandLimitedError {
    /// There is no sample to start from, or none that weighs anything.
    #[error("no sample lies in the image")]
    NoSamples,
    /// A sample's value is NaN, infinite, or so large that differences are.
    #[error("the value of sample {index} is not a finite number of ordinary size")]
    Value {
        /// The sample's index.
        index: usize,
    },
    /// A weight is negative or not finite.
    #[error("weight {weight} of sample {index} is no weight; they are finite and not negative")]
    Weight {
        /// The sample's index.
        index: usize,
        /// Its weight.
        weight: f64,
    },
    /// A band that is not a positive number.
    #[error("a band of {band} cycles per pixel is not possible")]
    Band {
        /// The band asked for.
        band: f64,
    },
    /// More samples, or a finer grid, than is held in memory.
    #[error(
        "{what}: {count:.3e}, and at most {limit:.3e} fit; take a smaller image, fewer samples or a \
         narrower band"
    )]
    TooLarge {
        /// What there would be too many of.
        what: &'static str,
        /// How many.
        count: f64,
        /// How many there may be.
        limit: f64,
    },
    /// The Fourier transform can't be planned.
    #[error(transparent)]
    Transform(#[from] NufftError),
    /// The observer asked to stop.
    #[error("reconstruction was cancelled")]
    Cancelled,
    /// The pixels don't make an image.
    #[error(transparent)]
    Image(#[from] ImageError),
}
