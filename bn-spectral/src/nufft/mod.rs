//! Fourier sums at arbitrary points: the non-uniform FFT in two dimensions.
//!
//! Type 1 takes points to modes, f(k) = Σⱼ wⱼ exp(−2πi k·xⱼ), type 2 modes to points,
//! vⱼ = Σₖ f(k) exp(+2πi k·xⱼ), for integer k with |kx|, |ky| ≤ K. Unnormalised both ways, each
//! the other's adjoint.
//!
//! Method: the points are smeared onto a grid a little finer than the modes need by a kernel of
//! a few cells (Kaiser–Bessel), the grid is transformed by FFTs, and the modes are divided by the
//! kernel's transform; type 2 is the transpose (Dutt and Rokhlin 1993; Barnett, Magland and af
//! Klinteberg 2019). Real strengths let two rows pass as one complex row, and only one half plane
//! of columns is transformed. The grid never exists as a whole: a strip of rows that fits the
//! cache is smeared, transformed and reduced to the wanted columns before the next.
//!
//! Error: aliases of modes beyond the grid, rounding magnified by the division, and the
//! polynomials that stand for the kernel. [`Nufft::error`] predicts its l2 norm relative to that
//! of the modes for points in general position; a single mode's error stays within about ten
//! times that of Σ|wⱼ|, wherever the points lie. Below some tens of points the sums are taken
//! term by term, to rounding.

#![expect(
    clippy::inline_always,
    reason = "kernels are compiled once for each instruction set: what they call has to be part of them"
)]
#![expect(
    clippy::needless_range_loop,
    reason = "loops over lanes index several arrays alike, which is what vectorises"
)]

mod batch;
mod design;
mod direct;
mod ffts;
mod kernel;
mod located;
mod mode_columns;
mod modes;
mod options;
mod real;
mod simd;
mod strip;
mod tables;
mod taps;
mod transpose;
mod type1;
mod type2;

#[cfg(test)]
mod portable;

use std::ops::Range;

use bn_core::DVec2;
use bn_fft::Complex;

pub use direct::{direct_complex_modes, direct_complex_sums, direct_modes, direct_sums};
pub use mode_columns::ModeColumns;
pub use modes::{FullPlane, HalfPlane};
pub use options::{NufftError, NufftOptions};
pub use real::Real;

use direct::Phasors;
use located::SortedPoints;
use strip::Packing;
use tables::{Tables, Workers};
use taps::Strengths;
use type1::Columns;
use type2::PointSums;

/// A planned transform between points and modes; made by [`NufftOptions::plan`].
///
/// Keeps its tables and buffers from one evaluation to the next. A coordinate outside [0, 1)
/// counts as its representative inside; one that isn't finite makes NaN of all it touches.
pub struct Nufft<T: Real = f64> {
    tables: Tables<T>,
    crossover: usize,
    parallel: bool,
    points: SortedPoints<T>,
    spectrum: Vec<Complex<T>>,
    sums: PointSums<T>,
    phasors: Phasors,
    workers: Workers<T>,
}

impl<T: Real> std::fmt::Debug for Nufft<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Nufft")
            .field("max_frequency", &self.tables.max_frequency)
            .field("design", &self.tables.design)
            .finish_non_exhaustive()
    }
}

impl<T: Real> Nufft<T> {
    fn new(tables: Tables<T>, crossover: usize, parallel: bool) -> Self {
        Self {
            tables,
            crossover,
            parallel,
            points: SortedPoints::default(),
            spectrum: Vec::new(),
            sums: PointSums::default(),
            phasors: Phasors::default(),
            workers: Workers::default(),
        }
    }

    /// K: modes have |kx|, |ky| ≤ K.
    pub fn max_frequency(&self) -> usize {
        self.tables.max_frequency
    }

    /// The predicted l2 error relative to the modes' norm: at most the tolerance asked for, unless
    /// that is beyond the type's precision.
    pub fn error(&self) -> f64 {
        self.tables.design.error
    }

    /// Cells a side of the grid.
    pub fn grid_size(&self) -> usize {
        self.tables.grid()
    }

    /// Cells a side of the kernel.
    pub fn kernel_width(&self) -> usize {
        self.tables.width()
    }

    /// Up to how many points are summed term by term.
    pub fn crossover(&self) -> usize {
        self.crossover
    }

    /// Type 1 for real strengths: f(k) = Σⱼ wⱼ exp(−2πi k·xⱼ), wⱼ = 1 without `strengths`.
    ///
    /// Cost O(n·w² + K² log K) for a kernel of w cells.
    ///
    /// # Panics
    /// If there are strengths but not one a point, or `modes` are of another K.
    pub fn points_to_modes(
        &mut self,
        points: &[DVec2],
        strengths: Option<&[f64]>,
        modes: &mut HalfPlane<T>,
    ) {
        assert_eq!(modes.max_frequency(), self.max_frequency(), "modes of another range");
        let all = 0..self.max_frequency() + 1;
        self.transform(points, strengths, all).write_all(modes.columns_mut().collect());
    }

