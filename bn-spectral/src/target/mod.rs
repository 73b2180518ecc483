//! Spectra to aim at: what a point set's radial power should be, and the RDF that goes with it.

mod annuli;
mod sampled;
mod single_peak;

use bn_core::{Curve, Density, PointSet};
use thiserror::Error;

use crate::{NufftError, PeriodogramOptions, RadialPower, panels, step_rdf};

use annuli::Annuli;
use sampled::{PowerSamples, RdfSamples};
pub use single_peak::SinglePeak;

/// Rings of a spectrum that is to be imitated reach to this times √n …
const IMITATED: f64 = 6.0;
/// … and have this width in cycles per unit. Means over wider rings take contrast from g: over one
/// cycle 4 % at three spacings of 400 points, as a box of width w does by sin(πwr)/(πwr).
const IMITATED_RING: f64 = 0.5;

/// No parameter is larger.
const HIGHEST: f64 = 1e9;

/// Why something is no target.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum TargetError {
    /// A parameter is NaN, infinite or outside its range.
    #[error("{name} is {value}; {need}")]
    Parameter {
        /// The parameter.
        name: &'static str,
        /// What it was.
        value: f64,
        /// What it must be.
        need: &'static str,
    },
    /// A curve has fewer than two samples, or more than [`Target::MAX_SAMPLES`].
    #[error("a curve of {count} samples; a target needs 2 to {}", Target::MAX_SAMPLES)]
    Count {
        /// How many there were.
        count: usize,
    },
    /// An abscissa is negative, not finite, or not above the one before.
    #[error("abscissa {index} is {value}; abscissae must ascend from 0 or more")]
    Abscissa {
        /// Its number from 0.
        index: usize,
        /// What it was.
        value: f64,
    },
    /// A value is not a number, or absurdly large.
    #[error("value {index} is {value:e}; a curve needs numbers within ±1e9")]
    Value {
        /// Its number from 0.
        index: usize,
        /// What it was.
        value: f64,
    },
    /// There is no part to combine, or the parts differ in density.
    #[error("a combination needs parts, all of one density")]
    Parts,
    /// The sets to imitate can't be measured.
    #[error(transparent)]
    Spectrum(#[from] NufftError),
    /// There is no set to imitate, or the sets differ in size.
    #[error("the sets to imitate must be of one size, and at least one")]
    Sets,
}

/// A radial power spectrum P(ν) at density n, ν > 0 in cycles per unit, with P → 1 towards high
/// frequencies, and the RDF g(r) that it is the transform of (thesis eq. 5.3; 5.10):
///
/// g(r) = 1 + (2π/n) ∫ ν (P(ν) − 1) J₀(2πνr) dν,  P(ν) = 1 + 2πn ∫ r (g(r) − 1) J₀(2πνr) dr.
///
/// Closed forms are used where they exist, the step and annuli; else Gauss quadrature: for sampled
/// curves, which are lines between their samples, good to 1e-9 of ∫ ν |P − 1| (of curves that reach beyond
/// thousands of spacings annuli, so narrow that the transform of each line is good to about 1e-6).
///
/// The values decide where matched points lie: they have the same bits on every CPU.
///
/// ```
/// use bn_core::Density;
/// use bn_spectral::{Target, highest_step};
///
/// let density = Density::new(1024);
/// let step = Target::step(density, highest_step(1024.0))?;
/// assert_eq!((step.power(10.0), step.power(20.0)), (0.0, 1.0));
/// assert!(step.rdf(&[0.0])[0].abs() < 1e-15); // just realizable
/// # Ok::<(), bn_spectral::TargetError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    density: Density,
    shape: Shape,
}

#[derive(Clone, Debug, PartialEq)]
enum Shape {
    /// H(ν − ν₀).
    Step(f64),
    Peak(SinglePeak),
    Power(PowerSamples),
    Rdf(Box<RdfSamples>),
    /// 1 + Σ w (P − 1).
    Sum(Vec<(f64, Shape)>),
    Product(Vec<Shape>),
}

impl Target {
    /// The most samples of a curve.
    pub const MAX_SAMPLES: usize = 1 << 17;

    /// Step blue noise, P(ν) = H(ν − ν₀), ν₀ in cycles per unit (thesis eq. 5.12).
    ///
    /// # Errors
    /// If ν₀ is negative or not finite.
    pub fn step(density: Density, nu0: f64) -> Result<Self, TargetError> {
        check("nu0", nu0, 0.0, "the step must lie at 0 or a positive frequency, below 1e9")?;
        Ok(Self { density, shape: Shape::Step(nu0) })
    }

