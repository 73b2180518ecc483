//! Bands: what all samples of 32 rows of cells add to the pixels, and the pixels that follow.

use std::ops::Range;

use super::BLOCK;
use super::accumulate::{Job, accumulate};
use super::blocks::{BlockPlan, BlockRow};
use super::cells::{Strip, StripPlace, rows_per_strip};
use super::renderer::{Normalization, RenderStats};
use crate::watch::{Turn, Watch};
use crate::{KernelTable, Pattern, Scene, Window};

/// Sums over samples for a rectangle of pixels.
pub(super) struct Planes {
    /// The first pixel column and row.
    pub(super) x: i64,
    pub(super) y: i64,
    pub(super) width: usize,
    pub(super) area: usize,
    pub(super) channels: usize,
    /// Σ r for each pixel.
    pub(super) weight: Vec<f64>,
    /// Σ r·(I − reference) for each channel and pixel.
    pub(super) value: Vec<f64>,
}

/// Everything that the bands of an image share.
pub(super) struct Layout<'a> {
    pub(super) scene: &'a dyn Scene,
    pub(super) pattern: &'a Pattern,
    pub(super) table: &'a KernelTable,
    pub(super) normalization: Normalization,
    pub(super) window: Window,
    pub(super) blocks: BlockPlan<'a>,
    /// The cells whose samples reach the window.
    pub(super) cell_columns: Range<i64>,
    pub(super) cell_rows: Range<i64>,
}

/// Buffers that a thread uses over again.
#[derive(Default)]
pub(super) struct Scratch {
    strip: Strip,
    values: Vec<f64>,
    turn: Turn,
}

impl<'a> Layout<'a> {
    pub(super) fn new(
        scene: &'a dyn Scene,
        pattern: &'a Pattern,
        table: &'a KernelTable,
        normalization: Normalization,
        frame: &crate::Frame,
    ) -> Self {
        let window = frame.window();
        let (first_tap, taps) = (table.first_tap(), table.taps() as i64);
        let cells = |start: u32, length: u32| {
            let (start, length) = (i64::from(start), i64::from(length));
            start - first_tap - taps + 1..start + length - first_tap
        };
        let cell_columns = cells(window.x, window.width);
        let reached = first_tap + table.lanes() as i64 - 1;
        let columns = cell_columns.start + first_tap..cell_columns.end + reached;
        let blocks = BlockPlan {
            scene,
            image: (frame.width(), frame.height()),
            window,
            kernel_radius: table.radius(),
            columns,
        };
        let cell_rows = cells(window.y, window.height);
        Self { scene, pattern, table, normalization, window, blocks, cell_columns, cell_rows }
    }

    /// The bands that have samples for the window.
    pub(super) fn bands(&self) -> Range<i64> {
        self.cell_rows.start.div_euclid(BLOCK)..(self.cell_rows.end - 1).div_euclid(BLOCK) + 1
    }

    /// Bytes that a band's planes take.
    pub(super) fn band_bytes(&self) -> usize {
        let rows = BLOCK as usize + self.table.lanes();
        let width = (self.blocks.columns.end - self.blocks.columns.start) as usize;
        8 * rows * width * (1 + self.scene.channels().count())
    }

    /// Bytes of a band's finished rows.
    pub(super) fn row_bytes(&self) -> usize {
        4 * BLOCK as usize * self.window.width as usize * self.scene.channels().count()
    }

    /// Accumulates all samples of band `band`, or some of them if the watch is stopped.
    pub(super) fn accumulate_band(
        &self,
        band: i64,
        watch: &Watch<'_>,
        scratch: &mut Scratch,
    ) -> (Planes, RenderStats) {
        let rows =
            self.cell_rows.start.max(band * BLOCK)..self.cell_rows.end.min((band + 1) * BLOCK);
        let width = (self.blocks.columns.end - self.blocks.columns.start) as usize;
        let area = width * ((rows.end - rows.start) as usize + self.table.lanes() - 1);
        let channels = self.scene.channels().count();
        let mut planes = Planes {
            x: self.blocks.columns.start,
            y: rows.start + self.table.first_tap(),
            width,
            area,
            channels,
            weight: vec![0.0; area],
            value: vec![0.0; channels * area],
        };
        let around = [band - 1, band, band + 1].map(|row| self.blocks.row(row));
        let mut stats = RenderStats { references: around[1].evaluated(), ..Default::default() };
        let columns = self.cell_columns.clone();
        for column in columns.start.div_euclid(BLOCK)..=(columns.end - 1).div_euclid(BLOCK) {
            if self.is_needed(column, band, &around) {
                let part = (band, column, rows.clone());
                self.accumulate_block(
                    part,
                    &around,
                    &mut planes,
                    (watch, &mut *scratch),
                    &mut stats,
                );
            }
        }
        (planes, stats)
    }

    /// Whether a block of samples reaches pixels whose value isn't known beforehand.
    fn is_needed(&self, column: i64, band: i64, around: &[BlockRow; 3]) -> bool {
        if self.normalization == Normalization::None {
            return true;
        }
        let (first, taps) = (self.table.first_tap(), self.table.taps() as i64);
        let reached = |index: i64| {
            let (start, end) = (index * BLOCK + first, (index + 1) * BLOCK + first + taps - 1);
            start.div_euclid(BLOCK)..(end - 1).div_euclid(BLOCK) + 1
        };
        reached(band).any(|row| around[(row - band + 1) as usize].any_varies(reached(column)))
    }

