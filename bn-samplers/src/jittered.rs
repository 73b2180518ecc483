//! Jittered sampling: one random point in each cell of a grid.

use std::f64::consts::TAU;

use bn_core::{DVec2, Observer, Progress, Seed, torus};
use rand::{Rng, RngExt};
use rayon::prelude::*;

use crate::common_options::check_range;
use crate::error::{check_count, observe, reserve};
use crate::{
    CountRule, DefaultValue, Method, OptionKind, OptionSpec, PointOrder, Report, Sample,
    SampleError, Sampler,
};

/// The centres of n cells of equal area, each displaced at random.
///
/// For a square n the cells are those of the √n × √n grid, and with the default options the
/// pattern is stratified sampling: P(k) = 1 − sinc²(`k_x`/√n) sinc²(`k_y`/√n) for k ≠ 0 (thesis
/// eq. 3.15). For any other n the unit square is cut into ⌊√n⌉ rows that hold ⌊n/rows⌋ or ⌈n/rows⌉
/// cells each and are as high as their cells' share of the area, so every cell has the area 1/n.
///
/// Thesis §3.3 and p. 108; R. L. Cook, "Stochastic sampling in computer graphics", ACM Trans.
/// Graph. 5(1), 1986.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jittered {
    /// How the displacements are distributed.
    pub distribution: Displacement,
    /// Width of the displacements as a fraction of the cell's size, from 0 to 10⁶: 0 gives
    /// the grid of cell centres, 1 fills the cell, more reaches into the neighbours.
    pub width: f64,
}

/// The distribution of a random displacement, independent in both axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Displacement {
    /// Uniform over `width` cells around the centre.
    Uniform,
    /// Normal with the standard deviation width/√12 cells, that of the uniform one.
    Gaussian,
}

impl Default for Jittered {
    fn default() -> Self {
        Self { distribution: Displacement::Uniform, width: 1.0 }
    }
}

/// The registry's entry.
pub(crate) const METHOD: Method = Method {
    name: "jittered",
    aliases: &["jitter", "stratified", "jittered-grid"],
    summary: "one random point in each cell of a grid",
    page: Some(108),
    citation: "R. L. Cook, Stochastic sampling in computer graphics, ACM Trans. Graph. 5(1), 1986",
    complexity: "O(n)",
    order: PointOrder::Scan,
    counts: CountRule::Any,
    seeded: true,
    options: &[
        OptionSpec {
            name: "distribution",
            kind: OptionKind::Choice(&["uniform", "gaussian"]),
            default: DefaultValue::Value("uniform"),
            help: "how points are displaced from the cell centres; gaussian has the variance of uniform",
            unit: "",
        },
        OptionSpec {
            name: "width",
            kind: OptionKind::Real { min: 0.0, max: WIDEST },
            default: DefaultValue::Value("1"),
            help: "width of the displacements: 0 is the grid, 1 fills the cell",
            unit: "cells",
        },
    ],
    build: |options| {
        Ok(Box::new(Jittered {
            distribution: match options.choice("distribution") {
                Some("gaussian") => Displacement::Gaussian,
                _ => Displacement::Uniform,
            },
            width: options.number("width"),
        }))
    },
    version: 1,
};

/// The largest width: beyond it a displacement has lost the digits that wrapping would keep.
const WIDEST: f64 = 1e6;

impl Sampler for Jittered {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        check_count(METHOD.name, n)?;
        check_range("width", self.width, 0.0, WIDEST)?;
        observe(observer, &Progress::new("drawing", 0, Some(n as u64)))?;
        let mut points = reserve(n)?;
        points.resize(n, DVec2::ZERO);
        let mut rows = Vec::new();
        let mut rest = points.as_mut_slice();
        for row in rows_of_cells(n) {
            let (cells, others) = rest.split_at_mut(row.cells);
            rest = others;
            rows.push((row, cells));
        }
        rows.par_iter_mut().with_min_len(16).for_each(|(row, points)| {
            let mut rng = seed.stream(row.index);
            for (column, p) in points.iter_mut().enumerate() {
                *p = row.centre(column) + row.cell_size() * self.displacement(&mut rng);
                *p = torus::wrap_point(*p);
            }
        });
        Ok(Sample::new(points, Report::new()))
    }
}

