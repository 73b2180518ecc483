//! The public spectra, against closed forms, reference data, other programs and themselves.

mod autocorrelation_pairs;
mod bessel_reference;
mod hankel_lattice;
mod hankel_pairs;
mod measures_conversion;
mod measures_psa;
mod nufft_accuracy;
mod nufft_cases;
mod periodogram_modes;
mod radial_rings;
mod rdf_histogram;
mod realizability_planted;
mod spectra_jitter;
mod target_shapes;
