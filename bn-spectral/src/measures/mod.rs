//! Effective Nyquist frequency ν_eff and oscillation Ω of a radial power spectrum (thesis §3.2),
//! from its samples or from the modes themselves.
//!
//! Both definitions share the thresholds below; they differ in where the spectrum comes from, and
//! with it in bias and variance:
//!
//! - *windowed* ([`WindowedSpectrum`]): P by a windowed transform of the RDF. This gives the
//!   numbers that the thesis prints. The window's main lobe blurs P over ±6 cycles at n = 4096 (3/(2
//!   half-widths) in general): steep edges lose 0.01 to 0.05 of ν_eff, peaks 10 to 15 % of Ω. In
//!   exchange noise is averaged: Ω of random points is 0.2 for one set of 4096, 0.06 for ten.
//! - *direct* ([`RingMeans`]): P from the exact power of every mode. Unbiased, up to the width of the
//!   rings. Each mode's power fluctuates by 100 %, so that for disordered sets E Ω² of B rings that
//!   hold C modes in all is 200·B/(R·C) above its limit, R the number of sets: Ω is 0.63 for one
//!   random set of 1024 points on rings of width 1.

mod conversion;
mod direct;
mod sampled;
mod windowed;

pub use conversion::{PowerToRdf, RdfToPower};
pub use direct::RingMeans;
pub use sampled::{effective_nyquist, oscillation};
pub use windowed::{SpectrumError, WindowedSpectrum};

/// Mean power up to ν below which ν counts as free of noise, in the definition of ν_eff.
pub const QUIET_POWER: f64 = 0.1;

/// The search for ν_eff starts above √n/2 where the mean power has passed this.
const LOUD_POWER: f64 = 0.5;

/// Ω looks at the spectrum from where it first reaches this.
const ONSET_POWER: f64 = 0.98;

/// Width of the ring that Ω looks at, in √n/2.
pub const OSCILLATION_RANGE: f64 = 10.0;

/// Ω is this many times the root mean square of P − 1.
const OSCILLATION_SCALE: f64 = 10.0;
