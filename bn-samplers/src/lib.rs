//! bn-samplers.
