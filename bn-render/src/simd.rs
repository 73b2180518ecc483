//! Loops built twice: once as they stand, once for processors with AVX2.

#![expect(clippy::inline_always, reason = "must be compiled anew under the features of the caller")]

/// Defines a function whose body is compiled for the baseline processor and for AVX2, and picks
/// the build at run time.
///
/// The body is plain code and neither build may contract `a * b + c` (Rust never does), so both
/// give the same bits: vectors only change how many elements are worked on at once. That is why
/// FMA is left alone. What it buys is in `benches/stages.rs`.
macro_rules! vectorized {
    (
        $(#[$meta:meta])*
        $vis:vis fn $name:ident $(< $(const $g:ident : usize),+ >)? (
            $($arg:ident : $ty:ty),* $(,)?
        ) $body:block
    ) => {
        $(#[$meta])*
        $vis fn $name $(< $(const $g: usize),+ >)? ($($arg: $ty),*) {
            #[inline(always)]
            fn plain $(< $(const $g: usize),+ >)? ($($arg: $ty),*) $body

            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2")]
                fn wide $(< $(const $g: usize),+ >)? ($($arg: $ty),*) {
                    plain $(::< $($g),+ >)? ($($arg),*);
                }
                if std::arch::is_x86_feature_detected!("avx2") {
                    // SAFETY: the processor has AVX2, the only thing `wide` asks for.
                    unsafe { wide $(::< $($g),+ >)? ($($arg),*) };
                    return;
                }
            }
            plain $(::< $($g),+ >)? ($($arg),*);
        }
    };
}
pub(crate) use vectorized;

/// Adding and subtracting this rounds a number below 2⁵¹ in size to the nearest integer.
pub(crate) const ROUND: f64 = 6_755_399_441_055_744.0;

/// cos(2π·`turns`), absolute error below 4e-16 plus 2π times the rounding of `turns` itself, for
/// |`turns`| < 2⁵¹; arithmetic only, so the same bits everywhere and many at once.
///
/// With y the distance to the nearest whole turn, cos 2πy = sin 2π(¼ − |y|); the odd polynomial of
/// the sine on [−¼, ¼] is its Chebyshev series cut at 1.8e-16 (computed with 80 digits).
#[inline(always)]
pub(crate) fn cos_turns(turns: f64) -> f64 {
    let whole = (turns + ROUND) - ROUND;
    let s = 0.25 - (turns - whole).abs();
    let z = s * s;
    let mut p = -0.692_509_553_392_359_3;
    p = p * z + 3.817_366_257_479_821_7;
    p = p * z - 15.094_506_194_366_875;
    p = p * z + 42.058_689_956_236_76;
    p = p * z - 76.705_859_689_678_69;
    p = p * z + 81.605_249_275_580_29;
    p = p * z - 41.341_702_240_398_29;
    p = p * z + 6.283_185_307_179_585;
    p * s
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cosine_of_turns_meets_its_bound() {
        for i in -40_000..=40_000 {
            let turns = f64::from(i) / 9973.0;
            // The oracle's argument is reduced first, as 2π·turns would lose digits.
            let reduced = turns - turns.round();
            let want = libm::cos(std::f64::consts::TAU * reduced);
            let got = cos_turns(turns);
            assert!((got - want).abs() < 9e-16, "at {turns}: {got} against {want}");
        }
        assert_eq!(cos_turns(1_048_577.0), cos_turns(0.0));
        assert!((cos_turns(0.0) - 1.0).abs() < 4e-16 && cos_turns(0.25) == 0.0);
    }

    vectorized! {
        fn cosines(turns: &[f64], out: &mut [f64]) {
            for (y, &x) in out.iter_mut().zip(turns) {
                *y = cos_turns(x);
            }
        }
    }

    #[test]
    fn both_builds_agree_to_the_bit() {
        let turns: Vec<f64> = (0..1003).map(|i| f64::from(i) * 0.7317 - 311.0).collect();
        let mut out = vec![0.0; turns.len()];
        cosines(&turns, &mut out);
        for (&x, &y) in turns.iter().zip(&out) {
            assert_eq!(cos_turns(x).to_bits(), y.to_bits(), "at {x}");
        }
    }
}
