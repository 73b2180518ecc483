//! The Hankel transform of order 0, F(u) = 2π ∫ r f(r) J₀(2πru) dr: the Fourier transform of a
//! radial function of the plane. It is its own inverse.

mod chirp;
mod lattice;
mod plan;
mod quadrature;

pub use lattice::{BesselSums, BesselSumsScratch};
pub use plan::HankelPlan;
