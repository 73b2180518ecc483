//! The thesis's test at high sampling rates (§5.4.2): a large image made smaller, and how much noise
//! that leaves.

use std::hash::{DefaultHasher, Hasher as _};

use bn_cli::{Failure, Outcome};
use bn_core::{DVec2, PointSet, Seed, Unobserved};
use bn_render::{
    Frame, Image, Interpolation, KernelTable, Normalization, Pattern, Picture, Renderer,
    SphereScene, mean_square_error, peak_signal_to_noise,
};
use bn_samplers::{Hexagonal, Sampler as _};
use rand::RngExt;
use serde::{Deserialize, Serialize};

use super::store::hash_points;

/// Side of the large image, rasterised once at its pixels' centres.
const LARGE: u32 = 2560;

/// Side of the small one.
const SMALL: u32 = 160;

/// The scene's contrast: fixed once so that stochastic sampling at 16 samples per pixel gives the
/// thesis's 32.2 dB.
const CONTRAST: f64 = 0.814;

/// The reference's samples per pixel, by a hexagonal lattice.
const REFERENCE: f64 = 512.0;

/// Samples per pixel of what the reference itself is held against, by the same lattice.
const DENSE: f64 = 4096.0;

/// The seed of the shifts that tell the images of one set apart.
const SHIFTS: u64 = 1;

/// The large image, the kernel and what renderings are held against.
pub(crate) struct Downsampling {
    picture: Picture,
    frame: Frame,
    kernel: KernelTable,
    /// The thesis's reference.
    reference: Image,
    /// A rendering from eight times as many samples.
    dense: Image,
}

/// PSNR of one rendering.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct Psnr {
    /// Against the thesis's reference.
    pub(crate) value: f64,
    /// Against a rendering from eight times as many samples.
    pub(crate) dense: f64,
}

impl Downsampling {
    /// The sphere scene, as an image continued bilinearly; the thesis's kernel.
    pub(crate) fn new() -> Outcome<Self> {
        let large = Frame::new(LARGE, LARGE).map_err(Failure::failed)?;
        let frame = Frame::new(SMALL, SMALL).map_err(Failure::failed)?;
        let scene = SphereScene::new(&large, CONTRAST);
        let once = bn_render::supersampling("none").expect("in the list");
        let (image, _) = once.render(&scene, &large, &Unobserved).map_err(Failure::failed)?;
        let picture = Picture::covering(image, Interpolation::Bilinear, &frame);
        let kernel = KernelTable::new(bn_render::kernel("lanczos2").expect("in the list"));
        let lattice = Hexagonal.sample(4096, Seed::new(1), &Unobserved).map_err(Failure::failed)?;
        let hexagonal = |rate: f64| -> Outcome<Image> {
            let pattern = Pattern::tiled(&lattice.points, rate).map_err(Failure::failed)?;
            let renderer =
                Renderer::new(&picture, &pattern, &kernel, Normalization::Density, &frame);
            Ok(renderer.image().map_err(Failure::failed)?.0)
        };
        let (reference, dense) = (hexagonal(REFERENCE)?, hexagonal(DENSE)?);
        Ok(Self { picture, frame, kernel, reference, dense })
    }

    /// PSNR of the image of number `index` from these points. Images of different numbers have the
    /// points shifted differently on the torus.
    pub(crate) fn psnr(
        &self,
        set: &PointSet,
        index: u32,
        samples_per_pixel: f64,
        normalization: Normalization,
    ) -> Outcome<Psnr> {
        let mut rng = Seed::new(SHIFTS).stream(index);
        let shift = DVec2::new(rng.random(), rng.random());
        let shifted = PointSet::wrapped(set.points().iter().map(|p| *p + shift).collect());
        let pattern = Pattern::tiled(&shifted.map_err(Failure::failed)?, samples_per_pixel)
            .map_err(Failure::failed)?;
        let renderer =
            Renderer::new(&self.picture, &pattern, &self.kernel, normalization, &self.frame);
        let image = renderer.image().map_err(Failure::failed)?.0;
        Ok(Psnr { value: psnr(&image, &self.reference)?, dense: psnr(&image, &self.dense)? })
    }

    /// A digest of these sets, of what their renderings are held against and of `how` that is done:
    /// where it is the same, so are the values of [`Downsampling::psnr`].
    pub(crate) fn digest(&self, sets: &[PointSet], how: u64) -> u64 {
        let mut hasher = DefaultHasher::new();
        hasher.write_u64(how);
        for image in [&self.reference, &self.dense] {
            image.values().iter().for_each(|value| hasher.write_u32(value.to_bits()));
        }
        for set in sets {
            hash_points(set, &mut hasher);
        }
        hasher.finish()
    }

    /// PSNR of the reference itself against the denser one: more than this no pattern can have,
    /// however many samples it takes.
    pub(crate) fn reference_psnr(&self) -> Outcome<f64> {
        psnr(&self.reference, &self.dense)
    }
}

fn psnr(image: &Image, reference: &Image) -> Outcome<f64> {
    Ok(peak_signal_to_noise(mean_square_error(image, reference).map_err(Failure::failed)?))
}
