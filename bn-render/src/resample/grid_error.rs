//! How well kernels reconstruct band-limited images from square grids.

use bn_spectral::Complex;

use super::Normalization;
use crate::Kernel;
use crate::kernel::assert_contract;
use crate::simd::cos_turns;

/// Frequencies of the band that are tried, evenly from 0 to its end: at least so many …
const FREQUENCIES: usize = 48;
/// … and so many to a lobe of the kernel's transform, 1/(2·radius) wide.
const OF_A_LOBE: f64 = 16.0;
/// Sums of weights below this part of their mean are none.
const NO_WEIGHT: f64 = 1e-9;
/// Places of pixels that are tried, evenly over each interval on which the error is smooth.
const PLACES: usize = 24;
/// Directions in which the farthest multipliers are kept.
const DIRECTIONS: usize = 128;

/// The stated error of a kernel: by how much an image of a band, sampled on a square grid of
/// `samples_per_pixel` and reconstructed by convolution, may differ from the image, as a part of the
/// sum of its waves' amplitudes.
///
/// A wave e^(2πi f·x) becomes H(fx, tx)·H(fy, ty) times itself at a pixel that lies t from a point of
/// the grid, with the axis's multiplier H(f, t) = h/∫r·Σₖ r(t − kh) e^(−2πi f(t − kh)), h the grid's
/// spacing, over H(0, t) if sums are divided by the weights they met. That holds the kernel's
/// attenuation within the band, and the copies of the band that it lets through. Returned is the
/// largest |H·H − 1| over |fx|, |fy| ≤ `band` (cycles per pixel) and all t; infinite if sums are divided
/// by their weights and pixels may see no sample, or weights that cancel (below 1 sample per pixel).
///
/// The maximum over a grid of frequencies and places and, of their multipliers, over those farthest in
/// 128 directions: at most 1 % below the true one from 1 sample per pixel on; below, where weights all
/// but cancel at some places and errors shoot up between those that are tried, by more.
///
/// Cost: 25 places for each interval between bends of the kernel, each with 48 frequencies, or 32 a
/// cycle and unit of radius if those are more, and two cosines for each sample that the kernel reaches:
/// milliseconds up to 16 samples per pixel.
///
/// ```
/// use bn_render::{Normalization, grid_error, kernel};
///
/// let tent = kernel("tent").expect("is in the list");
/// // Bilinear interpolation takes 1 − cos πf along each axis, midway between samples.
/// let error = grid_error(tent, Normalization::Density, 0.25, 1.0);
/// assert!((error - 0.5).abs() < 1e-9);
/// ```
///
/// # Panics
/// If the kernel breaks its contract, `samples_per_pixel` is not in (0, 10⁴], or the band is not in
/// [0, √`samples_per_pixel`/2], where the grid can tell its frequencies apart.
pub fn grid_error(
    kernel: &dyn Kernel,
    normalization: Normalization,
    band: f64,
    samples_per_pixel: f64,
) -> f64 {
    assert_contract(kernel);
    assert!(
        samples_per_pixel > 0.0 && samples_per_pixel <= 1e4,
        "{samples_per_pixel} samples per pixel are absurd"
    );
    let axis = Axis { kernel, normalization, spacing: samples_per_pixel.sqrt().recip() };
    assert!(
        (0.0..=0.5 / axis.spacing).contains(&band),
        "a band of {band} is beyond the grid's Nyquist frequency"
    );
    let lobes = 2.0 * kernel.radius() * band;
    let count = FREQUENCIES.max((OF_A_LOBE * lobes).ceil() as usize);
    let mut farthest = Farthest::new();
    for place in axis.places() {
        for i in 0..=count {
            match axis.multiplier(band * i as f64 / count as f64, place) {
                Some(multiplier) => farthest.keep(multiplier),
                None => return f64::INFINITY,
            }
        }
    }
    // |ab − 1| is convex in a and in b: its maximum lies at corners of the multipliers' hull. Those of
    // negative frequencies are the conjugates.
    let corners = || farthest.corners.iter().map(|corner| corner.multiplier);
    let of =
        |a: Complex<f64>, b: Complex<f64>| (a * b - 1.0).norm().max((a * b.conj() - 1.0).norm());
    corners().flat_map(|a| corners().map(move |b| of(a, b))).fold(0.0, f64::max)
}

