//! The cost of a point set whose periodogram should match a target, and its gradient.

use bn_core::DVec2;
use bn_spectral::{HalfPlane, Nufft, NufftError, NufftOptions, Real};
use rayon::prelude::*;

use super::lbfgs::Objective;
use super::rings::{Residual, Rings};

/// Columns of modes that make one piece of work.
const COLUMNS: usize = 16;
/// Up to this many points an evaluation stays on its thread.
const SEQUENTIAL: usize = 512;

/// The cost by the points' positions in units of 1/√n.
///
/// With S(k) = Σⱼ exp(−2πi k·xⱼ), P = |S|²/n and c the derivative of the cost E by the power of a mode,
/// ∇E = (2/n)·∇ Σₖ c S(k) exp(2πi k·x) at each point: one transform of type 1 and one of type 2, both
/// on a half plane. The gradient is exact for the E that is computed, whatever the transforms'
/// tolerance.
///
/// Portable plans: positions follow from these sums, and must not depend on the CPU.
pub(in super::super) struct Match<T: Real> {
    rings: Rings,
    plan: Nufft<T>,
    modes: HalfPlane<T>,
    points: Vec<DVec2>,
    slopes: Vec<DVec2>,
    sums: Vec<f64>,
    derivatives: Vec<f64>,
}

impl<T: Real> Match<T> {
    /// The cost of sets of `n` points, the sums S to a relative error of `tolerance`.
    pub(in super::super) fn new(
        rings: Rings,
        n: usize,
        tolerance: f64,
    ) -> Result<Self, NufftError> {
        let options = NufftOptions::new(rings.max_frequency(), tolerance).expecting(n).portable();
        let options = if n <= SEQUENTIAL { options.sequential() } else { options };
        Ok(Self {
            plan: options.plan()?,
            modes: HalfPlane::zeros(rings.max_frequency()),
            points: vec![DVec2::ZERO; n],
            slopes: vec![DVec2::ZERO; n],
            sums: vec![0.0; rings.room()],
            derivatives: vec![0.0; rings.room()],
            rings,
        })
    }

    /// Bytes that a cost takes, to some tens of percent.
    pub(in super::super) fn bytes(max_frequency: usize, n: usize) -> usize {
        // Modes on a half plane and, in as many columns, the rows of a grid three times as fine.
        let cells = max_frequency.saturating_mul(max_frequency).saturating_mul(2 + 3);
        // Points and slopes, and what the transforms keep of each point twice.
        let each = 2 * size_of::<DVec2>() + 2 * (3 * size_of::<u32>() + 2 * size_of::<T>());
        n.saturating_mul(each).saturating_add(cells.saturating_mul(2 * size_of::<T>()))
    }

    /// How far the last set that was evaluated is from the target.
    pub(in super::super) fn residual(&self) -> Residual {
        self.rings.residual(&self.sums)
    }

    /// The residual of points of the unit torus.
    pub(in super::super) fn residual_of(&mut self, points: &[DVec2]) -> Residual {
        self.points.copy_from_slice(points);
        self.transform();
        self.residual()
    }

    /// The modes of the points, and the sums of their power.
    fn transform(&mut self) {
        self.plan.points_to_modes(&self.points, None, &mut self.modes);
        let side = 2 * self.rings.max_frequency() + 1;
        let sums = |(piece, columns): (usize, &[_])| self.sum_columns(piece * COLUMNS, columns);
        let pieces: Vec<Vec<f64>> = if self.points.len() <= SEQUENTIAL {
            self.modes.values().chunks(COLUMNS * side).enumerate().map(sums).collect()
        } else {
            self.modes.values().par_chunks(COLUMNS * side).enumerate().map(sums).collect()
        };
        self.sums.fill(0.0);
        // In order, whoever made them.
        for piece in &pieces {
            for (sum, part) in self.sums.iter_mut().zip(piece) {
                *sum += part;
            }
        }
    }

    /// Sums of P over the rings, for columns kx from `first` on.
    fn sum_columns(&self, first: usize, columns: &[bn_spectral::Complex<T>]) -> Vec<f64> {
        let limit = self.rings.max_frequency();
        let mut sums = vec![0.0; self.rings.room()];
        for (kx, column) in (first..).zip(columns.chunks_exact(2 * limit + 1)) {
            // Of kx = 0 the half ky > 0 stands for the other, and the mode 0 is left out.
            let skipped = if kx == 0 { limit + 1 } else { 0 };
            for (j, mode) in column.iter().enumerate().skip(skipped) {
                let ky = j as f64 - limit as f64;
                sums[Rings::ring((kx * kx) as f64 + ky * ky)] += mode.norm_sqr().wide();
            }
        }
        // k and −k.
        let scale = 2.0 / self.points.len() as f64;
        for sum in &mut sums {
            *sum *= scale;
        }
        sums
    }
}

impl<T: Real> Objective for Match<T> {
    fn evaluate(&mut self, x: &[DVec2], gradient: &mut [DVec2]) -> f64 {
        let n = x.len() as f64;
        let unit = 1.0 / n.sqrt();
        for (point, x) in self.points.iter_mut().zip(x) {
            *point = *x * unit;
        }
        self.transform();
        let cost = self.rings.cost(&self.sums, &mut self.derivatives);
        let Self { rings, plan, modes, points, slopes, derivatives, .. } = self;
        let limit = rings.max_frequency() as f64;
        plan.columns_to_gradients(points, slopes, |kx, out| {
            let across = (kx * kx) as f64;
            for (j, (out, mode)) in out.iter_mut().zip(modes.column(kx)).enumerate() {
                let ky = j as f64 - limit;
                *out = *mode * T::narrow(derivatives[Rings::ring(across + ky * ky)]);
            }
        });
        for (gradient, slope) in gradient.iter_mut().zip(slopes) {
            *gradient = 2.0 / n * unit * *slope;
        }
        cost
    }
}

