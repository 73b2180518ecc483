//! Zone plates: concentric waves whose frequency grows with the radius.

#![expect(clippy::inline_always, reason = "must be compiled anew under the features of the caller")]

use bn_core::DVec2;

use super::Scene;
use crate::simd::{cos_turns, vectorized};
use crate::{Channels, Frame, Rect};

/// I = ½(1 + cos(π f ρ²/R)), ρ the distance from the image's centre and R half its width (thesis
/// eq. 3.20, scaled): the local frequency is f·ρ/R, hence f cycles per pixel at ρ = R.
///
/// Absolute error below 1e-15·(1 + 3 T) with T = f ρ²/2R, the phase in turns, which is rounded a few
/// times: 3e-11 after ten thousand rings.
#[derive(Clone, Copy, Debug)]
pub struct ZonePlate {
    center: DVec2,
    /// f/2R: turns of the cosine for each squared pixel.
    turns_per_square: f64,
}

impl ZonePlate {
    /// The zone plate of this local frequency, in cycles per pixel, at half the image's width.
    pub fn new(frame: &Frame, frequency: f64) -> Self {
        let (center, half_width) = middle(frame);
        Self { center, turns_per_square: frequency / (2.0 * half_width) }
    }
}

/// The image's centre and half its width.
fn middle(frame: &Frame) -> (DVec2, f64) {
    let half = 0.5 * DVec2::new(f64::from(frame.width()), f64::from(frame.height()));
    (half, half.x)
}

impl Scene for ZonePlate {
    fn channels(&self) -> Channels {
        Channels::Grey
    }

    fn values(&self, u: &[f64], v: &[f64], out: &mut [f64]) {
        fill_plate(u, v, self.center.x, self.center.y, self.turns_per_square, out);
    }

    fn bounds_over(&self, rect: &Rect) -> Option<(f64, f64)> {
        let (near, far) = distances(self.center, rect);
        let turns = |rho: f64| rho * rho * self.turns_per_square;
        Some(wave_bounds(turns(near), turns(far)))
    }

    fn local_frequency(&self, at: DVec2) -> Option<DVec2> {
        Some((at - self.center) * (2.0 * self.turns_per_square))
    }
}

vectorized! {
    fn fill_plate(u: &[f64], v: &[f64], cx: f64, cy: f64, turns_per_square: f64, out: &mut [f64]) {
        for ((value, &u), &v) in out.iter_mut().zip(u).zip(v) {
            let (dx, dy) = (u - cx, v - cy);
            *value = 0.5 + 0.5 * cos_turns((dx * dx + dy * dy) * turns_per_square);
        }
    }
}

/// The zone plate of limited frequency (thesis §5.4.1): with α = min(ρ/ρ₁, 1) and
/// φ = max(ρ − ρ₁, 0), I = ½(1 + cos[π ν₁ (α ρ + φ)]).
///
/// The thesis's z′ lacks the factor π and so ends at ν₁/π cycles; here the local frequency is
/// ν₁·ρ/ρ₁ up to ρ₁ and ν₁ beyond, and the phase is continuous.
#[derive(Clone, Copy, Debug)]
pub struct LimitedZonePlate {
    center: DVec2,
    cut_frequency: f64,
    cut_radius: f64,
}

impl LimitedZonePlate {
    /// The plate whose local frequency reaches `cut_frequency`, in cycles per pixel, at
    /// `cut_radius` pixels from the centre and stays there.
    ///
    /// # Panics
    /// If `cut_radius` is not positive.
    pub fn new(frame: &Frame, cut_frequency: f64, cut_radius: f64) -> Self {
        assert!(cut_radius > 0.0, "the cut-off radius {cut_radius} is not positive");
        Self { center: middle(frame).0, cut_frequency, cut_radius }
    }
}

impl Scene for LimitedZonePlate {
    fn channels(&self) -> Channels {
        Channels::Grey
    }

    fn values(&self, u: &[f64], v: &[f64], out: &mut [f64]) {
        let (half_frequency, cut) = (0.5 * self.cut_frequency, self.cut_radius);
        fill_limited(u, v, self.center.x, self.center.y, half_frequency, cut, out);
    }

    fn bounds_over(&self, rect: &Rect) -> Option<(f64, f64)> {
        let (near, far) = distances(self.center, rect);
        let turns = |rho: f64| limited_turns(rho, 0.5 * self.cut_frequency, self.cut_radius);
        Some(wave_bounds(turns(near), turns(far)))
    }

    fn local_frequency(&self, at: DVec2) -> Option<DVec2> {
        let d = at - self.center;
        let reach = d.length().max(self.cut_radius);
        Some(d * (self.cut_frequency / reach))
    }
}

/// The phase in turns, ½ν₁·(α ρ + φ).
#[inline(always)]
fn limited_turns(rho: f64, half_frequency: f64, cut: f64) -> f64 {
    let inner = rho.min(cut);
    half_frequency * (inner * rho / cut + (rho - inner))
}

vectorized! {
    fn fill_limited(
        u: &[f64], v: &[f64], cx: f64, cy: f64, half_frequency: f64, cut: f64, out: &mut [f64],
    ) {
        for ((value, &u), &v) in out.iter_mut().zip(u).zip(v) {
            let (dx, dy) = (u - cx, v - cy);
            let rho = (dx * dx + dy * dy).sqrt();
            *value = 0.5 + 0.5 * cos_turns(limited_turns(rho, half_frequency, cut));
        }
    }
}

