//! The thesis's algorithm: forces from the difference of the radial distribution functions.

use bn_core::{Curve, DVec2, Observer, PointSet, Progress, torus};
use bn_spectral::{PairHistogram, Target};

use super::table_forces::{MOST_STRENGTHS, table_forces};
use super::{End, Outcome};
use crate::SampleError;
use crate::common_options::check_range;
use crate::error::observe;

/// Spectrum matching as in the thesis, §5.2.1: points attract or repel each other by
/// f(r) = ∫₀ʳ (g − gₜ) dx along their line of sight (eq. 5.6 to 5.8), so that pairs leave the
/// distances of which there are too many.
///
/// In every iteration g is counted anew, in n bins over [0, ½) (65,535 at most), smoothed by a Gaussian; the fastest
/// point moves T/√n (the printed step size has `F_max` in the wrong place). The temperature T falls
/// by a factor from 1 on whenever the error E = ‖g − gₜ‖₂ hasn't been lowered for some iterations, and,
/// as in the authors' program, whenever E is 1.2 times that of the best set, from where the search then
/// goes on (errata 16: without that E ended at 0.0111 instead of 0.0075 for steps of 1024 points, the mean of three, after
/// twice as many iterations). The best
/// set that was seen is the result. As a reference: it ends where E is the noise of the
/// histogram, and an iteration is O(n²).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Force {
    /// Deviation of the Gaussian that smooths g, in bins; the thesis's σ = 8/n counts bins (errata
    /// 14).
    pub smoothing: f64,
    /// Iterations without a new best error before the temperature is lowered: 20 in the text.
    pub patience: u32,
    /// α, the factor of the temperature, below 1.
    pub cooling: f64,
    /// The temperature to stop at.
    pub coldest: f64,
    /// The most iterations.
    pub iterations: u32,
}

impl Default for Force {
    fn default() -> Self {
        Self { smoothing: 8.0, patience: 20, cooling: 0.9, coldest: 1e-3, iterations: 5000 }
    }
}

/// A set is lost if its error is this many times that of the best.
const LOST: f64 = 1.2;

/// The best set that was seen.
struct Best {
    error: f64,
    points: PointSet,
    /// g − gₜ.
    excess: Curve,
}

impl Force {
    /// Checks what the ranges of the options promise: fields are public.
    fn check(&self) -> Result<(), SampleError> {
        check_range("smoothing", self.smoothing, 0.0, 1000.0)?;
        check_range("cooling", self.cooling, 0.0, 1.0)?;
        check_range("coldest", self.coldest, 0.0, 1.0)
    }

    pub(super) fn run(
        &self,
        target: &Target,
        start: &PointSet,
        observer: &dyn Observer,
    ) -> Result<Outcome, SampleError> {
        self.check()?;
        let bins = start.len().clamp(2, MOST_STRENGTHS - 1);
        let wanted = target.rdf_histogram(bins).smoothed(self.smoothing * 0.5 / bins as f64);
        let mut points = start.clone();
        let mut best =
            Best { error: f64::INFINITY, points: points.clone(), excess: wanted.clone() };
        let (mut temperature, mut stuck, mut iteration) = (1.0, 0, 0);
        while temperature >= self.coldest && iteration <= self.iterations {
            let mut excess = self.excess(&points, &wanted);
            let error = norm(&excess);
            if error < best.error {
                best = Best { error, points: points.clone(), excess: excess.clone() };
                stuck = 0;
            } else {
                stuck += 1;
            }
            let figures = [("error", error), ("temperature", temperature)];
            let progress = Progress::new("pushing", iteration.into(), Some(self.iterations.into()));
            observe(observer, &progress.with_figures(&figures))?;
            observer.iterated(iteration.into(), &|| points.points().to_vec());
            let is_lost = error > LOST * best.error;
            if is_lost || stuck >= self.patience {
                (temperature, stuck) = (temperature * self.cooling, 0);
            }
            if is_lost {
                points.clone_from(&best.points);
                excess.clone_from(&best.excess);
            }
            if iteration == self.iterations {
                break;
            }
            points =
                moved(&points, &table_forces(points.points(), &integral(&excess)), temperature);
            iteration += 1;
        }
        let end = if temperature < self.coldest { End::Temperature } else { End::Iterations };
        Ok(Outcome { points: best.points.into_points(), iterations: iteration, end })
    }

    /// g − gₜ of a set, smoothed.
    fn excess(&self, points: &PointSet, wanted: &Curve) -> Curve {
        let bins = wanted.values().len();
        let g = PairHistogram::new(points, bins).rdf().smoothed(self.smoothing * wanted.step());
        let values = g.values().iter().zip(wanted.values()).map(|(g, wanted)| g - wanted).collect();
        Curve::new(0.0, wanted.step(), values)
    }
}

/// ‖f‖₂ over [0, ½).
fn norm(f: &Curve) -> f64 {
    (f.step() * f.values().iter().map(|v| v * v).sum::<f64>()).sqrt()
}

/// ∫₀ʳ f at the edges of the bins, one more than bins.
fn integral(f: &Curve) -> Vec<f64> {
    let mut sum = 0.0;
    let rest = f.values().iter().map(|v| {
        sum += v * f.step();
        sum
    });
    std::iter::once(0.0).chain(rest).collect()
}

/// The points along `forces`, the fastest by `temperature`/√n.
pub(super) fn moved(points: &PointSet, forces: &[DVec2], temperature: f64) -> PointSet {
    let largest = forces.iter().map(|f| f.length_squared()).fold(0.0, f64::max).sqrt();
    if !(largest > 0.0 && largest.is_finite()) {
        return points.clone();
    }
    let step = temperature / ((points.len() as f64).sqrt() * largest);
    let places = points.points().iter().zip(forces);
    let places = places.map(|(p, force)| torus::wrap_point(*p + step * *force)).collect();
    PointSet::new(places).expect("wrapped points are on the torus")
}
