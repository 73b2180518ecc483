//! `bn render`: images from sampling patterns.

mod adaptive;
mod reconstruction;
mod reference;
mod sampling;
mod scene;

use std::path::{Path, PathBuf};
use std::time::Instant;

use bn_render::{
    BitDepth, Encoding, Image, Normalization, PngOptions, SCENES, SUPERSAMPLING, difference,
    error_picture, mean_square_error, peak_signal_to_noise,
};
use clap::{Args, Command, ValueEnum};
use serde_json::{Value, json};

use self::reference::Reference;
use self::sampling::{Done, Sampling, SamplingArgs};
use self::scene::{Curve, SceneArgs, Subject};
use super::Global;
use crate::image_file::{ImageFormat, Rows, Target};
use crate::progress_bar::Bar;
use crate::{Failure, Outcome, output};

#[derive(Debug, Args)]
pub(super) struct Render {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    sampling: SamplingArgs,
    /// Image to write: .png, .pfm or .exr; `-` is standard output (with --format)
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    output: Option<PathBuf>,
    /// Format of the output: png, pfm or exr (default: by the file's extension)
    #[arg(long, value_name = "FORMAT", help_heading = "Output")]
    format: Option<ImageFormat>,
    /// Bits for each channel of a .png
    #[arg(long, value_name = "BITS", default_value = "8", help_heading = "Output")]
    depth: Depth,
    /// Curve of a .png's values; the file names it
    #[arg(long, value_name = "CURVE", default_value = "srgb", help_heading = "Output")]
    encoding: Curve,
    /// What the image is held against: an image file, `exact` for the scene convolved with the kernel,
    /// or a number for a hexagonal lattice of so many samples per pixel. Images are held in memory
    #[arg(long, value_name = "FILE|exact|SPP", help_heading = "Output",
          value_parser = |text: &str| Ok::<_, String>(Reference::from(text)))]
    reference: Option<Reference>,
    /// The error image: a .png shows it about middle grey, .pfm and .exr hold image less reference
    #[arg(long, value_name = "FILE", requires = "reference", help_heading = "Output")]
    error: Option<PathBuf>,
    /// Enlarge the error so many times in a .png
    #[arg(
        long,
        value_name = "TIMES",
        default_value = "1",
        requires = "error",
        help_heading = "Output"
    )]
    error_gain: f32,
    /// A JSON account on standard output: width, height, spp, samples, `samples_skipped`, mse, psnr,
    /// seconds and what was asked for; with --reconstruct act or pocs also iterations and residual
    #[arg(long, help_heading = "Output")]
    json: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Depth {
    #[value(name = "8")]
    Eight,
    #[value(name = "16")]
    Sixteen,
}

pub(super) fn command() -> Command {
    let scenes: Vec<_> =
        SCENES.iter().map(|entry| format!("  {:<19} {}", entry.name, entry.summary)).collect();
    Render::augment_args(Command::new("render"))
        .about("Render a scene through a sampling pattern and a kernel")
        .long_about(
            "Render a scene through a sampling pattern and a reconstruction kernel. Pixel (i, j) has \
             its centre at (i + 1/2, j + 1/2), v down; the sample of point (x, y) in tile (a, b) lies \
             at ((a + x) L, (b + y) L) with L = sqrt(n/spp) pixels. A pixel is the sum of r(d) I over \
             the samples within the kernel's square support over the sum of r(d) (--normalize \
             density), or over spp times the square of the kernel's integral (none). Images are \
             streamed to disk. --reconstruct act and pocs fit a band-limited function to the samples \
             instead and convolve that with the kernel. \
             PSNR is 10 log10(1/MSE) of unquantised values.",
        )
        .after_help(format!(
            "Scenes:\n{}\n\nSupersampling sets: {}\n\nExamples:\n  \
             bn render zone-plate --pattern fpo --spp 4 -o plate.png\n  \
             bn render checkerboard --pattern step.txt --spp 8 --reference 512 --error error.png -o board.png\n  \
             bn render zone-plate-limited --frequency 0.4 --pattern jittered --reconstruct act -o act.png\n  \
             bn render sphere --pattern fpo --spp 4 --adaptive 0.01 --json -o sphere.png\n  \
             bn render photo.png --size 160x160 --pattern jittered --spp 16 --kernel mitchell -o small.exr",
            scenes.join("\n"),
            SUPERSAMPLING.join(", ")
        ))
}

