//! Images from band-limited reconstruction.

use bn_core::Observer;
use rayon::prelude::*;

use super::convergence::{Convergence, Stopping};
use super::domain::{Border, Domain};
use super::error::BandLimitedError;
use super::evaluate::at_pixels;
use super::fit::{BandLimitedFit, level};
use super::response::LowPass;
use crate::watch::{Turn, Watch};
use crate::{Channels, Frame, Image, Pattern, SampleList, Scene};

/// How the polynomial is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum BandLimitedMethod {
    /// [`BandLimitedFit::act`].
    #[default]
    Act,
    /// [`BandLimitedFit::pocs`].
    Pocs,
}

/// How an image is reconstructed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BandLimitedOptions {
    /// The method.
    pub method: BandLimitedMethod,
    /// The band: frequencies along each axis are below so many cycles per pixel. None: by
    /// [`BandLimitedOptions::usual_band`].
    pub band: Option<f64>,
    /// How the image is continued.
    pub border: Border,
    /// When to stop.
    pub stopping: Stopping,
}

impl BandLimitedOptions {
    /// The band for s samples per pixel. √s/4 leaves irregular patterns well-conditioned, with four
    /// samples a coefficient. For low rates it is what images of the pixels' own band, ½, need:
    /// ½, and 1/12 more for what [`Border::Fade`] spreads, down to two samples a coefficient, √(s/8).
    pub fn usual_band(border: Border, samples_per_pixel: f64) -> f64 {
        let root = samples_per_pixel.sqrt();
        let pixels = 0.5 + border.spread();
        (0.25 * root).max((root * std::f64::consts::FRAC_1_SQRT_2 * 0.5).min(pixels))
    }

    /// Whether images of this frame can be reconstructed so, before any sample is taken.
    ///
    /// # Errors
    /// If the band is not a positive number, or grids or samples don't fit into memory.
    pub fn check(
        &self,
        frame: &Frame,
        low_pass: LowPass<'_>,
        samples_per_pixel: f64,
    ) -> Result<(), BandLimitedError> {
        self.domain(frame, low_pass, samples_per_pixel)?.0.check_samples(samples_per_pixel)
    }

    /// The rectangle to reconstruct on, and the band.
    fn domain(
        &self,
        frame: &Frame,
        low_pass: LowPass<'_>,
        samples_per_pixel: f64,
    ) -> Result<(Domain, f64), BandLimitedError> {
        let band = self.band.unwrap_or_else(|| Self::usual_band(self.border, samples_per_pixel));
        if !(band > 0.0 && band.is_finite()) {
            return Err(BandLimitedError::Band { band });
        }
        Ok((Domain::new(frame, self.border, low_pass.reach(), band)?, band))
    }
}

/// What was done for an image.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct BandLimitedStats {
    /// Samples on the periodic rectangle.
    pub samples: u64,
    /// Of these, samples at which the scene was evaluated, once each.
    pub evaluated: u64,
    /// The band in cycles per pixel.
    pub band: f64,
    /// How the iteration went, channel by channel.
    pub convergence: Vec<Convergence>,
}

impl BandLimitedStats {
    /// The most iterations of a channel.
    pub fn iterations(&self) -> usize {
        self.convergence.iter().map(Convergence::iterations).max().unwrap_or(0)
    }

    /// The largest residual of a channel.
    pub fn residual(&self) -> f64 {
        self.convergence.iter().map(|c| c.residual).fold(0.0, f64::max)
    }

    /// The largest condition number that was met, a lower bound of the true one.
    pub fn condition(&self) -> Option<f64> {
        self.convergence.iter().filter_map(|c| c.condition).reduce(f64::max)
    }

    /// Whether every channel reached the tolerance.
    pub fn converged(&self) -> bool {
        self.convergence.iter().all(Convergence::converged)
    }
}

/// Reconstructs the samples of a scene as a band-limited function, and takes its low-passed values at
/// the pixels' centres.
///
/// The pattern's weights, best the areas of its Voronoi cells ([`Pattern::weighted`]), are those of
/// the fit. All samples of the image and of the margin that [`Border`] asks for are held, and the
/// coefficients: images of up to some 2000 × 2000 pixels at 4 samples each. Windows are cut from the
/// whole. The result is the same to the bit for any number of threads; from one processor to another
/// it may differ by some 1e-13.
///
/// Scenes with edges have no band: what lies above it becomes noise, as with every reconstruction,
/// and what lies below rings at the edges, unless the low-pass is a kernel that doesn't.
#[derive(Clone, Copy)]
pub struct BandLimitedRenderer<'a> {
    /// The scene.
    pub scene: &'a dyn Scene,
    /// Where it is sampled.
    pub pattern: &'a Pattern,
    /// What comes after the reconstruction.
    pub low_pass: LowPass<'a>,
    /// The image, and the window of it that is wanted.
    pub frame: Frame,
    /// How it is reconstructed.
    pub options: BandLimitedOptions,
}

