//! One tile of pixels: sampled, judged and refined until it is good enough.

use super::super::renderer::Normalization;
use super::PATCH;
use super::patches::{Axis, Patches, Source};
use super::progressive::ProgressivePattern;
use crate::watch::Watch;
use crate::{Color, Rect};

/// Pixels with less than this part of the expected weight aren't believed.
const THIN: f64 = 0.1;

/// What all tiles share.
#[derive(Clone, Copy)]
pub(super) struct Task<'a> {
    pub(super) source: Source<'a>,
    pub(super) normalization: Normalization,
    /// The square of the error that windows are refined to.
    pub(super) most_square: f64,
}

/// A finished tile.
#[derive(Default)]
pub(super) struct FinishedTile {
    /// Pixels row by row, channels side by side.
    pub(super) values: Vec<f32>,
    /// Samples per pixel of each pixel's patch.
    pub(super) rates: Vec<f32>,
    pub(super) account: TileAccount,
}

/// What was done for a tile.
#[derive(Clone, Copy, Default)]
pub(super) struct TileAccount {
    pub(super) samples: u64,
    pub(super) pilot: u64,
    pub(super) evaluated: u64,
    pub(super) references: u64,
    pub(super) blocks: u64,
    pub(super) refined: u64,
    pub(super) unresolved: u64,
    pub(super) empty: u64,
    /// Pixels whose error is estimated, the sum of their squares, and the largest mean of a window.
    pub(super) estimated: u64,
    pub(super) square: f64,
    pub(super) worst_square: f64,
}

/// Buffers that a thread uses over again.
#[derive(Default)]
pub(super) struct TileScratch {
    patches: Patches,
    /// For the weight and each channel the tile's pixels: of the last layers, and of those before
    /// less them.
    total: Vec<f64>,
    gap: Vec<f64>,
    squares: Vec<Squares>,
    windows: Vec<Squares>,
}

/// The estimated squared errors of some pixels.
#[derive(Clone, Copy, Default)]
struct Squares {
    sum: f64,
    /// Pixels that have an estimate.
    estimated: u32,
    /// Pixels that nothing can be said of: no sample reaches them, or next to none counts.
    unsure: u32,
}

impl Squares {
    fn add(&mut self, other: Self) {
        self.sum += other.sum;
        self.estimated += other.estimated;
        self.unsure += other.unsure;
    }

    /// NaN if nothing is known.
    fn mean(self) -> f64 {
        self.sum / f64::from(self.estimated)
    }

    fn is_within(self, most: f64) -> bool {
        self.unsure == 0 && self.mean() <= most
    }
}

/// What is known of a pixel's error.
enum Known {
    Error(f64),
    /// No sample of the older layer reaches it.
    Nothing,
    /// The samples of the last layer cancel each other in the kernel, the value being a quotient of small
    /// numbers, or none reaches it.
    Thin,
}

