//! Disks on the torus in a grid whose cells hold at most one centre.

use bn_core::DVec2;

use crate::SampleError;
use crate::error::reserve;

/// Places that keep a minimum distance, in a grid of square cells with a diagonal of at most that
/// distance, so that a cell holds at most one.
///
/// The grid is padded by copies of the cells beyond the seam, with coordinates to match: queries
/// never wrap.
#[derive(Debug)]
pub(crate) struct DiskGrid {
    /// Cells per side of the unit square.
    side: usize,
    /// Cells per row, padding included.
    stride: usize,
    radius_squared: f64,
    /// The centre in each cell; infinitely far away if there is none.
    centres: Vec<DVec2>,
}

/// A cell of the unit square, counted from the lower left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Cell {
    pub(crate) column: u16,
    pub(crate) row: u16,
}

/// An axis-parallel square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Square {
    pub(crate) centre: DVec2,
    pub(crate) half_side: f64,
}

/// Cells that a disk may reach over to either side of its own, and width of the padding.
///
/// Enough: a radius is less than √2 + radius cells, at most 2 from radius 0.58 downwards; above it
/// there are 2 or 3 cells a side, and the copy of a centre nearest to a point, at most ½ away in
/// each axis, lies within 2 cells.
const REACH: usize = 2;
/// Cells in a row of a neighbourhood.
const WIDTH: usize = 2 * REACH + 1;
/// Cells in a neighbourhood.
pub(crate) const NEIGHBOURHOOD: usize = WIDTH * WIDTH;

/// Above the torus's diameter √½ only one disk fits, whatever the radius.
const LARGEST_RADIUS: f64 = 0.75;

/// Copies beyond the seam are rounded to 2⁻⁵²: a radius this much larger makes up for it.
const ROUNDING: f64 = 1e-15;

impl DiskGrid {
    /// An empty grid for centres at least `radius` > 0 apart; `n` is for the error only.
    ///
    /// Memory: 16 bytes for each of about 2/radius² cells.
    pub(crate) fn new(radius: f64, n: usize) -> Result<Self, SampleError> {
        let radius = (radius + ROUNDING).min(LARGEST_RADIUS);
        let side = (std::f64::consts::SQRT_2 / radius * (1.0 + ROUNDING)).ceil();
        if side > f64::from(u16::MAX) {
            return Err(SampleError::OutOfMemory { n });
        }
        let side = side as usize;
        let stride = side + 2 * REACH;
        let mut centres = reserve(stride * stride)?;
        centres.resize(stride * stride, DVec2::INFINITY);
        Ok(Self { side, stride, radius_squared: radius * radius, centres })
    }

    /// Cells per side of the unit square.
    pub(crate) fn side(&self) -> u16 {
        self.side as u16
    }

    /// Reads the surroundings of `cell`, so that they are at hand soon after.
    #[inline]
    pub(crate) fn fetch(&self, cell: Cell) {
        for row in self.rows(cell) {
            std::hint::black_box(row[0].x);
            std::hint::black_box(row[WIDTH - 1].x);
        }
    }

    /// Whether the disk around `centre` covers `p`.
    #[inline]
    pub(crate) fn covers_point(&self, centre: DVec2, p: DVec2) -> bool {
        (centre - p).length_squared() < self.radius_squared
    }

    /// Whether the disk around `centre` covers all of `square`.
    #[inline]
    pub(crate) fn covers(&self, centre: DVec2, square: Square) -> bool {
        let farthest = (centre - square.centre).abs() + DVec2::splat(square.half_side);
        farthest.length_squared() < self.radius_squared
    }

    /// Whether the disk around `centre` covers any of `square`.
    #[inline]
    fn touches(&self, centre: DVec2, square: Square) -> bool {
        let nearest = (centre - square.centre).abs() - DVec2::splat(square.half_side);
        nearest.max(DVec2::ZERO).length_squared() < self.radius_squared
    }

    /// A centre nearer than the radius to `p`, which lies in `cell`.
    #[inline]
    pub(crate) fn conflict(&self, p: DVec2, cell: Cell) -> Option<DVec2> {
        for row in self.rows(cell) {
            // No branch within a row: where the conflict is cannot be predicted.
            let mut hit = None;
            for &centre in row {
                hit = if self.covers_point(centre, p) { Some(centre) } else { hit };
            }
            if hit.is_some() {
                return hit;
            }
        }
        None
    }

    /// The centres whose disks cover some of `square`, which lies in `cell`: the list's beginning,
    /// whose length is returned.
    #[inline]
    pub(crate) fn touching(
        &self,
        square: Square,
        cell: Cell,
        list: &mut [DVec2; NEIGHBOURHOOD + 1],
    ) -> usize {
        let mut count = 0;
        for row in self.rows(cell) {
            for &centre in row {
                list[count] = centre;
                count += usize::from(self.touches(centre, square));
            }
        }
        count
    }

    /// Enters a centre that has no conflict and lies in `cell`.
    pub(crate) fn insert(&mut self, p: DVec2, cell: Cell) {
        for (row, dy) in self.copies(cell.row.into()) {
            for (column, dx) in self.copies(cell.column.into()) {
                self.centres[row * self.stride + column] = p + DVec2::new(dx, dy);
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

    /// The rows of cells that a disk around a point of `cell` may reach, the nearest first.
    #[inline]
    fn rows(&self, cell: Cell) -> [&[DVec2; WIDTH]; WIDTH] {
        let corner = usize::from(cell.row) * self.stride + usize::from(cell.column);
        [2, 1, 3, 0, 4].map(|row| {
            let cells = self.centres[corner + row * self.stride..].first_chunk();
            cells.expect("a cell of the unit square has neighbours in the padding")
        })
    }
}
