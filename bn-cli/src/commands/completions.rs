//! `bn completions`: what a shell needs to complete the command line.

use clap::{Args, Command};
use clap_complete::Shell;

use crate::{Outcome, output};

#[derive(Debug, Args)]
pub(super) struct Completions {
    /// The shell
    shell: Shell,
}

pub(super) fn command() -> Command {
    Completions::augment_args(
        Command::new("completions").about("Print a completion script for a shell").after_help(
            "Example: bn completions bash > ~/.local/share/bash-completion/completions/bn",
        ),
    )
}

pub(super) fn run(args: &Completions) -> Outcome {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut super::command(), "bn", &mut script);
    output::write_stdout(|w| Ok(w.write_all(&script)?))
}