    fn accumulate_block(
        &self,
        (band, column, rows): (i64, i64, Range<i64>),
        around: &[BlockRow; 3],
        planes: &mut Planes,
        (watch, scratch): (&Watch<'_>, &mut Scratch),
        stats: &mut RenderStats,
    ) {
        let x = self.cell_columns.start.max(column * BLOCK);
        let columns = (self.cell_columns.end.min((column + 1) * BLOCK) - x) as usize;
        let height = rows_per_strip(self.pattern.samples_per_pixel()) as i64;
        // Strips are cut at fixed rows, not that it mattered: cells are independent.
        let mut y = rows.start;
        while y < rows.end && !watch.is_stopped() {
            let end = ((y.div_euclid(height) + 1) * height).min(rows.end);
            let place = StripPlace { x, y, columns, rows: (end - y) as usize };
            scratch.strip.collect(self.pattern, place, self.table.phase());
            let n = scratch.strip.len();
            scratch.values.resize(n * planes.channels, 0.0);
            if let Some(color) = around[1].constant(column) {
                for (plane, value) in scratch.values.chunks_exact_mut(n.max(1)).zip(color) {
                    plane.fill(value);
                }
            } else {
                self.scene.values(&scratch.strip.u, &scratch.strip.v, &mut scratch.values);
                stats.evaluated += n as u64;
            }
            let job = Job {
                strip: &scratch.strip,
                place,
                values: &scratch.values,
                table: self.table,
                references: around,
                references_start: (band - 1) * BLOCK,
            };
            accumulate(&job, planes);
            watch.took(n, &mut scratch.turn);
            y = end;
        }
    }

    /// The wanted pixels of block row `row` from the bands around it (upper, own, lower), and the
    /// number of them that no sample reaches.
    pub(super) fn finish_rows(&self, row: i64, bands: [Option<&Planes>; 3]) -> (Vec<f32>, u64) {
        let blocks = self.blocks.row(row);
        let (left, width) = (i64::from(self.window.x), self.window.width as usize);
        let rows = self.pixel_rows(row);
        let channels = self.scene.channels().count();
        let mut out = vec![0.0; (rows.end - rows.start) as usize * width * channels];
        let (mut weight, mut value) = (vec![0.0; width], vec![0.0; width]);
        let mut empty = 0;
        for (y, pixels) in rows.zip(out.chunks_exact_mut(width * channels)) {
            sum_rows(bands, y, left, None, &mut weight);
            empty += self.count_empty(&blocks, &weight);
            for c in 0..channels {
                sum_rows(bands, y, left, Some(c), &mut value);
                let column = (left - self.blocks.columns.start) as usize;
                let references = &blocks.references(c)[column..column + width];
                let pixels = pixels.iter_mut().skip(c).step_by(channels);
                for (((pixel, &w), &v), &r) in pixels.zip(&weight).zip(&value).zip(references) {
                    *pixel = self.pixel(w, v, r) as f32;
                }
            }
        }
        (out, empty)
    }

    /// The wanted pixel rows of a row of blocks.
    pub(super) fn pixel_rows(&self, row: i64) -> Range<i64> {
        let (top, height) = (i64::from(self.window.y), i64::from(self.window.height));
        top.max(row * BLOCK)..(top + height).min((row + 1) * BLOCK)
    }

    /// The pixel of weight Σ r and value Σ r·(I − reference).
    ///
    /// In a block that is known to be constant no sample may have been accumulated; if all were,
    /// each would have added exactly 0 to the value: the pixel is its reference either way.
    #[inline]
    fn pixel(&self, weight: f64, value: f64, reference: f64) -> f64 {
        match self.normalization {
            Normalization::Density if weight != 0.0 => reference + value / weight,
            Normalization::Density => reference,
            Normalization::None => {
                let integral = self.table.integral();
                let expected = self.pattern.samples_per_pixel() * integral * integral;
                (value + reference * weight) / expected
            }
        }
    }

    /// Pixels of a row without weight; where density divides, without blocks whose samples may have been
    /// skipped.
    fn count_empty(&self, blocks: &BlockRow, weight: &[f64]) -> u64 {
        let column = |i: usize| (i64::from(self.window.x) + i as i64) / BLOCK;
        let empty = weight.iter().enumerate().filter(|&(_, &w)| w == 0.0);
        let may_be_skipped = |i: usize| {
            self.normalization == Normalization::Density && blocks.constant(column(i)).is_some()
        };
        empty.filter(|&(i, _)| !may_be_skipped(i)).count() as u64
    }
}

/// Sums a row of pixels over the bands, upper band first: the weights, or the values of a channel.
fn sum_rows(
    bands: [Option<&Planes>; 3],
    y: i64,
    left: i64,
    channel: Option<usize>,
    sum: &mut [f64],
) {
    sum.fill(0.0);
    for planes in bands.into_iter().flatten() {
        let row = y - planes.y;
        if row < 0 || row as usize * planes.width >= planes.area {
            continue;
        }
        let plane = channel.map_or(&planes.weight[..], |c| &planes.value[c * planes.area..]);
        let start = row as usize * planes.width + (left - planes.x) as usize;
        for (sum, &x) in sum.iter_mut().zip(&plane[start..]) {
            *sum += x;
        }
    }
}
