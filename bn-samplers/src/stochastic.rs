//! Uniform random points.

use std::sync::Arc;

use bn_core::{DVec2, DensityFunction, Observer, Progress, Seed};
use rand::RngExt;
use rayon::prelude::*;

use crate::common_options::{DENSITY_OPTION, uneven};
use crate::error::{check_count, observe, reserve};
use crate::{CountRule, Method, PointOrder, Report, Sample, SampleError, Sampler};

/// Points drawn independently and uniformly: a Poisson process given its count, P(k) = 1.
///
/// Coordinates of the uniform density are multiples of 2⁻⁵³. Thesis §3.3 and p. 107; R. L. Cook,
/// "Stochastic sampling in computer graphics", ACM Trans. Graph. 5(1), 1986.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stochastic {
    /// The density of the points, uniform if there is none.
    pub density: Option<Arc<DensityFunction>>,
}

/// The registry's entry.
pub(crate) const METHOD: Method = Method {
    name: "stochastic",
    aliases: &["random", "uniform", "white-noise"],
    summary: "independent uniform random points",
    page: Some(107),
    citation: "R. L. Cook, Stochastic sampling in computer graphics, ACM Trans. Graph. 5(1), 1986",
    complexity: "O(n)",
    order: PointOrder::Random,
    counts: CountRule::Any,
    seeded: true,
    options: &[DENSITY_OPTION],
    build: |options| Ok(Box::new(Stochastic { density: options.density(DENSITY_OPTION.name) })),
    version: 1,
};

/// Points drawn from one random stream, so that threads can't change the result.
const BLOCK: usize = 4096;

impl Sampler for Stochastic {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        check_count(METHOD.name, n)?;
        observe(observer, &Progress::new("drawing", 0, Some(n as u64)))?;
        let mut points = uniform_points(n, seed, 0)?;
        if let Some(density) = uneven(self.density.as_ref()) {
            points.par_iter_mut().for_each(|p| *p = density.place(*p));
        }
        Ok(Sample::new(points, Report::new()))
    }
}

/// `n` uniform random points, from the streams `first_task`, `first_task + 1`, … of the seed.
pub(crate) fn uniform_points(
    n: usize,
    seed: Seed,
    first_task: u32,
) -> Result<Vec<DVec2>, SampleError> {
    let mut points = reserve(n)?;
    points.resize(n, DVec2::ZERO);
    points.par_chunks_mut(BLOCK).enumerate().for_each(|(block, points)| {
        let mut rng = seed.stream(first_task + block as u32);
        for p in points {
            *p = DVec2::new(rng.random(), rng.random());
        }
    });
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::Unobserved;

    #[test]
    fn coordinates_are_uniform() {
        let n = 100_000;
        let sample = Stochastic::default().sample(n, Seed::new(3), &Unobserved).expect("valid");
        for axis in 0..2 {
            // Chi-squared over 64 equal bins: mean 63, variance 126; 5 standard deviations.
            let mut bins = [0_u32; 64];
            for p in sample.points.points() {
                bins[(p[axis] * 64.0) as usize] += 1;
            }
            let expected = n as f64 / 64.0;
            let chi2: f64 =
                bins.iter().map(|&b| (f64::from(b) - expected).powi(2) / expected).sum();
            assert!((chi2 - 63.0).abs() < 5.0 * 126.0_f64.sqrt(), "axis {axis}: {chi2}");
        }
    }

    #[test]
    fn counts_follow_the_density() {
        let n = 40_000;
        let density = DensityFunction::from_fn(64, |p| p.x + 0.5 * p.y).expect("valid");
        let method = Stochastic { density: Some(Arc::new(density.clone())) };
        let sample = method.sample(n, Seed::new(7), &Unobserved).expect("valid");
        let mut counts = [0_u32; 64];
        for p in sample.points.points() {
            counts[(p.y * 8.0) as usize * 8 + (p.x * 8.0) as usize] += 1;
        }
        for (block, &count) in counts.iter().enumerate() {
            let low = DVec2::new((block % 8) as f64, (block / 8) as f64) / 8.0;
            let part = density.mass(low, low + DVec2::splat(0.125));
            let mean = part * n as f64;
            // Binomial counts; 5 standard deviations.
            let sd = (mean * (1.0 - part)).sqrt();
            assert!((f64::from(count) - mean).abs() < 5.0 * sd, "block {block}: {count}, {mean}");
        }
    }
}
