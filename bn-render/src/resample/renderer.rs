//! The renderer: scene × pattern × kernel → pixels.

use std::collections::VecDeque;
use std::io;

use bn_core::{Observer, Unobserved};
use rayon::prelude::*;
use thiserror::Error;

use super::band::{Layout, Planes, Scratch};
use super::blocks::block_range;
use crate::image::check_finite;
use crate::watch::Watch;
use crate::{Channels, Frame, Image, ImageError, KernelTable, Pattern, Scene};

/// How the sum over samples becomes a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Normalization {
    /// Normalised convolution, thesis eq. 2.15: Σ a·r·I / Σ a·r with the samples' weights a (1 unless
    /// the pattern is weighted). Constants come out exactly.
    #[default]
    Density,
    /// Plain convolution, eq. 2.13 with unit gain: Σ a·r·I / (s·(∫r)²), s samples per pixel.
    None,
}

/// Why an image was not finished.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The observer asked to stop.
    #[error("rendering was cancelled")]
    Cancelled,
    /// The taker of the rows failed.
    #[error(transparent)]
    Output(#[from] io::Error),
    /// The image is too large to be held; stream it.
    #[error(transparent)]
    Image(#[from] ImageError),
}

/// What was done for an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct RenderStats {
    /// Samples whose kernel reaches a wanted pixel.
    pub samples: u64,
    /// Of these, samples at which the scene was evaluated, once each; the others were not needed,
    /// or their value was known.
    pub evaluated: u64,
    /// Evaluations at block centres, beside the samples: at most one for each 32 × 32 pixels.
    pub references: u64,
    /// Pixels with Σ r = 0, mostly pixels that no sample reaches: under [`Normalization::Density`] they
    /// take the scene's value at their block's centre, and blocks that are known to be constant, which
    /// are exact without a sample, are left out; under [`Normalization::None`] they are 0.
    pub empty_pixels: u64,
}

impl RenderStats {
    /// Samples that reach a wanted pixel and were not evaluated.
    pub fn skipped(&self) -> u64 {
        self.samples - self.evaluated
    }

    fn add(&mut self, other: &Self) {
        self.samples += other.samples;
        self.evaluated += other.evaluated;
        self.references += other.references;
        self.empty_pixels += other.empty_pixels;
    }
}

/// Some finished rows of the wanted window.
#[derive(Clone, Copy, Debug)]
pub struct Band<'a> {
    /// The image row of the first.
    pub first_row: u32,
    /// The pixels, row by row, channels side by side.
    pub values: &'a [f32],
}

/// Renders a scene through a pattern and a kernel.
///
/// Pixel (i, j) has its centre at (i + ½, j + ½) and gathers the samples within the kernel's
/// (square) support, samples outside the image included. Each sample is evaluated once. The result
/// is the same to the bit for any number of threads, any window of the image and whether or not
/// the scene tells where it is constant. Memory holds bands of 32 rows: two and, at once, as many as
/// fit into 160 MB with the rows that they become (at least one, at most four a thread); 8·(1 +
/// channels)·(32 + 2·radius)·width bytes each and as rows 128·channels·width.
///
/// Sums run in f64 relative to a reference value for each block of pixels, so that rounding stays
/// near 1e-15 of the local contrast; weights carry the error of [`KernelTable`].
pub struct Renderer<'a> {
    layout: Layout<'a>,
}

/// Memory for bands in work and for their finished rows, in bytes; the number of bands at once
/// follows.
const BAND_MEMORY: usize = 160 << 20;

impl<'a> Renderer<'a> {
    /// A renderer of the frame's window.
    pub fn new(
        scene: &'a dyn Scene,
        pattern: &'a Pattern,
        kernel: &'a KernelTable,
        normalization: Normalization,
        frame: &Frame,
    ) -> Self {
        Self { layout: Layout::new(scene, pattern, kernel, normalization, frame) }
    }

    /// The channels of the pixels.
    pub fn channels(&self) -> Channels {
        self.layout.scene.channels()
    }

    /// Renders into memory.
    ///
    /// # Errors
    /// If the image is larger than [`Image::MAX_SAMPLES`], or the scene's values are not finite.
    pub fn image(&self) -> Result<(Image, RenderStats), RenderError> {
        let window = self.layout.window;
        Image::check_size(window.width, window.height, self.channels())?;
        let mut values = Vec::new();
        let stats = self.stream(&Unobserved, |band| {
            values.extend_from_slice(band.values);
            Ok(())
        })?;
        Ok((Image::new(window.width, window.height, self.channels(), values)?, stats))
    }