    /// Single-peak blue noise.
    ///
    /// # Errors
    /// If a parameter is out of the range that [`SinglePeak`] states.
    pub fn single_peak(density: Density, peak: SinglePeak) -> Result<Self, TargetError> {
        peak.check()?;
        Ok(Self { density, shape: Shape::Peak(peak) })
    }

    /// The spectrum with samples (ν, P), ν ascending, linear between them; P before the first
    /// sample is that of the first, beyond the last it is 1.
    ///
    /// P may be negative, or end before it has settled at 1, which
    /// [`Realizability`](crate::Realizability) will point out.
    ///
    /// # Errors
    /// If there are too few or many samples, or they aren't finite and ascending.
    pub fn power_curve(density: Density, samples: &[(f64, f64)]) -> Result<Self, TargetError> {
        check_samples(samples)?;
        Ok(Self { density, shape: Shape::Power(PowerSamples::new(density, samples)) })
    }

    /// The spectrum whose RDF has samples (r, g), r ascending in unit lengths; g before the first
    /// sample is that of the first, beyond the last it is 1. Where g doesn't settle at 1 the spectrum
    /// rings, and [`Realizability`](crate::Realizability) warns of it.
    ///
    /// # Errors
    /// As [`Self::power_curve`].
    pub fn rdf_curve(density: Density, samples: &[(f64, f64)]) -> Result<Self, TargetError> {
        check_samples(samples)?;
        Ok(Self { density, shape: Shape::Rdf(Box::new(RdfSamples::new(density, samples))) })
    }

    /// The mean radial power of `sets` in rings of half a cycle up to 6√n, as seen at the density of `points`
    /// points: frequencies scale with its square root (thesis §5.2.3). P is constant on each ring.
    ///
    /// # Errors
    /// If there is no set, the sets differ in size, or there is no point to make.
    pub fn imitating(sets: &[PointSet], points: usize) -> Result<Self, TargetError> {
        let n = sets.first().ok_or(TargetError::Sets)?.len();
        if points == 0 || sets.iter().any(|set| set.len() != n) {
            return Err(TargetError::Sets);
        }
        let density = Density::new(points);
        let limit = (IMITATED * (n as f64).sqrt()).ceil() as usize;
        let options = PeriodogramOptions::new(limit).portable();
        let radial = RadialPower::in_rings(sets, options, IMITATED_RING)?;
        let scale = (points as f64 / n as f64).sqrt();
        let curve = radial.curve().ok_or(TargetError::Sets)?;
        let rings = curve.iter().zip(radial.modes()).filter(|(_, modes)| **modes > 0);
        let ring = |((nu, power), &modes): ((f64, f64), &u64)| {
            // Of R disordered sets a ring of c modes has a mean of variance 2P²/(cR).
            let noise = power * (2.0 * modes as f64 / sets.len() as f64).sqrt() / n as f64;
            ((nu * scale, power), noise)
        };
        let (samples, noise): (Vec<_>, Vec<_>) = rings.map(ring).unzip();
        let measured = PowerSamples::measured(density, &samples, noise);
        Ok(Self { density, shape: Shape::Power(measured) })
    }

    /// 1 + Σ w·(P − 1) over weighted parts: with weights that add to 1 the mean spectrum.
    ///
    /// # Errors
    /// If there is no part, a weight is not finite, or the parts differ in density.
    pub fn sum(parts: Vec<(f64, Self)>) -> Result<Self, TargetError> {
        let density = common_density(parts.iter().map(|(_, part)| part))?;
        for (weight, _) in &parts {
            check("weight", *weight, -HIGHEST, "weights must be finite, below 1e9")?;
        }
        let shapes = parts.into_iter().map(|(weight, part)| (weight, part.shape)).collect();
        Ok(Self { density, shape: Shape::Sum(shapes) })
    }

    /// The product of spectra.
    ///
    /// # Errors
    /// If there is no part or the parts differ in density.
    pub fn product(parts: Vec<Self>) -> Result<Self, TargetError> {
        let density = common_density(parts.iter())?;
        let mut shapes: Vec<Shape> = parts.into_iter().map(|part| part.shape).collect();
        let shape = if shapes.len() == 1 { shapes.remove(0) } else { Shape::Product(shapes) };
        Ok(Self { density, shape })
    }

    /// The density n that frequencies and distances refer to.
    pub fn density(&self) -> Density {
        self.density
    }

    /// Whether it was measured on point sets, [`Self::imitating`], or a part of it was.
    pub fn is_measured(&self) -> bool {
        self.shape.leaves().iter().any(|(_, leaf)| match leaf {
            Shape::Power(samples) => samples.is_measured(),
            _ => false,
        })
    }

