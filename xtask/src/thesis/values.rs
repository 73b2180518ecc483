//! The numbers printed in the thesis.

use std::collections::BTreeMap;

use bn_cli::{Failure, Outcome};
use serde::Deserialize;

/// Every number printed in the thesis's tables.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ThesisValues {
    /// The thesis's methods by key.
    methods: BTreeMap<String, String>,
    #[serde(rename = "entry")]
    entries: Vec<Entry>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    table: String,
    method: String,
    quantity: String,
    value: f64,
    /// Not every run of the thesis got there.
    #[serde(default)]
    partly: bool,
    #[serde(default)]
    #[expect(dead_code, reason = "notes are for the reader of the file")]
    note: String,
}

/// What the thesis prints of the iterations that its runs took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum PrintedCount {
    /// The mean over its runs, all of which got there.
    EveryRun(f64),
    /// The same of those runs that got there.
    SomeRuns(f64),
    /// No run got there.
    Never,
}

impl PrintedCount {
    /// The number that stands in the table.
    pub(crate) fn mean(self) -> Option<f64> {
        match self {
            Self::EveryRun(count) | Self::SomeRuns(count) => Some(count),
            Self::Never => None,
        }
    }
}

impl Entry {
    /// Whether the entry belongs to `table`; `B` is all of appendix B.
    fn is_of(&self, table: &str) -> bool {
        self.table == table || (table == "B" && self.table.starts_with("B."))
    }

    /// Whether it was printed in a table, not in the text or beside a figure.
    fn is_tabulated(&self) -> bool {
        self.table.starts_with("B.") || self.table.starts_with(|c: char| c.is_ascii_digit())
    }
}

impl ThesisValues {
    /// The values that this program carries.
    pub(crate) fn load() -> Outcome<Self> {
        Self::parse(include_str!("../../data/thesis_tables.toml"))
    }

    fn parse(text: &str) -> Outcome<Self> {
        let values: Self = toml::from_str(text).map_err(Failure::failed)?;
        Ok(values)
    }

    /// The value in `table` (`"3.1"`, …, `"B"`) for the thesis's `method`, by quantity key.
    pub(crate) fn value(&self, table: &str, method: &str, quantity: &str) -> Option<f64> {
        self.entry(table, method, quantity).map(|e| e.value)
    }

    /// A number of iterations, likewise.
    pub(crate) fn count(&self, table: &str, method: &str, quantity: &str) -> Option<PrintedCount> {
        self.entry(table, method, quantity).map(|e| match (e.value, e.partly) {
            (count, _) if count < 0.0 => PrintedCount::Never,
            (count, true) => PrintedCount::SomeRuns(count),
            (count, false) => PrintedCount::EveryRun(count),
        })
    }

    fn entry(&self, table: &str, method: &str, quantity: &str) -> Option<&Entry> {
        let is_it = |e: &&Entry| e.is_of(table) && e.method == method && e.quantity == quantity;
        self.entries.iter().find(is_it)
    }

    /// The least and the greatest value that the thesis's tables print for the same number: they
    /// disagree about some.
    pub(crate) fn range(&self, method: &str, quantity: &str) -> Option<(f64, f64)> {
        self.entries
            .iter()
            .filter(|e| e.is_tabulated() && e.method == method && e.quantity == quantity)
            .map(|e| (e.value, e.value))
            .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    }

    /// The methods that `table` has rows for, each once, in the order of the rows.
    pub(crate) fn methods_of(&self, table: &str) -> Vec<&str> {
        let mut methods = Vec::new();
        for entry in self.entries.iter().filter(|e| e.is_of(table)) {
            if !methods.contains(&&*entry.method) {
                methods.push(&*entry.method);
            }
        }
        methods
    }

    /// The thesis's name of a method.
    pub(crate) fn method_name<'a>(&'a self, key: &'a str) -> &'a str {
        self.methods.get(key).map_or(key, |name| name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn thesis() -> ThesisValues {
        ThesisValues::load().expect("the embedded file parses")
    }

    #[test]
    fn every_entry_of_a_statistics_table_has_a_known_method_and_quantity() {
        let thesis = thesis();
        assert!(thesis.entries.len() > 250, "{} entries", thesis.entries.len());
        for entry in &thesis.entries {
            assert!(entry.value.is_finite(), "{entry:?}");
            if ["3.1", "4.2", "5.2", "B"].iter().any(|table| entry.is_of(table)) {
                assert!(thesis.methods.contains_key(&entry.method), "{entry:?}");
                let known = crate::thesis::Quantity::ALL.map(crate::thesis::Quantity::key);
                assert!(known.contains(&&*entry.quantity), "{entry:?}");
            }
        }
    }

    #[test]
    fn values_are_found_by_table() {
        let thesis = thesis();
        assert_eq!(thesis.value("3.1", "regular", "omega"), Some(14.77));
        assert_eq!(thesis.value("B", "hex", "nu_eff"), Some(1.02));
        assert_eq!(thesis.value("3.1", "regular", "d_min"), None);
        assert_eq!(thesis.method_name("fpo"), "Farthest-point optimisation");
        assert_eq!(thesis.methods_of("3.1").len(), 9);
        assert_eq!(thesis.methods_of("4.2").len(), 12);
        assert_eq!(thesis.methods_of("B").len(), 14);
    }

    #[test]
    fn counts_say_how_many_runs_got_there() {
        let thesis = thesis();
        let count = |key: &str| thesis.count("4.1", "lloyd", &format!("iterations_to_{key}"));
        assert_eq!(count("d_avg_0.925"), Some(PrintedCount::EveryRun(122.0)));
        assert_eq!(count("d_min_0.8"), Some(PrintedCount::SomeRuns(425.0)));
        assert_eq!(count("d_min_0.9"), Some(PrintedCount::Never));
        assert_eq!(count("d_min_0.1"), None);
    }

    #[test]
    fn disagreeing_tables_give_a_range() {
        let thesis = thesis();
        assert_eq!(thesis.range("cccvt", "d_avg"), Some((0.88, 0.90)));
        assert_eq!(thesis.range("dart", "nu_eff"), Some((0.58, 0.59)));
        assert_eq!(thesis.range("peak", "d_min"), Some((0.51, 0.55)));
        assert_eq!(thesis.range("random", "q6"), Some((0.36, 0.36)));
        assert_eq!(thesis.range("fpo_plugged", "r_c"), None, "printed in the text only");
    }

    #[test]
    fn slips_in_the_file_are_errors() {
        let slip = "[methods]\n[[entry]]\ntable='1'\nmethod='a'\nquantity='b'\nvalue=1\nnoet=''\n";
        let error = ThesisValues::parse(slip).expect_err("an unknown field");
        assert!(error.to_string().contains("noet"), "{error}");
    }
}
