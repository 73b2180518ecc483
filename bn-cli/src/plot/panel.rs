//! One diagram: a frame with axes and layers of data.

use super::axis::{Axis, FittedAxis};
use super::canvas::{Anchor, Canvas, Rect, Stroke, TextStyle};
use super::encode::PngNotes;
use super::legend::{Entry, Legend, Obstacle};
use super::sizes;
use super::{Dots, Picture, Series, Text, Ticks};

/// A straight line across a panel that a curve is read against.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    at: f64,
    vertical: bool,
    name: Text,
}

impl Reference {
    /// The line y = `at`.
    pub fn horizontal(at: f64) -> Self {
        Self { at, vertical: false, name: Text::default() }
    }

    /// The line x = `at`.
    pub fn vertical(at: f64) -> Self {
        Self { at, vertical: true, name: Text::default() }
    }

    /// The line with an entry in the legend.
    #[must_use]
    pub fn named(mut self, name: Text) -> Self {
        self.name = name;
        self
    }
}

/// A framed diagram with two axes.
#[derive(Clone, Debug)]
pub struct Panel {
    title: Text,
    note: Text,
    x: Axis,
    y: Axis,
    aspect: f64,
    picture: Option<Picture>,
    dots: Option<Dots>,
    references: Vec<Reference>,
    series: Vec<Series>,
}

const INK: &str = "#000";
const FRAME: Stroke = Stroke::solid(INK, 0.5);
const GRID: Stroke = Stroke::solid("#e2e2e2", 0.4);
const REFERENCE: Stroke = Stroke { colour: "#d55e00", width: 0.7, dashes: "2.2 1.6" };
/// Lengths of labelled and unlabelled marks, outside the frame.
const TICK: f64 = 2.6;
const MINOR_TICK: f64 = 1.5;
/// From the frame to the tick labels.
const LABEL_GAP: f64 = 4.0;
/// What an axis's label takes off the tick labels, its subscripts included.
const NAME_ROOM: f64 = 1.5 * sizes::LABEL;
/// Between the lines of a title.
const TITLE_LEADING: f64 = 1.15 * sizes::TITLE;

/// Space that a panel needs around its frame.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Margins {
    pub left: f64,
    pub right: f64,
    pub top: f64,
    pub bottom: f64,
}

impl Panel {
    /// An empty square panel.
    pub fn new(x: Axis, y: Axis) -> Self {
        Self {
            title: Text::default(),
            note: Text::default(),
            x,
            y,
            aspect: 1.0,
            picture: None,
            dots: None,
            references: vec![],
            series: vec![],
        }
    }

    /// The panel with a title above its frame, broken into lines where it is wider.
    #[must_use]
    pub fn titled(mut self, title: Text) -> Self {
        self.title = title;
        self
    }

    /// The panel with a remark in its legend, such as what the frame cuts off.
    #[must_use]
    pub fn noted(mut self, note: Text) -> Self {
        self.note = note;
        self
    }

    /// The panel with a frame `aspect` times as wide as high.
    ///
    /// # Panics
    /// Unless `aspect` is between 0.1 and 10.
    #[must_use]
    pub fn with_aspect(mut self, aspect: f64) -> Self {
        assert!((0.1..=10.0).contains(&aspect), "a panel {aspect} times as wide as high");
        self.aspect = aspect;
        self
    }

    /// The panel with an image that fills the frame.
    #[must_use]
    pub fn picture(mut self, picture: Picture) -> Self {
        self.picture = Some(picture);
        self
    }

    /// The panel with points that fill the frame.
    #[must_use]
    pub fn dots(mut self, dots: Dots) -> Self {
        self.dots = Some(dots);
        self
    }

    /// The panel with one more reference line.
    #[must_use]
    pub fn reference(mut self, reference: Reference) -> Self {
        self.references.push(reference);
        self
    }

