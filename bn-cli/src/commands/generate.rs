//! `bn generate`: patterns from the registry of methods.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::anyhow;
use bn_core::io::Format;
use bn_core::{Observer, PointSet, Seed, Unobserved};
use bn_samplers::{CountRule, METHODS, Method, Report, Sample, Sampler};
use clap::{ArgMatches, Args, Command};
use rayon::prelude::*;
use serde_json::{Map, Value, json};

use super::Global;
use super::method_values::{given_options, given_values, option_argument, option_value};
use crate::progress_bar::Bar;
use crate::{Failure, Outcome, output, output_points};

/// What every method takes.
#[derive(Debug, Args)]
struct Generate {
    /// Number of points
    #[arg(short, value_name = "N", allow_negative_numbers = true, default_value = "4096",
          value_parser = clap::value_parser!(u32).range(1..=100_000_000))]
    n: u32,
    /// Seed of the random numbers; the same seed gives the same bytes
    #[arg(short, long, value_name = "SEED", allow_negative_numbers = true, default_value = "1")]
    seed: u64,
    /// Number of sets, each from its own random numbers; set 0 is what a single set would be
    #[arg(short = 'm', long, value_name = "K", allow_negative_numbers = true, default_value = "1",
          value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    sets: u32,
    /// File to write, `-` for standard output. Several sets go into one .dat, .npy or .json, or into
    /// `name_0.ext`, `name_1.ext`, ... ; {i} in the name says where the index goes
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
    /// Format of the output (default: by the file's extension; txt or dat on standard output)
    #[arg(long, value_name = "FORMAT")]
    format: Option<Format>,
    /// A JSON account of the run on standard output: seed, options, iterations, residual, seconds
    #[arg(long)]
    json: bool,
}

pub(super) fn command() -> Command {
    Command::new("generate")
        .about("Make patterns: `bn generate METHOD`")
        .long_about(
            "Make patterns: `bn generate METHOD`. `bn generate METHOD --help` tells the method's \
             options and sources.",
        )
        .after_help("Example: bn generate jittered -n 1024 --sets 10 -o jittered.npy")
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommand_value_name("METHOD")
        .subcommand_help_heading("Methods")
        .disable_help_subcommand(true)
        .subcommands(METHODS.iter().map(|method| method_command(method)))
}

fn method_command(method: &'static Method) -> Command {
    let page = method.page.map(|page| format!("Heck 2013, page {page}. ")).unwrap_or_default();
    Generate::augment_args(Command::new(method.name))
        .about(method.summary)
        .long_about(format!(
            "{}\n\nSource: {page}{}\nCost: {}\nOrder: {}\nCounts: {}",
            method.summary, method.citation, method.complexity, method.order, method.counts
        ))
        .visible_aliases(method.aliases)
        .after_help(format!("Example: bn generate {} -n 1024 --seed 1 -o points.txt", method.name))
        .args(method.options.iter().map(option_argument))
}

pub(super) fn run(matches: &ArgMatches, global: &Global) -> Outcome {
    let Some((name, matches)) = matches.subcommand() else {
        unreachable!("clap requires a method");
    };
    let method = bn_samplers::find(name).map_err(Failure::usage)?;
    let args: Generate = super::parsed(matches)?;
    let options = given_options(method.options, matches);
    let given = given_values(method, &options)?;
    let sampler = method.with_values(given).map_err(Failure::usage)?;
    output_points::check_total(u64::from(args.n), args.sets)?;
    if args.json && args.output == Path::new("-") {
        return Err(Failure::misuse(
            "--json needs standard output for itself; name a file with -o",
        ));
    }
    let format = args.format;
    output_points::check(&args.output, format, args.sets as usize)?;
    check_equal_sizes(method, &args, &options)?;
    let start = Instant::now();
    let samples = sample_all(&*sampler, &args, global)?;
    let seconds = start.elapsed().as_secs_f64();
    let (sets, reports): (Vec<PointSet>, Vec<Report>) =
        samples.into_iter().map(|sample| (sample.points, sample.report)).unzip();
    for (i, report) in reports.iter().enumerate() {
        for note in &report.notes {
            let set = if reports.len() > 1 { format!("set {i}: ") } else { String::new() };
            global.remark(format!("{set}{note}"));
        }
    }
    if let Some(remark) = unconverged(&reports) {
        global.remark(remark);
    }
    if sets.len() > 1 && sets.iter().all(|set| *set == sets[0]) {
        global.remark(format!("all sets are equal: {name} takes no random number here"));
    }
    output_points::write(&args.output, format, &sets)?;
    if args.json {
        let account = account(method, &args, &options, &sets, &reports, seconds);
        return output::write_stdout(|w| Ok(writeln!(w, "{account:#}")?));
    }
    Ok(())
}

