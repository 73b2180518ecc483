//! Throwing darts only where there may be room.

use bn_core::{DVec2, Observer, Progress, Seed};
use rayon::prelude::*;

use super::contest::Contest;
use super::disk_grid::{Cell, DiskGrid};
use super::tile::{Fate, Level, Tile};
use crate::SampleError;
use crate::error::{observe, reserve};

/// Throws darts at a torus of disks until a count is reached or provably nothing is free.
///
/// The squares that may hold free places are kept in lists, all of one size: a flat quadtree
/// (M. S. Ebeida et al., "A simple algorithm for maximal Poisson-disk sampling in high
/// dimensions", Comput. Graph. Forum 31(2), 2012; K. White et al., "Poisson disk point sets by
/// hierarchical dart throwing", 2007). A dart is uniform in their union, so one that sticks is
/// uniform in what is free, exactly as if darts were thrown at the whole torus. After each volley
/// of darts the squares are quartered, and those that a disk is seen to cover leave the lists.
///
/// The torus is divided into tiles that fit into a processor's cache and have their own random
/// streams; see [`Contest`] on how their darts keep the order of time.
pub(super) struct Thrower {
    grid: DiskGrid,
    /// Where the tiles begin, in each axis; the grid's side at last.
    bounds: Vec<u16>,
    tiles: Vec<Tile>,
    level: Level,
    points: Vec<DVec2>,
    darts: u64,
}

/// How throwing ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ending {
    /// As many points as asked for were placed.
    Placed,
    /// No further point fits: every square is covered. `unresolved` squares of a size below
    /// 10⁻⁸ radii could not be proved to be.
    Full { unresolved: usize },
}

/// Cells per side of a tile, about: 64 KiB of centres.
const TILE: u16 = 64;

/// Darts per square in a volley; more fall, fewer leave more squares to quarter.
const DARTS_PER_SQUARE: f64 = 0.7;

impl Thrower {
    /// Throws at an empty torus, points at least `radius` > 0 apart (unit lengths); `expected`
    /// sizes the list of points.
    pub(super) fn new(radius: f64, expected: usize, seed: Seed) -> Result<Self, SampleError> {
        let grid = DiskGrid::new(radius, expected)?;
        let across = u32::from(grid.side().div_ceil(TILE));
        let bound = |i| (i * u32::from(grid.side()) / across) as u16;
        let bounds: Vec<_> = (0..=across).map(bound).collect();
        let mut tiles = reserve((across * across) as usize)?;
        (0..across * across)
            .into_par_iter()
            .map(|index| {
                let (column, row) = ((index % across) as usize, (index / across) as usize);
                let first = Cell { column: bounds[column], row: bounds[row] };
                let end = Cell { column: bounds[column + 1], row: bounds[row + 1] };
                Tile::new(first, end, seed, index)
            })
            .collect_into_vec(&mut tiles);
        let level = Level::cells_of(&grid);
        Ok(Self { grid, bounds, tiles, level, points: reserve(expected)?, darts: 0 })
    }

    /// The points placed, in order.
    pub(super) fn points(&self) -> &[DVec2] {
        &self.points
    }

    /// The points placed, in order, by value.
    pub(super) fn into_points(self) -> Vec<DVec2> {
        self.points
    }

    /// Darts thrown so far, all of the last volley counted.
    pub(super) fn darts(&self) -> u64 {
        self.darts
    }

    /// Goes on until nothing is free or, if there is a `limit`, as many points are placed.
    pub(super) fn throw(
        &mut self,
        limit: Option<usize>,
        observer: &dyn Observer,
    ) -> Result<Ending, SampleError> {
        let total = limit.map(|limit| limit as u64);
        let limit = limit.unwrap_or(usize::MAX);
        loop {
            let placed = self.points.len() as u64;
            observe(observer, &Progress::new("throwing darts", placed, total))?;
            self.throw_volley();
            self.collect(limit)?;
            if self.points.len() == limit {
                return Ok(Ending::Placed);
            }
            let next = self.level.next();
            if next.is_some() {
                self.quarter();
            }
            let left = self.tiles.iter().map(Tile::squares).sum();
            match next {
                Some(next) if left > 0 => self.level = next,
                _ => return Ok(Ending::Full { unresolved: left }),
            }
        }
    }

    fn throw_volley(&mut self) {
        let (grid, level) = (&self.grid, self.level);
        let tiles = self.tiles.par_iter_mut();
        self.darts += tiles.map(|tile| tile.throw(grid, level, DARTS_PER_SQUARE)).sum::<u64>();
        let contest = Contest { grid, tiles: &self.tiles, bounds: &self.bounds };
        (0..self.tiles.len() as u32).into_par_iter().for_each(|tile| contest.settle(tile));
    }

