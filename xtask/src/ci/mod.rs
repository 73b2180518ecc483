//! `cargo xtask ci`: everything that must hold before a change lands.

mod examples;
mod process;
mod readme;

use std::time::Instant;

use bn_cli::{Failure, Outcome};
use clap::Args;

use crate::{bench, figures, report, tables, workspace};
use process::cargo;

/// Format, lints, documentation, quick tables, benches, figures and report, examples, the commands in the
/// documentation, and the tests; stops at the first that fails
#[derive(Debug, Args)]
pub(crate) struct CiArgs {
    /// Leave out the tests
    #[arg(long)]
    no_tests: bool,
}

/// A step: what it is called and what it does.
type Step = (&'static str, fn() -> Outcome);

const STEPS: [Step; 10] = [
    ("format", || cargo(&["fmt", "--all", "--check"], &[])),
    ("clippy", || {
        let what = ["clippy", "--workspace", "--all-targets", "--all-features"];
        cargo(&[&what[..], &["--", "-D", "warnings"]].concat(), &[])
    }),
    // Without bn-cli's drawing: what `cargo xtask tables` compiles.
    ("clippy of the tables alone", || {
        cargo(&["clippy", "--package", "xtask", "--", "-D", "warnings"], &[])
    }),
    ("documentation", || {
        cargo(
            &["doc", "--workspace", "--all-features", "--no-deps"],
            &[("RUSTDOCFLAGS", "-D warnings")],
        )
    }),
    ("quick tables", || tables::run(&tables::TablesArgs::for_ci())),
    ("quick benches", || bench::run(&bench::BenchArgs::for_ci())),
    ("quick figures", || figures::run(&figures::FiguresArgs::for_ci())),
    ("quick report", || report::run(&report::ReportArgs::for_ci())),
    ("examples", examples::run),
    ("commands in the documentation", readme::run),
];

const TESTS: Step = ("tests", || cargo(&["test", "--workspace", "--all-features"], &[]));

pub(crate) fn run(args: &CiArgs) -> Outcome {
    let steps: Vec<Step> = STEPS.into_iter().chain((!args.no_tests).then_some(TESTS)).collect();
    std::env::set_current_dir(workspace::root()?)?;
    for (i, (name, step)) in steps.iter().enumerate() {
        eprintln!("ci {}/{}: {name}", i + 1, steps.len());
        let start = Instant::now();
        step().map_err(|failure| Failure::failed(anyhow::anyhow!("{name} failed: {failure}")))?;
        eprintln!(
            "ci {}/{}: {name} good, {:.0} s",
            i + 1,
            steps.len(),
            start.elapsed().as_secs_f64()
        );
    }
    eprintln!("ci: all {} steps good", steps.len());
    Ok(())
}