/// The multipliers that lie farthest from 1, where those of good kernels all are, in each direction.
struct Farthest {
    corners: Vec<Corner>,
}

struct Corner {
    direction: Complex<f64>,
    distance: f64,
    multiplier: Complex<f64>,
}

impl Farthest {
    fn new() -> Self {
        let corner = |i: usize| {
            let turns = i as f64 / DIRECTIONS as f64;
            let direction = Complex::new(cos_turns(turns), cos_turns(turns - 0.25));
            Corner { direction, distance: f64::NEG_INFINITY, multiplier: Complex::new(1.0, 0.0) }
        };
        Self { corners: (0..DIRECTIONS).map(corner).collect() }
    }

    fn keep(&mut self, multiplier: Complex<f64>) {
        let from_one = multiplier - 1.0;
        for corner in &mut self.corners {
            let distance = from_one.re * corner.direction.re + from_one.im * corner.direction.im;
            if distance > corner.distance {
                (corner.distance, corner.multiplier) = (distance, multiplier);
            }
        }
    }
}

/// One axis of a grid and of what is made of its samples.
struct Axis<'a> {
    kernel: &'a dyn Kernel,
    normalization: Normalization,
    /// Of the grid, in pixels.
    spacing: f64,
}

impl Axis<'_> {
    /// H(f, t), if there is something to divide by.
    fn multiplier(&self, frequency: f64, place: f64) -> Option<Complex<f64>> {
        let (mut re, mut im, mut weights) = (0.0, 0.0, 0.0);
        let reach = (self.kernel.radius() / self.spacing).ceil() as i64 + 1;
        for k in -reach..=reach {
            let x = place - k as f64 * self.spacing;
            let weight = self.kernel.value(x);
            let turns = frequency * x;
            re += weight * cos_turns(turns);
            im -= weight * cos_turns(turns - 0.25);
            weights += weight;
        }
        let mean = self.spacing / self.kernel.integral();
        let unit = match self.normalization {
            Normalization::Density if weights * mean < NO_WEIGHT => return None,
            Normalization::Density => weights.recip(),
            Normalization::None => mean,
        };
        Some(Complex::new(re, im) * unit)
    }

    /// Places t ∈ [0, h) that stand for all: evenly between those where a sample meets a bend of the
    /// kernel, and close to these from both sides, as it may jump there.
    fn places(&self) -> Vec<f64> {
        let (radius, h) = (self.kernel.radius(), self.spacing);
        let bends = (0..=(2.0 * radius) as usize).map(|i| (i as f64 - radius).rem_euclid(h));
        let mut ends: Vec<f64> = bends.chain([0.0, h]).collect();
        ends.sort_unstable_by(f64::total_cmp);
        let margin = 1e-10 * h;
        ends.dedup_by(|a, b| *a - *b < 4.0 * margin);
        let piece = |ends: &[f64]| {
            let (start, width) = (ends[0] + margin, ends[1] - ends[0] - 2.0 * margin);
            (0..=PLACES).map(move |i| start + width * i as f64 / PLACES as f64)
        };
        ends.windows(2).flat_map(piece).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{KERNELS, KernelTransfer, kernel};
    use proptest::prelude::*;

    fn named(name: &str) -> &'static dyn Kernel {
        kernel(name).expect("a kernel")
    }

    #[test]
    fn interpolations_have_their_closed_forms() {
        let pi = std::f64::consts::PI;
        for band in [0.0, 0.01, 0.1, 0.25, 0.4, 0.5] {
            for normalization in [Normalization::Density, Normalization::None] {
                // Midway between samples, but near the end of the band, where other places are worse.
                let tent = grid_error(named("tent"), normalization, band, 1.0);
                let want = 1.0 - libm::cos(pi * band).powi(2);
                let least = (tent - want).abs() < 1e-8;
                assert!(least || (band == 0.5 && tent > want), "tent to {band}: {tent} {want}");
                // The nearest sample lies up to half a pixel away along each axis.
                let boxes = grid_error(named("box"), normalization, band, 1.0);
                let want = 2.0 * libm::sin(pi * band);
                assert!((boxes - want).abs() < 1e-8, "box to {band}: {boxes} {want}");
            }
        }
    }

    /// Fine grids leave what the kernel takes from the band itself.
    #[test]
    fn dense_grids_leave_the_kernels_transfer() {
        for &kernel in KERNELS {
            let transfer = KernelTransfer::new(kernel, 1.0);
            for band in [0.25, 0.5] {
                let far = (0..=400).map(|i| f64::from(i) / 400.0 * band);
                let gains: Vec<f64> = far.map(|nu| transfer.axis(nu)).collect();
                let pairs = gains.iter().flat_map(|a| gains.iter().map(move |b| a * b));
                let want = pairs.map(|gain| (gain - 1.0).abs()).fold(0.0, f64::max);
                for normalization in [Normalization::Density, Normalization::None] {
                    let got = grid_error(kernel, normalization, band, 1e4);
                    // A hundred samples to a pixel's side: errors of the rectangle rule where the
                    // kernel jumps, and the search's 1 %.
                    let name = kernel.name();
                    let jumps = ["box", "gaussian"].contains(&name);
                    let room = if jumps { 0.02 } else { 2e-5 };
                    let (low, high) = (0.99 * want - room, 1.01 * want + room);
                    assert!((low..high).contains(&got), "{name} to {band}: {got} {want}");
                }
            }
        }
    }

    #[test]
    fn what_no_sample_reaches_has_no_bound() {
        assert_eq!(grid_error(named("box"), Normalization::Density, 0.1, 0.5), f64::INFINITY);
        let dark = grid_error(named("box"), Normalization::None, 0.1, 0.5);
        assert!((1.0..2.0).contains(&dark), "{dark}");
        // Weights of both signs cancel somewhere.
        for (name, rate) in [("lanczos2", 0.2), ("lanczos2", 0.25), ("mitchell", 0.15)] {
            let density = grid_error(named(name), Normalization::Density, 0.05, rate);
            let plain = grid_error(named(name), Normalization::None, 0.05, rate);
            assert!(density == f64::INFINITY && plain < 10.0, "{name}: {density} {plain}");
        }
    }

    /// Where the band has many lobes of the kernel's transform, the worst lies in a narrow one.
    #[test]
    fn no_lobe_of_wide_bands_is_missed() {
        for (rate, want) in [(2500.0, 1.2175), (1e4, 1.2173)] {
            let band = 0.5 * f64::sqrt(rate);
            let got = grid_error(named("box"), Normalization::Density, band, rate);
            assert!((got / want - 1.0).abs() < 0.01, "{rate}: {got}");
        }
    }

    #[test]
    fn absurd_questions_are_refused() {
        for (band, rate) in [(0.6, 1.0), (-0.1, 1.0), (f64::NAN, 1.0), (0.1, 0.0), (0.1, f64::NAN)]
        {
            let tried = || grid_error(named("tent"), Normalization::Density, band, rate);
            assert!(std::panic::catch_unwind(tried).is_err(), "{band} from {rate}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

        /// No wave and no place has more than 1 % above it.
        #[test]
        fn no_wave_differs_by_more(
            which in 0..KERNELS.len(),
            rate in prop::sample::select(vec![1.0, 2.0, 2.25, 4.0, 7.3, 16.0]),
            (end, fx, fy) in (0.0..0.5, -1.0..1.0, -1.0..1.0),
            (tx, ty) in (0.0..1.0, 0.0..1.0),
            plain in any::<bool>(),
        ) {
            let normalization = if plain { Normalization::None } else { Normalization::Density };
            let kernel = KERNELS[which];
            let axis = Axis { kernel, normalization, spacing: f64::sqrt(rate).recip() };
            let band = end / axis.spacing;
            let stated = grid_error(kernel, normalization, band, rate);
            let x = axis.multiplier(fx * band, tx * axis.spacing).expect("dense enough");
            let y = axis.multiplier(fy * band, ty * axis.spacing).expect("dense enough");
            let got = (x * y - 1.0).norm();
            prop_assert!(got <= 1.01 * stated + 1e-12, "{}: {} {}", kernel.name(), got, stated);
        }
    }
}
