//! `bn render`: images from sampling patterns.

mod adaptive;
mod files;
mod reconstruction;
mod reference;
mod sampling;
mod scene;
mod supersampling;

use std::path::Path;
use std::time::Instant;

use bn_render::{
    Image, Normalization, SCENES, SUPERSAMPLING, mean_square_error, peak_signal_to_noise,
};
use clap::{Args, Command};
use serde_json::{Value, json};

use self::files::{FileArgs, Targets};
use self::reference::Reference;
use self::sampling::{Done, Sampling, SamplingArgs};
use self::scene::{SceneArgs, Subject};
use super::Global;
use crate::image_file::{Rows, Target};
use crate::progress_bar::Bar;
use crate::{Failure, Outcome, output};

#[derive(Debug, Args)]
pub(super) struct Render {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    sampling: SamplingArgs,
    #[command(flatten)]
    files: FileArgs,
    /// What the image is held against: an image file, `exact` for the scene convolved with the kernel,
    /// or a number for a hexagonal lattice of so many samples per pixel. A file has the size of the image,
    /// or of its window. Images are held in memory
    #[arg(long, value_name = "FILE|exact|SPP", help_heading = "Output",
          value_parser = |text: &str| Ok::<_, String>(Reference::from(text)))]
    reference: Option<Reference>,
    /// A JSON account on standard output: what was asked for; width, height, spp, `samples` (whose
    /// kernel reaches a wanted pixel), of these `samples_evaluated` and `samples_skipped`,
    /// `references_evaluated` (evaluations at blocks' centres, beside the samples), `empty_pixels`
    /// (guessed, or 0, for want of samples), mse, psnr, `seconds` of the rendering alone and
    /// `pattern_seconds`; with --reconstruct act or pocs also iterations and residual; with --adaptive
    /// the samples of all tiles of 128x128 pixels that meet the window (margins too), `spp_mean` (those
    /// over the tiles' pixels), `pilot_samples` (of every block's first layer), blocks and errors
    #[arg(long, help_heading = "Output")]
    json: bool,
}

