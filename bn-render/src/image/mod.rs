//! Images of linear light.

mod encoding;
#[cfg(feature = "exr")]
mod exr;
mod pfm;
mod png;

use thiserror::Error;

#[cfg(feature = "exr")]
pub use self::exr::{ExrRows, read_exr, stream_exr, write_exr};
pub use self::png::{BitDepth, PngEncoding, PngOptions, PngWriter, read_png, write_png};
pub use encoding::{Encoding, linear_from_srgb, srgb_from_linear};
pub use pfm::{PfmWriter, read_pfm, write_pfm};

/// The channels of an image or a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Channels {
    /// One.
    Grey,
    /// Three: red, green, blue with the primaries of sRGB.
    Rgb,
}

impl Channels {
    /// Number of channels, 1 or 3.
    pub fn count(self) -> usize {
        match self {
            Self::Grey => 1,
            Self::Rgb => 3,
        }
    }
}

/// Why numbers don't form an image, or a file doesn't hold one.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ImageError {
    /// A side is 0, or there are more than [`Image::MAX_SAMPLES`] numbers.
    #[error("an image of {width}×{height} pixels is not possible; sides are 1 at least, and {max} numbers the most", max = Image::MAX_SAMPLES)]
    Size {
        /// The width asked for.
        width: u64,
        /// The height asked for.
        height: u64,
    },
    /// The number of values is not width × height × channels.
    #[error("{got} values don't make an image that needs {want}")]
    Count {
        /// Values given.
        got: usize,
        /// Values needed.
        want: usize,
    },
    /// A value is NaN or infinite.
    #[error("the value of pixel ({x}, {y}) is not a finite number")]
    NotFinite {
        /// The pixel's column.
        x: u32,
        /// The pixel's row.
        y: u32,
    },
    /// Two images that are to be compared differ in size or channels.
    #[error("the images differ in size or channels: {a} and {b}")]
    Mismatch {
        /// One image, as width×height×channels.
        a: String,
        /// The other.
        b: String,
    },
    /// The file is not what its format says.
    #[error("not a valid {format} file: {reason}")]
    Format {
        /// The format's name.
        format: &'static str,
        /// What is wrong.
        reason: String,
    },
    /// The file can't be read or written.
    #[error(transparent)]
    Io(#[from] std::io::Error),
}

/// An image of finite f32 values, rows from the top, channels side by side in each pixel.
///
/// Values are linear light, nominally in [0, 1], but free to leave it: kernels with negative lobes
/// overshoot.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    width: u32,
    height: u32,
    channels: Channels,
    values: Vec<f32>,
}

impl Image {
    /// The most numbers an image may hold, 4 GB; larger images are streamed, not held.
    pub const MAX_SAMPLES: u64 = 1 << 30;

    /// The image of these values.
    ///
    /// # Errors
    /// If the size is 0 or absurd, the number of values doesn't fit, or one is not finite.
    pub fn new(
        width: u32,
        height: u32,
        channels: Channels,
        values: Vec<f32>,
    ) -> Result<Self, ImageError> {
        let want = checked_len(u64::from(width), u64::from(height), channels)?;
        if values.len() != want {
            return Err(ImageError::Count { got: values.len(), want });
        }
        check_finite(&values, width, channels, (0, 0))?;
        Ok(Self { width, height, channels, values })
    }

    /// Whether an image of this size can be held.
    ///
    /// # Errors
    /// If a side is 0 or there would be more than [`Image::MAX_SAMPLES`] numbers.
    pub fn check_size(width: u32, height: u32, channels: Channels) -> Result<(), ImageError> {
        checked_len(u64::from(width), u64::from(height), channels).map(drop)
    }

    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The channels.
    pub fn channels(&self) -> Channels {
        self.channels
    }

    /// All values, row by row.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The channels of pixel (x, y).
    ///
    /// # Panics
    /// If the pixel is outside the image.
    pub fn pixel(&self, x: u32, y: u32) -> &[f32] {
        assert!(x < self.width, "column {x} of {}", self.width);
        let count = self.channels.count();
        &self.values[(y as usize * self.width as usize + x as usize) * count..][..count]
    }

    /// Numbers in a row.
    pub fn row_len(&self) -> usize {
        self.width as usize * self.channels.count()
    }

    /// Width×height×channels, for messages.
    pub(crate) fn shape(&self) -> String {
        format!("{}×{}×{}", self.width, self.height, self.channels.count())
    }
}

/// Refuses sides that no file can have.
fn check_sides(width: u32, height: u32) -> Result<(), ImageError> {
    if width == 0 || height == 0 {
        return Err(ImageError::Size { width: width.into(), height: height.into() });
    }
    Ok(())
}

/// Refuses rows of an image, from pixel `first` on, that hold a value that is no finite number.
pub(crate) fn check_finite(
    values: &[f32],
    width: u32,
    channels: Channels,
    first: (u32, u32),
) -> Result<(), ImageError> {
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(bad) => {
            let pixel = bad / channels.count();
            let (x, y) = (pixel % width as usize, pixel / width as usize);
            Err(ImageError::NotFinite { x: first.0 + x as u32, y: first.1 + y as u32 })
        }
    }
}

/// Number of values in an image of this size, if it is not absurd.
fn checked_len(width: u64, height: u64, channels: Channels) -> Result<usize, ImageError> {
    let len = width.checked_mul(height).and_then(|n| n.checked_mul(channels.count() as u64));
    match len {
        Some(len)
            if (1..=Image::MAX_SAMPLES).contains(&len)
                && u32::try_from(width.max(height)).is_ok() =>
        {
            Ok(len as usize)
        }
        _ => Err(ImageError::Size { width, height }),
    }
}

/// A [`ImageError::Format`] in a word.
fn malformed(format: &'static str, reason: impl Into<String>) -> ImageError {
    ImageError::Format { format, reason: reason.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_are_checked() {
        let image =
            Image::new(2, 1, Channels::Rgb, vec![0.0, 0.1, 0.2, 1.0, 1.1, 1.2]).expect("an image");
        assert_eq!(image.pixel(1, 0), [1.0, 1.1, 1.2]);
        assert!(matches!(
            Image::new(2, 2, Channels::Grey, vec![0.0; 3]),
            Err(ImageError::Count { .. })
        ));
        assert!(matches!(Image::new(0, 2, Channels::Grey, vec![]), Err(ImageError::Size { .. })));
        assert!(matches!(
            Image::new(1 << 20, 1 << 20, Channels::Rgb, vec![]),
            Err(ImageError::Size { .. })
        ));
        let nan = Image::new(2, 2, Channels::Grey, vec![0.0, 0.0, 0.0, f32::NAN]);
        assert!(matches!(nan, Err(ImageError::NotFinite { x: 1, y: 1 })));
    }
}
