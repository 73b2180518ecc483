//! A block of grid cells: the squares in it that may hold free places, and darts thrown at them.

use std::sync::atomic::{AtomicU8, Ordering};

use bn_core::{DVec2, Seed, StreamRng, torus};
use rand::{Rng, RngExt};
use rand_distr::Exp1;

use super::disk_grid::{Cell, DiskGrid, Square};

/// A block of grid cells with what may be free in it.
#[derive(Debug)]
pub(super) struct Tile {
    /// The block's cells: from `first` on, up to but without `end`.
    first: Cell,
    end: Cell,
    /// The squares that may hold free places, parts of the cells.
    squares: Vec<Part>,
    /// The darts of the present volley that no earlier disk covers, in the order of time.
    darts: Vec<Dart>,
    /// The last dart of each cell; `NONE` if there is none.
    last_in_cell: Vec<u32>,
    rng: StreamRng,
}

/// A square within a grid cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    cell: Cell,
    /// Place in the cell, in units of the square's side.
    column: u32,
    row: u32,
}

/// A dart of the present volley.
#[derive(Debug)]
pub(super) struct Dart {
    pub(super) place: DVec2,
    pub(super) cell: Cell,
    /// When it is thrown, in units of the volley's duration over 2³².
    pub(super) time: u32,
    /// The dart before it in its cell; `NONE` if it is the first.
    previous: u32,
    fate: AtomicU8,
}

const NONE: u32 = u32::MAX;

/// What becomes of a dart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fate {
    /// Not known yet.
    Open,
    /// It makes a point, and a thread is entering it into the grid: some of its copies may be
    /// missing.
    Entering,
    /// It makes a point.
    Sticks,
    /// A disk covers it.
    Falls,
}

impl Tile {
    /// The cells from `first` up to but without `end`, all of which may hold free places.
    pub(super) fn new(first: Cell, end: Cell, seed: Seed, index: u32) -> Self {
        let whole = |row| {
            let cells = (first.column..end.column).map(move |column| Cell { column, row });
            cells.map(|cell| Part { cell, column: 0, row: 0 })
        };
        let squares: Vec<_> = (first.row..end.row).flat_map(whole).collect();
        let last_in_cell = vec![NONE; squares.len()];
        Self { first, end, squares, darts: Vec::new(), last_in_cell, rng: seed.stream(index) }
    }

    /// Squares that may hold free places.
    pub(super) fn squares(&self) -> usize {
        self.squares.len()
    }

    /// The darts of the present volley that no earlier disk covers, in the order of time.
    pub(super) fn darts(&self) -> &[Dart] {
        &self.darts
    }

    /// Whether all cells within `reach` of this one are in the tile.
    pub(super) fn has_inside(&self, cell: Cell, reach: u16) -> bool {
        let within = |first: u16, at: u16, end: u16| first + reach <= at && at + reach < end;
        within(self.first.column, cell.column, self.end.column)
            && within(self.first.row, cell.row, self.end.row)
    }

    /// The darts in a cell of this tile with their numbers, the latest first.
    pub(super) fn darts_in(&self, cell: Cell) -> impl Iterator<Item = (u32, &Dart)> {
        let named = |index: u32| self.darts.get(index as usize).map(|dart| (index, dart));
        let last = self.last_in_cell[self.place_of(cell)];
        std::iter::successors(named(last), move |(_, dart)| named(dart.previous))
    }

    fn place_of(&self, cell: Cell) -> usize {
        let width = usize::from(self.end.column - self.first.column);
        usize::from(cell.row - self.first.row) * width
            + usize::from(cell.column - self.first.column)
    }

    /// Throws a volley of `darts_per_square` on average: a Poisson process in space and time, so
    /// that the darts in the order of time are independent, each uniform in the squares.
    /// Returns how many were thrown.
    pub(super) fn throw(&mut self, grid: &DiskGrid, level: Level, darts_per_square: f64) -> u64 {
        self.forget_darts();
        let count = self.squares.len() as u64;
        let pause = 1.0 / (darts_per_square * count as f64);
        let mut thrown = 0;
        let mut time = 0.0;
        loop {
            let waiting: f64 = self.rng.sample(Exp1);
            time += waiting * pause;
            // No square, no dart: the pause is infinite.
            if time >= 1.0 {
                break;
            }
            thrown += 1;
            let index = (u64::from(self.rng.next_u32()) * count) >> 32;
            let part = self.squares[index as usize];
            let place = level.place_in(&part, self.rng.next_u64());
            if !grid.covers_place(place, part.cell) {
                self.add_dart(place, part.cell, (time * 2.0_f64.powi(32)) as u32);
            }
        }
        thrown
    }

    fn forget_darts(&mut self) {
        for i in 0..self.darts.len() {
            let place = self.place_of(self.darts[i].cell);
            self.last_in_cell[place] = NONE;
        }
        self.darts.clear();
    }

