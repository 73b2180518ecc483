//! `bn list`: what can be asked for by name.

mod methods;
mod render;

use std::io::Write;

use clap::{Args, Command, ValueEnum};
use serde::Serialize;

use crate::{Failure, Outcome, output};

#[derive(Debug, Args)]
pub(super) struct List {
    /// What to list
    #[arg(value_enum, default_value = "methods")]
    what: What,
    /// A JSON array on standard output: of methods {name, summary, page, options, …}; of kernels {name,
    /// radius, integral, errors}; of scenes {name, summary, options}; of supersampling sets {name,
    /// `samples_per_pixel`, `weights_per_pixel`}
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum What {
    /// The methods that make patterns (`bn generate`)
    Methods,
    /// Reconstruction kernels (`bn render --kernel`): radius in pixels, integral, stated errors
    Kernels,
    /// Scenes (`bn render SCENE`)
    Scenes,
    /// The sets of `bn render --supersampling`: n samples a pixel, m weights
    Supersampling,
}

pub(super) fn command() -> Command {
    List::augment_args(
        Command::new("list")
            .about("List the methods that make patterns, or kernels, scenes and supersampling sets")
            .after_help("`bn generate METHOD --help` tells the options of a method."),
    )
}

pub(super) fn run(args: &List) -> Outcome {
    match args.what {
        What::Methods => listed(args.json, &methods::entries(), methods::write),
        What::Kernels => listed(args.json, &render::kernels(), render::write_kernels),
        What::Scenes => listed(args.json, &render::scenes(), render::write_scenes),
        What::Supersampling => {
            listed(args.json, &render::supersampling(), render::write_supersampling)
        }
    }
}

/// The entries on standard output, as JSON or as lines to read.
fn listed<T: Serialize>(
    json: bool,
    entries: &[T],
    write: fn(&mut dyn Write, &[T]) -> std::io::Result<()>,
) -> Outcome {
    output::write_stdout(|w| {
        if json {
            serde_json::to_writer_pretty(&mut *w, entries).map_err(Failure::failed)?;
            return Ok(writeln!(w)?);
        }
        Ok(write(w, entries)?)
    })
}

/// Lines of names and what is said of them.
fn write_names<'a>(
    w: &mut dyn Write,
    names: impl Iterator<Item = (&'a str, &'a str)> + Clone,
) -> std::io::Result<()> {
    let width = names.clone().map(|(name, _)| name.len()).max().unwrap_or(0);
    for (name, summary) in names {
        writeln!(w, "{name:width$}  {summary}")?;
    }
    Ok(())
}
