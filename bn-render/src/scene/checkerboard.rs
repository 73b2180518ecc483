//! An infinite checkerboard seen up to its horizon.

#![expect(clippy::inline_always, reason = "must be compiled anew under the features of the caller")]

use super::{Color, Scene};
use crate::simd::vectorized;
use crate::{Channels, Frame, Rect};

/// A plane of black (0) and white (1) squares under a camera that looks at the horizon, and a sky
/// of one level above it.
///
/// At d pixels below the horizon the plane's coordinates, in squares, are ((u − u₀)·k/d, f·k/d):
/// u₀ is the image's middle, f the focal length (the image's width, a field of view of 53°) and k
/// sets the size of the squares. Frequencies grow without limit towards the horizon. Cost: two
/// divisions a sample.
#[derive(Clone, Copy, Debug)]
pub struct Checkerboard {
    view: View,
    sky: f64,
}

/// The camera, in pixels.
#[derive(Clone, Copy, Debug)]
struct View {
    middle: f64,
    horizon: f64,
    focal: f64,
    /// k: pixels below the horizon at which a square is one pixel wide.
    square: f64,
}

impl View {
    /// A point's coordinates on the plane in squares; meaningless above the horizon.
    #[inline(always)]
    fn board(&self, u: f64, v: f64) -> (f64, f64) {
        let scale = self.square / (v - self.horizon);
        ((u - self.middle) * scale, self.focal * scale)
    }
}

impl Checkerboard {
    /// The board with its horizon at `horizon` of the image's height from the top, with `squares`
    /// squares along the lower edge of the image, under a sky of level `sky`.
    ///
    /// # Panics
    /// If `horizon` is not in [0, 1) or `squares` is not positive.
    pub fn new(frame: &Frame, horizon: f64, squares: f64, sky: f64) -> Self {
        assert!((0.0..1.0).contains(&horizon), "the horizon {horizon} is not within the image");
        assert!(squares > 0.0, "{squares} squares are no board");
        let (width, height) = (f64::from(frame.width()), f64::from(frame.height()));
        let below = height * (1.0 - horizon);
        let view = View {
            middle: 0.5 * width,
            horizon: height * horizon,
            focal: width,
            square: squares * below / width,
        };
        Self { view, sky }
    }

    /// The horizon's v in pixels.
    pub fn horizon(&self) -> f64 {
        self.view.horizon
    }
}

impl Scene for Checkerboard {
    fn channels(&self) -> Channels {
        Channels::Grey
    }

    fn values(&self, u: &[f64], v: &[f64], out: &mut [f64]) {
        fill_board(u, v, &self.view, self.sky, out);
    }

    fn constant_over(&self, rect: &Rect) -> Option<Color> {
        if rect.max.y <= self.view.horizon {
            return Some([self.sky, 0.0, 0.0]);
        }
        if rect.min.y <= self.view.horizon {
            return None;
        }
        // The image of a rectangle is convex, so its corners tell; and the far side has both
        // extremes along the view, u either.
        let near = [rect.min.x, rect.max.x].map(|u| self.view.board(u, rect.max.y));
        let far = [rect.min.x, rect.max.x].map(|u| self.view.board(u, rect.min.y));
        let xs = [near[0].0, near[1].0, far[0].0, far[1].0];
        let column = one_cell(
            xs.iter().copied().fold(f64::INFINITY, f64::min),
            xs.into_iter().fold(f64::NEG_INFINITY, f64::max),
        )?;
        let row = one_cell(near[0].1, far[0].1)?;
        Some([parity(column + row), 0.0, 0.0])
    }

    fn bounds_over(&self, rect: &Rect) -> Option<(f64, f64)> {
        let whole = (self.sky.min(0.0), self.sky.max(1.0));
        Some(self.constant_over(rect).map_or(whole, |color| (color[0], color[0])))
    }
}

/// The cell that holds both ends, if one does, with room for rounding.
fn one_cell(low: f64, high: f64) -> Option<f64> {
    let room = 1e-9 * (1.0 + low.abs().max(high.abs()));
    let cell = (low - room).floor();
    (cell == (high + room).floor()).then_some(cell)
}

/// 1 for an odd whole number, else 0.
#[inline(always)]
fn parity(whole: f64) -> f64 {
    whole - 2.0 * (0.5 * whole).floor()
}

vectorized! {
    fn fill_board(u: &[f64], v: &[f64], view: &View, sky: f64, out: &mut [f64]) {
        for ((value, &u), &v) in out.iter_mut().zip(u).zip(v) {
            let (x, z) = view.board(u, v);
            let square = parity(x.floor() + z.floor());
            *value = if v > view.horizon { square } else { sky };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::DVec2;

    fn board() -> Checkerboard {
        Checkerboard::new(&Frame::new(200, 100).expect("a size"), 0.3, 9.0, 0.5)
    }

    #[test]
    fn squares_alternate_and_end_at_the_horizon() {
        let board = board();
        assert_eq!(board.value(DVec2::new(77.0, 30.0))[0], 0.5);
        assert_eq!(board.value(DVec2::new(77.0, 5.0))[0], 0.5);
        // Along the lower edge: squares of 200/9 pixels, a corner in the middle.
        let edge = |u: f64| board.value(DVec2::new(u, 99.999_999))[0];
        for i in 0..4 {
            let (left, right) =
                (100.0 - 200.0 / 9.0 * f64::from(i), 100.0 + 200.0 / 9.0 * f64::from(i));
            assert_ne!(edge(left - 1.0), edge(left - 1.0 - 200.0 / 9.0));
            assert_ne!(edge(right + 1.0), edge(right + 1.0 + 200.0 / 9.0));
        }
        for v in [30.000_001, 30.0 + 1e-12, 50.0] {
            let value = board.value(DVec2::new(3.3, v))[0];
            assert!(value == 0.0 || value == 1.0);
        }
    }

    #[test]
    fn promised_constants_are_constant() {
        let board = board();
        let mut promised = 0;
        for i in 0..2000 {
            let corner = DVec2::new(f64::from(i % 50) * 4.1 - 2.0, f64::from(i / 50) * 2.6);
            let rect = Rect { min: corner, max: corner + DVec2::new(5.0, 2.0) };
            let Some(color) = board.constant_over(&rect) else { continue };
            promised += 1;
            for j in 0..121 {
                let step = DVec2::new(f64::from(j % 11) / 10.0, f64::from(j / 11) / 10.0);
                let at = (rect.min + step * (rect.max - rect.min)).min(rect.max);
                assert_eq!(board.value(at), color, "at {at}");
            }
        }
        assert!(promised > 700, "{promised}");
    }
}