pub(super) fn run(args: &Render, global: &Global) -> Outcome {
    let targets = args.targets()?;
    let subject = args.scene.subject()?;
    let bar = Bar::new(global.quiet);
    let start = Instant::now();
    let (sampling, pattern) = args.sampling.sampling(&bar)?;
    let pattern_seconds = start.elapsed().as_secs_f64();
    let reference = args.reference(&subject, &sampling, global)?;
    let start = Instant::now();
    let (done, image) = args.render(&subject, &sampling, &bar, targets.image.as_ref())?;
    let seconds = start.elapsed().as_secs_f64();
    drop(bar);
    if let Some(fit) = &done.fit {
        reconstruction::remark(fit, global);
    }
    if done.stats.empty_pixels > 0 {
        global.remark(format!(
            "{} pixels have no sample in reach; they take the scene's value nearby",
            done.stats.empty_pixels
        ));
    }
    if let (Sampling::Adaptive(adaptive), Some(stats)) = (&sampling, &done.adaptive) {
        adaptive.tell(stats, global);
    }
    let compared = match (&reference, &image) {
        (Some((reference, account)), Some(image)) => {
            if let Some(target) = &targets.error {
                args.write_error(image, reference, target)?;
            }
            let mse = mean_square_error(image, reference).map_err(Failure::usage)?;
            Some(Compared { mse, reference: account })
        }
        _ => None,
    };
    let account = args.account(&subject, &sampling, &done, compared.as_ref(), &pattern);
    if args.json {
        let mut account = account;
        account["seconds"] = json!(seconds);
        account["pattern_seconds"] = json!(pattern_seconds);
        return output::write_stdout(|w| Ok(writeln!(w, "{account:#}")?));
    }
    if let Some(Compared { mse, .. }) = compared {
        let text = format!("psnr {:.2} dB, mse {mse:.4e}", peak_signal_to_noise(mse));
        if args.writes_stdout() {
            global.remark(text);
        } else {
            output::write_stdout(|w| Ok(writeln!(w, "{text}")?))?;
        }
    }
    Ok(())
}

/// Files to write.
struct Targets<'a> {
    image: Option<Target<'a>>,
    error: Option<Target<'a>>,
}

/// An image held against its reference.
struct Compared<'a> {
    mse: f64,
    /// What the reference is.
    reference: &'a Value,
}

