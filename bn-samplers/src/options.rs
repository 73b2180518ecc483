//! The options of methods as text: what a command line or a file says, checked and typed.

use std::fmt;
use std::sync::Arc;

use bn_core::{DensityFunction, PointSet};
use thiserror::Error;

use crate::names::nearest_name;

/// One option of a method.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct OptionSpec {
    /// Its name in kebab-case, without leading dashes.
    pub name: &'static str,
    /// What values it takes.
    pub kind: OptionKind,
    /// What holds if it isn't given.
    pub default: DefaultValue,
    /// One line on what it does, without the default, the range and the unit.
    pub help: &'static str,
    /// The unit of the value, empty for pure numbers and words.
    pub unit: &'static str,
}

/// What values an option takes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "snake_case"))]
pub enum OptionKind {
    /// On if present; as text `true` or `false`.
    Flag,
    /// A whole number from `min` to `max`, both possible.
    Integer {
        /// The least value.
        min: u64,
        /// The greatest value.
        max: u64,
    },
    /// A finite real number from `min` to `max`, both possible.
    Real {
        /// The least value.
        min: f64,
        /// The greatest value.
        max: f64,
    },
    /// One of these words.
    Choice(&'static [&'static str]),
    /// Any text.
    Text,
    /// A point set, which the caller has read: [`Given::Points`].
    Points,
    /// A density function, which the caller has read: [`Given::Density`].
    Density,
}

/// The value of an option as it is given.
#[derive(Clone, Debug)]
pub enum Given<'a> {
    /// As text, for all kinds but the following.
    Text(&'a str),
    /// For [`OptionKind::Points`].
    Points(Arc<PointSet>),
    /// For [`OptionKind::Density`].
    Density(Arc<DensityFunction>),
}

/// What holds if an option isn't given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "snake_case"))]
pub enum DefaultValue {
    /// This value, as text: giving it explicitly changes nothing.
    Value(&'static str),
    /// No value; the words say what the method does then.
    Absent(&'static str),
}

impl fmt::Display for DefaultValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Value(text) | Self::Absent(text) => f.write_str(text),
        }
    }
}

impl fmt::Display for OptionKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flag => f.write_str("true or false"),
            Self::Integer { min, max } if *max == u64::MAX => {
                write!(f, "a whole number of at least {min}")
            }
            Self::Integer { min, max } => write!(f, "a whole number from {min} to {max}"),
            Self::Real { min, max } if *max == f64::MAX => write!(f, "a number of at least {min}"),
            Self::Real { min, max } => write!(f, "a number from {min} to {max}"),
            Self::Choice(words) => write!(f, "one of {}", words.join(", ")),
            Self::Text => f.write_str("text"),
            Self::Points => f.write_str("a file of points"),
            Self::Density => {
                f.write_str("a grey image, dark where points are dense, or a formula of x and y")
            }
        }
    }
}

/// Why texts don't make [`OptionValues`].
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum OptionError {
    /// The method has no such option.
    #[error("{method} has no option --{option}{}", suggestion(.nearest.as_deref(), .known))]
    Unknown {
        /// The method's name.
        method: &'static str,
        /// The name that was given.
        option: String,
        /// The option that was probably meant.
        nearest: Option<&'static str>,
        /// The names of all options of the method.
        known: Vec<&'static str>,
    },
    /// The value is not of the option's kind or out of its range.
    #[error("--{option} is {text:?}, but must be {kind}{}", meant(*.nearest))]
    Invalid {
        /// The option's name.
        option: &'static str,
        /// The value that was given.
        text: String,
        /// What would be possible.
        kind: OptionKind,
        /// The word that was probably meant, for choices.
        nearest: Option<&'static str>,
    },
    /// The option was given more than once.
    #[error("--{option} is given more than once")]
    Repeated {
        /// The option's name.
        option: &'static str,
    },
    /// Options that contradict each other.
    #[error("--{option}: {reason}")]
    Conflict {
        /// The option's name.
        option: &'static str,
        /// What it contradicts, and the way out.
        reason: String,
    },
}

fn suggestion(nearest: Option<&str>, known: &[&str]) -> String {
    match nearest {
        Some(name) => format!("; did you mean --{name}?"),
        None if known.is_empty() => "; it has no options".to_owned(),
        None => format!("; it has --{}", known.join(", --")),
    }
}

fn meant(nearest: Option<&str>) -> String {
    nearest.map(|word| format!("; did you mean {word}?")).unwrap_or_default()
}

/// A checked value.
#[derive(Clone, Debug, PartialEq)]
enum Value {
    Flag(bool),
    Integer(u64),
    Real(f64),
    Choice(&'static str),
    Text(String),
    Points(Arc<PointSet>),
    Density(Arc<DensityFunction>),
}

/// The options given for one method: checked against its [`OptionSpec`]s, defaults filled in.
#[derive(Clone, Debug, PartialEq)]
pub struct OptionValues {
    values: Vec<(&'static OptionSpec, Option<Value>)>,
    given: Vec<&'static str>,
}

impl OptionValues {
    /// Checks (name, value) pairs against what `method` takes.
    ///
    /// # Errors
    /// [`OptionError`] for a name that the method doesn't know, a name given twice, or a value that
    /// is not of the option's kind.
    pub fn parse<'a>(
        method: &'static str,
        specs: &'static [OptionSpec],
        given: impl IntoIterator<Item = (&'a str, Given<'a>)>,
    ) -> Result<Self, OptionError> {
        let mut values: Vec<_> = specs.iter().map(|spec| (spec, None)).collect();
        let mut all_given = Vec::new();
        for (name, value) in given {
            let Some((spec, slot)) = values.iter_mut().find(|(spec, _)| spec.name == name) else {
                return Err(unknown(method, specs, name));
            };
            if slot.is_some() {
                return Err(OptionError::Repeated { option: spec.name });
            }
            all_given.push(spec.name);
            *slot = Some(match value {
                Given::Text(text) => parse_value(spec, text)?,
                Given::Points(points) if spec.kind == OptionKind::Points => Value::Points(points),
                Given::Density(density) if spec.kind == OptionKind::Density => {
                    Value::Density(density)
                }
                Given::Points(_) => return Err(invalid(spec, "a point set")),
                Given::Density(_) => return Err(invalid(spec, "a density function")),
            });
        }
        for (spec, slot) in &mut values {
            if let (None, DefaultValue::Value(text)) = (&slot, spec.default) {
                *slot = Some(parse_value(spec, text)?);
            }
        }
        Ok(Self { values, given: all_given })
    }

