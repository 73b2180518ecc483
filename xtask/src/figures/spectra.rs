//! Power spectra of common patterns (figure 3.4).

use bn_cli::Outcome;
use bn_cli::analysis::Analysis;
use bn_cli::plot::{Axis, Dots, Page, Panel, Row, Series, Text};
use bn_cli::report::{ReportData, WHITE};

use super::FigureSpec;
use super::studio::Studio;

pub(super) const FIGURES: &[FigureSpec] =
    &[FigureSpec { id: "3.4", title: "power spectra of common patterns", draw: common }];

/// Points and sets of each pattern.
fn plan(studio: &Studio) -> (usize, u32) {
    if studio.quick() { (256, 2) } else { (4096, 10) }
}

/// Spectra are shown up to this many √n/2.
const RANGE: f64 = 5.0;

/// Side of the panels in points.
const SIDE: f64 = 120.0;

fn data(studio: &Studio, method: &str, title: &str) -> Outcome<ReportData> {
    let (n, count) = plan(studio);
    let sets = studio.sets(method, &[], n, count)?;
    let analysis = Analysis::of(&sets);
    let frequency = (RANGE * analysis.density().grid_nyquist()).ceil() as usize;
    Ok(analysis.report_data(title.to_owned(), studio.provenance(), frequency))
}

/// Points, spectrum and ring means side by side.
fn row(data: &ReportData) -> Row {
    let unit = |name: &str| Axis::linear(Text::math(name)).over(0.0, 1.0);
    let points = Panel::new(unit("*x*"), unit("*y*"))
        .titled(Text::math(&data.title))
        .dots(Dots::new(data.points.iter().copied()).window(0.5));
    let axis = |component: &str| {
        Axis::linear(Text::math(&format!("*ν*_{{{component}}}/(√*n*/2)"))).over(-RANGE, RANGE)
    };
    let grid = &data.spectrum;
    let pixels = (grid.columns() as u32, grid.rows() as u32);
    let spectrum = Panel::new(axis("x"), axis("y"))
        .titled(Text::plain("power spectrum"))
        .picture(grid.to_picture(pixels.0, pixels.1, WHITE));
    // From 0 on and not closer than this, so that what is white noise looks white.
    let highest = data.radial_power.values().iter().copied().fold(2.0, f64::max);
    let radial = Panel::new(
        Axis::linear(Text::math("*ν*/(√*n*/2)")).over(0.0, RANGE),
        Axis::linear(Text::plain("power")).over(0.0, 1.05 * highest),
    )
    .with_aspect(1.6)
    .line(Series::of_curve(&data.radial_power));
    Row::new(SIDE, vec![points, spectrum, radial])
}

fn common(studio: &Studio) -> Outcome {
    let mut page = Page::new();
    for (method, title) in [
        ("regular", "square grid"),
        ("stochastic", "stochastic sampling"),
        ("jittered", "jittered grid"),
        ("dart-throwing", "dart throwing"),
    ] {
        page = page.row(row(&data(studio, method, title)?));
    }
    studio.page("", &page)
}
