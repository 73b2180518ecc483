//! Gradient descent on the pair correlation.

use bn_core::{Curve, Observer, PointSet, Progress};
use bn_spectral::{PairHistogram, Target};

use super::force::moved;
use super::table_forces::{MOST_STRENGTHS, table_forces};
use super::{End, Outcome};
use crate::SampleError;
use crate::common_options::check_range;
use crate::error::observe;

/// Spectrum matching by gradient descent on ‖g − gₜ‖²: Y. Zhou, H. Huang, L.-Y. Wei and R. Wang,
/// "Point sampling with general noise spectrum", ACM Trans. Graph. 31(4), 2012.
///
/// g is a kernel density estimate: the histogram of pair distances smoothed by a Gaussian, over what
/// independent points have. A pair's part in the derivative of E = ∫ (g − gₜ)² r dr by its distance is
/// then the slope of the difference, smoothed once more. (By Parseval's theorem E is also
/// ∫ (P − Pₜ)² ν dν, but for the smoothing.) The fastest point moves T/√n; T grows while E falls and is halved where E rises, from
/// where the search goes back.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Gradient {
    /// Deviation of the kernel in 1/√n, 1 at most.
    pub kernel: f64,
    /// Bins to a unit of 1/√n, 1000 at most.
    pub resolution: f64,
    /// T to stop at, 1 at most.
    pub smallest_step: f64,
    /// The most iterations.
    pub iterations: u32,
}

impl Default for Gradient {
    fn default() -> Self {
        Self { kernel: 0.1, resolution: 200.0, smallest_step: 1e-5, iterations: 2000 }
    }
}

impl Gradient {
    /// Fields are public.
    fn check(&self) -> Result<(), SampleError> {
        check_range("kernel", self.kernel, 0.0, 1.0)?;
        check_range("resolution", self.resolution, 0.0, 1000.0)?;
        check_range("smallest-step", self.smallest_step, 0.0, 1.0)
    }

    pub(super) fn run(
        &self,
        target: &Target,
        start: &PointSet,
        observer: &dyn Observer,
    ) -> Result<Outcome, SampleError> {
        self.check()?;
        let root = (start.len() as f64).sqrt();
        let bins = ((0.5 * self.resolution * root) as usize).clamp(2, MOST_STRENGTHS - 1);
        let kernel = Kernel::new(self.kernel / root, 0.5 / bins as f64, bins);
        let wanted = kernel.estimate(&target.rdf_histogram(bins));
        let excess = |points: &PointSet| {
            let g = kernel.estimate(&PairHistogram::new(points, bins).rdf());
            less(&g, &wanted)
        };
        let mut points = start.clone();
        let mut difference = excess(&points);
        let (mut step, mut iteration) = (0.1, 0);
        while step >= self.smallest_step && iteration < self.iterations {
            let figures = [("error", error(&difference)), ("step", step)];
            let progress =
                Progress::new("descending", iteration.into(), Some(self.iterations.into()));
            observe(observer, &progress.with_figures(&figures))?;
            observer.iterated(iteration.into(), &|| points.points().to_vec());
            let forces = table_forces(points.points(), &strengths(&kernel.by_count(&difference)));
            // E falls along the forces; a step that is too long is taken back.
            while step >= self.smallest_step && iteration < self.iterations {
                iteration += 1;
                let trial = moved(&points, &forces, step);
                let after = excess(&trial);
                if error(&after) < error(&difference) {
                    (points, difference, step) = (trial, after, 1.3 * step);
                    break;
                }
                step *= 0.5;
            }
        }
        let end = if step < self.smallest_step { End::Step } else { End::Iterations };
        Ok(Outcome { points: points.into_points(), iterations: iteration, end })
    }
}

/// √E, E = ∫ (g − gₜ)² r dr.
fn error(excess: &Curve) -> f64 {
    let squares = excess.values().iter().enumerate().map(|(i, v)| (i as f64 + 0.5) * v * v);
    excess.step() * squares.sum::<f64>().sqrt()
}

