//! Image files: one function that reads and one that writes, for all formats.

use std::fs::File;
use std::io::{self, BufReader};
use std::path::Path;
use std::str::FromStr;

use anyhow::anyhow;
use bn_render::{Channels, Encoding, Image, ImageError, PfmWriter, PngOptions, PngWriter};

use crate::{Failure, Outcome, output};

/// The formats of images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageFormat {
    /// 8 or 16 bits a channel.
    Png,
    /// Linear 32-bit floats, rows from the bottom.
    Pfm,
    /// Linear 32-bit floats, losslessly compressed.
    Exr,
}

impl FromStr for ImageFormat {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match &*text.to_ascii_lowercase() {
            "png" => Ok(Self::Png),
            "pfm" => Ok(Self::Pfm),
            "exr" if cfg!(feature = "exr") => Ok(Self::Exr),
            "exr" => Err("this build does without .exr; use .pfm".to_owned()),
            _ => Err("images are .png, .pfm or .exr".to_owned()),
        }
    }
}

impl ImageFormat {
    /// The format that a name's extension tells.
    ///
    /// # Errors
    /// If it tells none is bad use.
    pub fn from_path(path: &Path) -> Outcome<Self> {
        let extension = path.extension().unwrap_or_default().to_string_lossy();
        let told = Self::from_str(&extension);
        told.map_err(|error| Failure::misuse(format!("{}: {error}", path.display())))
    }
}

/// The image of a file, as linear light.
///
/// PNG values go through the transfer curve `encoding` if given, else the one that the file names
/// (`sRGB` or `gAMA`), else that of sRGB; PFM and EXR hold linear values.
///
/// # Errors
/// A file that is bad or absent is bad input; a disk that fails is a failure.
pub fn read(path: &Path, encoding: Option<Encoding>) -> Outcome<Image> {
    let format = ImageFormat::from_path(path)?;
    let open = || -> Result<Image, ImageError> {
        let input = BufReader::new(File::open(path)?);
        match format {
            ImageFormat::Png => bn_render::read_png(input, encoding),
            ImageFormat::Pfm => bn_render::read_pfm(input),
            #[cfg(feature = "exr")]
            ImageFormat::Exr => bn_render::read_exr(input),
            #[cfg(not(feature = "exr"))]
            ImageFormat::Exr => unreachable!("builds without the feature know no .exr"),
        }
    };
    open().map_err(|error| bad_or_failed(path, error))
}

/// A disk that fails is a failure; bad contents and names that lead nowhere are bad input.
fn bad_or_failed(path: &Path, error: ImageError) -> Failure {
    use io::ErrorKind::{IsADirectory, NotADirectory, NotFound};
    let disk = matches!(&error, ImageError::Io(io)
        if !matches!(io.kind(), NotFound | IsADirectory | NotADirectory));
    let error = anyhow!(error).context(path.display().to_string());
    if disk { Failure::failed(error) } else { Failure::usage(error) }
}

/// Takes finished rows, from the top.
pub type Rows<'a> = dyn FnMut(&[f32]) -> io::Result<()> + Send + 'a;

/// What a file to write is like.
#[derive(Clone, Debug)]
pub struct Target<'a> {
    /// Its name; `-` is standard output.
    pub path: &'a Path,
    /// Its format.
    pub format: ImageFormat,
    /// Depth, curve and texts of a PNG.
    pub png: PngOptions,
}

impl Target<'_> {
    /// Writes an image of `width` × `height` pixels whose rows `make` hands over from the top, as
    /// they come; the file appears when all are there.
    ///
    /// # Errors
    /// What `make` returns, or that the file can't be written.
    pub fn stream<T>(
        &self,
        (width, height, channels): (u32, u32, Channels),
        make: impl FnOnce(&mut Rows<'_>) -> Outcome<T>,
    ) -> Outcome<T> {
        output::write_seekable(self.path, |file| match self.format {
            ImageFormat::Png => {
                let mut writer = PngWriter::new(file, width, height, channels, &self.png)
                    .map_err(Failure::failed)?;
                let made = make(&mut |rows| writer.write_rows(rows).map_err(into_io))?;
                writer.finish().map_err(Failure::failed)?;
                Ok(made)
            }
            ImageFormat::Pfm => {
                let mut writer =
                    PfmWriter::new(file, width, height, channels).map_err(Failure::failed)?;
                let made = make(&mut |rows| writer.write_rows(rows).map_err(into_io))?;
                writer.finish().map_err(Failure::failed)?;
                Ok(made)
            }
            ImageFormat::Exr => stream_exr(file, (width, height, channels), make),
        })
    }

    /// Writes an image.
    ///
    /// # Errors
    /// If the file can't be written.
    pub fn write(&self, image: &Image) -> Outcome {
        let shape = (image.width(), image.height(), image.channels());
        self.stream(shape, |rows| Ok(rows(image.values())?))
    }
}

