//! RDF → radial power and back, windowed as in the thesis (§5.2.2).

use std::f64::consts::TAU;

use bn_core::{Curve, Density};

use crate::{BesselSums, Window, j0_slice};

/// Bins of the RDF and frequencies of the spectrum, each, per √n.
const SAMPLES_PER_ROOT: f64 = 100.0;
/// Frequencies up to √n/2: the resolution is a 200th of √n.
const SAMPLES_TO_NYQUIST: f64 = 100.0;

/// The radial power spectrum of an RDF, as the thesis computes its printed statistics:
///
/// P(ν) = 1 + 2πn ∫ r (g(r) − 1) J₀(2πνr) w(r) dr,
///
/// by the trapezoid rule at the lower edges r = i·Δr of the RDF's bins over [0, ½), at the
/// frequencies ν = j·√n/200 for j < 100·√n, with [`Window::THESIS`] of half-width
/// ½·clamp(4ν/√n, 0.2, 0.5): at low frequencies, where noise does not average out, g counts only
/// nearby. (The printed equation lacks n and r; the delta at ν = 0 is left out.)
///
/// Two deliberate roundings where n is no square: the number of frequencies (and of default bins) is
/// 100·√n to the nearest integer, and √n/200 is that number over 20000. P is an estimate and can
/// come out a little below 0; the thesis's program takes its absolute value.
///
/// The plan serves any number of curves. Error of the sums against the same sums in exact
/// arithmetic: 4e-12·2πn∫ r |g − 1| w dr. Cost at n = 4096: about 3 ms a curve and as much for the
/// plan, growing like √n·log n.
pub struct RdfToPower {
    density: Density,
    bins: usize,
    step: f64,
    frequencies: usize,
    /// 2πn r w(r) Δr of the constant window, by bin.
    weights: Vec<f64>,
    sums: BesselSums,
    /// The whole kernel, a row a frequency, where the window still widens.
    low: Vec<f64>,
}

impl RdfToPower {
    /// The number of bins on [0, ½) that the thesis uses: 100·√n, rounded.
    ///
    /// # Panics
    /// If `points` is 0.
    pub fn default_bins(points: usize) -> usize {
        assert!(points > 0, "an empty set has no spectrum");
        (SAMPLES_PER_ROOT * (points as f64).sqrt()).round() as usize
    }

    /// The plan for sets of `points` points and RDFs of `bins` bins on [0, ½).
    ///
    /// # Panics
    /// If `points` or `bins` is 0, or one of the grids exceeds 2²⁶.
    pub fn new(points: usize, bins: usize) -> Self {
        assert!(bins > 0, "an RDF has at least one bin");
        let density = Density::new(points);
        let frequencies = Self::default_bins(points);
        let step = frequencies as f64 / (2.0 * SAMPLES_PER_ROOT * SAMPLES_TO_NYQUIST);
        let dr = 0.5 / bins as f64;
        // Nothing beyond the widest window, 0.25, is ever used.
        let used = bins.div_ceil(2);
        let radius: Vec<f64> = (0..used).map(|i| i as f64 * dr).collect();
        let weight = |half_width: f64, r: f64| {
            TAU * density.points_per_unit_area() * r * dr * Window::THESIS.at(r, half_width)
        };
        let weights = radius.iter().map(|&r| weight(0.25, r)).collect();
        let (mut low, mut x, mut bessel) = (vec![], vec![0.0; used], vec![0.0; used]);
        let widening = (0..frequencies).map(|j| j as f64 * step);
        for nu in widening.take_while(|&nu| half_width(nu, density) < 0.25) {
            for (x, r) in x.iter_mut().zip(&radius) {
                *x = TAU * nu * r;
            }
            j0_slice(&x, &mut bessel);
            let weight = |(&r, j0): (&f64, &f64)| j0 * weight(half_width(nu, density), r);
            low.extend(radius.iter().zip(&bessel).map(weight));
        }
        let sums = BesselSums::new(used, frequencies, dr * step);
        Self { density, bins, step, frequencies, weights, sums, low }
    }

