//! Counting sort of points by cells.

use std::ops::Range;

use glam::DVec2;

use super::{cell_coordinate, cell_number};

/// Points whose places, old and new, fit into a core's cache together. Sorting as many at a time
/// halves the time for 10⁶ points.
const BLOCK: usize = 8192;

/// Below this many points everything fits, and sorting in blocks takes longer than it saves.
const LARGE: usize = 16 * BLOCK;

/// Points in the order of cells, within a cell in the order given.
pub(super) struct Sorted {
    /// Cell c holds `points[starts[c]..starts[c + 1]]`.
    pub(super) starts: Vec<u32>,
    pub(super) points: Vec<DVec2>,
    pub(super) indices: Vec<u32>,
    cells_per_side: usize,
}

impl Sorted {
    /// Sorts `unsorted` into `cells_per_side`² cells in O(n + cells).
    pub(super) fn new(unsorted: &[DVec2], cells_per_side: usize) -> Self {
        let n = unsorted.len();
        let mut sorted = Self {
            starts: vec![0; cells_per_side * cells_per_side + 1],
            points: vec![DVec2::ZERO; n],
            indices: vec![0; n],
            cells_per_side,
        };
        if n < LARGE {
            sorted.place(unsorted.iter().copied().zip(0..), 0..cells_per_side, 0);
        } else {
            sorted.sort_in_blocks(unsorted);
        }
        sorted
    }

    /// Distributes the points to blocks of rows first, and then sorts each block.
    fn sort_in_blocks(&mut self, unsorted: &[DVec2]) {
        let m = self.cells_per_side;
        let rows = (m * BLOCK / unsorted.len()).max(1);
        let block_of = |p: DVec2| cell_coordinate(p.y, m) / rows;
        let mut ends = vec![0; m.div_ceil(rows)];
        count(unsorted.iter().map(|&p| block_of(p)), &mut ends, 0);
        let mut blocks = vec![(DVec2::ZERO, 0); unsorted.len()];
        for (&p, index) in unsorted.iter().zip(0..) {
            let end = &mut ends[block_of(p)];
            blocks[*end as usize] = (p, index);
            *end += 1;
        }
        let mut start = 0;
        for (block, &end) in ends.iter().enumerate() {
            let points = blocks[start as usize..end as usize].iter().copied();
            let first_row = block * rows;
            self.place(points, first_row..(first_row + rows).min(m), start);
            start = end;
        }
    }

    /// Places the points of some rows, with their indices, from slot `first` on.
    fn place(
        &mut self,
        points: impl Iterator<Item = (DVec2, u32)> + Clone,
        rows: Range<usize>,
        first: u32,
    ) {
        let m = self.cells_per_side;
        let first_cell = rows.start * m;
        // The end of a cell, while points are placed its next free slot, is the next one's start.
        let ends = &mut self.starts[first_cell + 1..=rows.end * m];
        let cell_of = |p: DVec2| cell_number(p, m) - first_cell;
        count(points.clone().map(|(p, _)| cell_of(p)), ends, first);
        for (p, index) in points {
            let end = &mut ends[cell_of(p)];
            self.points[*end as usize] = p;
            self.indices[*end as usize] = index;
            *end += 1;
        }
    }

    /// Σ c² over the numbers c of points in the cells.
    pub(super) fn sum_of_squares(&self) -> u64 {
        self.starts.windows(2).map(|cell| u64::from(cell[1] - cell[0]).pow(2)).sum()
    }
}

/// Sets `starts` to where the items of each bin start, if they are laid out bin after bin from
/// `first` on; `starts` holds zeros before.
fn count(bins: impl Iterator<Item = usize>, starts: &mut [u32], first: u32) {
    for bin in bins {
        starts[bin] += 1;
    }
    let mut next = first;
    for start in starts {
        next += std::mem::replace(start, next);
    }
}
