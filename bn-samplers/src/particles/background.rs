//! The grey that attracts particles.

use bn_core::{DVec2, DensityFunction};
use bn_spectral::{HalfPlane, Nufft};
use std::f64::consts::PI;

/// A density in blocks of pixels, and how crowded it is around each block.
pub(super) struct Background {
    columns: usize,
    rows: usize,
    /// The density of each block, row by row.
    density: Vec<f64>,
    /// The largest density of a block nearby.
    crowding: Vec<f64>,
}

/// Blocks for each wave of the highest frequency.
const BLOCKS_A_WAVE: usize = 4;

/// Particles crowd from as far as this, in mean spacings.
const NEARBY: f64 = 1.5;

/// Crowding is at least this, relative to the mean: elsewhere particles are alone.
const SPARSEST: f64 = 0.1;

impl Background {
    /// A density as `n` particles see it by waves of up to `max_frequency`.
    pub(super) fn new(density: &DensityFunction, n: usize, max_frequency: usize) -> Self {
        let most = BLOCKS_A_WAVE * max_frequency.max(1);
        let (columns, rows) = (density.width().min(most), density.height().min(most));
        let size = DVec2::new(columns as f64, rows as f64);
        let corner = |column: usize, row: usize| DVec2::new(column as f64, row as f64) / size;
        let block = |i: usize| {
            let (column, row) = (i % columns, i / columns);
            density.mass(corner(column, row), corner(column + 1, row + 1)) * size.x * size.y
        };
        let density: Vec<f64> = (0..columns * rows).map(block).collect();
        let reach = |side: usize| (NEARBY * side as f64 / (n as f64).sqrt()).ceil() as usize;
        let across = largest_nearby(&density, columns, rows, 1, columns, reach(columns));
        let crowding = largest_nearby(&across, rows, columns, columns, 1, reach(rows));
        Self { columns, rows, density, crowding }
    }

    /// ∫ ρ(x)·exp(−2πi k·x) dx for the density of the blocks.
    pub(super) fn modes(&self, nufft: &mut Nufft) -> HalfPlane {
        let size = DVec2::new(self.columns as f64, self.rows as f64);
        let middle = |i: usize| {
            DVec2::new((i % self.columns) as f64 + 0.5, (i / self.columns) as f64 + 0.5) / size
        };
        let middles: Vec<DVec2> = (0..self.density.len()).map(middle).collect();
        let masses: Vec<f64> = self.density.iter().map(|d| d / (size.x * size.y)).collect();
        let mut modes = HalfPlane::zeros(nufft.max_frequency());
        nufft.points_to_modes(&middles, Some(&masses), &mut modes);
        let last = modes.max_frequency() as i64;
        for (kx, column) in modes.columns_mut().enumerate() {
            let across = sinc(kx as f64 / size.x);
            for (ky, mode) in (-last..).zip(column) {
                *mode *= across * sinc(ky as f64 / size.y);
            }
        }
        modes
    }

    /// How dense particles may be around `p`, relative to the mean.
    pub(super) fn crowding(&self, p: DVec2) -> f64 {
        let index = |x: f64, count: usize| ((x * count as f64) as usize).min(count - 1);
        let block = index(p.y, self.rows) * self.columns + index(p.x, self.columns);
        self.crowding[block].max(SPARSEST)
    }
}

/// The transform of a block.
fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { libm::sin(PI * x) / (PI * x) }
}

/// The largest of the values at most `reach` steps away along the first of two axes of a torus, of
/// which there are `count` values, `stride` apart, and `others` along the second, `other_stride` apart.
fn largest_nearby(
    values: &[f64],
    count: usize,
    others: usize,
    stride: usize,
    other_stride: usize,
    reach: usize,
) -> Vec<f64> {
    let mut largest = vec![0.0; values.len()];
    let reach = reach.min(count / 2);
    for other in 0..others {
        let at = |i: usize| i % count * stride + other * other_stride;
        for i in 0..count {
            let nearby = (i + count - reach..=i + count + reach).map(|j| values[at(j)]);
            largest[at(i)] = nearby.fold(0.0, f64::max);
        }
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_spectral::NufftOptions;

    #[test]
    fn modes_are_integrals_of_the_density() {
        let density = DensityFunction::from_raster(3, 2, vec![1.0, 4.0, 2.0, 0.0, 3.0, 2.0]);
        let density = density.expect("valid");
        let background = Background::new(&density, 10, 8);
        let mut nufft = NufftOptions::new(8, 1e-9).plan().expect("valid");
        let modes = background.modes(&mut nufft);
        assert!((modes.get(0, 0).re - 1.0).abs() < 1e-8);
        for (kx, ky) in [(1, 0), (0, 2), (3, 1), (-2, 5), (8, -8)] {
            // A midpoint rule within pixels: its error is (π·8/300)²/6 at most.
            let side = 300;
            let (mut re, mut im) = (0.0, 0.0);
            for i in 0..side * side {
                let p = DVec2::new(f64::from(i % side) + 0.5, f64::from(i / side) + 0.5)
                    / f64::from(side);
                let phase = -2.0 * PI * (f64::from(kx) * p.x + f64::from(ky) * p.y);
                re += density.at(p) * libm::cos(phase) / f64::from(side * side);
                im += density.at(p) * libm::sin(phase) / f64::from(side * side);
            }
            let got = modes.get(kx.into(), ky.into());
            assert!((got.re - re).abs() + (got.im - im).abs() < 2e-3, "{got} at {kx}, {ky}");
        }
    }

    #[test]
    fn crowding_reaches_beyond_the_crowd() {
        let density =
            DensityFunction::from_fn(100, |p| if torus_distance(p) < 0.1 { 1.0 } else { 0.0 });
        let background = Background::new(&density.expect("valid"), 400, 100);
        let crowded = background.crowding(DVec2::splat(0.5));
        // 1/(π·0.1²), up to pixels; a mean spacing is 0.05.
        assert!((crowded - 31.8).abs() < 1.5, "{crowded}");
        assert!((background.crowding(DVec2::new(0.65, 0.5)) - crowded).abs() < 1e-9);
        assert_eq!(background.crowding(DVec2::new(0.75, 0.5)), SPARSEST);
    }

    fn torus_distance(p: DVec2) -> f64 {
        bn_core::torus::distance(p, DVec2::splat(0.5))
    }
}
