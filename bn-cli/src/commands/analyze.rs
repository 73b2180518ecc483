//! `bn analyze`: the statistics of point sets.

use std::path::{Path, PathBuf};

use bn_core::io::Format;
use bn_core::{Curve, PointSet};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Command, ValueEnum};

use super::Global;
use crate::analysis::{
    Analysis, POWER_BELOW_LIMIT, SPECTRAL_LIMIT, Statistic, Summary, WINDOWED_LIMIT,
};
use crate::progress_bar::Bar;
use crate::{Failure, Outcome, input, output};

#[derive(Debug, Args)]
pub(super) struct Analyze {
    /// Point files; `-` is standard input, its format told by its contents (but .rps: `--format rps`)
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// One result for all sets of all files together, instead of one for each file
    #[arg(long, visible_alias = "avg")]
    average: bool,
    /// JSON on standard output: an array with an object for each file, one object with --average.
    /// null is what was not asked for, is not defined for the sets, or was left out for their size
    #[arg(long)]
    json: bool,
    /// Compute these statistics and nothing else
    #[arg(long, value_name = "KEY,...", value_delimiter = ',', value_parser = statistics())]
    only: Option<Vec<Statistic>>,
    /// Estimator of `nu_eff` and omega (default: both, windowed only up to 200000 points a set)
    #[arg(long, value_enum)]
    method: Option<Estimator>,
    /// Mean power of the modes 0 < |k| < NU, in cycles per unit
    #[arg(long, value_name = "NU", allow_negative_numbers = true)]
    power_below: Option<f64>,
    /// Write a curve as CSV instead (to -o); `--method windowed` takes the radial power spectrum from
    /// the RDF as `nu_eff` does
    #[arg(long, value_enum, requires = "output", conflicts_with_all = ["json", "only", "power_below"])]
    curve: Option<CurveName>,
    /// File for the curve, `-` for standard output
    #[arg(short, long, value_name = "FILE", requires = "curve")]
    output: Option<PathBuf>,
    /// Format of the files (default: by each file's extension)
    #[arg(long, value_name = "FORMAT")]
    format: Option<Format>,
    /// Wrap coordinates outside [0, 1) instead of refusing them
    #[arg(long)]
    wrap: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Estimator {
    /// From the RDF through the thesis's window: what the thesis's tables print; O(n^2)
    Windowed,
    /// From the ring means of the exact periodogram
    Direct,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum CurveName {
    /// Radial distribution function g(r), r in unit lengths: the lower edge of each bin
    Rdf,
    /// Radial power spectrum P(nu), nu in cycles per unit: the centre of each ring
    RadialPower,
    /// Anisotropy in dB, nu in cycles per unit
    Anisotropy,
}

pub(super) fn command() -> Command {
    Analyze::augment_args(Command::new("analyze"))
        .about("Measure point sets")
        .long_about(format!(
            "Measure point sets. Statistics, by key:\n\n{}\n\nStatistics of several sets together: \
             the first four are means over the sets; nu_eff and omega are taken once from the \
             averaged spectrum, with the jackknife's standard error.",
            Statistic::ALL.map(|s| format!("  {:16} {}", s.key(), s.description())).join("\n")
        ))
        .after_help(
            "Examples:\n  bn analyze a.txt b.rps --json\n  bn analyze set_*.rps --average\n  \
             bn analyze a.txt --only d_min,d_avg\n  bn analyze a.txt --curve rdf -o rdf.csv",
        )
}

/// Keys as clap's possible values, so that shells complete them.
fn statistics() -> impl TypedValueParser<Value = Statistic> {
    let keys = PossibleValuesParser::new(Statistic::ALL.map(Statistic::key));
    keys.try_map(|key| key.parse::<Statistic>().map_err(|failure| failure.to_string()))
}

/// The sets that one result is for.
struct Group {
    files: Vec<String>,
    sets: Vec<PointSet>,
}

pub(super) fn run(args: &Analyze, global: &Global) -> Outcome {
    args.check()?;
    let groups = args.groups()?;
    if let Some(curve) = args.curve {
        let path = args.output.as_deref().unwrap_or(Path::new("-"));
        return write_curve(curve, args.method, &groups, path, global);
    }
    let mut summaries = Vec::new();
    let bar = Bar::new(global.quiet);
    let count = groups.len();
    for (i, group) in groups.into_iter().enumerate() {
        bar.working(format!("measuring {} of {count}", i + 1));
        let analysis = args.analysis(&group.sets);
        let wanted = args.wanted(group.sets[0].len(), global);
        summaries.push(Summary::of(&analysis, &wanted, group.files));
    }
    drop(bar);
    output::write_stdout(|w| {
        if args.json {
            let written = match &summaries[..] {
                [one] if args.average => serde_json::to_writer_pretty(&mut *w, one),
                all => serde_json::to_writer_pretty(&mut *w, all),
            };
            written.map_err(std::io::Error::from)?;
            return Ok(writeln!(w)?);
        }
        summaries.iter().try_for_each(|summary| summary.write_text(w))
    })
}

impl Analyze {
    fn check(&self) -> Outcome {
        if let Some(nu) = self.power_below
            && !(nu > 0.0 && nu <= POWER_BELOW_LIMIT)
        {
            return Err(Failure::misuse(format!(
                "--power-below {nu}: a frequency above 0 and up to {POWER_BELOW_LIMIT} is needed"
            )));
        }
        let only = self.only.as_deref().unwrap_or_default();
        if only.contains(&Statistic::PowerBelow) && self.power_below.is_none() {
            return Err(Failure::misuse(
                "--only power_below needs a frequency: add --power-below NU",
            ));
        }
        if self.power_below.is_some() && !only.is_empty() && !only.contains(&Statistic::PowerBelow)
        {
            return Err(Failure::misuse("--power-below NU: --only leaves power_below out"));
        }
        let left_out = |s: &Statistic| match self.method {
            Some(Estimator::Direct) => s.is_windowed(),
            Some(Estimator::Windowed) => s.is_direct(),
            None => false,
        };
        if let Some(statistic) = only.iter().find(|s| left_out(s)) {
            let key = statistic.key();
            return Err(Failure::misuse(format!("--only {key}: --method leaves {key} out")));
        }
        if let (Some(curve), Some(_)) = (self.curve, self.method)
            && !matches!(curve, CurveName::RadialPower)
        {
            return Err(Failure::misuse("--method belongs to the curve radial-power alone"));
        }
        if let Some(output) = &self.output
            && self.files.iter().any(|file| output::replaces(output, file))
        {
            let name = output.display();
            return Err(Failure::misuse(format!("-o {name}: the curve would replace its points")));
        }
        if self.files.iter().filter(|file| file.as_os_str() == "-").count() > 1 {
            return Err(Failure::misuse("standard input (-) can be read only once"));
        }
        Ok(())
    }

    fn groups(&self) -> Outcome<Vec<Group>> {
        let mut groups = Vec::new();
        for file in &self.files {
            let sets = input::read(file, self.format, self.wrap)?.into_sets();
            groups.push(Group { files: vec![file.display().to_string()], sets });
        }
        if self.average {
            let first = groups.remove(0);
            groups = vec![groups.into_iter().try_fold(first, Group::join)?];
        }
        groups.iter().try_for_each(Group::check_sizes)?;
        Ok(groups)
    }

    fn analysis<'a>(&self, sets: &'a [PointSet]) -> Analysis<'a> {
        let analysis = Analysis::of(sets);
        match self.power_below {
            Some(frequency) => analysis.with_power_below(frequency),
            None => analysis,
        }
    }

