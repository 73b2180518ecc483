//! `bn realize`: whether a spectrum is realizable.

use std::path::PathBuf;

use bn_spectral::{Realizability, highest_step};
use clap::{Args, Command};
use serde_json::json;

use super::target::TargetArgs;
use crate::{Outcome, output};

#[derive(Debug, Args)]
pub(super) struct Realize {
    /// A curve file as for --target, or a point file whose spectrum is to be judged
    #[arg(value_name = "FILE", conflicts_with_all = ["target", "like"])]
    file: Option<PathBuf>,
    /// Number of points, the density that frequencies refer to (default: 4096, or that of the points)
    #[arg(short, value_name = "N", allow_negative_numbers = true,
          value_parser = clap::value_parser!(u32).range(1..=100_000_000))]
    n: Option<u32>,
    /// JSON on standard output
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    target: TargetArgs,
}

pub(super) fn command() -> Command {
    Realize::augment_args(Command::new("realize"))
        .about("Tell whether a spectrum is realizable")
        .long_about(
            "Tell whether a spectrum is realizable: the least value of the power P and of the RDF g, \
             which must not be negative, and where they are; further conditions that are known to be \
             necessary come as warnings. Sufficient conditions are not known. The exit code is 0 \
             whatever the answer.",
        )
        .after_help(
            "Examples:\n  bn realize --target step -n 4096 --nu0 36\n  \
             bn realize --target single-peak --json\n  bn realize curve.csv -n 1024",
        )
}

pub(super) fn run(args: &Realize) -> Outcome {
    let wanted = args.target.target(args.n, args.file.as_deref())?;
    let verdict = Realizability::of(&wanted.target);
    let n = wanted.target.density().points_per_unit_area();
    let warnings: Vec<String> = verdict.warnings.iter().map(ToString::to_string).collect();
    output::write_stdout(|w| {
        if args.json {
            let answer = json!({
                "target": wanted.name,
                "n": n as u64,
                "realizable": verdict.realizable,
                "min_power": verdict.min_power,
                "at_nu": verdict.at_nu,
                "min_g": verdict.min_g,
                "at_r": verdict.at_r,
                "nu_max": highest_step(n),
                "reason": verdict.reason(),
                "warnings": warnings,
            });
            return Ok(writeln!(w, "{answer:#}")?);
        }
        match verdict.reason() {
            None => writeln!(w, "realizable, as far as P >= 0 and g >= 0 tell")?,
            Some(reason) => writeln!(w, "not realizable: {reason}")?,
        }
        writeln!(
            w,
            "least power  {:10.6} at {:.4} cycles per unit",
            verdict.min_power, verdict.at_nu
        )?;
        let noise = if verdict.realizable && verdict.min_g < 0.0 && wanted.target.is_measured() {
            ", within the error of a measured spectrum"
        } else {
            ""
        };
        let (g, r) = (verdict.min_g, verdict.at_r);
        writeln!(w, "least g      {g:10.6} at the distance {r:.6}{noise}")?;
        writeln!(w, "a step is realizable up to {:.4} cycles per unit", highest_step(n))?;
        warnings.iter().try_for_each(|warning| writeln!(w, "warning: {warning}"))?;
        Ok(())
    })
}
