//! Disks on the torus in a grid whose cells hold at most one centre.

use std::sync::atomic::{AtomicU64, Ordering};

use bn_core::DVec2;

use crate::SampleError;
use crate::error::reserve;

/// Places that keep a minimum distance, in a grid of square cells with a diagonal of at most that
/// distance, so that a cell holds at most one.
///
/// The grid is padded by copies of the cells beyond the seam, with coordinates to match: queries
/// never wrap. Threads may enter centres and ask at the same time; a question may miss a centre
/// that is just being entered, some of its copies or all.
#[derive(Debug)]
pub(super) struct DiskGrid {
    /// Cells per side of the unit square.
    side: usize,
    /// Cells per row, padding included.
    stride: usize,
    radius_squared: f64,
    /// The centre in each cell that is taken.
    centres: Vec<Centre>,
    /// Which cells are taken: bit i of word j of a row is for cell 32·j + i of that row, i < 64, so
    /// that any 33 neighbours are together in one word.
    taken: Vec<AtomicU64>,
    /// Words per row of `taken`.
    words: usize,
    /// The cells of a neighbourhood, counted from its lower left cell: the order of its bits.
    neighbours: [usize; NEIGHBOURHOOD],
}

/// The bits of the coordinates.
#[derive(Debug, Default)]
struct Centre([AtomicU64; 2]);

/// A cell of the unit square, counted from the lower left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cell {
    pub(super) column: u16,
    pub(super) row: u16,
}

/// An axis-parallel square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Square {
    pub(super) centre: DVec2,
    pub(super) half_side: f64,
}

/// Cells that a disk may reach over to either side of its own, and width of the padding.
///
/// Enough: a radius is less than √2 + radius cells, at most 2 from radius 0.58 downwards; above it
/// there are 2 or 3 cells a side, and the copy of a centre nearest to a point, at most ½ away in
/// each axis, lies within 2 cells.
pub(super) const REACH: usize = 2;
/// Cells in a row of a neighbourhood.
pub(super) const WIDTH: usize = 2 * REACH + 1;
/// Cells in a neighbourhood.
const NEIGHBOURHOOD: usize = WIDTH * WIDTH;
/// The rows of a neighbourhood, the nearest first.
const ROWS: [usize; WIDTH] = [2, 1, 3, 0, 4];
/// The cell itself among its neighbourhood's bits.
const OWN: u32 = 1 << REACH;

/// Above the torus's diameter √½ only one disk fits, whatever the radius.
const LARGEST_RADIUS: f64 = 0.75;

/// Copies beyond the seam are rounded to 2⁻⁵²: a radius this much larger makes up for it.
const ROUNDING: f64 = 1e-15;

impl DiskGrid {
    /// An empty grid for centres at least `radius` > 0 apart; `n` is for the error only.
    ///
    /// Memory: 16 bytes for each of about 2/radius² cells.
    pub(super) fn new(radius: f64, n: usize) -> Result<Self, SampleError> {
        let radius = (radius + ROUNDING).min(LARGEST_RADIUS);
        let side = (std::f64::consts::SQRT_2 / radius * (1.0 + ROUNDING)).ceil();
        if side > f64::from(u16::MAX) {
            return Err(SampleError::OutOfMemory { n });
        }
        let side = side as usize;
        let stride = side + 2 * REACH;
        let words = stride.div_ceil(32);
        let mut centres = reserve(stride * stride)?;
        centres.resize_with(stride * stride, Centre::default);
        let mut taken = reserve(words * stride)?;
        taken.resize_with(words * stride, AtomicU64::default);
        let neighbours = std::array::from_fn(|bit| ROWS[bit / WIDTH] * stride + bit % WIDTH);
        let radius_squared = radius * radius;
        Ok(Self { side, stride, radius_squared, centres, taken, words, neighbours })
    }

    /// Cells per side of the unit square.
    pub(super) fn side(&self) -> u16 {
        self.side as u16
    }

    /// Whether two centres may not be so near to each other.
    #[inline]
    pub(super) fn are_too_near(&self, distance_squared: f64) -> bool {
        distance_squared < self.radius_squared
    }

    /// Whether any disk covers `p`, which lies in `cell`.
    #[inline]
    pub(super) fn covers_place(&self, p: DVec2, cell: Cell) -> bool {
        let mut near = self.centres_near(cell, self.taken_near(cell));
        near.any(|centre| self.are_too_near((centre - p).length_squared()))
    }

