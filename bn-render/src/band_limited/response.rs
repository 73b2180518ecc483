//! The low-pass between the reconstruction and the pixels.

use crate::{Kernel, KernelTransfer};

/// What the reconstructed function passes before it is taken at the pixels' centres.
#[derive(Clone, Copy)]
pub enum LowPass<'a> {
    /// All frequencies below ½ cycle per pixel along each axis, and no other: the limit of the kernel
    /// `sinc` without its window. Half of those at ½. Of content that
    /// [`Border::Fade`](super::Border::Fade) spreads beyond ½, what it cuts is missing near the border.
    Nyquist,
    /// The convolution with a kernel of unit gain, exactly: what convolving samples with that kernel
    /// tends to as they become dense, and [`exact_convolution`](crate::exact_convolution) computes.
    Kernel(&'a dyn Kernel),
}

impl std::fmt::Debug for LowPass<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Nyquist => f.write_str("Nyquist"),
            Self::Kernel(kernel) => write!(f, "Kernel({})", kernel.name()),
        }
    }
}

impl LowPass<'_> {
    /// How far a value may matter to a pixel, in pixels, near enough.
    pub(super) fn reach(self) -> f64 {
        match self {
            Self::Nyquist => 8.0,
            Self::Kernel(kernel) => kernel.radius(),
        }
    }

    /// The gains of the frequencies 0, 1, …, `most` cycles per `period` pixels.
    pub(super) fn gains(self, most: usize, period: usize) -> Vec<f64> {
        let frequency = |k: usize| k as f64 / period as f64;
        match self {
            Self::Nyquist => (0..=most)
                .map(|k| match (2 * k).cmp(&period) {
                    std::cmp::Ordering::Less => 1.0,
                    std::cmp::Ordering::Equal => 0.5,
                    std::cmp::Ordering::Greater => 0.0,
                })
                .collect(),
            Self::Kernel(kernel) => {
                let transfer = KernelTransfer::new(kernel, frequency(most));
                (0..=most).map(|k| transfer.axis(frequency(k))).collect()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel;

    #[test]
    fn gains_are_the_kernels_transforms() {
        let gains = |name: &str| LowPass::Kernel(kernel(name).expect("a kernel")).gains(300, 100);
        let (boxes, tents) = (gains("box"), gains("tent"));
        for (k, (got, tent)) in boxes.iter().zip(&tents).enumerate().skip(1) {
            let x = std::f64::consts::PI * k as f64 / 100.0;
            let sinc = libm::sin(x) / x;
            assert!((got - sinc).abs() < 1e-14 && (tent - sinc * sinc).abs() < 1e-14, "{k}");
        }
        for kernel in crate::KERNELS {
            assert!((LowPass::Kernel(*kernel).gains(0, 1)[0] - 1.0).abs() < 1e-13);
        }
        // The windowed sinc passes the lower half of the band and stops what lies above it.
        let sinc = gains("sinc");
        assert!((sinc[35] - 1.0).abs() < 2e-3 && sinc[70].abs() < 2e-3);
        let ideal = LowPass::Nyquist.gains(3, 4);
        assert_eq!(ideal, [1.0, 1.0, 0.5, 0.0]);
    }
}
