//! Figures: rows of panels with axes, lines, images and points, written as SVG.
//!
//! A [`Page`] is a stack of blocks (rows of [`Panel`]s, [`Table`]s, paragraphs); a panel has two
//! [`Axis`]es and layers ([`Series`], [`Reference`] lines, a [`Picture`], [`Dots`]). Data come as
//! plain numbers: values that are not finite leave gaps, a range that is empty or degenerate is
//! widened, so that no data can break a page. Lengths are in points (1/72 inch).
//!
//! ```
//! use bn_cli::plot::{Axis, Page, Panel, Row, Series, Text};
//!
//! let decay: Vec<[f64; 2]> = (1..=5).map(|i| [10f64.powi(i), 10f64.powi(-i)]).collect();
//! let panel = Panel::new(Axis::log(Text::plain("operations")), Axis::log(Text::plain("error")))
//!     .line(Series::new(decay).named(Text::math("ours, *n* = 4096")).with_markers());
//! let svg = Page::new().row(Row::new(120.0, vec![panel])).to_svg();
//! assert!(svg.starts_with("<svg"));
//! ```
//!
//! [`Page::to_svg`] leaves text as text; with the feature `report`, `Page::to_outlined_svg` turns
//! it into paths of the built-in font and `Page::to_png` renders the page. The same page gives the
//! same bytes: nothing here looks at the clock, the system's fonts or the order of a hash map.

mod axis;
mod canvas;
mod clip;
mod dots;
mod encode;
mod legend;
mod page;
mod panel;
mod picture;
mod range;
#[cfg(feature = "report")]
mod render;
mod series;
mod sizes;
mod table;
mod text;
mod text_width;
mod ticks;

pub use axis::Axis;
pub use dots::Dots;
pub use encode::data_uri;
pub use page::{Page, Row};
pub use panel::{Panel, Reference};
pub use picture::{Grid, Picture};
pub use range::Range;
#[cfg(feature = "report")]
pub use render::RenderError;
pub use series::{Series, Style};
pub use table::Table;
pub use text::Text;
#[cfg(feature = "report")]
pub(crate) use text::escape;
pub use ticks::Ticks;
