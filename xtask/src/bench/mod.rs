//! `cargo xtask bench`: run time against error, stage by stage.

mod bessel;
mod bessel_sums;
mod chapter;
mod estimators;
mod hankel;
mod imitations;
mod machine;
mod matching;
mod nufft;
mod optimizers;
mod programs;
mod rendering;
mod samplers;
mod skipping;
mod timing;

use std::fs;
use std::path::Path;
use std::time::Instant;

use anyhow::Context as _;
use bn_cli::{Failure, Outcome, output};
use clap::Args;
use serde_json::json;

use crate::workspace;
use chapter::Chapter;
use machine::Machine;
use timing::Budget;

/// Run time against error of every stage: JSON, Markdown and diagrams under target/bench/
#[derive(Debug, Args)]
pub(crate) struct BenchArgs {
    /// Fewer sizes, fewer repetitions: whether it works, not how fast it is
    #[arg(long)]
    quick: bool,
    /// Only this chapter: bessel, hankel, bessel-sums, nufft, estimators, samplers, optimizers,
    /// matching, imitations, rendering, skipping or programs
    #[arg(long, value_name = "CHAPTER")]
    only: Option<String>,
}

impl BenchArgs {
    /// What CI runs.
    pub(crate) fn for_ci() -> Self {
        Self { quick: true, only: None }
    }
}

/// How thoroughly to measure.
#[derive(Clone, Copy, Debug)]
struct Effort {
    quick: bool,
    budget: Budget,
}

/// Seed of all random input.
const SEED: u64 = 1;

type Measure = fn(Effort) -> Outcome<Chapter>;

/// The chapters, in the order in which data flow.
const CHAPTERS: [(&str, Measure); 12] = [
    ("bessel", bessel::measure),
    ("hankel", hankel::measure),
    ("bessel-sums", bessel_sums::measure),
    ("nufft", nufft::measure),
    ("estimators", estimators::measure),
    ("samplers", samplers::measure),
    ("optimizers", optimizers::measure),
    ("matching", matching::measure),
    ("imitations", imitations::measure),
    ("rendering", rendering::measure),
    ("skipping", skipping::measure),
    ("programs", programs::measure),
];

pub(crate) fn run(args: &BenchArgs) -> Outcome {
    let effort = Effort { quick: args.quick, budget: Budget::new(args.quick) };
    let chapters = select(args.only.as_deref())?;
    let mut folder = workspace::root()?.join("target/bench");
    if args.quick {
        folder.push("quick");
    }
    fs::create_dir_all(&folder)
        .with_context(|| format!("cannot make {}", folder.display()))
        .map_err(Failure::failed)?;
    let machine = Machine::this();
    let mut text = format!("# Run time against error\n\nSeed {SEED}. {}\n", machine.line());
    let mut made = Vec::new();
    for (name, measure) in chapters {
        let start = Instant::now();
        let chapter = measure(effort)?;
        eprintln!("{name}: {:.1} s", start.elapsed().as_secs_f64());
        if !chapter.diagrams.is_empty() {
            let svg = chapter.to_svg(&machine.line());
            write(&folder.join(chapter.file_name()), &svg)?;
        }
        let markdown = chapter.to_markdown();
        output::write_stdout(|w| Ok(writeln!(w, "{markdown}")?))?;
        text.push('\n');
        text.push_str(&markdown);
        made.push(chapter.to_json());
    }
    let document = json!({
        "schema": "bn-bench",
        "version": 1,
        "seed": SEED,
        "quick": args.quick,
        "machine": machine,
        "chapters": made,
    });
    write(&folder.join("bench.json"), &format!("{document:#}\n"))?;
    write(&folder.join("bench.md"), &text)
}

fn select(only: Option<&str>) -> Outcome<Vec<(&'static str, Measure)>> {
    let Some(only) = only else { return Ok(CHAPTERS.into()) };
    let chosen: Vec<_> = CHAPTERS.into_iter().filter(|(name, _)| *name == only).collect();
    if chosen.is_empty() {
        let known = CHAPTERS.map(|(name, _)| name).join(", ");
        return Err(Failure::misuse(format!("no chapter {only}; there are {known}")));
    }
    Ok(chosen)
}

fn write(path: &Path, text: &str) -> Outcome {
    output::write_file(path, |w| Ok(w.write_all(text.as_bytes())?))
}
