//! The modes of a type 1 transform, column by column.

use std::ops::Range;

use bn_fft::Complex;

use super::real::Real;
use super::taps::Strengths;
use super::type1::{self, Columns, GridColumn};
use super::{Nufft, narrow};

/// Modes of a type 1 transform whose rows are done: columns on demand.
pub struct ModeColumns<'a, T: Real = f64> {
    pub(super) plan: &'a Nufft<T>,
    pub(super) columns: Columns,
    /// The strengths, where the sums are taken term by term.
    pub(super) direct: Option<Strengths<'a>>,
}

impl<T: Real> ModeColumns<'_, T> {
    /// Calls `take(kx, output, modes)` for each kx in `columns`, with one of `outputs` each and
    /// the modes (kx, −K … K), on any thread and in any order.
    ///
    /// # Panics
    /// If a column is not among those the transform was made for, or there isn't one output for
    /// each.
    pub fn each<O: Send>(
        &self,
        columns: Range<usize>,
        outputs: Vec<O>,
        take: impl Fn(usize, O, &[Complex<T>]) + Sync,
    ) {
        let known = &self.columns.range;
        let inside = known.start <= columns.start && columns.end <= known.end;
        assert!(inside, "columns {columns:?} are not among {known:?}");
        assert_eq!(outputs.len(), columns.len(), "one output a column");
        if let Some(strengths) = self.direct {
            let mut modes = self.plan.zero_column();
            self.each_direct(strengths, columns, outputs, &mut |column, output, wide| {
                narrow(wide, &mut modes);
                take(column, output, &modes);
            });
        } else {
            self.each_fast(columns, outputs, |column, output, grid, modes| {
                grid.write_to(modes);
                take(column, output, modes);
            });
        }
    }

    /// All columns, each straight to its place.
    pub(super) fn write_all(&self, places: Vec<&mut [Complex<T>]>) {
        let all = self.columns.range.clone();
        if let Some(strengths) = self.direct {
            self.each_direct(strengths, all, places, &mut |_, place, wide| narrow(wide, place));
        } else {
            self.each_fast(all, places, |_, place, grid, _| grid.write_to(place));
        }
    }

    fn each_fast<O: Send>(
        &self,
        columns: Range<usize>,
        outputs: Vec<O>,
        take: impl Fn(usize, O, &GridColumn<'_, T>, &mut [Complex<T>]) + Sync,
    ) {
        let Nufft { tables, spectrum, workers, .. } = self.plan;
        let kept = &self.columns;
        type1::transform_columns(tables, kept, spectrum, columns, outputs, workers, take);
    }

    #[expect(clippy::type_complexity, reason = "a callback that is passed on once")]
    fn each_direct<O>(
        &self,
        strengths: Strengths<'_>,
        columns: Range<usize>,
        outputs: Vec<O>,
        take: &mut dyn FnMut(usize, O, &[Complex<f64>]),
    ) {
        let plan = self.plan;
        let limit = plan.max_frequency();
        let mut wide = vec![Complex::new(0.0, 0.0); 2 * limit + 1];
        for (column, output) in columns.zip(outputs) {
            let kx = self.columns.frequency(column, limit);
            wide.fill(Complex::new(0.0, 0.0));
            plan.phasors.add_modes(strengths, 0, kx, plan.tables.simd, &mut wide);
            take(column, output, &wide);
        }
    }
}
