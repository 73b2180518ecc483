//! `bn match`: point sets from the spectrum that they are to have.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::anyhow;
use bn_core::io::Format;
use bn_core::{PointSet, Seed, Unobserved};
use bn_samplers::{
    Algorithm, FigureValue, Given, OptionValues, Report, Sample, Sampler as _, SpectrumMatching,
};
use bn_spectral::Realizability;
use clap::{ArgMatches, Args, Command};
use rayon::prelude::*;
use serde_json::{Map, Value, json};

use super::Global;
use super::method_values::{given_options, only_set, option_argument, option_value};
use super::target::{TargetArgs, Wanted};
use crate::progress_bar::Bar;
use crate::{Failure, Outcome, output, output_points};

#[derive(Debug, Args)]
pub(super) struct Match {
    #[command(flatten)]
    target: TargetArgs,
    /// Number of points (default: 4096, or as many as the models of --like or --start have)
    #[arg(short, value_name = "N", allow_negative_numbers = true,
          value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    n: Option<u32>,
    /// Seed of the random numbers; the same seed gives the same bytes
    #[arg(short, long, value_name = "SEED", allow_negative_numbers = true, default_value = "1")]
    seed: u64,
    /// Number of sets, each from its own random numbers; with --start only annealing makes several
    #[arg(short = 'm', long, value_name = "K", allow_negative_numbers = true, default_value = "1",
          value_parser = clap::value_parser!(u32).range(1..=100_000))]
    sets: u32,
    /// File to write, `-` for standard output; as in `bn generate`
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
    /// Format of the output (default: by the file's extension; txt or dat on standard output)
    #[arg(long, value_name = "FORMAT")]
    format: Option<Format>,
    /// Go on from the points of this file, one set, instead of random ones
    #[arg(long, value_name = "FILE")]
    start: Option<PathBuf>,
    /// Come as near as possible to a target that no point set can have, and say how near
    #[arg(long)]
    best_effort: bool,
    /// A JSON account of the run on standard output: seed, options, iterations, residual, seconds
    #[arg(long)]
    json: bool,
}

pub(super) fn command() -> Command {
    Match::augment_args(Command::new("match"))
        .args(Algorithm::OPTIONS.iter().map(|spec| {
            option_argument(spec).help_heading("Options of the algorithms")
        }))
        .about("Make patterns that have a given spectrum")
        .long_about(
            "Make patterns that have a given spectrum. Targets that are known to be unrealizable are \
             refused with the reason, unless --best-effort; `bn realize` tells more. The thesis's \
             own single peak (the default parameters) is not realizable as printed and is matched \
             as well as possible all the same. The residual is the root mean square of ring means less the target over all modes up to 6 sqrt(n).",
        )
        .after_help(
            "Examples:\n  bn match --target step -n 4096 -o step.txt\n  \
             bn match --like dart_*.rps --sets 10 -o like.npy --json\n  \
             bn match --target curve.csv --best-effort -o near.txt",
        )
}

pub(super) fn run(matches: &ArgMatches, global: &Global) -> Outcome {
    let args: &Match = &super::parsed(matches)?;
    let options = given_options(Algorithm::OPTIONS, matches);
    let given = options.iter().map(|&(name, text)| (name, Given::Text(text)));
    let values = OptionValues::parse("match", Algorithm::OPTIONS, given).map_err(Failure::usage)?;
    let algorithm = Algorithm::from_options(&values).map_err(Failure::usage)?;
    if args.json && args.output == Path::new("-") {
        return Err(Failure::misuse(
            "--json needs standard output for itself; name a file with -o",
        ));
    }
    output_points::check(&args.output, args.format, args.sets as usize)?;
    let is_random = args.start.is_none() || matches!(algorithm, Algorithm::Annealing(_));
    if args.sets > 1 && !is_random {
        return Err(Failure::misuse(
            "--start with several --sets: all would be equal, since of the algorithms only annealing \
             takes random numbers then",
        ));
    }
    let first = args.start.as_deref().map(|file| start(file, args.n)).transpose()?;
    let n = args.n.or(first.as_ref().map(|points| points.len() as u32));
    let wanted = args.target.target(n, None)?;
    let points = wanted.target.density().points_per_unit_area() as u64;
    output_points::check_total(points, args.sets)?;
    let verdict = Realizability::of(&wanted.target);
    let objection = wanted.objection(&verdict);
    let warnings = verdict.warnings.iter().map(ToString::to_string);
    let warnings: Vec<String> = warnings.filter(|text| Some(text) != objection.as_ref()).collect();
    if let Some(objection) = objection {
        if !args.best_effort && !wanted.is_default {
            let all: Vec<&str> = [&objection].into_iter().chain(&warnings).map(|s| &**s).collect();
            return Err(Failure::misuse(format!(
                "{}: {}; --best-effort comes as near as possible",
                wanted.name,
                all.join("; ")
            )));
        }
        global.remark(format!("{}: {objection}; coming as near as possible", wanted.name));
    }
    for warning in &warnings {
        global.remark(format!("warning: {warning}"));
    }
    let start = Instant::now();
    let mut matching = SpectrumMatching::new(wanted.target.clone(), algorithm).judged(&verdict);
    matching.start = first;
    let samples = args.samples(&matching, global)?;
    let seconds = start.elapsed().as_secs_f64();
    let (sets, reports): (Vec<PointSet>, Vec<Report>) =
        samples.into_iter().map(|sample| (sample.points, sample.report)).unzip();
    output_points::write(&args.output, args.format, &sets)?;
    if args.json {
        let account = args.account(&wanted, &warnings, &options, &reports, seconds);
        return output::write_stdout(|w| Ok(writeln!(w, "{account:#}")?));
    }
    global.remark(summary(&reports));
    Ok(())
}

