//! A uniformly sampled function of one variable.

/// A real function sampled at `start + i·step`, such as an RDF or a radial power spectrum.
///
/// What the samples stand for (values at a point, means over a bin whose lower edge or centre is
/// the abscissa) is said where a curve is made.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Samples"))]
pub struct Curve {
    start: f64,
    step: f64,
    values: Vec<f64>,
}

/// A curve as it is read, before it is checked; null stands for NaN.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
struct Samples {
    start: f64,
    step: f64,
    values: Vec<Option<f64>>,
}

#[cfg(feature = "serde")]
impl TryFrom<Samples> for Curve {
    type Error = &'static str;

    fn try_from(samples: Samples) -> Result<Self, Self::Error> {
        let Samples { start, step, values } = samples;
        let values: Vec<f64> = values.into_iter().map(|v| v.unwrap_or(f64::NAN)).collect();
        let end = start + values.len() as f64 * step;
        if values.is_empty() || !(step > 0.0 && start.is_finite() && end.is_finite()) {
            return Err("a curve needs values at finite, increasing abscissae");
        }
        Ok(Self::new(start, step, values))
    }
}

impl Curve {
    /// The curve with these values at `start`, `start + step`, …
    ///
    /// # Panics
    /// If `values` is empty, `step` is not positive or an abscissa is not finite. The values
    /// themselves are free: a spectrum may be undefined (NaN) where no mode lies.
    pub fn new(start: f64, step: f64, values: Vec<f64>) -> Self {
        assert!(!values.is_empty(), "a curve needs a value");
        assert!(step > 0.0 && start.is_finite(), "abscissae {start} + i·{step} are not a grid");
        let curve = Self { start, step, values };
        assert!(curve.end().is_finite(), "the last abscissa is not finite");
        curve
    }

    /// The curve of `f` at `n` abscissae `start + i·step`.
    ///
    /// # Panics
    /// As [`Curve::new`].
    pub fn sample(start: f64, step: f64, n: usize, f: impl FnMut(f64) -> f64) -> Self {
        Self::new(start, step, (0..n).map(|i| start + i as f64 * step).map(f).collect())
    }

    /// The first abscissa.
    pub fn start(&self) -> f64 {
        self.start
    }

    /// The distance between abscissae.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// The last abscissa.
    pub fn end(&self) -> f64 {
        self.abscissa(self.values.len() - 1)
    }

    /// The abscissa of sample `index`, rounded once.
    pub fn abscissa(&self, index: usize) -> f64 {
        self.start + index as f64 * self.step
    }

    /// The samples.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The samples, by value.
    pub fn into_values(self) -> Vec<f64> {
        self.values
    }

    /// Abscissae and values in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (f64, f64)> {
        self.values.iter().enumerate().map(|(i, &y)| (self.abscissa(i), y))
    }

    /// The curve with every value mapped by `f(abscissa, value)`.
    #[must_use]
    pub fn map(&self, mut f: impl FnMut(f64, f64) -> f64) -> Self {
        let values = self.iter().map(|(x, y)| f(x, y)).collect();
        Self { start: self.start, step: self.step, values }
    }

    /// Linear interpolation at `x`; the end values outside the sampled range.
    ///
    /// Error at most step²/8 times the largest second derivative.
    pub fn interpolate(&self, x: f64) -> f64 {
        let position = (x - self.start) / self.step;
        let last = self.values.len() - 1;
        if position.is_nan() {
            return f64::NAN;
        }
        if position <= 0.0 {
            return self.values[0];
        }
        if position >= last as f64 {
            return self.values[last];
        }
        let i = position as usize;
        let t = position - i as f64;
        self.values[i] * (1.0 - t) + self.values[i + 1] * t
    }

    /// The integral from the first to the last abscissa by the trapezoid rule.
    ///
    /// Error at most (end − start)·step²/12 times the largest second derivative.
    pub fn integral(&self) -> f64 {
        let n = self.values.len();
        if n == 1 {
            return 0.0;
        }
        let inner: f64 = self.values[1..n - 1].iter().sum();
        self.step * (inner + 0.5 * (self.values[0] + self.values[n - 1]))
    }

    /// The curve convolved with a Gaussian of standard deviation `sigma` in units of the abscissa,
    /// cut at 4σ; at the ends the weights inside the range are normalised to 1, so a constant
    /// stays that constant. Cost O(n·σ/step).
    ///
    /// # Panics
    /// If `sigma` is negative or not finite.
    #[must_use]
    pub fn smoothed(&self, sigma: f64) -> Self {
        assert!(sigma >= 0.0 && sigma.is_finite(), "sigma {sigma} is not a width");
        let sigma_bins = sigma / self.step;
        let reach = ((4.0 * sigma_bins).ceil() as usize).min(self.values.len());
        if sigma_bins == 0.0 {
            return self.clone();
        }
        let weight: Vec<f64> =
            (0..=reach).map(|i| libm::exp(-0.5 * (i as f64 / sigma_bins).powi(2))).collect();
        let n = self.values.len();
        let smooth = |i: usize| {
            let (first, last) = (i.saturating_sub(reach), (i + reach).min(n - 1));
            let (mut sum, mut total) = (0.0, 0.0);
            for j in first..=last {
                let w = weight[i.abs_diff(j)];
                sum += w * self.values[j];
                total += w;
            }
            sum / total
        };
        Self { start: self.start, step: self.step, values: (0..n).map(smooth).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolates_lines_exactly_and_clamps() {
        let line = Curve::sample(1.0, 0.5, 5, |x| 3.0 * x - 1.0);
        for x in [1.0, 1.2, 2.75, 3.0] {
            assert!((line.interpolate(x) - (3.0 * x - 1.0)).abs() < 1e-14);
        }
        assert_eq!(line.interpolate(-7.0), 2.0);
        assert_eq!(line.interpolate(9.0), 8.0);
        assert!(line.interpolate(f64::NAN).is_nan());
    }

    #[test]
    fn integral_meets_its_error_bound() {
        let sine = Curve::sample(0.0, std::f64::consts::PI / 100.0, 101, libm::sin);
        let bound = std::f64::consts::PI * sine.step().powi(2) / 12.0;
        let error = (sine.integral() - 2.0).abs();
        assert!(error <= bound && error > 0.5 * bound / 2.0, "{error} against {bound}");
        assert_eq!(Curve::new(0.0, 1.0, vec![4.0]).integral(), 0.0);
    }

    #[test]
    fn smoothing_keeps_constants_and_widens_a_gaussian() {
        let flat = Curve::sample(0.0, 0.1, 50, |_| 2.5).smoothed(0.7);
        assert!(flat.values().iter().all(|v| (v - 2.5).abs() < 1e-14));
        // A Gaussian of variance 4 smoothed by one of variance 1 has variance 5.
        let bell = Curve::sample(-30.0, 0.1, 601, |x| libm::exp(-x * x / 8.0)).smoothed(1.0);
        for x in [0.0, 1.0, 3.0] {
            let want = (4.0_f64 / 5.0).sqrt() * libm::exp(-x * x / 10.0);
            // The cut at 4σ leaves out 6e-5 of the mass.
            assert!((bell.interpolate(x) - want).abs() < 1e-4, "at {x}");
        }
        assert_eq!(bell.smoothed(0.0), bell);
    }
}