    /// Type 1 for real strengths, the modes to be taken column by column: for transforms whose
    /// modes would not fit in memory together, or need not be kept. Only columns kx in `columns`
    /// will be asked for; memory is 16·K bytes (in double precision) for each.
    ///
    /// # Panics
    /// If there are strengths but not one a point, or a column beyond K is wanted.
    pub fn transform<'a>(
        &'a mut self,
        points: &'a [DVec2],
        strengths: Option<&'a [f64]>,
        columns: Range<usize>,
    ) -> ModeColumns<'a, T> {
        assert!(columns.end <= self.max_frequency() + 1, "columns {columns:?} are beyond K");
        let strengths = Strengths::real(strengths, points.len());
        let columns = Columns { packing: Packing::Paired, range: columns };
        self.start_type1(points, strengths, columns)
    }

    /// Type 1 for complex strengths: f(k) = Σⱼ wⱼ exp(−2πi k·xⱼ). About twice the cost of a real
    /// one.
    ///
    /// # Panics
    /// If there isn't one strength a point, or `modes` are of another K.
    pub fn complex_points_to_modes(
        &mut self,
        points: &[DVec2],
        strengths: &[Complex<f64>],
        modes: &mut FullPlane<T>,
    ) {
        assert_eq!(modes.max_frequency(), self.max_frequency(), "modes of another range");
        let strengths = Strengths::complex(strengths, points.len());
        let columns = Columns { packing: Packing::Single, range: 0..2 * self.max_frequency() + 1 };
        self.start_type1(points, strengths, columns).write_all(modes.columns_mut().collect());
    }

    fn start_type1<'a>(
        &'a mut self,
        points: &'a [DVec2],
        strengths: Strengths<'a>,
        columns: Columns,
    ) -> ModeColumns<'a, T> {
        if points.len() <= self.crossover {
            self.phasors.prepare(points, self.tables.max_frequency);
            return ModeColumns { plan: self, columns, direct: Some(strengths) };
        }
        self.prepare(points);
        type1::transform_rows(
            &self.tables,
            &self.points,
            strengths,
            &columns,
            &mut self.spectrum,
            &self.workers,
        );
        ModeColumns { plan: self, columns, direct: None }
    }

    /// Type 2 for modes of a real function: vⱼ = Σₖ f(k) exp(+2πi k·xⱼ) over the whole plane, with
    /// f(−k) = f(k)*. Where the column kx = 0 isn't Hermitian itself, the sums' real part.
    ///
    /// # Panics
    /// If `modes` are of another K or `values` aren't one a point.
    pub fn modes_to_points(&mut self, modes: &HalfPlane<T>, points: &[DVec2], values: &mut [f64]) {
        assert_eq!(modes.max_frequency(), self.max_frequency(), "modes of another range");
        self.columns_to_points(points, values, |kx, column| {
            column.copy_from_slice(modes.column(kx));
        });
    }

    /// The same with the modes written where they are needed: `fill` writes the modes
    /// (kx, −K … K) for each kx = 0 … K, on any thread and in any order.
    ///
    /// # Panics
    /// If `values` aren't one a point.
    pub fn columns_to_points(
        &mut self,
        points: &[DVec2],
        values: &mut [f64],
        fill: impl Fn(usize, &mut [Complex<T>]) + Sync,
    ) {
        assert_eq!(values.len(), points.len(), "one value a point");
        if points.len() <= self.crossover {
            self.phasors.prepare(points, self.tables.max_frequency);
            let mut column = self.zero_column();
            self.phasors.real_sums(values, self.tables.simd, |kx, out| {
                fill(kx, &mut column);
                widen(&column, out);
            });
            return;
        }
        self.run_type2(Packing::Paired, points, fill);
        for (point, sum) in self.points.all().iter().zip(self.sums.iter()) {
            values[point.index as usize] = (sum.re + sum.im).wide();
        }
    }

    /// Type 2 for any modes: vⱼ = Σₖ f(k) exp(+2πi k·xⱼ); `fill` writes the modes (kx, −K … K) for
    /// each kx = −K … K, on any thread and in any order.
    ///
    /// Two real functions pass in one: for f = g + ih with g, h Hermitian, the sums are those of
    /// g plus i times those of h.
    ///
    /// # Panics
    /// If `values` aren't one a point.
    pub fn columns_to_complex_points(
        &mut self,
        points: &[DVec2],
        values: &mut [Complex<f64>],
        fill: impl Fn(i64, &mut [Complex<T>]) + Sync,
    ) {
        assert_eq!(values.len(), points.len(), "one value a point");
        let limit = self.max_frequency() as i64;
        if points.len() <= self.crossover {
            self.phasors.prepare(points, self.tables.max_frequency);
            let mut column = self.zero_column();
            let mut wide = vec![Complex::new(0.0, 0.0); column.len()];
            values.fill(Complex::new(0.0, 0.0));
            for kx in -limit..=limit {
                fill(kx, &mut column);
                widen(&column, &mut wide);
                self.phasors.add_sums(&wide, kx, self.tables.simd, values);
            }
            return;
        }
        self.run_type2(Packing::Single, points, |index, out| fill(index as i64 - limit, out));
        for (point, sum) in self.points.all().iter().zip(self.sums.iter()) {
            values[point.index as usize] = Complex::new(sum.re.wide(), sum.im.wide());
        }
    }

    /// The gradient of a type 2 transform for modes of a real function: ∇ Σₖ f(k) exp(+2πi k·x) at
    /// each point, `fill` as in [`Nufft::columns_to_points`].
    ///
    /// The kernel is differentiated, not the modes: for sums of |S(k)|² this is the exact gradient of
    /// what type 1 gives, up to rounding, whatever the tolerance. Its error as a gradient is about
    /// π times the kernel's width that of the sums. A third more than a transform without gradient.
    ///
    /// # Panics
    /// If `values` aren't one a point.
    pub fn columns_to_gradients(
        &mut self,
        points: &[DVec2],
        values: &mut [DVec2],
        fill: impl Fn(usize, &mut [Complex<T>]) + Sync,
    ) {
        assert_eq!(values.len(), points.len(), "one value a point");
        if points.len() <= self.crossover {
            return self.direct_gradients(points, values, fill);
        }
        self.prepare(points);
        let Self { tables, points, spectrum, sums, workers, .. } = self;
        type2::transform_columns(tables, Packing::Paired, spectrum, workers, fill);
        type2::gradient_rows(tables, spectrum, points, sums, workers);
        // The taps' argument is −2 a cell.
        let scale = -2.0 * self.tables.grid() as f64;
        for (point, sum) in self.points.all().iter().zip(self.sums.iter()) {
            values[point.index as usize] = scale * DVec2::new(sum.re.wide(), sum.im.wide());
        }
    }

    fn direct_gradients(
        &mut self,
        points: &[DVec2],
        values: &mut [DVec2],
        fill: impl Fn(usize, &mut [Complex<T>]) + Sync,
    ) {
        self.phasors.prepare(points, self.tables.max_frequency);
        let limit = self.max_frequency() as f64;
        let mut column = self.zero_column();
        let mut sums = vec![0.0; points.len()];
        for axis in 0..2 {
            self.phasors.real_sums(&mut sums, self.tables.simd, |kx, out| {
                fill(kx, &mut column);
                widen(&column, out);
                for (j, mode) in out.iter_mut().enumerate() {
                    let k = if axis == 0 { kx as f64 } else { j as f64 - limit };
                    *mode *= Complex::new(0.0, std::f64::consts::TAU * k);
                }
            });
            for (value, sum) in values.iter_mut().zip(&sums) {
                value[axis] = *sum;
            }
        }
    }

    /// [`Nufft::columns_to_complex_points`] for modes that lie ready.
    ///
    /// # Panics
    /// If `modes` are of another K or `values` aren't one a point.
    pub fn complex_modes_to_points(
        &mut self,
        modes: &FullPlane<T>,
        points: &[DVec2],
        values: &mut [Complex<f64>],
    ) {
        assert_eq!(modes.max_frequency(), self.max_frequency(), "modes of another range");
        self.columns_to_complex_points(points, values, |kx, column| {
            column.copy_from_slice(modes.column(kx));
        });
    }

    fn run_type2(
        &mut self,
        packing: Packing,
        points: &[DVec2],
        fill: impl Fn(usize, &mut [Complex<T>]) + Sync,
    ) {
        self.prepare(points);
        let Self { tables, points, spectrum, sums, workers, .. } = self;
        type2::transform_columns(tables, packing, spectrum, workers, fill);
        type2::transform_rows(tables, packing, spectrum, points, sums, workers);
    }

    fn prepare(&mut self, points: &[DVec2]) {
        assert!(u32::try_from(points.len()).is_ok(), "more points than 32-bit numbers");
        self.points.locate(points, &self.tables.design);
        self.workers.prepare(self.parallel);
    }

    fn zero_column(&self) -> Vec<Complex<T>> {
        vec![Complex::new(T::default(), T::default()); 2 * self.max_frequency() + 1]
    }
}

fn narrow<T: Real>(wide: &[Complex<f64>], modes: &mut [Complex<T>]) {
    for (mode, value) in modes.iter_mut().zip(wide) {
        *mode = Complex::new(T::narrow(value.re), T::narrow(value.im));
    }
}

fn widen<T: Real>(column: &[Complex<T>], wide: &mut [Complex<f64>]) {
    for (wide, value) in wide.iter_mut().zip(column) {
        *wide = Complex::new(value.re.wide(), value.im.wide());
    }
}
