//! What a sampling pattern does to an image: scenes, reconstruction and the error that is left.
//!
//! A [`Scene`] is a function over the image plane, a [`Pattern`] tiles a point set over it, a
//! [`KernelTable`] says how much each sample gives to the pixels around it, and a [`Renderer`]
//! makes the pixels, by normalised or plain convolution ([`Normalization`]). Scenes come by name
//! ([`scene`], [`SCENES`]) or from an image ([`Picture`]), kernels by name ([`kernel`],
//! [`KERNELS`]). A [`BandLimitedRenderer`] makes them by iteration instead: it fits a trigonometric
//! polynomial to the samples ([`BandLimitedFit`]). [`Image`] holds linear light, reads and writes PNG, PFM and (feature `exr`)
//! `OpenEXR`; [`mean_square_error`] and [`peak_signal_to_noise`] compare. [`Supersampling`] holds the
//! fixed patterns of real-time graphics and their transfer functions; [`exact_convolution`] is what
//! samples without end would give. A [`Prediction`] tells the error of an image from the spectra of
//! the pattern ([`PatternPower`]) and of the image ([`ImageSpectrum`]); an [`AdaptiveRenderer`] takes
//! as many samples as a wanted error needs.
//!
//! The image plane: u to the right and v down in pixels, pixel (i, j) has its centre at
//! (i + ½, j + ½). Frequencies are in cycles per pixel.
//!
//! ```
//! use bn_core::{DVec2, PointSet};
//! use bn_render::{Frame, KernelTable, Normalization, Pattern, Renderer, ZonePlate};
//!
//! let grid = (0..1024_u32).map(|i| DVec2::new(f64::from(i % 32), f64::from(i / 32)) / 32.0);
//! let pattern = Pattern::tiled(&PointSet::new(grid.collect())?, 4.0)?;
//! let frame = Frame::new(64, 64)?;
//! let scene = ZonePlate::new(&frame, 0.25);
//! let kernel = KernelTable::new(bn_render::kernel("lanczos2").expect("is in the list"));
//! let renderer = Renderer::new(&scene, &pattern, &kernel, Normalization::Density, &frame);
//! let (image, stats) = renderer.image()?;
//! assert_eq!(stats.evaluated, stats.samples);
//! // In the middle the plate is nearly flat and bright.
//! assert!((image.pixel(32, 32)[0] - 1.0).abs() < 0.05);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Invariant: makes no pattern, prints nothing, knows no value of the thesis's tables.

mod band_limited;
mod gauss_legendre;
mod image;
mod kernel;
mod metrics;
mod pattern;
mod plane;
mod prediction;
mod quadrature;
mod resample;
mod scene;
mod simd;
mod supersampling;
mod watch;

pub use band_limited::{
    BandLimitedError, BandLimitedFit, BandLimitedMethod, BandLimitedOptions, BandLimitedRenderer,
    BandLimitedStats, Border, Convergence, Degree, LowPass, Stop, Stopping,
    TrigonometricPolynomial,
};
pub use image::{
    BitDepth, Channels, Encoding, Image, ImageError, PfmWriter, PngEncoding, PngOptions, PngWriter,
    linear_from_srgb, read_pfm, read_png, srgb_from_linear, write_pfm, write_png,
};
#[cfg(feature = "exr")]
pub use image::{ExrRows, read_exr, stream_exr, write_exr};
pub use kernel::{KERNELS, Kernel, KernelTable, KernelTransfer, MAX_RADIUS, kernel};
pub use metrics::{difference, error_picture, mean_square_error, peak_signal_to_noise};
pub use pattern::{Pattern, PatternError, SampleList, TileVariation};
pub use plane::{Frame, FrameError, Rect, Window};
pub use prediction::{ImageSpectrum, PatternPower, Prediction, SpectralLine};
pub use quadrature::{Convolution, exact_convolution};
pub use resample::{
    AdaptiveBand, AdaptiveRenderer, AdaptiveStats, Band, Normalization, ProgressivePattern,
    RenderError, RenderStats, Renderer, grid_error,
};
pub use scene::{
    Checkerboard, Color, Constant, Interpolation, LimitedZonePlate, Picture, PlaneWave, PlaneWaves,
    SCENES, Scene, SceneEntry, SceneError, SceneOptions, SphereScene, StripedCloth, ZonePlate,
    scene,
};
pub use supersampling::{SUPERSAMPLING, Supersampling, SupersamplingError, Tap, supersampling};
