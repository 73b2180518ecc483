//! The image plane: rectangles, windows of pixels, and the frame that an image fills.

use bn_core::DVec2;
use thiserror::Error;

/// A closed rectangle of the image plane, in pixels: u to the right, v down.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Rect {
    /// The corner with the smaller coordinates.
    pub min: DVec2,
    /// The corner with the larger coordinates.
    pub max: DVec2,
}

impl Rect {
    /// The rectangle [u0, u1] × [v0, v1].
    pub fn new(u0: f64, v0: f64, u1: f64, v1: f64) -> Self {
        Self { min: DVec2::new(u0, v0), max: DVec2::new(u1, v1) }
    }

    /// Whether `p` lies in it, border included.
    pub fn contains(&self, p: DVec2) -> bool {
        p.cmpge(self.min).all() && p.cmple(self.max).all()
    }

    /// The rectangle with `margin` added on every side.
    #[must_use]
    pub fn expanded(&self, margin: f64) -> Self {
        Self { min: self.min - margin, max: self.max + margin }
    }

    /// Its centre.
    pub fn center(&self) -> DVec2 {
        0.5 * (self.min + self.max)
    }
}

/// A rectangle of whole pixels: columns x … x + width − 1 of rows y … y + height − 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Window {
    /// The first column.
    pub x: u32,
    /// The first row.
    pub y: u32,
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
}

/// Why an image can't have the size or window asked for.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum FrameError {
    /// A side is 0 or longer than [`Frame::MAX_SIDE`].
    #[error("an image of {width}×{height} pixels is not possible; sides go from 1 to {max}", max = Frame::MAX_SIDE)]
    Size {
        /// The width asked for.
        width: u32,
        /// The height asked for.
        height: u32,
    },
    /// The window is empty or leaves the image.
    #[error(
        "a window of {}×{} pixels at ({}, {}) is empty or leaves the image of {width}×{height} pixels",
        window.width, window.height, window.x, window.y
    )]
    Window {
        /// The window asked for.
        window: Window,
        /// The image's width.
        width: u32,
        /// The image's height.
        height: u32,
    },
}

/// The size of an image and the window of it that is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Frame {
    width: u32,
    height: u32,
    window: Window,
}

impl Frame {
    /// The longest side: pixel positions stay exact far beyond it, files do not.
    pub const MAX_SIDE: u32 = 1 << 20;

    /// The frame of a whole image.
    ///
    /// # Errors
    /// If a side is 0 or above [`Frame::MAX_SIDE`].
    pub fn new(width: u32, height: u32) -> Result<Self, FrameError> {
        let sides = 1..=Self::MAX_SIDE;
        if !sides.contains(&width) || !sides.contains(&height) {
            return Err(FrameError::Size { width, height });
        }
        Ok(Self { width, height, window: Window { x: 0, y: 0, width, height } })
    }

    /// The same image, of which only `window` is wanted: its pixels are bit for bit those of the
    /// whole image.
    ///
    /// # Errors
    /// If the window is empty or leaves the image.
    pub fn cropped(self, window: Window) -> Result<Self, FrameError> {
        let fits = |start: u32, length: u32, side: u32| {
            length > 0 && start < side && length <= side - start
        };
        if fits(window.x, window.width, self.width) && fits(window.y, window.height, self.height) {
            Ok(Self { window, ..self })
        } else {
            Err(FrameError::Window { window, width: self.width, height: self.height })
        }
    }

    /// Width of the whole image in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height of the whole image in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The window that is wanted.
    pub fn window(&self) -> Window {
        self.window
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_and_windows_are_checked() {
        assert!(Frame::new(0, 4).is_err() && Frame::new(4, u32::MAX).is_err());
        let frame = Frame::new(10, 6).expect("a size");
        let window = |x, y, width, height| Window { x, y, width, height };
        assert_eq!(frame.window(), window(0, 0, 10, 6));
        assert!(frame.cropped(window(9, 5, 1, 1)).is_ok());
        for bad in [
            window(0, 0, 11, 1),
            window(10, 0, 1, 1),
            window(0, 0, 0, 1),
            window(3, 3, u32::MAX, 1),
        ] {
            assert!(frame.cropped(bad).is_err(), "{bad:?}");
        }
    }

    #[test]
    fn rectangles_are_closed() {
        let rect = Rect::new(0.0, 1.0, 2.0, 3.0);
        assert!(rect.contains(DVec2::new(2.0, 1.0)) && !rect.contains(DVec2::new(2.1, 1.0)));
        assert_eq!(rect.expanded(0.5), Rect::new(-0.5, 0.5, 2.5, 3.5));
        assert_eq!(rect.center(), DVec2::new(1.0, 2.0));
    }
}
