//! Images as scenes.

#![expect(clippy::inline_always, reason = "must be compiled anew under the features of the caller")]

use bn_core::DVec2;

use super::{Color, Scene};
use crate::kernel::{KernelTable, kernel};
use crate::simd::vectorized;
use crate::{Channels, Frame, Image, Rect};

/// How an image is continued between its pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Interpolation {
    /// The value of the pixel that holds the point.
    Box,
    /// Linear along each axis.
    #[default]
    Bilinear,
    /// The interpolating cubic (Keys's a = −½).
    Bicubic,
    /// Lanczos of radius 3, weights normalised.
    Lanczos,
}

impl Interpolation {
    /// The name of the kernel it convolves with.
    fn kernel_name(self) -> &'static str {
        match self {
            Self::Box => "box",
            Self::Bilinear => "tent",
            Self::Bicubic => "bicubic",
            Self::Lanczos => "lanczos3",
        }
    }
}

/// An image laid over the image plane, continued beyond its border by its border pixels.
///
/// The value is c + Σ w (I − c)/Σ w over the pixels that the interpolation reaches, c the first of
/// them: equal pixels give their value exactly.
#[derive(Clone, Debug)]
pub struct Picture {
    source: Source,
    extremes: Extremes,
}

#[derive(Clone, Debug)]
struct Source {
    image: Image,
    table: KernelTable,
    /// A point of the plane lies at `scale·at + offset` of the image, in its pixels.
    scale: DVec2,
    offset: DVec2,
}

impl Picture {
    /// The image stretched over the whole frame.
    pub fn covering(image: Image, interpolation: Interpolation, frame: &Frame) -> Self {
        let size = DVec2::new(f64::from(image.width()), f64::from(image.height()));
        let scale = size / DVec2::new(f64::from(frame.width()), f64::from(frame.height()));
        Self::placed(image, interpolation, scale, DVec2::ZERO)
    }

    /// The image of which the plane's point `at` shows the point `scale·at + offset`, in pixels of
    /// the image.
    ///
    /// # Panics
    /// If the scale or the offset is not finite.
    pub fn placed(image: Image, interpolation: Interpolation, scale: DVec2, offset: DVec2) -> Self {
        assert!(scale.is_finite() && offset.is_finite(), "no placement: {scale}, {offset}");
        let kernel = kernel(interpolation.kernel_name()).expect("interpolations name kernels");
        let extremes = Extremes::of(&image);
        Self { source: Source { image, table: KernelTable::new(kernel), scale, offset }, extremes }
    }

    /// The image.
    pub fn image(&self) -> &Image {
        &self.source.image
    }

    /// Extremes of each channel over all pixels that points of the rectangle may depend on.
    fn extremes_over(&self, rect: &Rect) -> [(f32, f32); 3] {
        let Source { table, scale, offset, .. } = &self.source;
        let ends = [rect.min * *scale + *offset, rect.max * *scale + *offset];
        // A pixel more than the interpolation reaches makes up for rounding.
        let reach = table.radius() + 1.0;
        let (low, high) = (ends[0].min(ends[1]) - reach, ends[0].max(ends[1]) + reach);
        self.extremes.over(&self.source.image, low, high)
    }
}

impl Scene for Picture {
    fn channels(&self) -> Channels {
        self.source.image.channels()
    }

    fn values(&self, u: &[f64], v: &[f64], out: &mut [f64]) {
        match self.source.table.lanes() {
            1 => interpolate::<1>(u, v, &self.source, out),
            2 => interpolate::<2>(u, v, &self.source, out),
            4 => interpolate::<4>(u, v, &self.source, out),
            _ => interpolate::<6>(u, v, &self.source, out),
        }
    }

    fn constant_over(&self, rect: &Rect) -> Option<Color> {
        let extremes = self.extremes_over(rect);
        let constant = extremes.iter().all(|(low, high)| low == high);
        constant.then(|| extremes.map(|(low, _)| f64::from(low)))
    }

    /// Known for weights that are never negative: box and bilinear.
    fn bounds_over(&self, rect: &Rect) -> Option<(f64, f64)> {
        if self.source.table.taps() > 2 {
            return None;
        }
        let used = &self.extremes_over(rect)[..self.channels().count()];
        let low = used.iter().map(|e| e.0).fold(f32::INFINITY, f32::min);
        let high = used.iter().map(|e| e.1).fold(f32::NEG_INFINITY, f32::max);
        // Rounding of the weights.
        let slack = 1e-12 * f64::from(high.abs().max(low.abs()));
        Some((f64::from(low) - slack, f64::from(high) + slack))
    }
}

