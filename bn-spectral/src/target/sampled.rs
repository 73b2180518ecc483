//! Targets given by samples of P or of g.

use std::f64::consts::TAU;

use bn_core::Density;
use rayon::prelude::*;

use super::annuli::{Annuli, Ramps, cells, steps_between};
use crate::bessel::j0_slice_alike;

/// A curve counts as settled at 1 if its last tenth is this close to it.
const SETTLED: f64 = 1e-3;
/// The deviation of the Gaussian that tapers a measured spectrum, in ends of it: at the end e^−4.5.
const TAPER: f64 = 1.0 / 3.0;
/// The spectrum of an RDF is tabulated up to this times √n …
const HIGHEST: f64 = 16.0;
/// … in steps of √n over this.
const STEPS: f64 = 256.0;

/// Samples of P at ascending frequencies.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PowerSamples {
    nu: Vec<f64>,
    power: Vec<f64>,
    /// Where P was measured: by ring, the number of modes a point times P's standard deviation.
    noise: Option<Vec<f64>>,
}

impl PowerSamples {
    pub(super) fn new(samples: &[(f64, f64)]) -> Self {
        let (nu, power) = samples.iter().copied().unzip();
        Self { nu, power, noise: None }
    }

    /// Samples that have statistical errors: see the field.
    pub(super) fn measured(samples: &[(f64, f64)], noise: Vec<f64>) -> Self {
        Self { noise: Some(noise), ..Self::new(samples) }
    }

    pub(super) fn end(&self) -> f64 {
        self.nu[self.nu.len() - 1]
    }

    /// Bounds of annuli over which P varies little at density `n`; abscissae are among them.
    pub(super) fn bounds(&self, n: f64) -> Vec<f64> {
        if self.is_measured() { cells(&self.nu) } else { self.ramps(n).bounds }
    }

    /// Where P may have a jump or a kink.
    pub(super) fn breaks(&self) -> Vec<f64> {
        if self.is_measured() { cells(&self.nu) } else { self.nu.clone() }
    }

    /// P − 1 of a curve that wasn't measured.
    fn ramps(&self, n: f64) -> Ramps {
        let excess: Vec<f64> = self.power.iter().map(|p| p - 1.0).collect();
        Ramps::new(&self.nu, &excess, n.sqrt())
    }

    /// Linear between the samples; of measured rings the mean of the ring at hand, so that means over
    /// rings are what they were: a line through them would cut the tops off narrow peaks.
    pub(super) fn power(&self, nu: f64) -> f64 {
        if nu > self.end() {
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
            return self.ramps(n).annuli().rdf(n, r);
        }
        let excess: Vec<f64> =
            self.nu.iter().zip(&self.power).map(|(nu, p)| (p - 1.0) * self.taper(*nu)).collect();
        Annuli::new(&cells(&self.nu), &excess).rdf(n, r)
    }

    fn taper(&self, nu: f64) -> f64 {
        if unsettled(&self.power).is_none() {
            1.0
        } else {
            libm::exp(-0.5 * (nu / (TAPER * self.end())).powi(2))
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
        let excess: Vec<f64> = g.iter().map(|g| g - 1.0).collect();
        let nu = steps_between(0.0, HIGHEST * n.sqrt(), n.sqrt() / STEPS);
        let mut power = Ramps::new(&r, &excess, 1.0 / n.sqrt()).annuli().transform(&nu);
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

    pub(super) fn power(&self, nu: f64) -> f64 {
        let position = nu / self.step;
        let i = position as usize;
        if i + 1 >= self.power.len() {
            return 1.0;
        }
        let t = position - i as f64;
        self.power[i] * (1.0 - t) + self.power[i + 1] * t
    }

    pub(super) fn rdf(&self, r: f64) -> f64 {
        if r > self.farthest() { 1.0 } else { interpolate(&self.r, &self.g, r) }
    }
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
