//! The SVG writer: a few shapes, appended as text.

use std::fmt::Write as _;

use super::encode::data_uri;
use super::text::{Text, escape};

/// A rectangle in page coordinates, y downwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rect {
    pub x: f64,
    pub y: f64,
    pub width: f64,
    pub height: f64,
}

impl Rect {
    pub fn right(self) -> f64 {
        self.x + self.width
    }

    pub fn bottom(self) -> f64 {
        self.y + self.height
    }
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stroke {
    pub colour: &'static str,
    pub width: f64,
    /// An SVG dash array in points; empty for a solid line.
    pub dashes: &'static str,
}

impl Stroke {
    pub const fn solid(colour: &'static str, width: f64) -> Self {
        Self { colour, width, dashes: "" }
    }
}

/// Which point of a label its position is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// A label's size and place relative to its position.
#[derive(Clone, Copy, Debug)]
pub(super) struct TextStyle {
    pub size: f64,
    pub anchor: Anchor,
    pub colour: &'static str,
    /// Reads upwards instead of to the right.
    pub upright: bool,
}

impl TextStyle {
    pub const fn new(size: f64, anchor: Anchor) -> Self {
        Self { size, anchor, colour: "#000", upright: false }
    }
}

/// What has been drawn so far. Text is kept apart: it lies above everything else, and is what the
/// outliner replaces.
#[derive(Clone, Debug, Default)]
pub(super) struct Canvas {
    shapes: String,
    text: String,
}

/// The families asked for where text stays text.
const FONT_FAMILY: &str = "Libertinus Serif, Linux Libertine O, STIX Two Text, Times, serif";

/// Writing to a string cannot fail, so results of `write!` are dropped in this file.
impl Canvas {
    pub fn line(&mut self, from: (f64, f64), to: (f64, f64), stroke: Stroke) {
        self.path(&format!("M{} {}L{} {}", px(from.0), px(from.1), px(to.0), px(to.1)), stroke);
    }

    /// An open path.
    pub fn path(&mut self, data: &str, stroke: Stroke) {
        let Stroke { colour, width, dashes } = stroke;
        let dashes = if dashes.is_empty() {
            String::new()
        } else {
            format!(" stroke-dasharray=\"{dashes}\"")
        };
        let _ = writeln!(
            self.shapes,
            "<path d=\"{data}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{}\" \
             stroke-linejoin=\"round\"{dashes}/>",
            px(width)
        );
    }

    /// A closed path, filled.
    pub fn area(&mut self, data: &str, fill: &str, stroke: Stroke) {
        let _ = writeln!(
            self.shapes,
            "<path d=\"{data}\" fill=\"{fill}\" stroke=\"{}\" stroke-width=\"{}\"/>",
            stroke.colour,
            px(stroke.width)
        );
    }

    pub fn rect(&mut self, rect: Rect, fill: &str, stroke: Stroke) {
        let _ = writeln!(
            self.shapes,
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{fill}\" stroke=\"{}\" \
             stroke-width=\"{}\"/>",
            px(rect.x),
            px(rect.y),
            px(rect.width),
            px(rect.height),
            stroke.colour,
            px(stroke.width)
        );
    }

    /// Equal discs, cut at `clip`. The clip is a nested viewport, not a clip path, so that pages
    /// can be put into one document without their identifiers meeting.
    pub fn discs(
        &mut self,
        centres: impl Iterator<Item = (f64, f64)>,
        radius: f64,
        fill: &str,
        clip: Rect,
    ) {
        let (x, y, width, height) = (px(clip.x), px(clip.y), px(clip.width), px(clip.height));
        let _ = writeln!(
            self.shapes,
            "<svg x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"{x} {y} {width} {height}\"><g fill=\"{fill}\">"
        );
        let radius = number(radius, 3);
        for (x, y) in centres {
            let _ =
                write!(self.shapes, "<circle cx=\"{}\" cy=\"{}\" r=\"{radius}\"/>", px(x), px(y));
        }
        self.shapes.push_str("</g></svg>\n");
    }

    /// A PNG file stretched over `rect`, pixels kept as blocks.
    pub fn image(&mut self, rect: Rect, png: &[u8]) {
        let _ = writeln!(
            self.shapes,
            "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" \
             image-rendering=\"optimizeSpeed\" style=\"image-rendering:pixelated\" \
             href=\"{}\"/>",
            number(rect.x, 4),
            number(rect.y, 4),
            number(rect.width, 4),
            number(rect.height, 4),
            data_uri("image/png", png)
        );
    }

    /// A line of text with its baseline at `at`.
    pub fn text(&mut self, at: (f64, f64), text: &Text, style: TextStyle) {
        if text.is_empty() {
            return;
        }
        let anchor = match style.anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let place = if style.upright {
            format!("transform=\"translate({} {}) rotate(-90)\"", px(at.0), px(at.1))
        } else {
            format!("x=\"{}\" y=\"{}\"", px(at.0), px(at.1))
        };
        let _ = writeln!(
            self.text,
            "<text {place} font-size=\"{}\" fill=\"{}\"{anchor}>{}</text>",
            px(style.size),
            style.colour,
            text.to_tspans(style.size)
        );
    }

    /// The document, with `text_layer` in the place of the text if one is given.
    pub fn document(&self, head: &Head, text_layer: Option<&str>) -> String {
        let (width, height) = (px(head.width), px(head.height));
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}pt\" height=\"{height}pt\" \
             viewBox=\"0 0 {width} {height}\">\n"
        );
        if !head.title.is_empty() {
            let _ = writeln!(svg, "<title>{}</title>", escape(&head.title));
        }
        if !head.provenance.is_empty() {
            let _ = writeln!(svg, "<metadata>{}</metadata>", escape(&head.provenance));
        }
        let _ = writeln!(svg, "<rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>");
        svg.push_str(&self.shapes);
        svg.push_str(text_layer.unwrap_or(&self.text_layer()));
        svg.push_str("</svg>\n");
        svg
    }

    /// The text alone, as a group.
    pub fn text_layer(&self) -> String {
        format!("<g font-family=\"{FONT_FAMILY}\">\n{}</g>\n", self.text)
    }
}

/// What a document says about itself.
#[derive(Clone, Debug, Default)]
pub(super) struct Head {
    pub width: f64,
    pub height: f64,
    pub title: String,
    pub provenance: String,
}

/// A coordinate with two decimals.
pub(super) fn px(value: f64) -> String {
    number(value, 2)
}

/// A number with at least one decimal asked for, less trailing zeros; 0 for what is not finite,
/// which no caller should pass.
fn number(value: f64, decimals: usize) -> String {
    debug_assert!(value.is_finite(), "coordinate {value}");
    let value = if value.is_finite() { value } else { 0.0 };
    let digits = format!("{value:.decimals$}");
    let digits = digits.trim_end_matches('0').trim_end_matches('.');
    if digits == "-0" { "0".into() } else { digits.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (0.0, "0"),
            (-0.001, "0"),
            (1.5, "1.5"),
            (100.0, "100"),
            (-2.346, "-2.35"),
            (10.0, "10"),
        ] {
            assert_eq!(px(value), text);
        }
    }

    #[test]
    fn the_document_carries_its_origin_escaped() {
        let head = Head {
            width: 10.0,
            height: 5.0,
            title: "a<b".into(),
            provenance: "bn generate \"x\" & y".into(),
        };
        let svg = Canvas::default().document(&head, None);
        assert!(svg.contains("<title>a&lt;b</title>"), "{svg}");
        assert!(svg.contains("<metadata>bn generate &quot;x&quot; &amp; y</metadata>"), "{svg}");
    }
}
