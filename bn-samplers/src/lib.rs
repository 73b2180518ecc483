//! Generators of sampling patterns on the unit torus.
//!
//! Each method is a struct whose public fields are its options; [`Sampler::sample`] makes a
//! pattern of n points from a seed and reports how it went. [`METHODS`] lists them all with their
//! sources and options, and [`find`] looks one up by name, so that a program can offer every
//! method without knowing any.
//!
//! ```
//! use bn_core::{Seed, Unobserved};
//! use bn_samplers::{Sampler, Stochastic};
//!
//! // A method chosen in the code, options typed …
//! let sample = Stochastic::default().sample(256, Seed::new(1), &Unobserved)?;
//! assert_eq!(sample.points.len(), 256);
//!
//! // … and the same one chosen by name, options as text.
//! let sampler = bn_samplers::find("random")?.with_options([])?;
//! assert_eq!(sampler.sample(256, Seed::new(1), &Unobserved)?, sample);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Invariant: never prints, reads no file, keeps no state between two samples; the same options,
//! count and seed give the same bytes on any machine and number of threads.

mod best_candidate;
mod bucket_grid;
mod capacity;
mod common_options;
mod digits;
mod error;
mod farthest_point_optimization;
mod farthest_point_strategy;
mod farthest_points;
mod halton;
mod hexagonal;
mod jittered;
mod lloyd;
mod method;
mod names;
mod net;
mod options;
mod particles;
mod placing;
mod poisson_disk;
mod r2;
mod registry;
mod regular;
mod report;
mod sampler;
mod sobol;
mod spectrum_matching;
mod stochastic;

pub use best_candidate::BestCandidate;
pub use capacity::bnot::Bnot;
pub use capacity::cccvt::Cccvt;
pub use error::SampleError;
pub use farthest_point_optimization::{FarthestPointOptimization, FpoStart, FpoUntil, FpoVariant};
pub use farthest_point_strategy::FarthestPointStrategy;
pub use halton::Halton;
pub use hexagonal::Hexagonal;
pub use jittered::{Displacement, Jittered};
pub use lloyd::Lloyd;
pub use method::{CountRule, Method, PointOrder};
pub use net::{Construction, Net};
pub use options::{DefaultValue, Given, OptionError, OptionKind, OptionSpec, OptionValues};
pub use particles::electrostatic::Electrostatic;
pub use particles::kernel_density::KernelDensity;
pub use poisson_disk::dart_throwing::DartThrowing;
pub use poisson_disk::maximal::{MaximalPoissonDisk, MaximalTarget};
pub use r2::R2;
pub use registry::{METHODS, UnknownMethod, find};
pub use regular::Regular;
pub use report::{Figure, FigureValue, Report};
pub use sampler::{Sample, Sampler};
pub use sobol::{Scramble, Sobol};
pub use spectrum_matching::single_peak::SinglePeak;
pub use spectrum_matching::step::Step;
pub use spectrum_matching::{
    Algorithm, Annealing, Force, Gradient, Residual, Spectral, SpectrumMatching, Weights,
};
pub use stochastic::Stochastic;
