//! Complex FFTs of several signals at once, one in each lane of the vector registers.
//!
//! Every operation is an addition or a product of lanes, never fused, and the twiddles come from
//! libm: the result has the same bits on every CPU, with whatever instructions it is computed. That
//! is what `NufftOptions::portable` promises, at about the speed of `rustfft` with AVX2.
//!
//! Stockham's autosorting algorithm with mixed radices (C. Van Loan, *Computational Frameworks for the
//! Fast Fourier Transform*, 1992, §1.7).

use std::f64::consts::TAU;

use bn_fft::Complex;

use super::real::Real;
use super::simd::Job;

/// Signals that are transformed together.
pub(super) const LANES: usize = 8;

/// The same element of all signals.
#[derive(Clone, Copy, Debug)]
pub struct Lanes<T> {
    re: [T; LANES],
    im: [T; LANES],
}

impl<T: Real> Lanes<T> {
    pub(super) fn zero() -> Self {
        Self { re: [T::default(); LANES], im: [T::default(); LANES] }
    }
}

/// Tables for transforms of one length.
#[derive(Debug)]
pub(super) struct BatchFft<T> {
    size: usize,
    passes: Vec<Pass<T>>,
}

#[derive(Debug)]
struct Pass<T> {
    radix: usize,
    /// e^(−2πi pk/m) for each p below m/radix, k = 1 … radix − 1, m what is left to transform.
    twiddles: Vec<Complex<T>>,
    /// e^(−2πi k/radix).
    roots: Vec<Complex<T>>,
}

impl<T: Real> BatchFft<T> {
    /// For signals of `size` numbers, a product of primes up to 11.
    pub(super) fn new(size: usize) -> Self {
        let (mut left, mut passes) = (size, Vec::new());
        for radix in [4, 2, 3, 5, 7, 11] {
            while left.is_multiple_of(radix) {
                let twiddle = |i: usize| {
                    let (p, k) = (i / (radix - 1), i % (radix - 1) + 1);
                    root((p * k) as f64 / left as f64)
                };
                passes.push(Pass {
                    radix,
                    twiddles: (0..left / radix * (radix - 1)).map(twiddle).collect(),
                    roots: (0..radix).map(|k| root(k as f64 / radix as f64)).collect(),
                });
                left /= radix;
            }
        }
        assert_eq!(left, 1, "{size} has a prime factor above 11");
        Self { size, passes }
    }
}

/// e^(−2πi turns).
fn root<T: Real>(turns: f64) -> Complex<T> {
    let (sin, cos) = libm::sincos(-TAU * turns);
    Complex::new(T::narrow(cos), T::narrow(sin))
}

/// Transforms up to [`LANES`] signals in place.
pub struct BatchTransform<'a, T> {
    pub(super) fft: &'a BatchFft<T>,
    /// e^(+2πi…) instead of e^(−2πi…).
    pub(super) inverse: bool,
    /// The signals' numbers, one signal every `stride`.
    pub(super) signals: &'a mut [Complex<T>],
    pub(super) stride: usize,
    /// Twice the size.
    pub(super) scratch: &'a mut [Lanes<T>],
}

impl<T: Real> Job for BatchTransform<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Self { fft, inverse, signals, stride, scratch } = self;
        let (mut from, mut to) = scratch[..2 * fft.size].split_at_mut(fft.size);
        // With real and imaginary parts exchanged, forward becomes inverse.
        for (lane, signal) in signals.chunks(stride).enumerate() {
            for (out, z) in from.iter_mut().zip(signal) {
                (out.re[lane], out.im[lane]) = if inverse { (z.im, z.re) } else { (z.re, z.im) };
            }
        }
        let mut done = 1;
        for pass in &fft.passes {
            match pass.radix {
                2 => run_pass::<T, 2>(pass, done, from, to),
                3 => run_pass::<T, 3>(pass, done, from, to),
                4 => run_pass::<T, 4>(pass, done, from, to),
                5 => run_pass::<T, 5>(pass, done, from, to),
                7 => run_pass::<T, 7>(pass, done, from, to),
                _ => run_pass::<T, 11>(pass, done, from, to),
            }
            std::mem::swap(&mut from, &mut to);
            done *= pass.radix;
        }
        for (lane, signal) in signals.chunks_mut(stride).enumerate() {
            for (z, out) in signal.iter_mut().zip(&*from) {
                let (re, im) = (out.re[lane], out.im[lane]);
                *z = if inverse { Complex::new(im, re) } else { Complex::new(re, im) };
            }
        }
    }
}

/// One radix: `done` transforms of what is left are interleaved in `from`.
#[inline(always)]
fn run_pass<T: Real, const R: usize>(
    pass: &Pass<T>,
    done: usize,
    from: &[Lanes<T>],
    to: &mut [Lanes<T>],
) {
    let part = from.len() / R;
    let roots: &[Complex<T>; R] = pass.roots.first_chunk().expect("one root for each");
    let inputs: [&[Lanes<T>]; R] = std::array::from_fn(|j| &from[j * part..(j + 1) * part]);
    let blocks = to.chunks_exact_mut(R * done).zip(pass.twiddles.chunks_exact(R - 1));
    for (p, (out, twiddles)) in blocks.enumerate() {
        for q in 0..done {
            let at = p * done + q;
            let b = butterfly(std::array::from_fn(|j| inputs[j][at]), roots);
            out[q] = b[0];
            for k in 1..R {
                out[k * done + q] = times(b[k], twiddles[k - 1]);
            }
        }
    }
}

