//! Pages with the built-in font: text as paths, and pixels.

use std::sync::Arc;

use png::ColorType;
use resvg::tiny_skia::{Pixmap, PremultipliedColorU8, Transform};
use resvg::usvg::{self, fontdb};

use super::Page;
use super::canvas::Head;
use super::encode::{PngNotes, png};
use super::page::{LEAST_DENSITY, MOST_DENSITY};

/// Why a page could not be rendered. A page that can be laid out renders; what can fail is its
/// size.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The picture would be larger than any page is meant to be.
    #[error("a picture of {width} × {height} pixels is too large (at most 500 million pixels)")]
    TooLarge {
        /// Pixels across.
        width: u64,
        /// Pixels down.
        height: u64,
    },
    /// A page can't be so narrow or so wide.
    #[error("a page {width} pixels wide: between {least} and {most} are possible")]
    Width {
        /// The width asked for.
        width: u32,
        /// The smallest possible.
        least: u32,
        /// The largest possible.
        most: u32,
    },
    /// The renderer does not take the page.
    #[error("the page cannot be rendered: {0}")]
    Svg(#[from] usvg::Error),
    /// The PNG file could not be made.
    #[error("the PNG file cannot be written: {0}")]
    Png(#[from] png::EncodingError),
}

const MOST_PIXELS: u64 = 500_000_000;

const REGULAR: &[u8] = include_bytes!("../../fonts/LibertinusSerif-Regular.otf");
const ITALIC: &[u8] = include_bytes!("../../fonts/LibertinusSerif-Italic.otf");

/// Points to an inch.
const POINTS: f64 = 72.0;

impl Page {
    /// The page as SVG that looks the same everywhere: every label is a path.
    ///
    /// # Errors
    /// [`RenderError::Svg`] if the text cannot be converted, which no label is known to cause.
    pub fn to_outlined_svg(&self) -> Result<String, RenderError> {
        let (canvas, head) = self.draw();
        let text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\">{}</svg>",
            head.width,
            head.height,
            canvas.text_layer()
        );
        let options = usvg::WriteOptions {
            coordinates_precision: 2,
            transforms_precision: 5,
            indent: usvg::Indent::None,
            ..usvg::WriteOptions::default()
        };
        let outlined = usvg::Tree::from_str(&text, &font_options())?.to_string(&options);
        Ok(canvas.document(&head, Some(content(&outlined))))
    }

    /// The page as an opaque 8-bit PNG file at its density, with title and provenance in text
    /// chunks (`Title`, `Source`).
    ///
    /// # Errors
    /// [`RenderError::TooLarge`] beyond 5·10⁸ pixels.
    pub fn to_png(&self) -> Result<Vec<u8>, RenderError> {
        let (canvas, head) = self.draw();
        let (width, height) = self.pixels(&head)?;
        let tree = usvg::Tree::from_str(&canvas.document(&head, None), &font_options())?;
        let too_large = RenderError::TooLarge { width: width.into(), height: height.into() };
        let mut pixmap = Pixmap::new(width, height).ok_or(too_large)?;
        pixmap.fill(resvg::tiny_skia::Color::WHITE);
        let scale = |pixels: u32, length: f32| pixels as f32 / length;
        let transform = Transform::from_scale(
            scale(width, tree.size().width()),
            scale(height, tree.size().height()),
        );
        resvg::render(&tree, transform, &mut pixmap.as_mut());
        let opaque = |p: &PremultipliedColorU8| [p.red(), p.green(), p.blue()];
        let samples: Vec<u8> = pixmap.pixels().iter().flat_map(opaque).collect();
        let notes = PngNotes {
            texts: &[("Title", &head.title), ("Source", &head.provenance)],
            pixels_per_metre: Some((self.density() * POINTS / 0.0254).round() as u32),
        };
        Ok(png((width, height), ColorType::Rgb, &samples, notes)?)
    }

    /// The density at which the PNG file is `width` pixels wide.
    ///
    /// # Errors
    /// [`RenderError::Width`] for a width outside what a page can have.
    pub fn density_for_width(&self, width: u32) -> Result<f64, RenderError> {
        let density = f64::from(width) / self.width();
        if (LEAST_DENSITY..=MOST_DENSITY).contains(&density) {
            return Ok(density);
        }
        Err(RenderError::Width {
            width,
            least: (self.width() * LEAST_DENSITY).ceil() as u32,
            most: (self.width() * MOST_DENSITY) as u32,
        })
    }

    /// The size of the PNG file.
    fn pixels(&self, head: &Head) -> Result<(u32, u32), RenderError> {
        let count = |length: f64| (length * self.density()).round().max(1.0) as u64;
        let (width, height) = (count(head.width), count(head.height));
        if width.saturating_mul(height) > MOST_PIXELS {
            return Err(RenderError::TooLarge { width, height });
        }
        Ok((width as u32, height as u32))
    }
}

/// The built-in font and no other.
fn font_options() -> usvg::Options<'static> {
    let mut fonts = fontdb::Database::new();
    for face in [REGULAR, ITALIC] {
        fonts.load_font_source(fontdb::Source::Binary(Arc::new(face)));
    }
    usvg::Options {
        fontdb: Arc::new(fonts),
        font_family: "Libertinus Serif".into(),
        ..usvg::Options::default()
    }
}

/// What stands between the outermost tags of a document.
fn content(svg: &str) -> &str {
    let start = svg.find('>').map_or(0, |i| i + 1);
    let end = svg.rfind("</svg>").unwrap_or(svg.len());
    svg.get(start..end).unwrap_or_default()
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::plot::{Text, sizes};

    /// Width of `text` as the shaper of the renderer sets it.
    fn shaped(text: &Text) -> f64 {
        let size = sizes::BODY;
        let svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"9\"><text \
             font-size=\"{size}\">{}</text></svg>",
            text.to_tspans(size)
        );
        let tree = usvg::Tree::from_str(&svg, &font_options()).unwrap();
        let usvg::Node::Text(ref node) = tree.root().children()[0] else { panic!("no text") };
        f64::from(node.bounding_box().width())
    }

    #[test]
    fn estimated_widths_hold_the_shaped_ones() {
        let ascii: String = (' '..='~').filter(|&c| c != '*').collect();
        for markup in [
            ascii.as_str(),
            &format!("*{ascii}*"),
            "*ν*_{eff}/(√*n*/2) (×10^{−12})",
            "α β γ δ ε ζ η θ λ μ π ρ σ τ φ χ ψ ω Γ Δ Θ Λ Σ Φ Ω",
            "± × · − – — … ≤ ≥ ≈ ∞ é ß Å Ж",
            "run time in seconds",
            "1.000001",
        ] {
            let text = Text::math(markup);
            let (estimate, width) = (text.width(sizes::BODY), shaped(&text));
            // Kerning and ligatures may take a little off; the guesses for signs are generous.
            assert!(estimate >= 0.999 * width, "{markup}: {estimate} for {width}");
            assert!(estimate <= 1.3 * width, "{markup}: {estimate} for {width}");
        }
    }

    #[test]
    fn the_font_has_the_signs_of_labels() {
        let signs = Text::plain("νΩσπ√−×·±≤≥∞…–\u{2009}ÅΔ²");
        let svg = Page::new().paragraph(signs).to_outlined_svg().unwrap();
        // A sign without a glyph would be left out or drawn as a box of four corners.
        assert!(svg.matches("<path").count() == 1 && svg.len() > 5000, "{}", svg.len());
    }
}
