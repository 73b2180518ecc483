//! Targets given by samples of P or of g.

use std::f64::consts::TAU;

use bn_core::Density;
use rayon::prelude::*;

use super::annuli::{Annuli, Ramps, cells};
use crate::bessel::j0_slice_alike;
use crate::panels;

/// A curve counts as settled at 1 if its last tenth is this close to it.
const SETTLED: f64 = 1e-3;
/// The deviation of the Gaussian that tapers a measured spectrum, in ends of it: at the end e^−4.5.
const TAPER: f64 = 1.0 / 3.0;
/// The spectrum of an RDF is tabulated up to this times √n, or where that takes too long to this
/// at least …
const HIGHEST: [f64; 2] = [16.0, 2.0];
/// … in steps of √n over this, …
const STEPS: f64 = 256.0;
/// … and this many to a turn of the fastest oscillation, that of the last distance: cubics between
/// them are good to 4e-5 of its amplitude, …
const PER_TURN: f64 = 32.0;
/// … but in so many at most: of curves that reach even farther only the trend is tabulated.
const MOST_STEPS: f64 = 262_144.0;
/// Values of J₀ that the table may take: about two seconds.
const MOST_WORK: f64 = 4e8;
/// The part of its transform that the end of a curve may take away without being looked at.
const NOTHING: f64 = 1e-10;

/// Samples of P at ascending frequencies.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PowerSamples {
    nu: Vec<f64>,
    power: Vec<f64>,
    /// From where on P = 1, but for what doesn't matter to g.
    end: f64,
    /// Where P was measured: by ring, the number of modes a point times P's standard deviation.
    noise: Option<Vec<f64>>,
}

impl PowerSamples {
    pub(super) fn new(density: Density, samples: &[(f64, f64)]) -> Self {
        let (nu, power): (Vec<f64>, Vec<f64>) = samples.iter().copied().unzip();
        let end = settled_end(&nu, &power, density.points_per_unit_area());
        Self { nu, power, end, noise: None }
    }

    /// Samples that have statistical errors: see the field.
    pub(super) fn measured(density: Density, samples: &[(f64, f64)], noise: Vec<f64>) -> Self {
        Self { noise: Some(noise), ..Self::new(density, samples) }
    }

    pub(super) fn end(&self) -> f64 {
        self.end
    }

    /// The last frequency.
    pub(super) fn farthest(&self) -> f64 {
        self.nu[self.nu.len() - 1]
    }

    /// Bounds of annuli over which P varies little at density `n`; abscissae are among them.
    pub(super) fn bounds(&self, n: f64) -> Vec<f64> {
        if self.is_measured() { cells(&self.nu) } else { self.ramps(n).bounds }
    }

    /// Where P may have a jump or a kink.
    pub(super) fn breaks(&self) -> Vec<f64> {
        if self.is_measured() { cells(&self.nu) } else { from_zero(&self.nu) }
    }

    /// P − 1 of a curve that wasn't measured.
    fn ramps(&self, n: f64) -> Ramps {
        let excess: Vec<f64> = self.power.iter().map(|p| p - 1.0).collect();
        Ramps::new(&self.nu, &excess, n.sqrt())
    }

    /// Linear between the samples; of measured rings the mean of the ring at hand, so that means over
    /// rings are what they were: a line through them would cut the tops off narrow peaks.
    pub(super) fn power(&self, nu: f64) -> f64 {
        if nu > self.farthest() {
            1.0
        } else if self.is_measured() {
            nearest(&self.nu, &self.power, nu)
        } else {
            interpolate(&self.nu, &self.power, nu)
        }
    }

    pub(super) fn is_measured(&self) -> bool {
        self.noise.is_some()
    }

    /// By how much the last tenth of the samples is away from 1 where it should have settled; nothing
    /// is known of measured spectra beyond their ends.
    pub(super) fn unsettled(&self) -> Option<f64> {
        if self.is_measured() { None } else { unsettled(&self.power) }
    }