/// The image of the window, from what hands over its rows.
fn collect<T>(
    subject: &Subject,
    make: impl FnOnce(&mut Rows<'_>) -> Outcome<T>,
) -> Outcome<(Image, T)> {
    let (window, channels) = (subject.frame.window(), subject.scene.channels());
    Image::check_size(window.width, window.height, channels).map_err(Failure::usage)?;
    let mut values = Vec::new();
    let made = make(&mut |rows| {
        values.extend_from_slice(rows);
        Ok(())
    })?;
    let image = Image::new(window.width, window.height, channels, values);
    Ok((image.map_err(Failure::failed)?, made))
}

impl Render {
    fn writes_stdout(&self) -> bool {
        [&self.output, &self.error].into_iter().flatten().any(|path| path == Path::new("-"))
    }

    /// The files to write, checked as far as that goes before any work.
    fn targets(&self) -> Outcome<Targets<'_>> {
        if self.json && self.writes_stdout() {
            return Err(Failure::misuse(
                "--json needs standard output for itself; name a file with -o",
            ));
        }
        if self.output.is_none() && !self.json && self.reference.is_none() {
            return Err(Failure::misuse("where to? name an image file with -o, or ask for --json"));
        }
        let about = |title: &str| {
            let version = concat!("bn ", env!("CARGO_PKG_VERSION"));
            vec![
                ("Software".to_owned(), version.to_owned()),
                ("Title".to_owned(), title.to_owned()),
            ]
        };
        let image = self.output.as_deref().map(|path| {
            let png = PngOptions {
                depth: match self.depth {
                    Depth::Eight => BitDepth::Eight,
                    Depth::Sixteen => BitDepth::Sixteen,
                },
                encoding: Encoding::from(self.encoding),
                text: about("rendering"),
                ..PngOptions::default()
            };
            target(path, self.format, png)
        });
        let error = self.error.as_deref().map(|path| {
            let png = PngOptions { text: about("error"), ..PngOptions::default() };
            target(path, None, png)
        });
        Ok(Targets { image: image.transpose()?, error: error.transpose()? })
    }

    /// Renders and writes the image; returns it if it is to be compared.
    fn render(
        &self,
        subject: &Subject,
        sampling: &Sampling,
        bar: &Bar,
        target: Option<&Target<'_>>,
    ) -> Outcome<(Done, Option<Image>)> {
        let render = |rows: &mut Rows<'_>| sampling.render(subject, bar, rows);
        if self.reference.is_some() {
            let (image, done) = collect(subject, render)?;
            if let Some(target) = target {
                target.write(&image)?;
            }
            return Ok((done, Some(image)));
        }
        let window = subject.frame.window();
        let done = match target {
            Some(target) => {
                target.stream((window.width, window.height, subject.scene.channels()), render)?
            }
            None => render(&mut |_| Ok(()))?,
        };
        Ok((done, None))
    }

    /// The image to hold the rendering against and its account, made first so that a bad one is
    /// refused before anything is written.
    fn reference(
        &self,
        subject: &Subject,
        sampling: &Sampling,
        global: &Global,
    ) -> Outcome<Option<(Image, Value)>> {
        let Some(reference) = &self.reference else { return Ok(None) };
        let normalization = sampling.normalization().unwrap_or_default();
        reference.image(subject, self.sampling.kernel(), normalization, global).map(Some)
    }

    fn write_error(&self, image: &Image, reference: &Image, target: &Target<'_>) -> Outcome {
        let picture = match target.format {
            ImageFormat::Png => error_picture(image, reference, self.error_gain),
            _ => difference(image, reference),
        };
        target.write(&picture.map_err(Failure::usage)?)
    }

    fn account(
        &self,
        subject: &Subject,
        sampling: &Sampling,
        done: &Done,
        compared: Option<&Compared<'_>>,
        pattern: &Value,
    ) -> Value {
        let (frame, window) = (subject.frame, subject.frame.window());
        let Done { stats, fit, .. } = done;
        let (reconstruct, weighted) = match sampling {
            Sampling::Tiled(tiled) => (Some("convolution"), tiled.pattern.is_weighted()),
            Sampling::Fitted(fitted) => (Some(fitted.name()), fitted.pattern.is_weighted()),
            Sampling::Adaptive(_) => (Some("convolution"), false),
            Sampling::Periodic(_) => (None, false),
        };
        let normalization = sampling.normalization();
        let mut account = json!({
            "scene": self.scene.scene,
            "width": window.width,
            "height": window.height,
            "image": {"width": frame.width(), "height": frame.height(), "x": window.x, "y": window.y},
            "channels": subject.scene.channels().count(),
            "pattern": pattern,
            "spp": sampling.samples_per_pixel(),
            "reconstruct": reconstruct,
            "kernel": reconstruct.map(|_| self.sampling.kernel().name()),
            "weights": reconstruct.map(|_| if weighted { "voronoi" } else { "equal" }),
            "normalize": normalization.map(|how| match how {
                Normalization::Density => "density",
                Normalization::None => "none",
            }),
            "samples": stats.samples,
            "samples_skipped": stats.skipped(),
            "samples_evaluated": stats.evaluated,
            "references_evaluated": stats.references,
            "empty_pixels": stats.empty_pixels,
            "reference": compared.map(|compared| compared.reference),
            "mse": compared.map(|compared| compared.mse),
            // Equal images have no finite PSNR: null.
            "psnr": compared.map(|compared| peak_signal_to_noise(compared.mse)),
        });
        let more = match (sampling, &done.adaptive) {
            (Sampling::Adaptive(adaptive), Some(stats)) => {
                Some(adaptive.account(stats, compared.map(|compared| compared.mse)))
            }
            _ => fit.as_ref().map(reconstruction::account),
        };
        if let (Some(account), Some(Value::Object(more))) = (account.as_object_mut(), more) {
            account.extend(more);
        }
        account
    }
}

fn target(path: &Path, format: Option<ImageFormat>, png: PngOptions) -> Outcome<Target<'_>> {
    let format = match format {
        Some(format) => format,
        None if path == Path::new("-") => {
            return Err(Failure::misuse("an image on standard output needs --format"));
        }
        None => ImageFormat::from_path(path)?,
    };
    if path != Path::new("-") {
        output::check_folder(path)?;
    }
    Ok(Target { path, format, png })
}
