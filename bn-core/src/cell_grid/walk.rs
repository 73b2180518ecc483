//! The ways of a search over the cells: outward in square rings, or through the cells of a disk.

use std::ops::{ControlFlow, Range};

use glam::DVec2;

use super::probe::Probe;
use super::{CellGrid, cell_coordinate};

/// Bounds on distances to points of other cells, in units of cells, are loosened by this: the
/// product that assigns a coordinate to one of up to 2¹⁵ cells is off by up to 4e-12, a distance
/// across the seam by as much.
const SLACK_CELLS: f64 = 1e-9;

impl CellGrid {
    /// Shows the probe the points in rings of cells around `p`, until none can be within reach.
    pub(super) fn walk_rings(&self, p: DVec2, probe: &mut impl Probe) -> ControlFlow<()> {
        let m = self.cells_per_side;
        if m < 3 {
            return probe.look(self.all());
        }
        let (ix, iy) = (cell_coordinate(p.x, m), cell_coordinate(p.y, m));
        // The place in the cell, in cells.
        let (x, y) = (p.x * m as f64 - ix as f64, p.y * m as f64 - iy as f64);
        let cells_squared = (m * m) as f64;
        let out_of_reach = |cells: f64, probe: &mut _| {
            let clear = cells - SLACK_CELLS;
            clear > 0.0 && clear * clear > Probe::reach_squared(probe) * cells_squared
        };
        // The own cell with its neighbours holds the answer most of the time.
        let columns = spans(ix, 1, m);
        self.show_spans(iy, &columns, probe)?;
        let above = if iy + 1 == m { 0 } else { iy + 1 };
        let below = if iy == 0 { m - 1 } else { iy - 1 };
        for (row, clear) in [(above, 1.0 - y), (below, y)] {
            if !out_of_reach(clear, probe) {
                self.show_spans(row, &columns, probe)?;
            }
        }
        let margin = x.min(1.0 - x).min(y).min(1.0 - y);
        for ring in 2..=m / 2 {
            // All that was not shown yet is at least this far away.
            if out_of_reach((ring - 1) as f64 + margin, probe) {
                break;
            }
            self.show_ring((ix, iy), ring, probe)?;
        }
        ControlFlow::Continue(())
    }

    /// The cells that are `ring` ≥ 2 columns or rows away, each once; 2·ring ≤ m.
    fn show_ring(
        &self,
        (ix, iy): (usize, usize),
        ring: usize,
        probe: &mut impl Probe,
    ) -> ControlFlow<()> {
        let m = self.cells_per_side;
        let (up, down) = ((iy + ring) % m, (iy + m - ring) % m);
        let columns = spans(ix, ring, m);
        self.show_spans(up, &columns, probe)?;
        if down != up {
            self.show_spans(down, &columns, probe)?;
        }
        let (right, left) = ((ix + ring) % m, (ix + m - ring) % m);
        for row in spans(iy, ring - 1, m).into_iter().flatten() {
            probe.look(self.cell(right, row))?;
            if left != right {
                probe.look(self.cell(left, row))?;
            }
        }
        ControlFlow::Continue(())
    }

    /// Shows the probe the points of all cells that meet the disk around `p`, each cell once.
    pub(super) fn walk_disk(
        &self,
        p: DVec2,
        radius: f64,
        probe: &mut impl Probe,
    ) -> ControlFlow<()> {
        let m = self.cells_per_side;
        let (x, y) = (p.x * m as f64, p.y * m as f64);
        // In cells; at m every row and column is reached.
        let radius = (radius * m as f64 + SLACK_CELLS).min(m as f64);
        let own_row = cell_coordinate(p.y, m);
        for row in spans(own_row, radius.ceil() as usize, m).into_iter().flatten() {
            let gap = if row == own_row { 0.0 } else { distance_to_row(y, row, m) };
            let gap = (gap - SLACK_CELLS).max(0.0);
            if gap <= radius {
                let half_chord = (radius * radius - gap * gap).sqrt();
                let columns = spans_between(x - half_chord, x + half_chord, m);
                self.show_spans(row, &columns, probe)?;
            }
        }
        ControlFlow::Continue(())
    }

    #[inline]
    fn show_spans(
        &self,
        row: usize,
        columns: &[Range<usize>; 2],
        probe: &mut impl Probe,
    ) -> ControlFlow<()> {
        for span in columns {
            if !span.is_empty() {
                probe.look(self.row_cells(row, span.clone()))?;
            }
        }
        ControlFlow::Continue(())
    }
}

/// How far y is from row `row` of m, which it is not in, the shorter way round.
fn distance_to_row(y: f64, row: usize, m: usize) -> f64 {
    let (low, high, m) = (row as f64, row as f64 + 1.0, m as f64);
    if y < low { (low - y).min(y + (m - high)) } else { (y - high).min(low + (m - y)) }
}

/// The cells of m that meet [low, high] on the circle, low in (−m, m) and high in [0, 2m).
fn spans_between(low: f64, high: f64, m: usize) -> [Range<usize>; 2] {
    if high.floor() - low.floor() + 1.0 >= m as f64 {
        [0..m, 0..0]
    } else if low < 0.0 {
        // Just below 0 the sum may round to m.
        let first = ((low + m as f64) as usize).min(m - 1);
        [0..high as usize + 1, first..m]
    } else if high >= m as f64 {
        [low as usize..m, 0..(high - m as f64) as usize + 1]
    } else {
        [low as usize..high as usize + 1, 0..0]
    }
}

/// The numbers c − k … c + k modulo m as ranges of 0..m, each number once.
fn spans(c: usize, k: usize, m: usize) -> [Range<usize>; 2] {
    if 2 * k + 1 >= m {
        [0..m, 0..0]
    } else if c < k {
        [0..c + k + 1, m + c - k..m]
    } else if c + k >= m {
        [c - k..m, 0..c + k + 1 - m]
    } else {
        [c - k..c + k + 1, 0..0]
    }
}
