//! Spectra and correlations of point sets on the unit torus, and the transforms they need.
//!
//! [`WindowedSpectrum`] gives the statistics that the thesis prints, ν_eff and Ω, from the pair
//! distances of point sets ([`PairHistogram`] → RDF → [`RdfToPower`], back by [`PowerToRdf`]).
//! [`RadialPower`] gives the same from the exact power of every mode, ring by ring ([`RingMeans`]),
//! and with it the anisotropy; [`PowerImage`] and [`Autocorrelation`] are the two-dimensional
//! views. Beneath them lie the non-uniform Fourier transform ([`Nufft`]), the Hankel transform of
//! order 0, on quadrature nodes ([`HankelPlan`]) and between lattices ([`BesselSums`]), and Bessel
//! functions over slices ([`j0_slice`]). Closed forms for tests and predictions:
//! [`JitteredGrid`], [`square_lattice_rings`], [`hexagonal_lattice_rings`], [`step_rdf`]. Spectra to
//! aim at are [`Target`]s, and [`Realizability`] says whether point sets can have them.
//!
//! Frequencies are in cycles per unit unless a type says otherwise, P → 1 at high frequencies and
//! g → 1 at large distances.
//!
//! ```
//! use bn_core::{DVec2, PointSet};
//! use bn_spectral::WindowedSpectrum;
//!
//! let grid = (0..1024_u32).map(|i| DVec2::new(f64::from(i % 32), f64::from(i / 32)) / 32.0);
//! let set = PointSet::new(grid.collect())?;
//! let spectrum = WindowedSpectrum::of(&[set])?;
//! // All power of the square grid lies at its Nyquist frequency and above; the estimator's window
//! // blurs that edge.
//! let nu_eff = spectrum.effective_nyquist().expect("reaches the thresholds").value();
//! assert!((0.85..=1.0).contains(&nu_eff));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Invariant: never sees a triangulation, never prints, knows no value of the thesis's tables.

mod autocorrelation;
mod bessel;
mod cell_pairs;
mod hankel;
mod measures;
mod nufft;
mod panels;
mod periodogram;
mod power_image;
mod radial;
mod rdf;
mod realizability;
mod spectra;
mod target;
mod window;

pub use autocorrelation::Autocorrelation;
pub use bessel::{j0, j0_slice, j1, j1_slice, jinc, jinc_slice};
pub use bn_fft::Complex;
pub use hankel::{BesselSums, BesselSumsScratch, HankelPlan};
pub use measures::{
    OSCILLATION_RANGE, PowerToRdf, QUIET_POWER, RdfToPower, RingMeans, SpectrumError,
    WindowedSpectrum, effective_nyquist, oscillation,
};
pub use nufft::{
    FullPlane, HalfPlane, ModeColumns, Nufft, NufftError, NufftOptions, Real, direct_complex_modes,
    direct_complex_sums, direct_modes, direct_sums,
};
pub use periodogram::{Periodogram, PeriodogramOptions};
pub use power_image::PowerImage;
pub use radial::{RadialPower, power_below};
pub use rdf::PairHistogram;
pub use realizability::{Realizability, Warning, feasible_region};
pub use spectra::{
    JitteredGrid, LatticeRing, hexagonal_lattice_rings, highest_step, square_lattice_rings,
    step_rdf,
};
pub use target::{SinglePeak, Target, TargetError};
pub use window::Window;
