//! When a value of ours agrees with the thesis.

use std::collections::BTreeMap;

use bn_cli::{Failure, Outcome};
use serde::{Deserialize, Serialize};

use super::{Expected, Quantity, QuickExpected, RowSpec, ThesisValues};

/// Judges values against the thesis, or against our own expected values.
#[derive(Debug)]
pub(crate) struct Judge {
    thesis: ThesisValues,
    tolerances: Tolerances,
    differences: Vec<KnownDifference>,
    places: Vec<KnownPlace>,
    basis: Basis,
}

/// What values are held against.
#[derive(Debug)]
pub(crate) enum Basis {
    /// The thesis's values, for the number of points and sets that it used.
    Thesis,
    /// Our own expected values for few points.
    Quick(QuickExpected),
    /// Nothing: the thesis says nothing about this number of points or sets.
    Nothing,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Tolerances {
    quantity: BTreeMap<Quantity, Tolerance>,
    #[serde(rename = "exception", default)]
    exceptions: Vec<Exception>,
    quick: QuickTolerance,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Tolerance {
    absolute: f64,
    #[serde(default)]
    relative: f64,
}

/// A number of the thesis that deserves another tolerance.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Exception {
    thesis: String,
    quantity: Quantity,
    absolute: f64,
    reason: String,
}

#[derive(Debug, Deserialize)]
struct QuickTolerance {
    deviations: f64,
    #[serde(flatten)]
    floor: BTreeMap<Quantity, f64>,
}

/// A value of the thesis that can't be reproduced, and why.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct KnownDifference {
    method: String,
    quantity: Quantity,
    value: f64,
    tolerance: Option<f64>,
    reason: String,
}

/// A method whose place in the ranking of table 5.3 is not the thesis's, and why.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct KnownPlace {
    /// The thesis's key of the row.
    pub(super) thesis: String,
    /// By how many dB at most it is on the wrong side of another method.
    pub(super) value: f64,
    pub(super) reason: String,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct KnownDifferences {
    #[serde(rename = "difference", default)]
    differences: Vec<KnownDifference>,
    #[serde(rename = "place", default)]
    places: Vec<KnownPlace>,
}

/// What a value is held against and how it fares.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Judgement {
    /// The value that the thesis prints in this table.
    pub(crate) thesis: Option<f64>,
    /// Least and greatest value that count as agreement before the tolerance is added.
    pub(crate) expected: Option<(f64, f64)>,
    /// How far outside `expected` a value may be.
    pub(crate) tolerance: Option<f64>,
    /// Why the value is not simply held against the thesis's, with the usual tolerance.
    pub(crate) reason: Option<String>,
    pub(crate) verdict: Verdict,
}

/// How a value fares.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Verdict {
    /// Within the tolerance of the thesis's value, or of the quick tables' expected one.
    Agrees,
    /// Not the thesis's value, but the one that we expect, with the reason.
    Explained,
    /// Outside the tolerance, or missing.
    Outside,
    /// There is nothing to hold it against.
    NotJudged,
    /// The method doesn't exist yet.
    NotYet,
}

impl Verdict {
    /// The word in the tables.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Agrees => "ok",
            Self::Explained => "explained",
            Self::Outside => "OUTSIDE",
            Self::NotJudged => "not judged",
            Self::NotYet => "not yet",
        }
    }
}

impl Judge {
    /// The judge with all that this program knows.
    pub(crate) fn new(basis: Basis) -> Outcome<Self> {
        let known: KnownDifferences =
            toml::from_str(include_str!("../../data/known_differences.toml"))
                .map_err(Failure::failed)?;
        Ok(Self {
            thesis: ThesisValues::load()?,
            tolerances: toml::from_str(include_str!("../../data/tolerances.toml"))
                .map_err(Failure::failed)?,
            differences: known.differences,
            places: known.places,
            basis,
        })
    }

    /// The judge for `sets` sets of `n` points.
    pub(crate) fn for_thesis(n: usize, sets: u32) -> Outcome<Self> {
        Self::new(if (n, sets) == (4096, 10) { Basis::Thesis } else { Basis::Nothing })
    }

    /// The judge for the quick tables.
    pub(crate) fn for_quick() -> Outcome<Self> {
        Self::new(Basis::Quick(QuickExpected::load()?))
    }

    pub(crate) fn thesis(&self) -> &ThesisValues {
        &self.thesis
    }

    pub(super) fn places(&self) -> &[KnownPlace] {
        &self.places
    }

    pub(super) fn basis(&self) -> &Basis {
        &self.basis
    }

