//! The panels of functions of one variable.

use bn_core::Curve;

use crate::plot::{Axis, Panel, Range, Reference, Series, Text};

/// The distances shown, in `d_hex`: in the RDF and the autocorrelation.
pub const MOST_DISTANCE: f64 = 8.0;

/// Frequencies shown, in √n/2.
const MOST_FREQUENCY: f64 = 10.0;

/// Upper ends of an axis from 0: few, so that pages can be compared at a glance.
const TOPS: [f64; 3] = [2.0, 4.0, 8.0];

/// Anisotropy of m sets, with −10·log₁₀ m, what independent random sets have.
pub(super) fn anisotropy(curve: &Curve, sets: usize) -> Panel {
    let expected = -10.0 * (sets.max(1) as f64).log10();
    let (low, high) = decibels(&shown(curve, MOST_FREQUENCY), expected);
    let reference = Reference::horizontal(expected).named(Text::math("−10 log_{10} *m*"));
    let y = Axis::linear(Text::plain("anisotropy in dB")).over(low, high);
    panel("Anisotropy", curve, frequency(curve), y).reference(reference)
}

/// The radial distribution function with g = 1.
pub(super) fn rdf(curve: &Curve) -> Panel {
    let x = Axis::linear(Text::math("*r*/*d*_{hex}")).over(0.0, extent(curve, MOST_DISTANCE));
    against_one("Radial distribution function", "*g*", curve, x, MOST_DISTANCE)
}

/// Ring means of the power with P = 1.
pub(super) fn radial_power(curve: &Curve) -> Panel {
    against_one("Radial power", "*P*", curve, frequency(curve), MOST_FREQUENCY)
}

/// A curve that tends to 1, over a range from 0 that holds it or, if it has peaks like a
/// lattice's, all but those.
fn against_one(title: &str, symbol: &str, curve: &Curve, x: Axis, most_x: f64) -> Panel {
    let peak = Range::of(shown(curve, most_x)).map_or(1.0, Range::high);
    let top = TOPS.into_iter().find(|&top| peak <= top);
    let y = Axis::linear(Text::math(symbol)).over(0.0, top.unwrap_or(TOPS[TOPS.len() - 1]));
    let reference = Reference::horizontal(1.0).named(Text::math(&format!("{symbol} = 1")));
    let panel = panel(title, curve, x, y).reference(reference);
    match top {
        Some(_) => panel,
        None => panel.noted(Text::math(&format!("peak of {symbol}: {}", short(peak)))),
    }
}

fn panel(title: &str, curve: &Curve, x: Axis, y: Axis) -> Panel {
    let panel = Panel::new(x, y).titled(Text::plain(title)).line(Series::of_curve(curve));
    let has_value = curve.values().iter().any(|v| v.is_finite());
    if has_value { panel } else { panel.noted(Text::plain("undefined for this set")) }
}

fn frequency(curve: &Curve) -> Axis {
    Axis::linear(Text::math("*ν*/(√*n*/2)")).over(0.0, extent(curve, MOST_FREQUENCY))
}

/// The end of the x axis: that of the curve or `most`, whichever comes first.
fn extent(curve: &Curve, most: f64) -> f64 {
    if curve.end() > 0.0 { curve.end().min(most) } else { most }
}

/// The values at abscissae up to `most`.
fn shown(curve: &Curve, most: f64) -> Vec<f64> {
    curve.iter().filter(|&(x, _)| x <= most).map(|(_, y)| y).collect()
}

/// The ends of the dB axis: multiples of 5 around the values, but no further than 20 below and 40
/// above `expected` (rings of few modes are wild) and no closer than 10.
fn decibels(values: &[f64], expected: f64) -> (f64, f64) {
    let range = Range::of(values.iter().copied()).unwrap_or(Range::new(expected, expected));
    let five = |v: f64, rounding: fn(f64) -> f64| 5.0 * rounding(v / 5.0);
    let low = range.low().clamp(expected - 20.0, expected - 10.0);
    let high = range.high().clamp(expected + 10.0, expected + 40.0);
    (five(low, f64::floor), five(high, f64::ceil))
}

/// A number for a note: a whole one, or two digits and a power of ten.
fn short(value: f64) -> String {
    if value < 1e4 {
        return format!("{value:.0}");
    }
    let power = value.log10().floor();
    format!("{:.1}·10^{{{power}}}", value / 10f64.powf(power))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decibels_hold_the_reference_and_bound_the_wild() {
        assert_eq!(decibels(&[], 0.0), (-10.0, 10.0));
        assert_eq!(decibels(&[-12.0, -8.0, 3.0], -10.0), (-20.0, 5.0));
        assert_eq!(decibels(&[-300.0, 90.0, f64::NAN], -10.0), (-30.0, 30.0));
    }

    #[test]
    fn notes_stay_short() {
        assert_eq!(short(52.3), "52");
        assert_eq!(short(4096.0), "4096");
        assert_eq!(short(1.23e6), "1.2·10^{6}");
    }
}
