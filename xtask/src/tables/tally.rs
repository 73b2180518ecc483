//! How many values fared how.

use std::collections::BTreeMap;

use bn_cli::{Failure, Outcome};
use serde::{Deserialize, Serialize};

use super::Cell;
use crate::thesis::Verdict;

/// How many values got each verdict.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Tally(BTreeMap<Verdict, usize>);

impl Tally {
    pub(super) fn of<'a>(cells: impl Iterator<Item = &'a Cell>) -> Self {
        let mut counts = BTreeMap::new();
        cells.for_each(|cell| *counts.entry(cell.verdict()).or_default() += 1);
        Self(counts)
    }

    /// That of several tables together.
    pub(crate) fn sum<'a>(tallies: impl Iterator<Item = &'a Self>) -> Self {
        let mut counts = BTreeMap::new();
        for (&verdict, count) in tallies.flat_map(|tally| &tally.0) {
            *counts.entry(verdict).or_default() += count;
        }
        Self(counts)
    }

    pub(crate) fn count(&self, verdict: Verdict) -> usize {
        self.0.get(&verdict).copied().unwrap_or(0)
    }

    /// Says how many values fared how; an error if any is outside its tolerance.
    pub(crate) fn outcome(&self) -> Outcome {
        let shown = [Verdict::Agrees, Verdict::Explained, Verdict::NotJudged, Verdict::NotYet];
        let counts = shown.map(|v| format!("{} {}", self.count(v), v.word())).join(", ");
        match self.count(Verdict::Outside) {
            0 => {
                eprintln!("values: {counts}");
                Ok(())
            }
            outside => Err(Failure::failed(anyhow::anyhow!(
                "{outside} values are outside their tolerance ({counts})"
            ))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_value_outside_fails_all() {
        let good = Tally([(Verdict::Agrees, 5), (Verdict::NotJudged, 2)].into());
        let bad = Tally([(Verdict::Agrees, 1), (Verdict::Outside, 1)].into());
        assert!(good.outcome().is_ok() && Tally::default().outcome().is_ok());
        let sum = Tally::sum([&good, &bad].into_iter());
        assert_eq!([Verdict::Agrees, Verdict::Explained].map(|v| sum.count(v)), [6, 0]);
        let error = sum.outcome().expect_err("one is outside");
        assert_eq!(error.code(), Failure::FAILED);
        assert!(error.to_string().contains("1 values are outside their tolerance (6 ok, 0 ex"));
    }
}
