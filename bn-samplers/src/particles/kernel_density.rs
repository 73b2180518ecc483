//! Blue noise from a kernel density model.

use bn_core::{DVec2, Observer, PointSet, Progress, Seed, torus};
use rand::RngExt;
use rand_distr::StandardNormal;
use rayon::prelude::*;

use super::pair_forces::pair_forces;
use crate::common_options::check_range;
use crate::error::{check_count, observe};
use crate::stochastic::uniform_points;
use crate::{
    CountRule, DefaultValue, Method, OptionKind, OptionSpec, PointOrder, Report, Sample,
    SampleError, Sampler,
};

/// Particles in thermal equilibrium: each carries a Gaussian kernel, and the energy is the squared
/// error by which the sum of kernels differs from a constant density.
///
/// Thesis p. 111; R. Fattal, "Blue-noise point sampling using kernel density model", ACM Trans.
/// Graph. 30(4), 2011. On the torus that energy is Σ exp(−d²/w²) over pairs at distance d, up to a
/// constant. At temperature 0 the particles freeze to a hexagonal lattice, at a high one they are
/// random. Sampling is hierarchical, which spares the slow settling of long waves: a quarter of
/// the points at each coarser level, a handful at the coarsest; at each level Langevin steps (down
/// the energy plus thermal noise), then each particle splits into four.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KernelDensity {
    /// Temperature in units of the energy of two coincident particles, from 0 to 1.
    pub temperature: f64,
    /// Width w of the interaction in mean spacings 1/√n, from 0.1 to 2.
    pub width: f64,
    /// Langevin steps at each level, up to 1000.
    pub steps: u32,
}

impl Default for KernelDensity {
    fn default() -> Self {
        Self { temperature: 0.004, width: 0.8, steps: 60 }
    }
}

/// The registry's entry.
pub(crate) const METHOD: Method = Method {
    name: "kernel-density",
    aliases: &["kde", "fattal"],
    summary: "particles with Gaussian kernels at a temperature",
    page: Some(111),
    citation: "R. Fattal, Blue-noise point sampling using kernel density model, ACM Trans. Graph. 30(4), 2011",
    complexity: "O(n)",
    order: PointOrder::Scan,
    counts: CountRule::Any,
    seeded: true,
    options: &[
        OptionSpec {
            name: "temperature",
            kind: OptionKind::Real { min: 0.0, max: 1.0 },
            default: DefaultValue::Value("0.004"),
            help: "disorder: 0 freezes the particles",
            unit: "energy of two coincident particles",
        },
        OptionSpec {
            name: "width",
            kind: OptionKind::Real { min: NARROWEST, max: WIDEST },
            default: DefaultValue::Value("0.8"),
            help: "distance at which the repulsion has fallen to 1/e",
            unit: "1/√n",
        },
        OptionSpec {
            name: "steps",
            kind: OptionKind::Integer { min: 0, max: MOST },
            default: DefaultValue::Value("60"),
            help: "steps at each level of the hierarchy",
            unit: "",
        },
    ],
    build: |options| {
        Ok(Box::new(KernelDensity {
            temperature: options.number("temperature"),
            width: options.number("width"),
            steps: options.count("steps"),
        }))
    },
    version: 1,
};

const NARROWEST: f64 = 0.1;
const WIDEST: f64 = 2.0;
const MOST: u64 = 1000;

/// Particles at the coarsest level, at most.
const COARSEST: usize = 16;

/// Kernels are cut off at this many widths, where 10⁻⁴ is left.
const CUTOFF: f64 = 3.0;

/// Particles that share a random stream.
const BLOCK: usize = 1024;

impl Sampler for KernelDensity {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        check_count(METHOD.name, n)?;
        self.check()?;
        let mut counts = vec![n];
        while let Some(&count) = counts.last()
            && count > COARSEST
        {
            counts.push(count.div_ceil(4));
        }
        let total = (counts.len() as u64) * u64::from(self.steps);
        let mut done = 0;
        let mut stream = 1 << 24;
        let coarsest = counts.pop().unwrap_or(n);
        let mut points = uniform_points(coarsest, seed, 0)?;
        loop {
            // Observers follow all points, not those of coarser levels.
            let is_finest = counts.is_empty();
            for step in 0..self.steps {
                if is_finest {
                    observer.iterated(step.into(), &|| points.clone());
                }
                observe(observer, &Progress::new("settling", done, Some(total)))?;
                done += 1;
                points = self.step(points, seed, stream);
                stream += points.len().div_ceil(BLOCK) as u32;
            }
            observe(observer, &Progress::new("settling", done, Some(total)))?;
            let Some(count) = counts.pop() else {
                observer.iterated(self.steps.into(), &|| points.clone());
                break;
            };
            points = split(&points, count, seed, stream);
            stream += 1;
        }
        let report = Report::new().with("steps", done);
        Ok(Sample::new(points, report))
    }
}

