//! Samples sorted by the pixels that they reach.

use super::BLOCK;
use crate::simd::vectorized;
use crate::{Pattern, Rect, SampleList};

/// Samples of a strip of cells, 32 cells wide and a few high, sorted by cell.
///
/// A cell holds the samples that reach the same pixels: a unit square between pixel centres for
/// kernels of even diameter. Cells are all or nothing for a window of pixels, and their samples
/// come in the pattern's order: so what a cell adds to its pixels never depends on what else is
/// rendered.
#[derive(Default)]
pub(super) struct Strip {
    found: SampleList,
    keys: Vec<u16>,
    cursor: Vec<u32>,
    /// The strip's samples, cell by cell, row by row.
    pub(super) u: Vec<f64>,
    pub(super) v: Vec<f64>,
    /// Nothing if all samples weigh the same.
    pub(super) weights: Vec<f64>,
    /// Where the samples of each cell begin, and the end of the last.
    pub(super) starts: Vec<u32>,
}

/// Which cells a strip holds: their first column and row, and how many.
#[derive(Clone, Copy)]
pub(super) struct StripPlace {
    pub(super) x: i64,
    pub(super) y: i64,
    pub(super) columns: usize,
    pub(super) rows: usize,
}

impl StripPlace {
    pub(super) fn cells(&self) -> usize {
        self.columns * self.rows
    }

    /// The part of the plane that the cells cover; `phase` is where cells begin, modulo 1.
    pub(super) fn rect(&self, phase: f64) -> Rect {
        let (u, v) = (self.x as f64 + phase, self.y as f64 + phase);
        Rect::new(u, v, u + self.columns as f64, v + self.rows as f64)
    }
}

/// Rows of cells in a strip such that samples and their values stay in the nearest caches.
pub(super) fn rows_per_strip(samples_per_pixel: f64) -> usize {
    const SAMPLES: f64 = 4096.0;
    // Casts saturate; a strip is never higher than a block.
    ((SAMPLES / (BLOCK as f64 * samples_per_pixel)) as usize).clamp(1, BLOCK as usize)
}

impl Strip {
    /// Collects and sorts the samples of the cells at `place`.
    pub(super) fn collect(&mut self, pattern: &Pattern, place: StripPlace, phase: f64) {
        self.found.clear();
        pattern.samples_in(&place.rect(phase), &mut self.found);
        let (u, v) = (self.found.u(), self.found.v());
        self.keys.resize(u.len(), 0);
        cell_keys(u, v, place, phase, &mut self.keys);
        cell_starts(&self.keys, place.cells(), &mut self.starts);
        self.cursor.clear();
        self.cursor.extend_from_slice(&self.starts);
        self.u.resize(u.len(), 0.0);
        self.v.resize(v.len(), 0.0);
        for ((&key, &u), &v) in self.keys.iter().zip(u).zip(v) {
            let slot = &mut self.cursor[usize::from(key)];
            self.u[*slot as usize] = u;
            self.v[*slot as usize] = v;
            *slot += 1;
        }
        self.collect_weights();
    }

    /// The weights, if there are any, in the order of the samples.
    fn collect_weights(&mut self) {
        let weights = self.found.weights();
        self.weights.resize(weights.len(), 0.0);
        if weights.is_empty() {
            return;
        }
        self.cursor.clear();
        self.cursor.extend_from_slice(&self.starts);
        for (&key, &weight) in self.keys.iter().zip(weights) {
            let slot = &mut self.cursor[usize::from(key)];
            self.weights[*slot as usize] = weight;
            *slot += 1;
        }
    }

    /// Number of samples.
    pub(super) fn len(&self) -> usize {
        self.u.len()
    }
}

vectorized! {
    /// The cell of each sample, row by row.
    fn cell_keys(u: &[f64], v: &[f64], place: StripPlace, phase: f64, keys: &mut [u16]) {
        let (left, top) = (place.x as f64, place.y as f64);
        let (columns, rows) = (place.columns as i32, place.rows as i32);
        for ((key, &u), &v) in keys.iter_mut().zip(u).zip(v) {
            // The rectangle holds whole cells; clamped all the same, for the rounding of u − phase.
            let column = ((u - phase - left) as i32).min(columns - 1);
            let row = ((v - phase - top) as i32).min(rows - 1);
            *key = (row * columns + column) as u16;
        }
    }
}

/// Where each cell's samples begin once sorted, and the end of the last.
fn cell_starts(keys: &[u16], cells: usize, starts: &mut Vec<u32>) {
    starts.clear();
    starts.resize(cells + 1, 0);
    for &key in keys {
        starts[usize::from(key) + 1] += 1;
    }
    let mut sum = 0;
    for start in starts {
        sum += *start;
        *start = sum;
    }
}
