//! Whether a point set can have a spectrum: what is known to be necessary.

use std::f64::consts::{PI, TAU};

use rayon::prelude::*;

use crate::{Target, j1_slice, panels};

/// Margins below 0 by less than this are rounding.
const ROUNDING: f64 = 1e-9;
/// g is looked at from 0 to this many times 1/√n, and to ½ at least, …
const REACH: f64 = 14.0;
/// … in steps of 1/√n over this, or finer where the spectrum reaches beyond 10·√n.
const STEPS: f64 = 100.0;
/// The most radii in such steps …
const MOST_RADII: f64 = 16_000.0;
/// … and those over the rest, if they don't reach: of spectra that reach far at this density, whose g is
/// all but decided within the first spacings.
const FAR_RADII: u32 = 500;
/// What a number variance may lack of its bound: curves are known to so many digits.
const LACK: f64 = 2e-3;
/// Below this power a frequency counts as empty.
const EMPTY: f64 = 1e-3;

/// What is known about the realizability of a [`Target`].
///
/// A spectrum that point sets have, or come arbitrarily near to, has P(ν) ≥ 0 and g(r) ≥ 0
/// (thesis eq. 5.11): both are checked, where they fail the worst and by how much. They are not
/// sufficient (Costin and Lebowitz 2004; Kuna, Lebowitz and Speer 2007). Further necessary
/// conditions that fail are among the [`warnings`](Self::warnings).
///
/// Where P was measured ([`Target::imitating`]), five standard deviations of g are allowed for, and
/// nothing else is asked: sets with such spectra exist, and finer questions are decided by what lies
/// beyond the measured rings.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Realizability {
    /// Whether P ≥ 0 and g ≥ 0, up to rounding and the statistical error of measured spectra.
    pub realizable: bool,
    /// The least P …
    pub min_power: f64,
    /// … and where, in cycles per unit.
    pub at_nu: f64,
    /// g where it is least, or where it is the farthest below its statistical error, …
    pub min_g: f64,
    /// … and where, in unit lengths.
    pub at_r: f64,
    /// Further conditions that are known to be necessary and don't hold, or nearly don't; curves that
    /// end too early.
    pub warnings: Vec<Warning>,
}

/// A necessary condition beyond P ≥ 0 and g ≥ 0 that doesn't hold, or what else makes the verdict doubtful.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", tag = "condition"))]
#[non_exhaustive]
pub enum Warning {
    /// The variance of the number of points in a disk is at least θ(1 − θ), θ the fractional part of
    /// the mean number: numbers are whole (Yamada 1961).
    NumberVariance {
        /// Radius of the disk in unit lengths.
        radius: f64,
        /// Variance of the number that the spectrum implies.
        variance: f64,
        /// What it is at least.
        bound: f64,
    },
    /// There is no power below `edge` (cycles per unit), which disordered sets can't have beyond
    /// √(2n/π): it fixes more numbers than there are coordinates (Uche, Stillinger and Torquato
    /// 2004). Little power is possible, none is not.
    Stealthy {
        /// Up to where P < 0.001.
        edge: f64,
        /// √(2n/π).
        limit: f64,
    },
    /// There is no power below `edge` (cycles per unit), where even the hexagonal lattice, of all sets
    /// that with the longest shortest wave vector, has power.
    BeyondHexagonal {
        /// Up to where P < 0.001.
        edge: f64,
        /// √(2n/√3).
        limit: f64,
    },
    /// A curve of P ends before it has settled at 1. It counts as 1 beyond: the jump is part of what is
    /// checked.
    UnsettledPower {
        /// The last frequency, in cycles per unit.
        end: f64,
        /// The largest |P − 1| in the last tenth of the samples.
        deviation: f64,
    },
    /// The same of a curve of g.
    UnsettledRdf {
        /// The last distance, in unit lengths.
        end: f64,
        /// The largest |g − 1| in the last tenth of the samples.
        deviation: f64,
    },
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NumberVariance { radius, variance, bound } => write!(
                f,
                "the number of points in disks of radius {radius:.5} would vary by {variance:.4}, \
                 but whole numbers vary by {bound:.4} at least"
            ),
            Self::Stealthy { edge, limit } => write!(
                f,
                "no power below {edge:.3} cycles per unit: disordered sets have some beyond {limit:.3}"
            ),
            Self::BeyondHexagonal { edge, limit } => write!(
                f,
                "no power below {edge:.3} cycles per unit, but even the hexagonal lattice has its \
                 first at {limit:.3}"
            ),
            Self::UnsettledPower { end, deviation } => write!(
                f,
                "the power is still {deviation:.4} away from 1 where its curve ends, at {end:.3} cycles \
                 per unit; it counts as 1 beyond, and the jump is judged and matched with the rest"
            ),
            Self::UnsettledRdf { end, deviation } => write!(
                f,
                "the RDF is still {deviation:.4} away from 1 where its curve ends, at the distance \
                 {end:.5}; it counts as 1 beyond, and the jump is judged and matched with the rest"
            ),
        }
    }
}

