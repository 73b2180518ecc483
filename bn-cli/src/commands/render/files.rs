//! The files that `bn render` writes.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use bn_render::{BitDepth, Encoding, Image, PngOptions, difference, error_picture};
use clap::{Args, ValueEnum};
use serde_json::Value;

use super::scene::Curve;
use crate::image_file::{ImageFormat, Target};
use crate::{Failure, Outcome, output};

#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
pub(super) struct FileArgs {
    /// Image to write: .png, .pfm or .exr; `-` is standard output (with --format)
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Format of the output: png, pfm or exr (default: by the file's extension)
    #[arg(long, value_name = "FORMAT", requires = "output")]
    format: Option<ImageFormat>,
    /// Bits for each channel of a .png that -o names (default: 8)
    #[arg(long, value_name = "BITS", requires = "output")]
    depth: Option<Depth>,
    /// Curve of the values of a .png that -o names; the file tells it (default: srgb)
    #[arg(long, value_name = "CURVE", requires = "output")]
    encoding: Option<Curve>,
    /// The error image: a .png shows it about middle grey, .pfm and .exr hold image less reference
    #[arg(long, value_name = "FILE", requires = "reference")]
    error: Option<PathBuf>,
    /// Enlarge the error so many times in a .png (default: 1)
    #[arg(long, value_name = "TIMES", requires = "error", allow_negative_numbers = true)]
    error_gain: Option<f32>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Depth {
    #[value(name = "8")]
    Eight,
    #[value(name = "16")]
    Sixteen,
}

/// Files to write.
pub(super) struct Targets<'a> {
    pub(super) image: Option<Target<'a>>,
    error: Option<Target<'a>>,
    error_gain: f32,
}

impl FileArgs {
    /// Whether the image is written.
    pub(super) fn is_wanted(&self) -> bool {
        self.output.is_some()
    }

    /// Whether standard output takes the image.
    pub(super) fn writes_stdout(&self) -> bool {
        self.output.as_deref() == Some(Path::new("-"))
    }

    /// The files to write, checked as far as that goes before any work.
    ///
    /// `inputs` must stay as they are.
    pub(super) fn targets(&self, inputs: &[&Path]) -> Outcome<Targets<'_>> {
        let image = self.output.as_deref().map(|path| self.image_target(path)).transpose()?;
        let error = self.error.as_deref().map(|path| self.error_target(path)).transpose()?;
        if let (Some(image), Some(error)) = (&image, &error)
            && is_same(image.path, error.path)
        {
            return Err(Failure::misuse(format!(
                "-o and --error both name {}; the error image needs a file of its own",
                error.path.display()
            )));
        }
        for (option, file) in [("-o", &self.output), ("--error", &self.error)] {
            if let Some(file) = file.as_deref()
                && inputs.iter().any(|input| output::replaces(file, input))
            {
                return Err(Failure::misuse(format!(
                    "{option} {}: the image would replace what it is made from or held against",
                    file.display()
                )));
            }
        }
        Ok(Targets { image, error, error_gain: self.error_gain.unwrap_or(1.0) })
    }

    fn image_target<'a>(&self, path: &'a Path) -> Outcome<Target<'a>> {
        let format = match self.format {
            Some(format) if ImageFormat::from_path(path).is_ok_and(|told| told != format) => {
                return Err(Failure::misuse(format!(
                    "-o {}: the name tells another format than --format",
                    path.display()
                )));
            }
            Some(format) => format,
            None if path == Path::new("-") => {
                return Err(Failure::misuse("an image on standard output needs --format"));
            }
            None => ImageFormat::from_path(path)
                .map_err(|failure| failure.context("-o needs such a name, or --format"))?,
        };
        let of_png = [self.depth.map(|_| "depth"), self.encoding.map(|_| "encoding")];
        only_png(format, path, of_png)?;
        let depth = match self.depth {
            Some(Depth::Sixteen) => BitDepth::Sixteen,
            Some(Depth::Eight) | None => BitDepth::Eight,
        };
        let encoding = Encoding::from(self.encoding.unwrap_or_default());
        let png = PngOptions { depth, encoding, text: about("rendering"), ..PngOptions::default() };
        target(path, format, png)
    }

    fn error_target<'a>(&self, path: &'a Path) -> Outcome<Target<'a>> {
        if path == Path::new("-") {
            return Err(Failure::misuse(
                "--error -: standard output takes the rendering only; name a file",
            ));
        }
        let format = ImageFormat::from_path(path)?;
        only_png(format, path, [self.error_gain.map(|_| "error-gain")])?;
        if let Some(gain) = self.error_gain
            && !(gain > 0.0 && gain.is_finite())
        {
            return Err(Failure::misuse(format!("--error-gain {gain} is not a positive number")));
        }
        target(path, format, PngOptions { text: about("error"), ..PngOptions::default() })
    }
}