    /// P(ν) at ν ≥ 0 cycles per unit, without the point mass at 0.
    pub fn power(&self, nu: f64) -> f64 {
        self.shape.power(nu)
    }

    /// g at the radii `r` ≥ 0, in unit lengths. O(samples · radii), 5 to 10 ns each, on all threads.
    pub fn rdf(&self, r: &[f64]) -> Vec<f64> {
        self.shape.rdf(self.density.points_per_unit_area(), r)
    }

    /// g in `bins` bins over [0, ½), each the mean over its annulus' width by its midpoint.
    pub fn rdf_histogram(&self, bins: usize) -> Curve {
        let width = 0.5 / bins as f64;
        let middles: Vec<f64> = (0..bins).map(|i| (i as f64 + 0.5) * width).collect();
        Curve::new(0.0, width, self.rdf(&middles))
    }

    /// The frequency from where on P = 1, as far as it is known.
    pub fn end(&self) -> f64 {
        self.shape.end()
    }

    /// A curve that ends before it has settled at 1: whether it is of g, its last abscissa, how far its
    /// last tenth is from 1; of several that which is the farthest from 1.
    pub(crate) fn unsettled(&self) -> Option<(bool, f64, f64)> {
        let of = |(weight, leaf): &(f64, &Shape)| match leaf {
            Shape::Power(samples) => {
                Some((false, samples.farthest(), weight.abs() * samples.unsettled()?))
            }
            Shape::Rdf(samples) => {
                Some((true, samples.farthest(), weight.abs() * samples.unsettled()?))
            }
            _ => None,
        };
        let all = self.shape.leaves();
        all.iter().filter_map(of).max_by(|a, b| a.2.total_cmp(&b.2))
    }

    /// The abscissae of curves of g.
    pub(crate) fn rdf_abscissae(&self) -> Vec<f64> {
        let leaves = self.shape.leaves();
        let of = |(_, leaf): &(f64, &Shape)| match leaf {
            Shape::Rdf(samples) => samples.abscissae().to_vec(),
            _ => Vec::new(),
        };
        leaves.iter().flat_map(of).collect()
    }

    /// Five standard deviations of the statistical error that g has where P was measured, at `r`.
    /// Parts count as independent, and the other factors of a product as 1.
    pub(crate) fn rdf_uncertainty(&self, r: &[f64]) -> Vec<f64> {
        let mut squares = vec![0.0; r.len()];
        for (weight, leaf) in self.shape.leaves() {
            if let Shape::Power(samples) = leaf {
                for (square, error) in squares.iter_mut().zip(samples.rdf_uncertainty(r)) {
                    *square += (weight * error).powi(2);
                }
            }
        }
        squares.into_iter().map(f64::sqrt).collect()
    }

    /// Bounds of annuli over which P varies little; jumps and kinks lie on bounds.
    pub(crate) fn annuli(&self) -> Vec<f64> {
        self.shape.bounds(self.density.points_per_unit_area())
    }

    /// Where P may have a jump or a kink, ascending, and as near to each other as it varies fast.
    pub(crate) fn breaks(&self) -> Vec<f64> {
        self.shape.breaks(self.density.points_per_unit_area())
    }
}

