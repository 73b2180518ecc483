//! Forces between all pairs of points, the strength tabulated by distance.

#![expect(clippy::inline_always, reason = "compiled anew under the features of the caller")]

use bn_core::DVec2;
use rayon::prelude::*;

/// Points whose forces are computed as one piece of work.
const ROWS: usize = 32;
/// Pairs that are computed together before their strengths are looked up.
const CHUNK: usize = 256;
/// The distance beyond which points don't act on each other: the table ends at ½, and the last bins
/// are half empty (errata 15).
const FARTHEST: f32 = 0.49;

/// Σⱼ f(r)·(xᵢ − xⱼ)/r² over all other points nearer than 0.49, for every i: thesis eq. 5.7. `f` holds
/// the strengths at r = k·½/(len − 1), linear in between.
///
/// In single precision but for the sums' order, which is fixed: coordinates are good to 6e-8, a
/// hundredth of a bin for thousands of points. Same bits on any CPU: nothing is fused. O(n²), about
/// 1.5 ns a pair and core.
pub(super) fn table_forces(points: &[DVec2], f: &[f64]) -> Vec<DVec2> {
    let padded = |coordinate: fn(&DVec2) -> f64| {
        let mut list: Vec<f32> = points.iter().map(|p| coordinate(p) as f32).collect();
        list.resize(points.len().next_multiple_of(CHUNK), OUTSIDE);
        list
    };
    let table = Table {
        x: padded(|p| p.x),
        y: padded(|p| p.y),
        per_unit: 2.0 * (f.len() - 1) as f32,
        // Pairs of (value, difference to the next): one look-up.
        strengths: (0..f.len())
            .map(|k| (f[k] as f32, (f.get(k + 1).unwrap_or(&f[k]) - f[k]) as f32))
            .collect(),
    };
    let mut forces = vec![DVec2::ZERO; points.len()];
    forces.par_chunks_mut(ROWS).enumerate().for_each(|(block, forces)| {
        for (i, force) in (block * ROWS..).zip(forces) {
            *force = table.force_on(i);
        }
    });
    forces
}

/// A coordinate that is too far from every point.
const OUTSIDE: f32 = 4.0;

struct Table {
    /// Whole chunks: what is beyond the points is outside.
    x: Vec<f32>,
    y: Vec<f32>,
    /// Entries of the table to a unit of length.
    per_unit: f32,
    strengths: Vec<(f32, f32)>,
}

impl Table {
    fn force_on(&self, i: usize) -> DVec2 {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") {
            // SAFETY: the CPU has just been found to have the feature.
            return unsafe { force_on_avx2(self, i) };
        }
        force_on(self, i)
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn force_on_avx2(table: &Table, i: usize) -> DVec2 {
    force_on(table, i)
}

#[inline(always)]
fn force_on(table: &Table, i: usize) -> DVec2 {
    let (x, y) = (table.x[i], table.y[i]);
    let last = (table.strengths.len() - 1) as f32;
    let (mut dx, mut dy) = ([0.0_f32; CHUNK], [0.0_f32; CHUNK]);
    let (mut positions, mut inverse) = ([0.0_f32; CHUNK], [0.0_f32; CHUNK]);
    let mut strength = [0.0_f32; CHUNK];
    let mut force = DVec2::ZERO;
    for (xs, ys) in table.x.as_chunks::<CHUNK>().0.iter().zip(table.y.as_chunks::<CHUNK>().0) {
        for j in 0..CHUNK {
            dx[j] = shortest(x - xs[j]);
            dy[j] = shortest(y - ys[j]);
            let square = dx[j] * dx[j] + dy[j] * dy[j];
            let r = square.sqrt();
            // Neither the point itself nor what coincides with it or is too far.
            inverse[j] = if r > 1e-9 && r < FARTHEST { 1.0 / square } else { 0.0 };
            let position = r * table.per_unit;
            positions[j] = if position < last { position } else { last };
        }
        for j in 0..CHUNK {
            let k = positions[j] as usize;
            let (value, difference) = table.strengths[k];
            strength[j] = value + difference * (positions[j] - k as f32);
        }
        let (mut fx, mut fy) = ([0.0_f32; 8], [0.0_f32; 8]);
        for j in (0..CHUNK).step_by(8) {
            for lane in 0..8 {
                let weight = strength[j + lane] * inverse[j + lane];
                fx[lane] += weight * dx[j + lane];
                fy[lane] += weight * dy[j + lane];
            }
        }
        force += DVec2::new(sum(fx), sum(fy));
    }
    force
}

#[inline(always)]
fn sum(lanes: [f32; 8]) -> f64 {
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

    #[test]
    fn forces_are_the_sums_over_all_pairs() {
        for n in [1, 2, 3, 300, 1000] {
            let points = uniform_points(n, Seed::new(2), 0).expect("few points");
            let f: Vec<f64> = (0..=200).map(|k| libm::sin(0.1 * f64::from(k))).collect();
            let got = table_forces(&points, &f);
            for (i, got) in got.iter().enumerate() {
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
                assert!((*got - want).length() < 1e-4 * size, "{n}: {got} against {want}");
            }
        }
    }
}
