//! `bn list`: the methods that there are.

use bn_samplers::{METHODS, Method, OptionSpec};
use clap::{Args, Command};
use serde::Serialize;

use crate::{Failure, Outcome, output};

#[derive(Debug, Args)]
pub(super) struct List {
    /// A JSON array of {name, summary, page, options} on standard output
    #[arg(long)]
    json: bool,
}

pub(super) fn command() -> Command {
    List::augment_args(
        Command::new("list")
            .about("List the methods that make patterns")
            .after_help("`bn generate METHOD --help` tells the options of a method."),
    )
}

pub(super) fn run(args: &List) -> Outcome {
    if args.json {
        return output::write_stdout(|w| {
            let entries: Vec<Entry> = METHODS.iter().map(|method| Entry::of(method)).collect();
            serde_json::to_writer_pretty(&mut *w, &entries).map_err(Failure::failed)?;
            Ok(writeln!(w)?)
        });
    }
    let width = METHODS.iter().map(|method| method.name.len()).max().unwrap_or(0);
    output::write_stdout(|w| {
        for method in METHODS {
            writeln!(w, "{:width$}  {}", method.name, method.summary)?;
        }
        Ok(())
    })
}

/// A method as `bn list --json` shows it.
#[derive(Serialize)]
struct Entry {
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
