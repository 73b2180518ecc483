//! Geometry of point sets on the unit torus.
//!
//! [`Spacing`] measures distances between neighbours (`d_min`, `d_avg`). A [`Triangulation`] is the
//! Delaunay triangulation on the torus, which points can join and leave; from it come the
//! [`Coverage`] radius with the place farthest from all points, [`voronoi_cells`] with their areas,
//! centroids and moments, and the [`bond_orientational_order`] Qⁿ; [`EmptyCircles`] keeps its faces
//! in order while it changes. A [`PowerDiagram`] gives the points weights. All of it is defined for every set
//! of at least one point: coincident and collinear points, lattices and points on the seam included.
//!
//! ```
//! use bn_core::{DVec2, PointSet};
//! use bn_geometry::{Coverage, Spacing, Triangulation, bond_orientational_order, voronoi_cells};
//!
//! // Rows of a nearly hexagonal lattice.
//! let place = |i: usize| DVec2::new(((i % 7) as f64 + (i / 7 % 2) as f64 / 2.0) / 7.0, (i / 7) as f64 / 8.0);
//! let set = PointSet::new((0..56).map(place).collect())?;
//! let density = set.density();
//! let spacing = Spacing::new(&set);
//! let triangulation = Triangulation::new(&set);
//! let coverage = Coverage::of(&triangulation).expect("a set is not empty");
//! println!("d_min {:.3}", density.normalize_distance(spacing.min()));
//! println!("d_avg {:.3}", density.normalize_distance(spacing.mean()));
//! println!("R_c   {:.3}", density.normalize_distance(coverage.radius));
//! assert!(bond_orientational_order(&triangulation, 6) > Some(0.99));
//! assert!(voronoi_cells(&triangulation).iter().all(|cell| (cell.area * 56.0 - 1.0).abs() < 1e-13));
//! # Ok::<(), bn_core::PointSetError>(())
//! ```
//!
//! Invariant: no frequency, no random number and no normalised unit occurs here; distances are in
//! unit lengths.

mod circle;
mod coverage;
mod empty_circles;
mod hilbert;
mod max_tree;
mod order;
mod power;
mod predicates;
mod spacing;
mod triangulation;
mod voronoi;

pub use circle::Circle;
pub use coverage::Coverage;
pub use empty_circles::EmptyCircles;
pub use hilbert::hilbert_order;
pub use order::{bond_orientational_order, local_bond_orientational_order};
pub use power::{Balance, BalancedDiagram, PowerDiagram, PowerEdge, PowerNeighbor};
pub use spacing::Spacing;
pub use triangulation::{Face, FaceId, Faces, Location, Neighbors, Star, Triangulation, Vacancy};
pub use voronoi::{VoronoiCell, voronoi_cells, voronoi_cells_into};
