//! Where the coefficients of a transform are kept.

use bn_fft::Complex;

use super::real::Real;

/// Modes f(k) of a real function, f(−k) = f(k)*: those with 0 ≤ kx ≤ K, −K ≤ ky ≤ K are kept.
///
/// Column by column: all ky of kx = 0, then those of kx = 1, … The column kx = 0 holds both of
/// each conjugate pair.
#[derive(Clone, Debug, PartialEq)]
pub struct HalfPlane<T: Real = f64> {
    max_frequency: usize,
    values: Vec<Complex<T>>,
}

/// Modes f(k) of a complex function for −K ≤ kx, ky ≤ K, column by column.
#[derive(Clone, Debug, PartialEq)]
pub struct FullPlane<T: Real = f64> {
    max_frequency: usize,
    values: Vec<Complex<T>>,
}

impl<T: Real> HalfPlane<T> {
    /// All modes 0, for frequencies up to K = `max_frequency`.
    pub fn zeros(max_frequency: usize) -> Self {
        let count = (max_frequency + 1) * (2 * max_frequency + 1);
        Self { max_frequency, values: vec![Complex::new(T::default(), T::default()); count] }
    }

    /// K.
    pub fn max_frequency(&self) -> usize {
        self.max_frequency
    }

    /// f(kx, ky) for any signs.
    ///
    /// # Panics
    /// If |kx| or |ky| exceeds K.
    pub fn get(&self, kx: i64, ky: i64) -> Complex<T> {
        let (kx, ky, conjugate) = if kx < 0 { (-kx, -ky, true) } else { (kx, ky, false) };
        let value = self.column(kx as usize)[index(ky, self.max_frequency)];
        if conjugate { value.conj() } else { value }
    }

    /// The modes of column kx ≥ 0, from ky = −K to K.
    ///
    /// # Panics
    /// If kx exceeds K.
    pub fn column(&self, kx: usize) -> &[Complex<T>] {
        let side = 2 * self.max_frequency + 1;
        &self.values[kx * side..][..side]
    }

    /// The same, to be changed.
    ///
    /// # Panics
    /// If kx exceeds K.
    pub fn column_mut(&mut self, kx: usize) -> &mut [Complex<T>] {
        let side = 2 * self.max_frequency + 1;
        &mut self.values[kx * side..][..side]
    }

    /// All columns, kx = 0 … K.
    pub fn columns_mut(&mut self) -> std::slice::ChunksExactMut<'_, Complex<T>> {
        self.values.chunks_exact_mut(2 * self.max_frequency + 1)
    }

    /// All values, column by column.
    pub fn values(&self) -> &[Complex<T>] {
        &self.values
    }
}

impl<T: Real> FullPlane<T> {
    /// All modes 0, for frequencies up to K = `max_frequency`.
    pub fn zeros(max_frequency: usize) -> Self {
        let count = (2 * max_frequency + 1) * (2 * max_frequency + 1);
        Self { max_frequency, values: vec![Complex::new(T::default(), T::default()); count] }
    }

    /// K.
    pub fn max_frequency(&self) -> usize {
        self.max_frequency
    }

    /// f(kx, ky).
    ///
    /// # Panics
    /// If |kx| or |ky| exceeds K.
    pub fn get(&self, kx: i64, ky: i64) -> Complex<T> {
        self.column(kx)[index(ky, self.max_frequency)]
    }

    /// The modes of column kx, from ky = −K to K.
    ///
    /// # Panics
    /// If |kx| exceeds K.
    pub fn column(&self, kx: i64) -> &[Complex<T>] {
        let side = 2 * self.max_frequency + 1;
        &self.values[index(kx, self.max_frequency) * side..][..side]
    }

    /// The same, to be changed.
    ///
    /// # Panics
    /// If |kx| exceeds K.
    pub fn column_mut(&mut self, kx: i64) -> &mut [Complex<T>] {
        let side = 2 * self.max_frequency + 1;
        &mut self.values[index(kx, self.max_frequency) * side..][..side]
    }

    /// All columns, kx = −K … K.
    pub fn columns_mut(&mut self) -> std::slice::ChunksExactMut<'_, Complex<T>> {
        self.values.chunks_exact_mut(2 * self.max_frequency + 1)
    }

    /// All values, column by column.
    pub fn values(&self) -> &[Complex<T>] {
        &self.values
    }
}

/// The place of frequency k among −K … K.
fn index(k: i64, max_frequency: usize) -> usize {
    let limit = max_frequency as i64;
    assert!((-limit..=limit).contains(&k), "frequency {k} is beyond the largest, {limit}");
    (k + limit) as usize
}
