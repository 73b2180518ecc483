//! Throwing darts only where there may be room.

use bn_core::{DVec2, Observer, Progress, Seed, StreamRng, torus};
use rand::Rng;

use super::disk_grid::{Cell, DiskGrid, NEIGHBOURHOOD, Square};
use crate::SampleError;
use crate::error::{observe, reserve};

/// Throws darts at a torus of disks until a count is reached or provably nothing is free.
///
/// The squares that may hold free places are kept in a list, all of one size: a flat quadtree
/// (M. S. Ebeida et al., "A simple algorithm for maximal Poisson-disk sampling in high
/// dimensions", Comput. Graph. Forum 31(2), 2012; K. White et al., "Poisson disk point sets by
/// hierarchical dart throwing", 2007). A dart is uniform in their union, so an accepted one is
/// uniform in what is free, exactly as if darts were thrown at the whole torus. Squares that a
/// disk is seen to cover leave the list; after a round of darts the others are quartered.
pub(crate) struct Thrower {
    grid: DiskGrid,
    points: Vec<DVec2>,
    /// The squares of this level, closed ones included: in order of place, so that going through
    /// them goes through memory.
    squares: Vec<Part>,
    /// Squares that are open still.
    left: usize,
    /// How often the squares have been quartered.
    level: u32,
    /// Side of a grid cell.
    cell_size: f64,
    /// Side of the squares.
    size: f64,
    darts: u64,
    rng: StreamRng,
}

/// A square, part of a grid cell, that may hold a free place unless it is closed.
#[derive(Clone, Copy, Debug)]
struct Part {
    cell: Cell,
    /// Place in the cell, in units of the square's side; `CLOSED` if nothing is free in it.
    column: u32,
    row: u32,
}

const CLOSED: u32 = u32::MAX;

/// How throwing ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ending {
    /// As many points as asked for were placed.
    Placed,
    /// No further point fits: every square is covered. `unresolved` squares of a size below
    /// 10⁻⁸ radii could not be proved to be.
    Full { unresolved: usize },
}

/// Squares of cell size × 2⁻³⁰ aren't quartered further: places in them differ by 10⁻⁹ radii.
const LAST_LEVEL: u32 = 30;

/// Darts that are thrown together.
const VOLLEY: usize = 16;

/// Volleys between two looks at the observer.
const VOLLEYS_PER_LOOK: u64 = 1 << 12;

/// Darts per square in each round; more miss, fewer leave more squares to quarter.
const DARTS_PER_SQUARE: f64 = 0.7;

impl Thrower {
    /// Throws at an empty torus, points at least `radius` > 0 apart (unit lengths); `expected`
    /// sizes the list of points.
    pub(crate) fn new(radius: f64, expected: usize, seed: Seed) -> Result<Self, SampleError> {
        let grid = DiskGrid::new(radius, expected)?;
        let mut squares = reserve(usize::from(grid.side()).pow(2))?;
        for row in 0..grid.side() {
            let cells = (0..grid.side()).map(|column| Cell { column, row });
            squares.extend(cells.map(|cell| Part { cell, column: 0, row: 0 }));
        }
        let cell_size = 1.0 / f64::from(grid.side());
        Ok(Self {
            grid,
            points: reserve(expected)?,
            left: squares.len(),
            squares,
            level: 0,
            cell_size,
            size: cell_size,
            darts: 0,
            rng: seed.stream(0),
        })
    }

    /// The points placed, in order.
    pub(crate) fn points(&self) -> &[DVec2] {
        &self.points
    }

    /// The points placed, in order, by value.
    pub(crate) fn into_points(self) -> Vec<DVec2> {
        self.points
    }

    /// Darts thrown so far.
    pub(crate) fn darts(&self) -> u64 {
        self.darts
    }

