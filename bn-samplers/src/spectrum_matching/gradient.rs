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
/// g is a kernel density estimate: the histogram of pair distances smoothed by a Gaussian. A pair's
/// part in the derivative of E = ∫ (g − gₜ)² r dr by its distance is then the slope of the
/// difference, smoothed once more. (By Parseval's theorem E is also ∫ (P − Pₜ)² ν dν, but for the
/// smoothing.) The fastest point moves T/√n; T grows while E falls and is halved where E rises, from
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
        let deviation = self.kernel / root;
        let wanted = target.rdf_histogram(bins).smoothed(deviation);
        let excess = |points: &PointSet| {
            let g = PairHistogram::new(points, bins).rdf().smoothed(deviation);
            let values = g.values().iter().zip(wanted.values()).map(|(g, wanted)| g - wanted);
            Curve::new(0.0, wanted.step(), values.collect())
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
            let forces = table_forces(points.points(), &strengths(&difference, deviation));
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
/// f(r)·d/r². g of a bin is its count over r, so that r·(g − gₜ)² has the derivative g − gₜ by the
/// count; the descent is along −d/dr of it, smoothed.
fn strengths(excess: &Curve, deviation: f64) -> Vec<f64> {
    let smooth = excess.smoothed(deviation);
    let values = smooth.values();
    let slope = |k: usize| {
        let before = values[k.saturating_sub(1)];
        let after = values[k.min(values.len() - 1)];
        -(after - before) / smooth.step()
    };
    (0..=values.len()).map(|k| slope(k) * k as f64 * smooth.step()).collect()
}
