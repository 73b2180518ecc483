//! Real functions on a regular grid of the torus, and their modes.

use std::sync::Arc;

use bn_fft::{Complex, Fft, Planner};
use rayon::prelude::*;

use super::modes::{Degree, Modes};

/// FFTs between the modes of a real function and its values at (s/width, t/height), row by row.
///
/// Two real rows pass as one complex row. Every number is computed in one way whatever the threads
/// are.
pub(super) struct Grid {
    width: usize,
    height: usize,
    /// Along x and y, exp(−2πi …) and exp(+2πi …).
    forward: [Arc<dyn Fft<f64>>; 2],
    inverse: [Arc<dyn Fft<f64>>; 2],
}

/// Rows that pass together: what lies beside each other in a column then fills cache lines.
const ROWS: usize = 16;

impl Grid {
    /// # Panics
    /// If the height is odd.
    pub(super) fn new(width: usize, height: usize) -> Self {
        assert!(height.is_multiple_of(2), "rows go in pairs");
        let mut planner = Planner::<f64>::new();
        let forward = [width, height].map(|length| planner.forward(length));
        let inverse = [width, height].map(|length| planner.inverse(length));
        Self { width, height, forward, inverse }
    }

    pub(super) fn width(&self) -> usize {
        self.width
    }

    pub(super) fn height(&self) -> usize {
        self.height
    }

    fn holds(&self, degree: Degree) -> bool {
        2 * degree.x < self.width && 2 * degree.y < self.height
    }

    /// The function's values.
    ///
    /// # Panics
    /// If the grid has not more than 2K places a side.
    pub(super) fn values(&self, modes: &Modes, values: &mut Vec<f64>) {
        let (degree, height) = (modes.degree(), self.height);
        assert!(self.holds(degree), "modes beyond the grid");
        let fft = &self.inverse[1];
        let mut columns = vec![Complex::new(0.0, 0.0); (degree.x + 1) * height];
        columns.par_chunks_exact_mut(height).enumerate().for_each_init(
            || scratch(&**fft),
            |scratch, (kx, column)| {
                let (negative, positive) = modes.column(kx).split_at(degree.y);
                column[height - degree.y..].copy_from_slice(negative);
                column[..=degree.y].copy_from_slice(positive);
                fft.process_with_scratch(column, scratch);
            },
        );
        values.resize(self.width * height, 0.0);
        let fft = &self.inverse[0];
        values.par_chunks_mut(ROWS * self.width).enumerate().for_each_init(
            || (self.lines(), scratch(&**fft)),
            |(lines, scratch), (block, rows)| {
                let count = rows.len() / self.width;
                self.pack(&columns, block * ROWS, count, lines);
                fft.process_with_scratch(&mut lines[..count / 2 * self.width], scratch);
                let lines = lines.chunks_exact(self.width);
                for (pair, line) in rows.chunks_exact_mut(2 * self.width).zip(lines) {
                    let (even, odd) = pair.split_at_mut(self.width);
                    for ((a, b), z) in even.iter_mut().zip(odd).zip(line) {
                        (*a, *b) = (z.re, z.im);
                    }
                }
            },
        );
    }

    /// The modes a(k), |k| ≤ `degree`: the mean of value·exp(−2πi k·x) over the grid.
    pub(super) fn modes(&self, values: &[f64], modes: &mut Modes) {
        let degree = modes.degree();
        assert!(self.holds(degree), "modes beyond the grid");
        let fft = &self.forward[0];
        // Block by block of rows, in each column by column.
        let mut blocks = vec![Complex::new(0.0, 0.0); (degree.x + 1) * self.height];
        let sources = values.par_chunks(ROWS * self.width);
        blocks.par_chunks_mut(ROWS * (degree.x + 1)).zip(sources).for_each_init(
            || (self.lines(), scratch(&**fft)),
            |(lines, scratch), (block, rows)| {
                let count = rows.len() / self.width;
                let pairs = rows.chunks_exact(2 * self.width);
                for (line, pair) in lines.chunks_exact_mut(self.width).zip(pairs) {
                    let (even, odd) = pair.split_at(self.width);
                    for ((z, a), b) in line.iter_mut().zip(even).zip(odd) {
                        *z = Complex::new(*a, *b);
                    }
                }
                fft.process_with_scratch(&mut lines[..count / 2 * self.width], scratch);
                self.unpack(lines, count, block);
            },
        );
        let fft = &self.forward[1];
        let scale = 1.0 / (self.width as f64 * self.height as f64);
        modes.par_columns_mut().enumerate().for_each_init(
            || (vec![Complex::new(0.0, 0.0); self.height], scratch(&**fft)),
            |(column, scratch), (kx, out)| {
                let parts = blocks.chunks(ROWS * (degree.x + 1));
                for (rows, block) in column.chunks_mut(ROWS).zip(parts) {
                    rows.copy_from_slice(&block[kx * rows.len()..][..rows.len()]);
                }
                fft.process_with_scratch(column, scratch);
                let (negative, positive) = out.split_at_mut(degree.y);
                let (low, high) = (&column[..=degree.y], &column[self.height - degree.y..]);
                negative.iter_mut().zip(high).for_each(|(a, z)| *a = z * scale);
                positive.iter_mut().zip(low).for_each(|(a, z)| *a = z * scale);
            },
        );
    }

