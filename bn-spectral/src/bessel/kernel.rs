//! Branch-free evaluation over slices, written so that the compiler vectorises it.
//!
//! |x| < 4: polynomial times the exact distance from the first zero, so that the relative error
//! stays small across it. 4 ≤ |x| ≤ 2²⁴: amplitude and phase of the Hankel function,
//! J(x) = √(x w)·A(w)·sin(x + offset + x w φ(w)) with w = 1/(x² + shift), in two ranges of
//! different degree; x is reduced by π in three parts (Cody and Waite) whose first product is exact.
//! Beyond, and for NaN, the scalar function. After Harrison, "Fast and accurate Bessel function
//! computation" (ARITH 2009), with an own variable w: it brings the degree at x = 4 from 22 to 15.

#![expect(clippy::inline_always, reason = "must be compiled anew under the features of the caller")]

use super::coefficients as c;

/// The first range ends here.
const NEAR: f64 = 4.0;
/// From here on a short polynomial is enough.
const FAR: f64 = 25.0;
/// Up to here the products of n and the first two parts of π are exact: 25 + 28 bits.
const LARGEST: f64 = 16_777_216.0;
/// Values that choose their ranges together: enough to fill the pipeline, few enough to be alike.
const CHUNK: usize = 32;

/// What distinguishes the functions; the arrays are explained in `coefficients`.
pub trait Function {
    const ZERO: (f64, f64);
    const NEAR: &'static [f64];
    const MIDDLE: (&'static [f64], &'static [f64]);
    const FAR: (&'static [f64], &'static [f64]);
    /// The number n₀ with sin(x − n₀π): −¼ for J₀, +¼ for J₁.
    const QUARTER: f64;
    /// The even function that the near polynomial gives as this function of |x|.
    fn near(even: f64, x: f64) -> f64;
    /// The function from that of |x| ≥ 4.
    fn far(value: f64, x: f64) -> f64;
    /// One value, anywhere.
    fn scalar(x: f64) -> f64;
}

pub struct J0;
pub struct J1;
pub struct Jinc;

impl Function for J0 {
    const ZERO: (f64, f64) = c::ZERO_0;
    const NEAR: &'static [f64] = &c::NEAR_0;
    const MIDDLE: (&'static [f64], &'static [f64]) = (&c::MIDDLE_AMPLITUDE_0, &c::MIDDLE_PHASE_0);
    const FAR: (&'static [f64], &'static [f64]) = (&c::FAR_AMPLITUDE_0, &c::FAR_PHASE_0);
    const QUARTER: f64 = -0.25;

    #[inline(always)]
    fn near(even: f64, _: f64) -> f64 {
        even
    }

    #[inline(always)]
    fn far(value: f64, _: f64) -> f64 {
        value
    }

    fn scalar(x: f64) -> f64 {
        super::j0(x)
    }
}

impl Function for J1 {
    const ZERO: (f64, f64) = c::ZERO_1;
    const NEAR: &'static [f64] = &c::NEAR_1;
    const MIDDLE: (&'static [f64], &'static [f64]) = (&c::MIDDLE_AMPLITUDE_1, &c::MIDDLE_PHASE_1);
    const FAR: (&'static [f64], &'static [f64]) = (&c::FAR_AMPLITUDE_1, &c::FAR_PHASE_1);
    const QUARTER: f64 = 0.25;

    #[inline(always)]
    fn near(even: f64, x: f64) -> f64 {
        even * x
    }

    #[inline(always)]
    fn far(value: f64, x: f64) -> f64 {
        f64::from_bits(value.to_bits() ^ (x.to_bits() & (1 << 63)))
    }

    fn scalar(x: f64) -> f64 {
        super::j1(x)
    }
}

impl Function for Jinc {
    const ZERO: (f64, f64) = J1::ZERO;
    const NEAR: &'static [f64] = J1::NEAR;
    const MIDDLE: (&'static [f64], &'static [f64]) = J1::MIDDLE;
    const FAR: (&'static [f64], &'static [f64]) = J1::FAR;
    const QUARTER: f64 = J1::QUARTER;

