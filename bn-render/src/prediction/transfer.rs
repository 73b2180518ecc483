//! What kernels do to frequencies.

use bn_core::DVec2;
use bn_spectral::Complex;

use crate::Kernel;
use crate::quadrature::gauss_legendre;
use crate::simd::cos_turns;

/// Nodes of the Gauss–Legendre rules.
const NODES: usize = 32;
/// Cycles that one rule resolves: with 32 nodes ∫ cos is exact to rounding up to 25/π, and the
/// kernel itself takes some.
const CYCLES: f64 = 7.0;

/// The transfer function of a kernel with unit gain, R(ν) = ∫∫ r(x) r(y) e^(−2πi ν·x) dx dy/(∫r)²,
/// ν in cycles per pixel: R(0) = 1, and at other frequencies the part of a wave that the kernel lets
/// pass.
///
/// By Gauss–Legendre rules over the pieces on which the kernel is smooth; absolute error below
/// 1e-12 up to the highest frequency asked for. 64 products for each unit of the kernel's support
/// and 7 cycles per pixel.
#[derive(Clone, Debug)]
pub struct KernelTransfer {
    /// Places and weights of an axis, the weights times r/∫r.
    nodes: Vec<(f64, f64)>,
}

impl KernelTransfer {
    /// The transfer function for frequencies whose coordinates are at most `highest` in size, in
    /// cycles per pixel.
    ///
    /// # Panics
    /// If `highest` is not a number from 0 to 10⁶.
    pub fn new(kernel: &dyn Kernel, highest: f64) -> Self {
        assert!((0.0..=1e6).contains(&highest), "a highest frequency of {highest} is absurd");
        let parts = (highest / CYCLES) as usize + 1;
        let rule = gauss_legendre(NODES);
        let (radius, pieces) = (kernel.radius(), (2.0 * kernel.radius()) as usize);
        let width = 1.0 / parts as f64;
        let nodes = (0..pieces * parts).flat_map(|part| {
            let start = part as f64 * width - radius;
            rule.iter().map(move |&(x, w)| (start + x * width, w * width))
        });
        let weighted = nodes.map(|(x, w)| (x, w * kernel.value(x) / kernel.integral()));
        Self { nodes: weighted.collect() }
    }

    /// R(ν): what a wave e^(2πi ν·x) is multiplied by. Real for even kernels, up to rounding.
    pub fn response(&self, frequency: DVec2) -> Complex<f64> {
        self.axis(frequency.x) * self.axis(frequency.y)
    }

    /// |R(ν)|²: the part of a frequency's power that passes.
    pub fn power(&self, frequency: DVec2) -> f64 {
        self.axis_power(frequency.x) * self.axis_power(frequency.y)
    }

    /// |R|² along one axis.
    pub(super) fn axis_power(&self, frequency: f64) -> f64 {
        self.axis(frequency).norm_sqr()
    }

    fn axis(&self, frequency: f64) -> Complex<f64> {
        let (mut re, mut im) = (0.0, 0.0);
        for &(x, w) in &self.nodes {
            let turns = frequency * x;
            re += w * cos_turns(turns);
            im -= w * cos_turns(turns - 0.25);
        }
        Complex::new(re, im)
    }
}

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
    use crate::{KERNELS, kernel};

    #[test]
    fn waves_are_multiplied_by_the_response() {
        let frame = crate::Frame::new(8, 6).expect("a size");
        let frequency = DVec2::new(0.71, -0.22);
        let wave = crate::PlaneWave { amplitude: 0.4, frequency, phase_turns: 0.1 };
        let scene = crate::PlaneWaves::new(0.0, vec![wave]);
        for &kernel in KERNELS {
            let response = KernelTransfer::new(kernel, 1.0).response(frequency);
            assert!(response.im.abs() < 1e-14, "{}", kernel.name());
            let exact =
                crate::exact_convolution(&scene, kernel, &frame, 1e-7, &bn_core::Unobserved)
                    .expect("small");
            for (i, &value) in exact.image.values().iter().enumerate() {
                let at = DVec2::new((i % 8) as f64 + 0.5, (i / 8) as f64 + 0.5);
                let want = response.re * crate::Scene::value(&scene, at)[0];
                assert!((f64::from(value) - want).abs() < 1e-7, "{}", kernel.name());
            }
        }
    }

    #[test]
    fn transfers_of_known_kernels() {
        let highest = 40.0;
        let square = |x: f64| if x == 0.0 { 1.0 } else { (libm::sin(x) / x).powi(2) };
        for (name, power) in [("box", 1), ("tent", 2)] {
            let transfer = KernelTransfer::new(kernel(name).expect("a kernel"), highest);
            for i in 0..=400 {
                let nu = f64::from(i) * 0.1;
                let want = square(std::f64::consts::PI * nu).powi(power);
                let got = transfer.axis_power(nu);
                assert!((got - want).abs() < 1e-13, "{name} at {nu}: {got} against {want}");
            }
        }
        for &kernel in KERNELS {
            let transfer = KernelTransfer::new(kernel, 0.0);
            let name = kernel.name();
            assert!((transfer.power(DVec2::ZERO) - 1.0).abs() < 1e-11, "{name}");
            // Rules made for higher frequencies agree with those for lower ones.
            let fine = KernelTransfer::new(kernel, 30.0);
            for nu in [0.3, 1.0, 2.7, 6.9] {
                let (a, b) = (transfer.axis_power(nu), fine.axis_power(nu));
                assert!((a - b).abs() < 1e-12, "{name} at {nu}: {a} {b}");
            }
        }
    }

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
                    let want = terms.map(|nu| transfer.axis_power(nu)).sum::<f64>() / side;
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
