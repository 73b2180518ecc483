//! Power spectra of images: lines.

use bn_core::DVec2;
use bn_spectral::{Complex, HalfPlane, Nufft, NufftError, NufftOptions};

use crate::{Frame, Image, PlaneWaves};

/// Power at one frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SpectralLine {
    /// In cycles per pixel.
    pub frequency: DVec2,
    /// The squared modulus of the wave's complex amplitude there, in squared units of light.
    pub power: f64,
}

/// The power spectrum `P_I` of an image as a sum of lines, Σ p δ(ν − f), f in cycles per pixel; the
/// powers sum to the mean square of the image.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ImageSpectrum {
    lines: Vec<SpectralLine>,
}

/// Relative error of the amplitudes of an image: its powers are good to twice that.
const TOLERANCE: f64 = 1e-9;

impl ImageSpectrum {
    /// The spectrum of these lines, f and −f both given.
    ///
    /// # Panics
    /// If a frequency is not finite, or a power is negative or not finite.
    pub fn from_lines(lines: Vec<SpectralLine>) -> Self {
        let good = |line: &SpectralLine| {
            line.frequency.is_finite() && line.power >= 0.0 && line.power.is_finite()
        };
        assert!(lines.iter().all(good), "a line has a finite frequency and a power");
        Self { lines }
    }

    /// A constant: a line of `level`² at 0 (eq. 3.16, where α is the amplitude).
    pub fn of_constant(level: f64) -> Self {
        Self { lines: vec![SpectralLine { frequency: DVec2::ZERO, power: level * level }] }
    }

