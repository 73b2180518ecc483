//! How samples become a function again: by convolution, or as the band-limited one that fits best.

use anyhow::anyhow;
use bn_core::{Observer, PointSet};
use bn_geometry::{Triangulation, voronoi_cells};
use bn_render::{
    BandLimitedError, BandLimitedMethod, BandLimitedOptions, BandLimitedRenderer, BandLimitedStats,
    Border, Frame, Image, Kernel, LowPass, Pattern, Stopping,
};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};

use super::super::Global;
use super::scene::Subject;
use crate::{Failure, Outcome};

#[derive(Debug, Args)]
#[command(next_help_heading = "Reconstruction")]
pub(super) struct ReconstructionArgs {
    /// How samples become pixels: each smeared by the kernel; or the band-limited function that fits
    /// the samples best, by conjugate gradients (act) or alternating projections (pocs), and that
    /// convolved with the kernel. The latter two hold image and samples in memory: together up to
    /// some 2000x2000 pixels at 4 spp
    #[arg(long, value_name = "METHOD", default_value = "convolution")]
    reconstruct: Reconstruct,
    /// What samples count for: all the same, or as the areas of their Voronoi cells (default: equal
    /// for convolution, voronoi for act and pocs)
    #[arg(long, value_name = "HOW", conflicts_with = "supersampling")]
    weights: Option<Weights>,
    /// act, pocs: the most iterations, up to 1000000 (default: 30)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=1_000_000))]
    iterations: Option<u32>,
    /// act, pocs: the residual of the normal equations that suffices, over that at the start; from
    /// 0 to below 1 (default: 1e-6)
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    tolerance: Option<f64>,
    /// act, pocs: the frequencies of the fit along each axis, in cycles per pixel (default:
    /// sqrt(spp)/4, but at low rates 7/12, or 1/2 with --border periodic, as far as sqrt(spp/8))
    #[arg(long, value_name = "F", allow_negative_numbers = true)]
    band: Option<f64>,
    /// act, pocs: beyond its border the image fades to its mean, or repeats itself (exact for scenes
    /// of its period only) (default: fade)
    #[arg(long, value_name = "HOW")]
    border: Option<Continued>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Reconstruct {
    Convolution,
    Act,
    Pocs,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Weights {
    Equal,
    Voronoi,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Continued {
    Fade,
    Periodic,
}

impl ReconstructionArgs {
    /// The options of a band-limited reconstruction, if one is asked for.
    pub(super) fn band_limited(&self) -> Outcome<Option<BandLimitedOptions>> {
        let method = match self.reconstruct {
            Reconstruct::Act => BandLimitedMethod::Act,
            Reconstruct::Pocs => BandLimitedMethod::Pocs,
            Reconstruct::Convolution => return self.nothing_of_iterations().map(|()| None),
        };
        let usual = Stopping::default();
        let tolerance = self.tolerance.unwrap_or(usual.tolerance);
        if !(0.0..1.0).contains(&tolerance) {
            return Err(Failure::misuse(format!(
                "--tolerance {tolerance:?}: residuals go from 1 at the start down to 0; 1e-6 is usual"
            )));
        }
        let stopping = Stopping {
            iterations: self.iterations.map_or(usual.iterations, |count| count as usize),
            tolerance,
        };
        if let Some(band) = self.band
            && !(band > 0.0 && band.is_finite())
        {
            return Err(Failure::misuse(format!(
                "--band {band}: a band is a positive number of cycles per pixel"
            )));
        }
        let border = match self.border {
            Some(Continued::Periodic) => Border::Periodic,
            Some(Continued::Fade) | None => Border::Fade,
        };
        Ok(Some(BandLimitedOptions { method, band: self.band, border, stopping }))
    }

    /// An error if an option is given that convolution has no use for.
    fn nothing_of_iterations(&self) -> Outcome {
        let given = [
            self.iterations.map(|_| "iterations"),
            self.tolerance.map(|_| "tolerance"),
            self.band.map(|_| "band"),
            self.border.map(|_| "border"),
        ];
        match given.into_iter().flatten().next() {
            Some(name) => {
                Err(Failure::misuse(format!("--{name} concerns --reconstruct act and pocs only")))
            }
            None => Ok(()),
        }
    }

    /// Whether samples count as the areas of their Voronoi cells.
    pub(super) fn by_voronoi(&self) -> bool {
        match self.weights {
            Some(weights) => weights == Weights::Voronoi,
            None => self.reconstruct != Reconstruct::Convolution,
        }
    }

    /// The set as a tiled pattern with the weights asked for.
    pub(super) fn pattern(&self, set: &PointSet, samples_per_pixel: f64) -> Outcome<Pattern> {
        let pattern = if self.by_voronoi() {
            let cells = voronoi_cells(&Triangulation::new(set));
            // Rounding can leave cells of next to no area on the wrong side of 0.
            let areas: Vec<f64> = cells.iter().map(|cell| cell.area.max(0.0)).collect();
            Pattern::weighted(set, &areas, samples_per_pixel)
        } else {
            Pattern::tiled(set, samples_per_pixel)
        };
        pattern.map_err(Failure::usage)
    }
}

/// A pattern whose samples are fitted, and the kernel after that.
pub(super) struct BandLimited {
    pub(super) pattern: Pattern,
    pub(super) kernel: &'static dyn Kernel,
    pub(super) options: BandLimitedOptions,
}

impl BandLimited {
    pub(super) fn render(
        &self,
        subject: &Subject,
        observer: &dyn Observer,
    ) -> Outcome<(Image, BandLimitedStats)> {
        let renderer = BandLimitedRenderer {
            scene: &*subject.scene,
            pattern: &self.pattern,
            low_pass: LowPass::Kernel(self.kernel),
            frame: subject.frame,
            options: self.options,
        };
        renderer.image(observer).map_err(|error| failure(self.options.method, error))
    }

    /// What the account has beside of what was asked for.
    pub(super) fn settings(&self) -> Value {
        let BandLimitedOptions { band, border, stopping, .. } = self.options;
        json!({
            "band": band,
            "border": match border {
                Border::Fade => "fade",
                Border::Periodic => "periodic",
            },
            "most_iterations": stopping.iterations,
            "tolerance": stopping.tolerance,
        })
    }

    pub(super) fn name(&self) -> &'static str {
        name_of(self.options.method)
    }
}

fn name_of(method: BandLimitedMethod) -> &'static str {
    match method {
        BandLimitedMethod::Act => "act",
        BandLimitedMethod::Pocs => "pocs",
    }
}

/// Refuses a frame, band or rate that can't be reconstructed, before any pattern is made.
pub(super) fn check(
    options: &BandLimitedOptions,
    frame: &Frame,
    kernel: &dyn Kernel,
    samples_per_pixel: f64,
) -> Outcome {
    let checked = options.check(frame, LowPass::Kernel(kernel), samples_per_pixel);
    checked.map_err(|error| failure(options.method, error))
}

fn failure(method: BandLimitedMethod, error: BandLimitedError) -> Failure {
    let is_usage = is_usage(&error);
    let error = anyhow!(error).context(format!("--reconstruct {}", name_of(method)));
    if is_usage { Failure::usage(error) } else { Failure::failed(error) }
}

/// Whether the request is at fault, not the run.
fn is_usage(error: &BandLimitedError) -> bool {
    !matches!(
        error,
        BandLimitedError::Cancelled | BandLimitedError::Transform(_) | BandLimitedError::Image(_)
    )
}

/// Says where the iteration fell short.
pub(super) fn remark(stats: &BandLimitedStats, global: &Global) {
    if stats.convergence.iter().any(bn_render::Convergence::is_underdetermined) {
        global.remark(
            "there are fewer samples than the band needs: of all functions that fit, that of least \
             energy about their mean was approached",
        );
    }
    if !stats.converged() {
        global.remark(format!(
            "the reconstruction ended after {} iterations, at a residual of {:.1e}",
            stats.iterations(),
            stats.residual()
        ));
    }
}

/// The keys that iterations add to the account.
pub(super) fn account(stats: &BandLimitedStats) -> Value {
    let history: Vec<_> = stats.convergence.iter().map(|channel| &channel.history).collect();
    json!({
        "iterations": stats.iterations(),
        "residual": stats.residual(),
        "converged": stats.converged(),
        "condition": stats.condition(),
        "band": stats.band,
        "coefficients": stats.convergence.first().map(|channel| channel.coefficients),
        "residuals": history,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_that_failed_is_no_misuse() {
        assert!(is_usage(&BandLimitedError::NoSamples));
        assert!(is_usage(&BandLimitedError::Band { band: 0.0 }));
        assert!(!is_usage(&BandLimitedError::Cancelled));
    }
}
