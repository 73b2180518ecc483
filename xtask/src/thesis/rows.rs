//! Which method with which options stands for which row of the thesis.

use std::collections::BTreeMap;

use bn_cli::{Failure, Outcome};
use bn_samplers::Method;
use serde::Deserialize;

/// The rows that we measure, in the order of the file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Rows {
    #[serde(rename = "row")]
    rows: Vec<RowSpec>,
}

/// A row that we measure.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RowSpec {
    /// The thesis's key of the row.
    pub(crate) thesis: String,
    /// The method's name in the registry; no two rows share one.
    pub(crate) method: String,
    /// Options that are not the method's defaults, as text.
    #[serde(default)]
    pub(crate) options: BTreeMap<String, String>,
    /// Why this method with these options.
    #[serde(default)]
    pub(crate) why: String,
}

impl Rows {
    /// The rows that this program carries.
    pub(crate) fn load() -> Outcome<Self> {
        toml::from_str(include_str!("../../data/rows.toml")).map_err(Failure::failed)
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &RowSpec> {
        self.rows.iter()
    }

    /// The rows that stand for the thesis's row `thesis`: one, or several methods that share it.
    pub(crate) fn of<'a>(&'a self, thesis: &'a str) -> impl Iterator<Item = &'a RowSpec> {
        self.rows.iter().filter(move |row| row.thesis == thesis)
    }
}

impl RowSpec {
    /// The method, if the registry has it.
    pub(crate) fn method(&self) -> Option<&'static Method> {
        bn_samplers::METHODS.iter().find(|method| method.name == self.method).copied()
    }

    /// The options as one would type them, empty for the defaults.
    pub(crate) fn options_text(&self) -> String {
        let typed: Vec<_> =
            self.options.iter().map(|(name, value)| format!("--{name} {value}")).collect();
        typed.join(" ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::thesis::ThesisValues;

    #[test]
    fn rows_and_thesis_know_each_other() {
        let rows = Rows::load().expect("the embedded file parses");
        let thesis = ThesisValues::load().expect("the embedded file parses");
        for table in ["3.1", "4.2", "5.2", "B"] {
            for key in thesis.methods_of(table) {
                assert!(rows.of(key).next().is_some(), "no row for {key} of table {table}");
            }
        }
        for (i, row) in rows.iter().enumerate() {
            assert!(thesis.range(&row.thesis, "d_avg").is_some(), "{row:?}");
            assert!(rows.iter().skip(i + 1).all(|other| other.method != row.method), "{row:?}");
        }
    }

    #[test]
    fn options_are_ones_that_the_methods_take() {
        for row in Rows::load().expect("the embedded file parses").iter() {
            let Some(method) = row.method() else { continue };
            let options = row.options.iter().map(|(name, value)| (&**name, &**value));
            method.with_options(options).unwrap_or_else(|error| panic!("{}: {error}", row.method));
        }
    }

    #[test]
    fn options_are_shown_as_typed() {
        let mut row = Rows::load().expect("parses").iter().next().expect("a row").clone();
        assert_eq!(row.options_text(), "");
        row.options = [("width", "1.5"), ("distribution", "gaussian")]
            .map(|(name, value)| (name.to_owned(), value.to_owned()))
            .into();
        assert_eq!(row.options_text(), "--distribution gaussian --width 1.5");
    }
}
