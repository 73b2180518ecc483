//! Farthest points within blocks: many at a time, without a triangulation of the whole.

use bn_core::{CellGrid, DVec2, Density, PointSet, torus};
use bn_geometry::Spacing;
use rayon::prelude::*;

use super::arrangement::{Arrangement, Moves, Search, Spread};
use super::field::{Field, Hole, hole_between};
use super::swarm::{Order, Swarm};

/// Squares a side of the inside of a block, whose points move; a frame of one more square around it
/// holds points that stay.
///
/// Chen and Gotsman move the points of one square in the 3 × 3 squares around it. With more squares
/// inside, each triangulation serves more points: 36 squares' points are triangulated for 16
/// squares' moves, rather than nine for one.
const INSIDE: usize = 4;
const BLOCK: usize = INSIDE + 2;

/// The least side of a square in `d_hex`: above the radius of all holes of random points, so that
/// nearly every hole that a point can find is whole.
const SQUARE: f64 = 3.5;

/// How often each point is visited before the next blocks' turn: triangulating costs as much as some
/// two visits. Repeated visits also have the blocks near their best before their neighbours change,
/// which ends in better patterns: at n = 4096 `d_avg` 0.9345 rather than 0.9335 after one visit each
/// time, and `d_min` 0.931 to 0.933 when run to convergence.
const VISITS: usize = 16;

/// The points, and how the torus is divided.
///
/// Every second block in each direction is worked on at the same time: those don't overlap, so they
/// cannot disturb each other as long as a point moves to holes alone whose whole disk lies in its
/// block.
#[derive(Debug)]
pub(super) struct Blocks<F> {
    field: F,
    order: Order,
    points: Vec<DVec2>,
    /// Squares a side of the torus: a multiple of 2·`INSIDE`.
    side: usize,
}

impl<F: Field + Sync> Blocks<F> {
    /// Whether so many points can be divided into blocks.
    pub(super) fn can_divide(n: usize) -> bool {
        squares(n) > 0
    }

    pub(super) fn new(start: &[DVec2], field: F, order: Order) -> Self {
        Self { field, order, points: start.to_vec(), side: squares(start.len()) }
    }

    /// The points as they are, on the whole torus.
    pub(super) fn to_swarm(&self) -> Swarm<F>
    where
        F: Clone,
    {
        Swarm::new(&self.points, self.field.clone(), self.order)
    }

    fn set(&self) -> PointSet {
        PointSet::new(self.points.clone()).expect("points of the unit torus")
    }

    /// Where the points go in the block whose inside starts at this square, and how far.
    fn optimize(&self, grid: &CellGrid, corner: (usize, usize), search: Search) -> Change {
        let block = Block { corner, side: self.side };
        let (names, places) = block.gather(grid);
        if places.is_empty() {
            return Change::default();
        }
        let field = InBlock { field: &self.field, block };
        let mut swarm = Swarm::new(&places, field, self.order);
        let before = swarm.points();
        let mut moves = Moves::default();
        for _ in 0..VISITS {
            moves = moves.and(swarm.visit_where(search, Block::is_inside));
        }
        let pairs = before.into_iter().zip(swarm.points());
        let moved = names.into_iter().zip(pairs).filter(|(_, (before, after))| before != after);
        let places: Vec<_> =
            moved.map(|(name, (_, after))| (name, block.to_torus(after))).collect();
        let longest = moves.longest * block.side_length();
        Change { moves: Moves { count: places.len(), longest }, places }
    }
}

/// What changed in a block.
#[derive(Debug, Default)]
struct Change {
    /// Each point that moved once, and the longest of its moves.
    moves: Moves,
    /// Indices of points, and where they are now.
    places: Vec<(u32, DVec2)>,
}

/// Squares a side of the torus for n points; 0 if they are too few.
fn squares(n: usize) -> usize {
    let unit = 2 * INSIDE;
    let least = SQUARE * Density::new(n).hexagonal_spacing();
    (1.0 / (least * unit as f64)) as usize * unit
}

impl<F: Field + Sync> Arrangement for Blocks<F> {
    fn points(&self) -> Vec<DVec2> {
        self.points.clone()
    }

    fn spread(&self) -> Spread {
        let spacing = Spacing::new(&self.set());
        Spread::new(spacing.nearest_distances(), self.points.iter().copied(), &self.field)
    }