    /// P(ν) of the RDF `g`, whose bins start at 0.
    ///
    /// # Panics
    /// If `g` does not have the planned bins on [0, ½).
    pub fn power(&self, g: &Curve) -> Curve {
        let range = g.step() * self.bins as f64;
        assert!(
            g.values().len() == self.bins && g.start() == 0.0 && (range - 0.5).abs() < 1e-9,
            "an RDF of {} bins to {range} from {} for {} bins to 0.5",
            g.values().len(),
            g.start(),
            self.bins
        );
        let excess = g.values().iter().map(|g| g - 1.0);
        let c: Vec<f64> = self.weights.iter().zip(excess.clone()).map(|(w, e)| w * e).collect();
        let mut power = vec![0.0; self.frequencies];
        self.sums.apply_into(&c, &mut power, &mut self.sums.scratch());
        for (power, row) in power.iter_mut().zip(self.low.chunks_exact(self.weights.len())) {
            *power = row.iter().zip(excess.clone()).map(|(kernel, e)| kernel * e).sum();
        }
        for power in &mut power {
            *power += 1.0;
        }
        Curve::new(0.0, self.step, power)
    }

    /// The density that frequencies refer to.
    pub fn density(&self) -> Density {
        self.density
    }
}

/// Of the window at frequency `nu`.
fn half_width(nu: f64, density: Density) -> f64 {
    0.5 * (2.0 * nu / density.grid_nyquist()).clamp(0.2, 0.5)
}

/// The RDF of a radial power spectrum, the inverse of [`RdfToPower`] by the same ideas:
///
/// g(r) = 1 + (2π/n) ∫ ν (P(ν) − 1) J₀(2πνr) w(ν) dν
///
/// by the trapezoid rule with its end correction at ν = 0, and [`Window::BLACKMAN`] over all samples
/// of P, which must start at ν = 0. Features of g are blurred over ±1.5 of the reciprocal end of
/// the samples; the lattice repeats g after 1/Δν, so Δν ≤ 1 keeps the aliases of [0, ½) away.
///
/// Of a P that itself came out of [`RdfToPower`] it gives 1 + w(r)(g(r) − 1), blurred: the window of
/// that direction stays.
pub struct PowerToRdf {
    frequencies: usize,
    step: f64,
    bins: usize,
    /// (2π/n) ν w(ν) Δν.
    weights: Vec<f64>,
    sums: BesselSums,
}

impl PowerToRdf {
    /// The plan for a spectrum of `frequencies` samples at ν = j·`step` cycles per unit and an RDF
    /// at r = i/(2·`bins`), i < `bins`.
    ///
    /// # Panics
    /// If a count is 0 or above 2²⁶ or `step` is not a positive number.
    pub fn new(density: Density, frequencies: usize, step: f64, bins: usize) -> Self {
        let sums = BesselSums::new(frequencies, bins, step * 0.5 / bins as f64);
        let scale = TAU / density.points_per_unit_area() * step * step;
        let half_width = frequencies as f64;
        let mut weights: Vec<f64> = (0..frequencies)
            .map(|j| scale * j as f64 * Window::BLACKMAN.at(j as f64, half_width))
            .collect();
        // Euler–Maclaurin: the rule misses Δν²/12 times the slope of ν(P − 1)w J₀ at 0.
        weights[0] = scale / 12.0;
        Self { frequencies, step, bins, weights, sums }
    }

    /// g(r) of the spectrum `power`.
    ///
    /// # Panics
    /// If `power` does not have the planned samples.
    pub fn rdf(&self, power: &Curve) -> Curve {
        let close = (power.step() / self.step - 1.0).abs() < 1e-9;
        assert!(
            power.values().len() == self.frequencies && power.start() == 0.0 && close,
            "a spectrum of {} samples from {} by {} for {} by {}",
            power.values().len(),
            power.start(),
            power.step(),
            self.frequencies,
            self.step
        );
        let excess = power.values().iter().map(|p| p - 1.0);
        let c: Vec<f64> = self.weights.iter().zip(excess).map(|(w, e)| w * e).collect();
        let mut g = vec![0.0; self.bins];
        self.sums.apply_into(&c, &mut g, &mut self.sums.scratch());
        Curve::new(0.0, 0.5 / self.bins as f64, g.iter().map(|g| 1.0 + g).collect())
    }
}
