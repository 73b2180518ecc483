//! Band-limited reconstruction: the trigonometric polynomial that fits irregular samples best.
//!
//! The samples lie on a periodic rectangle, which is mapped to the unit torus. Sought is the real
//! polynomial p(x) = Σ a(k) exp(2πi k·x), |kx| ≤ Kx, |ky| ≤ Ky, with the least
//! Σ wⱼ (p(xⱼ) − fⱼ)², the weights being the areas of the samples' Voronoi cells. Its normal equations
//! T a = b have the block Toeplitz matrix T(k, l) = τ(k − l), τ(k) = Σ wⱼ exp(−2πi k·xⱼ), and
//! b(k) = Σ wⱼ fⱼ exp(−2πi k·xⱼ), both one NUFFT. Areas as weights make T nearly the identity where
//! the samples are dense (H. G. Feichtinger, K. Gröchenig, T. Strohmer, *Efficient numerical methods
//! in non-uniform sampling theory*, Numerische Mathematik 69, 1995).

mod conjugate_gradients;
mod convergence;
mod domain;
mod error;
mod evaluate;
mod fit;
mod grid;
mod modes;
mod polynomial;
mod projections;
mod renderer;
mod response;
mod scattered;
mod toeplitz;

pub use convergence::{Convergence, Stop, Stopping};
pub use domain::Border;
pub use error::BandLimitedError;
pub use fit::BandLimitedFit;
pub use modes::Degree;
pub use polynomial::TrigonometricPolynomial;
pub use renderer::{BandLimitedMethod, BandLimitedOptions, BandLimitedRenderer, BandLimitedStats};
pub use response::LowPass;
