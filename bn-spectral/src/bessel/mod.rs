//! Bessel functions of the first kind of order 0 and 1, and jinc.

mod coefficients;
mod kernel;

/// J₀(x) for any real x.
///
/// Absolute error at most 4ε·min(1, √(2/(π|x|))), ε = 2⁻⁵², for |x| ≤ 10⁶ (and about that beyond);
/// relative error is unbounded near the zeros. J₀(±∞) = 0, NaN gives NaN. About 25 ns.
pub fn j0(x: f64) -> f64 {
    libm::j0(x)
}

/// J₁(x) for any real x; error, limits and cost as [`j0`].
pub fn j1(x: f64) -> f64 {
    libm::j1(x)
}

/// jinc(x) = J₁(x)/x with jinc(0) = ½, for any real x.
///
/// This is the thesis's §5.1.2; its table 5.1 needs the argument 2πu with it: the Hankel transform
/// of the unit disk is 2π·jinc(2πu). Absolute error at most that of [`j1`] over max(1, |x|).
pub fn jinc(x: f64) -> f64 {
    // The next term of the series is x²/16; and J₁ of a subnormal number keeps no digits.
    if x.abs() < 1e-8 { 0.5 } else { libm::j1(x) / x }
}

/// J₀ of every element of `x` into `out`.
///
/// The error bound of [`j0`]; 2–5 ns a value with AVX2 and FMA, which is decided at run time. The
/// last bits may differ from [`j0`] and between CPUs, but on one CPU a value depends on its
/// argument alone, not on its place in the slice or on how a longer slice was cut.
///
/// # Panics
/// If the lengths differ.
pub fn j0_slice(x: &[f64], out: &mut [f64]) {
    kernel::fill::<kernel::J0>(x, out);
}

/// J₁ of every element of `x` into `out`; everything as in [`j0_slice`].
///
/// # Panics
/// If the lengths differ.
pub fn j1_slice(x: &[f64], out: &mut [f64]) {
    kernel::fill::<kernel::J1>(x, out);
}

/// [`jinc`] of every element of `x` into `out`; everything else as in [`j0_slice`].
///
/// # Panics
/// If the lengths differ.
pub fn jinc_slice(x: &[f64], out: &mut [f64]) {
    kernel::fill::<kernel::Jinc>(x, out);
}

/// [`j0_slice`] with the same bits on every CPU, for what decides a point's position.
pub(crate) fn j0_slice_alike(x: &[f64], out: &mut [f64]) {
    kernel::fill_alike::<kernel::J0>(x, out);
}

/// [`jinc_slice`] with the same bits on every CPU, for what decides a point's position.
pub(crate) fn jinc_slice_alike(x: &[f64], out: &mut [f64]) {
    kernel::fill_alike::<kernel::Jinc>(x, out);
}
