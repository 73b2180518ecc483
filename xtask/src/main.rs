//! The project's own tasks: `cargo xtask tables`, `figures`, `report`, `bench` and `ci`.

mod bench;
mod ci;
mod figures;
mod markdown;
mod measure;
mod report;
mod tables;
mod thesis;
mod workspace;

use std::ffi::OsString;
use std::process::ExitCode;

use bn_cli::output::remark;
use bn_cli::{Failure, Outcome};
use clap::{Parser, Subcommand};

/// The thesis's tables, the benchmarks' reports and the steps of CI
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", version)]
struct Cli {
    #[arg(long, global = true, value_name = "N",
          help = "Number of threads (default: RAYON_NUM_THREADS, or all cores)",
          value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    #[command(subcommand)]
    task: Task,
}

#[derive(Debug, Subcommand)]
enum Task {
    Tables(tables::TablesArgs),
    Figures(figures::FiguresArgs),
    Report(report::ReportArgs),
    Bench(bench::BenchArgs),
    Ci(ci::CiArgs),
    /// The program `bn`, for benches of whole processes
    #[command(hide = true, disable_help_flag = true)]
    Bn {
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<OsString>,
    },
}

fn main() -> ExitCode {
    let interrupted = ctrlc::set_handler(|| {
        bn_cli::output::discard_unfinished();
        // 128 + SIGINT, as shells report it.
        std::process::exit(130);
    });
    if let Err(error) = interrupted {
        remark(format!("xtask: interrupts will leave temporary files behind: {error}"));
    }
    match run(&Cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) if failure.is_broken_pipe() => ExitCode::SUCCESS,
        Err(failure) => {
            remark(format!("xtask: {failure}"));
            ExitCode::from(failure.code())
        }
    }
}

fn run(cli: &Cli) -> Outcome {
    if let Some(threads) = cli.threads {
        rayon::ThreadPoolBuilder::new()
            .num_threads(usize::from(threads))
            .build_global()
            .map_err(Failure::failed)?;
    }
    match &cli.task {
        Task::Tables(args) => tables::run(args),
        Task::Figures(args) => figures::run(args),
        Task::Report(args) => report::run(args),
        Task::Bench(args) => bench::run(args),
        Task::Ci(args) => ci::run(args),
        Task::Bn { arguments } => {
            bn_cli::commands::run(std::iter::once("bn".into()).chain(arguments.iter().cloned()))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_sound() {
        Cli::command().debug_assert();
        let tables = Cli::try_parse_from(["xtask", "tables", "--quick", "--threads", "2"]);
        assert_eq!(tables.expect("valid").threads, Some(2));
        assert!(Cli::try_parse_from(["xtask", "tables", "--quick", "--sets", "3"]).is_err());
    }
}
