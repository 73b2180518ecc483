//! The thesis's test at high sampling rates (§5.4.2): a large image made smaller, and how much noise
//! that leaves.

use std::hash::{DefaultHasher, Hasher as _};

use bn_cli::{Failure, Outcome};
use bn_core::{DVec2, PointSet, Seed, Unobserved};
use bn_render::{
    Frame, Image, ImageSpectrum, Interpolation, Kernel, KernelTable, Normalization, Pattern,
    PatternPower, Picture, Prediction, Renderer, SpectralLine, SphereScene, mean_square_error,
    peak_signal_to_noise,
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

/// Lines of the picture's spectrum that are taken as one, along each axis. Noise hangs smoothly on the
/// frequency of what is sampled, over some 1/8 cycle per pixel: 10/160 change it by less than 2 %.
const TOGETHER: i32 = 10;

/// Modes of patterns that predictions use, over √n: at 128 samples per pixel up to 25 cycles per pixel,
/// where the picture's first copies have ended, at 24, and the kernel passes little.
const MODES: f64 = 2.2;

/// The large image, the kernel and what renderings are held against.
pub(crate) struct Downsampling {
    picture: Picture,
    /// Its power spectrum as the interpolation continues it, in cycles per pixel of the small image: the
    /// mean, and all else.
    mean: ImageSpectrum,
    details: ImageSpectrum,
    frame: Frame,
    kernel: &'static dyn Kernel,
    table: KernelTable,
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

/// PSNR that spectra let one expect.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct Expected {
    /// Of plain convolution.
    pub(crate) plain: f64,
    /// Where the picture's mean comes out exactly.
    pub(crate) about_mean: f64,
}

impl Downsampling {
    /// The sphere scene, as an image continued bilinearly; the thesis's kernel.
    pub(crate) fn new() -> Outcome<Self> {
        let large = Frame::new(LARGE, LARGE).map_err(Failure::failed)?;
        let frame = Frame::new(SMALL, SMALL).map_err(Failure::failed)?;
        let scene = SphereScene::new(&large, CONTRAST);
        let once = bn_render::supersampling("none").expect("in the list");
        let (image, _) = once.render(&scene, &large, &Unobserved).map_err(Failure::failed)?;
        let (mean, details) = interpolated_spectrum(&image, &frame);
        let picture = Picture::covering(image, Interpolation::Bilinear, &frame);
        let kernel = bn_render::kernel("lanczos2").expect("in the list");
        let table = KernelTable::new(kernel);
        let lattice = Hexagonal.sample(4096, Seed::new(1), &Unobserved).map_err(Failure::failed)?;
        let hexagonal = |rate: f64| -> Outcome<Image> {
            let pattern = Pattern::tiled(&lattice.points, rate).map_err(Failure::failed)?;
            let renderer =
                Renderer::new(&picture, &pattern, &table, Normalization::Density, &frame);
            Ok(renderer.image().map_err(Failure::failed)?.0)
        };
        let (reference, dense) = (hexagonal(REFERENCE)?, hexagonal(DENSE)?);
        Ok(Self { picture, mean, details, frame, kernel, table, reference, dense })
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
            Renderer::new(&self.picture, &pattern, &self.table, normalization, &self.frame);
        let image = renderer.image().map_err(Failure::failed)?.0;
        Ok(Psnr { value: psnr(&image, &self.reference)?, dense: psnr(&image, &self.dense)? })
    }

    /// The PSNR that these sets' mean spectrum and the picture's spectrum let one expect: of plain
    /// convolution, and without the picture's mean, which normalisation by density reproduces.
    pub(crate) fn predicted(&self, sets: &[PointSet], samples_per_pixel: f64) -> Outcome<Expected> {
        let modes = (MODES * (sets[0].len() as f64).sqrt()).ceil() as usize;
        let power = PatternPower::of(sets, modes).map_err(Failure::failed)?;
        let prediction = Prediction::new(&power, samples_per_pixel).map_err(Failure::failed)?;
        let [mean, details] =
            [&self.mean, &self.details].map(|part| prediction.noise(part, self.kernel));
        Ok(Expected {
            plain: peak_signal_to_noise(mean + details),
            about_mean: peak_signal_to_noise(details),
        })
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

/// The power of an image that covers `frame`, continued bilinearly: that of its pixels, and the copies
/// around their rate, which the interpolation weakens. The mean's, and that of all else, lines that lie
/// close together taken as one. Faded at the borders: edges there would put power on the axes, where the
/// hexagonal lattice has its own, and double its noise.
fn interpolated_spectrum(image: &Image, frame: &Frame) -> (ImageSpectrum, ImageSpectrum) {
    let rate = f64::from(image.width()) / f64::from(frame.width());
    let passed = |nu: f64| {
        let x = std::f64::consts::PI * nu / rate;
        if x == 0.0 { 1.0 } else { (libm::sin(x) / x).powi(4) }
    };
    // From the middle of a grid of groups, which reaches to 1½ rates.
    let width = f64::from(TOGETHER) / f64::from(frame.width());
    let reach = 3 * image.width() as i32 / 2 / TOGETHER + 1;
    let side = (2 * reach + 1) as usize;
    let group = |nu: f64| ((nu / width).round() as i32 + reach) as usize;
    let mut powers = vec![0.0; side * side];
    let (mut mean, pixels) = (0.0, ImageSpectrum::of_faded_image(image, frame));
    for line in pixels.lines() {
        for copy in 0..9 {
            let shift = DVec2::new(f64::from(copy % 3 - 1), f64::from(copy / 3 - 1)) * rate;
            let at = line.frequency + shift;
            let power = line.power * passed(at.x) * passed(at.y);
            if at == DVec2::ZERO {
                mean += power;
            } else {
                powers[group(at.y) * side + group(at.x)] += power;
            }
        }
    }
    let center = |i: usize| f64::from(i as i32 - reach) * width;
    let line = |(i, &power): (usize, &f64)| SpectralLine {
        frequency: DVec2::new(center(i % side), center(i / side)),
        power,
    };
    let strong = |line: &SpectralLine| line.power > 0.0;
    let details = powers.iter().enumerate().map(line).filter(strong).collect();
    let mean = vec![SpectralLine { frequency: DVec2::ZERO, power: mean }];
    (ImageSpectrum::from_lines(mean), ImageSpectrum::from_lines(details))
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_render::{Channels, Scene as _};

    /// The powers sum to the mean square of the picture between its pixels too, for waves within half
    /// the rate of its pixels, of which further copies are as good as none.
    #[test]
    fn the_spectrum_is_that_of_the_interpolated_picture() {
        let (frame, large) = (Frame::new(12, 12).expect("a size"), 96_u32);
        let value = |i: u32| {
            let (x, y) = (f64::from(i % large) / 96.0, f64::from(i / large) / 96.0);
            let wave = |x: f64| libm::cos(std::f64::consts::TAU * x);
            (0.4 + 0.3 * wave(9.0 * x - 4.0 * y) + 0.2 * wave(23.0 * y)) as f32
        };
        let values = (0..large * large).map(value).collect();
        let image = Image::new(large, large, Channels::Grey, values).expect("fits");
        let (mean, details) = interpolated_spectrum(&image, &frame);
        assert!((mean.total_power() - 0.16).abs() < 1e-7, "{}", mean.total_power());
        let picture = Picture::covering(image, Interpolation::Bilinear, &frame);
        // Within the border, which is not repeated; a whole number of periods of both waves.
        let steps = 960;
        let at = |i: u32| 12.0 * (f64::from(i) + 0.5) / f64::from(steps);
        let square = |i: u32| picture.value(DVec2::new(at(i % steps), at(i / steps)))[0].powi(2);
        let want = (0..steps * steps).map(square).sum::<f64>() / f64::from(steps).powi(2);
        let got = mean.total_power() + details.total_power();
        // The border's half pixels are constant across instead: 2 % of the area.
        assert!((got - want).abs() < 1e-3, "{got} {want}");
        // The interpolation took something: pixels alone have 0.16 + 0.045 + 0.02.
        assert!(got < 0.22, "{got}");
        // Both waves are where they should be, up to half a group along each axis.
        let near = |x: f64, y: f64| {
            let group = 0.5 * f64::from(TOGETHER) / 12.0 + 1e-9;
            let there = |line: &&SpectralLine| {
                (line.frequency - DVec2::new(x, y) / 12.0).abs().max_element() <= group
            };
            details.lines().iter().filter(there).map(|line| line.power).sum::<f64>()
        };
        let kept = |cycles: f64| {
            let x = std::f64::consts::PI * cycles / 96.0;
            if x == 0.0 { 1.0 } else { (libm::sin(x) / x).powi(4) }
        };
        // But for what fading at the borders spreads over some 16 lines along the axes, 4.7 % on each.
        for (x, y, power) in [(9.0, -4.0, 0.0225), (0.0, 23.0, 0.01), (0.0, -23.0, 0.01)] {
            let (got, want) = (near(x, y), power * kept(x) * kept(y));
            assert!((got / want - 1.0).abs() < 0.04, "({x}, {y}): {got} {want}");
            assert!(near(y, x) < 0.05 * want, "({y}, {x}): {}", near(y, x));
        }
    }
}
