//! Coefficients of real trigonometric polynomials, and the arithmetic that iterations need.

use bn_spectral::Complex;
use rayon::prelude::*;

/// The degree of a trigonometric polynomial: frequencies |kx| ≤ `x`, |ky| ≤ `y`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Degree {
    /// The largest frequency along x, in cycles per period.
    pub x: usize,
    /// The largest along y.
    pub y: usize,
}

impl Degree {
    /// Number of real coefficients, (2x + 1)(2y + 1).
    pub fn coefficients(self) -> usize {
        let count = |most: usize| most.saturating_mul(2).saturating_add(1);
        count(self.x).saturating_mul(count(self.y))
    }

    pub(super) fn doubled(self) -> Self {
        Self { x: 2 * self.x, y: 2 * self.y }
    }

    /// The most numbers that a transform between points and these modes, or twice as many along
    /// each axis, holds at once, the lesser axis lying across: columns times the rows of a grid that is
    /// as fine along both axes, at up to 2.13 times the Nyquist rate.
    pub(super) fn transform_places(self) -> f64 {
        let (least, most) = (self.x.min(self.y) as f64, self.most() as f64);
        let rows = 4.26 * most + 64.0;
        ((2.0 * least + 1.0) * 2.0 * rows).max((most + 1.0) * rows)
    }

    pub(super) fn most(self) -> usize {
        self.x.max(self.y)
    }

    /// That of the same plane with its axes exchanged.
    pub(super) fn transposed(self) -> Self {
        Self { x: self.y, y: self.x }
    }

    /// Whether transforms need less if the axes are exchanged: columns are held whole, so there should
    /// be few.
    pub(super) fn is_wide(self) -> bool {
        self.x > self.y
    }
}

/// Coefficients a(k), a(−k) = a(k)*: those of kx = 0 … x, column by column, each from ky = −y to y.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Modes {
    degree: Degree,
    values: Vec<Complex<f64>>,
}

impl Modes {
    pub(super) fn zeros(degree: Degree) -> Self {
        let count = (degree.x + 1) * (2 * degree.y + 1);
        Self { degree, values: vec![Complex::new(0.0, 0.0); count] }
    }

    pub(super) fn degree(&self) -> Degree {
        self.degree
    }

    fn side(&self) -> usize {
        2 * self.degree.y + 1
    }

    /// The coefficients of column kx, from ky = −y to y.
    pub(super) fn column(&self, kx: usize) -> &[Complex<f64>] {
        &self.values[kx * self.side()..][..self.side()]
    }