/// Samples that are evaluated at a time.
const CHUNK: usize = 4096;

impl BandLimitedRenderer<'_> {
    /// The image of the frame's window.
    ///
    /// # Errors
    /// If image or samples are too many to be held, no sample lies in the image, the band is not a
    /// positive number, the scene is not finite, or the observer asks to stop.
    pub fn image(
        &self,
        observer: &dyn Observer,
    ) -> Result<(Image, BandLimitedStats), BandLimitedError> {
        let (window, channels) = (self.frame.window(), self.scene.channels());
        Image::check_size(window.width, window.height, channels)?;
        let rate = self.pattern.samples_per_pixel();
        let (domain, band) = self.options.domain(&self.frame, self.low_pass, rate)?;
        let samples = Samples::taken(self, &domain, observer)?;
        let points = samples.places.u().iter().zip(samples.places.v());
        let points = points.map(|(&u, &v)| domain.on_torus(u, v)).collect();
        let mut fit = BandLimitedFit::new(points, &samples.weights, domain.degree)?;
        let mut stats = BandLimitedStats {
            samples: samples.places.len() as u64,
            evaluated: samples.evaluated,
            band,
            convergence: Vec::new(),
        };
        let mut values =
            vec![0.0_f32; window.width as usize * window.height as usize * channels.count()];
        for (channel, taken) in samples.values.iter().enumerate() {
            let (level, faded) = samples.faded(taken, &domain);
            let (polynomial, convergence) = match self.options.method {
                BandLimitedMethod::Act => fit.act(&faded, &self.options.stopping, observer)?,
                BandLimitedMethod::Pocs => fit.pocs(&faded, &self.options.stopping, observer)?,
            };
            let level = level + polynomial.constant;
            let pixels = at_pixels(&polynomial.modes, &domain, self.low_pass, window);
            let places = values.iter_mut().skip(channel).step_by(channels.count());
            places.zip(pixels).for_each(|(place, pixel)| *place = (level + pixel) as f32);
            stats.convergence.push(convergence);
        }
        Ok((Image::new(window.width, window.height, channels, values)?, stats))
    }

    /// The channels of the pixels.
    pub fn channels(&self) -> Channels {
        self.scene.channels()
    }
}

/// The samples of the domain.
struct Samples {
    places: SampleList,
    weights: Vec<f64>,
    /// Channel by channel.
    values: Vec<Vec<f64>>,
    evaluated: u64,
}

impl Samples {
    fn taken(
        renderer: &BandLimitedRenderer<'_>,
        domain: &Domain,
        observer: &dyn Observer,
    ) -> Result<Self, BandLimitedError> {
        let rect = domain.rect(renderer.pattern)?;
        let mut places = SampleList::default();
        renderer.pattern.samples_in(&rect, &mut places);
        if places.is_empty() {
            return Err(BandLimitedError::NoSamples);
        }
        let weights = match places.weights() {
            [] => vec![1.0; places.len()],
            weights => weights.to_vec(),
        };
        let channels = renderer.scene.channels().count();
        let constant = renderer.scene.constant_over(&rect);
        if let Some(color) = constant {
            let values = color[..channels].iter().map(|&c| vec![c; places.len()]).collect();
            return Ok(Self { places, weights, values, evaluated: 0 });
        }
        let watch = Watch::new(observer, places.len() as u64);
        let values = evaluated(renderer.scene, &places, channels, &watch);
        if watch.is_stopped() {
            return Err(BandLimitedError::Cancelled);
        }
        let evaluated = places.len() as u64;
        Ok(Self { places, weights, values, evaluated })
    }

    /// The mean of values, and what they differ from it, faded towards the domain's border.
    fn faded(&self, values: &[f64], domain: &Domain) -> (f64, Vec<f64>) {
        let level = level(values, &self.weights);
        let places = self.places.u().par_iter().zip(self.places.v());
        let faded =
            places.zip(values).map(|((&u, &v), value)| domain.fading(u, v) * (value - level));
        (level, faded.collect())
    }
}

/// The scene's values, channel by channel; zeros where the watch was stopped.
fn evaluated(
    scene: &dyn Scene,
    places: &SampleList,
    channels: usize,
    watch: &Watch<'_>,
) -> Vec<Vec<f64>> {
    let chunks: Vec<Vec<f64>> = (places.u().par_chunks(CHUNK))
        .zip(places.v().par_chunks(CHUNK))
        .map_init(Turn::default, |turn, (u, v)| {
            let mut out = vec![0.0; channels * u.len()];
            watch.advanced(u.len());
            if watch.took(u.len(), turn) {
                scene.values(u, v, &mut out);
            }
            out
        })
        .collect();
    let of = |channel: usize| {
        let part = move |chunk: &Vec<f64>| {
            let count = chunk.len() / channels;
            chunk[channel * count..][..count].to_vec()
        };
        chunks.iter().flat_map(part).collect()
    };
    (0..channels).map(of).collect()
}
