//! Walks over the near pairs of a point set, each pair once.

use std::ops::Range;

use bn_core::{CellGrid, DVec2, PointSet};

/// The points of a set, cell after cell of a grid whose cells are at least as wide as the pairs of
/// interest are far apart.
pub(crate) struct CellPairs {
    points: Vec<DVec2>,
    /// Where each cell's points start, row by row, and the end of the last.
    starts: Vec<usize>,
    cells_per_side: usize,
}

impl CellPairs {
    /// For pairs closer than `range` in each coordinate; none where cells of that width are fewer
    /// than 3 a side, so that all pairs have to be looked at.
    pub(crate) fn within(set: &PointSet, range: f64) -> Option<Self> {
        // A little wider than the range, so that no rounding puts a near pair two cells apart.
        let widest = (1.0 / (range * (1.0 + 1e-12))) as usize;
        let even = (set.len() as f64).sqrt() as usize;
        let cells_per_side = widest.min(even).min(CellGrid::MAX_CELLS_PER_SIDE);
        (cells_per_side >= 3)
            .then(|| Self::new(&CellGrid::with_cells_per_side(set, cells_per_side)))
    }

    fn new(grid: &CellGrid) -> Self {
        let m = grid.cells_per_side();
        let mut starts = Vec::with_capacity(m * m + 1);
        starts.push(0);
        for (iy, ix) in (0..m).flat_map(|iy| (0..m).map(move |ix| (iy, ix))) {
            starts.push(starts[starts.len() - 1] + grid.cell(ix, iy).points.len());
        }
        Self { points: grid.all().points.to_vec(), starts, cells_per_side: m }
    }

    /// The points in the order that their numbers refer to.
    pub(crate) fn points(&self) -> &[DVec2] {
        &self.points
    }

    /// Rows of cells.
    pub(crate) fn rows(&self) -> usize {
        self.cells_per_side
    }

    /// Pairs that all rows together come to, if the points are spread evenly.
    pub(crate) fn expected_pairs(&self) -> u64 {
        (self.points.len() as u64).pow(2) / (self.cells_per_side as u64).pow(2) * 5
    }

    /// Calls `visit(i, others)` for each point i of a row of cells and each range of points to pair
    /// it with: those after it in its cell and those of the four cells before. Over all rows every
    /// pair of the same or neighbouring cells comes once.
    pub(crate) fn for_each_in_row(&self, iy: usize, mut visit: impl FnMut(usize, Range<usize>)) {
        let m = self.cells_per_side;
        let cell = |ix: usize, iy: usize| -> Range<usize> {
            let c = iy * m + ix;
            self.starts[c]..self.starts[c + 1]
        };
        let below = (iy + m - 1) % m;
        for ix in 0..m {
            let (left, right) = ((ix + m - 1) % m, (ix + 1) % m);
            let own = cell(ix, iy);
            for point in own.clone() {
                visit(point, point + 1..own.end);
                for others in
                    [cell(left, iy), cell(left, below), cell(ix, below), cell(right, below)]
                {
                    visit(point, others);
                }
            }
        }
    }
}
