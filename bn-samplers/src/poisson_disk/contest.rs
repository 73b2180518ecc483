//! Which darts of a volley stick: each unless an earlier one that sticks is too near.

use bn_core::torus;

use super::disk_grid::{Cell, DiskGrid, REACH, WIDTH};
use super::tile::{Dart, Fate, Tile};

/// The darts of a volley on all tiles.
///
/// To go through the darts in the order of time would be to go through memory at random. But a
/// dart's fate depends on earlier ones nearby only: so tile after tile is gone through, each in
/// the order of time, and where a dart's fate depends on darts of other tiles, theirs are found
/// first. The outcome is that of the order of time, whatever the order of tiles, and on any number
/// of threads.
#[derive(Clone, Copy)]
pub(super) struct Contest<'a> {
    pub(super) grid: &'a DiskGrid,
    pub(super) tiles: &'a [Tile],
    /// Where the tiles begin, in each axis; the grid's side at last.
    pub(super) bounds: &'a [u16],
}

/// A dart: its tile, its number there.
type Name = (u32, u32);

impl Contest<'_> {
    /// Settles the fates of a tile's darts, and enters those that stick into the grid.
    pub(super) fn settle(&self, tile: u32) {
        let own = &self.tiles[tile as usize];
        let mut waiting = Vec::new();
        for (index, dart) in (0..).zip(own.darts()) {
            if dart.fate() != Fate::Open {
                dart.wait_until_entered();
                continue;
            }
            // Earlier darts of this tile are settled.
            if self.tiles.len() == 1 || own.has_inside(dart.cell, REACH as u16) {
                self.settle_among_settled(dart);
            } else {
                waiting.push((tile, index));
                self.settle_all(&mut waiting);
            }
        }
    }

    /// Settles darts, from the last on, and those that they depend on.
    fn settle_all(&self, waiting: &mut Vec<Name>) {
        while let Some(&name) = waiting.last() {
            let dart = self.dart(name);
            if dart.fate() == Fate::Open {
                if self.grid.covers_place(dart.place, dart.cell) {
                    dart.fall();
                } else if let Some(earlier) = self.unsettled_rival(name) {
                    waiting.push(earlier);
                    continue;
                } else {
                    self.settle_among_settled(dart);
                }
            }
            dart.wait_until_entered();
            waiting.pop();
        }
    }

    /// Settles a dart that depends on none that isn't settled.
    ///
    /// A disk that covers it can't be that of a later dart: that one would have waited for it. What
    /// it depends on is settled, so that the grid has all of their disks.
    fn settle_among_settled(&self, dart: &Dart) {
        if self.grid.covers_place(dart.place, dart.cell) {
            dart.fall();
        } else if dart.claim() {
            self.grid.insert(dart.place, dart.cell);
            dart.stick();
        }
        dart.wait_until_entered();
    }

    /// An earlier dart too near to this one that isn't settled.
    fn unsettled_rival(&self, name: Name) -> Option<Name> {
        let dart = self.dart(name);
        let mut found = None;
        let columns = self.near(dart.cell.column);
        for (row, down) in self.near(dart.cell.row) {
            for (column, right) in columns {
                let tile = down * (self.bounds.len() - 1) + right;
                for (index, rival) in self.tiles[tile].darts_in(Cell { column, row }) {
                    let rival_name = (tile as u32, index);
                    let is_earlier = (rival.time, rival_name) < (dart.time, name);
                    if is_earlier && !rival.is_settled() && self.are_too_near(rival, dart) {
                        found = Some(rival_name);
                    }
                }
            }
        }
        found
    }

    fn are_too_near(&self, a: &Dart, b: &Dart) -> bool {
        self.grid.are_too_near(torus::distance_squared(a.place, b.place))
    }

    fn dart(&self, (tile, index): Name) -> &Dart {
        &self.tiles[tile as usize].darts()[index as usize]
    }

    /// The rows (or columns) that a disk around a point of row `at` may reach, with their tile's.
    fn near(&self, at: u16) -> [(u16, usize); WIDTH] {
        let side = usize::from(self.grid.side());
        std::array::from_fn(|i| {
            let cell = (usize::from(at) + side - REACH + i) % side;
            // Tiles are equally wide but for rounding.
            let tile = cell * (self.bounds.len() - 1) / side;
            (cell as u16, tile + usize::from(usize::from(self.bounds[tile + 1]) <= cell))
        })
    }
}