impl Realizability {
    /// Checks a target. Some ten milliseconds as a rule; O((samples + ½·range of frequencies) · radii), up
    /// to 16,000 radii, for those that reach far: some ten seconds at most.
    pub fn of(target: &Target) -> Self {
        let (min_power, at_nu) = least_power(target);
        let (min_g, at_r, tolerance) = least_g(target);
        let further = || empty_region(target).into_iter().chain(number_variance(target));
        let warnings = if target.is_measured() {
            unsettled(target).into_iter().collect()
        } else {
            further().chain(unsettled(target)).collect()
        };
        Self {
            realizable: min_power >= -ROUNDING && min_g >= -ROUNDING - tolerance,
            min_power,
            at_nu,
            min_g,
            at_r,
            warnings,
        }
    }

    /// Whether nothing is known that stands in the way of point sets with this spectrum.
    pub fn is_unobjectionable(&self) -> bool {
        let objects = |warning: &Warning| {
            !matches!(warning, Warning::UnsettledPower { .. } | Warning::UnsettledRdf { .. })
        };
        self.realizable && !self.warnings.iter().any(objects)
    }

    /// Why the spectrum is not realizable, in words; none if it is.
    pub fn reason(&self) -> Option<String> {
        let Self { min_power, at_nu, min_g, at_r, .. } = self;
        if self.realizable {
            None
        } else if *min_power < -ROUNDING {
            Some(format!(
                "the power would be {} at {at_nu:.3} cycles per unit",
                legible(*min_power)
            ))
        } else {
            Some(format!("the RDF would be {} at the distance {at_r:.5}", legible(*min_g)))
        }
    }
}

/// With four decimals, or as many as show that it isn't 0.
fn legible(value: f64) -> String {
    if (1e-3..1e6).contains(&value.abs()) { format!("{value:.4}") } else { format!("{value:.2e}") }
}

/// Over a grid that holds both ends of every annulus and its middle, and more finely around the least
/// of these.
fn least_power(target: &Target) -> (f64, f64) {
    let bounds = target.annuli();
    let least = |least: (f64, f64), nu: f64| {
        let power = target.power(nu);
        if power < least.0 { (power, nu) } else { least }
    };
    let middles = bounds.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
    let coarse = bounds.iter().copied().chain(middles).fold((1.0, target.end()), least);
    let above = bounds.partition_point(|&bound| bound <= coarse.1).min(bounds.len() - 1);
    let gap = bounds[above] - bounds[above.saturating_sub(1)];
    let around = (-20..=20).map(|i| (coarse.1 + gap * f64::from(i) / 20.0).max(0.0));
    around.fold(coarse, least)
}

/// The least g less its tolerance: (g, r, tolerance).
fn least_g(target: &Target) -> (f64, f64, f64) {
    let root = target.density().points_per_unit_area().sqrt();
    let finest = 1.0 / (STEPS * root).max(10.0 * target.end());
    let range = (REACH / root).max(0.5);
    let count = (range / finest).min(MOST_RADII) as u32;
    let reached = f64::from(count) * finest;
    let mut radii: Vec<f64> = (0..=count).map(|i| f64::from(i) * finest).collect();
    if range - reached > finest {
        let far = |i: u32| reached + (range - reached) * f64::from(i) / f64::from(FAR_RADII);
        radii.extend((1..=FAR_RADII).map(far));
    }
    radii.extend(target.rdf_abscissae());
    let margins = |radii: &[f64]| -> (f64, f64, f64) {
        let (g, error) = (target.rdf(radii), target.rdf_uncertainty(radii));
        let all = radii.iter().zip(&g).zip(&error).map(|((&r, &g), &error)| (g, r, error));
        all.min_by(|a, b| (a.0 + a.2).total_cmp(&(b.0 + b.2))).unwrap_or((1.0, 0.0, 0.0))
    };
    let coarse = margins(&radii);
    let around: Vec<f64> =
        (-20..=20).map(|i| (coarse.1 + finest * f64::from(i) / 20.0).max(0.0)).collect();
    let fine = margins(&around);
    if fine.0 + fine.2 < coarse.0 + coarse.2 { fine } else { coarse }
}

/// Up to where there is no power, and whether that is too far.
fn empty_region(target: &Target) -> Option<Warning> {
    let n = target.density().points_per_unit_area();
    let bounds = target.annuli();
    let middle = |pair: &[f64]| target.power(0.5 * (pair[0] + pair[1]));
    let loud = bounds.windows(2).position(|pair| middle(pair) >= EMPTY);
    let edge = bounds[loud.unwrap_or(bounds.len() - 1)];
    let (hexagonal, stealthy) = ((2.0 * n / 3.0_f64.sqrt()).sqrt(), (2.0 * n / PI).sqrt());
    if edge > hexagonal * (1.0 + 1e-9) {
        Some(Warning::BeyondHexagonal { edge, limit: hexagonal })
    } else if edge > stealthy {
        Some(Warning::Stealthy { edge, limit: stealthy })
    } else {
        None
    }
}

