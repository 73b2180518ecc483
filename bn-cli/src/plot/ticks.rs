//! Where an axis is marked, and with what.

use super::{Range, Text};

/// The marks of an axis: labelled ones and, between them, short ones without a label.
#[derive(Clone, Debug, PartialEq)]
pub struct Ticks {
    /// Ascending positions of the labelled marks, all inside the range.
    pub major: Vec<f64>,
    /// One label a mark.
    pub labels: Vec<Text>,
    /// Positions of the unlabelled marks, all inside the range.
    pub minor: Vec<f64>,
    /// The power of ten that the labels leave out; the axis's own label has to name it.
    pub exponent: i32,
}

/// Tolerance, in steps, for an end of the range that is a multiple of the step but for rounding.
const END: f64 = 1e-6;

impl Ticks {
    /// At most `most` (at least 2 are allowed) labelled marks at multiples of 1, 2 or 5 times a
    /// power of ten, the smallest such step that fits. There is at least one mark.
    pub fn linear(range: Range, most: usize) -> Self {
        let most = most.max(2);
        // One step below the ideal power of ten, so that the search starts too fine.
        let start = (range.width() / most as f64).log10().floor() as i32 - 1;
        let mut step = Step { mantissa: 1, power: start };
        // Ends after six steps or so: the first is ten to a hundred times too fine.
        while step.count(range) > most as i64 {
            step = step.coarser();
        }
        let major = step.multiples(step.indices(range), range);
        let finer = step.subdivision();
        let minor = finer.multiples(finer.indices(range), range);
        let minor = minor.into_iter().filter(|v| !major.contains(v)).collect();
        let (labels, exponent) = step.labels(&major);
        Self { major, labels, minor, exponent }
    }

    /// Marks at powers of ten, every one or as many as `most` allows; over less than two of them at
    /// 1, 2 and 5 times a power of ten, over still less as [`Ticks::linear`]. `range` must be
    /// [`Range::positive`].
    pub fn logarithmic(range: Range, most: usize) -> Self {
        let most = most.max(2);
        let decades = |mantissas: &[u32], stride: usize| -> Vec<f64> {
            let first = range.low().log10().floor() as i32;
            let last = range.high().log10().ceil() as i32;
            (first..=last)
                .filter(|power| power.rem_euclid(stride as i32) == 0)
                .flat_map(|power| mantissas.iter().map(move |&m| times_power(f64::from(m), power)))
                .filter(|&v| range.contains(v))
                .collect()
        };
        let powers = decades(&[1], 1);
        let between = |major: &[f64], minor: Vec<f64>| -> Vec<f64> {
            minor.into_iter().filter(|v| !major.contains(v)).collect()
        };
        let (major, minor) = if powers.len() >= 2 {
            let stride = [1, 2, 3, 5, 10, 20, 50, 100, 200]
                .into_iter()
                .find(|&stride| decades(&[1], stride).len() <= most)
                .unwrap_or(500);
            let major = decades(&[1], stride);
            let minor = if stride == 1 { decades(&[2, 3, 4, 5, 6, 7, 8, 9], 1) } else { powers };
            let minor = if minor.len() > 100 { vec![] } else { between(&major, minor) };
            (major, minor)
        } else {
            let major = decades(&[1, 2, 5], 1);
            if major.len() < 2 || major.len() > most {
                return Self::linear_on_log(range, most);
            }
            let minor = between(&major, decades(&[3, 4, 6, 7, 8, 9], 1));
            (major, minor)
        };
        let labels = logarithmic_labels(&major);
        Self { major, labels, minor, exponent: 0 }
    }

    /// Linear marks, but always with full labels: a logarithmic axis has no common factor.
    fn linear_on_log(range: Range, most: usize) -> Self {
        let ticks = Self::linear(range, most);
        if ticks.exponent == 0 {
            return ticks;
        }
        let factor = format!("·10^{{{}}}", signed(f64::from(ticks.exponent), 0));
        let labels = ticks.labels.into_iter().map(|l| l.followed_by(Text::math(&factor))).collect();
        Self { labels, exponent: 0, ..ticks }
    }
}

/// mantissa · 10^power.
#[derive(Clone, Copy)]
struct Step {
    mantissa: i32,
    power: i32,
}

impl Step {
    fn value(self) -> f64 {
        times_power(f64::from(self.mantissa), self.power)
    }

    /// First and last multiple inside the range (the last below the first if there is none).
    fn indices(self, range: Range) -> (i64, i64) {
        let step = self.value();
        ((range.low() / step - END).ceil() as i64, (range.high() / step + END).floor() as i64)
    }

    fn count(self, range: Range) -> i64 {
        let (first, last) = self.indices(range);
        last - first + 1
    }

    fn coarser(self) -> Self {
        match self.mantissa {
            1 => Self { mantissa: 2, ..self },
            2 => Self { mantissa: 5, ..self },
            _ => Self { mantissa: 1, power: self.power + 1 },
        }
    }

    fn multiples(self, (first, last): (i64, i64), range: Range) -> Vec<f64> {
        let mantissa = i64::from(self.mantissa);
        (first..=last)
            .map(|i| {
                times_power((i * mantissa) as f64, self.power).clamp(range.low(), range.high())
            })
            .collect()
    }

    /// The step of the unlabelled marks: a fifth, a quarter or a fifth of 1, 2 or 5.
    fn subdivision(self) -> Self {
        match self.mantissa {
            1 => Self { mantissa: 2, power: self.power - 1 },
            2 => Self { mantissa: 5, power: self.power - 1 },
            _ => Self { mantissa: 1, power: self.power },
        }
    }

    /// Labels with just the decimals that the step needs, and the power of ten left out of them:
    /// 0 for numbers that read well in full.
    fn labels(self, values: &[f64]) -> (Vec<Text>, i32) {
        let largest = values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let plain = largest < 1e5 && self.power >= -4;
        let exponent = if plain || largest == 0.0 { 0 } else { largest.log10().floor() as i32 };
        let decimals = (exponent - self.power).clamp(0, 12) as usize;
        let label = |&v: &f64| Text::plain(&signed(times_power(v, -exponent), decimals));
        (values.iter().map(label).collect(), exponent)
    }
}

/// x · 10^power, exact up to one rounding for |power| ≤ 22.
fn times_power(x: f64, power: i32) -> f64 {
    // In two factors where one would overflow or underflow.
    let half = power / 2;
    let scale = |x: f64, p: i32| if p < 0 { x / 10f64.powi(-p) } else { x * 10f64.powi(p) };
    if power.abs() <= 300 { scale(x, power) } else { scale(scale(x, half), power - half) }
}

/// `value` with a true minus sign and without a negative zero.
pub(super) fn signed(value: f64, decimals: usize) -> String {
    let digits = format!("{:.decimals$}", value.abs());
    let is_zero = digits.bytes().all(|b| matches!(b, b'0' | b'.'));
    if value < 0.0 && !is_zero { format!("−{digits}") } else { digits }
}

fn logarithmic_labels(values: &[f64]) -> Vec<Text> {
    let plain = values.iter().all(|&v| (1e-3..1e4).contains(&v));
    let label = |&v: &f64| {
        let power = (v * (1.0 + 1e-9)).log10().floor() as i32;
        if plain {
            return Text::plain(&signed(v, power.min(0).unsigned_abs() as usize));
        }
        let mantissa = times_power(v, -power).round();
        let factor = if mantissa == 1.0 { String::new() } else { format!("{mantissa}·") };
        Text::math(&format!("{factor}10^{{{}}}", signed(f64::from(power), 0)))
    };
    values.iter().map(label).collect()
}