    /// Judges `ours` (none: not measurable) for `row` of `table`.
    pub(crate) fn judge(
        &self,
        table: &str,
        row: &RowSpec,
        quantity: Quantity,
        ours: Option<f64>,
    ) -> Judgement {
        let thesis = self.thesis.value(table, &row.thesis, quantity.key());
        let judgement = match &self.basis {
            Basis::Thesis => self.by_thesis(row, quantity, ours),
            Basis::Quick(expected) => {
                self.by_quick(expected.get(&row.method, quantity), quantity, ours)
            }
            Basis::Nothing => Judgement::not_judged(None, Verdict::NotJudged),
        };
        Judgement { thesis, ..judgement }
    }

    /// The judgement on a row whose method doesn't exist yet.
    pub(crate) fn not_yet(&self, table: &str, row: &RowSpec, quantity: Quantity) -> Judgement {
        let thesis = self.thesis.value(table, &row.thesis, quantity.key());
        Judgement { thesis, ..Judgement::not_judged(None, Verdict::NotYet) }
    }

    fn by_thesis(&self, row: &RowSpec, quantity: Quantity, ours: Option<f64>) -> Judgement {
        let known =
            self.differences.iter().find(|d| d.method == row.method && d.quantity == quantity);
        if let Some(known) = known {
            let usual = self.tolerance(&row.thesis, quantity, known.value).0;
            return Judgement::held_against(
                ours,
                (known.value, known.value),
                known.tolerance.unwrap_or(usual),
                Some(known.reason.clone()),
                Verdict::Explained,
            );
        }
        let Some(range) = self.thesis.range(&row.thesis, quantity.key()) else {
            return Judgement::not_judged(None, Verdict::NotJudged);
        };
        let (tolerance, reason) = self.tolerance(&row.thesis, quantity, range.1);
        Judgement::held_against(ours, range, tolerance, reason, Verdict::Agrees)
    }

    /// The tolerance for a value of about `value`, and the reason if it is an exception.
    fn tolerance(&self, thesis: &str, quantity: Quantity, value: f64) -> (f64, Option<String>) {
        let exception = self
            .tolerances
            .exceptions
            .iter()
            .find(|e| e.thesis == thesis && e.quantity == quantity);
        if let Some(exception) = exception {
            return (exception.absolute, Some(exception.reason.clone()));
        }
        let usual = self.tolerances.quantity.get(&quantity);
        (usual.map_or(0.0, |t| t.absolute.max(t.relative * value.abs())), None)
    }

    fn by_quick(
        &self,
        expected: Option<Expected>,
        quantity: Quantity,
        ours: Option<f64>,
    ) -> Judgement {
        let Some(Expected { mean, deviation }) = expected else {
            let how = "no expected value is stored: cargo xtask tables --record-quick";
            return Judgement::not_judged(Some(how.to_owned()), Verdict::NotJudged);
        };
        let quick = &self.tolerances.quick;
        let floor = quick.floor.get(&quantity).copied().unwrap_or(0.0);
        let tolerance = floor.max(quick.deviations * deviation);
        Judgement::held_against(ours, (mean, mean), tolerance, None, Verdict::Agrees)
    }
}

impl Judgement {
    /// The judgement on what is not held against anything: not judged, or not yet there.
    pub(super) fn not_judged(reason: Option<String>, verdict: Verdict) -> Self {
        Self { thesis: None, expected: None, tolerance: None, reason, verdict }
    }

    /// The judgement on what is shown only, with a word on it.
    pub(crate) fn shown(what: &str) -> Self {
        Self::not_judged(Some(what.to_owned()), Verdict::NotJudged)
    }