    /// What to compute for sets of `n` points: what was asked for; else everything that the chosen
    /// estimators give and that takes less than minutes.
    fn wanted(&self, n: usize, global: &Global) -> Vec<Statistic> {
        let too_large = n > WINDOWED_LIMIT && self.method != Some(Estimator::Windowed);
        let wanted = |statistic: &Statistic| match statistic {
            Statistic::PowerBelow => self.power_below.is_some(),
            s if s.is_windowed() => self.method != Some(Estimator::Direct),
            s if s.is_direct() => self.method != Some(Estimator::Windowed),
            _ => true,
        };
        let mut list: Vec<Statistic> = match &self.only {
            Some(only) => Statistic::ALL.into_iter().filter(|s| only.contains(s)).collect(),
            None => Statistic::ALL.into_iter().filter(wanted).collect(),
        };
        if n > SPECTRAL_LIMIT && list.iter().any(|s| s.is_direct()) {
            list.retain(|s| !s.is_direct());
            global.remark(format!(
                "nu_eff_direct and omega_direct left out: they serve up to {SPECTRAL_LIMIT} points"
            ));
        }
        if too_large && list.iter().any(|s| s.is_windowed()) {
            list.retain(|s| !s.is_windowed());
            if self.method.is_none() {
                global.remark(format!(
                    "nu_eff and omega left out: the windowed estimator would compare {}; --method \
                     windowed asks for it",
                    cost_of_pairs(n)
                ));
            }
        }
        list
    }
}

