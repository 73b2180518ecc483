//! The bucket grid on the torus: the one neighbour search of the workbench.

mod probe;
mod sort;
mod tree;
mod walk;

use std::fmt;
use std::ops::{ControlFlow, Range};
use std::sync::OnceLock;

use glam::DVec2;

use crate::{PointSet, torus};
use probe::{Nearest, NearestK, Probe, VeryNear, Within};
use sort::Sorted;
use tree::Tree;

/// Points per cell that [`CellGrid::new`] aims at: with 2 a nearest neighbour lies in the 3×3 cells
/// around a point but for 1 in 500 points of a random set, and never in an even one.
const POINTS_PER_CELL: f64 = 2.0;

/// Where Σ c² over the cells' counts c exceeds this many times n, cells are so unevenly filled that
/// looking through them would cost more than the k-d tree does.
const CROWDED: u64 = 32;

/// The points of a set in m × m equal square cells of the unit torus, for neighbour queries.
///
/// Points and their indices in the set are copied in the order of cells (row by row, within a cell
/// in order of index), so that a query reads few and contiguous stretches of memory. Building
/// takes O(n + m²) time; the grid holds 20 bytes a point and 4 bytes a cell.
///
/// Distances are torus distances as [`torus::distance`] measures them, for any number of points and
/// any radius, points that coincide or are 1e-300 apart included.
///
/// Cost: [`nearest`](Self::nearest) looks at the cells that meet the empty disk around the query,
/// about 9 where the points are spread evenly, and asked for every point of the set at most O(n)
/// cells in total. In a badly clustered set (on the average over 32 points in a point's cell) every
/// search goes through a k-d tree instead, which the first of them builds once, in O(n log n).
/// What remains slow: a query far away from all points of a set that is not clustered looks at all
/// cells of the void that it lies in.
///
/// ```
/// use bn_core::{CellGrid, DVec2, PointSet};
///
/// let set = PointSet::new(vec![DVec2::new(0.05, 0.5), DVec2::new(0.9, 0.5), DVec2::ZERO])?;
/// let grid = CellGrid::new(&set);
/// let (neighbor, distance) = grid.nearest(set.points()[0], Some(0)).expect("not alone");
/// assert_eq!(neighbor, 1);
/// assert!((distance - 0.15).abs() < 1e-15);
/// # Ok::<(), bn_core::PointSetError>(())
/// ```
#[derive(Clone)]
pub struct CellGrid {
    cells_per_side: usize,
    /// Cell c holds `points[starts[c]..starts[c + 1]]`.
    starts: Vec<u32>,
    points: Vec<DVec2>,
    indices: Vec<u32>,
    crowded: bool,
    tree: OnceLock<Tree>,
}

/// The points of one cell, or of several neighbouring ones, with their indices in the set.
#[derive(Clone, Copy, Debug)]
pub struct CellPoints<'a> {
    /// The points' places.
    pub points: &'a [DVec2],
    /// For each point its index in the set.
    pub indices: &'a [u32],
}

impl CellGrid {
    /// The most cells that a side can have: 2³⁰ cells in all.
    pub const MAX_CELLS_PER_SIDE: usize = 1 << 15;

    /// The grid of `set` with about two points a cell.
    pub fn new(set: &PointSet) -> Self {
        let side = (set.len() as f64 / POINTS_PER_CELL).sqrt().round() as usize;
        Self::with_cells_per_side(set, side.clamp(1, Self::MAX_CELLS_PER_SIDE))
    }

    /// The grid of `set` with `cells_per_side`² cells.
    ///
    /// # Panics
    /// If `cells_per_side` is 0 or above [`Self::MAX_CELLS_PER_SIDE`].
    pub fn with_cells_per_side(set: &PointSet, cells_per_side: usize) -> Self {
        assert!(
            (1..=Self::MAX_CELLS_PER_SIDE).contains(&cells_per_side),
            "{cells_per_side} cells a side; a grid has 1 to {}",
            Self::MAX_CELLS_PER_SIDE
        );
        let sorted = Sorted::new(set.points(), cells_per_side);
        let crowded = sorted.sum_of_squares() > CROWDED * set.len() as u64;
        let Sorted { starts, points, indices, .. } = sorted;
        Self { cells_per_side, starts, points, indices, crowded, tree: OnceLock::new() }
    }

    /// Cells in a row, and rows: m.
    pub fn cells_per_side(&self) -> usize {
        self.cells_per_side
    }