    /// g, of annuli. Of a measured spectrum that doesn't settle at 1 before its end P − 1 is tapered by
    /// a Gaussian: what lies beyond is unknown and not 1. g is then smoothed by a Gaussian too, which
    /// can't make it negative where it wasn't.
    pub(super) fn rdf(&self, n: f64, r: &[f64]) -> Vec<f64> {
        if !self.is_measured() {
            let (breaks, farthest) = (from_zero(&self.nu), r.iter().copied().fold(0.0, f64::max));
            if panels::count(&breaks, farthest) > panels::MOST_NODES {
                return self.ramps(n).annuli().rdf(n, r);
            }
            let mut g = panels::transform(&breaks, |nu| self.power(nu) - 1.0, r);
            for g in &mut g {
                *g = 1.0 + *g / n;
            }
            return g;
        }
        let excess: Vec<f64> =
            self.nu.iter().zip(&self.power).map(|(nu, p)| (p - 1.0) * self.taper(*nu)).collect();
        Annuli::new(&cells(&self.nu), &excess).rdf(n, r)
    }

    /// P − 1 as [`Self::rdf`] takes it.
    pub(super) fn tapered(&self, nu: f64) -> f64 {
        let excess = self.power(nu) - 1.0;
        if self.is_measured() { excess * self.taper(nu) } else { excess }
    }

    fn taper(&self, nu: f64) -> f64 {
        if unsettled(&self.power).is_none() {
            1.0
        } else {
            libm::exp(-0.5 * (nu / (TAPER * self.farthest())).powi(2))
        }
    }

    /// Five standard deviations of g(r) = 1 + Σ m (P − 1) J₀(2πνr)/n over rings of m modes.
    pub(super) fn rdf_uncertainty(&self, r: &[f64]) -> Vec<f64> {
        let Some(noise) = &self.noise else { return vec![0.0; r.len()] };
        let uncertainty = |&r: &f64| {
            let x: Vec<f64> = self.nu.iter().map(|nu| TAU * nu * r).collect();
            let mut bessel = vec![0.0; x.len()];
            j0_slice_alike(&x, &mut bessel);
            let terms = noise.iter().zip(&self.nu).zip(&bessel);
            5.0 * terms.map(|((w, nu), j0)| (w * self.taper(*nu) * j0).powi(2)).sum::<f64>().sqrt()
        };
        r.par_iter().map(uncertainty).collect()
    }
}

/// Samples of g at ascending radii, and the spectrum that belongs to it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RdfSamples {
    r: Vec<f64>,
    g: Vec<f64>,
    /// P in equal steps from 0.
    step: f64,
    power: Vec<f64>,
}

impl RdfSamples {
    pub(super) fn new(density: Density, samples: &[(f64, f64)]) -> Self {
        let n = density.points_per_unit_area();
        let (r, g): (Vec<f64>, Vec<f64>) = samples.iter().copied().unzip();
        // What lies beyond says nothing, and would only make the table finer.
        let end = settled_end(&r, &g, 1.0 / n);
        let breaks: Vec<f64> = from_zero(&r).into_iter().filter(|&r| r <= end).collect();
        if breaks.len() < 2 {
            return Self { r, g, step: n.sqrt(), power: vec![1.0; 2] };
        }
        let nu = table(&breaks, n.sqrt());
        let work = nu.len() as f64 * panels::count(&breaks, nu[nu.len() - 1]);
        let mut power = if work > 4.0 * MOST_WORK {
            let excess: Vec<f64> = g.iter().map(|g| g - 1.0).collect();
            Ramps::new(&r, &excess, 1.0 / n.sqrt()).annuli().transform(&nu)
        } else {
            panels::transform(&breaks, |at| interpolate(&r, &g, at) - 1.0, &nu)
        };
        for power in &mut power {
            *power = 1.0 + n * *power;
        }
        Self { r, g, step: nu[1], power }
    }

    /// By how much the last tenth of the samples is away from 1 where it should have settled.
    pub(super) fn unsettled(&self) -> Option<f64> {
        unsettled(&self.g)
    }

    /// The radii.
    pub(super) fn abscissae(&self) -> &[f64] {
        &self.r
    }

    /// The last radius.
    pub(super) fn farthest(&self) -> f64 {
        self.r[self.r.len() - 1]
    }

    pub(super) fn end(&self) -> f64 {
        self.step * (self.power.len() - 1) as f64
    }