/// What comparing all pairs of `n` points costs.
fn cost_of_pairs(n: usize) -> String {
    let pairs = n as f64 * n as f64 / 2.0;
    format!("{pairs:.1e} pairs a set, about {:.0} s on one core", pairs * 1e-9)
}

impl Group {
    fn join(mut self, other: Self) -> Outcome<Self> {
        let (n, m) = (self.sets[0].len(), other.sets[0].len());
        if n != m {
            return Err(Failure::misuse(format!(
                "{} has {n} points a set but {} has {m}; sets of different size are not averaged",
                self.files[0], other.files[0]
            )));
        }
        self.files.extend(other.files);
        self.sets.extend(other.sets);
        Ok(self)
    }

    fn check_sizes(&self) -> Outcome {
        let n = self.sets[0].len();
        match self.sets.iter().position(|set| set.len() != n) {
            None => Ok(()),
            Some(i) => Err(Failure::misuse(format!(
                "{}: set {i} has {} points but set 0 has {n}; sets of different size are not \
                 averaged: `bn convert` puts them into files of their own, to be analyzed one by one",
                self.files.join(" "),
                self.sets[i].len()
            ))),
        }
    }
}

fn write_curve(
    name: CurveName,
    method: Option<Estimator>,
    groups: &[Group],
    path: &Path,
    global: &Global,
) -> Outcome {
    let [group] = groups else {
        return Err(Failure::misuse("--curve takes one file, or several with --average"));
    };
    let n = group.sets[0].len();
    let pairs = matches!(name, CurveName::Rdf) || method == Some(Estimator::Windowed);
    if pairs && n > WINDOWED_LIMIT {
        global.remark(format!("comparing {}", cost_of_pairs(n)));
    } else if !pairs && n > SPECTRAL_LIMIT {
        return Err(Failure::misuse(format!(
            "the spectrum of {n} points can't be planned; {SPECTRAL_LIMIT} at most"
        )));
    }
    let analysis = Analysis::of(&group.sets);
    let spectrum = || analysis.radial_power(analysis.shown_frequency());
    let (header, curve): (&str, Option<Curve>) = match name {
        CurveName::Rdf => ("r,g", Some(analysis.rdf())),
        CurveName::RadialPower => {
            let windowed = method == Some(Estimator::Windowed);
            let power = || analysis.windowed().power().clone();
            ("nu,power", if windowed { Some(power()) } else { spectrum().curve() })
        }
        CurveName::Anisotropy => ("nu,anisotropy_db", spectrum().anisotropy_db()),
    };
    let curve = curve.ok_or_else(|| Failure::misuse("the curve has no point for these sets"))?;
    output::write_to(path, |w| {
        writeln!(w, "{header}")?;
        for (x, y) in curve.iter().filter(|(_, y)| y.is_finite()) {
            writeln!(w, "{x},{y}")?;
        }
        Ok(())
    })
}