#[cfg(feature = "exr")]
fn stream_exr<T>(
    file: File,
    (width, height, channels): (u32, u32, Channels),
    make: impl FnOnce(&mut Rows<'_>) -> Outcome<T>,
) -> Outcome<T> {
    let mut made = None;
    bn_render::stream_exr(file, width, height, channels, |writer| -> Result<(), Wrapped> {
        made = Some(make(&mut |rows| writer.write_rows(rows).map_err(into_io)).map_err(Wrapped)?);
        Ok(())
    })
    .map_err(|Wrapped(failure)| failure)?;
    Ok(made.expect("the rows have been made where nothing failed"))
}

#[cfg(not(feature = "exr"))]
fn stream_exr<T>(
    _: File,
    _: (u32, u32, Channels),
    _: impl FnOnce(&mut Rows<'_>) -> Outcome<T>,
) -> Outcome<T> {
    unreachable!("builds without the feature know no .exr")
}

/// A failure that errors of images turn into.
#[cfg(feature = "exr")]
struct Wrapped(Failure);

#[cfg(feature = "exr")]
impl From<ImageError> for Wrapped {
    fn from(error: ImageError) -> Self {
        Self(Failure::failed(error))
    }
}

fn into_io(error: ImageError) -> io::Error {
    match error {
        ImageError::Io(error) => error,
        other => io::Error::other(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_format_is_written_and_read() {
        let folder = tempfile::tempdir().expect("a folder");
        // Values that 16 bits of linear light hold.
        let values = (0..40 * 70 * 3).map(|i| (i * 7 % 65_536) as f32 / 65_535.0).collect();
        let image = Image::new(40, 70, Channels::Rgb, values).expect("an image");
        for extension in ["png", "pfm", "exr"] {
            let path = folder.path().join(format!("image.{extension}"));
            let Ok(format) = ImageFormat::from_path(&path) else { continue };
            let png = PngOptions {
                depth: bn_render::BitDepth::Sixteen,
                encoding: Encoding::Linear,
                ..PngOptions::default()
            };
            let target = Target { path: &path, format, png };
            // In pieces that fit no block.
            let shape = (40, 70, Channels::Rgb);
            let pieces = image.values().chunks(40 * 3 * 11);
            target
                .stream(shape, |rows| pieces.into_iter().try_for_each(|p| Ok(rows(p)?)))
                .expect("written");
            let back = read(&path, None).expect("read");
            let off = bn_render::mean_square_error(&back, &image).expect("same shape");
            assert!(off < 1e-14, "{extension}: {off}");
        }
    }

    #[test]
    fn too_few_rows_leave_no_file() {
        let folder = tempfile::tempdir().expect("a folder");
        for extension in ["png", "pfm", "exr"] {
            let path = folder.path().join(format!("image.{extension}"));
            let Ok(format) = ImageFormat::from_path(&path) else { continue };
            let target = Target { path: &path, format, png: PngOptions::default() };
            let short = target.stream((4, 4, Channels::Grey), |rows| Ok(rows(&[0.5; 12])?));
            assert_eq!(short.expect_err("a row is missing").code(), Failure::FAILED);
            let failed = target
                .stream((4, 4, Channels::Grey), |_| -> Outcome { Err(Failure::misuse("stop")) });
            assert_eq!(failed.expect_err("told to stop").code(), Failure::USAGE);
        }
        assert_eq!(std::fs::read_dir(folder.path()).expect("readable").count(), 0);
    }

    #[test]
    fn files_that_are_not_images_are_bad_input() {
        let folder = tempfile::tempdir().expect("a folder");
        for name in ["bad.png", "bad.pfm", "bad.exr"] {
            let path = folder.path().join(name);
            assert_eq!(read(&path, None).expect_err("absent").code(), Failure::USAGE);
            std::fs::write(&path, "no image").expect("writable");
            let error = read(&path, None).expect_err("no image");
            assert!(error.code() == Failure::USAGE && error.to_string().contains(name), "{error}");
        }
        let error = read(Path::new("image.jpg"), None).expect_err("no format of ours");
        assert!(error.to_string().contains(".png"), "{error}");
    }
}