vectorized! {
    fn interpolate<const M: usize>(u: &[f64], v: &[f64], source: &Source, out: &mut [f64]) {
        let channels = source.image.channels().count();
        let n = u.len();
        for i in 0..n {
            let x = Reach::<M>::of(u[i] * source.scale.x + source.offset.x, source.image.width(), &source.table);
            let y = Reach::<M>::of(v[i] * source.scale.y + source.offset.y, source.image.height(), &source.table);
            let (mut sums, mut total) = ([0.0; 3], 0.0);
            let pixels = source.image.values();
            let at = |row: usize, column: usize| (row * source.image.width() as usize + column) * channels;
            let first = at(y.pixels[0], x.pixels[0]);
            for (&row, &wy) in y.pixels.iter().zip(&y.weights) {
                for (&column, &wx) in x.pixels.iter().zip(&x.weights) {
                    let (w, place) = (wx * wy, at(row, column));
                    total += w;
                    for c in 0..channels {
                        sums[c] += w * (f64::from(pixels[place + c]) - f64::from(pixels[first + c]));
                    }
                }
            }
            for c in 0..channels {
                out[c * n + i] = f64::from(pixels[first + c]) + sums[c] / total;
            }
        }
    }
}

/// The pixels along one axis that a point depends on, and their weights.
struct Reach<const M: usize> {
    pixels: [usize; M],
    weights: [f64; M],
}

impl<const M: usize> Reach<M> {
    #[inline(always)]
    fn of(x: f64, length: u32, table: &KernelTable) -> Self {
        let shifted = x - table.phase();
        let cell = shifted.floor();
        let weights = table.weights::<M>(shifted - cell);
        let first = cell as i64 + table.first_tap();
        let last = i64::from(length) - 1;
        let pixels = std::array::from_fn(|k| (first + k as i64).clamp(0, last) as usize);
        Self { pixels, weights }
    }
}

/// The smallest and largest values of each channel in square tiles of an image.
#[derive(Clone, Debug)]
struct Extremes {
    columns: usize,
    rows: usize,
    tiles: Vec<[(f32, f32); 3]>,
}

impl Extremes {
    const TILE: usize = 16;
    const NONE: [(f32, f32); 3] = [(f32::INFINITY, f32::NEG_INFINITY); 3];

    fn of(image: &Image) -> Self {
        let columns = (image.width() as usize).div_ceil(Self::TILE);
        let rows = (image.height() as usize).div_ceil(Self::TILE);
        let mut tiles = vec![Self::NONE; columns * rows];
        for (y, row) in image.values().chunks_exact(image.row_len()).enumerate() {
            let tiles = &mut tiles[y / Self::TILE * columns..][..columns];
            for (x, pixel) in row.chunks_exact(image.channels().count()).enumerate() {
                for (extremes, &value) in tiles[x / Self::TILE].iter_mut().zip(pixel) {
                    *extremes = (extremes.0.min(value), extremes.1.max(value));
                }
            }
        }
        Self { columns, rows, tiles }
    }

    /// Extremes over all tiles that meet the given range of pixels, clamped to the image; the
    /// channels the image lacks are (0, 0).
    fn over(&self, image: &Image, low: DVec2, high: DVec2) -> [(f32, f32); 3] {
        let tile = |x: f64, length: u32, count: usize| {
            ((x.max(0.0) as usize).min(length as usize - 1) / Self::TILE).min(count - 1)
        };
        let columns =
            tile(low.x, image.width(), self.columns)..=tile(high.x, image.width(), self.columns);
        let rows = tile(low.y, image.height(), self.rows)..=tile(high.y, image.height(), self.rows);
        let mut all = Self::NONE;
        for row in rows {
            for tile in &self.tiles[row * self.columns..][columns.clone()] {
                for (all, tile) in all.iter_mut().zip(tile) {
                    *all = (all.0.min(tile.0), all.1.max(tile.1));
                }
            }
        }
        for unused in &mut all[image.channels().count()..] {
            *unused = (0.0, 0.0);
        }
        all
    }
}