/// Refuses options that only a .png has a use for.
fn only_png<const N: usize>(format: ImageFormat, path: &Path, given: [Option<&str>; N]) -> Outcome {
    match given.into_iter().flatten().next() {
        Some(name) if format != ImageFormat::Png => Err(Failure::misuse(format!(
            "--{name} concerns .png only; {} holds floats as they are",
            path.display()
        ))),
        _ => Ok(()),
    }
}

/// What a PNG tells of itself.
fn about(title: &str) -> Vec<(String, String)> {
    let version = concat!("bn ", env!("CARGO_PKG_VERSION"));
    vec![("Software".to_owned(), version.to_owned()), ("Title".to_owned(), title.to_owned())]
}

fn target(path: &Path, format: ImageFormat, png: PngOptions) -> Outcome<Target<'_>> {
    if path != Path::new("-") {
        output::check_folder(path)?;
    }
    Ok(Target { path, format, png })
}

/// Whether two names lead to one file in one folder.
fn is_same(a: &Path, b: &Path) -> bool {
    let folder = |path: &Path| {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        folder.unwrap_or(Path::new(".")).canonicalize().ok()
    };
    a == b || (a.file_name() == b.file_name() && folder(a).is_some() && folder(a) == folder(b))
}

impl Targets<'_> {
    /// Lets PNG files tell how they were made.
    pub(super) fn note(&mut self, settings: &Value) {
        let note = ("Comment".to_owned(), ascii(&settings.to_string()));
        for target in [&mut self.image, &mut self.error].into_iter().flatten() {
            target.png.text.push(note.clone());
        }
    }

    /// Writes the error image, if it is wanted.
    pub(super) fn write_error(&self, image: &Image, reference: &Image) -> Outcome {
        let Some(target) = &self.error else { return Ok(()) };
        let picture = match target.format {
            ImageFormat::Png => error_picture(image, reference, self.error_gain),
            _ => difference(image, reference),
        };
        target.write(&picture.map_err(Failure::usage)?)
    }
}

/// JSON in ASCII: PNG's plain texts are Latin-1.
fn ascii(json: &str) -> String {
    let mut text = String::with_capacity(json.len());
    for c in json.chars() {
        if c.is_ascii() {
            text.push(c);
            continue;
        }
        for unit in c.encode_utf16(&mut [0; 2]) {
            // Writing to a string cannot fail.
            let _ = write!(text, "\\u{unit:04x}");
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ascii_json_is_the_same_json() {
        let value = serde_json::json!({"file": "Büsche 𝄞.txt", "n": 3});
        let text = ascii(&value.to_string());
        assert!(text.is_ascii() && text.contains("B\\u00fcsche"), "{text}");
        assert_eq!(serde_json::from_str::<Value>(&text).expect("JSON"), value);
    }

    #[test]
    fn one_file_has_several_names() {
        let same = |a: &str, b: &str| is_same(Path::new(a), Path::new(b));
        assert!(
            same("a.png", "a.png") && same("a.png", "./a.png") && same("src/../a.png", "a.png")
        );
        assert!(!same("a.png", "b.png") && !same("src/a.png", "a.png"));
        assert!(!same("absent/a.png", "nowhere/a.png"));
    }
}
