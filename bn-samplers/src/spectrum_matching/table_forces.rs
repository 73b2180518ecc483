//! Forces between all pairs of points, the strength tabulated by distance.

#![expect(clippy::inline_always, reason = "compiled anew under the features of the caller")]

use bn_core::DVec2;
use rayon::prelude::*;

/// Points whose forces on each of as many others are computed in one loop; their coordinates and
/// forces stay in the first-level cache.
const BLOCK: usize = 256;
/// Pieces of work, each with its own sums: a fixed number, so that their order is fixed too.
const PIECES: usize = 16;
/// The distance beyond which points don't act on each other: the table ends at ½, and the last bins
/// are half empty (errata 15).
const FARTHEST: f32 = 0.49;
/// The nearest that two points can be and still act on each other.
const NEAREST: f32 = 1e-9;
/// A coordinate that is too far from every point, but not from its like.
const OUTSIDE: f32 = 4.0;
/// 2²³: above it single precision holds integers alone, in its lowest bits.
const INTEGERS: f32 = 8_388_608.0;

/// The longest table: its indices have 16 bits, so that no look-up needs a check.
pub(super) const MOST_STRENGTHS: usize = 1 << 16;

/// Σⱼ f(r)·(xᵢ − xⱼ)/r² over all other points nearer than 0.49, for every i: thesis eq. 5.7. `f` holds
/// the strengths at r = k·½/(len − 1), linear in between.
///
/// Each pair is computed once, in single precision but for the sums over more than 256 points:
/// coordinates are good to 6e-8, a hundredth of a bin for thousands of points. Same bits on any CPU
/// and number of threads: nothing is fused, all sums have a fixed order. O(n²), some 2 ns a pair and
/// core.
///
/// # Panics
/// If `f` is empty or longer than [`MOST_STRENGTHS`].
pub(super) fn table_forces(points: &[DVec2], f: &[f64]) -> Vec<DVec2> {
    assert!((1..=MOST_STRENGTHS).contains(&f.len()), "a table of {} strengths", f.len());
    let blocks = Blocks::of(points, f.len() - 1);
    let table = Table::new(f);
    let pieces = 0..blocks.x.len().min(PIECES);
    let pieces: Vec<Vec<DVec2>> =
        pieces.into_par_iter().map(|piece| blocks.piece(&table, piece)).collect();
    let total = |i: usize| pieces.iter().map(|sums| sums[i]).fold(DVec2::ZERO, |sum, f| sum + f);
    (0..points.len()).map(total).collect()
}

/// The points by blocks, and how their distances become places in a table.
struct Blocks {
    /// Whole blocks: what is beyond the points is outside.
    x: Vec<[f32; BLOCK]>,
    y: Vec<[f32; BLOCK]>,
    /// Entries of the table to a unit of length.
    per_unit: f32,
    /// The last entry: what is at its distance or beyond.
    last: u16,
    /// Number of points.
    points: usize,
}

impl Blocks {
    fn of(points: &[DVec2], last: usize) -> Self {
        let blocks = |coordinate: fn(&DVec2) -> f64| {
            let block = |points: &[DVec2]| {
                let mut block = [OUTSIDE; BLOCK];
                for (slot, point) in block.iter_mut().zip(points) {
                    *slot = coordinate(point) as f32;
                }
                block
            };
            points.chunks(BLOCK).map(block).collect()
        };
        Self {
            x: blocks(|p| p.x),
            y: blocks(|p| p.y),
            per_unit: 2.0 * last as f32,
            last: last as u16,
            points: points.len(),
        }
    }

    /// Number of points in a block.
    fn filled(&self, block: usize) -> usize {
        (self.points - block * BLOCK).min(BLOCK)
    }

    /// The forces of every [`PIECES`]-th block's pairs: with itself, and with the half of the others
    /// that follows it round the circle of blocks, so that every two blocks meet once.
    fn piece(&self, table: &Table, piece: usize) -> Vec<DVec2> {
        let blocks = self.x.len();
        let mut sums = vec![DVec2::ZERO; blocks * BLOCK];
        for one in (piece..blocks).step_by(PIECES) {
            self.act(table, one, one, &mut sums);
            for ahead in 1..=blocks / 2 {
                // Opposite blocks would meet from both sides.
                if 2 * ahead < blocks || one < ahead {
                    self.act(table, one, (one + ahead) % blocks, &mut sums);
                }
            }
        }
        sums
    }

