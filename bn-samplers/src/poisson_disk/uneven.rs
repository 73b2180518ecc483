//! Dart throwing by a density: disks the larger the sparser points are to be.

use bn_core::{DVec2, DensityFunction, Observer, Progress, Seed, torus};
use rand::RngExt;

use crate::SampleError;
use crate::error::observe;

/// Disks of radius r/√ρ around points of density ρ, none of which contains both its own point and that
/// of a smaller disk: two points keep the smaller of their radii as distance.
pub(super) struct UnevenThrower<'a> {
    density: &'a DensityFunction,
    /// r.
    radius: f64,
    disks: Vec<Disk>,
    /// The last disk in each bucket; `END` if there is none.
    heads: Vec<u32>,
    /// Levels of cells that hold disks, one bit each.
    levels: u64,
    darts: u64,
}

/// A disk that keeps others away.
struct Disk {
    centre: DVec2,
    /// 1/ρ at the centre: the square of the disk's radius in units of r.
    area: f64,
    /// The disk before it in its bucket.
    previous: u32,
}

const END: u32 = u32::MAX;

/// Cells of level l have the side 2⁻ˡ.
const LAST_LEVEL: u32 = 30;

/// Success is judged after so many darts, or as many as there are to be points.
const WINDOW: usize = 1024;

/// Disks shrink by this factor while fewer than one dart in [`SLOW`] sticks.
const SHRINK: f64 = 0.99;
const SLOW: usize = 200;

/// Disks that must not shrink are given up when fewer than one dart in so many sticks.
const HOPELESS: usize = 2000;

impl<'a> UnevenThrower<'a> {
    /// For `n` points; `radius` is r, the radius where the density is the mean.
    pub(super) fn new(density: &'a DensityFunction, n: usize, radius: f64) -> Self {
        let heads = vec![END; (2 * n).next_power_of_two()];
        Self { density, radius, disks: Vec::new(), heads, levels: 0, darts: 0 }
    }

    /// Throws darts by the density until `n` stick. If `may_shrink`, r falls when they no longer do,
    /// so that there will be n; else throwing ends then.
    pub(super) fn throw(
        &mut self,
        n: usize,
        may_shrink: bool,
        seed: Seed,
        observer: &dyn Observer,
    ) -> Result<(), SampleError> {
        let mut rng = seed.stream(0);
        let (slow, window) = if may_shrink { (SLOW, 1) } else { (HOPELESS, 10) };
        let window = window * n.max(WINDOW);
        while self.disks.len() < n {
            let placed = self.disks.len();
            let progress = Progress::new("throwing darts", placed as u64, Some(n as u64));
            observe(observer, &progress)?;
            for _ in 0..window {
                self.darts += 1;
                let dart = self.density.place(DVec2::new(rng.random(), rng.random()));
                let area = 1.0 / self.density.at(dart);
                if !self.is_covered(dart, area) {
                    self.insert(dart, area);
                    if self.disks.len() == n {
                        return Ok(());
                    }
                }
            }
            if (self.disks.len() - placed) * slow < window {
                if !may_shrink {
                    return Ok(());
                }
                self.radius *= SHRINK;
            }
        }
        Ok(())
    }

    /// r.
    pub(super) fn radius(&self) -> f64 {
        self.radius
    }

    /// Darts thrown so far.
    pub(super) fn darts(&self) -> u64 {
        self.darts
    }

    /// The points, in the order of arrival.
    pub(super) fn points(&self) -> Vec<DVec2> {
        self.disks.iter().map(|disk| disk.centre).collect()
    }

