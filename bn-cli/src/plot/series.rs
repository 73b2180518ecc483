//! Lines of data and the styles that tell them apart.

use std::fmt::Write as _;

use super::canvas::{Canvas, Rect, Stroke, px};
use super::{Text, clip};

/// How a series is drawn. The colours keep their order of lightness in grey print and are told
/// apart by the colour-blind (after Okabe and Ito 2008); dashes and markers differ besides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// Solid dark blue: the series that matters.
    Accent,
    /// Dashed vermilion: what it is held against.
    Contrast,
    /// One of six styles by index (modulo 6), for many equal series.
    Cycle(usize),
}

impl Style {
    fn index(self) -> usize {
        match self {
            Self::Accent => 0,
            Self::Contrast => 1,
            Self::Cycle(index) => index % STYLES.len(),
        }
    }

    pub(super) fn stroke(self) -> Stroke {
        let (colour, dashes, _) = STYLES[self.index()];
        Stroke { colour, width: 0.8, dashes }
    }

    fn marker(self) -> Marker {
        STYLES[self.index()].2
    }
}

/// Colour, dash array and marker.
const STYLES: [(&str, &str, Marker); 6] = [
    ("#14427a", "", Marker::Disc),
    ("#d55e00", "4 1.8", Marker::Square),
    ("#00805e", "1.2 1.6", Marker::Triangle),
    ("#7b2d8b", "5 1.5 1 1.5", Marker::Diamond),
    ("#3f97cf", "2.5 1.3", Marker::Cross),
    ("#5a5a5a", "7 2", Marker::Ring),
];

/// The shape that marks a datum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Marker {
    Disc,
    Square,
    Triangle,
    Diamond,
    Cross,
    Ring,
}

impl Marker {
    /// The outline around the origin, about 2.8 points wide.
    fn outline(self, x: f64, y: f64) -> String {
        let corners: &[(f64, f64)] = match self {
            Self::Disc | Self::Ring => {
                let mut data = format!("M{} {}", px(x - 1.5), px(y));
                let _ = write!(data, "a1.5 1.5 0 1 0 3 0a1.5 1.5 0 1 0 -3 0z");
                return data;
            }
            Self::Square => &[(-1.3, -1.3), (1.3, -1.3), (1.3, 1.3), (-1.3, 1.3)],
            Self::Triangle => &[(0.0, -1.9), (1.7, 1.2), (-1.7, 1.2)],
            Self::Diamond => &[(0.0, -2.0), (1.7, 0.0), (0.0, 2.0), (-1.7, 0.0)],
            Self::Cross => &[
                (-1.7, -0.5),
                (-0.5, -0.5),
                (-0.5, -1.7),
                (0.5, -1.7),
                (0.5, -0.5),
                (1.7, -0.5),
                (1.7, 0.5),
                (0.5, 0.5),
                (0.5, 1.7),
                (-0.5, 1.7),
                (-0.5, 0.5),
                (-1.7, 0.5),
            ],
        };
        let points: Vec<String> =
            corners.iter().map(|(dx, dy)| format!("{} {}", px(x + dx), px(y + dy))).collect();
        format!("M{}z", points.join("L"))
    }

    fn draw(self, canvas: &mut Canvas, colour: &'static str, (x, y): (f64, f64)) {
        let fill = if self == Self::Ring { "#fff" } else { colour };
        let edge = if self == Self::Ring { colour } else { "#fff" };
        canvas.area(&self.outline(x, y), fill, Stroke::solid(edge, 0.35));
    }
}

/// A line through data, with or without a marker at each datum.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    pub(super) points: Vec<[f64; 2]>,
    pub(super) name: Text,
    pub(super) style: Style,
    markers: bool,
    line: bool,
}

impl Series {
    /// A solid accent line through `points` (x, y), unnamed. What is not finite is a gap.
    pub fn new(points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        Self {
            points: points.into_iter().collect(),
            name: Text::default(),
            style: Style::Accent,
            markers: false,
            line: true,
        }
    }

    /// The line through a curve's samples.
    pub fn of_curve(curve: &bn_core::Curve) -> Self {
        Self::new(curve.iter().map(|(x, y)| [x, y]))
    }

    /// The series with an entry in the legend.
    #[must_use]
    pub fn named(mut self, name: Text) -> Self {
        self.name = name;
        self
    }

    /// The series in another style.
    #[must_use]
    pub fn styled(mut self, style: Style) -> Self {
        self.style = style;
        self
    }

    /// The series with a marker at each datum.
    #[must_use]
    pub fn with_markers(mut self) -> Self {
        self.markers = true;
        self
    }

    /// The markers alone.
    #[must_use]
    pub fn without_line(mut self) -> Self {
        self.markers = true;
        self.line = false;
        self
    }

    pub(super) fn has_markers(&self) -> bool {
        self.markers
    }

    /// Draws the series through `points` in page coordinates.
    pub(super) fn draw(&self, canvas: &mut Canvas, points: &[(f64, f64)], frame: Rect) {
        let stroke = self.style.stroke();
        if self.line {
            let data = clip::path(points, frame);
            if !data.is_empty() {
                canvas.path(&data, stroke);
            }
        }
        if self.markers {
            for &point in points.iter().filter(|&&p| clip::inside(p, frame)) {
                self.style.marker().draw(canvas, stroke.colour, point);
            }
        }
    }

    /// Draws what the legend shows: a piece of the line from `x` to `x + width`.
    pub(super) fn draw_sample(&self, canvas: &mut Canvas, x: f64, y: f64, width: f64) {
        let stroke = self.style.stroke();
        if self.line {
            canvas.line((x, y), (x + width, y), stroke);
        }
        if self.markers {
            self.style.marker().draw(canvas, stroke.colour, (x + 0.5 * width, y));
        }
    }
}