/// Σⱼ aⱼ e^(−2πi jk/R) for k = 0 … R − 1.
#[inline(always)]
fn butterfly<T: Real, const R: usize>(a: [Lanes<T>; R], roots: &[Complex<T>; R]) -> [Lanes<T>; R] {
    let mut b = a;
    if R == 2 {
        (b[0], b[1]) = (plus(a[0], a[1]), minus(a[0], a[1]));
    } else if R == 4 {
        let (even, odd) = (plus(a[0], a[2]), minus(a[0], a[2]));
        let (sum, difference) = (plus(a[1], a[3]), minus(a[1], a[3]));
        // −i·(a₁ − a₃)
        let turned = Lanes { re: difference.im, im: difference.re.map(|x| -x) };
        (b[0], b[2]) = (plus(even, sum), minus(even, sum));
        (b[1], b[3]) = (plus(odd, turned), minus(odd, turned));
    } else {
        odd_butterfly(&mut b, roots);
    }
    b
}

/// For odd R: pairs j and R − j share their cosines, and their sines up to the sign.
#[inline(always)]
fn odd_butterfly<T: Real, const R: usize>(b: &mut [Lanes<T>; R], roots: &[Complex<T>; R]) {
    let a = *b;
    for j in 1..=R / 2 {
        b[0] = plus(b[0], plus(a[j], a[R - j]));
    }
    for k in 1..=R / 2 {
        let (mut even, mut odd) = (a[0], Lanes::zero());
        for j in 1..=R / 2 {
            let root = roots[j * k % R];
            let (sum, difference) = (plus(a[j], a[R - j]), minus(a[j], a[R - j]));
            for l in 0..LANES {
                even.re[l] += root.re * sum.re[l];
                even.im[l] += root.re * sum.im[l];
                // i·sin·difference
                odd.re[l] -= root.im * difference.im[l];
                odd.im[l] += root.im * difference.re[l];
            }
        }
        (b[k], b[R - k]) = (plus(even, odd), minus(even, odd));
    }
}

#[inline(always)]
fn plus<T: Real>(mut a: Lanes<T>, b: Lanes<T>) -> Lanes<T> {
    for l in 0..LANES {
        a.re[l] += b.re[l];
        a.im[l] += b.im[l];
    }
    a
}

#[inline(always)]
fn minus<T: Real>(mut a: Lanes<T>, b: Lanes<T>) -> Lanes<T> {
    for l in 0..LANES {
        a.re[l] -= b.re[l];
        a.im[l] -= b.im[l];
    }
    a
}

#[inline(always)]
fn times<T: Real>(a: Lanes<T>, w: Complex<T>) -> Lanes<T> {
    let mut product = a;
    for l in 0..LANES {
        product.re[l] = a.re[l] * w.re - a.im[l] * w.im;
        product.im[l] = a.re[l] * w.im + a.im[l] * w.re;
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nufft::simd::Simd;

    /// Every radix, several signals at once, both directions, against the sums themselves.
    #[test]
    fn transforms_are_the_sums() {
        for (size, signals) in
            [(4, 1), (24, 8), (60, 3), (84, 8), (132, 5), (2 * 3 * 5 * 7 * 11, 2)]
        {
            let value = |i: usize| {
                let i = (i * 7919 % 10_007) as f64;
                Complex::new(libm::sin(i), libm::cos(1.3 * i))
            };
            let input: Vec<Complex<f64>> = (0..size * signals).map(value).collect();
            let fft = BatchFft::new(size);
            for inverse in [false, true] {
                let mut output = input.clone();
                let mut scratch = vec![Lanes::zero(); 2 * size];
                let job = BatchTransform {
                    fft: &fft,
                    inverse,
                    signals: &mut output,
                    stride: size,
                    scratch: &mut scratch,
                };
                Simd::portable().run(job);
                for (signal, got) in input.chunks(size).zip(output.chunks(size)) {
                    let (mut error, mut norm) = (0.0, 0.0);
                    for (k, got) in got.iter().enumerate() {
                        let term = |(j, z): (usize, &Complex<f64>)| {
                            let root = root::<f64>((j * k % size) as f64 / size as f64);
                            z * if inverse { root.conj() } else { root }
                        };
                        let want: Complex<f64> = signal.iter().enumerate().map(term).sum();
                        error += (got - want).norm_sqr();
                        norm += want.norm_sqr();
                    }
                    // The sums' own rounding, a random walk; the transform's is ε·log₂(size).
                    let bound = 2.0 * f64::EPSILON * (size as f64).sqrt();
                    assert!(error <= bound * bound * norm, "{size}: {error} of {norm}");
                }
            }
        }
    }
}