    #[inline(always)]
    fn near(even: f64, _: f64) -> f64 {
        even
    }

    #[inline(always)]
    fn far(value: f64, x: f64) -> f64 {
        value / x.abs()
    }

    fn scalar(x: f64) -> f64 {
        super::jinc(x)
    }
}

/// a·b + c, fused or not.
pub trait MulAdd {
    fn mul_add(a: f64, b: f64, c: f64) -> f64;
}

/// One rounding; only where the CPU has the instruction, or it would be a slow library call.
struct Fused;
/// Whatever the target always has.
struct Portable;
/// Two roundings, on every CPU.
struct Separate;

impl MulAdd for Fused {
    #[inline(always)]
    fn mul_add(a: f64, b: f64, c: f64) -> f64 {
        a.mul_add(b, c)
    }
}

impl MulAdd for Portable {
    #[inline(always)]
    fn mul_add(a: f64, b: f64, c: f64) -> f64 {
        if cfg!(any(target_feature = "fma", target_arch = "aarch64")) {
            a.mul_add(b, c)
        } else {
            a * b + c
        }
    }
}

impl MulAdd for Separate {
    #[inline(always)]
    fn mul_add(a: f64, b: f64, c: f64) -> f64 {
        a * b + c
    }
}

/// `F` of every element of `x` into `out`.
pub fn fill<F: Function>(x: &[f64], out: &mut [f64]) {
    assert_eq!(x.len(), out.len(), "one result for every argument");
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
        // SAFETY: the CPU has just been found to have both features.
        return unsafe { fill_avx2::<F>(x, out) };
    }
    fill_with::<F, Portable>(x, out);
}

