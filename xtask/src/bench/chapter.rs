//! A chapter of the benches' report: a table of figures and diagrams of them.

use std::fmt::Write as _;

use bn_cli::plot::{Axis, Page, Panel, Row, Series, Style, Text};
use serde_json::{Map, Value as Json, json};

use crate::markdown::{Align, Grid};

/// One question answered with figures.
#[derive(Clone, Debug)]
pub(super) struct Chapter {
    /// Its name in file names.
    pub(super) id: &'static str,
    pub(super) title: &'static str,
    /// What is measured, how and against what.
    pub(super) method: String,
    /// What the columns are, with units.
    pub(super) columns: &'static [&'static str],
    /// One value a column.
    pub(super) rows: Vec<Vec<Value>>,
    /// Side by side in one file.
    pub(super) diagrams: Vec<Diagram>,
}

/// A value of a row.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    Text(String),
    Count(usize),
    /// A measured number, shown with three digits.
    Real(f64),
    /// Nothing to tell.
    Absent,
}

/// A diagram over a logarithmic axis; upwards it is linear if all values lie within a decade.
#[derive(Clone, Debug)]
pub(super) struct Diagram {
    /// In the plot's markup, as all labels.
    pub(super) title: String,
    pub(super) x: &'static str,
    pub(super) y: &'static str,
    pub(super) curves: Vec<Curve>,
}

/// A named line of a [`Diagram`].
#[derive(Clone, Debug)]
pub(super) struct Curve {
    pub(super) name: String,
    pub(super) points: Vec<[f64; 2]>,
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<usize> for Value {
    fn from(count: usize) -> Self {
        Self::Count(count)
    }
}

impl From<f64> for Value {
    fn from(real: f64) -> Self {
        Self::Real(real)
    }
}

impl From<Option<f64>> for Value {
    fn from(real: Option<f64>) -> Self {
        real.map_or(Self::Absent, Self::Real)
    }
}

impl Value {
    fn text(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Count(count) => count.to_string(),
            Self::Real(real) => three_digits(*real),
            Self::Absent => "-".to_owned(),
        }
    }

    fn json(&self) -> Json {
        match self {
            Self::Text(text) => json!(text),
            Self::Count(count) => json!(count),
            Self::Real(real) => json!(real),
            Self::Absent => Json::Null,
        }
    }
}

/// The number with three significant digits, in powers of ten where it is very small or large.
fn three_digits(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    match size {
        1e-3..1e5 => {
            let decimals = (2 - size.log10().floor() as i32).max(0) as usize;
            format!("{x:.decimals$}")
        }
        _ => format!("{x:.2e}"),
    }
}

impl Chapter {
    /// The chapter in Markdown, without its diagrams.
    pub(super) fn to_markdown(&self) -> String {
        let number = |i: usize| !self.rows.iter().any(|row| matches!(row[i], Value::Text(_)));
        let columns: Vec<_> = self
            .columns
            .iter()
            .enumerate()
            .map(|(i, &name)| (name, if number(i) { Align::Right } else { Align::Left }))
            .collect();
        let mut grid = Grid::new(&columns);
        for row in &self.rows {
            grid.row(row.iter().map(Value::text).collect());
        }
        let mut text = format!("## {}\n\n{}\n\n{grid}", self.title, self.method);
        if !self.diagrams.is_empty() {
            let _ = write!(text, "\n![{}]({})\n", self.title, self.file_name());
        }
        text
    }

    /// The chapter as a JSON object whose rows are objects.
    pub(super) fn to_json(&self) -> Json {
        let row = |row: &Vec<Value>| -> Map<String, Json> {
            let pairs = self.columns.iter().zip(row);
            pairs.map(|(name, value)| ((*name).to_owned(), value.json())).collect()
        };
        json!({
            "id": self.id,
            "title": self.title,
            "method": self.method,
            "rows": self.rows.iter().map(row).collect::<Vec<_>>(),
        })
    }

    /// The name of the file with the diagrams.
    pub(super) fn file_name(&self) -> String {
        format!("{}.svg", self.id)
    }

    /// The diagrams side by side; `made_on` is kept in the file.
    pub(super) fn to_svg(&self, made_on: &str) -> String {
        let panels = self.diagrams.iter().map(Diagram::panel).collect();
        Page::new()
            .titled(Text::math(self.title))
            .made_by(made_on)
            .row(Row::new(170.0, panels))
            .to_svg()
    }
}

impl Diagram {
    fn is_flat(&self) -> bool {
        let values = || self.curves.iter().flat_map(|curve| &curve.points).map(|point| point[1]);
        let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max));
        high < 10.0 * low
    }

    fn panel(&self) -> Panel {
        let label = Text::math(self.y);
        let y = if self.is_flat() { Axis::linear(label) } else { Axis::log(label) };
        let panel = Panel::new(Axis::log(Text::math(self.x)), y).titled(Text::math(&self.title));
        self.curves.iter().enumerate().fold(panel, |panel, (i, curve)| {
            let series = Series::new(curve.points.iter().copied());
            let style = Style::Cycle(i);
            panel.line(series.named(Text::math(&curve.name)).styled(style).with_markers())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        let text = [0.0, 0.001_234_5, 1.0, 12.345, 99_999.0, 123_456.0, -4.5e-9].map(three_digits);
        assert_eq!(text, ["0", "0.00123", "1.00", "12.3", "99999", "1.23e5", "-4.50e-9"]);
    }

    fn chapter() -> Chapter {
        Chapter {
            id: "test",
            title: "A test",
            method: "Nothing is measured.".to_owned(),
            columns: &["what", "n", "time / s"],
            rows: vec![
                vec!["a".into(), 10_usize.into(), 0.5.into()],
                vec!["b".into(), 20_usize.into(), None.into()],
            ],
            diagrams: vec![Diagram {
                title: "time".to_owned(),
                x: "*n*",
                y: "time / s",
                curves: vec![Curve { name: "a".to_owned(), points: vec![[1.0, 2.0], [2.0, 3.0]] }],
            }],
        }
    }

    #[test]
    fn a_chapter_is_told_three_ways() {
        let chapter = chapter();
        let text = chapter.to_markdown();
        assert!(text.contains("| a    |  10 |    0.500 |\n| b    |  20 |        - |\n"), "{text}");
        assert!(text.contains("![A test](test.svg)"), "{text}");
        let json = chapter.to_json();
        assert_eq!(json["rows"][0]["time / s"], 0.5);
        assert!(json["rows"][1]["time / s"].is_null());
        let svg = chapter.to_svg("a machine");
        assert!(svg.starts_with("<svg") && svg.contains("a machine"));
    }
}
