//! How the scene is sampled and reconstructed: a tiled pattern and a kernel, or a fixed few samples
//! for each pixel.

use std::path::Path;

use anyhow::anyhow;
use bn_core::{DVec2, Observer, PointSet, Seed};
use bn_render::{
    AdaptiveStats, BandLimitedOptions, BandLimitedStats, Frame, ImageError, KERNELS, Kernel,
    KernelTable, Normalization, Pattern, RenderError, RenderStats, Renderer, Scene, Supersampling,
    TileVariation,
};
use bn_samplers::Method;
use clap::builder::PossibleValuesParser;
use clap::{Args, ValueEnum};
use serde_json::{Value, json};

use super::super::method_values::{given_values, only_set};
use super::adaptive::{self, Adaptive, AdaptiveArgs};
use super::reconstruction::{self, BandLimited, ReconstructionArgs};
use super::scene::{Subject, word};
use super::supersampling;
use crate::image_file::Rows;
use crate::progress_bar::Bar;
use crate::{Failure, Outcome};

#[derive(Debug, Args)]
#[command(next_help_heading = "Sampling")]
pub(super) struct SamplingArgs {
    /// The pattern that is tiled over the image: a method of `bn list`, or a point file of one set
    #[arg(long, value_name = "METHOD|FILE", required_unless_present = "supersampling")]
    pattern: Option<String>,
    /// Samples per pixel; n points fill a tile of sqrt(n/spp) pixels a side
    #[arg(long, value_name = "SPP", default_value = "4", allow_negative_numbers = true)]
    spp: f64,
    /// Reconstruction kernel, of references too (default: lanczos2)
    #[arg(long, value_name = "KERNEL",
          value_parser = PossibleValuesParser::new(KERNELS.iter().map(|kernel| kernel.name())))]
    kernel: Option<String>,
    /// Divide by the kernel's weights that met samples, or by what they are on average (default:
    /// density). Weights of either sign may all but cancel where few random samples lie: such pixels
    /// of `stochastic` run wild at density
    #[arg(long, value_name = "HOW")]
    normalize: Option<Normalize>,
    /// Points of a method's pattern (default: 4096)
    #[arg(short, value_name = "N", allow_negative_numbers = true,
          value_parser = clap::value_parser!(u32).range(1..=100_000_000))]
    n: Option<u32>,
    /// Seed of a method's pattern, of tiles that vary and of adaptive sampling (default: 1)
    #[arg(short, long, value_name = "SEED", allow_negative_numbers = true)]
    seed: Option<u64>,
    /// An option of the method, as `bn generate METHOD --help` has them; may be repeated
    #[arg(short = 'O', long = "option", value_name = "NAME=VALUE")]
    options: Vec<String>,
    /// Turn tiles by quarters, shift them on the torus, or both, each in its own way
    #[arg(long, value_name = "HOW", default_value = "none")]
    vary_tiles: Vary,
    /// Instead of a tiled pattern and a kernel: the same weighted samples for every pixel, one of the
    /// sets below or a text file of lines `x y weight` (offsets from the pixel's
    /// centre; weight 1 where left out)
    #[arg(long, value_name = "SET|FILE",
          conflicts_with_all = ["pattern", "spp", "normalize", "n", "seed", "options", "vary_tiles",
                                "reconstruct", "adaptive", "max_spp"])]
    supersampling: Option<String>,
    #[command(flatten)]
    reconstruction: ReconstructionArgs,
    #[command(flatten)]
    adaptive: AdaptiveArgs,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Normalize {
    Density,
    None,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Vary {
    None,
    Turn,
    Shift,
    Both,
}

/// What turns a scene into pixels.
pub(super) enum Sampling {
    /// A tiled pattern and a kernel.
    Tiled(Box<Tiled>),
    /// A tiled pattern, and the band-limited function that fits its samples.
    Fitted(Box<BandLimited>),
    /// Periodic supersampling.
    Periodic(Supersampling),
    /// A pattern in layers, as dense as an error takes.
    Adaptive(Box<Adaptive>),
}

/// What was done for an image.
#[derive(Default)]
pub(super) struct Done {
    pub(super) stats: RenderStats,
    /// How iterations went, if there were any.
    pub(super) fit: Option<BandLimitedStats>,
    /// What adaptive sampling has to say beside.
    pub(super) adaptive: Option<AdaptiveStats>,
}

/// A pattern laid over the image plane, and how its samples become pixels.
pub(super) struct Tiled {
    pub(super) pattern: Pattern,
    table: KernelTable,
    pub(super) normalization: Normalization,
}

impl SamplingArgs {
    /// The kernel, which the reference uses too.
    pub(super) fn kernel(&self) -> &'static dyn Kernel {
        let name = self.kernel.as_deref().unwrap_or("lanczos2");
        bn_render::kernel(name).expect("the parser lets kernels pass only")
    }

    /// Refuses a kernel where nothing is made through it.
    pub(super) fn check_kernel(&self, reference_takes_it: bool) -> Outcome {
        if self.supersampling.is_some() && self.kernel.is_some() && !reference_takes_it {
            return Err(Failure::misuse(
                "--kernel concerns patterns, and references other than files: --supersampling has \
                 no use for it",
            ));
        }
        Ok(())
    }

    /// How tiles vary, as typed.
    pub(super) fn variation_name(&self) -> Value {
        word(&self.vary_tiles)
    }

    /// Names of files that may be read.
    pub(super) fn files(&self) -> impl Iterator<Item = &Path> {
        [&self.pattern, &self.supersampling].into_iter().flatten().map(Path::new)
    }

    /// The seed, where something hangs on it; `pattern` is the pattern's account.
    pub(super) fn seed_taken(&self, pattern: &Value) -> Option<u64> {
        (pattern.get("method").is_some() || self.takes_seed()).then(|| self.seed())
    }

    fn seed(&self) -> u64 {
        self.seed.unwrap_or(1)
    }

    /// Whether the seed decides more than a method's points.
    fn takes_seed(&self) -> bool {
        self.vary_tiles != Vary::None || self.adaptive.is_wanted()
    }

    /// The sampling and its account.
    pub(super) fn sampling(&self, frame: &Frame, bar: &Bar) -> Outcome<(Sampling, Value)> {
        let fitted = self.reconstruction.band_limited()?;
        if let Some(name) = &self.supersampling {
            let pattern = supersampling::pattern(name)?;
            let account = json!({
                "supersampling": name,
                "samples_per_pixel": pattern.samples_per_pixel(),
                "weights_per_pixel": pattern.weights_per_pixel(),
            });
            return Ok((Sampling::Periodic(pattern), account));
        }
        self.check(fitted.as_ref(), frame)?;
        let name = self.pattern.as_deref().unwrap_or_default();
        let (set, account) = match bn_samplers::find(name) {
            Ok(method) => self.generated(method, bar)?,
            Err(unknown) => (self.read(name, unknown)?, json!({"file": name})),
        };
        let variation = self.variation();
        if let Some(options) = fitted {
            let pattern = self.reconstruction.pattern(&set, self.spp)?.varied(variation);
            let fitted = BandLimited { pattern, kernel: self.kernel(), options };
            return Ok((Sampling::Fitted(Box::new(fitted)), account));
        }
        let normalization = match self.normalize {
            Some(Normalize::None) => Normalization::None,
            Some(Normalize::Density) | None => Normalization::Density,
        };
        let table = KernelTable::new(self.kernel());
        if self.adaptive.is_wanted() {
            let adaptive = self.adaptive.sampling(
                &set,
                self.spp,
                (self.layer_seed(), variation),
                table,
                normalization,
            )?;
            return Ok((Sampling::Adaptive(Box::new(adaptive)), account));
        }
        let pattern = self.reconstruction.pattern(&set, self.spp)?.varied(variation);
        Ok((Sampling::Tiled(Box::new(Tiled { pattern, table, normalization })), account))
    }

    /// Refuses what makes no sense together, before a pattern is made or read.
    fn check(&self, fitted: Option<&BandLimitedOptions>, frame: &Frame) -> Outcome {
        if self.reconstruction.by_voronoi() && self.vary_tiles != Vary::None {
            return Err(Failure::misuse(
                "tiles that vary cut through Voronoi cells: --vary-tiles needs --weights equal",
            ));
        }
        if fitted.is_some() && self.normalize.is_some() {
            return Err(Failure::misuse("--normalize concerns --reconstruct convolution only"));
        }
        // Rates are refused whatever the set.
        let point = PointSet::new(vec![DVec2::ZERO]).map_err(Failure::failed)?;
        Pattern::tiled(&point, self.spp)
            .map_err(|error| Failure::misuse(format!("--spp: {error}")))?;
        self.adaptive.check(self.spp)?;
        if self.adaptive.is_wanted() && fitted.is_some() {
            return Err(Failure::misuse("--adaptive goes with --reconstruct convolution only"));
        }
        if self.adaptive.is_wanted() && self.reconstruction.by_voronoi() {
            return Err(Failure::misuse(
                "--adaptive weighs samples alike: --weights voronoi does not go with it",
            ));
        }
        if let Some(options) = fitted {
            reconstruction::check(options, frame, self.kernel(), self.spp)?;
        }
        Ok(())
    }

    /// How tiles vary.
    fn variation(&self) -> TileVariation {
        match self.vary_tiles {
            Vary::None => TileVariation::Repeated,
            Vary::Turn => TileVariation::Turned(self.tile_seed()),
            Vary::Shift => TileVariation::Shifted(self.tile_seed()),
            Vary::Both => TileVariation::TurnedAndShifted(self.tile_seed()),
        }
    }

    /// The seed of what sets tiles apart, unlike that of any set.
    fn tile_seed(&self) -> Seed {
        Seed::new(self.seed()).for_set(u32::MAX)
    }

    /// The seed of the shifts of an adaptive pattern's layers.
    fn layer_seed(&self) -> Seed {
        Seed::new(self.seed()).for_set(u32::MAX - 1)
    }

    fn generated(&self, method: &'static Method, bar: &Bar) -> Outcome<(PointSet, Value)> {
        let mut options = Vec::new();
        for option in &self.options {
            let (name, value) = option.split_once('=').ok_or_else(|| {
                Failure::misuse(format!("--option {option}: an option looks like radius=0.7"))
            })?;
            options.push((name.trim(), value.trim()));
        }
        let sampler =
            method.with_values(given_values(method, &options)?).map_err(Failure::usage)?;
        let n = self.n.unwrap_or(4096);
        let sample = sampler.sample(n as usize, Seed::new(self.seed()), bar).map_err(|error| {
            let usage = error.is_usage();
            let error = anyhow!(error).context(method.name);
            if usage { Failure::usage(error) } else { Failure::failed(error) }
        })?;
        let account = json!({
            "method": method.name, "n": sample.points.len(), "seed": self.seed(), "options": self.options,
        });
        Ok((sample.points, account))
    }

    fn read(&self, name: &str, unknown: impl std::fmt::Display) -> Outcome<PointSet> {
        let path = Path::new(name);
        if path.extension().is_none() && !path.exists() && name != "-" {
            return Err(Failure::misuse(format!(
                "{unknown}; a file of that name is not there either (`bn list` names the methods)"
            )));
        }
        if self.n.is_some() || !self.options.is_empty() {
            return Err(Failure::misuse(format!(
                "-n and --option belong to methods; {name} is a file of points"
            )));
        }
        if self.seed.is_some() && !self.takes_seed() {
            return Err(Failure::misuse(format!(
                "--seed belongs to methods, --vary-tiles and --adaptive; {name} is a file of points"
            )));
        }
        only_set(path)
    }
}