    fn sweep(&mut self, search: Search, _: f64) -> Moves {
        let mut moves = Moves::default();
        for phase in [(0, 0), (1, 1), (1, 0), (0, 1)] {
            let grid = CellGrid::with_cells_per_side(&self.set(), self.side);
            let each = self.side / (2 * INSIDE);
            let start = |i: usize, odd: usize| (2 * i + odd) * INSIDE;
            let corner = |i: usize| (start(i % each, phase.0), start(i / each, phase.1));
            let changes: Vec<Change> = (0..each * each)
                .into_par_iter()
                .map(|i| self.optimize(&grid, corner(i), search))
                .collect();
            for change in changes {
                moves = moves.and(change.moves);
                for (name, place) in change.places {
                    self.points[name as usize] = place;
                }
            }
        }
        // Those that moved in several blocks count once.
        Moves { count: moves.count.min(self.points.len()), ..moves }
    }
}

/// A block, whose own coordinates run from 0 to 1.
#[derive(Clone, Copy, Debug)]
struct Block {
    /// The first square of the inside.
    corner: (usize, usize),
    /// Squares a side of the torus.
    side: usize,
}

impl Block {
    /// The points in the block, and where they are in it.
    fn gather(self, grid: &CellGrid) -> (Vec<u32>, Vec<DVec2>) {
        let (mut names, mut places) = (Vec::new(), Vec::new());
        for row in 0..BLOCK {
            for column in 0..BLOCK {
                let x = self.square(self.corner.0, column);
                let y = self.square(self.corner.1, row);
                let cell = grid.cell(x, y);
                names.extend_from_slice(cell.indices);
                let place = |p: &DVec2| {
                    let within = *p * self.side as f64 - DVec2::new(x as f64, y as f64);
                    let place = DVec2::new(column as f64, row as f64) + within;
                    (place / BLOCK as f64)
                        .clamp(DVec2::ZERO, DVec2::splat(torus::ONE_MINUS_EPSILON))
                };
                places.extend(cell.points.iter().map(place));
            }
        }
        (names, places)
    }

    /// The number on the torus of a block's row or column of squares.
    fn square(self, corner: usize, i: usize) -> usize {
        (corner + self.side - 1 + i) % self.side
    }

    /// The side of the block.
    fn side_length(self) -> f64 {
        BLOCK as f64 / self.side as f64
    }

    fn to_torus(self, p: DVec2) -> DVec2 {
        let corner = DVec2::new(self.corner.0 as f64, self.corner.1 as f64) - 1.0;
        torus::wrap_point((corner + p * BLOCK as f64) / self.side as f64)
    }

    fn is_inside(p: DVec2) -> bool {
        let last = (BLOCK - 1) as f64 / BLOCK as f64;
        FRAME <= p.min_element() && p.max_element() < last
    }
}

/// The width of a square in a block's coordinates.
const FRAME: f64 = 1.0 / BLOCK as f64;

/// The field as it is seen in a block, which is triangulated as if it were a torus of its own: circles
/// that leave it are no holes.
#[derive(Debug)]
struct InBlock<'a, F> {
    field: &'a F,
    block: Block,
}

impl<F: Field> Field for InBlock<'_, F> {
    const IS_EVEN: bool = F::IS_EVEN;

    #[inline]
    fn root(&self, p: DVec2) -> f64 {
        self.field.root(self.block.to_torus(p))
    }

    fn least_root(&self) -> f64 {
        self.field.least_root()
    }

    #[inline]
    fn hole(&self, origin: DVec2, corners: [DVec2; 3]) -> Hole {
        let Hole { center, size } = hole_between(self, origin, corners);
        let place = origin + center;
        let to_border = place.min_element().min(1.0 - place.max_element());
        let reach = corners.iter().map(|corner| corner.distance_squared(center));
        let reach = reach.fold(0.0, f64::max);
        let is_whole = to_border > 0.0 && reach < to_border * to_border;
        Hole { center, size: if is_whole { size } else { 0.0 } }
    }

    /// Beyond the frame the neighbours are copies that only the block's own torus has: a point that
    /// is so far from all others stays.
    #[inline]
    fn distance_squared(&self, origin: DVec2, way: DVec2) -> f64 {
        if way.length_squared() > FRAME * FRAME {
            return f64::INFINITY;
        }
        let (here, there) = (self.root(origin), self.root(origin + way).max(self.least_root()));
        way.length_squared() * here * there
    }
}
