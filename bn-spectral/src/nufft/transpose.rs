//! Between the rows of a strip and the columns of the spectrum; where real rows go in pairs, also
//! between the transform of a pair and those of its rows.
//!
//! With a the even row and b the odd one, Z = A + iB. As a and b are real,
//! 2A(k) = Z(k) + Z(−k)*, 2B(k) = (Z(k) − Z(−k)*)/i, and Z(−k) = A(k)* + iB(k)*.
//!
//! And the step from the spectrum to the modes, which is a multiplication.

use std::ops::Range;

use bn_fft::Complex;

use super::real::Real;
use super::simd::Job;
use super::strip::{Packing, Strip};

/// Writes columns of a strip to `out`, one after the other, each from the strip's first grid row
/// to its last. Of paired rows, twice the value.
pub struct ToColumns<'a, 'b, T> {
    pub(super) strip: &'a Strip<'b, T>,
    /// Grid columns, counted on beyond the grid's side.
    pub(super) columns: Range<usize>,
    pub(super) out: &'a mut [Complex<T>],
}

impl<T: Real> Job for ToColumns<'_, '_, T> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Self { strip, columns, out } = self;
        let grid = strip.grid();
        let each = out.chunks_exact_mut(out.len() / columns.len());
        for (k, out) in columns.zip(each) {
            let column = strip.column(k % grid);
            match strip.packing {
                Packing::Single => out.iter_mut().zip(column).for_each(|(o, z)| *o = z),
                Packing::Paired => {
                    let opposite = strip.column((grid - k) % grid);
                    let pairs = out.as_chunks_mut().0.iter_mut();
                    for (([a, b], p), m) in pairs.zip(column).zip(opposite) {
                        *a = Complex::new(p.re + m.re, p.im - m.im);
                        *b = Complex::new(p.im + m.im, m.re - p.re);
                    }
                }
            }
        }
    }
}

/// Reads the cells of a strip from columns, kx after kx, each given on the strip's grid rows.
/// Cells of other columns become 0.
pub struct FromColumns<'a, 'b, T> {
    pub(super) strip: &'a mut Strip<'b, T>,
    /// As in [`ToColumns`].
    pub(super) columns: Range<usize>,
    /// All grid rows of all columns.
    pub(super) spectrum: &'a [Complex<T>],
}

impl<T: Real> Job for FromColumns<'_, '_, T> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Self { strip, columns, spectrum } = self;
        let grid = strip.grid();
        let rows = strip.grid_rows();
        let last = columns.end - 1;
        strip.clear_columns(last % grid + 1..grid - last % grid);
        for (k, column) in columns.zip(spectrum.chunks_exact(grid)) {
            let column = &column[rows.clone()];
            match strip.packing {
                Packing::Single => {
                    strip.column_mut(k % grid).zip(column).for_each(|(z, &c)| *z = c);
                }
                Packing::Paired => {
                    let pairs = column.as_chunks().0;
                    for (z, [a, b]) in strip.column_mut(k).zip(pairs) {
                        *z = Complex::new(a.re - b.im, a.im + b.re);
                    }
                    for (z, [a, b]) in strip.column_mut((grid - k) % grid).zip(pairs) {
                        *z = Complex::new(a.re + b.im, b.re - a.im);
                    }
                }
            }
        }
    }
}

/// out = from · along · factor, number by number.
pub struct Scale<'a, T> {
    pub(super) out: &'a mut [Complex<T>],
    pub(super) from: &'a [Complex<T>],
    pub(super) along: &'a [T],
    pub(super) factor: T,
}

impl<T: Real> Job for Scale<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        for ((o, z), &d) in self.out.iter_mut().zip(self.from).zip(self.along) {
            let d = d * self.factor;
            *o = Complex::new(z.re * d, z.im * d);
        }
    }
}