impl Task<'_> {
    /// Renders the pixels of `axes`, as far as it gets if the watch is stopped.
    pub(super) fn render(
        &self,
        axes: [&Axis; 2],
        watch: &Watch<'_>,
        scratch: &mut TileScratch,
    ) -> FinishedTile {
        let [(left, right), (top, bottom)] = axes.map(|axis| axis.span(self.source.table.phase()));
        let reach = Rect::new(left, top, right, bottom);
        // Under plain convolution even constants are noisy.
        let constant = match self.normalization {
            Normalization::Density => self.source.scene.constant_over(&reach),
            Normalization::None => None,
        };
        if let Some(color) = constant {
            return self.flat(axes, &reach, color);
        }
        let reference = self.source.scene.value(reach.center());
        scratch.patches.start(self.source, axes, reference, watch);
        let pilot = scratch.patches.samples;
        let last = self.source.pattern.levels() - 1;
        let mut finished = FinishedTile::default();
        loop {
            self.compose(axes, scratch);
            self.finish(axes, reference, scratch, &mut finished);
            judge_windows(axes, self.window_arm(), scratch);
            let mut refined = false;
            for (patch, &window) in scratch.windows.iter().enumerate() {
                let goes_on = scratch.patches.level(patch) < last && !watch.is_stopped();
                if goes_on && !window.is_within(self.most_square) {
                    scratch.patches.refine(self.source, axes, patch, watch);
                    refined = true;
                }
            }
            if !refined {
                break;
            }
        }
        self.settle(axes, scratch, &mut finished.account);
        finished.account.pilot = pilot;
        self.record_rates(axes, scratch, &mut finished);
        finished
    }

    /// A tile whose value is known: its pilot samples are counted, not taken.
    fn flat(&self, axes: [&Axis; 2], reach: &Rect, color: Color) -> FinishedTile {
        let pixels = axes[0].pixels * axes[1].pixels;
        let channels = self.source.scene.channels().count();
        let pilot = &self.source.pattern.layers()[..2];
        let samples = pilot.iter().map(|layer| layer.count_in(reach)).sum();
        let blocks = axes.map(|axis| axis.pixels.div_ceil(PATCH as usize) as u64);
        FinishedTile {
            values: color[..channels].repeat(pixels).iter().map(|&c| c as f32).collect(),
            rates: vec![self.source.pattern.samples_per_pixel(0) as f32; pixels],
            account: TileAccount {
                samples,
                pilot: samples,
                blocks: blocks[0] * blocks[1],
                estimated: pixels as u64,
                ..TileAccount::default()
            },
        }
    }

    /// Patches to either side of a window's: at least one, and enough that a window holds all
    /// pixels that its middle patch's samples reach.
    fn window_arm(&self) -> usize {
        (self.source.table.radius() / PATCH as f64).ceil().max(1.0) as usize
    }

    /// Adds up what the patches give to the pixels.
    fn compose(&self, axes: [&Axis; 2], scratch: &mut TileScratch) {
        let TileScratch { patches, total, gap, .. } = scratch;
        let (width, height) = (axes[0].pixels, axes[1].pixels);
        let planes = 1 + self.source.scene.channels().count();
        for sums in [&mut *total, &mut *gap] {
            sums.clear();
            sums.resize(planes * width * height, 0.0);
        }
        let reach = patches.reach as i64;
        for patch in 0..axes[0].patches * axes[1].patches {
            let (x, y) = Patches::corner(axes, self.source.table, patch);
            let (x, y) = (x - axes[0].start, y - axes[1].start);
            let columns = x.max(0)..(x + reach).min(width as i64);
            let (old, new) = patches.sums(patch);
            if columns.is_empty() {
                continue;
            }
            for row in y.max(0)..(y + reach).min(height as i64) {
                for plane in 0..planes as i64 {
                    let from =
                        (plane * reach * reach + (row - y) * reach + columns.start - x) as usize;
                    let to =
                        ((plane * height as i64 + row) * width as i64 + columns.start) as usize;
                    let count = (columns.end - columns.start) as usize;
                    let (old, new) = (&old[from..][..count], &new[from..][..count]);
                    let sums = total[to..][..count].iter_mut().zip(&mut gap[to..][..count]);
                    for ((total, gap), (&old, &new)) in sums.zip(old.iter().zip(new)) {
                        *total += new;
                        *gap += old - new;
                    }
                }
            }
        }
    }

    /// The pixels, and the estimated squared errors of the patches.
    fn finish(
        &self,
        axes: [&Axis; 2],
        reference: Color,
        scratch: &mut TileScratch,
        finished: &mut FinishedTile,
    ) {
        let (width, area) = (axes[0].pixels, axes[0].pixels * axes[1].pixels);
        let channels = self.source.scene.channels().count();
        scratch.squares.clear();
        scratch.squares.resize(axes[0].patches * axes[1].patches, Squares::default());
        finished.values.clear();
        finished.account.empty = 0;
        for pixel in 0..area {
            let weights = (scratch.total[pixel], scratch.gap[pixel]);
            let mut squares = Squares { estimated: 1, ..Squares::default() };
            for (c, &reference) in reference[..channels].iter().enumerate() {
                let at = (1 + c) * area + pixel;
                let values = (scratch.total[at], scratch.gap[at]);
                let (value, known) = self.pixel(weights, values, reference);
                finished.values.push(value as f32);
                match known {
                    Known::Error(error) => squares.sum += error * error / channels as f64,
                    Known::Nothing => squares = Squares::default(),
                    Known::Thin => squares = Squares { unsure: 1, ..Squares::default() },
                }
            }
            finished.account.empty += u64::from(weights.0 == 0.0);
            let (row, column) = (pixel / width, pixel % width);
            let patch = axes[1].patch_at(row) * axes[0].patches + axes[0].patch_at(column);
            scratch.squares[patch].add(squares);
        }
    }

    /// A pixel's value and estimated error, one realisation of it: from Σ r and Σ r·(I − reference)
    /// of the last layers, and of the layers before less those.
    ///
    /// Layers err independently, by a the older and b the newer, so the mean of (a − b)² is the sum
    /// of both variances. The older layer's is at least g times the newer's, which is g times as
    /// dense, if errors fall at least as fast as those of independent samples; hence (a − b)²/(1 + g)
    /// is at least the variance of b, and just that for independent samples. Under normalisation by
    /// density a and b are those of the ratio to first order, about a weight of at least half the
    /// expected one: where kernels with negative lobes leave hardly any, first order means nothing.
    #[inline]
    fn pixel(&self, weight: (f64, f64), value: (f64, f64), reference: f64) -> (f64, Known) {
        let scale = 1.0 / (1.0 + ProgressivePattern::GROWTH).sqrt();
        let expected = self.source.table.integral().powi(2);
        match self.normalization {
            Normalization::Density if weight.0 == 0.0 => (reference, Known::Thin),
            Normalization::Density => {
                let color = reference + value.0 / weight.0;
                if weight.0 + weight.1 == 0.0 {
                    return (color, Known::Nothing);
                }
                if weight.0 < THIN * expected {
                    return (color, Known::Thin);
                }
                let bounded = weight.0.max(0.5 * expected);
                let gap = (value.1 - value.0 / bounded * weight.1) / bounded;
                (color, Known::Error(scale * gap))
            }
            Normalization::None => {
                let all = (value.0 + reference * weight.0) / expected;
                let gap = (value.1 + reference * weight.1) / expected;
                (all, Known::Error(scale * gap))
            }
        }
    }

    /// The account of a tile that is finished.
    fn settle(&self, axes: [&Axis; 2], scratch: &TileScratch, account: &mut TileAccount) {
        let patches = &scratch.patches;
        (account.samples, account.evaluated) = (patches.samples, patches.evaluated);
        account.references = 1;
        for row in (0..axes[1].patches).filter(|&row| axes[1].has_pixels(row)) {
            for column in (0..axes[0].patches).filter(|&column| axes[0].has_pixels(column)) {
                let patch = row * axes[0].patches + column;
                let window = scratch.windows[patch];
                account.blocks += 1;
                account.refined += u64::from(patches.level(patch) > 0);
                account.unresolved += u64::from(!window.is_within(self.most_square));
                account.worst_square = account.worst_square.max(window.mean());
                account.estimated += u64::from(scratch.squares[patch].estimated);
                account.square += scratch.squares[patch].sum;
            }
        }
    }

    fn record_rates(&self, axes: [&Axis; 2], scratch: &TileScratch, finished: &mut FinishedTile) {
        let rate = |row: usize, column: usize| {
            let patch = axes[1].patch_at(row) * axes[0].patches + axes[0].patch_at(column);
            self.source.pattern.samples_per_pixel(scratch.patches.level(patch)) as f32
        };
        let rows = 0..axes[1].pixels;
        finished.rates =
            rows.flat_map(|row| (0..axes[0].pixels).map(move |column| rate(row, column))).collect();
    }
}

/// The estimated squared errors of the tile's pixels in the window around each patch.
fn judge_windows(axes: [&Axis; 2], arm: usize, scratch: &mut TileScratch) {
    let (columns, rows) = (axes[0].patches, axes[1].patches);
    let around = |i: usize, count: usize| i.saturating_sub(arm)..(i + arm + 1).min(count);
    scratch.windows.clear();
    for row in 0..rows {
        for column in 0..columns {
            let mut window = Squares::default();
            for y in around(row, rows) {
                for &squares in &scratch.squares[y * columns..][around(column, columns)] {
                    window.add(squares);
                }
            }
            scratch.windows.push(window);
        }
    }
}
