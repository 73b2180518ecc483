//! Blocks of cells that get more samples as a whole, and what their samples add to the pixels.

use std::ops::Range;

use super::super::accumulate::{Job, accumulate};
use super::super::band::Planes;
use super::super::blocks::BlockRow;
use super::super::cells::{Strip, StripPlace};
use super::PATCH;
use super::progressive::ProgressivePattern;
use crate::watch::{Turn, Watch};
use crate::{Color, KernelTable, Scene};

/// One axis of a tile: its pixels, the cells whose samples reach them, and the patches of cells.
#[derive(Clone)]
pub(super) struct Axis {
    /// The first pixel, with which a patch begins.
    pub(super) start: i64,
    pub(super) pixels: usize,
    cells: Range<i64>,
    /// The first patch's index; patch 0 begins with the first pixel.
    first: i64,
    /// Number of patches.
    pub(super) patches: usize,
}

impl Axis {
    pub(super) fn new(start: i64, pixels: usize, table: &KernelTable) -> Self {
        let (first_tap, taps) = (table.first_tap(), table.taps() as i64);
        let cells = start - first_tap - taps + 1..start + pixels as i64 - first_tap;
        let first = (cells.start - start).div_euclid(PATCH);
        let last = (cells.end - 1 - start).div_euclid(PATCH);
        Self { start, pixels, cells, first, patches: (last - first + 1) as usize }
    }

    /// Where samples that reach the pixels begin and end; cells begin at `phase` modulo 1.
    pub(super) fn span(&self, phase: f64) -> (f64, f64) {
        (self.cells.start as f64 + phase, self.cells.end as f64 + phase)
    }

    /// The cells of a patch.
    fn cells_of(&self, patch: usize) -> Range<i64> {
        let start = self.start + (self.first + patch as i64) * PATCH;
        start.max(self.cells.start)..(start + PATCH).min(self.cells.end)
    }

    /// The patch of the tile's pixel `offset`.
    pub(super) fn patch_at(&self, offset: usize) -> usize {
        (offset as i64 / PATCH - self.first) as usize
    }

    /// Whether the patch has pixels of the tile.
    pub(super) fn has_pixels(&self, patch: usize) -> bool {
        let offset = (self.first + patch as i64) * PATCH;
        (0..self.pixels as i64).contains(&offset)
    }
}

/// What is sampled how; the same for all tiles.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub(super) scene: &'a dyn Scene,
    pub(super) pattern: &'a ProgressivePattern,
    pub(super) table: &'a KernelTable,
}

/// The sums Σ r/s and Σ r·(I − reference)/s of every patch of a tile for the pixels around it, s
/// the layer's samples per pixel: of the last layer (`new`) and of the one before (`old`).
#[derive(Default)]
pub(super) struct Patches {
    /// Numbers of a patch: for each channel and the weight, the pixels around it.
    stride: usize,
    /// Pixels around a patch, along an axis.
    pub(super) reach: usize,
    old: Vec<f64>,
    new: Vec<f64>,
    levels: Vec<u8>,
    scratch: Scratch,
    pub(super) samples: u64,
    pub(super) evaluated: u64,
}

/// Buffers for one patch.
#[derive(Default)]
struct Scratch {
    strip: Strip,
    values: Vec<f64>,
    planes: Option<Planes>,
    references: Option<[BlockRow; 3]>,
    turn: Turn,
}

