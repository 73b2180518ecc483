//! Adaptive sampling: where the samples go and what they are worth.

use bn_cli::{Failure, Outcome};
use bn_core::{PointSet, Seed, Unobserved};
use bn_render::{
    AdaptiveRenderer, Channels, Checkerboard, Frame, Image, KernelTable, Normalization,
    ProgressivePattern, Scene, SphereScene, error_picture, linear_from_srgb, mean_square_error,
    peak_signal_to_noise,
};

use super::FigureSpec;
use super::gallery::{Exhibit, hang, rendered};
use super::studio::Studio;

pub(super) const FIGURES: &[FigureSpec] =
    &[FigureSpec { id: "adaptive", title: "adaptive sampling against uniform", draw }];

/// Samples per pixel of the pilot and at most, and the error to reach.
const PILOT: f64 = 4.0;
const MOST: f64 = 512.0;
const ERROR: f64 = 0.02;

/// Samples per pixel of the references, by a hexagonal lattice.
const REFERENCE: f64 = 512.0;

fn draw(studio: &Studio) -> Outcome {
    let (width, height) = if studio.quick() { (96, 64) } else { (360, 240) };
    let frame = Frame::new(width, height).map_err(Failure::failed)?;
    let n = if studio.quick() { 256 } else { 4096 };
    let set = studio.sets("fpo", &[], n, 1)?.swap_remove(0);
    let lattice = studio.sets("hexagonal", &[], n, 1)?.swap_remove(0);
    let sphere = SphereScene::new(&frame, 1.0);
    let board = Checkerboard::new(&frame, 0.5, 12.0, 0.5);
    let scenes: [&dyn Scene; 2] = [&sphere, &board];
    let mut rows = Vec::new();
    for scene in scenes {
        rows.extend(compared(scene, &frame, &set, &lattice)?);
    }
    let title = format!(
        "FPO from {PILOT} spp until the error is at most {ERROR}; errors enlarged eight times"
    );
    studio.page("", &hang(&title, rows))
}

/// The image and its rates; the errors of adaptive and of uniform sampling.
fn compared(
    scene: &dyn Scene,
    frame: &Frame,
    set: &PointSet,
    lattice: &PointSet,
) -> Outcome<[Vec<Exhibit>; 2]> {
    let pattern =
        ProgressivePattern::new(set, PILOT, MOST, Seed::new(1)).map_err(Failure::failed)?;
    let kernel = KernelTable::new(bn_render::kernel("lanczos2").expect("in the list"));
    let how = Normalization::Density;
    let renderer = AdaptiveRenderer::new(scene, &pattern, &kernel, how, frame, ERROR);
    let (mut values, mut rates) = (Vec::new(), Vec::new());
    let stats = renderer.stream(&Unobserved, |band| {
        values.extend_from_slice(band.values);
        rates.extend_from_slice(band.samples_per_pixel);
        Ok(())
    });
    let stats = stats.map_err(Failure::failed)?;
    let image = |channels, values| {
        Image::new(frame.width(), frame.height(), channels, values).map_err(Failure::failed)
    };
    let adaptive = image(scene.channels(), values)?;
    let mean = stats.samples as f64 / stats.pixels as f64;
    let reference = rendered(scene, frame, lattice, REFERENCE)?;
    let uniform = rendered(scene, frame, set, mean)?;
    let error = |label: &str, image: &Image| -> Outcome<Exhibit> {
        let mse = mean_square_error(image, &reference).map_err(Failure::failed)?;
        let picture = error_picture(image, &reference, 8.0).map_err(Failure::failed)?;
        let (psnr, rms) = (peak_signal_to_noise(mse), mse.sqrt());
        Ok(Exhibit::new(format!("{label}: {psnr:.1} dB, error {rms:.4}"), picture))
    };
    let errors = vec![
        error(&format!("adaptive, stated {:.4}", stats.error_estimated), &adaptive)?,
        error("uniform", &uniform)?,
    ];
    let map = image(Channels::Grey, rates.iter().map(|&rate| shade(rate)).collect())?;
    let unresolved = match stats.blocks_unresolved {
        0 => String::new(),
        count => format!(", {count} blocks not reached"),
    };
    let top = vec![
        Exhibit::new(format!("{mean:.1} spp on average"), adaptive),
        Exhibit::new(format!("{PILOT} spp (black) to {MOST} (white){unresolved}"), map),
    ];
    Ok([top, errors])
}

/// Light for a rate: equal steps for doublings.
fn shade(rate: f32) -> f32 {
    let part = libm::log2(f64::from(rate) / PILOT) / libm::log2(MOST / PILOT);
    linear_from_srgb(part.clamp(0.0, 1.0)) as f32
}
