//! The statistics that were asked for, as text and as JSON.

use std::io::Write;

use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

use super::{Analysis, Estimate, Statistic};
use crate::Outcome;

/// The values that an analysis was asked for, with what they belong to.
#[derive(Clone, Debug)]
pub struct Summary {
    /// The files that the sets came from.
    pub files: Vec<String>,
    /// Number of sets.
    pub sets: usize,
    /// Number of points in each set.
    pub points: usize,
    /// The statistics asked for; none where a statistic is not defined.
    pub values: Vec<(Statistic, Option<Estimate>)>,
}

impl Summary {
    /// Computes the `wanted` statistics and nothing else.
    pub fn of(analysis: &Analysis<'_>, wanted: &[Statistic], files: Vec<String>) -> Self {
        let values = wanted.iter().map(|&statistic| (statistic, analysis.estimate(statistic)));
        Self {
            files,
            sets: analysis.sets().len(),
            points: analysis.sets()[0].len(),
            values: values.collect(),
        }
    }

    /// The value of a statistic, if it was asked for and is defined.
    pub fn get(&self, statistic: Statistic) -> Option<Estimate> {
        self.values.iter().find(|(asked, _)| *asked == statistic).and_then(|(_, value)| *value)
    }

    /// The summary as a block of lines: key, value ± standard error, meaning.
    ///
    /// # Errors
    /// If `w` fails.
    pub fn write_text(&self, w: &mut dyn Write) -> Outcome {
        writeln!(w, "{}", self.files.join(" "))?;
        let sets = if self.sets == 1 { "set" } else { "sets" };
        writeln!(w, "  {} {sets} of {} points", self.sets, self.points)?;
        for (statistic, estimate) in &self.values {
            let value = match estimate {
                None => "not defined".to_owned(),
                Some(Estimate { value, std_error: None }) => shown(*value),
                Some(Estimate { value, std_error: Some(error) }) => {
                    format!("{} ± {}", shown(*value), shown(*error))
                }
            };
            writeln!(w, "  {:16} {value:<20} {}", statistic.key(), statistic.description())?;
        }
        Ok(())
    }
}

/// Four decimals; three significant digits where those would show nothing.
fn shown(value: f64) -> String {
    if value != 0.0 && value.abs() < 1e-3 { format!("{value:.2e}") } else { format!("{value:.4}") }
}

/// One object with every key, null where a statistic was not computed or is not defined.
impl Serialize for Summary {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("files", &self.files)?;
        map.serialize_entry("sets", &self.sets)?;
        map.serialize_entry("points", &self.points)?;
        for statistic in Statistic::ALL {
            map.serialize_entry(statistic.key(), &self.get(statistic).map(|e| e.value))?;
        }
        map.serialize_entry("std_error", &Errors(self))?;
        map.end()
    }
}

struct Errors<'a>(&'a Summary);

impl Serialize for Errors<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer
            .collect_map(Statistic::ALL.map(|s| (s.key(), self.0.get(s).and_then(|e| e.std_error))))
    }
}
