//! Polynomials at the centres of pixels.

use rayon::prelude::*;

use super::domain::Domain;
use super::grid::Grid;
use super::modes::Modes;
use super::response::LowPass;
use crate::Window;

/// The low-passed polynomial at the centres of the window's pixels, row by row.
///
/// By FFT on a grid that has an even number of places a pixel, and more than the degree needs: one
/// of them is the centre.
pub(super) fn at_pixels(
    modes: &Modes,
    domain: &Domain,
    low_pass: LowPass<'_>,
    window: Window,
) -> Vec<f64> {
    let degree = modes.degree();
    let mut passed = modes.clone();
    let across = low_pass.gains(degree.x, domain.width);
    let down = low_pass.gains(degree.y, domain.height);
    passed.par_columns_mut().zip(&across).for_each(|(column, across)| {
        for (i, a) in column.iter_mut().enumerate() {
            *a *= across * down[i.abs_diff(degree.y)];
        }
    });
    let finer = |degree: usize, size: usize| 2 * (degree / size + 1);
    let (fine_x, fine_y) = (finer(degree.x, domain.width), finer(degree.y, domain.height));
    let grid = Grid::new(fine_x * domain.width, fine_y * domain.height);
    let mut values = Vec::new();
    grid.values(&passed, &mut values);
    let (left, top) = domain.pixel(window.x, window.y);
    let row = |y: usize| {
        let row = &values[(fine_y * (top + y) + fine_y / 2) * grid.width()..][..grid.width()];
        let columns = left..left + window.width as usize;
        columns.map(|x| row[fine_x * x + fine_x / 2]).collect::<Vec<f64>>()
    };
    debug_assert!(grid.height() >= fine_y * (top + window.height as usize));
    (0..window.height as usize).flat_map(row).collect()
}