/// The smallest and largest distance of a rectangle's points from `center`.
fn distances(center: DVec2, rect: &Rect) -> (f64, f64) {
    let nearest = center.clamp(rect.min, rect.max);
    let farthest = (center - rect.min).abs().max((rect.max - center).abs());
    ((center - nearest).length(), farthest.length())
}

/// Bounds of ½(1 + cos 2πt) for t between `a` and `b`.
fn wave_bounds(a: f64, b: f64) -> (f64, f64) {
    // Rounding of cosines and phases, so that the bounds hold for computed values too.
    const SLACK: f64 = 1e-9;
    let slack = SLACK + 1e-15 * a.abs().max(b.abs());
    let (low, high) = (a.min(b) - slack, a.max(b) + slack);
    let ends = [low, high].map(|t| 0.5 + 0.5 * cos_turns(t));
    // The cosine is 1 at whole turns and −1 half a turn later.
    let reaches = |offset: f64| (high - offset).floor() >= (low - offset).ceil();
    let lower = if reaches(0.5) { 0.0 } else { ends[0].min(ends[1]) };
    let upper = if reaches(0.0) { 1.0 } else { ends[0].max(ends[1]) };
    (lower - SLACK, upper + SLACK)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame() -> Frame {
        Frame::new(120, 80).expect("a size")
    }

    #[test]
    fn values_follow_the_equation() {
        let (plate, limited) =
            (ZonePlate::new(&frame(), 0.7), LimitedZonePlate::new(&frame(), 0.4, 25.0));
        let pi = std::f64::consts::PI;
        for i in 0..2000 {
            let at = DVec2::new(f64::from(i % 61) * 2.1 - 3.0, f64::from(i / 61) * 2.7 - 4.0);
            let rho = at.distance(DVec2::new(60.0, 40.0));
            let want = 0.5 * (1.0 + libm::cos(pi * 0.7 * rho * rho / 60.0));
            assert!((plate.value(at)[0] - want).abs() < 1e-12, "{at}");
            let (alpha, phi) = ((rho / 25.0).min(1.0), (rho - 25.0).max(0.0));
            let want = 0.5 * (1.0 + libm::cos(pi * 0.4 * (alpha * rho + phi)));
            assert!((limited.value(at)[0] - want).abs() < 1e-12, "{at}");
        }
    }

    /// Against phases in whole numbers, far out in large images.
    #[test]
    fn values_stay_accurate_after_ten_thousand_rings() {
        for (width, frequency) in [(16_384_u32, 1_u64), (22_628, 1), (32_768, 3)] {
            let frame = Frame::new(width, width).expect("a size");
            let plate = ZonePlate::new(&frame, frequency as f64);
            for i in 0..20_000_u64 {
                // 64ths of a pixel; all of this is exact.
                let (x, y) = (i * i * 7919 % (64 * 11_000), i * 104_729 % (64 * 11_000));
                let at = plate.center + DVec2::new(x as f64, y as f64) / 64.0;
                // T = f ρ²/W in 4096ths, modulo whole turns.
                let period = 4096 * u64::from(width);
                let part = frequency * (x * x + y * y) % period;
                let want =
                    0.5 + 0.5 * libm::cos(std::f64::consts::TAU * part as f64 / period as f64);
                let turns = (frequency * (x * x + y * y)) as f64 / period as f64;
                let got = plate.value(at)[0];
                assert!(
                    (got - want).abs() < 1e-15 * (1.0 + 3.0 * turns),
                    "{got} {want} at {turns}"
                );
            }
        }
    }

    #[test]
    fn the_local_frequency_is_the_derivative_of_the_phase() {
        let limited = LimitedZonePlate::new(&frame(), 0.4, 25.0);
        for x in [1.0, 10.0, 24.9, 25.1, 50.0] {
            let h = 1e-6;
            let turns = |rho| limited_turns(rho, 0.2, 25.0);
            let want = (turns(x + h) - turns(x - h)) / (2.0 * h);
            let got = limited.local_frequency(DVec2::new(60.0 + x, 40.0)).expect("a wave");
            assert!((got.x - want).abs() < 1e-8 && got.y == 0.0, "at {x}: {got} against {want}");
        }
        let plate = ZonePlate::new(&frame(), 1.0);
        let edge = plate.local_frequency(DVec2::new(60.0, 100.0)).expect("a wave");
        assert!((edge.length() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn bounds_hold_and_bite() {
        let scenes: [&dyn Scene; 2] =
            [&ZonePlate::new(&frame(), 0.3), &LimitedZonePlate::new(&frame(), 0.2, 25.0)];
        let mut narrow = 0;
        for scene in scenes {
            for i in 0..300 {
                let corner = DVec2::new(f64::from(i % 20) * 6.0, f64::from(i / 20) * 5.3);
                let rect = Rect { min: corner, max: corner + DVec2::new(0.8, 1.3) };
                let (low, high) = scene.bounds_over(&rect).expect("known");
                narrow += usize::from(high - low < 0.9);
                for j in 0..81 {
                    let step = DVec2::new(f64::from(j % 9) / 8.0, f64::from(j / 9) / 8.0);
                    let at = (rect.min + step * (rect.max - rect.min)).min(rect.max);
                    let value = scene.value(at)[0];
                    assert!((low..=high).contains(&value), "{value} at {at}, {low} … {high}");
                }
            }
        }
        assert!(narrow > 100, "{narrow} narrow bounds of 600");
    }
}
