//! `bn match`: point sets from the spectrum that they are to have.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::anyhow;
use bn_core::io::Format;
use bn_core::{PointSet, Seed, Unobserved};
use bn_samplers::{Algorithm, FigureValue, Report, Sample, Sampler as _, SpectrumMatching};
use clap::builder::PossibleValuesParser;
use clap::{Args, Command};
use rayon::prelude::*;
use serde_json::{Value, json};

use super::Global;
use super::target::{TargetArgs, Wanted};
use crate::progress_bar::Bar;
use crate::{Failure, Outcome, input, output, output_points};

#[derive(Debug, Args)]
pub(super) struct Match {
    #[command(flatten)]
    target: TargetArgs,
    /// Number of points (default: 4096, or as many as the models of --like or --start have)
    #[arg(short, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    n: Option<u32>,
    /// Seed of the random numbers; the same seed gives the same bytes
    #[arg(short, long, value_name = "SEED", default_value = "1")]
    seed: u64,
    /// Number of sets, each from its own random numbers
    #[arg(short = 'm', long, value_name = "K", default_value = "1",
          value_parser = clap::value_parser!(u32).range(1..=100_000))]
    sets: u32,
    /// File to write, `-` for standard output; as in `bn generate`
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
    /// Format of the output (default: by the file's extension; txt or dat on standard output)
    #[arg(long, value_name = "FORMAT")]
    format: Option<Format>,
    /// How to come near the spectrum
    #[arg(long, value_name = "NAME", default_value = Algorithm::NAMES[0],
          value_parser = PossibleValuesParser::new(Algorithm::NAMES))]
    algorithm: String,
    /// The most iterations (default: until it stops paying)
    #[arg(long, value_name = "N")]
    iterations: Option<u32>,
    /// Go on from these points instead of random ones
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

pub(super) fn run(args: &Match, global: &Global) -> Outcome {
    if args.json && args.output == Path::new("-") {
        return Err(Failure::misuse(
            "--json needs standard output for itself; name a file with -o",
        ));
    }
    output_points::check(&args.output, args.format, args.sets as usize)?;
    let first = args.start.as_deref().map(|file| start(file, args.n)).transpose()?;
    let n = args.n.or(first.as_ref().map(|points| points.len() as u32));
    let wanted = args.target.target(n, None)?;
    if let Some(objection) = wanted.objection() {
        if !args.best_effort && !wanted.is_default {
            return Err(Failure::misuse(format!(
                "{}: {objection}; --best-effort comes as near as possible",
                wanted.name
            )));
        }
        global.remark(format!("{}: {objection}; coming as near as possible", wanted.name));
    }
    let start = Instant::now();
    let samples = args.samples(&wanted, first, global)?;
    let seconds = start.elapsed().as_secs_f64();
    let (sets, reports): (Vec<PointSet>, Vec<Report>) =
        samples.into_iter().map(|sample| (sample.points, sample.report)).unzip();
    output_points::write(&args.output, args.format, &sets)?;
    let account = args.account(&wanted, &reports, seconds);
    if args.json {
        return output::write_stdout(|w| Ok(writeln!(w, "{account:#}")?));
    }
    global.remark(format!("residual {:.2e}", real(&account["residual"])));
    Ok(())
}

/// The points to go on from, as many as are wanted.
fn start(file: &Path, n: Option<u32>) -> Outcome<PointSet> {
    let points = input::read(file, None, false)?.into_sets().swap_remove(0);
    match n {
        Some(n) if n as usize != points.len() => Err(Failure::misuse(format!(
            "--start {}: it has {} points, but -n is {n}",
            file.display(),
            points.len()
        ))),
        _ => Ok(points),
    }
}

fn real(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

impl Match {
    fn matching(&self, wanted: &Wanted, start: Option<PointSet>) -> SpectrumMatching {
        let algorithm = Algorithm::named(&self.algorithm).unwrap_or_default();
        let algorithm = match self.iterations {
            Some(iterations) => algorithm.with_iterations(iterations),
            None => algorithm,
        };
        let mut matching = SpectrumMatching::new(wanted.target.clone(), algorithm);
        matching.start = start;
        matching
    }

    fn samples(
        &self,
        wanted: &Wanted,
        start: Option<PointSet>,
        global: &Global,
    ) -> Outcome<Vec<Sample>> {
        let matching = self.matching(wanted, start);
        let n = wanted.target.density().points_per_unit_area() as usize;
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
    fn account(&self, wanted: &Wanted, reports: &[Report], seconds: f64) -> Value {
        let each = |name: &str| -> Vec<f64> {
            let value = |report: &Report| match report.get(name)? {
                FigureValue::Real(real) => Some(real),
                FigureValue::Count(count) => Some(count as f64),
                FigureValue::Holds(holds) => Some(f64::from(u8::from(holds))),
            };
            reports.iter().filter_map(value).collect()
        };
        let largest = |name: &str| each(name).into_iter().reduce(f64::max);
        json!({
            "target": wanted.name,
            "n": wanted.target.density().points_per_unit_area() as u64,
            "seed": self.seed,
            "sets": self.sets,
            "options": {"algorithm": self.algorithm, "iterations": self.iterations,
                        "best_effort": self.best_effort, "start": self.start,
                        "nu0": self.target.nu0, "peak": self.target.peak, "sigma": self.target.sigma},
            "iterations": each("iterations").iter().sum::<f64>() as u64,
            "residual": largest("residual"),
            "empty_power": largest("empty_power"),
            "converged": each("converged").iter().all(|&holds| holds == 1.0),
            "residuals": each("residual"),
            "seconds": seconds,
        })
    }
}
