//! The innermost loops: a kernel's taps added to the grid, or summed from it.

use bn_fft::Complex;

use super::kernel::MAX_WIDTH;
use super::located::Located;
use super::real::Real;
use super::simd::{Job, Simd, multiply_add};
use super::strip::{Packing, Strip};

/// Strengths of the points of a type 1 transform, in the caller's order.
#[derive(Clone, Copy, Debug)]
pub(super) enum Strengths<'a> {
    Unit,
    Real(&'a [f64]),
    Complex(&'a [Complex<f64>]),
}

impl<'a> Strengths<'a> {
    /// Real strengths of `points` points, 1 if none are given.
    pub(super) fn real(strengths: Option<&'a [f64]>, points: usize) -> Self {
        strengths.map_or(Self::Unit, |strengths| {
            assert_eq!(strengths.len(), points, "one strength a point");
            Self::Real(strengths)
        })
    }

    /// Complex strengths of `points` points.
    pub(super) fn complex(strengths: &'a [Complex<f64>], points: usize) -> Self {
        assert_eq!(strengths.len(), points, "one strength a point");
        Self::Complex(strengths)
    }

    #[inline(always)]
    pub(super) fn get(self, index: u32) -> Complex<f64> {
        match self {
            Self::Unit => Complex::new(1.0, 0.0),
            Self::Real(strengths) => Complex::new(strengths[index as usize], 0.0),
            Self::Complex(strengths) => strengths[index as usize],
        }
    }
}

/// The tap polynomials of a kernel, and the instructions to evaluate them with.
#[derive(Clone, Debug)]
#[expect(clippy::struct_field_names, reason = "the taps of a row are what the word means")]
pub(super) struct Taps<T> {
    width: usize,
    /// Taps a row, 4, 8, 12 or 16.
    taps: usize,
    /// As `KaiserBessel::polynomials` makes them.
    polynomials: Vec<T>,
    pub(super) simd: Simd,
}

impl<T: Real> Taps<T> {
    pub(super) fn new(width: usize, taps: usize, polynomials: Vec<T>, simd: Simd) -> Self {
        Self { width, taps, polynomials, simd }
    }
}

/// Adds the kernels of `points` to the rows of `strip`.
pub struct Spread<'a, 'b, T> {
    pub(super) taps: &'a Taps<T>,
    pub(super) points: &'a [Located<T>],
    /// −(grid size) for points whose rows reach the strip by wrapping round, else 0.
    pub(super) shift: i64,
    pub(super) strengths: Strengths<'a>,
    pub(super) strip: &'a mut Strip<'b, T>,
}

impl<T: Real> Job for Spread<'_, '_, T> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        match self.taps.taps {
            4 => self.spread::<FUSED, 4>(),
            8 => self.spread::<FUSED, 8>(),
            12 => self.spread::<FUSED, 12>(),
            _ => self.spread::<FUSED, 16>(),
        }
    }
}

/// Sums, for each of `points`, the cells of `strip` under its kernel times its taps.
pub struct Gather<'a, 'b, T> {
    pub(super) taps: &'a Taps<T>,
    pub(super) points: &'a [Located<T>],
    /// As in [`Spread`].
    pub(super) shift: i64,
    pub(super) strip: &'a Strip<'b, T>,
    pub(super) sums: &'a mut [Complex<T>],
}

impl<T: Real> Job for Gather<'_, '_, T> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        match self.taps.taps {
            4 => self.gather::<FUSED, 4>(),
            8 => self.gather::<FUSED, 8>(),
            12 => self.gather::<FUSED, 12>(),
            _ => self.gather::<FUSED, 16>(),
        }
    }
}

/// The same with the kernel's derivatives, real rows in pairs: by z along x in the real, along y in
/// the imaginary part of each sum.
pub struct GatherGradient<'a, 'b, T>(pub(super) Gather<'a, 'b, T>);

impl<T: Real> Job for GatherGradient<'_, '_, T> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        match self.0.taps.taps {
            4 => self.0.gather_gradient::<FUSED, 4>(),
            8 => self.0.gather_gradient::<FUSED, 8>(),
            12 => self.0.gather_gradient::<FUSED, 12>(),
            _ => self.0.gather_gradient::<FUSED, 16>(),
        }
    }
}

/// The values of all taps at `z` and their derivatives, by Horner's rule.
#[inline(always)]
fn differentiate<T: Real, const FUSED: bool, const TAPS: usize>(
    polynomials: &[T],
    z: T,
) -> [[T; TAPS]; 2] {
    let mut values = [T::default(); TAPS];
    let mut slopes = values;
    for row in polynomials.as_chunks::<TAPS>().0 {
        for i in 0..TAPS {
            slopes[i] = multiply_add::<T, FUSED>(slopes[i], z, values[i]);
            values[i] = multiply_add::<T, FUSED>(values[i], z, row[i]);
        }
    }
    [values, slopes]
}

/// The values of all taps at `z`, by Horner's rule.
#[inline(always)]
fn evaluate<T: Real, const FUSED: bool, const TAPS: usize>(polynomials: &[T], z: T) -> [T; TAPS] {
    let mut values = [T::default(); TAPS];
    for row in polynomials.as_chunks::<TAPS>().0 {
        for i in 0..TAPS {
            values[i] = multiply_add::<T, FUSED>(values[i], z, row[i]);
        }
    }
    values
}

/// Room for the widest kernel from an odd row on, in pairs of rows.
const ROOM: usize = MAX_WIDTH + 2;

/// The complex rows under a kernel.
struct Rows<T> {
    /// Number of the first one.
    first: i64,
    count: usize,
    /// The taps along y, from the first grid row of the first complex row on.
    taps: [T; ROOM],
    packing: Packing,
}

