//! The statistics that the thesis's tables print.

use std::fmt;

use bn_cli::analysis::Statistic;
use serde::{Deserialize, Serialize};

/// A statistic of the thesis, in its units: distances in `d_hex`, frequencies in √n/2.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Quantity {
    DMin,
    DAvg,
    RC,
    Q6,
    NuEff,
    Omega,
}

impl Quantity {
    pub(crate) const ALL: [Self; 6] =
        [Self::DMin, Self::DAvg, Self::RC, Self::Q6, Self::NuEff, Self::Omega];

    /// The key in the data files.
    pub(crate) fn key(self) -> &'static str {
        match self {
            Self::DMin => "d_min",
            Self::DAvg => "d_avg",
            Self::RC => "r_c",
            Self::Q6 => "q6",
            Self::NuEff => "nu_eff",
            Self::Omega => "omega",
        }
    }

    /// Whether it comes from a spectrum.
    pub(crate) fn is_spectral(self) -> bool {
        matches!(self, Self::NuEff | Self::Omega)
    }

    /// The statistic of the analysis that the thesis's number is compared with: for spectra, the
    /// thesis's own estimator.
    pub(crate) fn statistic(self) -> Statistic {
        match self {
            Self::DMin => Statistic::MinDistance,
            Self::DAvg => Statistic::MeanDistance,
            Self::RC => Statistic::CoverageRadius,
            Self::Q6 => Statistic::BondOrder,
            Self::NuEff => Statistic::NuEff,
            Self::Omega => Statistic::Omega,
        }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.key())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_what_the_data_files_say() {
        for quantity in Quantity::ALL {
            let text = serde_json::to_string(&quantity).expect("serialisable");
            assert_eq!(text, format!("{:?}", quantity.key()));
        }
    }
}
