//! Figures 5.1 and 5.2: autocorrelations and radial distribution functions of known patterns.

use bn_cli::Outcome;
use bn_cli::analysis::Analysis;
use bn_cli::plot::{Axis, Grid, Page, Panel, Row, Style, Text};
use bn_core::Density;

use super::FigureSpec;
use super::panels::{self, Line};
use super::studio::Studio;

pub(super) const FIGURES: &[FigureSpec] = &[
    FigureSpec {
        id: "5.1",
        title: "autocorrelations of sampling patterns beside their power spectra",
        draw: autocorrelations,
    },
    FigureSpec { id: "5.2", title: "radial distribution functions of blue noise", draw: rdfs },
];

/// The value shown white, in multiples of the mean.
const WHITE: f64 = 3.0;
/// Pixels a side of an image.
const PIXELS: u32 = 600;

/// Name in the registry and on the page, with options.
type Shown = (&'static str, &'static str, &'static [(&'static str, &'static str)]);

const IN_5_1: [Shown; 4] = [
    ("jittered", "jittered grid", &[]),
    ("dart-throwing", "dart throwing", &[]),
    ("cccvt", "CCCVT", &[]),
    ("fpo", "farthest-point optimization", &[]),
];

fn autocorrelations(studio: &Studio) -> Outcome {
    let (n, count) = if studio.quick() { (256, 2) } else { (4096, 10) };
    let mut page = Page::new().titled(Text::plain("Autocorrelation and power spectrum"));
    for (method, name, options) in IN_5_1 {
        let sets = studio.sets(method, options, n, count)?;
        let analysis = Analysis::of(&sets);
        let data =
            analysis.report_data(String::new(), String::new(), (2.5 * (n as f64).sqrt()) as usize);
        page = page.row(Row::new(
            130.0,
            vec![
                panels::points(name, &sets[0]),
                image("autocorrelation", &data.autocorrelation, "*r*", "*d*_{hex}"),
                image("power spectrum", &data.spectrum, "*ν*", "(√*n*/2)"),
            ],
        ));
    }
    let text = format!(
        "A quarter of one set of {n} points; means of {count} sets. Images in linear grey, black at 0, \
         white at {WHITE} times the mean or more."
    );
    studio.page("", &page.paragraph(Text::plain(&text)))
}

fn image(title: &str, grid: &Grid, symbol: &str, unit: &str) -> Panel {
    let axis = |component: &str, [low, high]: [f64; 2]| {
        Axis::linear(Text::math(&format!("{symbol}_{{{component}}}/{unit}"))).over(low, high)
    };
    Panel::new(axis("*x*", grid.x()), axis("*y*", grid.y()))
        .titled(Text::plain(title))
        .picture(grid.to_picture(PIXELS, PIXELS, WHITE))
}

const IN_5_2: [Shown; 6] = [
    ("jittered", "jittered grid", &[]),
    ("dart-throwing", "dart throwing", &[]),
    ("kernel-density", "kernel density", &[]),
    ("cccvt", "CCCVT", &[]),
    ("fpo", "farthest-point optimization", &[]),
    ("lloyd", "Lloyd", &[("iterations", "1000"), ("tolerance", "0")]),
];

fn rdfs(studio: &Studio) -> Outcome {
    let (n, count) = if studio.quick() { (256, 2) } else { (4096, 10) };
    let density = Density::new(n);
    let farthest = 5.0;
    let range = (farthest * density.hexagonal_spacing()).min(0.5);
    let mut shown = Vec::new();
    for (method, name, options) in IN_5_2 {
        let sets = studio.sets(method, options, n, count)?;
        let bins = if studio.quick() { 50 } else { 400 };
        let line = Line::of_curve("", &Analysis::of(&sets).rdf_within(range, bins), Style::Accent);
        shown.push(panels::rdf(name, density, &[line], (farthest, 0.0, 4.0)));
    }
    let mut page = Page::new().titled(Text::plain("Radial distribution functions"));
    while !shown.is_empty() {
        let rest = shown.split_off(shown.len().min(3));
        page = page.row(Row::new(110.0, std::mem::replace(&mut shown, rest)));
    }
    let text = format!("Means of {count} sets of {n} points. Dashed: independent points.");
    studio.page("", &page.paragraph(Text::plain(&text)))
}
