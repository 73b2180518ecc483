//! How densely points are wanted where.

use glam::DVec2;
use thiserror::Error;

/// A density function on the unit torus: how many points an area is to hold, relative to the mean.
///
/// It is constant on each pixel of a raster, so that masses are exact: pixel (i, j) covers
/// x in [i/width, (i+1)/width) and y in [j/height, (j+1)/height), row 0 at y = 0. Values are scaled
/// to the mean 1 over the torus.
///
/// ```
/// use bn_core::{DVec2, DensityFunction};
///
/// let ramp = DensityFunction::from_fn(64, |p| p.x)?;
/// assert!(ramp.at(DVec2::new(0.9, 0.5)) > 1.7);
/// assert!((ramp.mass(DVec2::ZERO, DVec2::new(0.5, 1.0)) - 0.25).abs() < 1e-12);
/// # Ok::<(), bn_core::DensityFunctionError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Raster", into = "Raster"))]
pub struct DensityFunction {
    width: usize,
    height: usize,
    /// Pixels row by row, of mean 1.
    values: Vec<f64>,
    /// `(width + 1)` numbers a row: the mass of the row's pixels before each, in units of a pixel.
    within_rows: Vec<f64>,
    /// The mass of the rows before each row, `height + 1` numbers, in units of a pixel.
    before_rows: Vec<f64>,
    max: f64,
}

/// What of a density function is stored.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
struct Raster {
    width: usize,
    height: usize,
    values: Vec<f64>,
}

#[cfg(feature = "serde")]
impl TryFrom<Raster> for DensityFunction {
    type Error = DensityFunctionError;

    fn try_from(raster: Raster) -> Result<Self, Self::Error> {
        Self::from_raster(raster.width, raster.height, raster.values)
    }
}

#[cfg(feature = "serde")]
impl From<DensityFunction> for Raster {
    fn from(density: DensityFunction) -> Self {
        Self { width: density.width, height: density.height, values: density.values }
    }
}

/// Why a raster isn't a density function.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum DensityFunctionError {
    /// A side is 0, or there are more than [`DensityFunction::MAX_PIXELS`] pixels.
    #[error("a density of {width}×{height} pixels is not possible; at least one and at most {max}", max = DensityFunction::MAX_PIXELS)]
    Size {
        /// Pixels in a row.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// The number of values is not width × height.
    #[error("{got} values don't make a density of {want} pixels")]
    Count {
        /// Values given.
        got: usize,
        /// Values needed.
        want: usize,
    },
    /// A value is negative, NaN or infinite.
    #[error(
        "the density is {value} at pixel ({column}, {row}), but must be finite and not negative"
    )]
    Value {
        /// The pixel's column.
        column: usize,
        /// The pixel's row, from y = 0.
        row: usize,
        /// The value.
        value: f64,
    },
    /// Every value is 0, or their sum is beyond all numbers.
    #[error("the density sums to {sum}, which can't be scaled to the mean 1")]
    Sum {
        /// The sum.
        sum: f64,
    },
}

impl DensityFunction {
    /// The most pixels: 2²⁶, 1 to 2 GB with the sums.
    pub const MAX_PIXELS: usize = 1 << 26;

    /// The density of these pixels, row by row from y = 0, in any unit.
    ///
    /// # Errors
    /// [`DensityFunctionError`] unless there are width × height values, finite, none negative, and
    /// not all 0.
    pub fn from_raster(
        width: usize,
        height: usize,
        mut values: Vec<f64>,
    ) -> Result<Self, DensityFunctionError> {
        use DensityFunctionError as Error;
        let pixels = width.checked_mul(height).filter(|n| (1..=Self::MAX_PIXELS).contains(n));
        let Some(want) = pixels else { return Err(Error::Size { width, height }) };
        if values.len() != want {
            return Err(Error::Count { got: values.len(), want });
        }
        let valid = |value: &f64| (0.0..f64::INFINITY).contains(value);
        if let Some(bad) = values.iter().position(|value| !valid(value)) {
            let value = values[bad];
            return Err(Error::Value { column: bad % width, row: bad / width, value });
        }
        let sum: f64 = values.iter().sum();
        let mean = sum / want as f64;
        if !(f64::MIN_POSITIVE..f64::INFINITY).contains(&mean) {
            return Err(Error::Sum { sum });
        }
        for value in &mut values {
            *value /= mean;
        }
        Ok(Self::with_sums(width, height, values))
    }

