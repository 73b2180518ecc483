//! Periodic supersampling: the same few weighted samples for every pixel (thesis §3.1).

mod file;
mod render;
mod standard;

use std::collections::HashMap;

use bn_core::DVec2;
use thiserror::Error;

pub use standard::{SUPERSAMPLING, supersampling};

use crate::simd::cos_turns;
use crate::{Channels, Image, ImageError};

/// A sample of a supersampling pattern.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Tap {
    /// Its place relative to the pixel's centre in pixels, v down: `x_k` of eq. 3.5.
    pub offset: DVec2,
    /// Its weight: `w_k`.
    pub weight: f64,
}

impl Tap {
    /// Whether all is finite and the offset not beyond all use.
    fn is_usable(&self) -> bool {
        let near = |x: f64| x.abs() <= Supersampling::MAX_OFFSET;
        self.weight.is_finite() && near(self.offset.x) && near(self.offset.y)
    }
}

/// Why taps don't make a supersampling pattern.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SupersamplingError {
    /// No tap, or too many.
    #[error("{count} samples don't make a pattern; it takes 1 to {max}", max = Supersampling::MAX_TAPS)]
    Count {
        /// Taps given.
        count: usize,
    },
    /// An offset or weight is not finite, or an offset is beyond all use.
    #[error("sample {index} is not usable: offsets must lie within ±{max} pixels, and weights be finite", max = Supersampling::MAX_OFFSET)]
    Tap {
        /// The tap's position in the list, from 0.
        index: usize,
    },
    /// The weights cancel, so that they can't be scaled to the sum 1.
    #[error("the weights sum to {sum:?}; a pattern needs a finite sum above 1e-9 of their sizes")]
    Weights {
        /// Their sum.
        sum: f64,
    },
    /// A line of a file is not two or three numbers of the ranges allowed.
    #[error("line {line} is not an offset x y within ±{max} pixels and a finite weight: {text:?}", max = Supersampling::MAX_OFFSET)]
    Line {
        /// The line's number, from 1.
        line: usize,
        /// What it says.
        text: String,
    },
}

/// A supersampling pattern: pixel n is Σ `w_k` I(n + `x_k`), Σ w = 1 (eq. 3.1 with the same taps for
/// every pixel).
///
/// In effect the image is convolved with h(x) = Σ `w_k` δ(x + `x_k`) and then sampled at the pixel
/// centres (3.5), so the modulus of h's transform, the MTF, tells everything.
#[derive(Clone, Debug, PartialEq)]
pub struct Supersampling {
    name: String,
    taps: Vec<Tap>,
}

impl Supersampling {
    /// The most taps a pattern may have.
    pub const MAX_TAPS: usize = 1 << 16;
    /// The largest offset along an axis, in pixels.
    pub const MAX_OFFSET: f64 = 64.0;

    /// The pattern of these taps, their weights scaled to the sum 1.
    ///
    /// # Errors
    /// If there is no tap or there are too many, one is out of range, or the weights don't have a
    /// positive sum.
    pub fn new(name: impl Into<String>, mut taps: Vec<Tap>) -> Result<Self, SupersamplingError> {
        if taps.is_empty() || taps.len() > Self::MAX_TAPS {
            return Err(SupersamplingError::Count { count: taps.len() });
        }
        if let Some(index) = taps.iter().position(|tap| !tap.is_usable()) {
            return Err(SupersamplingError::Tap { index });
        }
        let sum: f64 = taps.iter().map(|tap| tap.weight).sum();
        let size: f64 = taps.iter().map(|tap| tap.weight.abs()).sum();
        if !(sum.is_finite() && sum > 1e-9 * size) {
            return Err(SupersamplingError::Weights { sum });
        }
        for tap in &mut taps {
            tap.weight /= sum;
        }
        Ok(Self { name: name.into(), taps })
    }

    /// The pattern's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The taps.
    pub fn taps(&self) -> &[Tap] {
        &self.taps
    }

    /// m: weights stated for a pixel, zeros included, though those need no sample.
    pub fn weights_per_pixel(&self) -> usize {
        self.taps.len()
    }

    /// n: samples taken for each pixel on average, as samples whose places differ by whole pixels
    /// are shared between pixels, and those of weight 0 are not needed. O(m).
    pub fn samples_per_pixel(&self) -> usize {
        self.classes().len()
    }

    /// The impulse response h: weights at −`x_k`.
    pub fn impulse_response(&self) -> impl ExactSizeIterator<Item = Tap> {
        self.taps.iter().map(|tap| Tap { offset: -tap.offset, weight: tap.weight })
    }

    /// The MTF M(ν) = |Σ `w_k` exp(2πi ν·`x_k`)| at a frequency in cycles per pixel; 1 at 0. The pixel
    /// grid's Nyquist frequency `ν_c` is ½.
    pub fn transfer(&self, frequency: DVec2) -> f64 {
        let (mut re, mut im) = (0.0, 0.0);
        for tap in &self.taps {
            let turns = frequency.dot(tap.offset);
            re += tap.weight * cos_turns(turns);
            im += tap.weight * cos_turns(turns - 0.25);
        }
        (re * re + im * im).sqrt()
    }

    /// The MTF over [−4`ν_c`, 4`ν_c`]², that is ±2 cycles per pixel, as an image of `size` × `size`
    /// pixels whose outer pixel centres lie on the border; v down.
    ///
    /// # Errors
    /// If the image is too large.
    ///
    /// # Panics
    /// If `size` is below 2.
    pub fn transfer_image(&self, size: u32) -> Result<Image, ImageError> {
        assert!(size >= 2, "an image of {size} pixels has no two borders");
        let at = |i: u32| -2.0 + 4.0 * f64::from(i) / f64::from(size - 1);
        let transfer = |i: u32, j: u32| self.transfer(DVec2::new(at(i), at(j))) as f32;
        if u64::from(size) * u64::from(size) > Image::MAX_SAMPLES {
            return Err(ImageError::Size { width: u64::from(size), height: u64::from(size) });
        }
        let values = (0..size).flat_map(|j| (0..size).map(move |i| transfer(i, j))).collect();
        Image::new(size, size, Channels::Grey, values)
    }

    /// Taps grouped by their place modulo whole pixels: samples of one class form a lattice with
    /// one sample a pixel. Taps of weight 0 need no sample. In order of the classes' first taps.
    fn classes(&self) -> Vec<Class> {
        let mut classes: Vec<Class> = Vec::new();
        let mut known = HashMap::new();
        for tap in self.taps.iter().filter(|tap| tap.weight != 0.0) {
            // Rounded to 2⁻³⁰ pixels, so that rounding errors in a file don't take a class apart.
            let snapped = (tap.offset * SNAP).round();
            let shift = (snapped / SNAP).floor();
            let within = snapped - shift * SNAP;
            let class = *known.entry((within.x as i64, within.y as i64)).or_insert_with(|| {
                classes.push(Class { residue: within / SNAP, shifts: Vec::new() });
                classes.len() - 1
            });
            classes[class].shifts.push((shift.x as i64, shift.y as i64, tap.weight));
        }
        classes
    }
}

/// Places within a pixel that are told apart, along each axis.
const SNAP: f64 = (1 << 30) as f64;

/// Taps that share their samples.
struct Class {
    /// The place of the samples relative to pixel centres, in [0, 1)².
    residue: DVec2,
    /// Which pixels' samples go into a pixel, and with which weight.
    shifts: Vec<(i64, i64, f64)>,
}