impl<T: Real> Rows<T> {
    #[inline(always)]
    fn under<const TAPS: usize>(
        width: usize,
        packing: Packing,
        row: i64,
        values: &[T; TAPS],
    ) -> Self {
        let mut taps = [T::default(); ROOM];
        match packing {
            Packing::Single => {
                taps[..TAPS].copy_from_slice(values);
                Self { first: row, count: width, taps, packing }
            }
            Packing::Paired => {
                let odd = (row & 1) as usize;
                taps[odd..odd + TAPS].copy_from_slice(values);
                Self { first: row >> 1, count: (odd + width).div_ceil(2), taps, packing }
            }
        }
    }

    /// The factors of the real and the imaginary part of row `q`.
    #[inline(always)]
    fn factors(&self, q: usize) -> (T, T) {
        match self.packing {
            Packing::Single => (self.taps[q], self.taps[q]),
            Packing::Paired => (self.taps[2 * q], self.taps[2 * q + 1]),
        }
    }
}

impl<T: Real> Spread<'_, '_, T> {
    #[inline(always)]
    fn spread<const FUSED: bool, const TAPS: usize>(self) {
        let Self { taps, points, shift, strengths, strip } = self;
        for point in points {
            let strength = strengths.get(point.index);
            let (re, im) = match strip.packing {
                Packing::Single => (T::narrow(strength.re), T::narrow(strength.im)),
                Packing::Paired => (T::narrow(strength.re), T::narrow(strength.re)),
            };
            let x = evaluate::<T, FUSED, TAPS>(&taps.polynomials, point.zx);
            let y = evaluate::<T, FUSED, TAPS>(&taps.polynomials, point.zy);
            let mut across = [Complex::new(re, im); TAPS];
            for i in 0..TAPS {
                across[i].re *= x[i];
                across[i].im *= x[i];
            }
            let rows = Rows::under(taps.width, strip.packing, i64::from(point.row) + shift, &y);
            let (from, to) = strip.clip(rows.first, rows.count);
            for q in from..to {
                let (re, im) = rows.factors(q);
                let cells = strip.cells_mut::<TAPS>((rows.first + q as i64) as usize, point.column);
                for i in 0..TAPS {
                    cells[i].re = multiply_add::<T, FUSED>(across[i].re, re, cells[i].re);
                    cells[i].im = multiply_add::<T, FUSED>(across[i].im, im, cells[i].im);
                }
            }
        }
    }
}

impl<T: Real> Gather<'_, '_, T> {
    #[inline(always)]
    fn gather<const FUSED: bool, const TAPS: usize>(self) {
        let Self { taps, points, shift, strip, sums } = self;
        let zero = Complex::new(T::default(), T::default());
        for (point, out) in points.iter().zip(sums) {
            let x = evaluate::<T, FUSED, TAPS>(&taps.polynomials, point.zx);
            let y = evaluate::<T, FUSED, TAPS>(&taps.polynomials, point.zy);
            let rows = Rows::under(taps.width, strip.packing, i64::from(point.row) + shift, &y);
            let (from, to) = strip.clip(rows.first, rows.count);
            let mut columns = [zero; TAPS];
            for q in from..to {
                let (re, im) = rows.factors(q);
                let cells = strip.cells::<TAPS>((rows.first + q as i64) as usize, point.column);
                for i in 0..TAPS {
                    columns[i].re = multiply_add::<T, FUSED>(cells[i].re, re, columns[i].re);
                    columns[i].im = multiply_add::<T, FUSED>(cells[i].im, im, columns[i].im);
                }
            }
            *out = zero;
            for i in 0..TAPS {
                out.re = multiply_add::<T, FUSED>(columns[i].re, x[i], out.re);
                out.im = multiply_add::<T, FUSED>(columns[i].im, x[i], out.im);
            }
        }
    }

    #[inline(always)]
    fn gather_gradient<const FUSED: bool, const TAPS: usize>(self) {
        let Self { taps, points, shift, strip, sums } = self;
        for (point, out) in points.iter().zip(sums) {
            let [x, x_slopes] = differentiate::<T, FUSED, TAPS>(&taps.polynomials, point.zx);
            let [y, y_slopes] = differentiate::<T, FUSED, TAPS>(&taps.polynomials, point.zy);
            let row = i64::from(point.row) + shift;
            let rows = Rows::under(taps.width, strip.packing, row, &y);
            let slope_rows = Rows::under(taps.width, strip.packing, row, &y_slopes);
            let (from, to) = strip.clip(rows.first, rows.count);
            let mut columns = [T::default(); TAPS];
            let mut slope_columns = columns;
            for q in from..to {
                let (even, odd) = rows.factors(q);
                let (even_slope, odd_slope) = slope_rows.factors(q);
                let cells = strip.cells::<TAPS>((rows.first + q as i64) as usize, point.column);
                for i in 0..TAPS {
                    let (a, b) = (cells[i].re, cells[i].im);
                    columns[i] = multiply_add::<T, FUSED>(a, even, columns[i]);
                    columns[i] = multiply_add::<T, FUSED>(b, odd, columns[i]);
                    slope_columns[i] = multiply_add::<T, FUSED>(a, even_slope, slope_columns[i]);
                    slope_columns[i] = multiply_add::<T, FUSED>(b, odd_slope, slope_columns[i]);
                }
            }
            *out = Complex::new(T::default(), T::default());
            for i in 0..TAPS {
                out.re = multiply_add::<T, FUSED>(columns[i], x_slopes[i], out.re);
                out.im = multiply_add::<T, FUSED>(slope_columns[i], x[i], out.im);
            }
        }
    }
}
