//! Panels that several figures have: points, RDFs and radial spectra, in the thesis's units.

use bn_cli::plot::{Axis, Dots, Panel, Reference, Series, Style, Text};
use bn_core::{Curve, Density, PointSet};

/// A line of a panel: its name, its abscissae in cycles per unit or unit lengths.
pub(super) struct Line {
    pub(super) name: &'static str,
    pub(super) points: Vec<[f64; 2]>,
    pub(super) style: Style,
}

impl Line {
    pub(super) fn new(name: &'static str, points: Vec<[f64; 2]>, style: Style) -> Self {
        Self { name, points, style }
    }

    pub(super) fn of_curve(name: &'static str, curve: &Curve, style: Style) -> Self {
        Self::new(name, curve.iter().map(|(x, y)| [x, y]).collect(), style)
    }
}

/// A square of about 1,024 of the points.
pub(super) fn points(title: &str, set: &PointSet) -> Panel {
    let side = (1024.0 / set.len() as f64).sqrt().min(1.0);
    Panel::new(Axis::blank(), Axis::blank())
        .titled(Text::math(title))
        .dots(Dots::new(set.points().iter().copied()).window(side))
}

/// P over ν/(√n/2), from 0 to `highest` and `top`.
pub(super) fn power(
    title: &str,
    density: Density,
    lines: &[Line],
    (highest, top): (f64, f64),
) -> Panel {
    let x = Axis::linear(Text::math("*ν*/(√*n*/2)")).over(0.0, highest);
    let y = Axis::linear(Text::math("*P*")).over(0.0, top);
    panel(title, x, y, lines, density.grid_nyquist(), highest)
}

/// g over `r/d_hex`, from 0 to `farthest` and from `bottom` to `top`.
pub(super) fn rdf(
    title: &str,
    density: Density,
    lines: &[Line],
    (farthest, bottom, top): (f64, f64, f64),
) -> Panel {
    let x = Axis::linear(Text::math("*r*/*d*_{hex}")).over(0.0, farthest);
    let y = Axis::linear(Text::math("*g*")).over(bottom, top);
    panel(title, x, y, lines, density.hexagonal_spacing(), farthest)
}

fn panel(title: &str, x: Axis, y: Axis, lines: &[Line], unit: f64, end: f64) -> Panel {
    let panel = Panel::new(x, y).titled(Text::math(title)).with_aspect(1.2);
    let one = panel.reference(Reference::horizontal(1.0));
    lines.iter().fold(one, |panel, line| {
        let points = line.points.iter().map(|&[x, y]| [x / unit, y]).filter(|[x, _]| *x <= end);
        let series = Series::new(points).styled(line.style);
        panel.line(if line.name.is_empty() { series } else { series.named(Text::math(line.name)) })
    })
}

/// `count` + 1 abscissae from 0 to `end`.
pub(super) fn grid(end: f64, count: usize) -> Vec<f64> {
    (0..=count).map(|i| end * i as f64 / count as f64).collect()
}
