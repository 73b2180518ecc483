//! The periodic rectangle that an image is reconstructed on.

use bn_core::DVec2;

use super::error::BandLimitedError;
use super::grid::good_size;
use super::modes::Degree;
use super::toeplitz::grid_size;
use crate::{Frame, Pattern, Rect};

/// What the image is continued by: band-limited functions of finite degree are periodic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Border {
    /// A margin beyond the kernel's reach, in which the scene's values fade to their mean, so that
    /// opposite sides meet. The fading spreads frequencies by up to 1/12 cycle per pixel: content within
    /// that of the band's end loses some of its accuracy near the image's border.
    #[default]
    Fade,
    /// The image itself, repeated: exact for scenes of the image's period, and wrong near the border
    /// for all others.
    Periodic,
}

impl Border {
    /// By how much the continuation spreads frequencies, in cycles per pixel.
    pub(super) fn spread(self) -> f64 {
        match self {
            Self::Fade => LOBE / FADE,
            Self::Periodic => 0.0,
        }
    }
}

/// The rectangle [start, start + size) of the image plane, as a torus.
#[derive(Clone, Copy, Debug)]
pub(super) struct Domain {
    /// In whole pixels; not positive.
    start: (i64, i64),
    pub(super) width: usize,
    pub(super) height: usize,
    image: (f64, f64),
    /// How far beyond the image values are those of the scene, in pixels; infinite if they don't fade.
    reach: f64,
    pub(super) degree: Degree,
}

/// The width of the strip in which values fade. A strip of half that would spread frequencies twice as
/// far, and images of the pixels' own band would leave fewer samples to a coefficient.
const FADE: f64 = 48.0;

/// The end of the main lobe of the four-term Blackman–Harris window, in cycles over its width; what
/// lies beyond is below −92 dB.
const LOBE: f64 = 4.0;

/// Most samples, at some 160 bytes each 5 GB, and most places of a pixel grid.
const MOST: f64 = (1_u64 << 25) as f64;

/// Most places of a transform between samples and modes: at 16 bytes each, 2 GB.
const MOST_PLACES: f64 = (1_u64 << 27) as f64;

impl Domain {
    pub(super) fn new(
        frame: &Frame,
        border: Border,
        reach: f64,
        band: f64,
    ) -> Result<Self, BandLimitedError> {
        let (image, margin) = ((frame.width(), frame.height()), (reach + FADE).ceil() as usize);
        let side = |length: u32| match border {
            Border::Periodic => (0, length as usize),
            Border::Fade => {
                let size = good_size(length as usize + 2 * margin);
                (-(((size - length as usize) / 2) as i64), size)
            }
        };
        let ((left, width), (top, height)) = (side(image.0), side(image.1));
        let places = (4.0 * band).max(2.0).powi(2) * width as f64 * height as f64;
        check("places of a grid", places, MOST)?;
        let degree = Degree { x: degree(band, width), y: degree(band, height) };
        let (columns, rows) = grid_size(degree);
        check("places of a grid", columns as f64 * rows as f64, MOST)?;
        check_degree(degree)?;
        Ok(Self {
            start: (left, top),
            width,
            height,
            image: (f64::from(image.0), f64::from(image.1)),
            reach: if border == Border::Fade { reach } else { f64::INFINITY },
            degree,
        })
    }

    /// An error if so many samples a pixel are too many.
    pub(super) fn check_samples(&self, samples_per_pixel: f64) -> Result<(), BandLimitedError> {
        check("samples", self.width as f64 * self.height as f64 * samples_per_pixel, MOST)
    }

    /// The rectangle of the image plane; an error if it holds too many samples.
    pub(super) fn rect(&self, pattern: &Pattern) -> Result<Rect, BandLimitedError> {
        self.check_samples(pattern.samples_per_pixel())?;
        let (u, v) = (self.start.0 as f64, self.start.1 as f64);
        Ok(Rect::new(u, v, u + self.width as f64, v + self.height as f64))
    }

    /// A place of the image plane on the unit torus.
    pub(super) fn on_torus(&self, u: f64, v: f64) -> DVec2 {
        DVec2::new(
            (u - self.start.0 as f64) / self.width as f64,
            (v - self.start.1 as f64) / self.height as f64,
        )
    }

    /// The domain's pixel that is the image's pixel (x, y).
    pub(super) fn pixel(&self, x: u32, y: u32) -> (usize, usize) {
        ((i64::from(x) - self.start.0) as usize, (i64::from(y) - self.start.1) as usize)
    }

    /// How much of the scene's contrast is left at a place: 1 in the image, 0 at the domain's border.
    pub(super) fn fading(&self, u: f64, v: f64) -> f64 {
        let outside = |x: f64, length: f64| (-x).max(x - length) - self.reach;
        fade(outside(u, self.image.0)) * fade(outside(v, self.image.1))
    }
}

