//! Single-peak blue noise: a smoothed step with a peak at its edge.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use bn_core::{Curve, Density};

use super::annuli::{Annuli, steps_between};
use super::{TargetError, check};
use crate::{HankelPlan, panels};

/// Standard deviations from its centre beyond which a Gaussian counts as 0: 1.1e-19 of it is there.
const REACH: f64 = 9.0;
/// Oscillations of a Bessel function over the slopes of P from which on the faster of two quadratures,
/// in steps of σ over this, …
const STEPS: f64 = 4.0;
/// … takes the place of the more accurate one.
const MANY_TURNS: f64 = 100.0;
/// A Gaussian narrower than this part of ν₀ + width counts as none: it changes g by less than its
/// square.
const SHARP: f64 = 1e-8;
/// The thesis's parameters belong to this many points …
const REFERENCE_POINTS: f64 = 4096.0;

/// P = G ⋆ (H(ν − ν₀) + p₀·box(ν)): a step at ν₀ and above it a box of area p₀ on
/// [ν₀, ν₀ + width), smoothed along ν by a Gaussian of deviation σ (thesis §5.3.3, where the box is
/// a Dirac peak; the authors' program uses a box). All in cycles per unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SinglePeak {
    /// ν₀ ≥ 0.
    pub nu0: f64,
    /// p₀ ≥ 0, the power of the peak in excess of the step: (height − 1)·width.
    pub peak: f64,
    /// σ ≥ 0 of the Gaussian.
    pub sigma: f64,
    /// Width of the box before smoothing, above 0.
    pub width: f64,
}

impl SinglePeak {
    /// The thesis's reference pattern, figure 5.7 d: at 4096 points 60 cycles, height 20 over one
    /// cycle, σ = 2.5 cycles; at n points all of them times √(n/4096). It is not realizable: what a
    /// point set can reach is near it.
    pub fn thesis(density: Density) -> Self {
        let scale = (density.points_per_unit_area() / REFERENCE_POINTS).sqrt();
        Self { nu0: 60.0 * scale, peak: 19.0 * scale, sigma: 2.5 * scale, width: scale }
    }

    /// P(ν).
    pub fn power(self, nu: f64) -> f64 {
        let step = self.smoothed_step(nu - self.nu0);
        step + self.peak / self.width * (step - self.smoothed_step(nu - self.nu0 - self.width))
    }

    /// The spectrum as the authors' program tabulates it: in bins of half a cycle over [0, n/2), the
    /// two bins from `nu0` (a whole number of cycles) on have `height`, then all is smoothed by a
    /// Gaussian of `sigma_bins` bins. Abscissae are the bins' lower edges; as a target, values belong to
    /// the bins' middles:
    ///
    /// ```
    /// use bn_core::Density;
    /// use bn_spectral::{SinglePeak, Target};
    ///
    /// let density = Density::new(4096);
    /// let table = SinglePeak::tabulated(density, 60, 20.0, 5.0);
    /// let samples: Vec<(f64, f64)> = table.iter().map(|(nu, p)| (nu + 0.25, p)).collect();
    /// let target = Target::power_curve(density, &samples)?;
    /// let ours = SinglePeak::thesis(density);
    /// assert!((target.power(62.0) - ours.power(62.0)).abs() < 0.02);
    /// # Ok::<(), bn_spectral::TargetError>(())
    /// ```
    ///
    /// # Panics
    /// If `sigma_bins` is negative or not finite.
    pub fn tabulated(density: Density, nu0: u32, height: f64, sigma_bins: f64) -> Curve {
        let bins = density.points_per_unit_area().max(2.0) as usize;
        let value = |nu: f64| {
            let above = nu - f64::from(nu0);
            if above < 0.0 {
                0.0
            } else if above < 1.0 {
                height
            } else {
                1.0
            }
        };
        Curve::sample(0.0, 0.5, bins, value).smoothed(0.5 * sigma_bins)
    }

