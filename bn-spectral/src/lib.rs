//! Spectra and correlations of point sets on the unit torus, and the transforms they need.
//!
//! Bessel functions of order 0 and 1 over slices.
//!
//! Invariant: never sees a triangulation, never prints, knows no number of the thesis.

mod bessel;

pub use bessel::{j0, j0_slice, j1, j1_slice, jinc, jinc_slice};
