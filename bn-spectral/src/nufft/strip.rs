//! A band of grid rows, small enough for the cache: the only part of the grid that ever exists.

use std::ops::Range;

use bn_fft::Complex;

use super::ffts::{Direction, FftScratch, Ffts};
use super::kernel::MAX_WIDTH;
use super::real::Real;

/// How real grid rows lie in the complex rows that the FFT works on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Packing {
    /// A row a row: complex data.
    Single,
    /// Two neighbouring rows of real data as real and imaginary part, transformed at once.
    Paired,
}

impl Packing {
    /// Grid rows in a complex row.
    pub(super) fn grid_rows_each(self) -> usize {
        match self {
            Self::Single => 1,
            Self::Paired => 2,
        }
    }

    fn grid_rows(self, rows: &Range<usize>) -> Range<usize> {
        let each = self.grid_rows_each();
        each * rows.start..each * rows.end
    }
}

/// The partition of the grid into strips.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strips {
    pub(super) grid: usize,
    pub(super) packing: Packing,
    /// Complex rows of a strip; the last strip may have fewer.
    pub(super) height: usize,
}

impl Strips {
    /// Strips of about half a megabyte. Each has as many grid rows as a kernel reaches, so that
    /// a kernel never touches more than two.
    pub(super) fn new<T: Real>(grid: usize, packing: Packing) -> Self {
        let rows = grid / packing.grid_rows_each();
        let least = MAX_WIDTH / packing.grid_rows_each();
        let wanted = (1 << 19) / (std::mem::size_of::<Complex<T>>() * grid);
        let fits = |height: &usize| rows.is_multiple_of(*height) || rows % height >= least;
        let height = (least..=wanted.clamp(least, 32)).rev().find(fits);
        let height = height.or_else(|| (least..rows).find(fits)).unwrap_or(rows);
        Self { grid, packing, height }
    }

    /// Complex rows of the whole grid.
    pub(super) fn rows(&self) -> usize {
        self.grid / self.packing.grid_rows_each()
    }

    /// Number of strips.
    pub(super) fn count(&self) -> usize {
        self.rows().div_ceil(self.height)
    }

    /// Numbers from one row to the next in a strip's buffer: a row, and room for kernels that
    /// reach over its end.
    pub(super) fn stride(&self) -> usize {
        self.grid + MAX_WIDTH
    }

    /// The complex rows of strip `index`.
    pub(super) fn rows_of(&self, index: usize) -> Range<usize> {
        index * self.height..((index + 1) * self.height).min(self.rows())
    }

    /// The grid rows of strip `index`.
    pub(super) fn grid_rows_of(&self, index: usize) -> Range<usize> {
        self.packing.grid_rows(&self.rows_of(index))
    }

    /// The grid rows just before strip `index` from which a kernel of `width` reaches into it,
    /// and what takes their numbers to ones that go on below the strip's.
    pub(super) fn reaching(&self, index: usize, width: usize) -> (Range<usize>, i64) {
        let start = self.grid_rows_of(index).start;
        if start == 0 {
            (self.grid + 1 - width..self.grid, -(self.grid as i64))
        } else {
            (start + 1 - width..start, 0)
        }
    }
}

/// One strip's cells.
#[derive(Debug)]
pub(super) struct Strip<'a, T> {
    pub(super) packing: Packing,
    rows: Range<usize>,
    stride: usize,
    cells: &'a mut [Complex<T>],
}

impl<'a, T: Real> Strip<'a, T> {
    /// Strip `index` in (a part of) `buffer`, with whatever the buffer holds.
    pub(super) fn new(strips: &Strips, index: usize, buffer: &'a mut [Complex<T>]) -> Self {
        let rows = strips.rows_of(index);
        let stride = strips.stride();
        let cells = &mut buffer[..rows.len() * stride];
        Self { packing: strips.packing, rows, stride, cells }
    }

    pub(super) fn clear(&mut self) {
        self.cells.fill(Complex::new(T::default(), T::default()));
    }

    /// Zeroes these columns.
    pub(super) fn clear_columns(&mut self, columns: Range<usize>) {
        for row in self.rows_mut() {
            row[columns.clone()].fill(Complex::new(T::default(), T::default()));
        }
    }

    /// Cells in a row, without its padding.
    pub(super) fn grid(&self) -> usize {
        self.stride - MAX_WIDTH
    }

    /// The strip's grid rows.
    pub(super) fn grid_rows(&self) -> Range<usize> {
        self.packing.grid_rows(&self.rows)
    }

    /// The part of the rows `first`, `first` + 1, … (`count` of them) that lies in the strip.
    #[inline(always)]
    pub(super) fn clip(&self, first: i64, count: usize) -> (usize, usize) {
        let (start, end) = (self.rows.start as i64, self.rows.end as i64);
        ((start - first).max(0) as usize, (end - first).clamp(0, count as i64) as usize)
    }

    #[inline(always)]
    fn at(&self, row: usize, column: u32) -> usize {
        (row - self.rows.start) * self.stride + column as usize
    }

    #[inline(always)]
    pub(super) fn cells<const TAPS: usize>(&self, row: usize, column: u32) -> &[Complex<T>; TAPS] {
        let at = self.at(row, column);
        self.cells[at..].first_chunk().expect("rows are padded by the widest kernel")
    }

    #[inline(always)]
    pub(super) fn cells_mut<const TAPS: usize>(
        &mut self,
        row: usize,
        column: u32,
    ) -> &mut [Complex<T>; TAPS] {
        let at = self.at(row, column);
        self.cells[at..].first_chunk_mut().expect("rows are padded by the widest kernel")
    }

    /// Adds what kernels put beyond each row's end to its beginning.
    pub(super) fn fold(&mut self) {
        for row in self.cells.chunks_exact_mut(self.stride) {
            let (row, pad) = row.split_at_mut(self.stride - MAX_WIDTH);
            for (cell, &beyond) in row.iter_mut().zip(&*pad) {
                *cell += beyond;
            }
        }
    }

    /// Repeats each row's beginning beyond its end.
    pub(super) fn unfold(&mut self) {
        for row in self.cells.chunks_exact_mut(self.stride) {
            row.copy_within(..MAX_WIDTH, self.stride - MAX_WIDTH);
        }
    }

    /// The rows in order, without their padding.
    pub(super) fn rows_mut(&mut self) -> impl Iterator<Item = &mut [Complex<T>]> {
        let grid = self.stride - MAX_WIDTH;
        self.cells.chunks_exact_mut(self.stride).map(move |row| &mut row[..grid])
    }

    /// Transforms every row.
    pub(super) fn transform(
        &mut self,
        ffts: &Ffts<T>,
        direction: Direction,
        scratch: &mut FftScratch<T>,
    ) {
        ffts.transform(direction, self.cells, self.stride - MAX_WIDTH, self.stride, scratch);
    }

    /// Number `column` of every row, from the strip's first row to its last.
    #[inline(always)]
    pub(super) fn column(&self, column: usize) -> impl Iterator<Item = Complex<T>> {
        self.cells[column..].iter().step_by(self.stride).copied()
    }

    /// The same, to be written.
    #[inline(always)]
    pub(super) fn column_mut(&mut self, column: usize) -> impl Iterator<Item = &mut Complex<T>> {
        self.cells[column..].iter_mut().step_by(self.stride)
    }
}
