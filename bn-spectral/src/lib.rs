//! bn-spectral.
