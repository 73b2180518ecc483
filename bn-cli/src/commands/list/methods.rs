//! The methods that make patterns.

use std::io::{Result, Write};

use bn_samplers::{METHODS, Method, OptionSpec};
use serde::Serialize;

use super::write_names;

pub(super) fn entries() -> Vec<Entry> {
    METHODS.iter().map(|method| Entry::of(method)).collect()
}

pub(super) fn write(w: &mut dyn Write, methods: &[Entry]) -> Result<()> {
    write_names(w, methods.iter().map(|method| (method.name, method.summary)))
}

/// A method as `bn list --json` shows it.
#[derive(Serialize)]
pub(super) struct Entry {
    name: &'static str,
    aliases: &'static [&'static str],
    summary: &'static str,
    page: Option<u32>,
    citation: &'static str,
    complexity: &'static str,
    order: String,
    counts: String,
    version: u32,
    options: Vec<OptionEntry>,
}

#[derive(Serialize)]
struct OptionEntry {
    name: &'static str,
    help: &'static str,
    values: String,
    unit: &'static str,
    default: String,
}

impl Entry {
    fn of(method: &Method) -> Self {
        Self {
            name: method.name,
            aliases: method.aliases,
            summary: method.summary,
            page: method.page,
            citation: method.citation,
            complexity: method.complexity,
            order: method.order.to_string(),
            counts: method.counts.to_string(),
            version: method.version,
            options: method.options.iter().map(OptionEntry::of).collect(),
        }
    }
}

impl OptionEntry {
    fn of(spec: &OptionSpec) -> Self {
        Self {
            name: spec.name,
            help: spec.help,
            values: spec.kind.to_string(),
            unit: spec.unit,
            default: spec.default.to_string(),
        }
    }
}
