//! The target of `bn match` and `bn realize`: names, files, models to imitate.

use std::path::{Path, PathBuf};

use bn_core::io::ReadOptions;
use bn_core::{Density, PointSet};
use bn_spectral::{Realizability, SinglePeak, Target, Warning, highest_step};
use clap::Args;

use crate::input::Source;
use crate::{Failure, Outcome, curve_file, input};

/// Which spectrum.
#[derive(Debug, Args)]
pub(super) struct TargetArgs {
    /// `step`, `single-peak`, or a CSV file (`-`: standard input) with the header `nu,power` (cycles per unit),
    /// `nu_rel,power` (sqrt(n)/2), `r,g` (unit lengths) or `r_rel,g` (`d_hex`), as `bn analyze --curve`
    /// writes it (of measured curves the noise counts too, and is hardly ever realizable: --like takes the
    /// points themselves)
    #[arg(long, value_name = "TARGET", conflicts_with = "like")]
    target: Option<PathBuf>,
    /// Point files whose mean spectrum is the target
    #[arg(long, value_name = "FILE", num_args = 1..)]
    like: Vec<PathBuf>,
    /// Frequency of the step, or where the peak begins, in cycles per unit (default: sqrt(n/pi) for
    /// step, 60 sqrt(n/4096) for single-peak)
    #[arg(long, value_name = "NU", allow_negative_numbers = true)]
    pub(super) nu0: Option<f64>,
    /// Power of the peak above 1, (height - 1) times width, in cycles per unit (default: 19
    /// sqrt(n/4096))
    #[arg(long, value_name = "POWER", allow_negative_numbers = true)]
    pub(super) peak: Option<f64>,
    /// Deviation of the Gaussian that smooths the peak, in cycles per unit (default: 2.5
    /// sqrt(n/4096))
    #[arg(long, value_name = "SIGMA", allow_negative_numbers = true)]
    pub(super) sigma: Option<f64>,
}

/// A target and where it comes from.
pub(super) struct Wanted {
    pub(super) target: Target,
    /// As the command line has it.
    pub(super) name: String,
    /// Named with default parameters: such a target is not refused.
    pub(super) is_default: bool,
}

/// Points if neither `-n` nor a model says how many.
const DEFAULT_POINTS: usize = 4096;

impl TargetArgs {
    /// The target for `n` points, or as many as the models have.
    pub(super) fn target(&self, n: Option<u32>, file: Option<&Path>) -> Outcome<Wanted> {
        let parameters = [("nu0", self.nu0), ("peak", self.peak), ("sigma", self.sigma)];
        let given: Vec<&str> =
            parameters.iter().filter(|(_, value)| value.is_some()).map(|(name, _)| *name).collect();
        let target = self.target.as_deref().or(file);
        let name = target.map(|path| path.display().to_string()).unwrap_or_default();
        let takes: &[&str] = match &*name {
            "step" => &["nu0"],
            "single-peak" => &["nu0", "peak", "sigma"],
            _ => &[],
        };
        if let Some(unknown) = given.iter().find(|name| !takes.contains(name)) {
            return Err(Failure::misuse(format!("--{unknown} is no parameter of this target")));
        }
        let density = Density::new(n.map_or(DEFAULT_POINTS, |n| n as usize));
        let target = match (&*name, target) {
            ("step", _) => self.step(density)?,
            ("single-peak", _) => self.single_peak(density)?,
            (_, Some(path)) => {
                let source = Source::open(path)?;
                if file.is_some() && !curve_file::looks_like_curve(source.head()) {
                    let sets = source.into_sets(None, ReadOptions::default())?;
                    return imitated(sets.sets(), name, n);
                }
                curve_file::read(source, density)?
            }
            (_, None) if !self.like.is_empty() => {
                let names: Vec<_> = self.like.iter().map(|f| f.display().to_string()).collect();
                return imitated(&all_sets(&self.like)?, names.join(" "), n);
            }
            (_, None) => {
                return Err(Failure::misuse(
                    "which spectrum? --target step, --target single-peak, --target FILE or --like FILE",
                ));
            }
        };
        Ok(Wanted { target, name, is_default: !takes.is_empty() && given.is_empty() })
    }

    fn step(&self, density: Density) -> Outcome<Target> {
        let nu0 = self.nu0.unwrap_or_else(|| highest_step(density.points_per_unit_area()));
        Target::step(density, nu0).map_err(Failure::usage)
    }

    fn single_peak(&self, density: Density) -> Outcome<Target> {
        let thesis = SinglePeak::thesis(density);
        let peak = SinglePeak {
            nu0: self.nu0.unwrap_or(thesis.nu0),
            peak: self.peak.unwrap_or(thesis.peak),
            sigma: self.sigma.unwrap_or(thesis.sigma),
            width: thesis.width,
        };
        Target::single_peak(density, peak).map_err(Failure::usage)
    }
}

/// The sets of all files.
fn all_sets(files: &[PathBuf]) -> Outcome<Vec<PointSet>> {
    let mut sets = Vec::new();
    for file in files {
        sets.extend(input::read(file, None, false)?.into_sets());
    }
    Ok(sets)
}

/// The mean spectrum of these sets.
fn imitated(sets: &[PointSet], name: String, n: Option<u32>) -> Outcome<Wanted> {
    let points = n.map_or(sets[0].len(), |n| n as usize);
    let target = Target::imitating(sets, points).map_err(Failure::usage)?;
    Ok(Wanted { target, name, is_default: false })
}

/// Fewer modes than this can't have a spectrum of their own.
const FEWEST_MODES: f64 = 12.0;

impl Wanted {
    /// Why nobody should try to match it, if there is a reason.
    pub(super) fn objection(&self, verdict: &Realizability) -> Option<String> {
        let is_beyond = |warning: &&Warning| matches!(warning, Warning::BeyondHexagonal { .. });
        let beyond = verdict.warnings.iter().find(is_beyond).map(ToString::to_string);
        beyond.or_else(|| verdict.reason()).or_else(|| self.too_low())
    }

    /// Spectra that differ from 1 only where the torus has next to no frequency.
    fn too_low(&self) -> Option<String> {
        let end = self.target.end();
        let modes = std::f64::consts::PI * end * end;
        (end > 0.0 && modes < FEWEST_MODES).then(|| {
            format!(
                "the target differs from 1 only below {end:.3} cycles per unit, where the torus has \
                 about {modes:.0} modes: too few for a spectrum"
            )
        })
    }
}