    /// Whether the option `name` was given, be it with its default value.
    pub fn is_given(&self, name: &str) -> bool {
        self.given.contains(&name)
    }

    /// Whether the flag `name` is set.
    ///
    /// # Panics
    /// Like all getters, if the method has no option of this name and kind: a slip in its `build`.
    pub fn flag(&self, name: &str) -> bool {
        match self.get(name) {
            None => false,
            Some(Value::Flag(on)) => *on,
            other => wrong_kind(name, other),
        }
    }

    /// The whole number `name`; `None` if not given and without default.
    ///
    /// # Panics
    /// As [`OptionValues::flag`].
    pub fn integer(&self, name: &str) -> Option<u64> {
        match self.get(name) {
            None => None,
            Some(Value::Integer(value)) => Some(*value),
            other => wrong_kind(name, other),
        }
    }

    /// The real number `name`; `None` if not given and without default.
    ///
    /// # Panics
    /// As [`OptionValues::flag`].
    pub fn real(&self, name: &str) -> Option<f64> {
        match self.get(name) {
            None => None,
            Some(Value::Real(value)) => Some(*value),
            other => wrong_kind(name, other),
        }
    }

    /// The word chosen for `name`; `None` if not given and without default.
    ///
    /// # Panics
    /// As [`OptionValues::flag`].
    pub fn choice(&self, name: &str) -> Option<&'static str> {
        match self.get(name) {
            None => None,
            Some(Value::Choice(word)) => Some(word),
            other => wrong_kind(name, other),
        }
    }

    /// The text `name`; `None` if not given and without default.
    ///
    /// # Panics
    /// As [`OptionValues::flag`].
    pub fn text(&self, name: &str) -> Option<&str> {
        match self.get(name) {
            None => None,
            Some(Value::Text(text)) => Some(text),
            other => wrong_kind(name, other),
        }
    }

    /// The point set `name`; `None` if not given.
    ///
    /// # Panics
    /// As [`OptionValues::flag`].
    pub fn points(&self, name: &str) -> Option<Arc<PointSet>> {
        match self.get(name) {
            None => None,
            Some(Value::Points(points)) => Some(Arc::clone(points)),
            other => wrong_kind(name, other),
        }
    }

    /// The density function `name`; `None` if not given.
    ///
    /// # Panics
    /// As [`OptionValues::flag`].
    pub fn density(&self, name: &str) -> Option<Arc<DensityFunction>> {
        match self.get(name) {
            None => None,
            Some(Value::Density(density)) => Some(Arc::clone(density)),
            other => wrong_kind(name, other),
        }
    }

    fn get(&self, name: &str) -> Option<&Value> {
        match self.values.iter().find(|(spec, _)| spec.name == name) {
            Some((_, value)) => value.as_ref(),
            None => panic!("the method states no option --{name}"),
        }
    }
}

#[cold]
fn wrong_kind(name: &str, value: Option<&Value>) -> ! {
    panic!("option --{name} is not of the kind asked for: {value:?}")
}

fn unknown(method: &'static str, specs: &'static [OptionSpec], name: &str) -> OptionError {
    let known: Vec<_> = specs.iter().map(|spec| spec.name).collect();
    let nearest = nearest_name(name, known.iter().copied());
    OptionError::Unknown { method, option: name.to_owned(), nearest, known }
}

fn parse_value(spec: &'static OptionSpec, text: &str) -> Result<Value, OptionError> {
    let trimmed = text.trim();
    let value = match spec.kind {
        OptionKind::Flag => trimmed.parse().ok().map(Value::Flag),
        OptionKind::Integer { min, max } => {
            trimmed.parse().ok().filter(|value| (min..=max).contains(value)).map(Value::Integer)
        }
        OptionKind::Real { min, max } => {
            trimmed.parse().ok().filter(|value| (min..=max).contains(value)).map(Value::Real)
        }
        OptionKind::Choice(words) => {
            words.iter().find(|word| **word == trimmed).map(|word| Value::Choice(word))
        }
        OptionKind::Text => Some(Value::Text(text.to_owned())),
        OptionKind::Points | OptionKind::Density => None,
    };
    value.ok_or_else(|| invalid(spec, text))
}

fn invalid(spec: &OptionSpec, text: &str) -> OptionError {
    OptionError::Invalid {
        option: spec.name,
        text: text.to_owned(),
        kind: spec.kind,
        nearest: match spec.kind {
            OptionKind::Choice(words) => nearest_name(text.trim(), words.iter().copied()),
            _ => None,
        },
    }
}
