//! The convolution itself, by quadrature: what reconstruction tends to as samples become dense.

use bn_core::{DVec2, Observer};

use crate::gauss_legendre::gauss_legendre;
use crate::{
    Frame, Image, Kernel, RenderError, Scene, Supersampling, SupersamplingError, Tap,
    mean_square_error,
};

/// A scene convolved with a kernel, and how well.
#[derive(Clone, Debug)]
pub struct Convolution {
    /// The pixels.
    pub image: Image,
    /// Root mean square of what doubling the nodes along each axis changed at last. For smooth
    /// scenes the error is far smaller, for scenes with edges of about this size.
    pub change: f64,
    /// Whether the change is within the tolerance asked for.
    pub converged: bool,
    /// Nodes for each pixel.
    pub samples_per_pixel: usize,
}

/// Most nodes along an axis for each pixel.
const MOST_NODES: usize = 32;

/// The convolution of `scene` with `kernel` of unit gain, ∫∫ I·r/(∫r)², at the frame's pixels, by
/// Gauss–Legendre rules over each unit square on which the kernel is smooth.
///
/// The nodes along each axis are doubled, from 4 a pixel to at most 32, until the image changes by
/// no more than `tolerance` (root mean square). Nodes are shared by the pixels that they reach.
/// Cost: up to 1024 values and 1024·(2·radius)² products a pixel.
///
/// The observer is told of each image's progress, of which there are two to four.
///
/// # Errors
/// If the frame's window is too large for an image in memory, or the observer asks to stop.
pub fn exact_convolution(
    scene: &dyn Scene,
    kernel: &dyn Kernel,
    frame: &Frame,
    tolerance: f64,
    observer: &dyn Observer,
) -> Result<Convolution, RenderError> {
    let cells = (2.0 * kernel.radius()) as usize;
    let most = MOST_NODES.min(Supersampling::MAX_TAPS.isqrt() / cells);
    let at = |nodes: usize| rule(kernel, cells, nodes).render(scene, frame, observer);
    let (mut nodes, mut image) = (4, at(4)?.0);
    loop {
        nodes *= 2;
        let finer = at(nodes)?.0;
        let change = mean_square_error(&image, &finer)?.sqrt();
        image = finer;
        let converged = change <= tolerance;
        if converged || 2 * nodes > most {
            return Ok(Convolution { image, change, converged, samples_per_pixel: nodes * nodes });
        }
    }
}

/// The quadrature as a pattern of taps: `nodes` to each of `cells` unit intervals along each axis.
fn rule(kernel: &dyn Kernel, cells: usize, nodes: usize) -> Supersampling {
    let axis: Vec<(f64, f64)> = (0..cells)
        .flat_map(|cell| {
            let start = cell as f64 - kernel.radius();
            gauss_legendre(nodes).into_iter().map(move |(x, w)| (start + x, w))
        })
        // A tap is where the sample lies, the kernel's argument points from there to the pixel.
        .map(|(x, w)| (x, w * kernel.value(-x)))
        .collect();
    let tap =
        |x: (f64, f64), y: (f64, f64)| Tap { offset: DVec2::new(x.0, y.0), weight: x.1 * y.1 };
    let taps = axis.iter().flat_map(|&y| axis.iter().map(move |&x| tap(x, y))).collect();
    let pattern: Result<_, SupersamplingError> = Supersampling::new("quadrature", taps);
    pattern.expect("kernels have a positive integral and a small support")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{KERNELS, PlaneWave, PlaneWaves, kernel};
    use bn_core::Unobserved;

    /// ∫ r(x) cos 2πfx dx / ∫ r over the support, by Simpson's rule.
    fn gain(kernel: &dyn Kernel, f: f64) -> f64 {
        let (r, n) = (kernel.radius(), 8000);
        let h = 2.0 * r / f64::from(n);
        let at = |i: i32| {
            let x = (f64::from(i) * h - r).clamp(-r * (1.0 - 1e-15), r);
            kernel.value(x) * libm::cos(std::f64::consts::TAU * f * x)
        };
        let inner: f64 = (1..n).map(|i| at(i) * if i % 2 == 1 { 4.0 } else { 2.0 }).sum();
        h / 3.0 * (at(0) + inner + at(n)) / kernel.integral()
    }

    #[test]
    fn waves_come_out_with_the_kernels_gain() {
        let frame = Frame::new(24, 20).expect("a size");
        let frequency = DVec2::new(0.83, -0.37);
        let wave = PlaneWave { amplitude: 0.4, frequency, phase_turns: 0.1 };
        let scene = PlaneWaves::new(0.5, vec![wave]);
        for &kernel in KERNELS {
            let got = exact_convolution(&scene, kernel, &frame, 1e-6, &Unobserved).expect("small");
            assert!(got.converged, "{}: {}", kernel.name(), got.change);
            let gain = gain(kernel, 0.83) * gain(kernel, 0.37);
            for j in 0..20 {
                for i in 0..24 {
                    let centre = DVec2::new(f64::from(i) + 0.5, f64::from(j) + 0.5);
                    let want = 0.5 + gain * (scene.value(centre)[0] - 0.5);
                    let got = f64::from(got.image.pixel(i, j)[0]);
                    // The rounding to f32.
                    assert!((got - want).abs() < 1e-7, "{}: {got}, {want}", kernel.name());
                }
            }
        }
    }

    #[test]
    fn edges_are_told_by_the_change_that_is_left() {
        let frame = Frame::new(40, 30).expect("a size");
        let scene = crate::Checkerboard::new(&frame, 0.3, 5.0, 0.5);
        let kernel = kernel("lanczos2").expect("a kernel");
        let got = exact_convolution(&scene, kernel, &frame, 1e-7, &Unobserved).expect("small");
        // Most of it lies at the horizon, where squares are as small as one likes.
        assert!(!got.converged && (1e-3..0.03).contains(&got.change), "{}", got.change);
        assert_eq!(got.samples_per_pixel, 1024);
    }
}
