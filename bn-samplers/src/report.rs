//! What a method says about one run.

use std::fmt;

/// The account of one run: named figures in the order in which they matter, and remarks in words.
///
/// Figures never depend on the clock or on the number of threads.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Report {
    /// Iterations, residuals, radii that were reached, by `snake_case` name.
    pub figures: Vec<Figure>,
    /// Remarks for the user, such as that fewer points were made; each a sentence without a dot.
    pub notes: Vec<String>,
}

/// One figure of a [`Report`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Figure {
    /// What it is, in `snake_case` with the unit where there is one: `"radius_d_hex"`.
    pub name: &'static str,
    /// How much.
    pub value: FigureValue,
}

/// The value of a [`Figure`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(untagged))]
pub enum FigureValue {
    /// A number of things.
    Count(u64),
    /// A measured or chosen real number.
    Real(f64),
    /// Whether something holds.
    Holds(bool),
    /// One of a few words.
    Word(&'static str),
}

impl Report {
    /// A report with nothing in it.
    pub fn new() -> Self {
        Self::default()
    }

    /// The report with one more figure.
    #[must_use]
    pub fn with(mut self, name: &'static str, value: impl Into<FigureValue>) -> Self {
        self.figures.push(Figure { name, value: value.into() });
        self
    }

    /// The report with one more remark.
    #[must_use]
    pub fn with_note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// The figure called `name`.
    pub fn get(&self, name: &str) -> Option<FigureValue> {
        self.figures.iter().find(|figure| figure.name == name).map(|figure| figure.value)
    }
}

impl From<u64> for FigureValue {
    fn from(count: u64) -> Self {
        Self::Count(count)
    }
}

impl From<usize> for FigureValue {
    fn from(count: usize) -> Self {
        Self::Count(count as u64)
    }
}

impl From<f64> for FigureValue {
    fn from(value: f64) -> Self {
        Self::Real(value)
    }
}

impl From<bool> for FigureValue {
    fn from(holds: bool) -> Self {
        Self::Holds(holds)
    }
}

impl From<&'static str> for FigureValue {
    fn from(word: &'static str) -> Self {
        Self::Word(word)
    }
}

impl fmt::Display for FigureValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Count(count) => count.fmt(f),
            Self::Real(value) => value.fmt(f),
            Self::Holds(holds) => f.write_str(if *holds { "yes" } else { "no" }),
            Self::Word(word) => f.write_str(word),
        }
    }
}