    /// The panel with one more line of data.
    #[must_use]
    pub fn line(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    pub(super) fn aspect(&self) -> f64 {
        self.aspect
    }

    /// The space that labels, title and a legend outside take around a frame `height` points high.
    pub(super) fn margins(&self, height: f64) -> Margins {
        let frame = Rect { x: 0.0, y: 0.0, width: self.aspect * height, height };
        let layout = self.layout(frame);
        let margins = layout.margins();
        let legend = self.legend(frame.width).place(frame, &self.obstacles(&layout));
        let outside = legend.map_or(0.0, |place| place.right() - frame.right() + 1.0);
        Margins {
            right: margins.right.max(outside),
            top: match self.title_lines(frame.width).len() {
                0 => 0.45 * sizes::TICK,
                lines => 1.55 * sizes::TITLE + (lines - 1) as f64 * TITLE_LEADING,
            },
            ..margins
        }
    }

    /// The title broken into lines that stand out over the frame by a twentieth of it at most.
    fn title_lines(&self, frame_width: f64) -> Vec<Text> {
        if self.title.is_empty() {
            return vec![];
        }
        self.title.wrapped(sizes::TITLE, 1.1 * frame_width)
    }

    /// Draws the panel around `frame`, images at `density` pixels a point.
    pub(super) fn draw(&self, canvas: &mut Canvas, frame: Rect, density: f64) {
        let layout = self.layout(frame);
        let lines = self.obstacles(&layout);
        if self.picture.is_none() && self.dots.is_none() {
            layout.draw_grid(canvas);
        }
        self.draw_ground(canvas, frame, density);
        for (series, line) in self.series.iter().zip(&lines) {
            series.draw(canvas, &line.points, frame);
        }
        // Above the data: a noisy curve would hide a line that it runs along.
        for reference in &self.references {
            layout.draw_reference(canvas, reference);
        }
        canvas.rect(frame, "none", FRAME);
        layout.draw_axes(canvas);
        self.draw_legend(canvas, frame);
        let middle = frame.x + 0.5 * frame.width;
        for (above, line) in self.title_lines(frame.width).iter().rev().enumerate() {
            let y = frame.y - 0.55 * sizes::TITLE - above as f64 * TITLE_LEADING;
            canvas.text((middle, y), line, TextStyle::new(sizes::TITLE, Anchor::Middle));
        }
    }

    /// Draws the legend where [`Panel::margins`] has found the place: the search is repeated with
    /// the same numbers, so that rounding cannot move the legend to where no room was kept.
    fn draw_legend(&self, canvas: &mut Canvas, frame: Rect) {
        let origin = Rect { x: 0.0, y: 0.0, ..frame };
        let legend = self.legend(frame.width);
        if let Some(place) = legend.place(origin, &self.obstacles(&self.layout(origin))) {
            legend.draw(canvas, Rect { x: frame.x + place.x, y: frame.y + place.y, ..place });
        }
    }

    fn legend(&self, width: f64) -> Legend<'_> {
        let references = self.references.iter().map(|line| Entry::Reference(&line.name, REFERENCE));
        let series = self.series.iter().map(Entry::Series);
        Legend::new(series.chain(references).chain([Entry::Note(&self.note)]), width)
    }

    /// The series on the page.
    fn obstacles(&self, layout: &Layout) -> Vec<Obstacle> {
        let place = |series: &Series| Obstacle {
            points: layout.to_page(&series.points),
            markers: series.has_markers(),
        };
        self.series.iter().map(place).collect()
    }

    fn layout(&self, frame: Rect) -> Layout {
        let data = || self.series.iter().flat_map(|series| series.points.iter());
        let at = |vertical: bool| {
            self.references.iter().filter(move |r| r.vertical == vertical).map(|r| r.at)
        };
        // A datum counts only if both its coordinates can be drawn.
        let whole = |p: &&[f64; 2]| p[0].is_finite() && p[1].is_finite();
        let x = self.x.fitted(data().filter(whole).map(|p| p[0]).chain(at(true)));
        let y = self.y.fitted(data().filter(whole).map(|p| p[1]).chain(at(false)));
        let x_ticks = x.ticks(frame.width, |label| label.width(sizes::TICK));
        let y_ticks = y.ticks(frame.height, |_| sizes::TICK);
        Layout { frame, x, y, x_ticks, y_ticks }
    }

    fn draw_ground(&self, canvas: &mut Canvas, frame: Rect, density: f64) {
        let image = |canvas: &mut Canvas, frame: Rect, picture: &Picture| {
            let png = picture
                .to_png(PngNotes::default())
                .expect("writing a checked image to memory cannot fail");
            canvas.image(frame, &png);
        };
        if let Some(picture) = &self.picture {
            image(canvas, frame, picture);
        }
        let Some(dots) = &self.dots else { return };
        if !dots.are_many() {
            return draw_discs(canvas, dots, frame);
        }
        let pixels = (density * frame.width).round().clamp(1.0, 4096.0);
        image(canvas, frame, &dots.to_picture(pixels as u32));
        let inset = Rect {
            x: frame.x + 0.56 * frame.width,
            y: frame.y + 0.04 * frame.height,
            width: 0.4 * frame.width,
            height: 0.4 * frame.height,
        };
        canvas.rect(inset, "#fff", Stroke::solid("#fff", 4.0));
        draw_discs(canvas, &dots.window(inset_side(dots)), inset);
        canvas.rect(inset, "none", FRAME);
    }
}

/// Side of the part of a large set that the inset of its panel shows: about 256 points.
pub(super) fn inset_side(dots: &Dots) -> f64 {
    16.0 / (dots.len().max(256) as f64).sqrt() * dots.side()
}

fn draw_discs(canvas: &mut Canvas, dots: &Dots, frame: Rect) {
    let side = frame.width.min(frame.height);
    let radius = dots.radius(side);
    let centres = dots
        .visible(radius / side)
        .map(|p| (frame.x + p.x * frame.width, frame.bottom() - p.y * frame.height));
    canvas.discs(centres, radius, INK, frame);
}

/// A frame with its settled axes.
struct Layout {
    frame: Rect,
    x: FittedAxis,
    y: FittedAxis,
    x_ticks: Ticks,
    y_ticks: Ticks,
}

