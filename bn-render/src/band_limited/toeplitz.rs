//! The matrix of the normal equations, applied by FFT.

use rayon::prelude::*;

use super::error::BandLimitedError;
use super::grid::{Grid, good_size};
use super::modes::{Degree, Modes};
use super::scattered::Scattered;

/// T: (T a)(k) = Σ τ(k − l) a(l), |k|, |l| ≤ K.
///
/// As a circulant of more than 4K places a side, which the FFT turns into a product: the polynomial
/// of a on that grid times the function with the modes τ(k), |k| ≤ 2K, and back. What wraps around
/// stays beyond K.
pub(super) struct Toeplitz {
    grid: Grid,
    /// The samples, low-passed to twice the degree, on the grid.
    density: Vec<f64>,
    values: Vec<f64>,
}

impl Toeplitz {
    pub(super) fn new(samples: &Scattered) -> Result<Self, BandLimitedError> {
        let (width, height) = grid_size(samples.degree());
        let grid = Grid::new(width, height);
        let mut density = Vec::new();
        grid.values(&samples.weight_modes()?, &mut density);
        Ok(Self { grid, density, values: Vec::new() })
    }

    pub(super) fn apply(&mut self, modes: &Modes, out: &mut Modes) {
        self.grid.values(modes, &mut self.values);
        let width = self.grid.width();
        let rows =
            self.values.par_chunks_exact_mut(width).zip(self.density.par_chunks_exact(width));
        rows.for_each(|(row, density)| {
            row.iter_mut().zip(density).for_each(|(value, density)| *value *= density);
        });
        self.grid.modes(&self.values, out);
    }
}

/// The grid that products of this degree need.
pub(super) fn grid_size(degree: Degree) -> (usize, usize) {
    (good_size(4 * degree.x + 1), good_size(4 * degree.y + 1))
}