/// How near the sets came, and why no nearer.
fn summary(reports: &[Report]) -> String {
    let mut ends: Vec<&str> = words(reports, "ended_by").collect();
    ends.sort_unstable();
    ends.dedup();
    let residual = numbers(reports, "residual").fold(0.0, f64::max);
    format!("residual {residual:.2e}, ended by {}", ends.join(" or "))
}

/// The numbers called `name`, of those that have it.
fn numbers(reports: &[Report], name: &str) -> impl Iterator<Item = f64> {
    reports.iter().filter_map(move |report| match report.get(name)? {
        FigureValue::Real(real) => Some(real),
        FigureValue::Count(count) => Some(count as f64),
        FigureValue::Holds(_) | FigureValue::Word(_) => None,
    })
}

/// The words called `name`, likewise.
fn words(reports: &[Report], name: &str) -> impl Iterator<Item = &'static str> {
    reports.iter().filter_map(move |report| match report.get(name)? {
        FigureValue::Word(word) => Some(word),
        _ => None,
    })
}

/// The points to go on from, as many as are wanted.
fn start(file: &Path, n: Option<u32>) -> Outcome<PointSet> {
    let points = only_set(file)?;
    match n {
        Some(n) if n as usize != points.len() => Err(Failure::misuse(format!(
            "--start {}: it has {} points, but -n is {n}",
            file.display(),
            points.len()
        ))),
        _ => Ok(points),
    }
}

impl Match {
    fn samples(&self, matching: &SpectrumMatching, global: &Global) -> Outcome<Vec<Sample>> {
        let n = matching.target().density().points_per_unit_area() as usize;
        let bar = Bar::new(global.quiet);
        let failure = |error: bn_samplers::SampleError| {
            let usage = error.is_usage();
            if usage { Failure::usage(anyhow!(error)) } else { Failure::failed(anyhow!(error)) }
        };
        let seed = Seed::new(self.seed);
        if self.sets == 1 {
            return Ok(vec![matching.sample(n, seed, &bar).map_err(failure)?]);
        }
        let counter = bar.counting("sets", u64::from(self.sets));
        let one = |set: u32| {
            let sample = matching.sample(n, seed.for_set(set), &Unobserved).map_err(failure);
            counter.step();
            sample
        };
        (0..self.sets).into_par_iter().map(one).collect()
    }

    /// The JSON account; `iterations` is summed over the sets, residuals are the largest.
    fn account(
        &self,
        wanted: &Wanted,
        warnings: &[String],
        given: &[(&str, &str)],
        reports: &[Report],
        seconds: f64,
    ) -> Value {
        let largest = |name: &str| numbers(reports, name).reduce(f64::max);
        let converged = |report: &Report| report.get("converged") == Some(true.into());
        json!({
            "target": wanted.name,
            "n": wanted.target.density().points_per_unit_area() as u64,
            "seed": self.seed,
            "sets": self.sets,
            "options": self.options(given),
            "warnings": warnings,
            "iterations": numbers(reports, "iterations").sum::<f64>() as u64,
            "residual": largest("residual"),
            "empty_power": largest("empty_power"),
            "converged": reports.iter().all(converged),
            "ended_by": words(reports, "ended_by").collect::<Vec<_>>(),
            "residuals": numbers(reports, "residual").collect::<Vec<_>>(),
            "seconds": seconds,
        })
    }

    /// All options as they were given or are by default; null where the algorithm doesn't take them or
    /// chooses by itself.
    fn options(&self, given: &[(&str, &str)]) -> Map<String, Value> {
        let own = json!({
            "best_effort": self.best_effort, "start": self.start,
            "nu0": self.target.nu0, "peak": self.target.peak, "sigma": self.target.sigma,
        });
        let named = given.iter().find(|(name, _)| *name == "algorithm");
        let algorithm = named.map_or(Algorithm::NAMES[0], |(_, text)| text);
        let tuned = Algorithm::OPTIONS.iter().map(|spec| {
            let takes = Algorithm::takes(algorithm, spec.name);
            let value = if takes { option_value(spec, given) } else { Value::Null };
            (spec.name.replace('-', "_"), value)
        });
        let own = own.as_object().cloned().unwrap_or_default();
        tuned.chain(own).collect()
    }
}
