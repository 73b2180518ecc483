//! The subcommands of `bn`, one file each: arguments, then what they mean, then the work.

mod analyze;
mod completions;
mod convert;
mod generate;
mod list;
mod match_;
mod method_values;
mod realize;
mod render;
#[cfg(feature = "report")]
mod report;
mod target;

use std::ffi::OsString;

use clap::{ArgMatches, Args, Command, FromArgMatches};

use crate::{Failure, Outcome};

/// Options that every subcommand takes.
#[derive(Clone, Debug, Args)]
pub(crate) struct Global {
    /// Number of threads (default: `RAYON_NUM_THREADS`, else one a core); never changes a result
    #[arg(long, short = 'j', global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// No progress and no remarks on standard error
    #[arg(long, short, global = true)]
    quiet: bool,
}

impl Global {
    /// A remark for the person at the terminal.
    fn remark(&self, message: impl std::fmt::Display) {
        if !self.quiet {
            crate::output::remark(format_args!("bn: {message}"));
        }
    }
}

/// The whole command line, from which parser, help and completions come.
pub fn command() -> Command {
    let command = Global::augment_args(Command::new("bn"))
        .version(env!("CARGO_PKG_VERSION"))
        .about("The workbench for irregular sampling: make, measure and draw sampling patterns")
        .long_about(
            "The workbench for irregular sampling: make, measure and draw sampling patterns.\n\n\
             The domain is the unit torus: [0,1) x [0,1) with opposite sides joined. Distances are \
             reported in units of the hexagonal lattice's spacing, frequencies in units of \
             sqrt(n)/2. Results go to standard output, remarks to standard error. Exit codes: 0 \
             done, 1 the run failed, 2 bad use or bad input, 130 interrupted.",
        )
        .after_help(
            "Examples:\n  bn list\n  bn generate dart-throwing -n 4096 --seed 1 -o points.txt\n  \
             bn analyze points.txt\n  bn generate lloyd -n 1024 | bn analyze - --json",
        )
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommands([
            list::command(),
            generate::command(),
            analyze::command(),
            match_::command(),
            realize::command(),
            render::command(),
            convert::command(),
            completions::command(),
        ]);
    #[cfg(feature = "report")]
    let command = command.subcommand(report::command());
    command
}

/// Runs `bn` with these arguments, the program's name first.
///
/// Requests for help and mistakes in the arguments end the process as clap does: 0 and 2.
///
/// # Errors
/// What the command ended with when it did not end well.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> Outcome {
    let matches = command().try_get_matches_from(arguments).unwrap_or_else(|error| error.exit());
    let global = parsed::<Global>(&matches)?;
    if let Some(threads) = global.threads {
        rayon::ThreadPoolBuilder::new()
            .num_threads(usize::from(threads))
            .build_global()
            .map_err(Failure::failed)?;
    }
    match matches.subcommand() {
        Some(("list", matches)) => list::run(&parsed(matches)?),
        Some(("generate", matches)) => generate::run(matches, &global),
        Some(("analyze", matches)) => analyze::run(&parsed(matches)?, &global),
        Some(("match", matches)) => match_::run(matches, &global),
        Some(("realize", matches)) => realize::run(&parsed(matches)?),
        Some(("render", matches)) => render::run(&parsed(matches)?, &global),
        Some(("convert", matches)) => convert::run(&parsed(matches)?),
        Some(("completions", matches)) => completions::run(&parsed(matches)?),
        #[cfg(feature = "report")]
        Some(("report", matches)) => report::run(&parsed(matches)?, &global),
        _ => unreachable!("clap requires one of the subcommands above"),
    }
}

/// The typed form of what clap has already checked.
fn parsed<A: FromArgMatches>(matches: &ArgMatches) -> Outcome<A> {
    A::from_arg_matches(matches).map_err(Failure::usage)
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_command_line_is_consistent() {
        super::command().debug_assert();
    }
}
