//! Points located on the grid and sorted by the first grid row that they touch.

use std::ops::Range;

use bn_core::DVec2;

use super::design::Design;
use super::real::Real;

/// A point seen from the grid.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Located<T> {
    /// Where the point lies in its cell, −1 to 1: the argument of the tap polynomials.
    pub(super) zx: T,
    pub(super) zy: T,
    /// The first column and row under its kernel.
    pub(super) column: u32,
    pub(super) row: u32,
    /// Its place in the caller's order.
    pub(super) index: u32,
}

/// The points of one evaluation; the buffers are kept from one to the next.
#[derive(Debug, Default)]
pub(super) struct SortedPoints<T> {
    unsorted: Vec<Located<T>>,
    sorted: Vec<Located<T>>,
    /// First sorted point of every row, and the number of points at the end.
    starts: Vec<u32>,
}

impl<T: Real> SortedPoints<T> {
    /// Locates and sorts `points`. A counting sort: stable, so that sums have one fixed order.
    pub(super) fn locate(&mut self, points: &[DVec2], design: &Design) {
        let grid = design.grid;
        self.unsorted.clear();
        self.unsorted.reserve(points.len());
        self.starts.clear();
        self.starts.resize(grid + 1, 0);
        for (index, p) in points.iter().enumerate() {
            let (column, zx) = first_cell::<T>(p.x, design);
            let (row, zy) = first_cell::<T>(p.y, design);
            self.starts[row as usize + 1] += 1;
            self.unsorted.push(Located { zx, zy, column, row, index: index as u32 });
        }
        for row in 0..grid {
            self.starts[row + 1] += self.starts[row];
        }
        self.sorted.resize(points.len(), Located::default());
        for located in &self.unsorted {
            // Every row's start moves to its end, which is the start of the next.
            let place = &mut self.starts[located.row as usize];
            self.sorted[*place as usize] = *located;
            *place += 1;
        }
        self.starts.rotate_right(1);
        self.starts[0] = 0;
        self.starts[grid] = points.len() as u32;
    }

    /// Number of points.
    pub(super) fn len(&self) -> usize {
        self.sorted.len()
    }

    /// Where the points of these rows lie in sorted order.
    pub(super) fn span(&self, rows: Range<usize>) -> Range<usize> {
        self.starts[rows.start] as usize..self.starts[rows.end] as usize
    }

    /// The points whose first row is among these.
    pub(super) fn in_rows(&self, rows: Range<usize>) -> &[Located<T>] {
        &self.sorted[self.span(rows)]
    }

    /// All points, sorted.
    pub(super) fn all(&self) -> &[Located<T>] {
        &self.sorted
    }
}

/// The first cell under the kernel of a point at `x`, and the argument of the tap polynomials.
///
/// x·N is kept as a rounded product and its rounding error: otherwise the place within the cell
/// would lose the digits that the cell's number takes, N·ε.
fn first_cell<T: Real>(x: f64, design: &Design) -> (u32, T) {
    let grid = design.grid as f64;
    // Valid points are in [0, 1) already; whoever moves points may leave that to us.
    let x = x - x.floor();
    let product = x * grid;
    let residue = x.mul_add(grid, -product);
    let left = product - 0.5 * design.kernel.width as f64;
    let cell = left.ceil();
    let place = (cell - left) - residue;
    // x − ⌊x⌋ can round to 1, hence the remainder. NaN stays NaN in `place`.
    let wrapped = (cell as i64).rem_euclid(design.grid as i64);
    (wrapped as u32, T::narrow(2.0 * place - 1.0))
}
