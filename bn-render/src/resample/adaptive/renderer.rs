//! The adaptive renderer: tile by tile, and what it did.

use std::io;
use std::ops::Range;

use bn_core::{Observer, Unobserved};
use rayon::prelude::*;

use super::TILE;
use super::patches::{Axis, Source};
use super::progressive::ProgressivePattern;
use super::tile::{FinishedTile, Task, TileAccount, TileScratch};
use crate::image::check_finite;
use crate::resample::{Normalization, RenderError};
use crate::watch::Watch;
use crate::{Frame, Image, KernelTable, Scene};

/// Renders a scene with as many samples as a wanted error takes, block by block.
///
/// Every block of 4 × 4 pixels begins with the pilot samples of a [`ProgressivePattern`] and goes
/// from level to level, four times as densely each time, as long as the estimated error of the
/// window around it exceeds `error`: the root mean square over the window's pixels (12 × 12, or 20 ×
/// 20 for kernels of a radius above 4 pixels; cut at the borders of the 128-pixel tiles in which the
/// work is done) and channels, in units of light. A block whose level
/// is the pattern's last stays as it is, and is counted.
///
/// *Estimate.* A block's samples are those of its last layer. The layer before is a quarter as dense
/// and errs independently of it, having its own random shift; 1/√5 of the difference of both is the
/// error of the last, just so where errors fall as those of independent samples (from some 16 samples
/// per pixel in that layer on, where normalisation by density is nearly linear), and an upper bound
/// where they fall faster: up to twice the true error for smooth scenes under well-spread patterns.
/// Of pixels with less than a tenth of the expected weight, where independent samples nearly cancel
/// in a kernel with negative lobes, nothing is believed: windows that hold one are refined as far as
/// may be, and what is stated leaves such pixels out.
/// Choosing where to stop by the same estimate makes it a little low, by some percent. Two things it
/// can't see: what both layers miss (a detail between all samples of a window), and, for lattices,
/// errors that are the same all over the image, of which one pair of shifts is one draw only (sets
/// whose densest layer has tiles of few pixels come close to that). Scenes that are half constant
/// gain under well-spread patterns. Where most of an image needs samples, and with independent ones,
/// as many spread evenly do better: the layer that only judges takes a fifth, and rates come in steps
/// of four.
///
/// A sample counts by 1 over the samples per pixel of its block, so that borders between blocks of
/// different rates leave no trace. Tiles of 128 × 128 pixels are rendered each for itself: results
/// are the same to the bit for any number of threads and any window. Samples near a tile's border
/// are taken by all tiles they reach (5 % more samples for a kernel of radius 2).
pub struct AdaptiveRenderer<'a> {
    task: Task<'a>,
    frame: Frame,
}

/// What was done for an adaptive image.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct AdaptiveStats {
    /// Samples of all tiles that meet the window.
    pub samples: u64,
    /// Of these, samples of the pilot.
    pub pilot_samples: u64,
    /// Samples at which the scene was evaluated; the values of the others were known.
    pub evaluated: u64,
    /// Evaluations at tile centres, beside the samples.
    pub references: u64,
    /// Blocks of 4 × 4 pixels.
    pub blocks: u64,
    /// Blocks that got more samples than the pilot's.
    pub blocks_refined: u64,
    /// Blocks whose window is estimated above the wanted error, or holds pixels of which nothing can be
    /// said, with all samples they may have.
    pub blocks_unresolved: u64,
    /// Pixels with Σ r = 0: under [`Normalization::Density`] they take the scene's value at their
    /// tile's centre, and are not part of the estimates; their windows are refined as far as may be.
    /// Under [`Normalization::None`] they are 0.
    pub empty_pixels: u64,
    /// Pixels of all tiles that meet the window.
    pub pixels: u64,
    /// The estimated root mean square error of those of them that two layers reach, the last with a
    /// tenth of the expected weight; NaN if none.
    pub error_estimated: f64,
    /// That of the worst window that has such pixels; NaN if none has.
    pub error_worst: f64,
}

/// Some finished rows of the wanted window.
#[derive(Clone, Copy, Debug)]
pub struct AdaptiveBand<'a> {
    /// The image row of the first.
    pub first_row: u32,
    /// The pixels, row by row, channels side by side.
    pub values: &'a [f32],
    /// Samples per pixel that each pixel's block has got.
    pub samples_per_pixel: &'a [f32],
}

impl<'a> AdaptiveRenderer<'a> {
    /// A renderer of the frame's window to a standard error of `error`.
    ///
    /// # Panics
    /// If `error` is not a positive number.
    pub fn new(
        scene: &'a dyn Scene,
        pattern: &'a ProgressivePattern,
        kernel: &'a KernelTable,
        normalization: Normalization,
        frame: &Frame,
        error: f64,
    ) -> Self {
        assert!(error > 0.0 && error.is_finite(), "an error of {error} can't be reached");
        let source = Source { scene, pattern, table: kernel };
        Self { task: Task { source, normalization, most_square: error * error }, frame: *frame }
    }

    /// The image, held in memory.
    ///
    /// # Errors
    /// If the image is larger than [`Image::MAX_SAMPLES`], or the scene's values are not finite.
    pub fn image(&self) -> Result<(Image, AdaptiveStats), RenderError> {
        let (window, channels) = (self.frame.window(), self.task.source.scene.channels());
        Image::check_size(window.width, window.height, channels)?;
        let mut values = Vec::new();
        let stats = self.stream(&Unobserved, |band| {
            values.extend_from_slice(band.values);
            Ok(())
        })?;
        Ok((Image::new(window.width, window.height, channels, values)?, stats))
    }

