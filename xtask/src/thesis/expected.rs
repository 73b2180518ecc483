//! What the quick tables must give.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use bn_cli::{Failure, Outcome};
use serde::Deserialize;

use super::Quantity;

/// Mean and standard deviation, over many seeds, of what one run of the quick tables gives.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct QuickExpected {
    /// By method and quantity.
    #[serde(default)]
    method: BTreeMap<String, BTreeMap<Quantity, Expected>>,
}

/// One expected value.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Expected {
    /// Mean over the seeds.
    pub(crate) mean: f64,
    /// Standard deviation of one run; 0 where the seed makes no difference.
    pub(crate) deviation: f64,
}

impl QuickExpected {
    /// The values that this program carries.
    pub(crate) fn load() -> Outcome<Self> {
        toml::from_str(include_str!("../../data/quick_expected.toml")).map_err(Failure::failed)
    }

    pub(crate) fn get(&self, method: &str, quantity: Quantity) -> Option<Expected> {
        self.method.get(method)?.get(&quantity).copied()
    }

    /// Adds what runs with different seeds gave.
    ///
    /// The deviation is that of one run from the mean of the recorded ones: the sample's standard
    /// deviation times √(1 + 1/runs).
    pub(crate) fn record(&mut self, method: &str, quantity: Quantity, runs: &[f64]) {
        let m = runs.len() as f64;
        let mean = runs.iter().sum::<f64>() / m;
        let squares: f64 = runs.iter().map(|v| (v - mean) * (v - mean)).sum();
        let variance = if runs.len() > 1 { squares / (m - 1.0) } else { 0.0 };
        let deviation = (variance * (1.0 + 1.0 / m)).sqrt();
        let of_method = self.method.entry(method.to_owned()).or_default();
        of_method.insert(quantity, Expected { mean, deviation });
    }

    /// The file's text; `head` says how it was made.
    pub(crate) fn to_toml(&self, head: &str) -> String {
        let mut text = String::new();
        for line in head.lines() {
            text.push_str(format!("# {line}").trim_end());
            text.push('\n');
        }
        for (method, values) in &self.method {
            let _ = writeln!(text, "\n[method.{method}]");
            for (quantity, Expected { mean, deviation }) in values {
                let _ = writeln!(
                    text,
                    "{quantity:<6} = {{ mean = {mean:.5}, deviation = {deviation:.5} }}"
                );
            }
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A method that is new enters CI judged, not merely run.
    #[test]
    fn every_row_that_can_be_made_is_recorded() {
        let expected = QuickExpected::load().expect("parses");
        for row in crate::thesis::Rows::load().expect("parses").iter() {
            // Ω is not defined for all, so the last of what always is stands for the rest.
            let recorded = expected.get(&row.method, Quantity::Q6).is_some();
            assert_eq!(recorded, row.method().is_some(), "{}", row.method);
        }
    }

    #[test]
    fn what_is_recorded_is_read_back() {
        let mut expected = QuickExpected::default();
        expected.record("dart-throwing", Quantity::RC, &[1.0, 2.0, 3.0]);
        expected.record("regular", Quantity::Q6, &[0.25]);
        let text = expected.to_toml("Made by a test\n\nin two runs");
        assert!(text.starts_with("# Made by a test\n#\n# in two runs\n"), "{text}");
        let back: QuickExpected = toml::from_str(&text).expect("its own text");
        let dart = back.get("dart-throwing", Quantity::RC).expect("recorded");
        assert_eq!(dart.mean, 2.0);
        // s = 1, and the mean of three adds a third of the variance.
        assert!((dart.deviation - (4.0_f64 / 3.0).sqrt()).abs() < 1e-5);
        assert_eq!(
            back.get("regular", Quantity::Q6),
            Some(Expected { mean: 0.25, deviation: 0.0 })
        );
        assert_eq!(back.get("regular", Quantity::RC), None);
    }
}