    /// The frequencies of the table.
    pub(super) fn frequencies(&self) -> Vec<f64> {
        (0..self.power.len()).map(|i| self.step * i as f64).collect()
    }

    /// By a cubic through four neighbours; the spectrum is even.
    pub(super) fn power(&self, nu: f64) -> f64 {
        let position = nu / self.step;
        let (i, last) = (position as usize, self.power.len() - 1);
        if i >= last {
            return 1.0;
        }
        let t = position - i as f64;
        let before = self.power[if i == 0 { 1 } else { i - 1 }];
        let (here, next, after) = (self.power[i], self.power[i + 1], self.power[last.min(i + 2)]);
        let (s, t1, t2) = (1.0 - t, 1.0 + t, 2.0 - t);
        0.5 * s * t2 * (here * t1 - before * t / 3.0) + 0.5 * t * t1 * (next * t2 - after * s / 3.0)
    }

    pub(super) fn rdf(&self, r: f64) -> f64 {
        if r > self.farthest() { 1.0 } else { interpolate(&self.r, &self.g, r) }
    }
}

/// The frequencies at which the spectrum of a g with samples at `r` is tabulated, at a density of
/// `root`².
fn table(breaks: &[f64], root: f64) -> Vec<f64> {
    let fine = (1.0 / (PER_TURN * breaks[breaks.len() - 1])).min(root / STEPS);
    let is_too_much = |highest: f64| {
        let steps = highest / fine;
        steps > MOST_STEPS || steps * panels::count(breaks, highest) > 2.0 * MOST_WORK
    };
    let mut highest = HIGHEST[0] * root;
    while is_too_much(highest) && highest > HIGHEST[1] * root {
        highest *= 0.9;
    }
    let step = if is_too_much(highest) {
        highest = HIGHEST[0] * root;
        root / STEPS
    } else {
        fine
    };
    let count = (highest / step).ceil().max(1.0) as usize;
    (0..=count).map(|i| highest * i as f64 / count as f64).collect()
}

/// From where on a curve with these samples is 1, but for less than `NOTHING` of its transform: of P,
/// g with `unit` = n, and the reverse with 1/n. 0 if it is 1 all along.
fn settled_end(x: &[f64], y: &[f64], unit: f64) -> f64 {
    let mut rest = 0.0;
    for i in (0..x.len() - 1).rev() {
        let excess = (y[i] - 1.0).abs().max((y[i + 1] - 1.0).abs());
        rest += TAU / unit * x[i + 1] * (x[i + 1] - x[i]) * excess;
        if rest > NOTHING {
            return x[i + 1];
        }
    }
    let first = TAU / unit * x[0] * x[0] * (y[0] - 1.0).abs();
    if rest + first > NOTHING { x[0] } else { 0.0 }
}

/// The abscissae with 0 before them.
fn from_zero(x: &[f64]) -> Vec<f64> {
    let zero = (x[0] > 0.0).then_some(0.0);
    zero.into_iter().chain(x.iter().copied()).collect()
}

/// The largest distance from 1 in the last tenth, if it is one that matters.
fn unsettled(values: &[f64]) -> Option<f64> {
    let tail = &values[values.len() - values.len().div_ceil(10)..];
    let most = tail.iter().map(|v| (v - 1.0).abs()).fold(0.0, f64::max);
    (most >= SETTLED).then_some(most)
}

/// Linear interpolation between ascending abscissae; the end values outside.
fn interpolate(x: &[f64], y: &[f64], at: f64) -> f64 {
    let after = x.partition_point(|x| *x <= at);
    if after == 0 {
        return y[0];
    }
    if after == x.len() {
        return y[after - 1];
    }
    let t = (at - x[after - 1]) / (x[after] - x[after - 1]);
    y[after - 1] * (1.0 - t) + y[after] * t
}

/// The value at the nearest of ascending abscissae.
fn nearest(x: &[f64], y: &[f64], at: f64) -> f64 {
    let after = x.partition_point(|x| *x <= at).clamp(1, x.len() - 1);
    if at < 0.5 * (x[after - 1] + x[after]) { y[after - 1] } else { y[after] }
}