    /// The density `density(p)` at the centres of `side` × `side` pixels.
    ///
    /// # Errors
    /// As [`DensityFunction::from_raster`].
    pub fn from_fn(
        side: usize,
        mut density: impl FnMut(DVec2) -> f64,
    ) -> Result<Self, DensityFunctionError> {
        if side.checked_mul(side).is_none_or(|pixels| pixels > Self::MAX_PIXELS) {
            return Err(DensityFunctionError::Size { width: side, height: side });
        }
        let centre = |i: usize| (i as f64 + 0.5) / side as f64;
        let values = (0..side * side)
            .map(|pixel| density(DVec2::new(centre(pixel % side), centre(pixel / side))))
            .collect();
        Self::from_raster(side, side, values)
    }

    fn with_sums(width: usize, height: usize, values: Vec<f64>) -> Self {
        let mut within_rows = Vec::with_capacity((width + 1) * height);
        let mut before_rows = Vec::with_capacity(height + 1);
        let (mut before, mut max) = (0.0, 0.0_f64);
        before_rows.push(before);
        for row in values.chunks_exact(width) {
            let mut sum = 0.0;
            within_rows.push(sum);
            for &value in row {
                sum += value;
                max = max.max(value);
                within_rows.push(sum);
            }
            before += sum;
            before_rows.push(before);
        }
        Self { width, height, values, within_rows, before_rows, max }
    }

    /// Pixels in a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The pixels, row by row from y = 0, of mean 1.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The density at `p`, a point of [0, 1)²: 1 is the mean. O(1).
    pub fn at(&self, p: DVec2) -> f64 {
        let column = ((p.x * self.width as f64) as usize).min(self.width - 1);
        let row = ((p.y * self.height as f64) as usize).min(self.height - 1);
        self.values[row * self.width + column]
    }

    /// The density whose pixels are in proportion to `value` of this one's.
    ///
    /// # Errors
    /// As [`DensityFunction::from_raster`].
    pub fn map(&self, value: impl Fn(f64) -> f64) -> Result<Self, DensityFunctionError> {
        let values = self.values.iter().map(|&density| value(density)).collect();
        Self::from_raster(self.width, self.height, values)
    }

    /// Whether it is the same everywhere.
    pub fn is_uniform(&self) -> bool {
        self.values.iter().all(|&density| density == self.max)
    }

    /// The largest density.
    pub fn max(&self) -> f64 {
        self.max
    }

    /// The part of all points that the rectangle from `low` to `high` is to hold, 0 to 1, for
    /// corners in [0, 1]². O(height of the rectangle in pixels).
    pub fn mass(&self, low: DVec2, high: DVec2) -> f64 {
        let rows = self.height as f64;
        let (bottom, top) = (low.y * rows, high.y * rows);
        let mut mass = 0.0;
        for row in (bottom.max(0.0) as usize)..(top.ceil() as usize).min(self.height) {
            let covered = top.min(row as f64 + 1.0) - bottom.max(row as f64);
            mass += covered * (self.row_mass(row, high.x) - self.row_mass(row, low.x));
        }
        mass / self.values.len() as f64
    }

    /// The mass of a row's pixels up to `x`, in units of a pixel.
    fn row_mass(&self, row: usize, x: f64) -> f64 {
        let position = (x * self.width as f64).clamp(0.0, self.width as f64);
        let column = (position as usize).min(self.width - 1);
        let before = self.within_rows[row * (self.width + 1) + column];
        before + (position - column as f64) * self.values[row * self.width + column]
    }

    /// The map of the unit square that takes a uniform density to this one: if `u` is uniform in
    /// [0, 1)², the point has this density. Rows by the first of two cumulative sums, columns by
    /// the second. O(log(width · height)).
    pub fn place(&self, u: DVec2) -> DVec2 {
        let (row, y) = invert(&self.before_rows, u.y);
        let start = row * (self.width + 1);
        let (column, x) = invert(&self.within_rows[start..=start + self.width], u.x);
        DVec2::new(inside(column, x, self.width), inside(row, y, self.height))
    }
}

/// The place `part` (0 to 1) of the way through pixel `index` of `count`, moved by roundings only as
/// far as [`DensityFunction::at`] finds it in that pixel.
fn inside(index: usize, part: f64, count: usize) -> f64 {
    let pixel = |x: f64| (x * count as f64) as usize;
    let mut x = (index as f64 + part) / count as f64;
    while x >= 1.0 || pixel(x) > index {
        x = x.next_down();
    }
    while pixel(x) < index {
        x = x.next_up();
    }
    x
}