    /// H smoothed, at `x` above its edge.
    fn smoothed_step(self, x: f64) -> f64 {
        if self.sigma > 0.0 {
            0.5 * libm::erfc(-x / self.sigma * FRAC_1_SQRT_2)
        } else {
            f64::from(x >= 0.0)
        }
    }

    pub(super) fn check(self) -> Result<(), TargetError> {
        check("nu0", self.nu0, 0.0, "it must be 0 or a positive frequency, below 1e9")?;
        check("peak", self.peak, 0.0, "the peak's power must be 0 or positive, below 1e9")?;
        check("sigma", self.sigma, 0.0, "a Gaussian's width must be 0 or positive, below 1e9")?;
        check("width", self.width, f64::MIN_POSITIVE, "a peak needs a width, below 1e9")
    }

    /// Where P is neither 0 nor 1.
    pub(super) fn band(self) -> (f64, f64) {
        let reach = REACH * self.sigma;
        ((self.nu0 - reach).max(0.0), self.nu0 + self.width + reach)
    }

    /// Whether the Gaussian is so narrow that it doesn't matter to g.
    fn is_sharp(self) -> bool {
        self.sigma <= SHARP * (self.nu0 + self.width)
    }

    /// Where P isn't constant: around both ends of the box, or one band if these meet.
    fn slopes(self) -> Vec<(f64, f64)> {
        let (from, to) = self.band();
        let reach = REACH * self.sigma;
        let (below, above) = (self.nu0 + reach, self.nu0 + self.width - reach);
        if below < above { vec![(from, below), (above, to)] } else { vec![(from, to)] }
    }

    /// Bounds of annuli fine enough for P to count as constant on each: jumps, and 16 to σ.
    pub(super) fn bounds(self) -> Vec<f64> {
        let mut bounds = vec![0.0];
        if self.is_sharp() {
            bounds.extend([self.nu0, self.nu0 + self.width]);
        } else {
            for (from, to) in self.slopes() {
                bounds.extend(steps_between(from, to, self.sigma / 16.0));
            }
        }
        bounds.dedup();
        bounds
    }

    /// g(r) at density `n`: annuli where P is constant, quadrature in between. To about 1e-12 of the
    /// slopes' share, or 1e-9 where σ is many times 1/r,
    /// or what annuli of σ/16 make of it where even that takes too long.
    pub(super) fn rdf(self, n: f64, r: &[f64]) -> Vec<f64> {
        let top = self.peak / self.width;
        if self.is_sharp() {
            return Annuli::new(&[0.0, self.nu0, self.nu0 + self.width], &[-1.0, top]).rdf(n, r);
        }
        let slopes = self.slopes();
        let length: f64 = slopes.iter().map(|(from, to)| to - from).sum();
        let farthest = r.iter().copied().fold(0.0, f64::max);
        let is_long = length * farthest > MANY_TURNS;
        if panels::count(&[0.0, length], farthest) > panels::MOST_NODES {
            return Annuli::of(&self.bounds(), |nu| self.power(nu) - 1.0).rdf(n, r);
        }
        let mut g = match slopes[..] {
            [(from, below), (above, _)] => {
                Annuli::new(&[0.0, from, below, above], &[-1.0, 0.0, top]).rdf(n, r)
            }
            _ => Annuli::new(&[0.0, slopes[0].0], &[-1.0]).rdf(n, r),
        };
        for (from, to) in slopes {
            let excess = |nu: f64| self.power(nu) - 1.0;
            let bands = if is_long {
                panels::transform(&steps_between(from, to, self.sigma / STEPS), excess, r)
            } else {
                // The Gaussian is as smooth as 16 Gauss nodes can be asked for over 2σ.
                HankelPlan::alike(&[from, to], PI / 2.0 * self.sigma, r).transform(excess)
            };
            for (g, band) in g.iter_mut().zip(bands) {
                *g += band / n;
            }
        }
        g
    }
}
