//! Intervals that an axis can be drawn over.

/// A finite interval wide enough to be divided: |low|, |high| ≤ 1e300 and
/// high − low ≥ 1e-9·max(|low|, |high|), at least 1e-300.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    low: f64,
    high: f64,
}

/// The largest magnitude kept, so that differences and products with small factors stay finite.
const HUGE: f64 = 1e300;

/// The smallest width kept, relative to the larger end.
const RELATIVE_WIDTH: f64 = 1e-9;

impl Range {
    /// The interval between `a` and `b`, mended where it cannot be drawn: ends are ordered and
    /// clamped to ±1e300, a NaN end becomes the other one (both: 0 … 1), and an interval that is
    /// too narrow is widened around its centre to half its magnitude either way (around 0: ±1).
    pub fn new(a: f64, b: f64) -> Self {
        let (a, b) = match (a.is_nan(), b.is_nan()) {
            (true, true) => (0.0, 1.0),
            (true, false) => (b, b),
            (false, true) => (a, a),
            (false, false) => (a, b),
        };
        let (a, b) = (a.clamp(-HUGE, HUGE), b.clamp(-HUGE, HUGE));
        let (low, high) = (a.min(b), a.max(b));
        let magnitude = low.abs().max(high.abs());
        if high - low >= (RELATIVE_WIDTH * magnitude).max(1.0 / HUGE) {
            return Self { low, high };
        }
        let half = if magnitude < 1.0 / HUGE { 1.0 } else { 0.5 * magnitude };
        Self { low: (low - half).max(-HUGE), high: (high + half).min(HUGE) }
    }

    /// The smallest range that holds the finite ones of `values`; `None` if there are none.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        values
            .into_iter()
            .filter(|v| v.is_finite())
            .fold(None, |ends, v| match ends {
                None => Some((v, v)),
                Some((low, high)) => Some((v.min(low), v.max(high))),
            })
            .map(|(low, high)| Self::new(low, high))
    }

    /// The part of the range that a logarithmic axis can show: the low end is lifted to 1e-12 of
    /// the high one where it is not positive; 0.1 … 10 if nothing is positive, and a range less
    /// than a factor 1.001 wide grows by √10 either way.
    #[must_use]
    pub fn positive(self) -> Self {
        if self.high <= 0.0 {
            return Self { low: 0.1, high: 10.0 };
        }
        let high = self.high.max(1e-290);
        let low = if self.low > 0.0 { self.low.max(1e-300) } else { 1e-12 * high };
        if high / low < 1.001 {
            return Self { low: low / 10f64.sqrt(), high: high * 10f64.sqrt() };
        }
        Self { low, high }
    }

    /// The lower end.
    pub fn low(self) -> f64 {
        self.low
    }

    /// The upper end.
    pub fn high(self) -> f64 {
        self.high
    }

    /// high − low, positive.
    pub fn width(self) -> f64 {
        self.high - self.low
    }

    /// Whether `value` lies in the closed interval.
    pub fn contains(self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }

    /// The smallest range that holds both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self::new(self.low.min(other.low), self.high.max(other.high))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mends_what_cannot_be_drawn() {
        assert_eq!(Range::new(3.0, 1.0), Range { low: 1.0, high: 3.0 });
        assert_eq!(Range::new(0.0, 0.0), Range { low: -1.0, high: 1.0 });
        assert_eq!(Range::new(4.0, 4.0), Range { low: 2.0, high: 6.0 });
        assert_eq!(Range::new(f64::NAN, 4.0), Range::new(4.0, 4.0));
        assert_eq!(Range::new(f64::NAN, f64::NAN), Range { low: 0.0, high: 1.0 });
        let all = Range::new(f64::NEG_INFINITY, f64::INFINITY);
        assert!(all.width().is_finite() && all.width() > 1e300);
        assert!(Range::new(1e16, 1e16 + 2.0).width() > 1e15);
        assert!(Range::new(5e-324, 5e-324).width() >= 1e-300);
    }

    #[test]
    fn is_taken_from_finite_values_only() {
        let values = [f64::NAN, 2.0, f64::INFINITY, -1.0];
        assert_eq!(Range::of(values), Some(Range::new(-1.0, 2.0)));
        assert_eq!(Range::of([f64::NAN, f64::INFINITY]), None);
        assert_eq!(Range::of([7.0]), Some(Range::new(7.0, 7.0)));
    }

    #[test]
    fn logarithmic_part_is_positive_and_wide() {
        for range in [
            Range::new(-3.0, -1.0),
            Range::new(-3.0, 5.0),
            Range::new(0.0, 1e300),
            Range::new(1.0, 1.0 + 1e-8),
            Range::new(0.0, 1e-299),
        ] {
            let part = range.positive();
            assert!(part.low() > 0.0 && part.high() / part.low() >= 1.001, "{part:?}");
        }
        assert_eq!(Range::new(1e-3, 10.0).positive(), Range::new(1e-3, 10.0));
    }
}