    /// `good` if `ours` lies at most `tolerance` outside `expected`.
    pub(super) fn held_against(
        ours: Option<f64>,
        expected: (f64, f64),
        tolerance: f64,
        reason: Option<String>,
        good: Verdict,
    ) -> Self {
        // Decimals such as 0.76 − 0.74 = 0.02 shall not fail by their rounding.
        let slack = tolerance + 1e-9;
        let within =
            ours.is_some_and(|ours| expected.0 - slack <= ours && ours <= expected.1 + slack);
        let verdict = if within { good } else { Verdict::Outside };
        let (expected, tolerance) = (Some(expected), Some(tolerance));
        Self { thesis: None, expected, tolerance, reason, verdict }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::thesis::Rows;

    fn row(method: &str) -> RowSpec {
        let rows = Rows::load().expect("parses");
        rows.iter().find(|row| row.method == method).expect("a row").clone()
    }

    fn verdict(method: &str, quantity: Quantity, ours: f64) -> Verdict {
        let judge = Judge::for_thesis(4096, 10).expect("the embedded files parse");
        judge.judge("B", &row(method), quantity, Some(ours)).verdict
    }

    #[test]
    fn values_agree_up_to_the_tolerance() {
        // B.9: d_avg 0.94, tolerance 0.02.
        for (ours, want) in
            [(0.92, Verdict::Agrees), (0.9599, Verdict::Agrees), (0.9197, Verdict::Outside)]
        {
            assert_eq!(verdict("lloyd", Quantity::DAvg, ours), want, "{ours}");
        }
        // B.11: Omega 14.77, tolerance 10 %; B.2: 0.05, tolerance 0.03.
        assert_eq!(verdict("regular", Quantity::Omega, 16.2), Verdict::Agrees);
        assert_eq!(verdict("regular", Quantity::Omega, 16.3), Verdict::Outside);
        assert_eq!(verdict("stochastic", Quantity::Omega, 0.08), Verdict::Agrees);
        assert_eq!(verdict("stochastic", Quantity::Omega, 0.081), Verdict::Outside);
        assert_eq!(verdict("stochastic", Quantity::Omega, f64::NAN), Verdict::Outside);
    }

    #[test]
    fn disagreeing_tables_widen_the_target() {
        // CCCVT's d_avg: 0.88 in three tables, 0.90 in one.
        assert_eq!(verdict("cccvt", Quantity::DAvg, 0.86), Verdict::Agrees);
        assert_eq!(verdict("cccvt", Quantity::DAvg, 0.92), Verdict::Agrees);
        assert_eq!(verdict("cccvt", Quantity::DAvg, 0.925), Verdict::Outside);
    }

    #[test]
    fn exceptions_carry_their_reason() {
        let judge = Judge::for_thesis(4096, 10).expect("the embedded files parse");
        let wide = judge.judge("4.2", &row("stochastic"), Quantity::RC, Some(1.84));
        assert_eq!((wide.verdict, wide.tolerance), (Verdict::Agrees, Some(0.12)));
        assert!(wide.reason.is_some());
    }

    #[test]
    fn known_differences_are_held_against_our_own_value() {
        let judge = Judge::for_thesis(4096, 10).expect("the embedded files parse");
        let dart = row("dart-throwing");
        let ours = judge.judge("4.2", &dart, Quantity::RC, Some(0.81));
        assert_eq!((ours.verdict, ours.thesis), (Verdict::Explained, Some(1.07)));
        assert!(ours.reason.is_some());
        // What the thesis prints would be wrong here.
        let theirs = judge.judge("4.2", &dart, Quantity::RC, Some(1.07));
        assert_eq!(theirs.verdict, Verdict::Outside);
    }

    #[test]
    fn what_is_missing_is_outside_and_other_counts_are_not_judged() {
        let judge = Judge::for_thesis(4096, 10).expect("the embedded files parse");
        let regular = row("regular");
        assert_eq!(judge.judge("B", &regular, Quantity::Q6, None).verdict, Verdict::Outside);
        let other = Judge::for_thesis(1024, 10).expect("the embedded files parse");
        let free = other.judge("B", &regular, Quantity::Q6, Some(7.0));
        assert_eq!((free.verdict, free.thesis), (Verdict::NotJudged, Some(0.33)));
    }

    #[test]
    fn quick_values_may_deviate_statistically() {
        let judge = Judge::for_quick().expect("the embedded files parse");
        let by = |expected, ours| judge.by_quick(expected, Quantity::DAvg, Some(ours)).verdict;
        let expected = Some(Expected { mean: 0.5, deviation: 0.004 });
        assert_eq!(by(expected, 0.519), Verdict::Agrees);
        assert_eq!(by(expected, 0.521), Verdict::Outside);
        let exact = Some(Expected { mean: 0.5, deviation: 0.0 });
        assert_eq!(by(exact, 0.5019), Verdict::Agrees);
        assert_eq!(by(exact, 0.5021), Verdict::Outside);
        assert_eq!(by(None, 0.5), Verdict::NotJudged);
    }

    #[test]
    fn every_quantity_has_a_tolerance_and_every_record_a_row() {
        let judge = Judge::for_thesis(4096, 10).expect("the embedded files parse");
        for quantity in Quantity::ALL {
            assert!(judge.tolerance("lloyd", quantity, 0.0).0 > 0.0, "{quantity}");
            assert!(judge.tolerances.quick.floor.contains_key(&quantity), "{quantity}");
        }
        let rows = Rows::load().expect("parses");
        for known in &judge.differences {
            assert!(rows.iter().any(|row| row.method == known.method), "{known:?}");
            assert!(known.value.is_finite() && !known.reason.is_empty(), "{known:?}");
        }
        for place in &judge.places {
            assert!(
                rows.of(&place.thesis).next().is_some() && !place.reason.is_empty(),
                "{place:?}"
            );
        }
        for exception in &judge.tolerances.exceptions {
            assert!(rows.iter().any(|row| row.thesis == exception.thesis), "{exception:?}");
        }
    }
}
