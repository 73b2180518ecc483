//! Options of methods as they are typed, and what they stand for.

use std::path::Path;
use std::sync::Arc;

use bn_core::PointSet;
use bn_samplers::{DefaultValue, Given, Method, OptionKind, OptionSpec};
use clap::builder::ValueRange;
use clap::{Arg, ArgAction, ArgMatches};
use serde_json::{Value, json};

use crate::{Failure, Outcome, density, input};

/// The argument of the command line for an option.
pub(super) fn option_argument(spec: &'static OptionSpec) -> Arg {
    let unit = if spec.unit.is_empty() { String::new() } else { format!(" [{}]", spec.unit) };
    let default = format!("default: {}", spec.default);
    let argument = Arg::new(spec.name).long(spec.name).help_heading("Options of the method");
    match spec.kind {
        // `--flag` alone is true; `--flag=false` is possible too.
        OptionKind::Flag => argument
            .num_args(ValueRange::from(0..=1))
            .require_equals(true)
            .default_missing_value("true")
            .value_name("true|false")
            .help(format!("{}{unit}", spec.help)),
        _ => argument
            .num_args(1)
            .allow_negative_numbers(true)
            .value_name(value_name(spec.kind))
            .help(format!("{}{unit}: {} ({default})", spec.help, spec.kind)),
    }
    .action(ArgAction::Set)
}

fn value_name(kind: OptionKind) -> &'static str {
    match kind {
        OptionKind::Integer { .. } => "N",
        OptionKind::Real { .. } => "X",
        OptionKind::Choice(_) => "WORD",
        OptionKind::Flag | OptionKind::Text => "TEXT",
        OptionKind::Points => "FILE",
        OptionKind::Density => "IMAGE|FORMULA",
    }
}

/// The options that were typed, as text.
pub(super) fn given_options<'a>(
    specs: &'static [OptionSpec],
    matches: &'a ArgMatches,
) -> Vec<(&'static str, &'a str)> {
    let typed = |spec: &OptionSpec| matches.get_one::<String>(spec.name).map(String::as_str);
    specs.iter().filter_map(|spec| Some((spec.name, typed(spec)?))).collect()
}

/// The options as the method takes them: files of points and densities are read here.
pub(super) fn given_values<'a>(
    method: &Method,
    options: &[(&'a str, &'a str)],
) -> Outcome<Vec<(&'a str, Given<'a>)>> {
    let kind = |name| method.options.iter().find(|spec| spec.name == name).map(|spec| spec.kind);
    let value = |name, text| -> Outcome<Given<'a>> {
        Ok(match kind(name) {
            Some(OptionKind::Points) => Given::Points(Arc::new(only_set(Path::new(text))?)),
            Some(OptionKind::Density) => Given::Density(Arc::new(density::density(text)?)),
            _ => Given::Text(text),
        })
    };
    options.iter().map(|&(name, text)| Ok((name, value(name, text)?))).collect()
}

/// The one set of a file.
pub(super) fn only_set(file: &Path) -> Outcome<PointSet> {
    let mut sets = input::read(file, None, false)?.into_sets();
    match (sets.pop(), sets.len()) {
        (Some(set), 0) => Ok(set),
        (_, others) => Err(Failure::misuse(format!(
            "{} holds {} sets where one is wanted; `bn convert` it to one file a set",
            file.display(),
            others + 1
        ))),
    }
}

/// The option as given or its default; null where the method chooses by itself.
pub(super) fn option_value(spec: &OptionSpec, given: &[(&str, &str)]) -> Value {
    let text = given.iter().find(|(name, _)| *name == spec.name).map(|(_, text)| text.trim());
    let text = match (text, spec.default) {
        (Some(text), _) | (None, DefaultValue::Value(text)) => text,
        (None, DefaultValue::Absent(_)) => return Value::Null,
    };
    match spec.kind {
        // The sampler has been built from this text, so it parses.
        OptionKind::Flag | OptionKind::Integer { .. } | OptionKind::Real { .. } => {
            text.parse().unwrap_or_else(|_| json!(text.parse::<f64>().ok()))
        }
        _ => json!(text),
    }
}