pub(super) fn command() -> Command {
    let scenes: Vec<_> =
        SCENES.iter().map(|entry| format!("  {:<19} {}", entry.name, entry.summary)).collect();
    Render::augment_args(Command::new("render"))
        .override_usage(
            "bn render [OPTIONS] --pattern <METHOD|FILE> <SCENE>\n       \
             bn render [OPTIONS] --supersampling <SET|FILE> <SCENE>",
        )
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
            "Scenes:\n{}\n\nSupersampling sets: {}\n\n`bn list kernels` tells what each \
             kernel does to band-limited images, `bn list supersampling` the samples of each set.\n\nExamples:\n  \
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
    let mut targets = args.targets()?;
    let subject = args.scene.subject()?;
    let reference = args.reference.as_ref().map(|reference| reference.prepared(&subject));
    let reference = reference.transpose()?;
    let bar = Bar::new(global.quiet);
    let start = Instant::now();
    let (sampling, pattern) = args.sampling.sampling(&subject.frame, &bar)?;
    let pattern_seconds = start.elapsed().as_secs_f64();
    let settings = args.settings(&subject, &sampling, &pattern);
    targets.note(&settings);
    // Made first, so that a bad one is refused before anything is written.
    let normalization = sampling.normalization().unwrap_or_default();
    let filter = (args.sampling.kernel(), normalization);
    let reference = reference.map(|reference| reference.image(&subject, filter, global, &bar));
    let reference = reference.transpose()?;
    let start = Instant::now();
    let (done, image) = args.render(&subject, &sampling, &bar, targets.image.as_ref())?;
    let seconds = start.elapsed().as_secs_f64();
    drop(bar);
    if let Some(fit) = &done.fit {
        reconstruction::remark(fit, global);
    }
    if done.stats.empty_pixels > 0 {
        let become_ = match normalization {
            Normalization::Density => "take the scene's value nearby",
            Normalization::None => "are 0",
        };
        global.remark(format!(
            "{} pixels have no sample in reach; they {become_}",
            done.stats.empty_pixels
        ));
    }
    if let (Sampling::Adaptive(adaptive), Some(stats)) = (&sampling, &done.adaptive) {
        adaptive.tell(stats, global);
    }
    let compared = match (&reference, &image) {
        (Some((reference, account)), Some(image)) => {
            targets.write_error(image, reference)?;
            let mse = mean_square_error(image, reference).map_err(Failure::usage)?;
            Some(Compared { mse, reference: account })
        }
        _ => None,
    };
    if args.json {
        let mut account = settings;
        extend(&mut account, results(&sampling, &done, compared.as_ref()));
        let time = json!({"seconds": seconds, "pattern_seconds": pattern_seconds});
        extend(&mut account, time);
        return output::write_stdout(|w| Ok(writeln!(w, "{account:#}")?));
    }
    if let Some(Compared { mse, .. }) = compared {
        let text = format!("psnr {:.2} dB, mse {mse:.4e}", peak_signal_to_noise(mse));
        if args.files.writes_stdout() {
            global.remark(text);
        } else {
            output::write_stdout(|w| Ok(writeln!(w, "{text}")?))?;
        }
    }
    Ok(())
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
    /// The files to write; what makes no sense is refused before any work.
    fn targets(&self) -> Outcome<Targets<'_>> {
        if self.json && self.files.writes_stdout() {
            return Err(Failure::misuse(
                "--json needs standard output for itself; name a file with -o",
            ));
        }
        if !self.files.is_wanted() && !self.json && self.reference.is_none() {
            return Err(Failure::misuse("where to? name an image file with -o, or ask for --json"));
        }
        let takes_kernel = self.reference.as_ref().is_some_and(Reference::takes_kernel);
        self.sampling.check_kernel(takes_kernel)?;
        let inputs: Vec<_> = self
            .sampling
            .files()
            .chain([Path::new(&self.scene.scene)])
            .chain(self.reference.as_ref().and_then(Reference::file))
            .collect();
        self.files.targets(&inputs)
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

    /// All that decides the image.
    fn settings(&self, subject: &Subject, sampling: &Sampling, pattern: &Value) -> Value {
        let (frame, window) = (subject.frame, subject.frame.window());
        let (reconstruct, weighted) = match sampling {
            Sampling::Tiled(tiled) => (Some("convolution"), tiled.pattern.is_weighted()),
            Sampling::Fitted(fitted) => (Some(fitted.name()), fitted.pattern.is_weighted()),
            Sampling::Adaptive(_) => (Some("convolution"), false),
            Sampling::Periodic(_) => (None, false),
        };
        let normalization = sampling.normalization();
        let mut settings = json!({
            "scene": self.scene.scene,
            "scene_options": self.scene.given(),
            "width": window.width,
            "height": window.height,
            "image": {"width": frame.width(), "height": frame.height(), "x": window.x, "y": window.y},
            "channels": subject.scene.channels().count(),
            "pattern": pattern,
            "seed": self.sampling.seed_taken(pattern),
            "vary_tiles": reconstruct.map(|_| self.sampling.variation_name()),
            "spp": sampling.samples_per_pixel(),
            "reconstruct": reconstruct,
            "kernel": reconstruct.map(|_| self.sampling.kernel().name()),
            "weights": reconstruct.map(|_| if weighted { "voronoi" } else { "equal" }),
            "normalize": normalization.map(normalization_name),
        });
        match sampling {
            Sampling::Fitted(fitted) => extend(&mut settings, fitted.settings()),
            Sampling::Adaptive(adaptive) => extend(&mut settings, adaptive.settings()),
            Sampling::Tiled(_) | Sampling::Periodic(_) => {}
        }
        settings
    }
}

fn normalization_name(normalization: Normalization) -> &'static str {
    match normalization {
        Normalization::Density => "density",
        Normalization::None => "none",
    }
}

/// What came of it.
fn results(sampling: &Sampling, done: &Done, compared: Option<&Compared<'_>>) -> Value {
    let Done { stats, fit, .. } = done;
    let mut results = json!({
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
    if let (Sampling::Adaptive(_), Some(stats)) = (sampling, &done.adaptive) {
        extend(&mut results, adaptive::account(stats, compared.map(|compared| compared.mse)));
    }
    if let Some(fit) = fit {
        extend(&mut results, reconstruction::account(fit));
    }
    results
}

/// Adds the keys of one object to another.
fn extend(account: &mut Value, more: Value) {
    if let (Some(account), Value::Object(more)) = (account.as_object_mut(), more) {
        account.extend(more);
    }
}
