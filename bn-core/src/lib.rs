//! Point sets on the unit torus: the types that every other crate of the workbench speaks.
//!
//! The domain is the unit square [0, 1)² with opposite sides identified. A [`PointSet`] can only
//! hold points of that domain, an [`Ensemble`] several sets; [`torus`] measures distances on it,
//! [`Density`] knows the length and frequency that results are normalised by, [`DensityFunction`]
//! says where points are wanted how densely ([`DensityIntegrals`] how many an area holds),
//! [`CellGrid`] answers neighbour queries, [`Curve`] holds a sampled function, [`Seed`] gives
//! independent random streams that are the same on every machine, and [`io`] reads and writes point
//! files.
//!
//! ```
//! use bn_core::{DVec2, PointSet, torus};
//!
//! let set = PointSet::new(vec![DVec2::new(0.05, 0.5), DVec2::new(0.95, 0.5)])?;
//! let d = torus::distance(set.points()[0], set.points()[1]);
//! assert!((d - 0.1).abs() < 1e-15); // across the seam
//! println!("{:.3} of the largest possible distance", set.density().normalize_distance(d));
//! # Ok::<(), bn_core::PointSetError>(())
//! ```
//!
//! Invariant: knows of no other crate of the workspace, does not print, starts no thread.

mod cell_grid;
mod curve;
mod density;
mod density_function;
mod density_integrals;
pub mod io;
mod point_set;
mod progress;
mod seed;
pub mod torus;

pub use cell_grid::{CellGrid, CellPoints};
pub use curve::Curve;
pub use density::{Density, NormalizedDistance, NormalizedFrequency};
pub use density_function::{DensityFunction, DensityFunctionError};
pub use density_integrals::{DensityIntegrals, Moments};
pub use glam::DVec2;
pub use point_set::{Ensemble, EnsembleError, PointSet, PointSetError};
pub use progress::{Observer, Progress, Unobserved};
pub use seed::{Seed, StreamRng};
