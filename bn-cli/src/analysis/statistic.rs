//! The statistics by name.

use std::fmt;
use std::str::FromStr;

use crate::Failure;

/// A statistic of a point set or an ensemble.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Statistic {
    /// Smallest nearest-neighbour distance, over `d_hex`; mean over the sets.
    MinDistance,
    /// Mean nearest-neighbour distance, over `d_hex`; mean over the sets.
    MeanDistance,
    /// Radius of the largest circle that holds no point, over `d_hex`; mean over the sets.
    CoverageRadius,
    /// Bond-orientational order Q⁶ over Delaunay neighbours; mean over the sets.
    BondOrder,
    /// Effective Nyquist frequency over √n/2, from the RDF through the thesis's window.
    NuEff,
    /// Oscillation, from the RDF through the thesis's window.
    Omega,
    /// Effective Nyquist frequency over √n/2, from the periodogram's ring means.
    NuEffDirect,
    /// Oscillation, from the periodogram's ring means.
    OmegaDirect,
    /// Mean power of the modes below a given frequency.
    PowerBelow,
}

impl Statistic {
    /// All statistics, in the order of the output.
    pub const ALL: [Self; 9] = [
        Self::MinDistance,
        Self::MeanDistance,
        Self::CoverageRadius,
        Self::BondOrder,
        Self::NuEff,
        Self::Omega,
        Self::NuEffDirect,
        Self::OmegaDirect,
        Self::PowerBelow,
    ];

    /// The key in JSON and in `--only`.
    pub fn key(self) -> &'static str {
        match self {
            Self::MinDistance => "d_min",
            Self::MeanDistance => "d_avg",
            Self::CoverageRadius => "coverage_radius",
            Self::BondOrder => "q6",
            Self::NuEff => "nu_eff",
            Self::Omega => "omega",
            Self::NuEffDirect => "nu_eff_direct",
            Self::OmegaDirect => "omega_direct",
            Self::PowerBelow => "power_below",
        }
    }

    /// What it is and its unit, in a few words.
    pub fn description(self) -> &'static str {
        match self {
            Self::MinDistance => "smallest nearest-neighbour distance / d_hex",
            Self::MeanDistance => "mean nearest-neighbour distance / d_hex",
            Self::CoverageRadius => "coverage radius / d_hex",
            Self::BondOrder => "bond-orientational order Q6",
            Self::NuEff => "effective Nyquist frequency / (sqrt(n)/2), windowed RDF",
            Self::Omega => "oscillation, windowed RDF",
            Self::NuEffDirect => "effective Nyquist frequency / (sqrt(n)/2), periodogram",
            Self::OmegaDirect => "oscillation, periodogram",
            Self::PowerBelow => "mean power of the modes below the given frequency",
        }
    }

    /// Whether it comes from the exact periodogram's ring means.
    pub fn is_direct(self) -> bool {
        matches!(self, Self::NuEffDirect | Self::OmegaDirect)
    }

    /// Whether it comes from the RDF through the thesis's window.
    pub fn is_windowed(self) -> bool {
        matches!(self, Self::NuEff | Self::Omega)
    }
}

impl fmt::Display for Statistic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.key())
    }
}

impl FromStr for Statistic {
    type Err = Failure;

    fn from_str(text: &str) -> Result<Self, Failure> {
        Self::ALL.into_iter().find(|statistic| statistic.key() == text).ok_or_else(|| {
            let keys = Self::ALL.map(Self::key).join(", ");
            Failure::misuse(format!("no statistic is called `{text}`; there are {keys}"))
        })
    }
}

/// A value and its standard error over the sets (none for one set, or where it is exact).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Standard error of the value, if there are at least two sets.
    pub std_error: Option<f64>,
}

impl Estimate {
    /// Mean of per-set values and its standard error s/√m; none for no value.
    pub fn mean(values: &[f64]) -> Option<Self> {
        let m = values.len() as f64;
        if values.is_empty() {
            return None;
        }
        let mean = values.iter().sum::<f64>() / m;
        let squares: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
        let std_error = (values.len() > 1).then(|| (squares / (m - 1.0) / m).sqrt());
        Some(Self { value: mean, std_error })
    }

    /// A value taken once from all sets together, with the jackknife's standard error from the
    /// same value taken with each set left out (Efron 1982): √((m−1)/m · Σ (v₋ᵢ − mean)²). No error
    /// for one set, or if the value isn't defined with one of the sets left out.
    pub fn jackknife(value: f64, left_out: &[Option<f64>]) -> Self {
        let Some(left_out) = left_out.iter().copied().collect::<Option<Vec<f64>>>() else {
            return Self { value, std_error: None };
        };
        let m = left_out.len() as f64;
        let mean = left_out.iter().sum::<f64>() / m;
        let squares: f64 = left_out.iter().map(|v| (v - mean) * (v - mean)).sum();
        let std_error = (left_out.len() > 1).then(|| ((m - 1.0) / m * squares).sqrt());
        Self { value, std_error }
    }

    /// The estimate of a value known in steps only: its error is not below that of rounding,
    /// step/√12.
    #[must_use]
    pub fn rounded_to(self, step: f64) -> Self {
        let rounding = step / 12_f64.sqrt();
        Self { std_error: self.std_error.map(|error| error.hypot(rounding)), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_bound_the_error_from_below() {
        let exact = Estimate { value: 0.75, std_error: Some(0.0) };
        assert_eq!(exact.rounded_to(0.12).std_error, Some(0.12 / 12_f64.sqrt()));
        let noisy = Estimate { value: 0.75, std_error: Some(3.0) }.rounded_to(4.0 * 12_f64.sqrt());
        assert_eq!(noisy.std_error, Some(5.0));
        assert_eq!(Estimate { value: 0.75, std_error: None }.rounded_to(0.1).std_error, None);
    }

    #[test]
    fn keys_are_read_back() {
        for statistic in Statistic::ALL {
            assert_eq!(statistic.key().parse::<Statistic>().expect("its own key"), statistic);
        }
        let error = "dmin".parse::<Statistic>().expect_err("no such key");
        assert_eq!(error.code(), Failure::USAGE);
        assert!(error.to_string().contains("d_min"));
    }

    #[test]
    fn the_jackknife_of_a_mean_is_its_standard_error() {
        let values = [1.0, 4.0, 2.0, 7.0];
        let mean = Estimate::mean(&values).expect("four values");
        let left_out = values.map(|v| Some((14.0 - v) / 3.0));
        let jackknife = Estimate::jackknife(3.5, &left_out);
        assert_eq!(mean.value, 3.5);
        let (a, b) = (mean.std_error.expect("four sets"), jackknife.std_error.expect("four sets"));
        assert!((a - b).abs() < 1e-15 && a > 1.0, "{a} {b}");
        let undefined = Estimate::jackknife(3.5, &[Some(1.0), None, Some(2.0)]);
        assert_eq!(undefined, Estimate { value: 3.5, std_error: None });
        assert_eq!(Estimate::mean(&[2.0]).expect("one value").std_error, None);
        assert_eq!(Estimate::mean(&[]), None);
    }
}
