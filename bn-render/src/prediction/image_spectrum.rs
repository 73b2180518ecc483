//! Power spectra of images: lines.

use bn_core::DVec2;
use bn_fft::{Complex, Fft, Planner};
use rayon::prelude::*;

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
    /// borders don't fit add power along the axes, which few patterns but lattices pick out:
    /// [`ImageSpectrum::of_faded_image`] has no such edges.
    ///
    /// Powers are good to 1e-14 of the image's. Cost: an FFT of the image's size for each channel, and
    /// up to 80 bytes a pixel.
    pub fn of_image(image: &Image, frame: &Frame) -> Self {
        Self::of_pixels(image, frame, |_| ())
    }

    /// The periodogram of an image that covers `frame` and need not repeat: what differs from a
    /// channel's mean is faded to nothing at the borders, by a Tukey window over 1/16 of each side,
    /// and scaled such that detail that fills the image evenly keeps its power. Nothing is faded along
    /// sides shorter than 64 pixels, of which a ramp would have less than four.
    ///
    /// Otherwise as [`ImageSpectrum::of_image`], the mean's line too; a line leaves 4.7 % of its power to
    /// its neighbours along each axis, most of it to the nearest 16.
    pub fn of_faded_image(image: &Image, frame: &Frame) -> Self {
        let [across, down] = [image.width(), image.height()].map(|side| tukey(side as usize));
        Self::of_pixels(image, frame, |pixels| {
            let mean = about_mean(pixels);
            for (row, weight) in pixels.chunks_exact_mut(across.len()).zip(&down) {
                row.iter_mut().zip(&across).for_each(|(value, w)| *value *= w * weight);
            }
            about_mean(pixels);
            for value in pixels.iter_mut() {
                *value += mean;
            }
        })
    }

    /// The mean over the channels of the periodograms of what `prepare` makes of their pixels, row by
    /// row.
    fn of_pixels(image: &Image, frame: &Frame, prepare: impl Fn(&mut [Complex<f64>])) -> Self {
        let (width, height) = (image.width() as usize, image.height() as usize);
        let mut planner = Planner::<f64>::new();
        let transforms = [width, height].map(|length| planner.forward(length));
        let channels = image.channels().count();
        let share = 1.0 / ((width * height) as f64).powi(2) / channels as f64;
        // Column by column.
        let mut powers = vec![0.0; width * height];
        for channel in 0..channels {
            let values = image.values().iter().skip(channel).step_by(channels);
            let mut rows: Vec<_> = values.map(|&v| Complex::new(f64::from(v), 0.0)).collect();
            prepare(&mut rows);
            let rows = transformed(rows, &*transforms[0]);
            let columns = transformed(transposed(&rows, width), &*transforms[1]);
            let parts = powers.par_iter_mut().zip(&columns);
            parts.for_each(|(power, mode)| *power += share * mode.norm_sqr());
        }
        Self { lines: dft_lines(&powers, (image.width(), image.height()), frame) }
    }

    /// The lines.
    pub fn lines(&self) -> &[SpectralLine] {
        &self.lines
    }

    /// The sum of all powers: the mean square of the image.
    pub fn total_power(&self) -> f64 {
        self.lines.iter().map(|line| line.power).sum()
    }

    /// The same without its mean, which normalised convolution reconstructs exactly: an upper estimate
    /// of what that leaves of the error, as it takes more of what changes slowly (up to 7 dB for blue
    /// noise of 128 samples per pixel).
    #[must_use]
    pub fn without_mean(mut self) -> Self {
        self.lines.retain(|line| line.frequency != DVec2::ZERO);
        self
    }
}

/// Takes these values' mean from them, and returns it.
fn about_mean(values: &mut [Complex<f64>]) -> Complex<f64> {
    let mean = values.iter().sum::<Complex<f64>>() / values.len() as f64;
    for value in values.iter_mut() {
        *value -= mean;
    }
    mean
}

/// A side's weights: rising over 1/16 of it at both ends as half a cosine, of mean square 1.
fn tukey(side: usize) -> Vec<f64> {
    let ramp = if side < 64 { 0 } else { side / 16 };
    let rise = |i: usize| {
        let t = (i.min(side - 1 - i) as f64 + 0.5) / ramp as f64;
        if t < 1.0 { 0.5 - 0.5 * libm::cos(std::f64::consts::PI * t) } else { 1.0 }
    };
    let weights: Vec<f64> = (0..side).map(rise).collect();
    let scale = (side as f64 / weights.iter().map(|w| w * w).sum::<f64>()).sqrt();
    weights.into_iter().map(|w| scale * w).collect()
}

/// The transforms of the rows, in place; each as long as the transform.
fn transformed(mut rows: Vec<Complex<f64>>, fft: &dyn Fft<f64>) -> Vec<Complex<f64>> {
    rows.par_chunks_exact_mut(fft.len()).for_each_init(
        || vec![Complex::new(0.0, 0.0); fft.get_inplace_scratch_len()],
        |scratch, row| fft.process_with_scratch(row, scratch),
    );
    rows
}

/// Rows of this width as columns.
fn transposed(rows: &[Complex<f64>], width: usize) -> Vec<Complex<f64>> {
    let height = rows.len() / width;
    let mut columns = vec![Complex::new(0.0, 0.0); rows.len()];
    columns.par_chunks_exact_mut(height).enumerate().for_each(|(x, column)| {
        column.iter_mut().enumerate().for_each(|(y, value)| *value = rows[y * width + x]);
    });
    columns
}

