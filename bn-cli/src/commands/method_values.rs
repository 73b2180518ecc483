//! Options of methods as they are typed, and what they stand for.

use std::path::Path;
use std::sync::Arc;

use bn_core::PointSet;
use bn_samplers::{Given, Method, OptionKind};

use crate::{Failure, Outcome, density, input};

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
