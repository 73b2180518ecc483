//! bn-geometry.