/// As [`fill`], with the same bits on every CPU.
pub fn fill_alike<F: Function>(x: &[f64], out: &mut [f64]) {
    assert_eq!(x.len(), out.len(), "one result for every argument");
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        // SAFETY: the CPU has just been found to have the feature.
        return unsafe { fill_alike_avx2::<F>(x, out) };
    }
    fill_with::<F, Separate>(x, out);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn fill_alike_avx2<F: Function>(x: &[f64], out: &mut [f64]) {
    fill_with::<F, Separate>(x, out);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn fill_avx2<F: Function>(x: &[f64], out: &mut [f64]) {
    fill_with::<F, Fused>(x, out);
}

/// Every value is that of its range whatever its neighbours are, so cutting changes nothing.
#[inline(always)]
fn fill_with<F: Function, A: MulAdd>(x: &[f64], out: &mut [f64]) {
    for (x, out) in x.chunks(CHUNK).zip(out.chunks_mut(CHUNK)) {
        let [mut near, mut far, mut inside] = [0_u64; 3];
        for &x in x {
            near += u64::from(x.abs() < NEAR);
            far += u64::from(x.abs() >= FAR);
            inside += u64::from(x.abs() <= LARGEST);
        }
        let all = x.len() as u64;
        if far > 0 {
            for (&x, out) in x.iter().zip(&mut *out) {
                *out = oscillating::<F, A>(x, c::FAR_SHIFT, F::FAR);
            }
        }
        if near + far < all {
            for (&x, out) in x.iter().zip(&mut *out) {
                let value = oscillating::<F, A>(x, c::MIDDLE_SHIFT, F::MIDDLE);
                *out = if x.abs() < FAR { value } else { *out };
            }
        }
        if near > 0 {
            for (&x, out) in x.iter().zip(&mut *out) {
                let value = around_zero::<F, A>(x);
                *out = if x.abs() < NEAR { value } else { *out };
            }
        }
        if inside < all {
            outside::<F>(x, out);
        }
    }
}

#[cold]
fn outside<F: Function>(x: &[f64], out: &mut [f64]) {
    for (&x, out) in x.iter().zip(out) {
        if x.is_nan() || x.abs() > LARGEST {
            *out = F::scalar(x);
        }
    }
}

#[inline(always)]
fn polynomial<A: MulAdd>(coefficients: &[f64], x: f64) -> f64 {
    let (&last, rest) = coefficients.split_last().expect("no polynomial is empty");
    rest.iter().rev().fold(last, |value, &c| A::mul_add(value, x, c))
}

#[inline(always)]
fn around_zero<F: Function, A: MulAdd>(x: f64) -> f64 {
    let a = x.abs();
    let distance = (a - F::ZERO.0) - F::ZERO.1;
    let even = polynomial::<A>(F::NEAR, A::mul_add(x, x, -8.0));
    F::near(even * (distance * (a + F::ZERO.0)), x)
}

#[inline(always)]
fn oscillating<F: Function, A: MulAdd>(
    x: f64,
    shift: f64,
    (amplitude, phase): (&[f64], &[f64]),
) -> f64 {
    /// Adding this to a small number rounds it to an integer, which stands in the lowest bits.
    const ROUNDER: f64 = 6_755_399_441_055_744.0; // 1.5·2⁵²
    let a = x.abs();
    let w = 1.0 / A::mul_add(a, a, shift);
    let aw = a * w;
    let shifted = A::mul_add(a, std::f64::consts::FRAC_1_PI, -F::QUARTER) + ROUNDER;
    let n = (shifted - ROUNDER) + F::QUARTER;
    let small = A::mul_add(-n, c::PI_3, A::mul_add(aw, polynomial::<A>(phase, w), -n * c::PI_2));
    let r = A::mul_add(-n, c::PI_1, a) + small;
    let r2 = r * r;
    let sine = A::mul_add(r * r2, polynomial::<A>(&c::SINE, r2), r);
    let value = aw.sqrt() * polynomial::<A>(amplitude, w) * sine;
    // sin(r + nπ) = (−1)ⁿ sin r.
    F::far(f64::from_bits(value.to_bits() ^ (shifted.to_bits() << 63)), x)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What runs where there is no AVX2 keeps the bound too, on the same reference rows.
    #[test]
    fn portable_code_keeps_the_bound() {
        let rows = include_str!("../../tests/data/bessel.csv").lines().skip(1);
        let rows: Vec<[f64; 3]> = rows
            .map(|row| {
                let mut cells = row.split(',').map(|cell| cell.parse().expect("a number"));
                [(); 3].map(|()| cells.next().expect("three columns"))
            })
            .collect();
        let x: Vec<f64> = rows.iter().map(|row| row[0]).collect();
        let mut out = vec![0.0; x.len()];
        for (column, fill) in [
            (1, fill_with::<J0, Portable> as fn(&[f64], &mut [f64])),
            (2, fill_with::<J1, Portable>),
            (1, fill_alike::<J0>),
            (2, fill_alike::<J1>),
        ] {
            fill(&x, &mut out);
            for (got, row) in out.iter().zip(&rows) {
                let envelope = (2.0 / (std::f64::consts::PI * row[0])).sqrt().min(1.0);
                let error = (got - row[column]).abs() / (f64::EPSILON * envelope);
                assert!(error <= 4.0, "J{} at {}: {error} ε·M", column - 1, row[0]);
            }
        }
    }

    /// Vectorised or not, and however the slice was cut.
    #[test]
    fn alike_is_alike() {
        let x: Vec<f64> =
            (0..4000).map(|i| f64::from(i) * 0.037 - 20.0).chain([2e7, 0.0]).collect();
        let (mut wide, mut narrow) = (vec![0.0; x.len()], vec![0.0; x.len()]);
        fill_alike::<J0>(&x, &mut wide);
        for (x, out) in x.iter().zip(&mut narrow) {
            fill_with::<J0, Separate>(std::slice::from_ref(x), std::slice::from_mut(out));
        }
        assert_eq!(wide, narrow);
        fill_alike::<Jinc>(&x, &mut wide);
        for (x, out) in x.chunks(7).zip(narrow.chunks_mut(7)) {
            fill_with::<Jinc, Separate>(x, out);
        }
        assert_eq!(wide, narrow);
    }
}
