//! The page that describes a pattern: points, autocorrelation, power spectrum, anisotropy, RDF,
//! radial power and the statistics (appendix B of the thesis).
//!
//! [`ReportData`] holds what was measured, already in the units of the page; [`page`] lays it out.
//! With the feature `report`, `to_svg`, `to_png` and `to_html` make the files. The same data give
//! the same bytes.

mod curves;
#[cfg(feature = "report")]
mod files;
mod page;
mod statistics;

pub use curves::MOST_DISTANCE;
pub use page::{MOST_CELLS, WHITE, page};
pub use statistics::Statistic;

#[cfg(feature = "report")]
pub use files::{to_html, to_png, to_svg};

use bn_core::{Curve, DVec2};

use crate::plot::Grid;

/// What the page shows. Lengths are in units of `d_hex`, frequencies in units of √n/2.
#[derive(Clone, Debug)]
pub struct ReportData {
    /// The heading, such as the name of the method or of the file.
    pub title: String,
    /// n, the number of points of each set.
    pub points_per_set: usize,
    /// m, the number of sets that were averaged.
    pub sets: usize,
    /// The points of one set, in [0, 1)².
    pub points: Vec<DVec2>,
    /// g over the two components of the distance; cells without a value (such as r = 0) are NaN.
    /// Cells that hold less than about ten pairs show noise instead of structure.
    pub autocorrelation: Grid,
    /// P over the two components of the frequency. The DC mode, or the cell that holds only it,
    /// is NaN. One mode a cell, or means over blocks of modes.
    pub spectrum: Grid,
    /// Anisotropy in dB over the frequency.
    pub anisotropy: Curve,
    /// g over the distance; up to 8 `d_hex` are shown.
    pub rdf: Curve,
    /// Ring means of P over the frequency; up to 10·√n/2 are shown.
    pub radial_power: Curve,
    /// The table, from left to right.
    pub statistics: Vec<Statistic>,
    /// How the data came about (command, seed, version): kept in the files, not drawn.
    pub provenance: String,
}