impl Sampling {
    /// Samples per pixel.
    pub(super) fn samples_per_pixel(&self) -> f64 {
        match self {
            Self::Tiled(tiled) => tiled.pattern.samples_per_pixel(),
            Self::Fitted(fitted) => fitted.pattern.samples_per_pixel(),
            Self::Periodic(pattern) => pattern.samples_per_pixel() as f64,
            Self::Adaptive(adaptive) => adaptive.pilot(),
        }
    }

    /// How sums become pixels, where a kernel makes them.
    pub(super) fn normalization(&self) -> Option<Normalization> {
        match self {
            Self::Tiled(tiled) => Some(tiled.normalization),
            Self::Fitted(_) | Self::Periodic(_) => None,
            Self::Adaptive(adaptive) => Some(adaptive.normalization),
        }
    }

    /// Renders the subject's window, handing its rows over from the top.
    pub(super) fn render(
        &self,
        subject: &Subject,
        observer: &dyn Observer,
        rows: &mut Rows<'_>,
    ) -> Outcome<Done> {
        match self {
            Self::Tiled(tiled) => {
                let stats = tiled.render(&*subject.scene, &subject.frame, observer, rows)?;
                Ok(Done { stats, ..Done::default() })
            }
            Self::Fitted(fitted) => {
                let (image, fit) = fitted.render(subject, observer)?;
                rows(image.values())?;
                let (samples, evaluated) = (fit.samples, fit.evaluated);
                let stats = RenderStats { samples, evaluated, ..RenderStats::default() };
                Ok(Done { stats, fit: Some(fit), adaptive: None })
            }
            Self::Periodic(pattern) => {
                let (image, samples) = pattern
                    .render(&*subject.scene, &subject.frame, observer)
                    .map_err(from_render_error)?;
                rows(image.values())?;
                let stats = RenderStats { samples, evaluated: samples, ..RenderStats::default() };
                Ok(Done { stats, ..Done::default() })
            }
            Self::Adaptive(adaptive) => {
                let stats = adaptive.render(subject, observer, rows)?;
                Ok(Done { stats: adaptive::common(&stats), adaptive: Some(stats), fit: None })
            }
        }
    }
}

impl Tiled {
    /// A pattern with the kernel and normalisation of another.
    pub(super) fn new(
        pattern: Pattern,
        kernel: &'static dyn Kernel,
        normalization: Normalization,
    ) -> Self {
        Self { pattern, table: KernelTable::new(kernel), normalization }
    }

    pub(super) fn render(
        &self,
        scene: &dyn Scene,
        frame: &Frame,
        observer: &dyn Observer,
        rows: &mut Rows<'_>,
    ) -> Outcome<RenderStats> {
        let renderer = Renderer::new(scene, &self.pattern, &self.table, self.normalization, frame);
        renderer.stream(observer, |band| rows(band.values)).map_err(from_render_error)
    }
}

/// The writer's own errors, among them a reader that went away, stay what they are.
pub(super) fn from_render_error(error: RenderError) -> Failure {
    match error {
        RenderError::Output(error) => Failure::from(error),
        RenderError::Image(error @ ImageError::NotFinite { .. }) => Failure::usage(
            anyhow!(error)
                .context("the scene is brighter than 32-bit floats can tell once filtered"),
        ),
        RenderError::Image(error) => Failure::usage(error),
        other => Failure::failed(other),
    }
}
