//! Geometry of point sets on the unit torus.

mod circle;
mod hilbert;
mod predicates;
mod triangulation;

pub use circle::Circle;
pub use triangulation::{Face, FaceId, Faces, Location, Neighbors, Star, Triangulation};
