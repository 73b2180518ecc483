//! The inner loops: what the samples of a strip add to the pixels around them.

#![expect(clippy::inline_always, reason = "must be compiled anew under the features of the caller")]
#![expect(clippy::needless_range_loop, reason = "several arrays of a fixed size share an index")]

use super::blocks::BlockRow;
use super::cells::{Strip, StripPlace};
use super::{BLOCK, band::Planes};
use crate::KernelTable;
use crate::simd::vectorized;

/// A strip of samples with their values, ready to be added to planes.
pub(super) struct Job<'a> {
    pub(super) strip: &'a Strip,
    pub(super) place: StripPlace,
    /// Values of the samples, channel by channel.
    pub(super) values: &'a [f64],
    pub(super) table: &'a KernelTable,
    /// The rows of blocks around the planes' pixels, the first holding row `references_start`.
    pub(super) references: &'a [BlockRow; 3],
    /// A pixel row at or above the planes' first, at the start of a block.
    pub(super) references_start: i64,
}

/// Adds a strip's samples to the planes.
pub(super) fn accumulate(job: &Job<'_>, planes: &mut Planes) {
    match planes.channels {
        1 => by_lanes::<1>(job, planes),
        _ => by_lanes::<3>(job, planes),
    }
}

fn by_lanes<const C: usize>(job: &Job<'_>, planes: &mut Planes) {
    match job.table.lanes() {
        1 => add_strip::<1, C>(job, planes),
        2 => add_strip::<2, C>(job, planes),
        4 => add_strip::<4, C>(job, planes),
        6 => add_strip::<6, C>(job, planes),
        8 => add_strip::<8, C>(job, planes),
        12 => add_strip::<12, C>(job, planes),
        _ => add_strip::<16, C>(job, planes),
    }
}

vectorized! {
    /// Σ w and Σ w·(I − c) of each cell, w the kernel times the sample's weight and c the first
    /// sample's value, summed in the order of the samples and then added to the cell's M × M pixels relative to their own references.
    fn add_strip<const M: usize, const C: usize>(job: &Job<'_>, planes: &mut Planes) {
        let n = job.strip.len();
        let phase = job.table.phase();
        let mut batch = Batch::<M, C>::new();
        for row in 0..job.place.rows {
            let y = job.place.y + row as i64;
            for column in 0..job.place.columns {
                let cell = row * job.place.columns + column;
                let range = job.strip.starts[cell] as usize..job.strip.starts[cell + 1] as usize;
                if range.is_empty() {
                    continue;
                }
                let x = job.place.x + column as i64;
                let mut sums = CellSums::<M, C>::ZERO;
                let base: [f64; C] = std::array::from_fn(|c| job.values[c * n + range.start]);
                let (left, top) = (x as f64, y as f64);
                for start in range.clone().step_by(BATCH) {
                    let count = BATCH.min(range.end - start);
                    let (u, v) = (&job.strip.u[start..][..count], &job.strip.v[start..][..count]);
                    for i in 0..count {
                        batch.wx[i] = job.table.weights::<M>(u[i] - phase - left);
                        batch.wy[i] = job.table.weights::<M>(v[i] - phase - top);
                    }
                    if let Some(weights) = job.strip.weights.get(start..start + count) {
                        batch.weigh(weights);
                    }
                    for c in 0..C {
                        let values = &job.values[c * n + start..][..count];
                        for i in 0..count {
                            batch.value[c][i] = values[i] - base[c];
                        }
                    }
                    sums.add(&batch, count);
                }
                let first_tap = job.table.first_tap();
                flush(&sums, &base, x + first_tap, y + first_tap, job, planes);
            }
        }
    }
}

/// Samples whose weights are held at once: in two passes the weights of both axes are vectors.
const BATCH: usize = 32;

/// Weights and relative values of some samples of a cell.
struct Batch<const M: usize, const C: usize> {
    wx: [[f64; M]; BATCH],
    wy: [[f64; M]; BATCH],
    value: [[f64; BATCH]; C],
}

impl<const M: usize, const C: usize> Batch<M, C> {
    fn new() -> Self {
        Self { wx: [[0.0; M]; BATCH], wy: [[0.0; M]; BATCH], value: [[0.0; BATCH]; C] }
    }

    /// Multiplies the kernel by the samples' own weights.
    #[inline(always)]
    fn weigh(&mut self, weights: &[f64]) {
        for (wy, weight) in self.wy.iter_mut().zip(weights) {
            for w in wy {
                *w *= weight;
            }
        }
    }
}

/// The sums of one cell over its M × M pixels.
struct CellSums<const M: usize, const C: usize> {
    weight: [[f64; M]; M],
    value: [[[f64; M]; M]; C],
}

impl<const M: usize, const C: usize> CellSums<M, C> {
    const ZERO: Self = Self { weight: [[0.0; M]; M], value: [[[0.0; M]; M]; C] };

    /// Adds the first `count` samples of a batch, in their order.
    #[inline(always)]
    fn add(&mut self, batch: &Batch<M, C>, count: usize) {
        if M <= 6 {
            // All sums of a grey scene fit into registers.
            for i in 0..count {
                for j in 0..M {
                    self.add_row(batch, i, j);
                }
            }
        } else {
            // The sums of one row fit.
            for j in 0..M {
                for i in 0..count {
                    self.add_row(batch, i, j);
                }
            }
        }
    }

    /// Adds what sample `i` gives to the pixels of row `j`.
    #[inline(always)]
    fn add_row(&mut self, batch: &Batch<M, C>, i: usize, j: usize) {
        for k in 0..M {
            let w = batch.wy[i][j] * batch.wx[i][k];
            self.weight[j][k] += w;
            for c in 0..C {
                self.value[c][j][k] += w * batch.value[c][i];
            }
        }
    }
}

/// Adds a cell's sums to the planes: Σ w·(I − r) = Σ w·(I − c) + (c − r)·Σ w for each pixel's
/// reference r.
#[inline(always)]
fn flush<const M: usize, const C: usize>(
    sums: &CellSums<M, C>,
    base: &[f64; C],
    x: i64,
    y: i64,
    job: &Job<'_>,
    planes: &mut Planes,
) {
    let column = (x - planes.x) as usize;
    for j in 0..M {
        let references = &job.references[((y + j as i64 - job.references_start) / BLOCK) as usize];
        let start = ((y - planes.y) as usize + j) * planes.width + column;
        for c in 0..C {
            let reference = &references.references(c)[column..column + M];
            let plane = &mut planes.value[c * planes.area..][start..start + M];
            for k in 0..M {
                plane[k] += sums.value[c][j][k] + (base[c] - reference[k]) * sums.weight[j][k];
            }
        }
        let plane = &mut planes.weight[start..start + M];
        for k in 0..M {
            plane[k] += sums.weight[j][k];
        }
    }
}
