//! Imitations of other methods' spectra (thesis §5.2.3), and how near they come.

use std::ops::Range;

use bn_cli::{Failure, Outcome};
use bn_core::{Curve, Density, PointSet, Seed, Unobserved};
use bn_samplers::{Algorithm, Sampler, SpectrumMatching};
use bn_spectral::{PairHistogram, PeriodogramOptions, RadialPower, Target};
use rayon::prelude::*;

/// The models of the thesis's figures 5.3 and 5.4.
pub(crate) const MODELS: [&str; 4] = ["jittered", "dart-throwing", "cccvt", "lloyd"];

/// Spectra are compared up to this times √n …
pub(crate) const HIGHEST: f64 = 6.0;
/// … and RDFs up to this over √n …
pub(crate) const FARTHEST: f64 = 5.0;
/// … in bins of 1/√n over this.
pub(crate) const BINS: f64 = 20.0;

/// Ensembles of one size: a model, what imitates it, and more of itself.
pub(crate) struct Imitation {
    pub(crate) model: Vec<PointSet>,
    /// Other sets of the model: how near two ensembles of the same method are.
    pub(crate) itself: Vec<PointSet>,
    /// By `spectral`, from the model's radial power.
    pub(crate) spectral: Vec<PointSet>,
    /// By `force`, from the model's RDF.
    pub(crate) force: Vec<PointSet>,
}

impl Imitation {
    /// `sets` sets of `n` points by each.
    pub(crate) fn of(model: &str, n: usize, sets: u32, seed: u64) -> Outcome<Self> {
        let method = bn_samplers::find(model).map_err(Failure::usage)?;
        let sampler = method.with_options([]).map_err(Failure::usage)?;
        let model = ensemble(&*sampler, n, seed, 0..sets)?;
        let itself = ensemble(&*sampler, n, seed, sets..2 * sets)?;
        let imitate = |target: Target, algorithm: &str| {
            let algorithm = Algorithm::named(algorithm).unwrap_or_default();
            ensemble(&SpectrumMatching::new(target, algorithm), n, seed, 2 * sets..3 * sets)
        };
        let power = Target::imitating(&model, n).map_err(Failure::failed)?;
        let rdf = Target::rdf_curve(Density::new(n), &rdf_samples(&model, n));
        let spectral = imitate(power, "spectral")?;
        let force = imitate(rdf.map_err(Failure::failed)?, "force")?;
        Ok(Self { model, itself, spectral, force })
    }
}

/// The sets of these numbers.
fn ensemble(
    sampler: &dyn Sampler,
    n: usize,
    seed: u64,
    sets: Range<u32>,
) -> Outcome<Vec<PointSet>> {
    let one = |set: u32| {
        let sample = sampler.sample(n, Seed::new(seed).for_set(set), &Unobserved);
        sample.map(|sample| sample.points).map_err(Failure::failed)
    };
    sets.into_par_iter().map(one).collect()
}

/// g of an ensemble at the middles of n bins over [0, ½), as `force` counts it.
fn rdf_samples(sets: &[PointSet], n: usize) -> Vec<(f64, f64)> {
    let rdf = mean_rdf(sets, 0.5, n);
    let middle = |i: usize| (i as f64 + 0.5) * rdf.step();
    rdf.values().iter().enumerate().map(|(i, &g)| (middle(i), g)).collect()
}

fn mean_rdf(sets: &[PointSet], range: f64, bins: usize) -> Curve {
    let mut sum = vec![0.0; bins];
    for set in sets {
        let rdf = PairHistogram::within(set, range, bins).rdf();
        for (sum, g) in sum.iter_mut().zip(rdf.values()) {
            *sum += g / sets.len() as f64;
        }
    }
    Curve::new(0.0, range / bins as f64, sum)
}

/// Radial power and RDF of an ensemble.
pub(crate) struct Curves {
    pub(crate) power: RadialPower,
    pub(crate) rdf: Curve,
}

impl Curves {
    pub(crate) fn of(sets: &[PointSet]) -> Outcome<Self> {
        let root = (sets[0].len() as f64).sqrt();
        let options = PeriodogramOptions::new((HIGHEST * root) as usize);
        let power = RadialPower::of(sets, options).map_err(Failure::failed)?;
        let range = (FARTHEST / root).min(0.5);
        let rdf = mean_rdf(sets, range, (range * root * BINS) as usize);
        Ok(Self { power, rdf })
    }

    /// Root mean square of the differences of the radial power, weighted by the rings' modes, and of
    /// the RDF.
    pub(crate) fn differences(&self, other: &Self) -> [f64; 2] {
        let rings =
            self.power.modes().iter().zip(self.power.means().iter().zip(other.power.means()));
        let (mut modes, mut squares) = (0.0, 0.0);
        for (&count, (a, b)) in rings.filter(|(count, _)| **count > 0) {
            modes += count as f64;
            squares += count as f64 * (a - b).powi(2);
        }
        let pairs = self.rdf.values().iter().zip(other.rdf.values());
        let rdf: f64 = pairs.map(|(a, b)| (a - b).powi(2)).sum();
        [(squares / modes).sqrt(), (rdf / self.rdf.values().len() as f64).sqrt()]
    }
}