    /// Number of points n ≥ 1.
    #[expect(clippy::len_without_is_empty, reason = "a point set is never empty")]
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// All points in the order of cells.
    pub fn all(&self) -> CellPoints<'_> {
        CellPoints { points: &self.points, indices: &self.indices }
    }

    /// Column and row of the cell that `p` lies in.
    ///
    /// # Panics
    /// If `p` is not in [0, 1)².
    pub fn cell_of(&self, p: DVec2) -> (usize, usize) {
        assert!(torus::contains(p), "{p} is not in [0, 1)²");
        let cell = cell_number(p, self.cells_per_side);
        (cell % self.cells_per_side, cell / self.cells_per_side)
    }

    /// The points in the cell of column `ix` and row `iy`, by index.
    ///
    /// # Panics
    /// If there is no such column or row.
    pub fn cell(&self, ix: usize, iy: usize) -> CellPoints<'_> {
        self.row_cells(iy, ix..ix + 1)
    }

    /// The points in the given columns of row `iy`, cell by cell.
    ///
    /// # Panics
    /// If there is no such column or row.
    pub fn row_cells(&self, iy: usize, columns: Range<usize>) -> CellPoints<'_> {
        let m = self.cells_per_side;
        assert!(iy < m && columns.end <= m, "columns {columns:?} of row {iy} in {m}×{m} cells");
        let row = iy * m;
        let slots =
            self.starts[row + columns.start] as usize..self.starts[row + columns.end] as usize;
        CellPoints { points: &self.points[slots.clone()], indices: &self.indices[slots] }
    }

    /// The point nearest to `p`, without point `except`, and its distance; `None` if there is no
    /// other point.
    ///
    /// Of several points at the same distance it is the one of smallest index; of several that
    /// coincide with `p`, always the same one.
    ///
    /// # Panics
    /// If `p` is not in [0, 1)².
    pub fn nearest(&self, p: DVec2, except: Option<u32>) -> Option<(u32, f64)> {
        let mut probe = Nearest::new(p, except);
        self.approach(p, &mut probe);
        if probe.is_undecided() {
            return self.nearest_of_very_near(p, except);
        }
        probe.result()
    }

    /// The `k` points nearest to `p` (fewer if the set has fewer), without point `except`, with
    /// their distances, nearest first, at equal distance by index. If more than `k` coincide with
    /// `p`, always the same of them.
    ///
    /// Distances below 1e-162, whose squares are 0, count as equal.
    ///
    /// # Panics
    /// If `p` is not in [0, 1)².
    pub fn nearest_k(&self, p: DVec2, k: usize, except: Option<u32>) -> Vec<(u32, f64)> {
        let mut probe = NearestK::new(p, k, except);
        if k > 0 {
            self.approach(p, &mut probe);
        }
        probe.result()
    }

    /// Calls `visit(index, distance²)` once for each point at distance ≤ `radius` from `p`, in no
    /// particular order.
    ///
    /// The disk is closed: the test is distance² ≤ radius², each square rounded once and 0 below
    /// 1e-308. From √½ on every point of the torus is within the radius.
    ///
    /// # Panics
    /// If `p` is not in [0, 1)², or `radius` is negative or NaN.
    pub fn for_each_within(&self, p: DVec2, radius: f64, mut visit: impl FnMut(u32, f64)) {
        let everything = self.try_for_each_within(p, radius, |index, distance_squared| {
            visit(index, distance_squared);
            ControlFlow::<()>::Continue(())
        });
        debug_assert!(everything.is_continue(), "nobody stopped the visit");
    }

    /// As [`Self::for_each_within`], until `visit` breaks; what it breaks with is returned.
    ///
    /// # Panics
    /// As [`Self::for_each_within`].
    pub fn try_for_each_within<B>(
        &self,
        p: DVec2,
        radius: f64,
        visit: impl FnMut(u32, f64) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        assert!(torus::contains(p), "{p} is not in [0, 1)²");
        assert!(radius >= 0.0, "radius {radius} is not a distance");
        let mut probe = Within::new(p, radius, visit);
        // That the walk broke off is in the probe's result.
        let _ = match self.tree() {
            Some(tree) => tree.search(p, &mut probe),
            None => self.walk_disk(p, radius, &mut probe),
        };
        probe.result()
    }

    /// Whether a point other than `except` lies at distance ≤ `radius` from `p`.
    ///
    /// # Panics
    /// As [`Self::for_each_within`].
    pub fn any_within(&self, p: DVec2, radius: f64, except: Option<u32>) -> bool {
        let found = self.try_for_each_within(p, radius, |index, _| {
            if Some(index) == except { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        found.is_break()
    }

    #[cold]
    fn nearest_of_very_near(&self, p: DVec2, except: Option<u32>) -> Option<(u32, f64)> {
        let mut probe = VeryNear::new(p, except);
        self.approach(p, &mut probe);
        probe.result()
    }

    /// Shows `probe` all points that may be within its shrinking reach of `p`, near ones first.
    fn approach(&self, p: DVec2, probe: &mut impl Probe) {
        assert!(torus::contains(p), "{p} is not in [0, 1)²");
        // A probe that breaks off has what it wants.
        let _ = match self.tree() {
            Some(tree) => tree.search(p, probe),
            None => self.walk_rings(p, probe),
        };
    }

    fn tree(&self) -> Option<&Tree> {
        self.crowded.then(|| self.tree.get_or_init(|| Tree::new(&self.points, &self.indices)))
    }
}

impl fmt::Debug for CellGrid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("CellGrid")
            .field("points", &self.points.len())
            .field("cells_per_side", &self.cells_per_side)
            .field("crowded", &self.crowded)
            .finish_non_exhaustive()
    }
}

/// The cell of a coordinate: floor(x·m), with the product rounded as everywhere in this module.
fn cell_coordinate(x: f64, cells_per_side: usize) -> usize {
    ((x * cells_per_side as f64) as usize).min(cells_per_side - 1)
}

fn cell_number(p: DVec2, cells_per_side: usize) -> usize {
    cell_coordinate(p.y, cells_per_side) * cells_per_side + cell_coordinate(p.x, cells_per_side)
}
