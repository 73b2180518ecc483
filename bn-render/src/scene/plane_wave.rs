//! Constants and plane waves.

use bn_core::DVec2;

use super::{Color, Scene};
use crate::simd::{cos_turns, vectorized};
use crate::{Channels, Rect};

/// The same value everywhere.
#[derive(Clone, Copy, Debug)]
pub struct Constant {
    channels: Channels,
    color: Color,
}

impl Constant {
    /// One grey level.
    pub fn grey(level: f64) -> Self {
        Self { channels: Channels::Grey, color: [level, 0.0, 0.0] }
    }

    /// One colour.
    pub fn rgb(color: Color) -> Self {
        Self { channels: Channels::Rgb, color }
    }
}

impl Scene for Constant {
    fn channels(&self) -> Channels {
        self.channels
    }

    fn values(&self, u: &[f64], _: &[f64], out: &mut [f64]) {
        for (plane, value) in out.chunks_exact_mut(u.len().max(1)).zip(self.color) {
            plane.fill(value);
        }
    }

    fn constant_over(&self, _: &Rect) -> Option<Color> {
        Some(self.color)
    }

    fn local_frequency(&self, _: DVec2) -> Option<DVec2> {
        Some(DVec2::ZERO)
    }
}

/// α cos(2π f·x + phase), thesis eq. 3.17 (α is an amplitude, not a power).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PlaneWave {
    /// α.
    pub amplitude: f64,
    /// f in cycles per pixel.
    pub frequency: DVec2,
    /// The phase at the image's corner in turns.
    pub phase_turns: f64,
}

/// A sum of plane waves around a mean: mean + Σ α cos(2π f·x + phase).
///
/// Its power spectrum has lines of α²/4 at ±f (3.18), for f ≠ 0; at f = 0 a wave is the constant
/// α cos(phase), whose line is the square of that.
#[derive(Clone, Debug)]
pub struct PlaneWaves {
    mean: f64,
    waves: Vec<PlaneWave>,
}

impl PlaneWaves {
    /// The sum of these waves.
    pub fn new(mean: f64, waves: Vec<PlaneWave>) -> Self {
        Self { mean, waves }
    }

    /// The mean.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// The waves.
    pub fn waves(&self) -> &[PlaneWave] {
        &self.waves
    }
}

impl Scene for PlaneWaves {
    fn channels(&self) -> Channels {
        Channels::Grey
    }

    fn values(&self, u: &[f64], v: &[f64], out: &mut [f64]) {
        out.fill(self.mean);
        for wave in &self.waves {
            add_wave(u, v, wave, out);
        }
    }

    fn bounds_over(&self, _: &Rect) -> Option<(f64, f64)> {
        let swing: f64 = self.waves.iter().map(|wave| wave.amplitude.abs()).sum();
        let slack = 1e-12 * (swing + self.mean.abs());
        Some((self.mean - swing - slack, self.mean + swing + slack))
    }

    /// Of a single wave; several have no one frequency.
    fn local_frequency(&self, _: DVec2) -> Option<DVec2> {
        let [wave] = self.waves.as_slice() else { return None };
        Some(wave.frequency)
    }
}

vectorized! {
    fn add_wave(u: &[f64], v: &[f64], wave: &PlaneWave, out: &mut [f64]) {
        let PlaneWave { amplitude, frequency: DVec2 { x: fx, y: fy }, phase_turns } = *wave;
        for ((value, &u), &v) in out.iter_mut().zip(u).zip(v) {
            *value += amplitude * cos_turns(fx * u + fy * v + phase_turns);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waves_add_up() {
        let wave = |amplitude, x, y, phase_turns| PlaneWave {
            amplitude,
            frequency: DVec2::new(x, y),
            phase_turns,
        };
        let waves =
            PlaneWaves::new(0.5, vec![wave(0.3, 0.1, -0.2, 0.25), wave(-0.1, 0.4, 0.0, 0.0)]);
        let turn = std::f64::consts::TAU;
        for i in 0..500 {
            let (u, v) = (f64::from(i) * 0.37 - 20.0, f64::from(i % 23) * 1.3);
            let want = 0.5 + 0.3 * libm::cos(turn * (0.1 * u - 0.2 * v + 0.25))
                - 0.1 * libm::cos(turn * 0.4 * u);
            let got = waves.value(DVec2::new(u, v))[0];
            assert!((got - want).abs() < 1e-13, "{got} against {want}");
            let (low, high) = waves.bounds_over(&Rect::new(0.0, 0.0, 1.0, 1.0)).expect("known");
            assert!((low..=high).contains(&got));
        }
        assert_eq!(waves.local_frequency(DVec2::ZERO), None);
    }

    #[test]
    fn constants_fill_their_channels() {
        let mut out = [9.0; 6];
        Constant::rgb([0.1, 0.2, 0.3]).values(&[0.0, 5.0], &[1.0, 2.0], &mut out);
        assert_eq!(out, [0.1, 0.1, 0.2, 0.2, 0.3, 0.3]);
        let rect = Rect::new(0.0, 0.0, 1.0, 1.0);
        assert_eq!(Constant::rgb([0.1, 0.2, 0.3]).bounds_over(&rect), Some((0.1, 0.3)));
        assert_eq!(Constant::grey(0.25).bounds_over(&rect), Some((0.25, 0.25)));
    }
}
