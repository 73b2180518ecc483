//! `--adaptive`: as many samples as an error takes, block by block.

use anyhow::anyhow;
use bn_core::{DVec2, Observer, PointSet, Seed};
use bn_render::{
    AdaptiveRenderer, AdaptiveStats, KernelTable, Normalization, ProgressivePattern, RenderStats,
    TileVariation,
};
use clap::Args;
use serde_json::{Value, json};

use super::super::Global;
use super::sampling::from_render_error;
use super::scene::Subject;
use crate::image_file::Rows;
use crate::{Failure, Outcome};

#[derive(Debug, Args)]
#[command(next_help_heading = "Adaptive sampling")]
pub(super) struct AdaptiveArgs {
    /// Sample every block of 4x4 pixels at --spp (a fifth of it to judge the rest by), then four times
    /// as densely again and again while the estimated root mean square error of the window around it
    /// (12x12 pixels, 20x20 for sinc, cut at the borders of tiles of 128) is above ERROR, in units of
    /// light: 0.01 is 40 dB. The error reached is told
    #[arg(long, value_name = "ERROR", allow_negative_numbers = true)]
    adaptive: Option<f64>,
    /// The most samples per pixel that a block may get. Each step about quadruples them, as the layer
    /// before stays to judge by: from 4 to 16.8, 68, 272.8 and 1092; the last that doesn't exceed it
    /// ends refinement
    #[arg(
        long,
        value_name = "SPP",
        default_value = "1100",
        requires = "adaptive",
        allow_negative_numbers = true
    )]
    max_spp: f64,
}

/// A pattern in layers, and how far to go with it.
pub(super) struct Adaptive {
    pattern: ProgressivePattern,
    table: KernelTable,
    pub(super) normalization: Normalization,
    error: f64,
    most: f64,
}

impl AdaptiveArgs {
    /// Whether adaptive sampling is asked for.
    pub(super) fn is_wanted(&self) -> bool {
        self.adaptive.is_some()
    }

    /// Refuses what makes no sense, before any work.
    pub(super) fn check(&self, pilot: f64) -> Outcome {
        let Some(error) = self.adaptive else { return Ok(()) };
        if !(error > 0.0 && error.is_finite()) {
            return Err(Failure::misuse(format!(
                "--adaptive {error}: an error is a positive number"
            )));
        }
        if self.max_spp.is_nan() || self.max_spp < pilot {
            return Err(Failure::misuse(format!(
                "--max-spp {} is below the {pilot} of --spp that every block begins with",
                self.max_spp
            )));
        }
        // Its rates are refused whatever the set.
        let point = PointSet::new(vec![DVec2::ZERO]).map_err(Failure::failed)?;
        ProgressivePattern::new(&point, pilot, self.max_spp, Seed::new(0))
            .map_err(|error| Failure::usage(anyhow!(error).context("--max-spp")))?;
        Ok(())
    }

    /// The sampling by layers of `set`.
    pub(super) fn sampling(
        &self,
        set: &PointSet,
        pilot: f64,
        (seed, variation): (Seed, TileVariation),
        table: KernelTable,
        normalization: Normalization,
    ) -> Outcome<Adaptive> {
        let error = self.adaptive.expect("asked only where it is wanted");
        let pattern = ProgressivePattern::new(set, pilot, self.max_spp, seed);
        let pattern = pattern.map_err(Failure::usage)?.varied(variation);
        Ok(Adaptive { pattern, table, normalization, error, most: self.max_spp })
    }
}

impl Adaptive {
    /// Samples per pixel that every block begins with.
    pub(super) fn pilot(&self) -> f64 {
        self.pattern.samples_per_pixel(0)
    }

    /// Samples per pixel, in all, of a block that is refined as far as may be.
    fn last(&self) -> f64 {
        self.pattern.samples_per_pixel(self.pattern.levels() - 1)
    }

    /// Renders the subject's window, handing its rows over from the top.
    pub(super) fn render(
        &self,
        subject: &Subject,
        observer: &dyn Observer,
        rows: &mut Rows<'_>,
    ) -> Outcome<AdaptiveStats> {
        let renderer = AdaptiveRenderer::new(
            &*subject.scene,
            &self.pattern,
            &self.table,
            self.normalization,
            &subject.frame,
            self.error,
        );
        renderer.stream(observer, |band| rows(band.values)).map_err(from_render_error)
    }

    /// What it took and reached, on standard error.
    pub(super) fn tell(&self, stats: &AdaptiveStats, global: &Global) {
        global.remark(format!(
            "{:.2} samples per pixel on average; estimated error {:.2e}, {:.2e} in the worst window; \
             {} of {} blocks refined",
            mean_rate(stats),
            stats.error_estimated,
            stats.error_worst,
            stats.blocks_refined,
            stats.blocks
        ));
        if stats.blocks_unresolved > 0 {
            global.remark(format!(
                "{} blocks are above an error of {} at {:.1} samples per pixel, the last step that \
                 --max-spp {} allows",
                stats.blocks_unresolved,
                self.error,
                self.last(),
                self.most
            ));
        }
    }

    /// What the account has beside of what was asked for.
    pub(super) fn settings(&self) -> Value {
        json!({"error_target": self.error, "max_spp": self.most})
    }
}

/// The keys of the account that adaptive sampling has beside the others.
pub(super) fn account(stats: &AdaptiveStats, mse: Option<f64>) -> Value {
    json!({
        "spp_mean": mean_rate(stats),
        "pilot_samples": stats.pilot_samples,
        "blocks": stats.blocks,
        "blocks_refined": stats.blocks_refined,
        "blocks_unresolved": stats.blocks_unresolved,
        "error_estimated": stats.error_estimated,
        "error_worst": stats.error_worst,
        "error_true": mse.map(f64::sqrt),
    })
}

/// The counters that every rendering has.
pub(super) fn common(stats: &AdaptiveStats) -> RenderStats {
    RenderStats {
        samples: stats.samples,
        evaluated: stats.evaluated,
        references: stats.references,
        empty_pixels: stats.empty_pixels,
    }
}

fn mean_rate(stats: &AdaptiveStats) -> f64 {
    stats.samples as f64 / stats.pixels as f64
}