/// What pairs at each bin's edge gain by moving apart, times their distance: the force is
/// f(r)·d/r². From one bin to the next E changes by the difference of its derivatives.
fn strengths(by_count: &Curve) -> Vec<f64> {
    let values = by_count.values();
    let slope = |k: usize| {
        let before = values[k.saturating_sub(1)];
        let after = values[k.min(values.len() - 1)];
        -(after - before) / by_count.step()
    };
    (0..=values.len()).map(|k| slope(k) * k as f64 * by_count.step()).collect()
}

/// The Gaussian K that makes a density of counts, of weights that add to 1 within the range.
struct Kernel {
    deviation: f64,
    /// The part of the Gaussian around each bin that lies within the range.
    within: Vec<f64>,
}

impl Kernel {
    fn new(deviation: f64, step: f64, bins: usize) -> Self {
        // Smoothed amid zeros, ones turn into what is left of the Gaussian.
        let beyond = (4.0 * deviation / step).ceil() as usize;
        let range = beyond..beyond + bins;
        let ones = (0..bins + 2 * beyond).map(|i| f64::from(u8::from(range.contains(&i))));
        let smooth = Curve::new(0.0, step, ones.collect()).smoothed(deviation);
        Self { deviation, within: smooth.values()[range].to_vec() }
    }

    /// K(r·g)/r of a histogram of g, whose counts go like r·g.
    fn estimate(&self, g: &Curve) -> Curve {
        let radius = |i: usize| i as f64 + 0.5;
        let counts = scaled(g, radius).smoothed(self.deviation);
        scaled(&counts, |i| 1.0 / radius(i))
    }

    /// The derivative of E by the count of each bin, but for a factor: r·(g − gₜ)²'s by the count in
    /// bin j is 2·Kᵢⱼ (g − gₜ) in bin i. The sum is over the rows of K, not its columns.
    fn by_count(&self, excess: &Curve) -> Curve {
        let smooth = scaled(excess, |i| 1.0 / self.within[i]).smoothed(self.deviation);
        scaled(&smooth, |i| self.within[i])
    }
}

/// The difference of two curves.
fn less(a: &Curve, b: &Curve) -> Curve {
    let values = a.values().iter().zip(b.values()).map(|(a, b)| a - b).collect();
    Curve::new(0.0, a.step(), values)
}

/// The curve times a factor of each bin.
fn scaled(curve: &Curve, factor: impl Fn(usize) -> f64) -> Curve {
    let values = curve.values().iter().enumerate().map(|(i, v)| v * factor(i)).collect();
    Curve::new(0.0, curve.step(), values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::Seed;
    use rand::RngExt as _;

    /// One count more in a bin, from the ends to the middle: E is a square, for which central
    /// differences are exact.
    #[test]
    fn the_derivative_is_that_of_the_error() {
        let (bins, step) = (60, 0.5 / 60.0);
        let mut rng = Seed::new(2).stream(0);
        let mut random = || {
            let values: Vec<f64> = (0..bins).map(|_| 2.0 * rng.random::<f64>()).collect();
            Curve::new(0.0, step, values)
        };
        let (g, wanted) = (random(), random());
        for deviation in [0.0, 0.3 * step, 5.0 * step, 0.4] {
            let kernel = Kernel::new(deviation, step, bins);
            let wanted = kernel.estimate(&wanted);
            let excess = |g: &Curve| less(&kernel.estimate(g), &wanted);
            let derivative = kernel.by_count(&excess(&g));
            for bin in 0..bins {
                // In units of r·g: g of a count is 1/r.
                let square = |count: f64| {
                    let add = |i: usize| if i == bin { count / (i as f64 + 0.5) } else { 0.0 };
                    let values = g.values().iter().enumerate().map(|(i, g)| g + add(i));
                    error(&excess(&Curve::new(0.0, step, values.collect()))).powi(2)
                };
                let slope = (square(0.1) - square(-0.1)) / 0.2 / (2.0 * step * step);
                let got = derivative.values()[bin];
                assert!((got - slope).abs() < 1e-9, "{deviation}, {bin}: {got} and {slope}");
            }
        }
    }
}
