//! Spectra and correlations of point sets on the unit torus, and the transforms they need.
//!
//! Bessel functions of order 0 and 1 over slices; the Hankel transform of order 0, on quadrature
//! nodes and between lattices; exact pair histograms and the radial distribution function.
//!
//! Invariant: never sees a triangulation, never prints, knows no number of the thesis.

mod bessel;
mod hankel;
mod rdf;
mod window;

pub use bessel::{j0, j0_slice, j1, j1_slice, jinc, jinc_slice};
pub use hankel::{BesselSums, BesselSumsScratch, HankelPlan};
pub use rdf::PairHistogram;
pub use window::Window;