    fn quarter(&mut self) {
        let (grid, level) = (&self.grid, self.level);
        let tiles = self.tiles.par_iter_mut();
        tiles.for_each_init(Vec::new, |scratch, tile| tile.quarter(grid, level, scratch));
    }

    /// Appends the darts that stick to the points, in the order of time, up to `limit`.
    fn collect(&mut self, limit: usize) -> Result<(), SampleError> {
        let count = self.tiles.iter().map(|tile| tile.darts().len()).sum();
        let mut order = reserve(count)?;
        let mut places = reserve(count)?;
        for dart in self.tiles.iter().flat_map(Tile::darts) {
            if dart.fate() == Fate::Sticks {
                order.push(u64::from(dart.time) << 32 | places.len() as u64);
                places.push(dart.place);
            }
        }
        order.sort_unstable();
        let room = limit - self.points.len();
        let places = order.into_iter().take(room).map(|key| places[key as u32 as usize]);
        self.points.extend(places);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::poisson_disk::disk_grid::delay::with_slow_entries;
    use bn_core::{Density, torus};

    /// What sticks is what sticks if the darts come one by one in the order of time, whatever the
    /// tiles; by brute force.
    #[test]
    fn tiles_keep_the_order_of_time() {
        // One tile, the fewest cells that make four, and 16 tiles.
        for (n, across) in [(300, 1), (1300, 2), (12_000, 4)] {
            let radius = 0.7 * Density::new(n).hexagonal_spacing();
            let mut thrower = Thrower::new(radius, n, Seed::new(3)).expect("room");
            assert_eq!(thrower.bounds.len(), across + 1);
            thrower.throw_volley();
            let mut darts = Vec::new();
            for (index, tile) in thrower.tiles.iter().enumerate() {
                darts.extend(tile.darts().iter().map(|dart| (dart.time, index, dart)));
            }
            darts.sort_by_key(|&(time, tile, _)| (time, tile));
            let mut stuck: Vec<DVec2> = Vec::new();
            for (_, _, dart) in darts {
                let falls = stuck.iter().any(|&p| torus::distance(p, dart.place) < radius);
                assert_eq!(dart.fate(), if falls { Fate::Falls } else { Fate::Sticks });
                if !falls {
                    stuck.push(dart.place);
                }
            }
            thrower.collect(usize::MAX).expect("room");
            assert!(stuck.len() > n / 2);
            assert_eq!(thrower.into_points(), stuck);
        }
    }

    /// Threads that find the same dart's fate at the same time agree.
    #[test]
    fn threads_agree() {
        let (n, radius) = (20_000, 0.8 * Density::new(20_000).hexagonal_spacing());
        let points = |threads: usize, seed| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let throw = || {
                let mut thrower = Thrower::new(radius, n, Seed::new(seed)).expect("room");
                thrower.throw(None, &bn_core::Unobserved).expect("not stopped");
                thrower.into_points()
            };
            pool.expect("threads").install(throw)
        };
        for seed in 0..12 {
            assert!(points(8, seed) == points(1, seed), "seed {seed}");
        }
        for seed in 0..3 {
            let slow = with_slow_entries(|| points(16, seed));
            assert!(slow == points(1, seed), "seed {seed}, slow entries");
        }
    }

    /// Counts of darts have the mean and the variance of a Poisson process.
    #[test]
    fn volleys_are_poisson_processes() {
        let runs = 2000_u32;
        let counts = (0..runs).map(|run| {
            let mut thrower = Thrower::new(0.1, 1, Seed::new(run.into())).expect("room");
            thrower.throw_volley();
            thrower.darts() as f64
        });
        let counts: Vec<_> = counts.collect();
        let mean = counts.iter().sum::<f64>() / f64::from(runs);
        let variance = counts.iter().map(|count| (count - mean).powi(2)).sum::<f64>();
        let variance = variance / f64::from(runs - 1);
        // 15² cells; five standard errors: of a mean √(m/runs), of a variance m·√(2/runs).
        let want = 225.0 * DARTS_PER_SQUARE;
        assert!((mean - want).abs() < 5.0 * (want / f64::from(runs)).sqrt(), "{mean}");
        assert!((variance / want - 1.0).abs() < 5.0 * (2.0 / f64::from(runs)).sqrt(), "{variance}");
    }
}
