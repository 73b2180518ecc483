//! A test image of striped cloth.

use bn_core::DVec2;

use super::Scene;
use crate::simd::cos_turns;
use crate::{Channels, Frame};

/// Striped cloth: drapery in vertical stripes, a diagonal band, a round curved patch and a woven
/// square before a soft background.
///
/// Made to stand in for photographs of striped clothes: most of its energy outside the Nyquist
/// region of a quarter-size image lies left, right and diagonally of it. Stripes have 70 to 180
/// cycles to the image's width, products of two in the weave 210: at 512 pixels all stay below 0.45
/// cycles per pixel, and soft edges keep the rest below Nyquist but for a little.
#[derive(Clone, Copy, Debug)]
pub struct StripedCloth {
    size: DVec2,
}

impl StripedCloth {
    /// The image stretched over the frame.
    pub fn new(frame: &Frame) -> Self {
        Self { size: DVec2::new(f64::from(frame.width()), f64::from(frame.height())) }
    }
}

/// ½(1 + cos) of a phase in turns.
fn wave(turns: f64) -> f64 {
    0.5 + 0.5 * cos_turns(turns)
}

/// 0 below −½, 1 above ½, smooth in between.
fn smooth_step(x: f64) -> f64 {
    let t = (x + 0.5).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

fn mix(a: f64, b: f64, share: f64) -> f64 {
    a + (b - a) * share
}

/// The cloth at a point of the unit square.
fn cloth(p: DVec2) -> f64 {
    /// Soft edges are this wide: six pixels of 512.
    const EDGE: f64 = 6.0 / 512.0;
    let inside = |distance: f64| smooth_step(distance / EDGE);
    let background = 0.35 + 0.25 * p.y + 0.1 * cos_turns(0.7 * p.x + 0.4 * p.y);

    // Drapery on the left: stripes whose spacing follows the folds, shaded by their slope.
    let fold =
        0.011 * cos_turns(3.0 * p.x + 0.9 * p.y) + 0.006 * cos_turns(5.3 * p.x - 1.7 * p.y + 0.3);
    let shade = 0.75 + 0.2 * cos_turns(3.0 * p.x + 0.9 * p.y + 0.25);
    let drapery = shade * (0.15 + 0.7 * wave(118.0 * (p.x + fold)));
    let curtain = inside(0.46 + 0.03 * cos_turns(1.3 * p.y) - p.x);

    // A diagonal band of finer stripes.
    let across = DVec2::new(0.6, 0.8).dot(p - DVec2::new(0.62, 0.62));
    let along = DVec2::new(0.8, -0.6).dot(p);
    let trousers = 0.2 + 0.65 * wave(150.0 * along + 0.8 * cos_turns(1.8 * across));
    let leg = inside(0.13 - across.abs()) * inside(p.x - 0.3);

    // A round patch of curved stripes.
    let d = p - DVec2::new(0.72, 0.24);
    let scarf = 0.25 + 0.6 * wave(125.0 * d.x + 75.0 * d.y + 90.0 * (d.x * d.x + d.y * d.y));
    let head = inside(0.19 - d.length());

    // A woven square.
    let weave = 0.3 + 0.55 * wave(105.0 * (p.x + p.y)) * wave(105.0 * (p.x - p.y));
    let table = inside(p.x - 0.6) * inside(p.y - 0.74);

    let mut value = mix(background, drapery, curtain);
    value = mix(value, weave, table);
    value = mix(value, trousers, leg);
    mix(value, scarf, head)
}

impl Scene for StripedCloth {
    fn channels(&self) -> Channels {
        Channels::Grey
    }

    fn values(&self, u: &[f64], v: &[f64], out: &mut [f64]) {
        for ((value, &u), &v) in out.iter_mut().zip(u).zip(v) {
            *value = cloth(DVec2::new(u, v) / self.size);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_stay_within_range_and_use_it() {
        let scene = StripedCloth::new(&Frame::new(512, 512).expect("a size"));
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for i in 0..512 * 512 {
            let at = DVec2::new(f64::from(i % 512) + 0.5, f64::from(i / 512) + 0.5);
            let value = scene.value(at)[0];
            (low, high) = (low.min(value), high.max(value));
        }
        assert!(low > 0.0 && low < 0.2 && high < 1.0 && high > 0.8, "{low} … {high}");
    }
}