impl Jittered {
    /// A displacement in units of the cell.
    fn displacement(&self, rng: &mut impl Rng) -> DVec2 {
        let (u, v) = (rng.random::<f64>(), rng.random::<f64>());
        match self.distribution {
            Displacement::Uniform => self.width * DVec2::new(u - 0.5, v - 0.5),
            Displacement::Gaussian => {
                // Box and Muller: 1 − u is never 0, so the logarithm is finite.
                let radius = self.width * (-libm::log(1.0 - u) / 6.0).sqrt();
                radius * DVec2::new(libm::cos(TAU * v), libm::sin(TAU * v))
            }
        }
    }
}

/// One row of cells of equal size.
struct Row {
    /// Number of the row, from below.
    index: u32,
    /// Cells in the row.
    cells: usize,
    /// Lower edge.
    y: f64,
    /// Height: the row's share of all cells.
    height: f64,
}

impl Row {
    fn cell_size(&self) -> DVec2 {
        DVec2::new(1.0 / self.cells as f64, self.height)
    }

    fn centre(&self, column: usize) -> DVec2 {
        DVec2::new((column as f64 + 0.5) / self.cells as f64, self.y + 0.5 * self.height)
    }
}

/// The unit square cut into n cells of equal area, as near to squares as whole rows allow.
fn rows_of_cells(n: usize) -> impl Iterator<Item = Row> {
    let rows = (n as f64).sqrt().round().max(1.0) as usize;
    // Row k ends where its share of the cells is used up: ⌊(k + 1)·n/rows⌋.
    let end = move |k: usize| (k as u128 * n as u128 / rows as u128) as usize;
    (0..rows).map(move |k| {
        let (first, last) = (end(k), end(k + 1));
        let (y, top) = (first as f64 / n as f64, last as f64 / n as f64);
        Row { index: k as u32, cells: last - first, y, height: top - y }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::Unobserved;

    #[test]
    fn square_counts_put_one_point_in_each_cell() {
        let sample = Jittered::default().sample(64, Seed::new(1), &Unobserved).expect("valid");
        for (i, p) in sample.points.points().iter().enumerate() {
            assert_eq!((p * 8.0).floor(), DVec2::new((i % 8) as f64, (i / 8) as f64));
        }
    }

    #[test]
    fn cells_tile_the_square_for_any_count() {
        for n in [1, 2, 3, 5, 7, 12, 17, 1000, 4095, 4097] {
            let rows: Vec<_> = rows_of_cells(n).collect();
            assert_eq!(rows.iter().map(|row| row.cells).sum::<usize>(), n);
            let mut top = 0.0;
            for row in &rows {
                assert_eq!(row.y, top);
                top = row.y + row.height;
                let size = row.cell_size();
                assert!((size.x * size.y * n as f64 - 1.0).abs() < 1e-9, "area for {n}");
                let aspect = size.x / size.y;
                assert!(n < 12 || (0.65..1.5).contains(&aspect), "aspect {aspect} for {n}");
            }
            assert!((top - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn both_distributions_have_the_stated_variance() {
        for distribution in [Displacement::Uniform, Displacement::Gaussian] {
            let jittered = Jittered { distribution, width: 0.3 };
            let mut rng = Seed::new(5).stream(0);
            let n = 100_000;
            let mut sum = [DVec2::ZERO; 2];
            for _ in 0..n {
                let d = jittered.displacement(&mut rng);
                sum = [sum[0] + d, sum[1] + d * d];
            }
            let sigma = 0.3 / 12.0_f64.sqrt();
            // Standard error of a mean: sigma/√n; of a variance: at most √2·sigma²/√n (normal).
            let error = 5.0 / f64::from(n).sqrt();
            let [mean, variance] = sum.map(|sum| sum / f64::from(n));
            assert!(mean.abs().max_element() < error * sigma);
            let excess = (variance / sigma.powi(2) - 1.0).abs().max_element();
            assert!(excess < error * 2.0_f64.sqrt());
        }
    }
}