/// A curve that stops too early.
fn unsettled(target: &Target) -> Option<Warning> {
    target.unsettled().map(|(is_rdf, end, deviation)| {
        if is_rdf {
            Warning::UnsettledRdf { end, deviation }
        } else {
            Warning::UnsettledPower { end, deviation }
        }
    })
}

/// The disk whose number variance is the farthest below its bound, if any is.
fn number_variance(target: &Target) -> Option<Warning> {
    let lack = |warning: &Warning| match *warning {
        Warning::NumberVariance { variance, bound, .. } => bound - variance,
        _ => 0.0,
    };
    let n = target.density().points_per_unit_area();
    let warning = |(radius, variance): (f64, f64)| {
        let theta = (n * PI * radius * radius).fract();
        Warning::NumberVariance { radius, variance, bound: theta * (1.0 - theta) }
    };
    let all = variances(target).into_iter().map(warning);
    all.max_by(|a, b| lack(a).total_cmp(&lack(b))).filter(|worst| lack(worst) > LACK)
}

/// Radii up to 3.5/√n and the variances of the number of points in disks of these:
/// σ²(R) = n ∫ P (R J₁(2πRν)/ν)² 2πν dν, and nπR² for P = 1.
fn variances(target: &Target) -> Vec<(f64, f64)> {
    let n = target.density().points_per_unit_area();
    // What disks of these sizes see of higher frequencies is next to nothing.
    let end = target.end().min(100.0 * n.sqrt());
    let largest = 3.5 / n.sqrt();
    // J₁² turns twice as fast as J₁.
    let breaks = if end > 0.0 { bounded(target, end) } else { Vec::new() };
    let nodes = panels::nodes(&breaks, 2.0 * largest);
    let masses: Vec<f64> =
        nodes.iter().map(|&(nu, w)| TAU * w * nu * (target.power(nu) - 1.0)).collect();
    let variance = |i: i32| {
        let radius = largest * f64::from(i) / 350.0;
        let x: Vec<f64> = nodes.iter().map(|(nu, _)| TAU * radius * nu).collect();
        let mut disk = vec![0.0; x.len()];
        j1_slice(&x, &mut disk);
        let parts = masses.iter().zip(&nodes).zip(&disk);
        let sum: f64 = parts.map(|((m, (nu, _)), j1)| m * (radius * j1 / nu).powi(2)).sum();
        (radius, n * (PI * radius * radius + sum))
    };
    (30..=350).into_par_iter().map(variance).collect()
}

/// Break points for a quadrature of P up to `end`: where it may jump or have a kink.
fn bounded(target: &Target, end: f64) -> Vec<f64> {
    let mut breaks: Vec<f64> =
        target.breaks().into_iter().filter(|&b| b > 0.0 && b < end).collect();
    breaks.dedup();
    std::iter::once(0.0).chain(breaks).chain([end]).collect()
}

/// Which members of a family of spectra with two parameters are realizable: the smaller of the two
/// margins, min P and min g, for each `x` and `y`, row by row of equal `y`.
///
/// NaN where `family` gives no target.
pub fn feasible_region(
    xs: &[f64],
    ys: &[f64],
    family: impl Fn(f64, f64) -> Option<Target> + Sync,
) -> Vec<f64> {
    let margin = |i: usize| {
        let target = family(xs[i % xs.len()], ys[i / xs.len()])?;
        Some(least_power(&target).0.min(least_g(&target).0))
    };
    (0..xs.len() * ys.len()).into_par_iter().map(|i| margin(i).unwrap_or(f64::NAN)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SinglePeak;
    use bn_core::Density;

    /// Against midpoint sums in steps of 1/20,000 of the range, which no panel knows of.
    #[test]
    fn variances_are_those_of_plain_sums() {
        let density = Density::new(400);
        let ramp = [(0.0, 0.2), (11.0, 0.0), (14.0, 1.9), (14.3, 0.6), (40.0, 1.0)];
        let peak = SinglePeak { nu0: 14.0, peak: 3.0, sigma: 0.7, width: 0.5 };
        for target in [
            Target::power_curve(density, &[(0.0, 1.0), (9.0, 1.0)]),
            Target::step(density, 11.0),
            Target::single_peak(density, peak),
            Target::power_curve(density, &ramp),
        ] {
            let target = target.expect("valid");
            let step = target.end().max(1.0) / 20_000.0;
            for (radius, variance) in variances(&target).into_iter().step_by(40) {
                let part = |i: u32| {
                    let nu = step * (f64::from(i) + 0.5);
                    let disk = radius * crate::j1(TAU * radius * nu) / nu;
                    TAU * nu * step * (target.power(nu) - 1.0) * disk * disk
                };
                let sum: f64 = (0..20_000).map(part).sum();
                let want = 400.0 * (PI * radius * radius + sum);
                assert!((variance - want).abs() < 1e-5 * want, "{variance}, not {want}, {radius}");
            }
        }
    }
}
