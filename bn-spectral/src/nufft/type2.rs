//! Type 2, modes → points: the steps of type 1 in reverse, each transposed.

use bn_fft::Complex;

use super::batch::LANES;
use super::ffts::Direction;
use super::located::SortedPoints;
use super::real::Real;
use super::strip::{Packing, Strip, Strips};
use super::tables::{Tables, Workers};
use super::taps::{Gather, GatherGradient};
use super::transpose::{FromColumns, Scale};

/// Rows of the grid before their transform, from modes: `spectrum` holds, column by column, all
/// grid rows. `fill` writes the modes ky = −K … K of column kx = 0 … K (paired) or −K … K (single, by
/// its number from 0).
pub(super) fn transform_columns<T: Real>(
    tables: &Tables<T>,
    packing: Packing,
    spectrum: &mut Vec<Complex<T>>,
    workers: &Workers<T>,
    fill: impl Fn(usize, &mut [Complex<T>]) + Sync,
) {
    let (grid, limit) = (tables.grid(), tables.max_frequency);
    let zero = Complex::new(T::default(), T::default());
    spectrum.resize(tables.columns(packing).len() * grid, zero);
    let batches = spectrum.chunks_mut(LANES * grid).collect();
    workers.each(tables, batches, |batch, lines: &mut [_], worker| {
        for (index, line) in (batch * LANES..).zip(lines.chunks_exact_mut(grid)) {
            fill(index, &mut worker.modes);
            if packing == Packing::Paired && index == 0 {
                make_hermitian(&mut worker.modes);
            }
            let factor = match packing {
                Packing::Single => tables.deconvolution[index],
                Packing::Paired => tables.deconvolution[index + limit],
            };
            spread_modes(tables, &worker.modes, factor, line);
        }
        tables.ffts.transform(Direction::Inverse, lines, grid, grid, &mut worker.fft);
    });
}

/// Puts a column's modes where the FFT wants them, divided by the kernel's transform.
fn spread_modes<T: Real>(
    tables: &Tables<T>,
    modes: &[Complex<T>],
    factor: T,
    line: &mut [Complex<T>],
) {
    let (grid, limit, simd) = (tables.grid(), tables.max_frequency, tables.simd);
    let (negative, positive) = modes.split_at(limit);
    let (before, after) = tables.deconvolution.split_at(limit);
    let out = &mut line[grid - limit..];
    T::scale(simd, Scale { out, from: negative, along: before, factor });
    let out = &mut line[..=limit];
    T::scale(simd, Scale { out, from: positive, along: after, factor });
    line[limit + 1..grid - limit].fill(Complex::new(T::default(), T::default()));
}

/// The half of a column kx = 0 that makes real sums: (f(ky) + f(−ky)*)/2.
fn make_hermitian<T: Real>(modes: &mut [Complex<T>]) {
    let half = T::narrow(0.5);
    let last = modes.len() - 1;
    for i in 0..=last / 2 {
        let mean = (modes[i] + modes[last - i].conj()) * half;
        modes[i] = mean;
        modes[last - i] = mean.conj();
    }
}

/// Sums at the points, in sorted order and in two parts: from the strip of the point's first row,
/// and from the next one. Real sums are the real plus the imaginary part.
#[derive(Debug, Default)]
pub(super) struct PointSums<T> {
    own: Vec<Complex<T>>,
    next: Vec<Complex<T>>,
}

impl<T: Real> PointSums<T> {
    /// The sums in sorted order.
    pub(super) fn iter(&self) -> impl Iterator<Item = Complex<T>> {
        self.own.iter().zip(&self.next).map(|(&a, &b)| a + b)
    }
}

/// One strip's share of the work: the sums it adds to its own points and to those before it.
struct Share<'a, T> {
    own: &'a mut [Complex<T>],
    before: &'a mut [Complex<T>],
}

/// Transforms the rows of `spectrum` and sums them under the points' kernels.
pub(super) fn transform_rows<T: Real>(
    tables: &Tables<T>,
    packing: Packing,
    spectrum: &[Complex<T>],
    points: &SortedPoints<T>,
    sums: &mut PointSums<T>,
    workers: &Workers<T>,
) {
    each_strip(tables, packing, spectrum, points, sums, workers, T::gather);
}

/// Transforms the real rows of `spectrum` and sums them under the derivatives of the points'
/// kernels: by x in the real, by y in the imaginary part.
pub(super) fn gradient_rows<T: Real>(
    tables: &Tables<T>,
    spectrum: &[Complex<T>],
    points: &SortedPoints<T>,
    sums: &mut PointSums<T>,
    workers: &Workers<T>,
) {
    let gather = |job: Gather<'_, '_, T>| T::gather_gradient(GatherGradient(job));
    each_strip(tables, Packing::Paired, spectrum, points, sums, workers, gather);
}

fn each_strip<T: Real>(
    tables: &Tables<T>,
    packing: Packing,
    spectrum: &[Complex<T>],
    points: &SortedPoints<T>,
    sums: &mut PointSums<T>,
    workers: &Workers<T>,
    gather: impl Fn(Gather<'_, '_, T>) + Sync,
) {
    let strips = tables.strips(packing);
    let shares = share(tables, strips, points, sums);
    workers.each(tables, shares, |index, share, worker| {
        let mut strip = Strip::new(strips, index, &mut worker.strip);
        let columns = tables.columns(packing);
        T::from_columns(tables.simd, FromColumns { strip: &mut strip, columns, spectrum });
        strip.transform(&tables.ffts, Direction::Inverse, &mut worker.fft);
        strip.unfold();
        let (before, shift) = strips.reaching(index, tables.width());
        let own = strips.grid_rows_of(index);
        for (rows, shift, sums) in [(before, shift, share.before), (own, 0, share.own)] {
            let (taps, points) = (&tables.taps, points.in_rows(rows));
            gather(Gather { taps, points, shift, strip: &strip, sums });
        }
    });
}

/// Splits the sums among the strips that compute them.
fn share<'a, T: Real>(
    tables: &Tables<T>,
    strips: &Strips,
    points: &SortedPoints<T>,
    sums: &'a mut PointSums<T>,
) -> Vec<Share<'a, T>> {
    let zero = Complex::new(T::default(), T::default());
    sums.own.resize(points.len(), zero);
    // Most kernels end within their own strip; their second part stays 0.
    sums.next.clear();
    sums.next.resize(points.len(), zero);
    let (mut own, mut next) = (&mut sums.own[..], &mut sums.next[..]);
    let mut shares = Vec::with_capacity(strips.count());
    let mut reached = Vec::with_capacity(strips.count());
    for index in 0..strips.count() {
        let rows = strips.grid_rows_of(index);
        let inside = points.span(rows.clone()).len();
        let over = points.span(rows.end + 1 - tables.width()..rows.end).len();
        let (mine, rest) = own.split_at_mut(inside);
        let (both, next_rest) = next.split_at_mut(inside);
        (own, next) = (rest, next_rest);
        reached.push(&mut both[inside - over..]);
        shares.push(mine);
    }
    // What reaches over a strip's end is the next strip's work, round the seam.
    reached.rotate_right(1);
    shares.into_iter().zip(reached).map(|(own, before)| Share { own, before }).collect()
}
