//! J0, J1 and jinc against 25-digit values, over the whole line, scalar and by slice.

use bn_spectral::{j0, j0_slice, j1, j1_slice, jinc, jinc_slice};
use proptest::prelude::*;

/// min(1, √(2/(πx))): the size of J0 and J1 around x.
fn envelope(x: f64) -> f64 {
    (std::f64::consts::FRAC_2_PI / x.abs()).sqrt().min(1.0)
}

/// Argument and the three reference values of every row, all finite doubles.
fn reference() -> Vec<[f64; 4]> {
    let rows = include_str!("../data/bessel.csv").lines().skip(1);
    rows.map(|row| {
        let mut cells = row.split(',').map(|cell| cell.parse().expect("a number"));
        [(); 4].map(|()| cells.next().expect("four columns"))
    })
    .collect()
}

fn by_slice(f: fn(&[f64], &mut [f64]), x: &[f64]) -> Vec<f64> {
    let mut out = vec![f64::NAN; x.len()];
    f(x, &mut out);
    out
}

/// The largest error in units of the scale, with its argument.
fn worst(x: &[f64], got: &[f64], want: &[f64], scale: impl Fn(f64) -> f64) -> (f64, f64) {
    let errors = x.iter().zip(got).zip(want).map(|((&x, g), w)| ((g - w).abs() / scale(x), x));
    errors.fold((0.0, 0.0), |a, b| if b.0 > a.0 || b.0.is_nan() { b } else { a })
}

#[test]
fn errors_stay_below_four_epsilon_of_the_envelope() {
    let rows = reference();
    assert!(
        rows.len() == 356 && rows.iter().any(|r| r[0] == 0.0) && rows.iter().any(|r| r[0] >= 9e5)
    );
    // Both functions are even or odd: the same rows test the negative axis.
    for sign in [1.0, -1.0] {
        let x: Vec<f64> = rows.iter().map(|r| sign * r[0]).collect();
        let column = |k: usize, odd: f64| rows.iter().map(|r| odd * r[k]).collect::<Vec<f64>>();
        let unit = |x: f64| f64::EPSILON * envelope(x);
        let jinc_unit = |x: f64| unit(x) / x.abs().max(1.0);
        let scalar = |f: fn(f64) -> f64| x.iter().map(|&x| f(x)).collect::<Vec<f64>>();
        for (name, got, want, jinc) in [
            ("j0", scalar(j0), column(1, 1.0), false),
            ("j1", scalar(j1), column(2, sign), false),
            ("jinc", scalar(jinc), column(3, 1.0), true),
            ("j0_slice", by_slice(j0_slice, &x), column(1, 1.0), false),
            ("j1_slice", by_slice(j1_slice, &x), column(2, sign), false),
            ("jinc_slice", by_slice(jinc_slice, &x), column(3, 1.0), true),
        ] {
            let (error, at) =
                if jinc { worst(&x, &got, &want, jinc_unit) } else { worst(&x, &got, &want, unit) };
            println!("{name}: {error:.2} ε·M at {at}");
            assert!(error <= 4.0, "{name} is off by {error} ε·M at {at}");
        }
    }
}

#[test]
fn jinc_is_one_half_down_to_the_smallest_numbers() {
    let x = [0.0, -0.0, 5e-324, 1e-310, -1e-200, 1e-9];
    assert!(x.iter().all(|&x| jinc(x) == 0.5));
    assert!(by_slice(jinc_slice, &x).iter().all(|v| (v - 0.5).abs() <= f64::EPSILON / 2.0));
}

#[test]
fn the_ends_of_the_line_are_ordinary() {
    let x = [f64::INFINITY, f64::NEG_INFINITY, f64::NAN, f64::MAX, 1e300, 1.7e7, -1.7e7];
    for (slice, scalar) in [
        (j0_slice as fn(&[f64], &mut [f64]), j0 as fn(f64) -> f64),
        (j1_slice, j1),
        (jinc_slice, jinc),
    ] {
        for (got, &x) in by_slice(slice, &x).iter().zip(&x) {
            assert!(*got == scalar(x) || (x.is_nan() && got.is_nan()), "{got} at {x}");
            // The amplitude of J1 exceeds its limit by 3/(16x²).
            assert!(x.is_nan() || got.abs() <= envelope(x) * (1.0 + 1e-12));
        }
    }
    j0_slice(&[], &mut []);
}

proptest! {
    /// A value is that of its argument whatever stands beside it: cuts and neighbours change no bit.
    #[test]
    fn values_do_not_depend_on_the_cut(
        x in prop::collection::vec(prop_oneof![-5.0..5.0_f64, 3.9..4.1_f64, 0.0..100.0_f64, -1e8..1e8_f64], 1..150),
        cut in 0.0..1.0_f64,
    ) {
        for f in [j0_slice, j1_slice, jinc_slice] {
            let whole = by_slice(f, &x);
            let (head, tail) = x.split_at((cut * x.len() as f64) as usize);
            let parts = [by_slice(f, head), by_slice(f, tail)].concat();
            prop_assert!(whole.iter().zip(&parts).all(|(a, b)| a.to_bits() == b.to_bits()));
            for (&x, &value) in x.iter().zip(&whole) {
                prop_assert_eq!(by_slice(f, &[x])[0].to_bits(), value.to_bits());
            }
        }
    }

    /// Both implementations within their bounds of the truth are within twice that of each other.
    #[test]
    fn slices_agree_with_the_scalar_functions(x in prop::collection::vec(-1e6..1e6_f64, 64), scale in -5..1_i32) {
        let x: Vec<f64> = x.iter().map(|x| x * 10.0_f64.powi(scale)).collect();
        for (&x, got) in x.iter().zip(by_slice(j0_slice, &x)) {
            prop_assert!((got - j0(x)).abs() <= 8.0 * f64::EPSILON * envelope(x), "J0 at {}", x);
        }
        for (&x, got) in x.iter().zip(by_slice(j1_slice, &x)) {
            prop_assert!((got - j1(x)).abs() <= 8.0 * f64::EPSILON * envelope(x), "J1 at {}", x);
        }
    }
}