impl Patches {
    /// Starts a tile: every patch with the pilot's two layers, values relative to `reference`.
    pub(super) fn start(
        &mut self,
        source: Source<'_>,
        axes: [&Axis; 2],
        reference: Color,
        watch: &Watch<'_>,
    ) {
        let channels = source.scene.channels().count();
        let count = axes[0].patches * axes[1].patches;
        self.reach = PATCH as usize + source.table.lanes() - 1;
        let area = self.reach * self.reach;
        self.stride = (1 + channels) * area;
        for sums in [&mut self.old, &mut self.new] {
            sums.clear();
            sums.resize(count * self.stride, 0.0);
        }
        self.levels.clear();
        self.levels.resize(count, 0);
        (self.samples, self.evaluated) = (0, 0);
        let row = || BlockRow::uniform(reference, channels, self.reach);
        self.scratch.references = Some([row(), row(), row()]);
        self.scratch.planes = Some(Planes {
            x: 0,
            y: 0,
            width: self.reach,
            area,
            channels,
            weight: vec![0.0; area],
            value: vec![0.0; channels * area],
        });
        for patch in 0..count {
            self.sample(source, axes, (patch, 0), watch);
            self.sample(source, axes, (patch, 1), watch);
        }
    }

    /// Takes a patch to the next level.
    pub(super) fn refine(
        &mut self,
        source: Source<'_>,
        axes: [&Axis; 2],
        patch: usize,
        watch: &Watch<'_>,
    ) {
        self.levels[patch] += 1;
        let layer = usize::from(self.levels[patch]) + 1;
        self.sample(source, axes, (patch, layer), watch);
    }

    /// The level of a patch.
    pub(super) fn level(&self, patch: usize) -> usize {
        usize::from(self.levels[patch])
    }

    /// The first pixel that a patch's sums are for.
    pub(super) fn corner(axes: [&Axis; 2], table: &KernelTable, patch: usize) -> (i64, i64) {
        let (column, row) = (patch % axes[0].patches, patch / axes[0].patches);
        let first = |axis: &Axis, index| axis.cells_of(index).start + table.first_tap();
        (first(axes[0], column), first(axes[1], row))
    }

    /// The sums of a patch, old and new: first the weights, then channel by channel.
    pub(super) fn sums(&self, patch: usize) -> (&[f64], &[f64]) {
        let range = patch * self.stride..(patch + 1) * self.stride;
        (&self.old[range.clone()], &self.new[range])
    }

    /// Samples a patch by one more layer, unless the watch is stopped.
    fn sample(
        &mut self,
        source: Source<'_>,
        axes: [&Axis; 2],
        (patch, layer): (usize, usize),
        watch: &Watch<'_>,
    ) {
        if watch.is_stopped() {
            return;
        }
        let (column, row) = (patch % axes[0].patches, patch / axes[0].patches);
        let (x, y) = (axes[0].cells_of(column), axes[1].cells_of(row));
        let place = StripPlace {
            x: x.start,
            y: y.start,
            columns: (x.end - x.start) as usize,
            rows: (y.end - y.start) as usize,
        };
        let pattern = &source.pattern.layers()[layer];
        let range = patch * self.stride..(patch + 1) * self.stride;
        let (old, new) = (&mut self.old[range.clone()], &mut self.new[range]);
        old.copy_from_slice(new);
        let Scratch { strip, values, planes: Some(planes), references: Some(references), turn } =
            &mut self.scratch
        else {
            return;
        };
        strip.collect(pattern, place, source.table.phase());
        let n = strip.len();
        self.samples += n as u64;
        watch.took(n, turn);
        values.resize(n * planes.channels, 0.0);
        if let Some(color) = source.scene.constant_over(&place.rect(source.table.phase())) {
            for (plane, value) in values.chunks_exact_mut(n.max(1)).zip(color) {
                plane.fill(value);
            }
        } else {
            source.scene.values(&strip.u, &strip.v, values);
            self.evaluated += n as u64;
        }
        planes.x = place.x + source.table.first_tap();
        planes.y = place.y + source.table.first_tap();
        planes.weight.fill(0.0);
        planes.value.fill(0.0);
        let job = Job {
            strip,
            place,
            values,
            table: source.table,
            references,
            references_start: planes.y,
        };
        accumulate(&job, planes);
        let share = 1.0 / pattern.samples_per_pixel();
        let sums = planes.weight.iter().chain(&planes.value);
        for (new, sum) in new.iter_mut().zip(sums) {
            *new = sum * share;
        }
    }
}