    fn lines(&self) -> Vec<Complex<f64>> {
        vec![Complex::new(0.0, 0.0); ROWS / 2 * self.width]
    }

    /// Rows first … first + count − 1, in pairs A + iB, from their columns kx ≥ 0.
    fn pack(
        &self,
        columns: &[Complex<f64>],
        first: usize,
        count: usize,
        lines: &mut [Complex<f64>],
    ) {
        lines.fill(Complex::new(0.0, 0.0));
        for (kx, column) in columns.chunks_exact(self.height).enumerate() {
            let pairs = column[first..first + count].as_chunks::<2>().0;
            for (line, [a, b]) in lines.chunks_exact_mut(self.width).zip(pairs) {
                if kx == 0 {
                    // Real rows have a real mean; what else is there is rounding.
                    line[0] = Complex::new(a.re, b.re);
                } else {
                    line[kx] = Complex::new(a.re - b.im, a.im + b.re);
                    line[self.width - kx] = Complex::new(a.re + b.im, b.re - a.im);
                }
            }
        }
    }

    /// The reverse: 2A(k) = Z(k) + Z(−k)*, 2iB(k) = Z(k) − Z(−k)*.
    fn unpack(&self, lines: &[Complex<f64>], count: usize, block: &mut [Complex<f64>]) {
        for (kx, out) in block.chunks_exact_mut(count).enumerate() {
            let opposite = (self.width - kx) % self.width;
            let pairs = out.as_chunks_mut::<2>().0.iter_mut();
            for ([a, b], line) in pairs.zip(lines.chunks_exact(self.width)) {
                let (z, m) = (line[kx], line[opposite]);
                *a = Complex::new(0.5 * (z.re + m.re), 0.5 * (z.im - m.im));
                *b = Complex::new(0.5 * (z.im + m.im), 0.5 * (m.re - z.re));
            }
        }
    }
}

fn scratch(fft: &dyn Fft<f64>) -> Vec<Complex<f64>> {
    vec![Complex::new(0.0, 0.0); fft.get_inplace_scratch_len()]
}

/// The least even number of factors 2, 3 and 5 that is not below `least`.
pub(super) fn good_size(least: usize) -> usize {
    let smooth = |mut n: usize| {
        for p in [2, 3, 5] {
            while n.is_multiple_of(p) {
                n /= p;
            }
        }
        n == 1
    };
    let mut half = least.div_ceil(2).max(1);
    // Ends at the next power of 2 at the latest.
    while !smooth(half) {
        half += 1;
    }
    2 * half
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn some_modes(degree: Degree) -> Modes {
        let mut modes = Modes::zeros(degree);
        let (mut state, limit) = (1_u32, degree.y);
        for (kx, column) in modes.columns_mut().enumerate() {
            for j in 0..=2 * limit {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let value =
                    Complex::new(f64::from(state >> 16) / 65536.0, f64::from(state & 0xff) / 256.0);
                if kx > 0 {
                    column[j] = value;
                } else if j >= limit {
                    column[j] = value;
                    column[2 * limit - j] = value.conj();
                    if j == limit {
                        column[j].im = 0.0;
                    }
                }
            }
        }
        modes
    }

    #[test]
    fn values_are_the_polynomials_and_lead_back() {
        for (x, y, width, height) in
            [(0, 0, 1, 2), (1, 3, 5, 8), (4, 9, 9, 20), (7, 2, 16, 34), (3, 20, 7, 50)]
        {
            let degree = Degree { x, y };
            let (grid, modes) = (Grid::new(width, height), some_modes(degree));
            let mut values = Vec::new();
            grid.values(&modes, &mut values);
            for (i, got) in values.iter().enumerate() {
                let (s, t) =
                    ((i % width) as f64 / width as f64, (i / width) as f64 / height as f64);
                let mut want = 0.0;
                for kx in 0..=x {
                    for (j, a) in modes.column(kx).iter().enumerate() {
                        let (sin, cos) =
                            libm::sincos(TAU * (kx as f64 * s + (j as f64 - y as f64) * t));
                        want += (a.re * cos - a.im * sin) * if kx == 0 { 1.0 } else { 2.0 };
                    }
                }
                assert!(
                    (got - want).abs() < 1e-12 * degree.coefficients() as f64,
                    "{degree:?} at {i}: {got} {want}"
                );
            }
            let mut back = Modes::zeros(degree);
            grid.modes(&values, &mut back);
            back.add(-1.0, &modes);
            assert!(back.norm_squared() < 1e-26 * modes.norm_squared(), "{degree:?}");
        }
    }

    #[test]
    fn good_sizes_are_even_and_smooth() {
        for (least, want) in
            [(0, 2), (1, 2), (2, 2), (7, 8), (13, 16), (23, 24), (401, 432), (801, 810)]
        {
            assert_eq!(good_size(least), want);
        }
    }
}