#[cfg(test)]
mod tests {
    use super::super::rings::Weights;
    use super::*;
    use crate::stochastic::uniform_points;
    use bn_core::{Density, Seed};
    use bn_spectral::{Target, direct_modes};

    /// Enough for a transform to be more than direct sums.
    const N: usize = 300;
    const K: usize = 27;
    /// Where the target's step is.
    const EDGE: f64 = 9.0;

    fn target() -> Target {
        Target::step(Density::new(N), EDGE).expect("valid")
    }

    fn places() -> Vec<DVec2> {
        let root = (N as f64).sqrt();
        uniform_points(N, Seed::new(8), 0).expect("few").iter().map(|p| *p * root).collect()
    }

    /// The cost from direct sums and the definition.
    fn oracle(x: &[DVec2]) -> f64 {
        let unit = 1.0 / (N as f64).sqrt();
        let points: Vec<DVec2> = x.iter().map(|x| *x * unit).collect();
        let modes = direct_modes(&points, None, K);
        let rings = Rings::new(&target(), K, Weights::default());
        let mut sums = vec![0.0; rings.room()];
        let limit = K as i64;
        for kx in -limit..=limit {
            for ky in -limit..=limit {
                if (kx, ky) != (0, 0) {
                    let ring = Rings::ring((kx * kx + ky * ky) as f64);
                    sums[ring] += modes.get(kx, ky).norm_sqr() / N as f64;
                }
            }
        }
        let mut derivatives = vec![0.0; rings.room()];
        rings.cost(&sums, &mut derivatives)
    }

    #[test]
    fn the_cost_is_that_of_direct_sums() {
        let rings = Rings::new(&target(), K, Weights::default());
        let mut cost = Match::<f64>::new(rings, N, 1e-10).expect("small");
        let (x, mut gradient) = (places(), vec![DVec2::ZERO; N]);
        let (got, want) = (cost.evaluate(&x, &mut gradient), oracle(&x));
        assert!((got - want).abs() < 1e-8 * want, "{got} against {want}");
    }

    /// Even a coarse transform has the gradient of the cost that it computes, in each component.
    #[test]
    fn the_gradient_is_that_of_the_cost() {
        for tolerance in [1e-10, 1e-6, 1e-3] {
            let rings = Rings::new(&target(), K, Weights::default());
            let mut cost = Match::<f64>::new(rings, N, tolerance).expect("small");
            assert!(cost.plan.crossover() < N, "{} are summed directly", cost.plan.crossover());
            let (x, mut gradient) = (places(), vec![DVec2::ZERO; N]);
            cost.evaluate(&x, &mut gradient);
            let size = (gradient.iter().map(|g| g.length_squared()).sum::<f64>() / N as f64).sqrt();
            let mut unused = vec![DVec2::ZERO; N];
            // So short that no point leaves its cell of the grid: from one to the next the kernel's
            // polynomials are continuous only to a tenth of the tolerance.
            let h = 1e-6;
            for i in (0..N).step_by(17) {
                for axis in [DVec2::X, DVec2::Y] {
                    let mut at = |step: f64| {
                        let mut moved = x.clone();
                        moved[i] += step * axis;
                        cost.evaluate(&moved, &mut unused)
                    };
                    let slope = (at(h) - at(-h)) / (2.0 * h);
                    let got = gradient[i].dot(axis);
                    // Third derivatives are of the order (2πK/√n)² ≈ 100 times the gradient, and
                    // rounding is 1e-16 of the cost over h.
                    let bound = 1e-6 * size;
                    assert!((got - slope).abs() < bound, "{got} against {slope} of {size}");
                }
            }
        }
    }

    #[test]
    fn the_modes_are_most_of_what_is_needed() {
        for limit in [100, 1000] {
            let modes = size_of_val(HalfPlane::<f32>::zeros(limit).values());
            assert!((2 * modes..4 * modes).contains(&Match::<f32>::bytes(limit, limit)));
        }
        let n = bn_core::PointSet::MAX_POINTS;
        assert!(Match::<f64>::bytes(NufftOptions::MAX_FREQUENCY, n) > 100 * n);
    }

    #[test]
    fn rings_count_every_mode_once() {
        let rings = Rings::new(&target(), K, Weights::default());
        let mut measure = Match::<f64>::new(rings, 1, 1e-10).expect("small");
        // One point has P = 1 everywhere: the residual is that of the target's empty modes.
        let residual = measure.residual_of(&[DVec2::new(0.3, 0.7)]);
        assert!((residual.empty_power - 1.0).abs() < 1e-9);
        let (mut empty, mut all) = (0.0, 0.0);
        let limit = K as i64;
        for kx in -limit..=limit {
            for ky in -limit..=limit {
                let square = kx * kx + ky * ky;
                if square > 0 && square < limit * limit {
                    all += 1.0;
                    empty += f64::from(u8::from((square as f64) < EDGE * EDGE));
                }
            }
        }
        assert!((residual.rms - f64::sqrt(empty / all)).abs() < 1e-9, "{residual:?}");
    }
}