/// Where a cumulative sum that starts at 0 reaches the part `u` of its last: the interval, always
/// one that isn't empty, and the place in it from 0 to 1.
fn invert(sums: &[f64], u: f64) -> (usize, f64) {
    let target = u * sums[sums.len() - 1];
    let after = sums.partition_point(|&sum| sum <= target).clamp(1, sums.len() - 1);
    // At the very end, rounding may point past the last interval that holds anything.
    let mut interval = after - 1;
    while interval > 0 && sums[interval + 1] <= sums[interval] {
        interval -= 1;
    }
    let width = sums[interval + 1] - sums[interval];
    (interval, ((target - sums[interval]) / width).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn bad_rasters_are_refused() {
        use DensityFunctionError as Error;
        let raster = DensityFunction::from_raster;
        assert!(matches!(raster(0, 3, vec![]), Err(Error::Size { .. })));
        assert!(matches!(raster(usize::MAX, 2, vec![]), Err(Error::Size { .. })));
        assert!(matches!(raster(2, 2, vec![1.0; 3]), Err(Error::Count { got: 3, want: 4 })));
        assert!(matches!(raster(2, 1, vec![0.0; 2]), Err(Error::Sum { .. })));
        assert!(matches!(raster(2, 1, vec![f64::MAX; 2]), Err(Error::Sum { .. })));
        for value in [-1.0, f64::NAN, f64::INFINITY] {
            let error = raster(2, 2, vec![1.0, 1.0, 1.0, value]).expect_err("bad");
            assert!(matches!(error, Error::Value { column: 1, row: 1, .. }), "{error}");
        }
        assert!(DensityFunction::from_fn(1 << 14, |_| 1.0).is_err());
        assert!(DensityFunction::from_fn(0, |_| 1.0).is_err());
    }

    #[test]
    fn empty_pixels_get_no_points() {
        let density = DensityFunction::from_raster(3, 2, vec![0.0, 0.0, 0.0, 0.0, 5.0, 0.0]);
        let density = density.expect("valid");
        for u in [0.0, 0.3, 0.5, 1.0_f64.next_down()] {
            for v in [0.0, 0.7, 1.0_f64.next_down()] {
                let p = density.place(DVec2::new(u, v));
                assert_eq!(density.at(p), 6.0, "{p}");
                assert!((0.333..0.667).contains(&p.x) && (0.5..1.0).contains(&p.y), "{p}");
            }
        }
        assert_eq!(density.at(DVec2::new(0.5, 0.75)), 6.0);
        assert_eq!(density.max(), 6.0);
    }

    proptest! {
        /// The mass of a rectangle is its integral, and `place` makes it.
        #[test]
        fn masses_add_up_and_are_what_place_fills(
            width in 1_usize..6,
            height in 1_usize..6,
            seed in proptest::collection::vec(0.0_f64..1.0, 36),
            corner in (0.0_f64..1.0, 0.0_f64..1.0),
        ) {
            let values = seed[..width * height].iter().map(|v| (v - 0.2).max(0.0)).collect::<Vec<_>>();
            prop_assume!(values.iter().sum::<f64>() > 0.0);
            let density = DensityFunction::from_raster(width, height, values).expect("valid");
            let corner = DVec2::from(corner);
            let (x, y) = (corner.x, corner.y);
            let parts = [
                density.mass(DVec2::ZERO, corner),
                density.mass(DVec2::new(x, 0.0), DVec2::new(1.0, y)),
                density.mass(DVec2::new(0.0, y), DVec2::new(x, 1.0)),
                density.mass(corner, DVec2::ONE),
            ];
            prop_assert!((parts.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            // A midpoint rule over a grid of `place` counts the part below the corner.
            let side = 200;
            let mut below = 0;
            for i in 0..side * side {
                let u = DVec2::new(f64::from(i % side) + 0.5, f64::from(i / side) + 0.5) / f64::from(side);
                let p = density.place(u);
                prop_assert!(crate::torus::contains(p));
                prop_assert!(density.at(p) > 0.0);
                below += i32::from(p.x < x && p.y < y);
            }
            let part = f64::from(below) / f64::from(side * side);
            prop_assert!((part - parts[0]).abs() < 0.02, "{part} of the points, mass {}", parts[0]);
        }
    }
}
