//! What a plan computes once, the scratch space of its threads, and how work is dealt to them.

use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

use bn_fft::Complex;
use rayon::prelude::*;

use super::batch::LANES;
use super::design::Design;
use super::ffts::{FftScratch, Ffts};
use super::real::Real;
use super::simd::Simd;
use super::strip::{Packing, Strips};
use super::taps::Taps;

/// The constant part of a plan.
pub(super) struct Tables<T> {
    pub(super) design: Design,
    pub(super) max_frequency: usize,
    pub(super) taps: Taps<T>,
    pub(super) simd: Simd,
    /// 1/φ̂(k/N) for k = −K … K.
    pub(super) deconvolution: Vec<T>,
    /// Over the grid's side.
    pub(super) ffts: Ffts<T>,
    paired: Strips,
    single: Strips,
}

impl<T: Real> Tables<T> {
    pub(super) fn new(design: Design, max_frequency: usize, portable: bool) -> Self {
        let (grid, kernel) = (design.grid, design.kernel);
        let error = design.polynomial_error.max(0.2 * T::EPSILON);
        let polynomials = kernel.polynomials(design.taps, error);
        let polynomials = polynomials.into_iter().map(T::narrow).collect();
        let transform = |k: usize| kernel.transform(k as f64 / grid as f64);
        let limit = max_frequency as i64;
        let deconvolution = (-limit..=limit)
            .map(|k| T::narrow(1.0 / transform(k.unsigned_abs() as usize)))
            .collect();
        let simd = if portable { Simd::portable() } else { Simd::detect() };
        Self {
            max_frequency,
            taps: Taps::new(kernel.width, design.taps, polynomials, simd),
            simd,
            deconvolution,
            ffts: Ffts::new(grid, portable),
            paired: Strips::new::<T>(grid, Packing::Paired),
            single: Strips::new::<T>(grid, Packing::Single),
            design,
        }
    }

    pub(super) fn grid(&self) -> usize {
        self.design.grid
    }

    pub(super) fn strips(&self, packing: Packing) -> &Strips {
        match packing {
            Packing::Single => &self.single,
            Packing::Paired => &self.paired,
        }
    }

    /// The grid column of the first mode column: kx = −K, or 0 for real data.
    pub(super) fn first_column(&self, packing: Packing) -> usize {
        match packing {
            Packing::Single => self.grid() - self.max_frequency,
            Packing::Paired => 0,
        }
    }

    /// The grid columns of all modes, counted on beyond the grid's side.
    pub(super) fn columns(&self, packing: Packing) -> Range<usize> {
        let first = self.first_column(packing);
        match packing {
            Packing::Single => first..first + 2 * self.max_frequency + 1,
            Packing::Paired => first..first + self.max_frequency + 1,
        }
    }

    pub(super) fn width(&self) -> usize {
        self.design.kernel.width
    }
}

/// Scratch space of one thread.
#[derive(Debug)]
pub(super) struct Worker<T> {
    /// The cells of a strip.
    pub(super) strip: Vec<Complex<T>>,
    /// Columns of the grid, [`LANES`] of them.
    pub(super) lines: Vec<Complex<T>>,
    /// One column of modes, ky = −K … K.
    pub(super) modes: Vec<Complex<T>>,
    pub(super) fft: FftScratch<T>,
}

impl<T: Real> Worker<T> {
    fn new(tables: &Tables<T>) -> Self {
        let zero = Complex::new(T::default(), T::default());
        let height = tables.paired.height.max(tables.single.height);
        Self {
            strip: vec![zero; height * tables.paired.stride()],
            lines: vec![zero; LANES * tables.grid()],
            modes: vec![zero; 2 * tables.max_frequency + 1],
            fft: tables.ffts.scratch(tables.grid()),
        }
    }
}

/// The scratch spaces of all threads, kept between evaluations.
///
/// A thread takes one for each item and puts it back: nothing stays locked while a caller's
/// function runs, so that it may use the thread pool itself.
#[derive(Debug)]
pub(super) struct Workers<T> {
    idle: Mutex<Vec<Worker<T>>>,
    parallel: bool,
}

impl<T> Default for Workers<T> {
    fn default() -> Self {
        Self { idle: Mutex::default(), parallel: false }
    }
}

impl<T: Real> Workers<T> {
    /// For the threads of the current pool, or for one.
    pub(super) fn prepare(&mut self, parallel: bool) {
        self.parallel = parallel && rayon::current_num_threads() > 1;
    }

    fn idle(&self) -> MutexGuard<'_, Vec<Worker<T>>> {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn with_one(&self, tables: &Tables<T>, task: impl FnOnce(&mut Worker<T>)) {
        let idle = self.idle().pop();
        let mut worker = idle.unwrap_or_else(|| Worker::new(tables));
        task(&mut worker);
        self.idle().push(worker);
    }

    /// Calls `task(index, item, worker)` for every item, on all threads. Each result depends on
    /// its own item alone, so the number of threads doesn't matter.
    pub(super) fn each<X: Send>(
        &self,
        tables: &Tables<T>,
        items: Vec<X>,
        task: impl Fn(usize, X, &mut Worker<T>) + Sync,
    ) {
        if self.parallel {
            items.into_par_iter().enumerate().for_each(|(index, item)| {
                self.with_one(tables, |worker| task(index, item, worker));
            });
        } else {
            self.with_one(tables, |worker| {
                for (index, item) in items.into_iter().enumerate() {
                    task(index, item, worker);
                }
            });
        }
    }
}