    /// Adds the forces between the points of two blocks, or those of one on each other.
    fn act(&self, table: &Table, one: usize, other: usize, sums: &mut [DVec2]) {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512bw") {
            // SAFETY: the CPU has just been found to have the features.
            return unsafe { act_avx512(self, table, one, other, sums) };
        } else if is_x86_feature_detected!("avx2") {
            // SAFETY: the CPU has just been found to have the feature.
            return unsafe { act_avx2(self, table, one, other, sums) };
        }
        act(self, table, one, other, sums);
    }

    /// The place of a distance: the index of the entry before it, and how far it is beyond that.
    #[inline(always)]
    fn place(&self, r: f32) -> (u16, f32) {
        let end = f32::from(self.last);
        let position = r * self.per_unit;
        let position = if position < end { position } else { end };
        // The nearest integer to the position less ½ is its floor, or at an integer may be the one
        // before: to a table that is continuous that is the same.
        let lower = position - 0.5;
        let shifted = (if lower > 0.0 { lower } else { 0.0 }) + INTEGERS;
        ((shifted.to_bits() & 0xffff) as u16, position - (shifted - INTEGERS))
    }
}

/// A quarter faster than [`act_avx2`]: 1.5 instead of 2.0 ns a pair.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512bw")]
fn act_avx512(blocks: &Blocks, table: &Table, one: usize, other: usize, sums: &mut [DVec2]) {
    act(blocks, table, one, other, sums);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn act_avx2(blocks: &Blocks, table: &Table, one: usize, other: usize, sums: &mut [DVec2]) {
    act(blocks, table, one, other, sums);
}

#[inline(always)]
fn act(blocks: &Blocks, table: &Table, one: usize, other: usize, sums: &mut [DVec2]) {
    let mut row = Row::default();
    let mut back = [[0.0_f32; BLOCK]; 2];
    for i in 0..blocks.filled(one) {
        row.measure(blocks, (one, i), other);
        row.look_up(table);
        sums[one * BLOCK + i] += row.add(&mut back);
    }
    // Within a block every pair has come up from both sides.
    if one != other {
        for (j, sum) in sums[other * BLOCK..][..BLOCK].iter_mut().enumerate() {
            *sum -= DVec2::new(f64::from(back[0][j]), f64::from(back[1][j]));
        }
    }
}

/// Strengths and their differences to the next, each pair in one number: one look-up gets both.
struct Table(Box<[u64; MOST_STRENGTHS]>);

impl Table {
    fn new(f: &[f64]) -> Self {
        let mut table = vec![0; MOST_STRENGTHS].into_boxed_slice();
        for (k, slot) in table.iter_mut().enumerate().take(f.len()) {
            let next = f.get(k + 1).unwrap_or(&f[k]);
            let (value, difference) = (f[k] as f32, (next - f[k]) as f32);
            *slot = u64::from(value.to_bits()) | u64::from(difference.to_bits()) << 32;
        }
        Self(table.try_into().expect("of that length"))
    }
}

#[inline(always)]
fn parts(entry: u64) -> (f32, f32) {
    (f32::from_bits(entry as u32), f32::from_bits((entry >> 32) as u32))
}

/// The pairs of one point with a block: arrays that simple loops go over, one after the other, which
/// is what compilers make vector instructions of.
struct Row {
    dx: [f32; BLOCK],
    dy: [f32; BLOCK],
    /// 1/r², 0 for pairs that don't act on each other.
    inverse: [f32; BLOCK],
    /// The place in the table: index and distance from it.
    index: [u16; BLOCK],
    fraction: [f32; BLOCK],
    value: [f32; BLOCK],
    difference: [f32; BLOCK],
}

impl Default for Row {
    fn default() -> Self {
        let zeros = [0.0; BLOCK];
        Self {
            dx: zeros,
            dy: zeros,
            inverse: zeros,
            index: [0; BLOCK],
            fraction: zeros,
            value: zeros,
            difference: zeros,
        }
    }
}

impl Row {
    #[inline(always)]
    fn measure(&mut self, blocks: &Blocks, (one, i): (usize, usize), other: usize) {
        let (x, y) = (blocks.x[one][i], blocks.y[one][i]);
        let (xs, ys) = (&blocks.x[other], &blocks.y[other]);
        for j in 0..BLOCK {
            let (dx, dy) = (shortest(x - xs[j]), shortest(y - ys[j]));
            let square = dx * dx + dy * dy;
            let r = square.sqrt();
            (self.dx[j], self.dy[j]) = (dx, dy);
            self.inverse[j] = if r > NEAREST && r < FARTHEST { 1.0 / square } else { 0.0 };
            (self.index[j], self.fraction[j]) = blocks.place(r);
        }
    }

    #[inline(always)]
    fn look_up(&mut self, table: &Table) {
        for j in 0..BLOCK {
            (self.value[j], self.difference[j]) = parts(table.0[usize::from(self.index[j])]);
        }
    }

    /// The force on the one; the same on the block into `back`.
    #[inline(always)]
    fn add(&mut self, back: &mut [[f32; BLOCK]; 2]) -> DVec2 {
        for j in 0..BLOCK {
            let strength = self.value[j] + self.difference[j] * self.fraction[j];
            let weight = strength * self.inverse[j];
            self.dx[j] *= weight;
            self.dy[j] *= weight;
        }
        for (sums, forces) in back.iter_mut().zip([&self.dx, &self.dy]) {
            for (sum, force) in sums.iter_mut().zip(forces) {
                *sum += force;
            }
        }
        DVec2::new(sum(&self.dx), sum(&self.dy))
    }
}

/// In eight partial sums.
#[inline(always)]
fn sum(values: &[f32; BLOCK]) -> f64 {
    let mut lanes = [0.0_f32; 8];
    for eight in values.as_chunks::<8>().0 {
        for (lane, value) in lanes.iter_mut().zip(eight) {
            *lane += value;
        }
    }
    lanes.iter().map(|&lane| f64::from(lane)).sum()
}

/// The shortest way round the torus of two coordinates `d` apart, −1 < d < 1.
#[inline(always)]
fn shortest(d: f32) -> f32 {
    if d > 0.5 {
        d - 1.0
    } else if d < -0.5 {
        d + 1.0
    } else {
        d
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stochastic::uniform_points;
    use bn_core::{Seed, torus};

    /// Within a block, two blocks, an odd and an even number of them, more than there are pieces.
    #[test]
    fn forces_are_the_sums_over_all_pairs() {
        for n in [1, 2, 3, 300, 700, 1000, 4500] {
            let points = uniform_points(n, Seed::new(2), 0).expect("few points");
            let f: Vec<f64> = (0..=200).map(|k| libm::sin(0.1 * f64::from(k))).collect();
            let got = table_forces(&points, &f);
            for i in (0..n).step_by(n.div_ceil(1000)) {
                let (mut want, mut size) = (DVec2::ZERO, 1e-30);
                for (j, &other) in points.iter().enumerate() {
                    let d = torus::delta(other, points[i]);
                    let r = d.length();
                    if i != j && r < 0.49 {
                        let k = (400.0 * r) as usize;
                        let strength = f[k] + (f[k + 1] - f[k]) * (400.0 * r - k as f64);
                        want += strength / (r * r) * d;
                        size += strength.abs() / r + 40.0 / r;
                    }
                }
                // Distances to 1e-7, of which the nearest are about 0.1/n; rounding of the sums.
                let error = (got[i] - want).length();
                assert!(error < 1e-4 * size, "{n}: {} against {want}", got[i]);
            }
        }
    }

    /// What any CPU computes, and what this one does.
    #[test]
    fn instructions_make_no_difference() {
        let points = uniform_points(2 * BLOCK - 9, Seed::new(3), 0).expect("few points");
        let f: Vec<f64> = (0..=5000).map(|k| libm::cos(0.01 * f64::from(k))).collect();
        let (blocks, table) = (Blocks::of(&points, 5000), Table::new(&f));
        for other in 0..2 {
            let (mut any, mut this) = ([DVec2::ZERO; 2 * BLOCK], [DVec2::ZERO; 2 * BLOCK]);
            act(&blocks, &table, 0, other, &mut any);
            blocks.act(&table, 0, other, &mut this);
            assert!(any == this);
        }
    }

    #[test]
    fn tables_of_any_length_serve() {
        let points = uniform_points(20, Seed::new(4), 0).expect("few points");
        for f in [vec![1.0], vec![1.0; 2], vec![1.0; MOST_STRENGTHS]] {
            let (got, want) = (table_forces(&points, &f), table_forces(&points, &[1.0; 5]));
            for (got, want) in got.iter().zip(&want) {
                assert!((*got - *want).length() <= 1e-4 * want.length(), "{got} against {want}");
            }
        }
    }
}