/// The lines of powers that come column by column, frequencies from 0 up and round to −1.
fn dft_lines(powers: &[f64], (width, height): (u32, u32), frame: &Frame) -> Vec<SpectralLine> {
    let range = |side: u32| {
        let side = i64::from(side);
        -(side / 2)..side - side / 2
    };
    let place = |k: i64, side: u32| k.rem_euclid(side.into()) as usize;
    let size = DVec2::new(frame.width().into(), frame.height().into());
    let line = |kx: i64, ky: i64| SpectralLine {
        frequency: DVec2::new(kx as f64, ky as f64) / size,
        power: powers[place(kx, width) * height as usize + place(ky, height)],
    };
    range(height).flat_map(|ky| range(width).map(move |kx| line(kx, ky))).collect()
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

    /// Against sums by definition, of odd, even, long and tiny images.
    #[test]
    fn lines_of_images_are_their_discrete_transform() {
        for (width, height) in [(1_u32, 1_u32), (1, 7), (6, 5), (40, 3), (2, 30)] {
            let frame = Frame::new(width, height).expect("a size");
            let value = |i: u32| (f64::from(i * i % 23) / 23.0) as f32;
            let values: Vec<f32> = (0..width * height).map(value).collect();
            let image = Image::new(width, height, Channels::Grey, values.clone()).expect("fits");
            let lines = ImageSpectrum::of_image(&image, &frame);
            assert_eq!(lines.lines().len(), values.len());
            for line in lines.lines() {
                let mut sum = Complex::new(0.0, 0.0);
                for (i, &value) in (0_u32..).zip(&values) {
                    let place = DVec2::new(f64::from(i % width), f64::from(i / width));
                    let (sin, cos) =
                        libm::sincos(-std::f64::consts::TAU * line.frequency.dot(place));
                    sum += Complex::new(cos, sin) * f64::from(value);
                }
                let want = sum.norm_sqr() / (values.len() as f64).powi(2);
                assert!((line.power - want).abs() < 1e-14, "{line:?}, not {want}");
            }
        }
    }

    /// As long as images come: what is needed is the image's own size.
    #[test]
    fn long_images_take_no_more_than_others() {
        let (width, height) = (200_000, 2);
        let frame = Frame::new(width, height).expect("a size");
        let values: Vec<f32> = (0..width * height).map(|i| (i % 7) as f32).collect();
        let mean_square =
            values.iter().map(|v| f64::from(v * v)).sum::<f64>() / values.len() as f64;
        let image = Image::new(width, height, Channels::Grey, values).expect("fits");
        let total = ImageSpectrum::of_image(&image, &frame).total_power();
        assert!((total / mean_square - 1.0).abs() < 1e-12, "{total}");
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
            let spectrum = ImageSpectrum::of_image(&grey, &frame);
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
            let all = ImageSpectrum::of_image(&rgb, &frame).total_power();
            assert!((all - 5.0 / 3.0 * spectrum.total_power()).abs() < 1e-9, "{all}");
        }
    }

    /// A slope's ends don't fit: repeated, it has power 1/(2π² sin²) along its axis, which fading takes
    /// away; waves keep theirs, wherever they lie between the lines, and constants stay constant.
    #[test]
    fn faded_images_have_no_edges_at_their_borders() {
        let (width, height) = (128_u32, 96_u32);
        let frame = Frame::new(width, height).expect("a size");
        let image = |value: &dyn Fn(f64, f64) -> f64| {
            let at = |i: u32| value(f64::from(i % width) + 0.5, f64::from(i / width) + 0.5) as f32;
            let values = (0..width * height).map(at).collect();
            Image::new(width, height, Channels::Grey, values).expect("fits")
        };
        let fast = |spectrum: &ImageSpectrum| {
            let far = |line: &&SpectralLine| line.frequency.x.abs() > 0.25;
            spectrum.lines().iter().filter(far).map(|line| line.power).sum::<f64>()
        };
        let slope = image(&|x, _| x / 128.0);
        let (repeated, faded) = (
            fast(&ImageSpectrum::of_image(&slope, &frame)),
            fast(&ImageSpectrum::of_faded_image(&slope, &frame)),
        );
        // Σ 1/(4 W² sin²(πk/W)) over W/4 < |k|: nearly 1/(2πW).
        assert!((repeated * std::f64::consts::TAU * 128.0 - 1.0).abs() < 0.1, "{repeated}");
        assert!(faded < 2e-3 * repeated, "{faded} {repeated}");
        let wave = PlaneWaves::new(0.4, vec![wave(0.2, 0.2113, -0.173, 0.1)]);
        let seen = image(&|x, y| wave.value(DVec2::new(x, y))[0]);
        let spectrum = ImageSpectrum::of_faded_image(&seen, &frame);
        // Up to the power of the square of the window at twice the frequency.
        assert!((spectrum.total_power() - 0.18).abs() < 2e-4, "{}", spectrum.total_power());
        let flat = ImageSpectrum::of_faded_image(&image(&|_, _| 0.3), &frame).without_mean();
        assert!(flat.total_power() < 1e-20, "{}", flat.total_power());
        // Too small to be faded.
        let values = (0..63).map(|i| (i * i % 17) as f32 / 17.0).collect();
        let small = Image::new(63, 1, Channels::Grey, values).expect("fits");
        let frame = Frame::new(63, 1).expect("a size");
        let powers = |spectrum: &ImageSpectrum| -> Vec<f64> {
            spectrum.lines().iter().map(|line| line.power).collect()
        };
        let (want, got) = (
            ImageSpectrum::of_image(&small, &frame),
            ImageSpectrum::of_faded_image(&small, &frame),
        );
        let both = powers(&want).into_iter().zip(powers(&got));
        both.for_each(|(want, got)| assert!((want - got).abs() < 1e-16, "{got} {want}"));
    }
}
