//! Type 1, points → modes: spread, transform the rows strip by strip, then the wanted columns.

use std::ops::Range;

use bn_fft::Complex;

use super::batch::LANES;
use super::ffts::Direction;
use super::located::SortedPoints;
use super::real::Real;
use super::strip::{Packing, Strip};
use super::tables::{Tables, Workers};
use super::taps::{Spread, Strengths};
use super::transpose::{Scale, ToColumns};

/// Which columns kx a spectrum holds.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    pub(super) packing: Packing,
    /// Real strengths: kx, from 0. Complex ones: kx + K.
    pub(super) range: Range<usize>,
}

impl Columns {
    /// kx of column `column` of the range.
    pub(super) fn frequency(&self, column: usize, max_frequency: usize) -> i64 {
        match self.packing {
            Packing::Single => column as i64 - max_frequency as i64,
            Packing::Paired => column as i64,
        }
    }
}

/// Rows of the grid after their transform: `spectrum` holds, strip by strip, column by column,
/// the strip's grid rows; twice their value for real strengths.
pub(super) fn transform_rows<T: Real>(
    tables: &Tables<T>,
    points: &SortedPoints<T>,
    strengths: Strengths<'_>,
    columns: &Columns,
    spectrum: &mut Vec<Complex<T>>,
    workers: &Workers<T>,
) {
    let strips = tables.strips(columns.packing);
    let first = columns.range.start + tables.first_column(columns.packing);
    let wanted = first..first + columns.range.len();
    let size = wanted.len() * strips.packing.grid_rows_each() * strips.height;
    spectrum.resize(wanted.len() * tables.grid(), Complex::new(T::default(), T::default()));
    // Without columns there is nothing to do, in chunks of any size.
    workers.each(
        tables,
        spectrum.chunks_mut(size.max(1)).collect(),
        |index, chunk: &mut [_], worker| {
            let mut strip = Strip::new(strips, index, &mut worker.strip);
            strip.clear();
            let (before, shift) = strips.reaching(index, tables.width());
            let own = strips.grid_rows_of(index);
            for (rows, shift) in [(before, shift), (own, 0)] {
                let (taps, points) = (&tables.taps, points.in_rows(rows));
                T::spread(Spread { taps, points, shift, strengths, strip: &mut strip });
            }
            strip.fold();
            strip.transform(&tables.ffts, Direction::Forward, &mut worker.fft);
            let (strip, columns) = (&strip, wanted.clone());
            T::to_columns(tables.simd, ToColumns { strip, columns, out: chunk });
        },
    );
}

/// A transformed column of the grid, about to become modes.
pub(super) struct GridColumn<'a, T> {
    tables: &'a Tables<T>,
    line: &'a [Complex<T>],
    /// 1/φ̂(kx), and ½ for real strengths.
    factor: T,
}

impl<T: Real> GridColumn<'_, T> {
    /// Writes the modes ky = −K … K.
    pub(super) fn write_to(&self, modes: &mut [Complex<T>]) {
        let Self { tables, line, factor } = *self;
        let limit = tables.max_frequency;
        let (negative, positive) = modes.split_at_mut(limit);
        let (before, after) = tables.deconvolution.split_at(limit);
        let from = &line[line.len() - limit..];
        T::scale(tables.simd, Scale { out: negative, from, along: before, factor });
        T::scale(tables.simd, Scale { out: positive, from: line, along: after, factor });
    }
}

/// Transforms the columns `wanted` of `spectrum` and hands each to `take` with its number, its
/// output, and room for its modes.
pub(super) fn transform_columns<T: Real, O: Send>(
    tables: &Tables<T>,
    columns: &Columns,
    spectrum: &[Complex<T>],
    wanted: Range<usize>,
    outputs: Vec<O>,
    workers: &Workers<T>,
    take: impl Fn(usize, O, &GridColumn<'_, T>, &mut [Complex<T>]) + Sync,
) {
    let grid = tables.grid();
    workers.each(tables, in_batches(outputs), |batch, outputs, worker| {
        let first = wanted.start + batch * LANES;
        let lines = &mut worker.lines[..outputs.len() * grid];
        for (column, line) in (first..).zip(lines.chunks_exact_mut(grid)) {
            collect_column(tables, columns, spectrum, column - columns.range.start, line);
        }
        tables.ffts.transform(Direction::Forward, lines, grid, grid, &mut worker.fft);
        for ((column, line), output) in (first..).zip(lines.chunks_exact(grid)).zip(outputs) {
            // The table of 1/φ̂ is centred on k = 0.
            let factor = match columns.packing {
                Packing::Single => tables.deconvolution[column],
                Packing::Paired => {
                    tables.deconvolution[column + tables.max_frequency] * T::narrow(0.5)
                }
            };
            take(column, output, &GridColumn { tables, line, factor }, &mut worker.modes);
        }
    });
}

/// The items by [`LANES`], in order.
fn in_batches<O>(items: Vec<O>) -> Vec<Vec<O>> {
    let mut batches = Vec::with_capacity(items.len().div_ceil(LANES));
    let mut items = items.into_iter().peekable();
    while items.peek().is_some() {
        batches.push(items.by_ref().take(LANES).collect());
    }
    batches
}

/// Column `index` of the spectrum, from all strips.
fn collect_column<T: Real>(
    tables: &Tables<T>,
    columns: &Columns,
    spectrum: &[Complex<T>],
    index: usize,
    line: &mut [Complex<T>],
) {
    let strips = tables.strips(columns.packing);
    let rows = strips.packing.grid_rows_each() * strips.height;
    let parts = spectrum.chunks(columns.range.len() * rows);
    for (part, out) in parts.zip(line.chunks_mut(rows)) {
        out.copy_from_slice(&part[index * out.len()..][..out.len()]);
    }
}
