//! An axis: what it measures, how it is scaled and over which range.

use super::{Range, Text, Ticks};

/// A horizontal or vertical axis, linear or logarithmic.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    label: Text,
    logarithmic: bool,
    marked: bool,
    range: Option<Range>,
}

impl Axis {
    /// A linear axis; its range comes from the data unless [`Axis::over`] gives one.
    pub fn linear(label: Text) -> Self {
        Self { label, logarithmic: false, marked: true, range: None }
    }

    /// A logarithmic axis. What is not positive has no place on it.
    pub fn log(label: Text) -> Self {
        Self { label, logarithmic: true, marked: true, range: None }
    }

    /// An axis from 0 to 1 without marks and label, for pictures that need no scale.
    pub fn blank() -> Self {
        Self { marked: false, ..Self::linear(Text::default()).over(0.0, 1.0) }
    }

    /// The axis over the range between `low` and `high`, mended as [`Range::new`] says.
    #[must_use]
    pub fn over(mut self, low: f64, high: f64) -> Self {
        self.range = Some(Range::new(low, high));
        self
    }

    /// The axis with its range settled: the given one, or that of `data` with a margin of 4 % on
    /// either side (none at 0 on a linear axis).
    pub(super) fn fitted(&self, data: impl IntoIterator<Item = f64>) -> FittedAxis {
        let usable = |v: &f64| !self.logarithmic || *v > 0.0;
        let fitted = || {
            Range::of(data.into_iter().filter(usable))
                .map_or(Range::new(f64::NAN, f64::NAN), |range| self.with_margin(range))
        };
        let range = self.range.unwrap_or_else(fitted);
        let range = if self.logarithmic { range.positive() } else { range };
        FittedAxis {
            label: self.label.clone(),
            logarithmic: self.logarithmic,
            marked: self.marked,
            range,
        }
    }

    fn with_margin(&self, range: Range) -> Range {
        if self.logarithmic {
            let range = range.positive();
            let factor = (range.high() / range.low()).powf(0.04).min(1e6);
            return Range::new(range.low() / factor, range.high() * factor);
        }
        let margin = 0.04 * range.width();
        let away = |end: f64, margin: f64| if end == 0.0 { 0.0 } else { end + margin };
        Range::new(away(range.low(), -margin), away(range.high(), margin))
    }
}

/// An axis whose range is known.
#[derive(Clone, Debug)]
pub(super) struct FittedAxis {
    label: Text,
    logarithmic: bool,
    marked: bool,
    range: Range,
}

impl FittedAxis {
    /// The place of `value` along the axis: 0 at the low end, 1 at the high end, NaN where the
    /// value has no place.
    pub fn position(&self, value: f64) -> f64 {
        let (low, high) = (self.range.low(), self.range.high());
        if self.logarithmic {
            let logarithm = if value > 0.0 { value.log10() } else { f64::NAN };
            (logarithm - low.log10()) / (high.log10() - low.log10())
        } else {
            (value - low) / (high - low)
        }
    }

    /// The range drawn.
    pub fn range(&self) -> Range {
        self.range
    }

    /// Marks for an axis `length` long, so few that labels `extent` long each keep their distance.
    pub fn ticks(&self, length: f64, extent: impl Fn(&Text) -> f64) -> Ticks {
        if !self.marked {
            return Ticks { major: vec![], labels: vec![], minor: vec![], exponent: 0 };
        }
        let fits = |ticks: &Ticks| {
            let ends: Vec<(f64, f64)> = ticks
                .major
                .iter()
                .zip(&ticks.labels)
                .map(|(&v, label)| (length * self.position(v), extent(label)))
                .collect();
            ends.windows(2).all(|w| w[1].0 - w[0].0 >= 0.5 * (w[0].1 + w[1].1) + LABEL_GAP)
        };
        let make = |most| {
            if self.logarithmic {
                Ticks::logarithmic(self.range, most)
            } else {
                Ticks::linear(self.range, most)
            }
        };
        let mut ticks = (2..=MOST_TICKS).rev().map(make).find(fits).unwrap_or_else(|| make(2));
        if !fits(&ticks) {
            // Two labels that meet even so: the first alone still says where the axis is.
            ticks.labels.iter_mut().skip(1).for_each(|label| *label = Text::default());
        }
        ticks
    }

    /// The axis's label, with the power of ten that its marks leave out.
    pub fn label(&self, ticks: &Ticks) -> Text {
        if ticks.exponent == 0 {
            return self.label.clone();
        }
        let exponent = super::ticks::signed(f64::from(ticks.exponent), 0);
        let factor = Text::math(&format!(" (×10^{{{exponent}}})"));
        self.label.clone().followed_by(factor)
    }
}

/// More labelled marks than this crowd a panel.
const MOST_TICKS: usize = 5;

/// Points left free between two labels of an axis.
const LABEL_GAP: f64 = 4.0;