impl Shape {
    /// What sums and products are made of in the end, and its weight in sums.
    fn leaves<'a>(&'a self) -> Vec<(f64, &'a Self)> {
        match self {
            Self::Sum(parts) => {
                let weighted = |(weight, part): &'a (f64, Self)| {
                    let weight = *weight;
                    part.leaves().into_iter().map(move |(inner, leaf)| (weight * inner, leaf))
                };
                parts.iter().flat_map(weighted).collect()
            }
            Self::Product(parts) => parts.iter().flat_map(Self::leaves).collect(),
            leaf => vec![(1.0, leaf)],
        }
    }

    fn power(&self, nu: f64) -> f64 {
        match self {
            Self::Step(nu0) => f64::from(nu >= *nu0),
            Self::Peak(peak) => peak.power(nu),
            Self::Power(samples) => samples.power(nu),
            Self::Rdf(samples) => samples.power(nu),
            Self::Sum(parts) => {
                1.0 + parts.iter().map(|(w, part)| w * (part.power(nu) - 1.0)).sum::<f64>()
            }
            Self::Product(parts) => parts.iter().map(|part| part.power(nu)).product(),
        }
    }

    fn rdf(&self, n: f64, r: &[f64]) -> Vec<f64> {
        match self {
            Self::Step(nu0) => r.iter().map(|&r| step_rdf(n, *nu0, r)).collect(),
            Self::Peak(peak) => peak.rdf(n, r),
            Self::Power(samples) => samples.rdf(n, r),
            Self::Rdf(samples) => r.iter().map(|&r| samples.rdf(r)).collect(),
            Self::Sum(parts) => {
                let mut sum = vec![1.0; r.len()];
                for (weight, part) in parts {
                    for (sum, g) in sum.iter_mut().zip(part.rdf(n, r)) {
                        *sum += weight * (g - 1.0);
                    }
                }
                sum
            }
            // The transform of a product is a convolution: numerically, between the parts' breaks.
            Self::Product(_) => {
                let (breaks, farthest) = (self.breaks(n), r.iter().copied().fold(0.0, f64::max));
                let excess = |nu: f64| self.tapered(nu);
                if panels::count(&breaks, farthest) > panels::MOST_NODES {
                    return Annuli::of(&self.bounds(n), excess).rdf(n, r);
                }
                let mut g = panels::transform(&breaks, excess, r);
                for g in &mut g {
                    *g = 1.0 + *g / n;
                }
                g
            }
        }
    }

    /// P − 1, that of measured spectra tapered as their RDF takes it.
    fn tapered(&self, nu: f64) -> f64 {
        match self {
            Self::Power(samples) => samples.tapered(nu),
            Self::Sum(parts) => parts.iter().map(|(w, part)| w * part.tapered(nu)).sum(),
            Self::Product(parts) => {
                parts.iter().map(|part| 1.0 + part.tapered(nu)).product::<f64>() - 1.0
            }
            other => other.power(nu) - 1.0,
        }
    }

    fn end(&self) -> f64 {
        match self {
            Self::Step(nu0) => *nu0,
            Self::Peak(peak) => peak.band().1,
            Self::Power(samples) => samples.end(),
            Self::Rdf(samples) => samples.end(),
            Self::Sum(parts) => parts.iter().map(|(_, part)| part.end()).fold(0.0, f64::max),
            Self::Product(parts) => parts.iter().map(Shape::end).fold(0.0, f64::max),
        }
    }

    /// See [`Target::annuli`].
    fn bounds(&self, n: f64) -> Vec<f64> {
        match self {
            Self::Step(nu0) => vec![0.0, *nu0],
            Self::Peak(peak) => peak.bounds(),
            Self::Power(samples) => samples.bounds(n),
            Self::Rdf(samples) => samples.frequencies(),
            Self::Sum(parts) => merged(parts.iter().map(|(_, part)| part.bounds(n))),
            Self::Product(parts) => merged(parts.iter().map(|part| part.bounds(n))),
        }
    }

    /// See [`Target::breaks`].
    fn breaks(&self, n: f64) -> Vec<f64> {
        match self {
            Self::Power(samples) => samples.breaks(),
            Self::Sum(parts) => merged(parts.iter().map(|(_, part)| part.breaks(n))),
            Self::Product(parts) => merged(parts.iter().map(|part| part.breaks(n))),
            Self::Step(_) | Self::Peak(_) | Self::Rdf(_) => self.bounds(n),
        }
    }
}

fn merged(parts: impl Iterator<Item = Vec<f64>>) -> Vec<f64> {
    let mut all: Vec<f64> = parts.flatten().collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

fn common_density<'a>(mut parts: impl Iterator<Item = &'a Target>) -> Result<Density, TargetError> {
    let density = parts.next().ok_or(TargetError::Parts)?.density;
    if parts.all(|part| part.density == density) { Ok(density) } else { Err(TargetError::Parts) }
}

/// Checks that a parameter is at least `least` and not absurdly large.
fn check(
    name: &'static str,
    value: f64,
    least: f64,
    need: &'static str,
) -> Result<(), TargetError> {
    if (least..=HIGHEST).contains(&value) {
        Ok(())
    } else {
        Err(TargetError::Parameter { name, value, need })
    }
}

fn check_samples(samples: &[(f64, f64)]) -> Result<(), TargetError> {
    if !(2..=Target::MAX_SAMPLES).contains(&samples.len()) {
        return Err(TargetError::Count { count: samples.len() });
    }
    let mut before = -f64::MIN_POSITIVE;
    for (index, &(x, y)) in samples.iter().enumerate() {
        // NaN is neither above nor finite.
        if !(x > before && x.is_finite()) {
            return Err(TargetError::Abscissa { index, value: x });
        }
        if y.is_nan() || y.abs() > HIGHEST {
            return Err(TargetError::Value { index, value: y });
        }
        before = x;
    }
    Ok(())
}