impl KernelDensity {
    fn check(&self) -> Result<(), SampleError> {
        check_range("temperature", self.temperature, 0.0, 1.0)?;
        check_range("width", self.width, NARROWEST, WIDEST)?;
        check_range("steps", self.steps.into(), 0.0, MOST as f64)
    }

    /// One Langevin step: x ← x − h·∇E + √(2hT)·ξ with standard normal ξ.
    fn step(&self, points: Vec<DVec2>, seed: Seed, first_stream: u32) -> Vec<DVec2> {
        let spacing = 1.0 / (points.len() as f64).sqrt();
        let width = self.width * spacing;
        let scale = 1.0 / (width * width);
        // −∇ exp(−d²/w²) = 2d/w²·exp(−d²/w²)
        let factor = |squared: f64| 2.0 * scale * libm::exp(-squared * scale);
        let set = PointSet::new(points).expect("points of the unit torus");
        let forces = pair_forces(&set, CUTOFF * width, factor);
        let mut points = set.into_points();
        // A wave of n particles per unit area curves the energy by up to 4πn/e: with wide kernels the
        // step is bounded by the spacing rather than the width.
        let rate = STEP * width.min(spacing).powi(2);
        let noise = (2.0 * rate * self.temperature).sqrt();
        let blocks = points.par_chunks_mut(BLOCK).zip(forces.par_chunks(BLOCK)).enumerate();
        blocks.for_each(|(block, (points, forces))| {
            let mut rng = seed.stream(first_stream.wrapping_add(block as u32));
            for (p, &force) in points.iter_mut().zip(forces) {
                let thermal = DVec2::new(rng.sample(StandardNormal), rng.sample(StandardNormal));
                *p = torus::wrap_point(*p + rate * force + noise * thermal);
            }
        });
        points
    }
}

/// Length of a step in units of the squared width, or spacing, over the energy.
const STEP: f64 = 0.2;

/// Replaces each particle by four, some by three so that there are `count`, at random places around
/// it.
fn split(parents: &[DVec2], count: usize, seed: Seed, stream: u32) -> Vec<DVec2> {
    let mut rng = seed.stream(stream);
    let spacing = 1.0 / (parents.len() as f64).sqrt();
    let mut points = Vec::with_capacity(count);
    for (i, &parent) in parents.iter().enumerate() {
        // Of the children of all, an even share up to here.
        let until = (i + 1) * count / parents.len();
        while points.len() < until {
            let offset = DVec2::new(rng.random(), rng.random()) - 0.5;
            points.push(torus::wrap_point(parent + spacing * offset));
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::Unobserved;

    /// The energy of two particles on the torus, all copies counted.
    fn energy(d: DVec2, width: f64) -> f64 {
        let copies = (-3..=3).flat_map(|i| (-3..=3).map(move |j| (f64::from(i), f64::from(j))));
        let squared = copies.map(|(x, y)| (d + DVec2::new(x, y)).length_squared());
        squared.map(|squared| libm::exp(-squared / (width * width))).sum()
    }

    /// Two particles have the mean energy of Boltzmann's distribution.
    #[test]
    fn pairs_are_in_thermal_equilibrium() {
        let width = 0.8 / 2.0_f64.sqrt();
        for temperature in [0.05, 0.3] {
            let (mut weights, mut mean) = (0.0, 0.0);
            for i in 0..10_000 {
                let d = DVec2::new(f64::from(i % 100), f64::from(i / 100)) / 100.0;
                let weight = libm::exp(-energy(d, width) / temperature);
                weights += weight;
                mean += weight * energy(d, width);
            }
            mean /= weights;
            let method = KernelDensity { temperature, ..KernelDensity::default() };
            let runs = 2000;
            let energies = (0..runs).map(|seed| {
                let set = method.sample(2, Seed::new(seed), &Unobserved).expect("valid").points;
                energy(set.points()[0] - set.points()[1], width)
            });
            let energies: Vec<_> = energies.collect();
            let got = energies.iter().sum::<f64>() / runs as f64;
            let spread = energies.iter().map(|energy| (energy - got).powi(2)).sum::<f64>();
            let error = spread.sqrt() / runs as f64;
            // Finite steps and the kernels' cutoff shift the mean, by less than 2 % here.
            assert!((got - mean).abs() < 5.0 * error + 0.02 * mean, "{got} against {mean}");
        }
    }

    #[test]
    fn splitting_makes_the_count_that_is_asked_for() {
        let parents = uniform_points(13, Seed::new(1), 0).expect("few points");
        for count in [49, 50, 51, 52] {
            let points = split(&parents, count, Seed::new(1), 1);
            assert_eq!(points.len(), count);
            for p in points {
                let nearest = parents.iter().map(|&parent| torus::distance(p, parent));
                let nearest = nearest.fold(f64::INFINITY, f64::min);
                assert!(nearest < 0.5_f64.sqrt() / 13.0_f64.sqrt());
            }
        }
    }
}
