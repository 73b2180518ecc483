//! What `bn render` takes by name.

use std::io::{Result, Write};

use bn_render::{KERNELS, Normalization, SCENES, SUPERSAMPLING, grid_error};
use serde::Serialize;

use super::write_names;

/// Of what kernels' errors are stated: bands in cycles per pixel, and samples per pixel of the grids.
const STATED: [(f64, f64); 4] = [(0.1, 1.0), (0.25, 1.0), (0.25, 4.0), (0.5, 4.0)];

#[derive(Serialize)]
pub(super) struct Kernel {
    name: &'static str,
    radius: f64,
    integral: f64,
    errors: Vec<GridError>,
}

#[derive(Serialize)]
struct GridError {
    band: f64,
    samples_per_pixel: f64,
    error: f64,
}

pub(super) fn kernels() -> Vec<Kernel> {
    let of = |kernel: &dyn bn_render::Kernel| Kernel {
        name: kernel.name(),
        radius: kernel.radius(),
        integral: kernel.integral(),
        errors: (STATED.iter())
            .map(|&(band, samples_per_pixel)| {
                let error = grid_error(kernel, Normalization::Density, band, samples_per_pixel);
                GridError { band, samples_per_pixel, error }
            })
            .collect(),
    };
    KERNELS.iter().map(|kernel| of(*kernel)).collect()
}

pub(super) fn write_kernels(w: &mut dyn Write, kernels: &[Kernel]) -> Result<()> {
    write!(w, "{:<9} {:>6} {:>9}", "name", "radius", "integral")?;
    for (band, rate) in STATED {
        write!(w, " {:>10}", format!("e({band}, {rate})"))?;
    }
    writeln!(w)?;
    for kernel in kernels {
        write!(w, "{:<9} {:>6} {:>9.6}", kernel.name, kernel.radius, kernel.integral)?;
        for stated in &kernel.errors {
            write!(w, " {:>10.4}", stated.error)?;
        }
        writeln!(w)?;
    }
    writeln!(
        w,
        "\nradius: of the square support, in pixels\nintegral: of r along one axis\n\
         e(b, s): the most by which an image of waves up to b cycles per pixel along each axis, sampled on a\n\
         square grid of s samples per pixel, differs after reconstruction (--normalize density), as a part\n\
         of the sum of the waves' amplitudes"
    )
}

#[derive(Serialize)]
pub(super) struct Scene {
    name: &'static str,
    summary: &'static str,
    options: &'static [&'static str],
}

pub(super) fn scenes() -> Vec<Scene> {
    let of = |entry: &bn_render::SceneEntry| Scene {
        name: entry.name,
        summary: entry.summary,
        options: entry.options,
    };
    SCENES.iter().map(of).collect()
}

pub(super) fn write_scenes(w: &mut dyn Write, scenes: &[Scene]) -> Result<()> {
    write_names(w, scenes.iter().map(|scene| (scene.name, scene.summary)))
}

#[derive(Serialize)]
pub(super) struct Set {
    name: &'static str,
    samples_per_pixel: usize,
    weights_per_pixel: usize,
}

pub(super) fn supersampling() -> Vec<Set> {
    let known = |name: &&'static str| {
        bn_render::supersampling(name).map(|set| Set {
            name,
            samples_per_pixel: set.samples_per_pixel(),
            weights_per_pixel: set.weights_per_pixel(),
        })
    };
    SUPERSAMPLING.iter().filter_map(known).collect()
}

pub(super) fn write_supersampling(w: &mut dyn Write, sets: &[Set]) -> Result<()> {
    writeln!(w, "{:<17} {:>3} {:>4}", "name", "n", "m")?;
    for Set { name, samples_per_pixel, weights_per_pixel } in sets {
        writeln!(w, "{name:<17} {samples_per_pixel:>3} {weights_per_pixel:>4}")?;
    }
    writeln!(
        w,
        "\nn: samples a pixel, shared ones counted once\nm: weights of a pixel, zeros included"
    )
}
