//! Blocks stacked into a page.

use super::canvas::{Anchor, Canvas, Head, Rect, TextStyle};
use super::panel::Margins;
use super::{Panel, Table, Text, sizes};

/// Panels side by side, with frames of one height.
#[derive(Clone, Debug)]
pub struct Row {
    height: f64,
    panels: Vec<Panel>,
}

impl Row {
    /// `panels` from the left, their frames `height` points high.
    ///
    /// # Panics
    /// Unless `height` is between 20 and 2000 points.
    pub fn new(height: f64, panels: Vec<Panel>) -> Self {
        assert!((20.0..=2000.0).contains(&height), "a frame {height} points high");
        Self { height, panels }
    }
}

#[derive(Clone, Debug)]
enum Block {
    Row(Row),
    Table(Table),
    Paragraph(Text),
}

/// A page as wide and high as its blocks need.
#[derive(Clone, Debug)]
pub struct Page {
    title: Text,
    provenance: String,
    density: f64,
    blocks: Vec<Block>,
}

/// White around everything.
const BORDER: f64 = 10.0;
/// Between panels, and between blocks.
const COLUMN_GAP: f64 = 9.0;
const BLOCK_GAP: f64 = 10.0;
/// Width of a page that holds nothing wider.
const LEAST_WIDTH: f64 = 240.0;
/// Pixels a point that a page can have.
pub(super) const LEAST_DENSITY: f64 = 0.1;
pub(super) const MOST_DENSITY: f64 = 100.0;
const LEADING: f64 = 1.3 * sizes::BODY;

impl Default for Page {
    fn default() -> Self {
        Self::new()
    }
}

impl Page {
    /// An empty page at 4 pixels a point (288 dpi).
    pub fn new() -> Self {
        let title = Text::default();
        Self { title, provenance: String::new(), density: 4.0, blocks: vec![] }
    }

    /// The page with a heading, broken into lines of the page's width.
    #[must_use]
    pub fn titled(mut self, title: Text) -> Self {
        self.title = title;
        self
    }

    /// The page with a statement of how it was made, kept in the file and not drawn: the SVG's
    /// metadata, a text chunk of the PNG.
    #[must_use]
    pub fn made_by(mut self, provenance: &str) -> Self {
        self.provenance = provenance.to_string();
        self
    }

    /// The page with another resolution of rasterised points and of the PNG file. Frames are moved
    /// to whole pixels, so that an image whose pixels fit its frame is shown pixel by pixel.
    ///
    /// # Panics
    /// Unless `density` is between 0.1 and 100 pixels a point.
    #[must_use]
    pub fn with_density(mut self, density: f64) -> Self {
        let possible = LEAST_DENSITY..=MOST_DENSITY;
        assert!(possible.contains(&density), "{density} pixels a point");
        self.density = density;
        self
    }

    /// The page with a row of panels below what it has.
    #[must_use]
    pub fn row(mut self, row: Row) -> Self {
        self.blocks.push(Block::Row(row));
        self
    }

    /// The page with a table below what it has.
    #[must_use]
    pub fn table(mut self, table: Table) -> Self {
        self.blocks.push(Block::Table(table));
        self
    }

    /// The page with a paragraph below what it has, broken into lines of the page's width.
    #[must_use]
    pub fn paragraph(mut self, text: Text) -> Self {
        self.blocks.push(Block::Paragraph(text));
        self
    }

    /// The page as SVG whose text is text, for readers that have the font or will do with another.
    pub fn to_svg(&self) -> String {
        let (canvas, head) = self.draw();
        canvas.document(&head, None)
    }

    /// Pixels a point, of rasterised points and of the PNG file.
    pub fn density(&self) -> f64 {
        self.density
    }

    /// Width of the page in points, before it is rounded up to a whole pixel.
    pub(super) fn width(&self) -> f64 {
        let widths = self.blocks.iter().map(|block| match block {
            Block::Row(row) => {
                self.columns(row).iter().map(Column::width).sum::<f64>()
                    + COLUMN_GAP * row.panels.len().saturating_sub(1) as f64
            }
            Block::Table(table) => table.width(),
            Block::Paragraph(_) => 0.0,
        });
        widths.fold(LEAST_WIDTH, f64::max) + 2.0 * BORDER
    }

