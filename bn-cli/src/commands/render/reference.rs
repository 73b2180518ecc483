//! What an image is held against.

use std::path::PathBuf;

use anyhow::anyhow;
use bn_core::{Seed, Unobserved};
use bn_render::{Image, Kernel, Normalization, Pattern, exact_convolution};
use bn_samplers::Sampler;
use serde_json::{Value, json};

use super::super::Global;
use super::collect;
use super::sampling::Tiled;
use super::scene::Subject;
use crate::{Failure, Outcome, image_file};

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

impl Reference {
    /// The image and its account.
    pub(super) fn image(
        &self,
        subject: &Subject,
        kernel: &'static dyn Kernel,
        normalization: Normalization,
        global: &Global,
    ) -> Outcome<(Image, Value)> {
        match self {
            Self::File(path) => {
                let image = image_file::read(path, None)?;
                let (window, channels) = (subject.frame.window(), subject.scene.channels());
                let (got, want) = (
                    (image.width(), image.height(), image.channels().count()),
                    (window.width, window.height, channels.count()),
                );
                if got != want {
                    return Err(Failure::misuse(format!(
                        "{} has {}×{} pixels of {} channels; the rendering has {}×{} of {}",
                        path.display(),
                        got.0,
                        got.1,
                        got.2,
                        want.0,
                        want.1,
                        want.2
                    )));
                }
                Ok((image, json!({"file": path.display().to_string()})))
            }
            Self::Exact => {
                let made = exact_convolution(&*subject.scene, kernel, &subject.frame, TOLERANCE)
                    .map_err(Failure::usage)?;
                if !made.converged {
                    global.remark(format!(
                        "the reference may be off by about {:.1e} (root mean square), what {} samples \
                         per pixel changed against a quarter of them",
                        made.change, made.samples_per_pixel
                    ));
                }
                let account = json!({
                    "exact": made.converged,
                    "change": made.change,
                    "samples_per_pixel": made.samples_per_pixel,
                });
                Ok((made.image, account))
            }
            &Self::Hexagonal(spp) => {
                let lattice = bn_samplers::Hexagonal.sample(LATTICE, Seed::new(1), &Unobserved);
                let lattice = lattice.map_err(|error| Failure::failed(anyhow!(error)))?.points;
                let pattern = Pattern::tiled(&lattice, spp).map_err(Failure::usage)?;
                let tiled = Tiled::new(pattern, kernel, normalization);
                let (image, _) = collect(subject, |rows| {
                    tiled.render(&*subject.scene, &subject.frame, &Unobserved, rows)
                })?;
                Ok((image, json!({"method": "hexagonal", "n": LATTICE, "spp": spp})))
            }
        }
    }
}