/// The largest frequency below `band` cycles per pixel, in cycles per `length` pixels: the Nyquist
/// frequency of a lattice, whose two signs can't be told apart, is left out.
fn degree(band: f64, length: usize) -> usize {
    ((band * length as f64).ceil() as usize).saturating_sub(1)
}

/// Refuses degrees whose transforms don't fit.
pub(super) fn check_degree(degree: Degree) -> Result<(), BandLimitedError> {
    check("places of a transform", degree.transform_places(), MOST_PLACES)
}

fn check(what: &'static str, count: f64, limit: f64) -> Result<(), BandLimitedError> {
    if count <= limit { Ok(()) } else { Err(BandLimitedError::TooLarge { what, count, limit }) }
}

/// 1 for x ≤ 0, 0 for x ≥ FADE; between, 1 less the integral of the four-term Blackman–Harris window
/// (F. J. Harris, Proc. IEEE 66, 1978).
fn fade(x: f64) -> f64 {
    const TERMS: [f64; 4] = [0.358_75, 0.488_29, 0.141_28, 0.011_68];
    if x <= 0.0 {
        return 1.0;
    }
    if x >= FADE {
        return 0.0;
    }
    let turn = std::f64::consts::TAU * x / FADE;
    let wave = |k: usize| TERMS[k] / TERMS[0] * libm::sin(k as f64 * turn) / k as f64;
    1.0 - x / FADE - (wave(2) - wave(1) - wave(3)) / std::f64::consts::TAU
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fading_is_smooth_and_even() {
        assert_eq!((fade(-1.0), fade(0.0), fade(FADE), fade(1e9)), (1.0, 1.0, 0.0, 0.0));
        let mut last = 1.0;
        for i in 1..480 {
            let x = f64::from(i) / 10.0;
            let now = fade(x);
            assert!(now < last + 1e-15 && (now + fade(FADE - x) - 1.0).abs() < 1e-14, "{x}");
            last = now;
        }
    }

    #[test]
    fn domains_surround_their_image() {
        let frame = Frame::new(100, 41).expect("a size");
        let domain = Domain::new(&frame, Border::Fade, 2.0, 0.5).expect("small");
        assert!(domain.width >= 200 && domain.height >= 141 && domain.height.is_multiple_of(2));
        let pattern = bn_core::PointSet::new(vec![DVec2::ZERO]).expect("a set");
        let pattern = Pattern::tiled(&pattern, 1.0).expect("a pattern");
        let rect = domain.rect(&pattern).expect("small");
        assert!(rect.min.x <= -50.0 && rect.max.y >= 91.0);
        assert_eq!(domain.fading(0.0, 41.0), 1.0);
        assert_eq!(domain.fading(-2.0, 43.0), 1.0);
        assert_eq!(domain.fading(50.0, -50.0), 0.0);
        let (x, y) = domain.pixel(3, 4);
        let centre = domain.on_torus(3.5, 4.5);
        assert!((centre.x * domain.width as f64 - (x as f64 + 0.5)).abs() < 1e-12);
        assert!((centre.y * domain.height as f64 - (y as f64 + 0.5)).abs() < 1e-12);
        let exact = Domain::new(&frame, Border::Periodic, 2.0, 0.5).expect("small");
        assert_eq!((exact.width, exact.height, exact.degree), (100, 41, Degree { x: 49, y: 20 }));
        assert_eq!(exact.fading(99.0, 0.0), 1.0);
    }

    #[test]
    fn sizes_beyond_memory_are_refused() {
        let large = Frame::new(1 << 20, 1 << 20).expect("a size");
        assert!(Domain::new(&large, Border::Fade, 2.0, 0.5).is_err());
        // Small as areas, but transforms are as fine along both axes.
        for (width, height) in [(20_000, 64), (64, 20_000), (64_000, 16)] {
            let long = Frame::new(width, height).expect("a size");
            for border in [Border::Fade, Border::Periodic] {
                let refused = Domain::new(&long, border, 2.0, 0.5);
                assert!(matches!(refused, Err(BandLimitedError::TooLarge { .. })), "{width}");
            }
        }
        // What is refused does not hang on which side is longer.
        let accepted = |width, height| {
            let frame = Frame::new(width, height).expect("a size");
            Domain::new(&frame, Border::Periodic, 2.0, 0.5).is_ok()
        };
        for (long, short, fits) in [(11_000, 64, true), (11_400, 64, false), (8000, 500, true)] {
            assert_eq!((accepted(long, short), accepted(short, long)), (fits, fits), "{long}");
        }
        let photograph = Frame::new(1920, 1080).expect("a size");
        assert!(Domain::new(&photograph, Border::Fade, 2.0, 0.5).is_ok());
        let small = Frame::new(64, 64).expect("a size");
        assert!(Domain::new(&small, Border::Periodic, 2.0, 1e9).is_err());
        assert!(
            Domain::new(&small, Border::Periodic, 2.0, 1e-9).is_ok_and(|d| d.degree.most() == 0)
        );
    }
}