/// What is to be said of runs that ended before they converged and have no note of it.
fn unconverged(reports: &[Report]) -> Option<String> {
    use bn_samplers::FigureValue;
    let figure = |report: &Report, name: &str| {
        report.figures.iter().find(|figure| figure.name == name).map(|figure| figure.value)
    };
    let early = |report: &&Report| {
        figure(report, "converged") == Some(FigureValue::Holds(false)) && report.notes.is_empty()
    };
    let ended: Vec<&Report> = reports.iter().filter(early).collect();
    let first = ended.first()?;
    let of = if reports.len() > 1 {
        format!(" ({} of {} sets)", ended.len(), reports.len())
    } else {
        String::new()
    };
    let after = match figure(first, "iterations") {
        Some(FigureValue::Count(iterations)) => format!(" after {iterations} iterations"),
        _ => String::new(),
    };
    let residual = match figure(first, "residual") {
        Some(FigureValue::Real(residual)) => format!(", residual {residual:.3e}"),
        _ => String::new(),
    };
    let why = match figure(first, "ended_by") {
        Some(FigureValue::Word(word)) => format!(" ({word})"),
        _ => String::new(),
    };
    Some(format!("stopped{after} without having converged{why}{residual}{of}"))
}

/// Refuses `.npy` for sets that will differ in size, before they are made.
fn check_equal_sizes(method: &Method, args: &Generate, options: &[(&str, &str)]) -> Outcome {
    let npy = match args.format {
        Some(format) => format == Format::Npy,
        None => Format::from_path(&args.output) == Ok(Format::Npy),
    };
    let exact = options.iter().any(|&(name, text)| name == "exact" && text != "false");
    let together = !output_points::one_a_file(&args.output);
    if npy && together && args.sets > 1 && method.counts == CountRule::Approximate && !exact {
        return Err(Failure::misuse(format!(
            "sets of {} differ in size, and .npy holds sets of one size: write a .dat or .json",
            method.name
        )));
    }
    Ok(())
}

/// The sets, made in parallel; one alone shows how it proceeds, several show how many are done.
fn sample_all(sampler: &dyn Sampler, args: &Generate, global: &Global) -> Outcome<Vec<Sample>> {
    let n = args.n as usize;
    let bar = Bar::new(global.quiet);
    let one = |set: u32, observer: &dyn Observer| {
        sampler.sample(n, Seed::new(args.seed).for_set(set), observer).map_err(|error| {
            let usage = error.is_usage();
            let error = anyhow!(error);
            if usage { Failure::usage(error) } else { Failure::failed(error) }
        })
    };
    if args.sets == 1 {
        return Ok(vec![one(0, &bar)?]);
    }
    let progress = bar.counting("sets", u64::from(args.sets));
    (0..args.sets)
        .into_par_iter()
        .map(|set| {
            let sample = one(set, &Unobserved);
            progress.step();
            sample
        })
        .collect()
}

/// The JSON account of a run. `iterations` is summed over the sets, `residual` the largest.
fn account(
    method: &Method,
    args: &Generate,
    options: &[(&str, &str)],
    sets: &[PointSet],
    reports: &[Report],
    seconds: f64,
) -> Value {
    let figures: Vec<Map<String, Value>> = reports.iter().map(figures).collect();
    let known = |name: &str| -> Vec<f64> {
        figures.iter().filter_map(|run| run.get(name).and_then(Value::as_f64)).collect()
    };
    let iterations = known("iterations");
    let runs: Vec<Value> = sets
        .iter()
        .zip(reports)
        .zip(&figures)
        .map(|((set, report), figures)| {
            json!({"points": set.len(), "figures": figures, "notes": report.notes})
        })
        .collect();
    let all_options: Map<String, Value> = method
        .options
        .iter()
        .map(|spec| (spec.name.to_owned(), option_value(spec, options)))
        .collect();
    json!({
        "method": method.name,
        "method_version": method.version,
        "n": args.n,
        "seed": args.seed,
        "sets": args.sets,
        "options": all_options,
        "iterations": (!iterations.is_empty()).then(|| iterations.iter().sum::<f64>() as u64),
        "residual": known("residual").into_iter().reduce(f64::max),
        "seconds": seconds,
        "runs": runs,
    })
}

fn figures(report: &Report) -> Map<String, Value> {
    use bn_samplers::FigureValue;
    let value = |value| match value {
        FigureValue::Count(count) => json!(count),
        FigureValue::Real(real) => json!(real),
        FigureValue::Holds(holds) => json!(holds),
        FigureValue::Word(word) => json!(word),
    };
    report.figures.iter().map(|figure| (figure.name.to_owned(), value(figure.value))).collect()
}