    /// Renders the window from top to bottom, handing finished rows to `sink`. Memory holds some
    /// rows of tiles.
    ///
    /// # Errors
    /// If the sink fails or the observer asks to stop.
    pub fn stream(
        &self,
        observer: &dyn Observer,
        mut sink: impl FnMut(AdaptiveBand<'_>) -> io::Result<()>,
    ) -> Result<AdaptiveStats, RenderError> {
        let window = self.frame.window();
        let columns = tiles(window.x, window.width);
        let rows = tiles(window.y, window.height);
        let across = (columns.end - columns.start) as usize;
        // Enough tiles for all threads.
        let at_once = (4 * rayon::current_num_threads()).div_ceil(across) as u32;
        let watch = Watch::new(observer, window.height.into());
        let mut sum = Sum::default();
        for first in rows.clone().step_by(at_once as usize) {
            let group = first..rows.end.min(first + at_once);
            let places: Vec<(u32, u32)> =
                group.flat_map(|row| columns.clone().map(move |column| (column, row))).collect();
            let finished: Vec<FinishedTile> = places
                .par_iter()
                .map_init(TileScratch::default, |scratch, &place| self.tile(place, &watch, scratch))
                .collect();
            if watch.is_stopped() {
                return Err(RenderError::Cancelled);
            }
            for (tiles, places) in finished.chunks(across).zip(places.chunks(across)) {
                for tile in tiles {
                    sum.add(tile);
                }
                self.hand_over(places, tiles, &mut sink)?;
            }
            let last = places.last().map_or(0, |place| (place.1 + 1) * TILE);
            let done = last.min(window.y + window.height) - window.y;
            if !watch.reached(done.into()) {
                return Err(RenderError::Cancelled);
            }
        }
        Ok(sum.stats())
    }

    fn tile(
        &self,
        (column, row): (u32, u32),
        watch: &Watch<'_>,
        scratch: &mut TileScratch,
    ) -> FinishedTile {
        let axis = |index: u32, side: u32| {
            let start = index * TILE;
            let pixels = TILE.min(side - start);
            Axis::new(i64::from(start), pixels as usize, self.task.source.table)
        };
        let axes = [axis(column, self.frame.width()), axis(row, self.frame.height())];
        self.task.render([&axes[0], &axes[1]], watch, scratch)
    }

    /// The wanted rows of a row of tiles.
    fn hand_over(
        &self,
        places: &[(u32, u32)],
        tiles: &[FinishedTile],
        sink: &mut impl FnMut(AdaptiveBand<'_>) -> io::Result<()>,
    ) -> Result<(), RenderError> {
        let window = self.frame.window();
        let channels = self.task.source.scene.channels();
        let Some(&(_, row)) = places.first() else { return Ok(()) };
        let wanted = overlap(row, window.y, window.height);
        let (mut values, mut rates) = (Vec::new(), Vec::new());
        for line in wanted.clone() {
            for (&(column, _), tile) in places.iter().zip(tiles) {
                let width = TILE.min(self.frame.width() - column * TILE) as usize;
                let across = overlap(column, window.x, window.width);
                let pixels = line * width + across.start..line * width + across.end;
                rates.extend_from_slice(&tile.rates[pixels.clone()]);
                values.extend_from_slice(
                    &tile.values[pixels.start * channels.count()..pixels.end * channels.count()],
                );
            }
        }
        let first_row = row * TILE + wanted.start as u32;
        check_finite(&values, window.width, channels, (window.x, first_row))?;
        sink(AdaptiveBand { first_row, values: &values, samples_per_pixel: &rates })?;
        Ok(())
    }
}

/// The tiles that pixels start … start + length − 1 lie in.
fn tiles(start: u32, length: u32) -> Range<u32> {
    start / TILE..(start + length - 1) / TILE + 1
}

/// Which of tile `index`'s pixels are among start … start + length − 1.
fn overlap(index: u32, start: u32, length: u32) -> Range<usize> {
    let corner = index * TILE;
    let (first, end) = (start.max(corner), (start + length).min(corner + TILE));
    (first - corner) as usize..(end - corner) as usize
}

/// The accounts of all tiles, added in their order.
#[derive(Default)]
struct Sum {
    account: TileAccount,
    pixels: u64,
}

impl Sum {
    fn add(&mut self, tile: &FinishedTile) {
        let (sum, one) = (&mut self.account, &tile.account);
        sum.samples += one.samples;
        sum.pilot += one.pilot;
        sum.evaluated += one.evaluated;
        sum.references += one.references;
        sum.blocks += one.blocks;
        sum.refined += one.refined;
        sum.unresolved += one.unresolved;
        sum.empty += one.empty;
        sum.estimated += one.estimated;
        sum.square += one.square;
        sum.worst_square = sum.worst_square.max(one.worst_square);
        self.pixels += tile.rates.len() as u64;
    }

    fn stats(&self) -> AdaptiveStats {
        let sum = &self.account;
        AdaptiveStats {
            samples: sum.samples,
            pilot_samples: sum.pilot,
            evaluated: sum.evaluated,
            references: sum.references,
            blocks: sum.blocks,
            blocks_refined: sum.refined,
            blocks_unresolved: sum.unresolved,
            empty_pixels: sum.empty,
            pixels: self.pixels,
            error_estimated: (sum.square / sum.estimated as f64).sqrt(),
            error_worst: if sum.estimated > 0 { sum.worst_square.sqrt() } else { f64::NAN },
        }
    }
}
