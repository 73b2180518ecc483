//! The layout of the page.

use super::{ReportData, curves, statistics};
use crate::plot::{Axis, Dots, Grid, Page, Panel, Row, Text};

/// The value shown white in the autocorrelation and the power spectrum, in multiples of the mean.
pub const WHITE: f64 = 3.0;

/// Side of the panels in points: three of them and their labels make a page 180 mm wide.
const SIDE: f64 = 130.0;

/// A spectrum of up to this many cells a side is shown cell by cell; a finer one is averaged down
/// to no more pixels. Whoever measures a larger spectrum may take means to this size themselves.
pub const MOST_CELLS: usize = 1000;

/// The page at its natural resolution: a pixel of its panels is a cell of the spectrum, a whole
/// fraction of one where cells are few, or the mean of many.
pub fn page(data: &ReportData) -> Page {
    let pixels = panel_pixels(data.spectrum.columns().max(data.spectrum.rows()));
    page_at(data, f64::from(pixels) / SIDE)
}

/// The page at `density` pixels a point.
pub(super) fn page_at(data: &ReportData, density: f64) -> Page {
    let pixels = (SIDE * density).round().max(1.0) as u32;
    let first = Row::new(
        SIDE,
        vec![
            points(data),
            image("Autocorrelation", &data.autocorrelation, pixels, "*r*", "*d*_{hex}"),
            image("Power spectrum", &with_visible_peaks(&data.spectrum), pixels, "*ν*", "(√*n*/2)"),
        ],
    );
    let second = Row::new(
        SIDE,
        vec![
            curves::anisotropy(&data.anisotropy, data.sets),
            curves::rdf(&data.rdf),
            curves::radial_power(&data.radial_power),
        ],
    );
    let page = Page::new()
        .titled(Text::plain(&data.title))
        .made_by(&data.provenance)
        .with_density(density)
        .row(first)
        .row(second);
    let page = statistics::tables(&data.statistics, data.sets).into_iter().fold(page, Page::table);
    page.paragraph(caption(data))
}

/// Pixels across a panel for a spectrum of this many cells: 560 to 1119 where cells allow it.
fn panel_pixels(cells: usize) -> u32 {
    let pixels = if cells <= MOST_CELLS {
        cells * 560_usize.div_ceil(cells)
    } else {
        cells / cells.div_ceil(MOST_CELLS)
    };
    pixels as u32
}

fn points(data: &ReportData) -> Panel {
    let axis = |name: &str| Axis::linear(Text::math(name)).over(0.0, 1.0);
    Panel::new(axis("*x*"), axis("*y*"))
        .titled(Text::plain("Points"))
        .dots(Dots::new(data.points.iter().copied()))
}

fn image(title: &str, grid: &Grid, pixels: u32, symbol: &str, unit: &str) -> Panel {
    let axis = |component: &str, [low, high]: [f64; 2]| {
        Axis::linear(Text::math(&format!("{symbol}_{{{component}}}/{unit}"))).over(low, high)
    };
    let pixels = |cells: usize| pixels.min(cells as u32);
    Panel::new(axis("*x*", grid.x()), axis("*y*", grid.y()))
        .titled(Text::plain(title))
        .picture(grid.to_picture(pixels(grid.columns()), pixels(grid.rows()), WHITE))
}

/// A cell above this is a Bragg peak: of 10⁶ cells of an unordered pattern under a peak of height 5
/// one in 10³ spectra has such a cell.
const BRAGG: f64 = 100.0;

/// The spectrum with Bragg peaks, one cell each, made about 1.4 points wide.
fn with_visible_peaks(spectrum: &Grid) -> Grid {
    let reach = (spectrum.columns() as f64 / 220.0).round() as usize;
    spectrum.clone().with_peaks_widened(BRAGG, reach)
}

fn caption(data: &ReportData) -> Text {
    let n = grouped(data.points_per_set);
    let sets = match data.sets {
        0 | 1 => format!("One set of *n* = {n} points."),
        m => {
            format!("Mean of *m* = {m} sets of *n* = {n} points; the points are those of one set.")
        }
    };
    let inset = if data.points.len() > Dots::MOST_DISCS {
        " The inset shows about 256 points of the lower left corner."
    } else {
        ""
    };
    let peaks = if data.spectrum.exceeds(BRAGG) {
        format!(", peaks above {BRAGG} drawn larger than they are")
    } else {
        String::new()
    };
    Text::math(&format!(
        "{sets}{inset} Images in linear grey, black at 0, white at {WHITE} times the mean or more; \
         DC removed from the spectrum{peaks}. Distances in units of *d*_{{hex}}, frequencies in units of \
         √*n*/2. Dashed: what independent random points have on average."
    ))
}

/// A count with thin spaces between groups of three digits from 10 000 on.
fn grouped(count: usize) -> String {
    let digits = count.to_string();
    if digits.len() < 5 {
        return digits;
    }
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push('\u{2009}');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_grouped() {
        assert_eq!(grouped(4096), "4096");
        assert_eq!(grouped(1_000_000), "1\u{2009}000\u{2009}000");
        assert_eq!(grouped(65_536), "65\u{2009}536");
    }

    #[test]
    fn panels_show_a_spectrum_cell_by_cell() {
        for cells in 1..=MOST_CELLS {
            let pixels = panel_pixels(cells) as usize;
            assert!(pixels.is_multiple_of(cells) && (560..1119).contains(&pixels), "{cells}");
        }
        for cells in [1001, 1281, 10_001, 1_000_000] {
            let pixels = panel_pixels(cells) as usize;
            assert!((500..=MOST_CELLS).contains(&pixels), "{cells}: {pixels}");
        }
    }
}