    fn add_dart(&mut self, place: DVec2, cell: Cell, time: u32) {
        let last = self.place_of(cell);
        let previous = std::mem::replace(&mut self.last_in_cell[last], self.darts.len() as u32);
        self.darts.push(Dart { place, cell, time, previous, fate: AtomicU8::new(0) });
    }

    /// Replaces each square of this level by those of its quarters that no disk alone covers.
    /// `quarters` is scratch memory.
    pub(super) fn quarter(&mut self, grid: &DiskGrid, level: Level, quarters: &mut Vec<Part>) {
        let mut count = 0;
        for part in &self.squares {
            quarters.resize(quarters.len().max(count + 4), *part);
            let covered = grid.covered_quarters(level.square(part), part.cell);
            for (quarter, covered) in (0..).zip(covered) {
                let (column, row) =
                    (2 * part.column + (quarter & 1), 2 * part.row + (quarter >> 1));
                // Written in any case: whether it counts cannot be predicted.
                quarters[count] = Part { cell: part.cell, column, row };
                count += usize::from(!covered);
            }
        }
        self.squares.clear();
        self.squares.extend_from_slice(&quarters[..count]);
    }
}

impl Dart {
    /// What is known of its fate.
    pub(super) fn fate(&self) -> Fate {
        match self.fate.load(Ordering::Acquire) {
            0 => Fate::Open,
            1 => Fate::Entering,
            2 => Fate::Sticks,
            _ => Fate::Falls,
        }
    }

    /// Whether its fate is known and, if it sticks, all of its disk is in the grid.
    pub(super) fn is_settled(&self) -> bool {
        matches!(self.fate(), Fate::Sticks | Fate::Falls)
    }

    /// Notes that it sticks, if its fate was open: the caller, and nobody else, has to enter it into
    /// the grid and to [`stick`](Self::stick) it.
    pub(super) fn claim(&self) -> bool {
        self.leave_open(Fate::Entering)
    }

    /// Notes that it is in the grid.
    pub(super) fn stick(&self) {
        self.fate.store(Fate::Sticks as u8, Ordering::Release);
    }

    /// Notes that a disk covers it.
    ///
    /// That may be its own: while this thread asked the grid, another one may have found that the
    /// dart sticks. Hence that finding stands.
    pub(super) fn fall(&self) {
        self.leave_open(Fate::Falls);
    }

    fn leave_open(&self, fate: Fate) -> bool {
        let open = Fate::Open as u8;
        self.fate.compare_exchange(open, fate as u8, Ordering::AcqRel, Ordering::Acquire).is_ok()
    }

    /// Waits while another thread enters it: a few dozen instructions, unless that thread is
    /// interrupted.
    pub(super) fn wait_until_entered(&self) {
        while self.fate() == Fate::Entering {
            std::thread::yield_now();
        }
    }
}

/// How far the cells have been quartered, the same everywhere.
#[derive(Clone, Copy, Debug)]
pub(super) struct Level {
    /// Side of a grid cell.
    cell_size: f64,
    /// Side of the squares.
    size: f64,
    quarterings: u32,
}

/// Squares of cell size × 2⁻³⁰ aren't quartered further: places in them differ by 10⁻⁹ radii.
const LAST_LEVEL: u32 = 30;

impl Level {
    /// Squares that are whole cells.
    pub(super) fn cells_of(grid: &DiskGrid) -> Self {
        let cell_size = 1.0 / f64::from(grid.side());
        Self { cell_size, size: cell_size, quarterings: 0 }
    }

    /// The quarters of this level's squares; none if they are too small.
    pub(super) fn next(self) -> Option<Self> {
        let quarterings = self.quarterings + 1;
        (quarterings <= LAST_LEVEL).then_some(Self { size: 0.5 * self.size, quarterings, ..self })
    }

    #[inline]
    fn square(self, part: &Part) -> Square {
        let along = |cell: u16, within: u32| {
            f64::from(cell) * self.cell_size + (f64::from(within) + 0.5) * self.size
        };
        let Part { cell, column, row } = *part;
        let centre = DVec2::new(along(cell.column, column), along(cell.row, row));
        Square { centre, half_side: 0.5 * self.size }
    }

    /// A place in a square from 64 random bits.
    #[inline]
    fn place_in(self, part: &Part, bits: u64) -> DVec2 {
        // 2³² places a side: finer than any square needs, and squares get smaller.
        let along = |bits: u32| (f64::from(bits) * 2.0_f64.powi(-32) - 0.5) * self.size;
        let offset = DVec2::new(along(bits as u32), along((bits >> 32) as u32));
        let place = self.square(part).centre + offset;
        place.clamp(DVec2::ZERO, DVec2::splat(torus::ONE_MINUS_EPSILON))
    }
}
