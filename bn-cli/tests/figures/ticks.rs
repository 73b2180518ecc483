//! Where axes are marked: for any range at all.

use bn_cli::plot::{Range, Text, Ticks};
use proptest::prelude::*;

/// Numbers of every size and kind, and pairs that differ by little.
fn any_end() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -100.0..100.0,
        2 => any::<f64>(),
        1 => (-300..300).prop_map(|power| 10f64.powi(power)),
        1 => Just(f64::NAN),
        1 => Just(f64::INFINITY),
        1 => Just(0.0),
        1 => (0..100u32).prop_map(|ulps| f64::from_bits(1.0_f64.to_bits() + u64::from(ulps))),
    ]
}

fn is_ascending_inside(values: &[f64], range: Range) -> bool {
    values.windows(2).all(|w| w[0] < w[1]) && values.iter().all(|&v| range.contains(v))
}

/// The number a label in full stands for.
fn read(label: &str) -> f64 {
    label.replace('−', "-").parse().unwrap()
}

/// The number that a power of ten such as 2·10⁻³, whose label's characters are "2·10−3", stands
/// for.
fn read_power(label: &str) -> f64 {
    let (mantissa, power) = label.split_once("10").unwrap();
    let mantissa = mantissa.strip_suffix('·').map_or(1.0, read);
    mantissa * 10f64.powf(read(power))
}

/// mantissa and power of ten of a step, if the mantissa is a whole digit.
fn digit(step: f64) -> Option<i64> {
    let mantissa = step / 10f64.powf(step.log10().floor());
    let digit = mantissa.round();
    ((mantissa - digit).abs() < 1e-5).then_some(digit as i64)
}

proptest! {
    #[test]
    fn linear_marks_are_few_and_round(a in any_end(), b in any_end(), most in 2usize..9) {
        let range = Range::new(a, b);
        let ticks = Ticks::linear(range, most);
        prop_assert!((1..=most).contains(&ticks.major.len()), "{:?}", ticks.major);
        prop_assert!(is_ascending_inside(&ticks.major, range));
        prop_assert!(is_ascending_inside(&ticks.minor, range));
        prop_assert!(ticks.minor.iter().all(|v| !ticks.major.contains(v)));
        prop_assert!(ticks.minor.len() <= 6 * (most + 1), "{:?}", ticks.minor.len());
        for pair in ticks.major.windows(2) {
            // Marks at the ends of the range are moved there by up to 1e-6 steps, and
            // differences of marks far from zero cancel.
            let step = pair[1] - pair[0];
            let cancelled = 1e-15 * pair[1].abs().max(pair[0].abs()) / step;
            prop_assume!(cancelled < 1e-6);
            prop_assert!(matches!(digit(step), Some(1 | 2 | 5 | 10)), "step {step}");
        }
    }

    #[test]
    fn linear_labels_say_where_their_marks_are(a in -1e9..1e9f64, width in 1e-3..1e9f64) {
        let range = Range::new(a, a + width);
        let ticks = Ticks::linear(range, 5);
        for (&v, label) in ticks.major.iter().zip(&ticks.labels) {
            let told = read(&label.characters()) * 10f64.powi(ticks.exponent);
            prop_assert!((told - v).abs() <= 2e-6 * range.width(), "{v} labelled {told}");
        }
        let mut labels: Vec<String> = ticks.labels.iter().map(Text::characters).collect();
        labels.dedup();
        prop_assert_eq!(labels.len(), ticks.major.len());
    }

    #[test]
    fn logarithmic_marks_are_inside(a in any_end(), b in any_end(), most in 2usize..9) {
        let range = Range::new(a, b).positive();
        let ticks = Ticks::logarithmic(range, most);
        prop_assert!((1..=most).contains(&ticks.major.len()), "{:?}", ticks.major);
        prop_assert_eq!(ticks.labels.len(), ticks.major.len());
        prop_assert_eq!(ticks.exponent, 0);
        prop_assert!(is_ascending_inside(&ticks.major, range), "{range:?} {:?}", ticks.major);
        prop_assert!(is_ascending_inside(&ticks.minor, range), "{range:?} {:?}", ticks.minor);
    }

    #[test]
    fn logarithmic_labels_say_where_their_marks_are(
        power in -20..20i32, mantissa in 1.0..10.0f64, decades in 0.5..30.0f64,
    ) {
        let low = mantissa * 10f64.powi(power);
        let ticks = Ticks::logarithmic(Range::new(low, low * 10f64.powf(decades)), 5);
        let in_full = ticks.major.iter().all(|&v| (1e-3..1e4).contains(&v));
        let read = if in_full { read } else { read_power };
        for (&v, label) in ticks.major.iter().zip(&ticks.labels) {
            let told = read(&label.characters());
            prop_assert!((told / v - 1.0).abs() < 1e-6, "{v} labelled {}", label.characters());
        }
    }
}

#[test]
fn common_ranges_get_the_expected_marks() {
    let labels =
        |ticks: Ticks| -> Vec<String> { ticks.labels.iter().map(Text::characters).collect() };
    for (low, high, expected) in [
        (0.0, 1.0, "0.0 0.5 1.0"),
        (-10.0, 10.0, "−10 −5 0 5 10"),
        (0.0, 8.0, "0 2 4 6 8"),
        (-25.0, 5.0, "−20 −10 0"),
        (0.0, 2.5e6, "0.0 0.5 1.0 1.5 2.0 2.5"),
        (4.9, 5.1, "4.90 4.95 5.00 5.05 5.10"),
    ] {
        let most = expected.split(' ').count().max(5);
        assert_eq!(labels(Ticks::linear(Range::new(low, high), most)).join(" "), expected);
    }
    for (low, high, expected) in [
        (1e-14, 0.1, "10−12 10−9 10−6 10−3"),
        (1.0, 1000.0, "1 10 100 1000"),
        (16.0, 128.0, "20 50 100"),
        (2.1, 4.4, "2.5 3.0 3.5 4.0"),
    ] {
        assert_eq!(labels(Ticks::logarithmic(Range::new(low, high), 5)).join(" "), expected);
    }
}
