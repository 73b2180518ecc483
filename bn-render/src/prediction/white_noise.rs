//! White noise on the frequencies of a tile, after a kernel.

use crate::Kernel;
use crate::gauss_legendre::gauss_legendre;
use crate::simd::cos_turns;

/// Nodes of the Gauss–Legendre rules: exact to rounding for products of two kernels' pieces.
const NODES: usize = 32;

/// Σ |R(ν + k/L)|²/L over all integers k for one axis and a tile of side L: what white noise on the
/// frequencies of a tile becomes.
///
/// By Poisson's sum it is Σ ρ(mL) cos 2πmLν with the kernel's autocorrelation ρ, of which few terms
/// are not 0; for L at least the kernel's diameter it is ρ(0) = ∫r²/(∫r)² alone.
#[derive(Clone, Debug)]
pub(super) struct WhiteNoise {
    side: f64,
    /// ρ(mL) for m = 0, 1, …
    autocorrelation: Vec<f64>,
}

impl WhiteNoise {
    /// For tiles of side `side` pixels.
    pub(super) fn new(kernel: &dyn Kernel, side: f64) -> Self {
        let reach = (2.0 * kernel.radius() / side).ceil() as usize;
        let at = |m: usize| autocorrelation(kernel, m as f64 * side);
        Self { side, autocorrelation: (0..reach.max(1)).map(at).collect() }
    }

    /// The sum at `frequency` cycles per pixel.
    pub(super) fn at(&self, frequency: f64) -> f64 {
        let mut terms = self.autocorrelation.iter();
        let center = terms.next().copied().unwrap_or_default();
        let turns = |m: usize| (m + 1) as f64 * self.side * frequency;
        let sum: f64 = terms.enumerate().map(|(m, rho)| rho * cos_turns(turns(m))).sum();
        center + 2.0 * sum
    }
}

/// ∫ r(x) r(x + d) dx/(∫r)², piece by piece between the places where either factor may bend.
fn autocorrelation(kernel: &dyn Kernel, d: f64) -> f64 {
    let radius = kernel.radius();
    let (low, high) = (-radius, radius - d);
    let units = || (0..=(2.0 * radius) as usize).map(|i| i as f64 - radius);
    let mut ends: Vec<f64> = units().chain(units().map(|x| x - d)).collect();
    ends.retain(|&x| (low..=high).contains(&x));
    ends.sort_unstable_by(f64::total_cmp);
    let rule = gauss_legendre(NODES);
    let piece = |ends: &[f64]| -> f64 {
        let (start, width) = (ends[0], ends[1] - ends[0]);
        let product = |x: f64| kernel.value(x) * kernel.value(x + d);
        rule.iter().map(|&(x, w)| w * width * product(start + x * width)).sum()
    };
    ends.windows(2).map(piece).sum::<f64>() / kernel.integral().powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{KernelTransfer, kernel};

    /// Poisson's sum against the sum itself, for kernels whose transfer decays fast.
    #[test]
    fn white_noise_is_the_sum_over_a_tiles_frequencies() {
        for name in ["mitchell", "bicubic", "lanczos3"] {
            let kernel = kernel(name).expect("a kernel");
            let transfer = KernelTransfer::new(kernel, 300.0);
            for side in [0.7, 2.0, 3.3, 9.0] {
                let white = WhiteNoise::new(kernel, side);
                for nu in [0.0, 0.21, 0.4] {
                    let reach = (290.0 * side) as i32;
                    let terms = (-reach..=reach).map(|k| nu + f64::from(k) / side);
                    let want = terms.map(|nu| transfer.axis(nu).powi(2)).sum::<f64>() / side;
                    let got = white.at(nu);
                    // The tail of the sum, whose terms fall as ν⁻⁴ or faster.
                    assert!((got - want).abs() < 2e-8, "{name}, {side}, {nu}: {got} {want}");
                }
            }
        }
        let boxes = WhiteNoise::new(kernel("box").expect("a kernel"), 5.0);
        assert!((boxes.at(0.37) - 1.0).abs() < 1e-14);
    }
}