    /// Lays the page out and draws it.
    pub(super) fn draw(&self) -> (Canvas, Head) {
        let width = self.width() - 2.0 * BORDER;
        let mut canvas = Canvas::default();
        let mut y = BORDER;
        if !self.title.is_empty() {
            for line in self.title.wrapped(sizes::HEADING, width) {
                let at = (BORDER + 0.5 * width, y + 0.8 * sizes::HEADING);
                canvas.text(at, &line, TextStyle::new(sizes::HEADING, Anchor::Middle));
                y += 1.2 * sizes::HEADING;
            }
            y += 0.6 * BLOCK_GAP - 0.2 * sizes::HEADING;
        }
        for (i, block) in self.blocks.iter().enumerate() {
            y += if i == 0 { 0.0 } else { BLOCK_GAP };
            let place = Rect { x: BORDER, y, width, height: 0.0 };
            y += match block {
                Block::Row(row) => self.draw_row(&mut canvas, row, place),
                Block::Table(table) => {
                    table.draw(&mut canvas, place);
                    table.height()
                }
                Block::Paragraph(text) => draw_paragraph(&mut canvas, text, place),
            };
        }
        let head = Head {
            // Whole pixels, so that the last row and column of a PNG are not half transparent.
            width: self.whole_pixels(self.width(), covering),
            height: self.whole_pixels(y + BORDER, covering),
            title: self.title.characters(),
            provenance: self.provenance.clone(),
        };
        (canvas, head)
    }

    fn whole_pixels(&self, length: f64, rounding: fn(f64) -> f64) -> f64 {
        rounding(length * self.density) / self.density
    }

    /// Draws a row from the top of `place` and returns its height.
    fn draw_row(&self, canvas: &mut Canvas, row: &Row, place: Rect) -> f64 {
        let margins: Vec<Margins> = row.panels.iter().map(|p| p.margins(row.height)).collect();
        let highest = |part: fn(&Margins) -> f64| margins.iter().map(part).fold(0.0, f64::max);
        let (top, bottom) = (highest(|m| m.top), highest(|m| m.bottom));
        let columns = self.columns(row);
        let taken: f64 = columns.iter().map(Column::width).sum();
        let spare = place.width - taken;
        let gaps = columns.len().saturating_sub(1) as f64;
        // Rows narrower than the page are spread a little and centred.
        let gap = (spare / gaps.max(1.0)).min(2.0 * COLUMN_GAP);
        let mut x = place.x + 0.5 * (spare - gap * gaps);
        for (panel, column) in row.panels.iter().zip(&columns) {
            let frame = Rect {
                x: self.whole_pixels(x + column.left, f64::round),
                y: self.whole_pixels(place.y + top, f64::round),
                width: panel.aspect() * row.height,
                height: row.height,
            };
            panel.draw(canvas, frame, self.density);
            x += column.width() + gap;
        }
        top + row.height + bottom
    }

    /// The columns of a row: wide enough for every row with as many panels, so that frames of
    /// equal width stand below each other.
    fn columns(&self, row: &Row) -> Vec<Column> {
        let mut columns = vec![Column::default(); row.panels.len()];
        let rows = self.blocks.iter().filter_map(|block| match block {
            Block::Row(other) if other.panels.len() == row.panels.len() => Some(other),
            _ => None,
        });
        for row in rows {
            for (column, panel) in columns.iter_mut().zip(&row.panels) {
                let margins = panel.margins(row.height);
                column.left = column.left.max(margins.left);
                column.frame = column.frame.max(panel.aspect() * row.height);
                column.right = column.right.max(margins.right);
            }
        }
        columns
    }
}

/// The horizontal extent of the panels below each other.
#[derive(Clone, Debug, Default)]
struct Column {
    left: f64,
    frame: f64,
    right: f64,
}

impl Column {
    fn width(&self) -> f64 {
        self.left + self.frame + self.right
    }
}

/// The least whole number of pixels, a rounding error less.
fn covering(pixels: f64) -> f64 {
    (pixels - 1e-6).ceil()
}

fn draw_paragraph(canvas: &mut Canvas, text: &Text, place: Rect) -> f64 {
    let lines = text.wrapped(sizes::BODY, place.width);
    for (i, line) in lines.iter().enumerate() {
        let baseline = place.y + (i as f64 + 0.75) * LEADING;
        canvas.text((place.x, baseline), line, TextStyle::new(sizes::BODY, Anchor::Start));
    }
    lines.len() as f64 * LEADING
}