    /// Whether a disk of this area (over r²) would be too near to another.
    ///
    /// Disks are found level by level, each in cells at least as wide as its disks are far apart at
    /// most: three by three cells hold all in question, and each cell a few.
    fn is_covered(&self, dart: DVec2, area: f64) -> bool {
        let limit = self.radius * self.radius;
        let mut levels = self.levels;
        while levels != 0 {
            let level = levels.trailing_zeros();
            levels &= levels - 1;
            let [columns, rows] = [dart.x, dart.y].map(|x| around(cell(x, level), level));
            for row in rows {
                for column in columns.clone() {
                    let mut next = self.heads[self.bucket(level, column, row)];
                    while next != END {
                        let disk = &self.disks[next as usize];
                        let least = limit * area.min(disk.area);
                        if torus::distance_squared(disk.centre, dart) < least {
                            return true;
                        }
                        next = disk.previous;
                    }
                }
            }
        }
        false
    }

    fn insert(&mut self, centre: DVec2, area: f64) {
        let level = level_of(self.radius * area.sqrt());
        let bucket = self.bucket(level, cell(centre.x, level), cell(centre.y, level));
        let previous = std::mem::replace(&mut self.heads[bucket], self.disks.len() as u32);
        self.disks.push(Disk { centre, area, previous });
        self.levels |= 1 << level;
    }

    /// Where the disks of a cell are listed, perhaps with those of others.
    fn bucket(&self, level: u32, column: u32, row: u32) -> usize {
        let name = u64::from(row) << 32 | u64::from(column);
        let name = name ^ u64::from(level).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = name.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        (mixed >> 32) as usize & (self.heads.len() - 1)
    }
}

/// The level whose cells are at least, and less than twice, as wide as `radius`.
fn level_of(radius: f64) -> u32 {
    let mut level = 0;
    while level < LAST_LEVEL && side(level + 1) >= radius {
        level += 1;
    }
    level
}

fn side(level: u32) -> f64 {
    1.0 / f64::from(1_u32 << level)
}

fn cell(x: f64, level: u32) -> u32 {
    (x * f64::from(1_u32 << level)) as u32
}

/// A cell and those at its sides along an axis, each once.
fn around(cell: u32, level: u32) -> impl Iterator<Item = u32> + Clone {
    let count = 1_u32 << level;
    let (first, number) = if count < 3 { (0, count) } else { (cell + count - 1, 3) };
    (first..first + number).map(move |cell| cell & (count - 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::Unobserved;

    #[test]
    fn points_keep_the_smaller_radius() {
        let density = DensityFunction::from_fn(16, |p| 0.01 + p.x * p.x * p.y).expect("valid");
        let mut thrower = UnevenThrower::new(&density, 600, 0.03);
        thrower.throw(600, true, Seed::new(1), &Unobserved).expect("not stopped");
        let points = thrower.points();
        assert_eq!(points.len(), 600);
        assert!(thrower.radius() > 0.02);
        for (i, &p) in points.iter().enumerate() {
            for &q in &points[..i] {
                let densest = density.at(p).max(density.at(q));
                let least = thrower.radius() / densest.sqrt();
                assert!(torus::distance(p, q) >= least * (1.0 - 1e-12));
            }
        }
    }

    #[test]
    fn disks_that_do_not_fit_are_given_up() {
        let density = DensityFunction::from_fn(2, |p| 1.0 + p.x).expect("valid");
        let mut thrower = UnevenThrower::new(&density, 100, 0.2);
        thrower.throw(100, false, Seed::new(1), &Unobserved).expect("not stopped");
        assert!((5..60).contains(&thrower.points().len()), "{}", thrower.points().len());
    }

    #[test]
    fn levels_are_as_wide_as_their_disks() {
        for (radius, level) in [(3.0, 0), (1.0, 0), (0.6, 0), (0.5, 1), (0.3, 1), (1e-30, 30)] {
            assert_eq!(level_of(radius), level);
        }
        for level in 0..4 {
            for cell in 0..1 << level {
                let mut cells: Vec<_> = around(cell, level).collect();
                assert!(cells.contains(&cell));
                cells.sort_unstable();
                cells.dedup();
                assert_eq!(cells.len(), 3.min(1 << level));
            }
        }
    }
}
