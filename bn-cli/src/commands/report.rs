//! `bn report`: the page of appendix B.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use bn_core::io::Format;
use clap::{Args, Command};

use super::Global;
use crate::analysis::{Analysis, SPECTRAL_LIMIT};
use crate::progress_bar::Bar;
use crate::{Failure, Outcome, input, output, report};

#[derive(Debug, Args)]
pub(super) struct Report {
    /// Point files, whose sets are averaged; `-` is standard input
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Page to write: .png, .svg or .html
    #[arg(short, long, value_name = "PAGE")]
    output: PathBuf,
    /// Heading of the page (default: the files' names)
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
    /// Width of a .png in pixels (default: so that a pixel is a mode of the spectrum, or several)
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(200..=20_000))]
    width: Option<u32>,
    /// Show the spectrum up to this frequency, in sqrt(n)/2 (default: 10, less above 4 million points)
    #[arg(long, value_name = "NU", allow_negative_numbers = true)]
    range: Option<f64>,
    /// Format of the files (default: by each file's extension)
    #[arg(long, value_name = "FORMAT")]
    format: Option<Format>,
    /// Wrap coordinates outside [0, 1) instead of refusing them
    #[arg(long)]
    wrap: bool,
}

pub(super) fn command() -> Command {
    Report::augment_args(Command::new("report"))
        .about("Draw the page that describes a pattern")
        .long_about(
            "Draw the page that describes a pattern: points, autocorrelation, power spectrum, \
             anisotropy, radial distribution function, radial power, and the statistics. Several \
             sets are averaged; the points shown are those of the first.",
        )
        .after_help("Example: bn report lloyd_*.rps -o lloyd.png")
}

enum Page {
    Png,
    Svg,
    Html,
}

pub(super) fn run(args: &Report, global: &Global) -> Outcome {
    let page = page_format(&args.output)?;
    // Before the points are read and measured.
    output::check_folder(&args.output)?;
    if args.width.is_some() && !matches!(page, Page::Png) {
        return Err(Failure::misuse("--width belongs to a .png; other pages have no pixels"));
    }
    let mut sets = Vec::new();
    for file in &args.files {
        sets.extend(input::read(file, args.format, args.wrap)?.into_sets());
    }
    let n = sets[0].len();
    if let Some(other) = sets.iter().find(|set| set.len() != n) {
        return Err(Failure::misuse(format!(
            "sets of {n} and of {} points are not averaged; draw a page for each",
            other.len()
        )));
    }
    if n > SPECTRAL_LIMIT {
        return Err(Failure::misuse(format!(
            "the spectrum of {n} points can't be planned; {SPECTRAL_LIMIT} at most"
        )));
    }
    let names = args.files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>();
    let title = args.title.clone().unwrap_or_else(|| heading(&names));
    let bar = Bar::new(global.quiet);
    bar.working("measuring and drawing".to_owned());
    let analysis = Analysis::of(&sets);
    let range = range(args.range, n)?;
    let frequency = (range * analysis.density().grid_nyquist()).ceil().max(1.0) as usize;
    let provenance = format!("bn {} report {}", env!("CARGO_PKG_VERSION"), names.join(" "));
    let data = analysis.report_data(title, provenance, frequency);
    let drawn = |error| Failure::failed(anyhow!("{}: {error}", args.output.display()));
    let bytes = match page {
        Page::Png => report::to_png(&data, args.width).map_err(drawn)?,
        Page::Svg => report::to_svg(&data).map_err(drawn)?.into_bytes(),
        Page::Html => report::to_html(&data).map_err(drawn)?.into_bytes(),
    };
    drop(bar);
    output::write_to(&args.output, |w| Ok(w.write_all(&bytes)?))
}

/// The most modes of a page's spectrum, which has range²·n of them: some ten seconds and 1 GB.
const MOST_MODES: f64 = 4e8;

/// The range of the spectrum, in √n/2, for sets of `n` points.
fn range(asked: Option<f64>, n: usize) -> Outcome<f64> {
    let most = (MOST_MODES / n as f64).sqrt();
    match asked {
        None => Ok(most.min(10.0)),
        Some(range) if range > 0.0 && range <= most.min(100.0) => Ok(range),
        Some(range) => Err(Failure::misuse(format!(
            "--range {range}: from above 0 to {:.3} for {n} points",
            most.min(100.0)
        ))),
    }
}

fn heading(names: &[String]) -> String {
    let base = |name: &String| {
        Path::new(name).file_name().map_or_else(|| name.clone(), |n| n.to_string_lossy().into())
    };
    match names {
        [one] => base(one),
        [first, .., last] => format!("{} … {}", base(first), base(last)),
        [] => String::new(),
    }
}

fn page_format(path: &Path) -> Outcome<Page> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        Some("png") => Ok(Page::Png),
        Some("svg") => Ok(Page::Svg),
        Some("html" | "htm") => Ok(Page::Html),
        _ => Err(Failure::misuse(format!(
            "{}: a page is written as .png, .svg or .html",
            path.display()
        ))),
    }
}