    pub(super) fn columns_mut(&mut self) -> std::slice::ChunksExactMut<'_, Complex<f64>> {
        let side = self.side();
        self.values.chunks_exact_mut(side)
    }

    pub(super) fn par_columns_mut(&mut self) -> rayon::slice::ChunksExactMut<'_, Complex<f64>> {
        let side = self.side();
        self.values.par_chunks_exact_mut(side)
    }

    /// Sets these to `other` with the axes exchanged, a(kx, ky) = other(ky, kx).
    pub(super) fn transpose_from(&mut self, other: &Self) {
        let degree = self.degree;
        assert_eq!(degree.transposed(), other.degree, "modes of another range");
        self.par_columns_mut().enumerate().for_each(|(kx, column)| {
            let (before, after) = column.split_at_mut(degree.y);
            for (ky, a) in after.iter_mut().enumerate() {
                *a = other.column(ky)[degree.x + kx];
            }
            // other(−ky, kx) is the conjugate of other(ky, −kx), whose column is held.
            for (ky, a) in (1..).zip(before.iter_mut().rev()) {
                *a = other.column(ky)[degree.x - kx].conj();
            }
        });
    }

    /// ⟨a, b⟩ over the whole plane: Σ a(k)* b(k), which is real. Summed column by column, so that
    /// threads don't change it.
    pub(super) fn dot(&self, other: &Self) -> f64 {
        let side = self.side();
        let columns: Vec<f64> = (self.values.par_chunks_exact(side))
            .zip(other.values.par_chunks_exact(side))
            .map(|(a, b)| a.iter().zip(b).map(|(a, b)| a.re * b.re + a.im * b.im).sum())
            .collect();
        columns.iter().enumerate().map(|(kx, sum)| if kx == 0 { *sum } else { 2.0 * sum }).sum()
    }

    pub(super) fn norm_squared(&self) -> f64 {
        self.dot(self)
    }

    /// self + factor·other, in place.
    pub(super) fn add(&mut self, factor: f64, other: &Self) {
        self.combine(other, |a, b| a + b * factor);
    }

    /// other + factor·self, in place.
    pub(super) fn scale_and_add(&mut self, factor: f64, other: &Self) {
        self.combine(other, |a, b| b + a * factor);
    }

    fn combine(
        &mut self,
        other: &Self,
        f: impl Fn(Complex<f64>, Complex<f64>) -> Complex<f64> + Sync,
    ) {
        let side = self.side();
        let columns = self.par_columns_mut().zip(other.values.par_chunks_exact(side));
        columns.for_each(|(a, b)| a.iter_mut().zip(b).for_each(|(a, b)| *a = f(*a, *b)));
    }

    pub(super) fn scale(&mut self, factor: f64) {
        self.par_columns_mut().for_each(|column| column.iter_mut().for_each(|a| *a *= factor));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transposition_exchanges_the_axes() {
        let degree = Degree { x: 3, y: 2 };
        // a(kx, ky), with a(0, −ky) = a(0, ky)* as modes of real functions have it.
        let value = |kx: i32, ky: i32| {
            let (sign, kx, ky) =
                if kx < 0 || (kx == 0 && ky < 0) { (-1.0, -kx, -ky) } else { (1.0, kx, ky) };
            let im = if (kx, ky) == (0, 0) { 0.0 } else { f64::from(kx - 4 * ky) };
            Complex::new(f64::from(10 * kx + ky), sign * im)
        };
        let filled = |degree: Degree, value: &dyn Fn(i32, i32) -> Complex<f64>| {
            let mut modes = Modes::zeros(degree);
            for (kx, column) in modes.columns_mut().enumerate() {
                for (j, a) in column.iter_mut().enumerate() {
                    *a = value(kx as i32, j as i32 - degree.y as i32);
                }
            }
            modes
        };
        let modes = filled(degree, &value);
        let mut turned = Modes::zeros(degree.transposed());
        turned.transpose_from(&modes);
        assert_eq!(turned, filled(degree.transposed(), &|kx, ky| value(ky, kx)));
        assert_eq!(turned.norm_squared(), modes.norm_squared());
        let mut back = Modes::zeros(degree);
        back.transpose_from(&turned);
        assert_eq!(back, modes);
    }

    #[test]
    fn products_count_both_half_planes() {
        let mut modes = Modes::zeros(Degree { x: 1, y: 1 });
        // a(0,0) = 3, a(0,±1) = 1 ± i, a(1,0) = 2 (and so a(−1,0) = 2).
        modes.values[0] = Complex::new(1.0, -1.0);
        modes.values[1] = Complex::new(3.0, 0.0);
        modes.values[2] = Complex::new(1.0, 1.0);
        modes.values[4] = Complex::new(2.0, 0.0);
        assert_eq!(modes.norm_squared(), 9.0 + 2.0 * 2.0 + 2.0 * 4.0);
        assert_eq!(modes.degree().coefficients(), 9);
        let twice = {
            let mut m = modes.clone();
            m.scale(2.0);
            m
        };
        let mut sum = modes.clone();
        sum.add(1.0, &modes);
        assert_eq!(sum, twice);
        sum.scale_and_add(-1.0, &twice);
        assert_eq!(sum, Modes::zeros(modes.degree()));
    }
}
