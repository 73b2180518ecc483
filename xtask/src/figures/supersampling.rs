//! Periodic supersampling: patterns, transfer functions and what they make of a picture (figures 3.2
//! and 3.3).

use bn_cli::plot::{Axis, Grid, Page, Panel, Reference, Row, Series, Style, Text};
use bn_cli::{Failure, Outcome};
use bn_core::Unobserved;
use bn_render::{Frame, Image, Interpolation, Picture, StripedCloth, Supersampling, supersampling};

use super::FigureSpec;
use super::gallery::picture;
use super::studio::Studio;

pub(super) const FIGURES: &[FigureSpec] = &[
    FigureSpec { id: "3.2", title: "supersampling patterns: none to quincunx", draw: first },
    FigureSpec { id: "3.3", title: "supersampling patterns: grids of 4 and 16", draw: second },
];

/// The test image's side, and that of what is made of it.
const LARGE: u32 = 512;
const SMALL: u32 = 128;

/// Pixels of the transfer function's image, an odd number so that one is ν = 0.
const CELLS: u32 = 257;

/// Side of the panels in points, and pixels a point: a panel shows 256 pixels.
const SIDE: f64 = 128.0;

fn first(studio: &Studio) -> Outcome {
    page(studio, &["none", "lanczos2", "quincunx"])
}

fn second(studio: &Studio) -> Outcome {
    page(studio, &["grid-2x2", "rotated-grid", "grid-4x4-box", "grid-4x4-lanczos2"])
}

/// The test image: one sample a pixel of the striped cloth, which has little above half a cycle a
/// pixel at this size.
fn test_image() -> Outcome<Image> {
    let large = Frame::new(LARGE, LARGE).map_err(Failure::failed)?;
    let once = supersampling("none").expect("in the list");
    Ok(once.render(&StripedCloth::new(&large), &large, &Unobserved).map_err(Failure::failed)?.0)
}

fn page(studio: &Studio, names: &[&str]) -> Outcome {
    let small = Frame::new(SMALL, SMALL).map_err(Failure::failed)?;
    let scene = Picture::covering(test_image()?, Interpolation::Bilinear, &small);
    let mut page = Page::new().with_density(2.0);
    for name in names {
        let pattern = supersampling(name).expect("in the list");
        let (image, _) = pattern.render(&scene, &small, &Unobserved).map_err(Failure::failed)?;
        page = page.row(Row::new(
            SIDE,
            vec![taps(&pattern), transfer(&pattern)?, section(&pattern), resampled(&image)?],
        ));
    }
    let caption = "Left: the samples of a pixel (its square is dashed), round where the weight is \
                   positive, square where it is negative. Then the MTF over ±4 *ν*_{c}, black 0, white 1: what lies outside the \
                   dashed square of the Nyquist region folds back onto it from the blocks around. \
                   Third: the MTF along the axis and the diagonal. Right: the 512² test image at 128².";
    studio.page("", &page.paragraph(Text::math(caption)))
}

/// The impulse response: weights at their places.
fn taps(pattern: &Supersampling) -> Panel {
    let axis = |name: &str| Axis::linear(Text::math(name)).over(-2.2, 2.2);
    let places = |positive: bool| {
        let taps = pattern.impulse_response().filter(move |tap| (tap.weight > 0.0) == positive);
        // Weights of 0 up to rounding are left out.
        taps.filter(|tap| tap.weight.abs() > 1e-9).map(|tap| [tap.offset.x, -tap.offset.y])
    };
    let title = format!(
        "{}: *n* = {}, *m* = {}",
        pattern.name(),
        pattern.samples_per_pixel(),
        pattern.weights_per_pixel()
    );
    let panel = Panel::new(axis("*x*"), axis("*y*")).titled(Text::math(&title));
    let panel = [-0.5, 0.5].into_iter().fold(panel, |panel, at| {
        panel.reference(Reference::vertical(at)).reference(Reference::horizontal(at))
    });
    let series = |positive, style| {
        Series::new(places(positive)).styled(Style::Cycle(style)).with_markers().without_line()
    };
    panel.line(series(true, 0)).line(series(false, 1))
}

/// The MTF as an image over four times the Nyquist frequency to either side, with the blocks that fold onto each other.
fn transfer(pattern: &Supersampling) -> Outcome<Panel> {
    let image = pattern.transfer_image(CELLS).map_err(Failure::failed)?;
    let rows = image.values().chunks_exact(CELLS as usize).rev();
    let values = rows.flat_map(|row| row.iter().map(|&m| f64::from(m))).collect();
    let grid = Grid::new(CELLS as usize, values, [-4.0, 4.0], [-4.0, 4.0]);
    let axis = |name: &str| Axis::linear(Text::math(name)).over(-4.0, 4.0);
    let panel = Panel::new(axis("*ν*_{x}/*ν*_{c}"), axis("*ν*_{y}/*ν*_{c}"))
        .titled(Text::plain("MTF"))
        .picture(grid.to_picture(CELLS, CELLS, 1.0));
    Ok([-3.0, -1.0, 1.0, 3.0].into_iter().fold(panel, |panel, at| {
        panel.reference(Reference::vertical(at)).reference(Reference::horizontal(at))
    }))
}

/// The MTF along the axis and the diagonal.
fn section(pattern: &Supersampling) -> Panel {
    // Frequencies in ν_c, half a cycle per pixel.
    let along = |x: f64, y: f64| {
        (0..=200).map(move |i| {
            let nu = 4.0 * f64::from(i) / 200.0;
            [nu, pattern.transfer(bn_core::DVec2::new(0.5 * nu * x, 0.5 * nu * y))]
        })
    };
    let diagonal = std::f64::consts::FRAC_1_SQRT_2;
    Panel::new(
        Axis::linear(Text::math("*ν*/*ν*_{c}")).over(0.0, 4.0),
        Axis::linear(Text::plain("MTF")).over(0.0, 1.4),
    )
    .reference(Reference::vertical(1.0))
    .line(Series::new(along(1.0, 0.0)).named(Text::plain("axis")).styled(Style::Cycle(0)))
    .line(
        Series::new(along(diagonal, diagonal))
            .named(Text::plain("diagonal"))
            .styled(Style::Cycle(1)),
    )
}

fn resampled(image: &Image) -> Outcome<Panel> {
    let twice = super::gallery::enlarged(image, 2)?;
    Ok(Panel::new(Axis::blank(), Axis::blank())
        .titled(Text::plain("512² at 128²"))
        .picture(picture(&twice)))
}
