//! What a pattern's power spectrum says about the error of an image before it is rendered (thesis
//! section 3.2).

mod error;
mod image_spectrum;
mod pattern_power;
mod white_noise;

pub use error::Prediction;
pub use image_spectrum::{ImageSpectrum, SpectralLine};
pub use pattern_power::PatternPower;
