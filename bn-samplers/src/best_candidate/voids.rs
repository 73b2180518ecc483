//! Where a new point would be farther than a given distance from all others.

use bn_core::{DVec2, StreamRng, torus};
use rand::{Rng, RngExt};

use crate::bucket_grid::{BucketGrid, disk_covers};

/// Squares that cover all places at least `radius` away from every point, and little else.
///
/// The radius is lowered all the time, by less and less as points get more. So the voids of lower
/// radii to come are kept too, in levels: each is looked for in the squares of the one before, which
/// are few.
#[derive(Debug)]
pub(super) struct Voids {
    /// Of ascending radius, the last being the voids' own; never empty.
    levels: Vec<Level>,
    /// By which part of it the radius is lowered next.
    step: f64,
}

/// The voids of a radius, and perhaps more: points may have come since they were looked for.
#[derive(Debug)]
struct Level {
    radius: f64,
    squares: Squares,
}

/// Equal squares.
#[derive(Clone, Debug)]
struct Squares {
    half_side: f64,
    centres: Vec<DVec2>,
}

/// The coarse squares' side is at most the radius over this.
const FINENESS: f64 = 16.0;
/// From there on quartering goes on while it leaves less than this part of the squares' area: the
/// more points there are, the smaller are the voids where one of many candidates is best.
const WORTHWHILE: f64 = 0.45;
/// The finest squares, as [`FINENESS`].
const FINEST: f64 = 65_536.0;
/// The lowest level's radius over that of the voids when they are looked for everywhere.
const COARSER: f64 = 0.94;
/// Between levels with fewer squares than this there are no others.
const FEW: usize = 64;
/// By these parts the radius is lowered, at least and at most.
const STEPS: (f64, f64) = (1e-7, 0.04);
/// So many candidates in the squares of a lowered radius are neither too few nor too many.
const DRAWS: (f64, f64) = (48.0, 160.0);

impl Squares {
    /// The voids of this radius, below ¼, in squares of which no disk alone covers any.
    fn around_voids(points: &BucketGrid, radius: f64) -> Self {
        let side = (1.0 / radius).ceil() as usize;
        let half_side = 0.5 / side as f64;
        let along = |i: usize| (2 * i + 1) as f64 * half_side;
        let all = (0..side * side).map(|i| DVec2::new(along(i % side), along(i / side)));
        let mut squares = Self { half_side, centres: all.collect() };
        squares.keep_open(points, radius);
        while 2.0 * squares.half_side > radius / FINENESS {
            squares = squares.quartered(points, radius);
        }
        squares
    }

    fn keep_open(&mut self, points: &BucketGrid, radius: f64) {
        let half_side = self.half_side;
        self.centres.retain(|&centre| !points.any_covers(centre, half_side, radius));
    }

    /// The quarters that no disk alone covers.
    fn quartered(&self, points: &BucketGrid, radius: f64) -> Self {
        let h = 0.5 * self.half_side;
        let quarters = |&centre: &DVec2| {
            [(-h, -h), (h, -h), (-h, h), (h, h)].map(|(x, y)| centre + DVec2::new(x, y))
        };
        let mut quarters =
            Self { half_side: h, centres: self.centres.iter().flat_map(quarters).collect() };
        quarters.keep_open(points, radius);
        quarters
    }

    /// Their share of the torus.
    fn area(&self) -> f64 {
        (2.0 * self.half_side).powi(2) * self.centres.len() as f64
    }
}

impl Level {
    /// The level of a higher radius, in squares so small that no more of `count` candidates than
    /// needed fall in them.
    fn above(&self, points: &BucketGrid, radius: f64, count: f64) -> Self {
        let mut squares = self.squares.clone();
        squares.keep_open(points, radius);
        while count * squares.area() > DRAWS.1 && 2.0 * squares.half_side > radius / FINEST {
            let finer = squares.quartered(points, radius);
            let is_worthwhile = finer.area() < WORTHWHILE * squares.area();
            squares = finer;
            if !is_worthwhile {
                break;
            }
        }
        Self { radius, squares }
    }
}

impl Voids {
    /// The voids of a pattern, for `count` candidates; `radius` below ¼.
    pub(super) fn new(points: &BucketGrid, radius: f64, count: f64) -> Self {
        let mut voids = Self { levels: Vec::new(), step: STEPS.1 };
        voids.look(points, radius, count);
        voids
    }

    /// Lowers the radius until voids are large enough for `count` candidates, with the points that
    /// have come meanwhile.
    pub(super) fn lower(&mut self, points: &BucketGrid, count: f64) {
        self.look(points, self.radius() * (1.0 - self.step), count);
        let draws = count * self.area();
        if draws > DRAWS.1 {
            self.step = (0.5 * self.step).max(STEPS.0);
        } else if draws < DRAWS.0 {
            self.step = (2.0 * self.step).min(STEPS.1);
        }
    }

    /// Looks for the voids of `radius`, lower than before: in the highest level that has them all,
    /// with levels in between at half the way each time.
    fn look(&mut self, points: &BucketGrid, radius: f64, count: f64) {
        while self.levels.last().is_some_and(|level| level.radius > radius) {
            self.levels.pop();
        }
        if self.levels.is_empty() {
            let coarse = COARSER * radius;
            self.levels
                .push(Level { radius: coarse, squares: Squares::around_voids(points, coarse) });
        }
        while let below = self.top()
            && below.radius < radius
        {
            let gap = radius - below.radius;
            let is_wide = gap > 2.0 * self.step * radius && below.squares.centres.len() > FEW;
            let next = if is_wide { below.radius + 0.5 * gap } else { radius };
            let level = below.above(points, next, count);
            self.levels.push(level);
        }
    }

    fn top(&self) -> &Level {
        self.levels.last().expect("there is a level")
    }

    /// The distance that all voids have from the points.
    pub(super) fn radius(&self) -> f64 {
        self.top().radius
    }

    /// The squares' share of the torus.
    pub(super) fn area(&self) -> f64 {
        self.top().squares.area()
    }

    /// A uniform random place in the squares, and the number of its square.
    ///
    /// # Panics
    /// If there is no square.
    pub(super) fn draw(&self, rng: &mut StreamRng) -> (DVec2, usize) {
        let Squares { half_side, centres } = &self.top().squares;
        let index = ((u128::from(rng.next_u64()) * centres.len() as u128) >> 64) as usize;
        let place = |random: f64| (2.0 * random - 1.0) * half_side;
        let p = centres[index] + DVec2::new(place(rng.random()), place(rng.random()));
        (torus::wrap_point(p), index)
    }

    /// Whether the disk around `point` covers the square, which then holds no void.
    pub(super) fn is_covered(&self, index: usize, point: DVec2) -> bool {
        let Squares { half_side, centres } = &self.top().squares;
        disk_covers(point, self.radius(), centres[index], *half_side)
    }

    /// Leaves out the squares of these numbers.
    pub(super) fn remove(&mut self, indices: &mut Vec<usize>) {
        indices.sort_unstable();
        indices.dedup();
        let top = self.levels.last_mut().expect("there is a level");
        // From the last on, so that what fills a gap isn't to be removed itself.
        for index in indices.drain(..).rev() {
            top.squares.centres.swap_remove(index);
        }
    }
}