    /// Goes on until nothing is free or, if there is a `limit`, as many points are placed.
    pub(crate) fn throw(
        &mut self,
        limit: Option<usize>,
        observer: &dyn Observer,
    ) -> Result<Ending, SampleError> {
        let total = limit.map(|limit| limit as u64);
        let limit = limit.unwrap_or(usize::MAX);
        loop {
            let darts = DARTS_PER_SQUARE * self.squares.len() as f64;
            for volley in 0..(darts / VOLLEY as f64).ceil() as u64 {
                if volley % VOLLEYS_PER_LOOK == 0 {
                    let placed = self.points.len() as u64;
                    observe(observer, &Progress::new("throwing darts", placed, total))?;
                }
                self.throw_volley(limit);
                if self.points.len() == limit {
                    return Ok(Ending::Placed);
                }
                if self.left == 0 {
                    break;
                }
            }
            if self.left == 0 || self.level == LAST_LEVEL {
                return Ok(Ending::Full { unresolved: self.left });
            }
            self.quarter();
        }
    }

    /// Throws up to [`VOLLEY`] darts, none after there are `limit` points.
    ///
    /// The squares are chosen and their surroundings fetched before the first dart is thrown: the
    /// waits for memory overlap.
    fn throw_volley(&mut self, limit: usize) {
        let count = self.squares.len() as u128;
        let rng = &mut self.rng;
        let chosen = [(); VOLLEY].map(|()| ((u128::from(rng.next_u64()) * count) >> 64) as usize);
        for index in chosen {
            self.grid.fetch(self.squares[index].cell);
        }
        for index in chosen {
            // A choice among all squares, if of an open one, is a choice among the open ones.
            if self.points.len() < limit && self.squares[index].column != CLOSED {
                self.throw_dart(index);
            }
        }
    }

    /// Throws a dart at one of the squares.
    fn throw_dart(&mut self, index: usize) {
        self.darts += 1;
        let part = self.squares[index];
        let square = self.square(&part);
        // 2³² places a side: finer than any square needs, and squares get smaller.
        let place = |bits: u32| (f64::from(bits) * 2.0_f64.powi(-32) - 0.5) * self.size;
        let bits = self.rng.next_u64();
        let dart = square.centre + DVec2::new(place(bits as u32), place((bits >> 32) as u32));
        let dart = dart.clamp(DVec2::ZERO, DVec2::splat(torus::ONE_MINUS_EPSILON));
        let conflict = self.grid.conflict(dart, part.cell);
        if conflict.is_none() {
            self.grid.insert(dart, part.cell);
            self.points.push(dart);
        }
        // A cell with a centre is covered, and so is all of it.
        if conflict.is_none_or(|centre| self.grid.covers(centre, square)) {
            self.squares[index].column = CLOSED;
            self.left -= 1;
        }
    }

    #[inline]
    fn square(&self, part: &Part) -> Square {
        let along = |cell: u16, within: u32| {
            f64::from(cell) * self.cell_size + (f64::from(within) + 0.5) * self.size
        };
        let Part { cell, column, row } = *part;
        let centre = DVec2::new(along(cell.column, column), along(cell.row, row));
        Square { centre, half_side: 0.5 * self.size }
    }

    /// Replaces each open square by those of its quarters that no disk alone covers.
    fn quarter(&mut self) {
        let half_side = 0.25 * self.size;
        let mut quarters = Vec::new();
        let mut near = [DVec2::INFINITY; NEIGHBOURHOOD + 1];
        for part in self.squares.iter().filter(|part| part.column != CLOSED) {
            let square = self.square(part);
            let count = self.grid.touching(square, part.cell, &mut near);
            let is_covered = |square| near[..count].iter().any(|&c| self.grid.covers(c, square));
            if is_covered(square) {
                continue;
            }
            for (right, up) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let side = |far: u32| if far == 1 { half_side } else { -half_side };
                let centre = square.centre + DVec2::new(side(right), side(up));
                if !is_covered(Square { centre, half_side }) {
                    let (column, row) = (2 * part.column + right, 2 * part.row + up);
                    quarters.push(Part { cell: part.cell, column, row });
                }
            }
        }
        self.left = quarters.len();
        self.squares = quarters;
        self.level += 1;
        self.size *= 0.5;
    }
}
