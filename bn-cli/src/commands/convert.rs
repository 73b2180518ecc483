//! `bn convert`: from one point format to another.

use std::path::PathBuf;

use bn_core::io::Format;
use clap::{Args, Command};

use crate::input;
use crate::{Outcome, output_points};

#[derive(Debug, Args)]
pub(super) struct Convert {
    /// File to read; `-` is standard input, its format told by its contents (but .rps: `--from rps`)
    input: PathBuf,
    /// File to write; `-` is standard output
    output: PathBuf,
    /// Format of the input (default: by the file's extension)
    #[arg(long, value_name = "FORMAT")]
    from: Option<Format>,
    /// Format of the output (default: by the file's extension)
    #[arg(long, visible_alias = "format", value_name = "FORMAT")]
    to: Option<Format>,
    /// Wrap coordinates outside [0, 1) instead of refusing them
    #[arg(long)]
    wrap: bool,
}

pub(super) fn command() -> Command {
    Convert::augment_args(
        Command::new("convert")
            .about("Convert between point formats")
            .long_about(
                "Convert between point formats: .txt .rps .dat .csv .npy .json .eps. Formats of \
                 64-bit numbers and text keep every bit; .rps holds 32-bit numbers. Several sets go \
                 into one .dat, .npy or .json, else into name_0.ext, name_1.ext, ...; {i} in the \
                 name asks for one file a set and says where the index goes.",
            )
            .after_help("Example: bn convert points.rps points.npy"),
    )
}

pub(super) fn run(args: &Convert) -> Outcome {
    let ensemble = input::read(&args.input, args.from, args.wrap)?;
    output_points::write(&args.output, args.to, ensemble.sets())
}