    /// Which quarters of `square`, which lies in `cell`, are covered by a disk each: lower left,
    /// lower right, upper left, upper right.
    #[inline]
    pub(super) fn covered_quarters(&self, square: Square, cell: Cell) -> [bool; 4] {
        let taken = self.taken_near(cell);
        if taken & OWN != 0 {
            return [true; 4];
        }
        let half = 0.5 * square.half_side;
        let mut covered = [false; 4];
        for centre in self.centres_near(cell, taken) {
            let d = centre - square.centre;
            // Squared distances along each axis to the far sides of the quarters.
            let far = |d: f64| [d + half, d - half].map(|d| (d.abs() + half).powi(2));
            let ([left, right], [low, high]) = (far(d.x), far(d.y));
            covered[0] |= self.are_too_near(left + low);
            covered[1] |= self.are_too_near(right + low);
            covered[2] |= self.are_too_near(left + high);
            covered[3] |= self.are_too_near(right + high);
        }
        covered
    }

    /// Enters a centre that no disk covers and that lies in `cell`.
    pub(super) fn insert(&self, p: DVec2, cell: Cell) {
        for (row, dy) in self.copies(cell.row.into()) {
            for (column, dx) in self.copies(cell.column.into()) {
                self.centres[row * self.stride + column].move_to(p + DVec2::new(dx, dy));
                let word = row * self.words + column / 32;
                // After the place: who sees the bit sees the place.
                self.taken[word].fetch_or(1 << (column % 32), Ordering::Release);
                #[cfg(test)]
                delay::pause();
                if column >= 32 {
                    self.taken[word - 1].fetch_or(1 << (column % 32 + 32), Ordering::Release);
                }
            }
        }
    }

    /// Where a row or column of the unit square appears in the padded grid, and its displacement.
    fn copies(&self, index: usize) -> impl Iterator<Item = (usize, f64)> + use<> {
        let (side, stride) = (self.side, self.stride);
        let home = index + REACH;
        let first = home % side;
        (first..stride).step_by(side).map(move |at| (at, (at as f64 - home as f64) / side as f64))
    }

    /// Which cells that a disk around a point of `cell` may reach are taken, nearest rows first.
    #[inline]
    fn taken_near(&self, cell: Cell) -> u32 {
        let (column, row) = (usize::from(cell.column), usize::from(cell.row));
        let mut bits = 0;
        for (i, near) in ROWS.into_iter().enumerate() {
            let word = self.taken[(row + near) * self.words + column / 32].load(Ordering::Acquire);
            bits |= ((word >> (column % 32)) as u32 & ((1 << WIDTH) - 1)) << (i * WIDTH);
        }
        bits
    }

    /// The centres in the cells around `cell` that `taken` tells.
    #[inline]
    fn centres_near(&self, cell: Cell, mut taken: u32) -> impl Iterator<Item = DVec2> {
        let corner = usize::from(cell.row) * self.stride + usize::from(cell.column);
        std::iter::from_fn(move || {
            let neighbour = self.neighbours.get(taken.trailing_zeros() as usize)?;
            taken &= taken - 1;
            Some(self.centres[corner + neighbour].place())
        })
    }
}

impl Centre {
    #[inline]
    fn place(&self) -> DVec2 {
        let [x, y] = [&self.0[0], &self.0[1]].map(|bits| bits.load(Ordering::Relaxed));
        DVec2::new(f64::from_bits(x), f64::from_bits(y))
    }

    fn move_to(&self, place: DVec2) {
        self.0[0].store(place.x.to_bits(), Ordering::Relaxed);
        self.0[1].store(place.y.to_bits(), Ordering::Relaxed);
    }
}

/// Makes the moments long in which a centre is entered only in part, for tests of the order in which
/// threads see it.
#[cfg(test)]
pub(super) mod delay {
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::time::Duration;

    static LONG: AtomicBool = AtomicBool::new(false);

    /// Calls `f` with slow entries.
    pub(crate) fn with_slow_entries<T>(f: impl FnOnce() -> T) -> T {
        LONG.store(true, Ordering::Relaxed);
        let value = f();
        LONG.store(false, Ordering::Relaxed);
        value
    }

    pub(super) fn pause() {
        if LONG.load(Ordering::Relaxed) {
            std::thread::sleep(Duration::from_micros(50));
        }
    }
}
