//! The font sizes of a page, in points.

/// Numbers along an axis.
pub(super) const TICK: f64 = 7.5;
/// What an axis measures.
pub(super) const LABEL: f64 = 8.5;
/// Legends and notes inside a frame.
pub(super) const LEGEND: f64 = 7.5;
/// Above a panel.
pub(super) const TITLE: f64 = 9.0;
/// Above a page.
pub(super) const HEADING: f64 = 12.5;
/// Tables and paragraphs.
pub(super) const BODY: f64 = 8.5;
