//! What kernels do to frequencies.

use bn_core::DVec2;

use super::{Kernel, assert_contract};
use crate::gauss_legendre::gauss_legendre;
use crate::simd::cos_turns;

/// Nodes of the Gauss–Legendre rules.
const NODES: usize = 32;
/// Cycles that one rule resolves: with 32 nodes ∫ cos is exact to rounding up to 25/π, and the
/// kernel itself takes some.
const CYCLES: f64 = 7.0;

/// The transfer function of a kernel with unit gain, R(ν) = ∫∫ r(x) r(y) cos(2π ν·x) dx dy/(∫r)²,
/// ν in cycles per pixel: R(0) = 1, and at other frequencies the part of a wave that the kernel lets
/// pass. Kernels are even, so it is real.
///
/// By Gauss–Legendre rules over the pieces on which the kernel is smooth; absolute error below
/// 1e-12 up to the highest frequency asked for. 32 products for each unit of the kernel's support
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
    /// If `highest` is not a number from 0 to 10⁶, or the kernel breaks its contract.
    pub fn new(kernel: &dyn Kernel, highest: f64) -> Self {
        assert!((0.0..=1e6).contains(&highest), "a highest frequency of {highest} is absurd");
        assert_contract(kernel);
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

    /// R(ν): what a wave e^(2πi ν·x) is multiplied by.
    pub fn response(&self, frequency: DVec2) -> f64 {
        self.axis(frequency.x) * self.axis(frequency.y)
    }

    /// R(ν)²: the part of a frequency's power that passes.
    pub fn power(&self, frequency: DVec2) -> f64 {
        self.response(frequency).powi(2)
    }

    /// R along one axis, in cycles per pixel: `response` is the product of those of both.
    pub fn axis(&self, frequency: f64) -> f64 {
        self.nodes.iter().map(|&(x, w)| w * cos_turns(frequency * x)).sum()
    }
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
            let exact =
                crate::exact_convolution(&scene, kernel, &frame, 1e-7, &bn_core::Unobserved)
                    .expect("small");
            for (i, &value) in exact.image.values().iter().enumerate() {
                let at = DVec2::new((i % 8) as f64 + 0.5, (i / 8) as f64 + 0.5);
                let want = response * crate::Scene::value(&scene, at)[0];
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
                let got = transfer.axis(nu).powi(2);
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
                let (a, b) = (transfer.axis(nu), fine.axis(nu));
                assert!((a - b).abs() < 1e-12, "{name} at {nu}: {a} {b}");
            }
        }
    }
}