    /// Plane waves about their mean: α²/4 at f and −f for each (eq. 3.18), the square of the mean
    /// at 0.
    ///
    /// Waves of one frequency add in amplitude, and so does a wave of frequency 0 to the mean: it
    /// is the constant α cos φ, of power α² for φ = 0, and not the α²/2 that (3.18) and (3.19) would
    /// give there.
    pub fn of_waves(scene: &PlaneWaves) -> Self {
        let mut amplitudes = vec![(DVec2::ZERO, Complex::new(scene.mean(), 0.0))];
        for wave in scene.waves() {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * wave.phase_turns);
            let half = Complex::new(cos, sin) * (0.5 * wave.amplitude);
            for (f, amplitude) in [(wave.frequency, half), (-wave.frequency, half.conj())] {
                match amplitudes.iter_mut().find(|(at, _)| *at == f) {
                    Some((_, sum)) => *sum += amplitude,
                    None => amplitudes.push((f, amplitude)),
                }
            }
        }
        let line =
            |(frequency, a): (DVec2, Complex<f64>)| SpectralLine { frequency, power: a.norm_sqr() };
        Self { lines: amplitudes.into_iter().map(line).collect() }
    }

    /// The periodogram of an image that covers `frame`: of its pixels, taken as samples of a
    /// function that repeats at the image's borders; the mean over the channels.
    ///
    /// Lines lie at (i/W, j/H) for a frame of W × H pixels, as many as the image has pixels. What
    /// lies between the pixels (their interpolation) is not part of it, and edges where opposite
    /// borders don't fit add power along the axes.
    ///
    /// Cost: O(m² log m) and some 30 m² bytes, m the longer side, whatever the shorter one is.
    ///
    /// # Errors
    /// If a side of the image is above 2¹⁷ pixels.
    pub fn of_image(image: &Image, frame: &Frame) -> Result<Self, NufftError> {
        let (width, height) = (image.width() as usize, image.height() as usize);
        let limit = width.max(height) / 2;
        let mut plan: Nufft =
            NufftOptions::new(limit, TOLERANCE).expecting(width * height).plan()?;
        let place = |i: usize| {
            let (x, y) = ((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
            DVec2::new(x / width as f64, y / height as f64)
        };
        let points: Vec<DVec2> = (0..width * height).map(place).collect();
        let mut lines = dft_frequencies(image, frame);
        let channels = image.channels().count();
        for channel in 0..channels {
            let values = image.values().iter().skip(channel).step_by(channels);
            let values: Vec<f64> = values.map(|&value| f64::from(value)).collect();
            let mut modes = HalfPlane::zeros(limit);
            plan.points_to_modes(&points, Some(&values), &mut modes);
            let share = 1.0 / (points.len() as f64).powi(2) / channels as f64;
            for (line, k) in &mut lines {
                line.power += share * modes.get(k.0, k.1).norm_sqr();
            }
        }
        Ok(Self { lines: lines.into_iter().map(|(line, _)| line).collect() })
    }

    /// The lines.
    pub fn lines(&self) -> &[SpectralLine] {
        &self.lines
    }

    /// The sum of all powers: the mean square of the image.
    pub fn total_power(&self) -> f64 {
        self.lines.iter().map(|line| line.power).sum()
    }

    /// The same without its mean: about what normalised convolution leaves of the error, as it
    /// reconstructs constants exactly.
    #[must_use]
    pub fn without_mean(mut self) -> Self {
        self.lines.retain(|line| line.frequency != DVec2::ZERO);
        self
    }
}

/// A line without power for each frequency of the image's discrete transform, with its wave vector
/// in cycles per image.
fn dft_frequencies(image: &Image, frame: &Frame) -> Vec<(SpectralLine, (i64, i64))> {
    let range = |side: u32| {
        let side = i64::from(side);
        -(side / 2)..side - side / 2
    };
    let (width, height) = (f64::from(frame.width()), f64::from(frame.height()));
    let line = |kx: i64, ky: i64| {
        let frequency = DVec2::new(kx as f64 / width, ky as f64 / height);
        (SpectralLine { frequency, power: 0.0 }, (kx, ky))
    };
    range(image.height()).flat_map(|ky| range(image.width()).map(move |kx| line(kx, ky))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Channels, PlaneWave, Scene};

    fn wave(amplitude: f64, x: f64, y: f64, phase_turns: f64) -> PlaneWave {
        PlaneWave { amplitude, frequency: DVec2::new(x, y), phase_turns }
    }

    #[test]
    fn waves_have_two_lines_and_constants_one() {
        let scene = PlaneWaves::new(0.5, vec![wave(0.3, 0.1, -0.2, 0.4)]);
        let spectrum = ImageSpectrum::of_waves(&scene);
        assert_eq!(spectrum.lines().len(), 3);
        assert!((spectrum.total_power() - (0.25 + 0.045)).abs() < 1e-15);
        assert!((spectrum.without_mean().total_power() - 0.045).abs() < 1e-15);
        // f = 0: amplitudes add, whatever the phase.
        let flat = ImageSpectrum::of_waves(&PlaneWaves::new(0.5, vec![wave(0.3, 0.0, 0.0, 0.0)]));
        assert!((flat.total_power() - 0.64).abs() < 1e-15);
        assert_eq!(ImageSpectrum::of_constant(0.8).total_power(), 0.8 * 0.8);
        // Two waves of one frequency, in opposite phase.
        let waves = vec![wave(0.3, 0.1, 0.0, 0.0), wave(0.1, -0.1, 0.0, 0.5)];
        let power = ImageSpectrum::of_waves(&PlaneWaves::new(0.0, waves)).total_power();
        assert!((power - 0.02).abs() < 1e-15, "{power}");
    }

    #[test]
    fn images_have_the_lines_of_their_waves() {
        for (width, height) in [(30_u32, 20_u32), (21, 33)] {
            let frame = Frame::new(2 * width, 2 * height).expect("a size");
            let (fx, fy) = (4.0 / f64::from(width), -7.0 / f64::from(height));
            let scene = PlaneWaves::new(0.4, vec![wave(0.2, fx, fy, 0.1)]);
            let at = |i: u32| {
                let (x, y) = (f64::from(i % width) + 0.5, f64::from(i / width) + 0.5);
                scene.value(DVec2::new(x, y))[0] as f32
            };
            let values: Vec<f32> = (0..width * height).map(at).collect();
            let grey = Image::new(width, height, Channels::Grey, values.clone()).expect("fits");
            let spectrum = ImageSpectrum::of_image(&grey, &frame).expect("small");
            assert_eq!(spectrum.lines().len(), (width * height) as usize);
            for line in spectrum.lines() {
                // Half the frequency, as the image covers a frame of twice its size.
                let near = |f: DVec2| line.frequency.distance(0.5 * f) < 1e-12;
                let want = if line.frequency == DVec2::ZERO {
                    0.16
                } else if near(DVec2::new(fx, fy)) || near(DVec2::new(-fx, -fy)) {
                    0.01
                } else {
                    0.0
                };
                // The values' rounding to f32.
                assert!((line.power - want).abs() < 1e-7, "{line:?}, not {want}");
            }
            let colored = values.iter().flat_map(|&v| [v, 2.0 * v, 0.0]).collect();
            let rgb = Image::new(width, height, Channels::Rgb, colored).expect("fits");
            let all = ImageSpectrum::of_image(&rgb, &frame).expect("small").total_power();
            assert!((all - 5.0 / 3.0 * spectrum.total_power()).abs() < 1e-9, "{all}");
        }
    }
}
