//! What an image is held against.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use bn_core::{Observer, Seed, Unobserved};
use bn_render::{Image, Kernel, Normalization, Pattern, exact_convolution};
use bn_samplers::Sampler;
use serde_json::{Value, json};

use super::super::Global;
use super::sampling::{Tiled, from_render_error};
use super::scene::Subject;
use super::{collect, normalization_name};
use crate::image_file::{self, ImageFormat};
use crate::{Failure, Outcome};

/// Where the reference comes from.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Reference {
    /// The convolution with the kernel, by quadrature.
    Exact,
    /// The same scene and kernel from a hexagonal lattice of so many samples per pixel.
    Hexagonal(f64),
    /// An image file.
    File(PathBuf),
}

impl From<&str> for Reference {
    fn from(text: &str) -> Self {
        match text.parse() {
            Ok(spp) => Self::Hexagonal(spp),
            Err(_) if text == "exact" => Self::Exact,
            Err(_) => Self::File(text.into()),
        }
    }
}

/// The change that the quadrature stops at: 120 dB.
const TOLERANCE: f64 = 1e-6;

/// Points of the hexagonal lattice.
const LATTICE: usize = 4096;

/// A reference that can be made, as far as that can be told before any work.
pub(super) enum Prepared {
    Exact,
    Hexagonal(Pattern),
    File(Image, Value),
}

impl Reference {
    /// The file that is read.
    pub(super) fn file(&self) -> Option<&Path> {
        match self {
            Self::File(path) => Some(path),
            Self::Exact | Self::Hexagonal(_) => None,
        }
    }

    /// Whether it is made through the kernel.
    pub(super) fn takes_kernel(&self) -> bool {
        !matches!(self, Self::File(_))
    }

    /// Reads what is to be read, and refuses what can't be a reference of the subject.
    pub(super) fn prepared(&self, subject: &Subject) -> Outcome<Prepared> {
        let (window, channels) = (subject.frame.window(), subject.scene.channels());
        Image::check_size(window.width, window.height, channels).map_err(Failure::usage)?;
        match self {
            Self::File(path) => {
                ImageFormat::from_path(path).map_err(|_| {
                    Failure::misuse(format!(
                        "--reference {}: a reference is `exact`, a number of samples per pixel or an image \
                         file (.png, .pfm, .exr)",
                        path.display()
                    ))
                })?;
                let image = image_file::read(path, None)
                    .map_err(|failure| failure.context("--reference"))?;
                let (got, want) = (
                    (image.width(), image.height(), image.channels().count()),
                    (window.width, window.height, channels.count()),
                );
                if got != want {
                    return Err(Failure::misuse(format!(
                        "--reference {}: its {}×{} pixels have {} channel(s); the rendering (what --crop leaves of \
                         it) has {}×{} of {}",
                        path.display(),
                        got.0,
                        got.1,
                        got.2,
                        want.0,
                        want.1,
                        want.2
                    )));
                }
                Ok(Prepared::File(image, json!({"file": path.display().to_string()})))
            }
            Self::Exact => Ok(Prepared::Exact),
            &Self::Hexagonal(spp) => {
                let lattice = bn_samplers::Hexagonal.sample(LATTICE, Seed::new(1), &Unobserved);
                let lattice = lattice.map_err(|error| Failure::failed(anyhow!(error)))?.points;
                let pattern = Pattern::tiled(&lattice, spp)
                    .map_err(|error| Failure::misuse(format!("--reference: {error}")))?;
                Ok(Prepared::Hexagonal(pattern))
            }
        }
    }
}

impl Prepared {
    /// The image, by this kernel and normalisation, and its account.
    pub(super) fn image(
        self,
        subject: &Subject,
        (kernel, normalization): (&'static dyn Kernel, Normalization),
        global: &Global,
        observer: &dyn Observer,
    ) -> Outcome<(Image, Value)> {
        match self {
            Self::File(image, account) => Ok((image, account)),
            Self::Exact => {
                let (scene, frame) = (&*subject.scene, &subject.frame);
                let made = exact_convolution(scene, kernel, frame, TOLERANCE, observer)
                    .map_err(from_render_error)?;
                if !made.converged {
                    global.remark(format!(
                        "the reference may be off by about {:.1e} (root mean square), what {} samples \
                         per pixel changed against a quarter of them",
                        made.change, made.samples_per_pixel
                    ));
                }
                let account = json!({
                    "exact": made.converged,
                    "kernel": kernel.name(),
                    "change": made.change,
                    "spp": made.samples_per_pixel,
                });
                Ok((made.image, account))
            }
            Self::Hexagonal(pattern) => {
                let account = json!({
                    "method": "hexagonal",
                    "n": LATTICE,
                    "spp": pattern.samples_per_pixel(),
                    "kernel": kernel.name(),
                    "normalize": normalization_name(normalization),
                });
                let tiled = Tiled::new(pattern, kernel, normalization);
                let (image, _) = collect(subject, |rows| {
                    tiled.render(&*subject.scene, &subject.frame, observer, rows)
                })?;
                Ok((image, account))
            }
        }
    }
}