    /// Renders the window from top to bottom, handing finished rows to `sink`.
    ///
    /// # Errors
    /// If the sink fails, a pixel is not a finite number, or the observer asks to stop.
    pub fn stream(
        &self,
        observer: &dyn Observer,
        mut sink: impl FnMut(Band<'_>) -> io::Result<()> + Send,
    ) -> Result<RenderStats, RenderError> {
        let layout = &self.layout;
        let window = layout.window;
        let watch = Watch::new(observer, window.height.into());
        let mut stats = RenderStats { samples: self.samples(), ..Default::default() };
        let bands = layout.bands();
        // Rows are kept until the next bands are in work.
        let rows = layout.row_bytes();
        let at_once =
            (BAND_MEMORY / (layout.band_bytes() + rows)).clamp(1, 4 * rayon::current_num_threads());
        let mut held = Held { first: bands.start, planes: VecDeque::new() };
        let mut finished: Vec<(i64, Vec<f32>)> = Vec::new();
        let mut next_row = block_range(window.y, window.height).start;
        let last_row = block_range(window.y, window.height).end;
        let mut next_band = bands.start;
        while next_row < last_row {
            let group = next_band..(next_band + at_once as i64).min(bands.end);
            next_band = group.end;
            // Rows finished before are handed over while the next bands are in work.
            let (made, taken) = rayon::join(
                || accumulate(layout, group, &watch),
                || {
                    finished
                        .drain(..)
                        .try_for_each(|(row, values)| hand_over(layout, row, &values, &mut sink))
                },
            );
            taken?;
            if watch.is_stopped() {
                return Err(RenderError::Cancelled);
            }
            for (planes, of_band) in made {
                stats.add(&of_band);
                held.planes.push_back(planes);
            }
            let ready =
                if next_band == bands.end { last_row } else { (next_band - 1).min(last_row) };
            let rows: Vec<_> = (next_row..ready)
                .into_par_iter()
                .map(|row| (row, layout.finish_rows(row, held.around(row))))
                .collect();
            for (row, (values, empty)) in rows {
                stats.empty_pixels += empty;
                finished.push((row, values));
            }
            next_row = ready.max(next_row);
            held.forget_before(next_row - 1);
            let done = layout.pixel_rows(next_row - 1).end - i64::from(window.y);
            if !watch.reached(done.max(0) as u64) {
                return Err(RenderError::Cancelled);
            }
        }
        for (row, values) in finished {
            hand_over(layout, row, &values, &mut sink)?;
        }
        Ok(stats)
    }

    /// Number of samples whose kernel reaches the window.
    pub fn samples(&self) -> u64 {
        let (columns, rows) = (&self.layout.cell_columns, &self.layout.cell_rows);
        let place = super::cells::StripPlace {
            x: columns.start,
            y: rows.start,
            columns: (columns.end - columns.start) as usize,
            rows: (rows.end - rows.start) as usize,
        };
        self.layout.pattern.count_in(&place.rect(self.layout.table.phase()))
    }
}

/// The bands that rows to come still need, in order.
struct Held {
    first: i64,
    planes: VecDeque<Planes>,
}

impl Held {
    fn around(&self, row: i64) -> [Option<&Planes>; 3] {
        [row - 1, row, row + 1]
            .map(|band| usize::try_from(band - self.first).ok().and_then(|i| self.planes.get(i)))
    }

    fn forget_before(&mut self, band: i64) {
        while self.first < band && self.planes.pop_front().is_some() {
            self.first += 1;
        }
    }
}

fn accumulate(
    layout: &Layout<'_>,
    bands: std::ops::Range<i64>,
    watch: &Watch<'_>,
) -> Vec<(Planes, super::RenderStats)> {
    bands
        .into_par_iter()
        .map_init(Scratch::default, |scratch, band| layout.accumulate_band(band, watch, scratch))
        .collect()
}

fn hand_over(
    layout: &Layout<'_>,
    row: i64,
    values: &[f32],
    sink: &mut impl FnMut(Band<'_>) -> io::Result<()>,
) -> Result<(), RenderError> {
    let first_row = layout.pixel_rows(row).start as u32;
    let (window, channels) = (layout.window, layout.scene.channels());
    check_finite(values, window.width, channels, (window.x, first_row))?;
    sink(Band { first_row, values })?;
    Ok(())
}