impl Layout {
    /// The space that marks and labels take; nothing above.
    fn margins(&self) -> Margins {
        let widest = |ticks: &Ticks| {
            ticks.labels.iter().map(|label| label.width(sizes::TICK)).fold(0.0, f64::max)
        };
        let name_room = |name: &Text| if name.is_empty() { 0.0 } else { NAME_ROOM };
        // The outermost x labels may stand out over the frame by half their width.
        let overhang = |end: f64| {
            let labels = self.x_ticks.major.iter().zip(&self.x_ticks.labels);
            labels
                .map(|(&v, label)| {
                    let from_end = self.frame.width * (self.x.position(v) - end).abs();
                    0.5 * label.width(sizes::TICK) - from_end
                })
                .fold(0.0, f64::max)
        };
        let y_labels = LABEL_GAP + widest(&self.y_ticks) + name_room(&self.y.label(&self.y_ticks));
        let x_labels = if self.x_ticks.labels.is_empty() { 0.0 } else { 0.85 * sizes::TICK };
        Margins {
            left: y_labels.max(overhang(0.0)),
            right: overhang(1.0).max(1.0),
            top: 0.0,
            bottom: LABEL_GAP
                + x_labels
                + name_room(&self.x.label(&self.x_ticks))
                + 0.25 * sizes::LABEL,
        }
    }

    fn page_x(&self, x: f64) -> f64 {
        self.frame.x + self.frame.width * near(self.x.position(x))
    }

    fn page_y(&self, y: f64) -> f64 {
        self.frame.bottom() - self.frame.height * near(self.y.position(y))
    }

    fn to_page(&self, points: &[[f64; 2]]) -> Vec<(f64, f64)> {
        points
            .iter()
            .map(|&[x, y]| {
                let drawable = x.is_finite() && y.is_finite();
                if drawable { (self.page_x(x), self.page_y(y)) } else { (f64::NAN, f64::NAN) }
            })
            .collect()
    }

    fn draw_grid(&self, canvas: &mut Canvas) {
        for &v in &self.y_ticks.major {
            let y = self.page_y(v);
            canvas.line((self.frame.x, y), (self.frame.right(), y), GRID);
        }
    }

    fn draw_reference(&self, canvas: &mut Canvas, reference: &Reference) {
        let frame = self.frame;
        let axis = if reference.vertical { &self.x } else { &self.y };
        if !axis.range().contains(reference.at) {
            return;
        }
        if reference.vertical {
            let x = self.page_x(reference.at);
            canvas.line((x, frame.bottom()), (x, frame.y), REFERENCE);
        } else {
            let y = self.page_y(reference.at);
            canvas.line((frame.x, y), (frame.right(), y), REFERENCE);
        }
    }

    fn draw_axes(&self, canvas: &mut Canvas) {
        let Rect { x: left, width, height, .. } = self.frame;
        let bottom = self.frame.bottom();
        let marks = |ticks: &Ticks| -> Vec<(f64, f64)> {
            let major = ticks.major.iter().map(|&v| (v, TICK));
            major.chain(ticks.minor.iter().map(|&v| (v, MINOR_TICK))).collect()
        };
        for (v, length) in marks(&self.x_ticks) {
            let x = self.page_x(v);
            canvas.line((x, bottom), (x, bottom + length), FRAME);
        }
        for (v, length) in marks(&self.y_ticks) {
            let y = self.page_y(v);
            canvas.line((left - length, y), (left, y), FRAME);
        }
        let baseline = bottom + LABEL_GAP + 0.8 * sizes::TICK;
        for (&v, label) in self.x_ticks.major.iter().zip(&self.x_ticks.labels) {
            let style = TextStyle::new(sizes::TICK, Anchor::Middle);
            canvas.text((self.page_x(v), baseline), label, style);
        }
        let mut widest = 0.0_f64;
        for (&v, label) in self.y_ticks.major.iter().zip(&self.y_ticks.labels) {
            let at = (left - LABEL_GAP, self.page_y(v) + 0.32 * sizes::TICK);
            canvas.text(at, label, TextStyle::new(sizes::TICK, Anchor::End));
            widest = widest.max(label.width(sizes::TICK));
        }
        let name = |axis: &FittedAxis, ticks: &Ticks, room: f64| {
            axis.label(ticks).shortened(sizes::LABEL, room)
        };
        canvas.text(
            (left + 0.5 * width, baseline + 0.9 * NAME_ROOM),
            &name(&self.x, &self.x_ticks, 1.15 * width),
            TextStyle::new(sizes::LABEL, Anchor::Middle),
        );
        canvas.text(
            (left - LABEL_GAP - widest - 0.42 * NAME_ROOM, bottom - 0.5 * height),
            &name(&self.y, &self.y_ticks, 1.15 * height),
            TextStyle { upright: true, ..TextStyle::new(sizes::LABEL, Anchor::Middle) },
        );
    }
}

/// Positions kept to where differences of page coordinates stay accurate.
fn near(position: f64) -> f64 {
    position.clamp(-1e4, 1e4)
}
