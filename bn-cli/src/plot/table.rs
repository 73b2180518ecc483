//! A small table in the manner of print: three rules, no boxes.

use super::canvas::{Anchor, Canvas, Rect, Stroke, TextStyle};
use super::{Text, sizes};

/// Columns under a head; the first column names the rows, the others are centred.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    head: Vec<Text>,
    rows: Vec<Vec<Text>>,
}

const LINE: f64 = 1.45 * sizes::BODY;
/// The least distance between columns.
const GAP: f64 = 10.0;
const HEAVY: Stroke = Stroke::solid("#000", 0.8);
const LIGHT: Stroke = Stroke::solid("#000", 0.4);
/// From a rule to the line of text under it, and from a line of text to the rule under it.
const RULE_SPACE: f64 = 2.5;

impl Table {
    /// A table without rows.
    ///
    /// # Panics
    /// If the head has no column.
    pub fn new(head: Vec<Text>) -> Self {
        assert!(!head.is_empty(), "a table needs a column");
        Self { head, rows: vec![] }
    }

    /// The table with one more row.
    ///
    /// # Panics
    /// If the row has not as many cells as the head.
    #[must_use]
    pub fn row(mut self, cells: Vec<Text>) -> Self {
        assert_eq!(cells.len(), self.head.len(), "cells in a row of the table");
        self.rows.push(cells);
        self
    }

    pub(super) fn height(&self) -> f64 {
        (1 + self.rows.len()) as f64 * LINE + 4.0 * RULE_SPACE
    }

    /// The width below which columns would touch.
    pub(super) fn width(&self) -> f64 {
        self.column_widths().iter().map(|w| w + GAP).sum::<f64>() - GAP
    }

    fn column_widths(&self) -> Vec<f64> {
        (0..self.head.len())
            .map(|column| {
                self.lines().map(|line| line[column].width(sizes::BODY)).fold(0.0, f64::max)
            })
            .collect()
    }

    fn lines(&self) -> impl Iterator<Item = &Vec<Text>> {
        std::iter::once(&self.head).chain(&self.rows)
    }

    /// Draws the table over the width and from the top of `place`.
    pub(super) fn draw(&self, canvas: &mut Canvas, place: Rect) {
        let widths = self.column_widths();
        let spare = (place.width - self.width()).max(0.0) / widths.len() as f64;
        let rule = |canvas: &mut Canvas, y: f64, stroke: Stroke| {
            canvas.line((place.x, y), (place.right(), y), stroke);
        };
        rule(canvas, place.y, HEAVY);
        let mut y = place.y + RULE_SPACE;
        for (i, line) in self.lines().enumerate() {
            let baseline = y + 0.72 * LINE;
            let mut x = place.x;
            for (column, (cell, width)) in line.iter().zip(&widths).enumerate() {
                let room = width + spare;
                let (at, anchor) =
                    if column == 0 { (x, Anchor::Start) } else { (x + 0.5 * room, Anchor::Middle) };
                canvas.text((at, baseline), cell, TextStyle::new(sizes::BODY, anchor));
                x += room + GAP;
            }
            y += LINE;
            if i == 0 {
                rule(canvas, y + RULE_SPACE, LIGHT);
                y += 2.0 * RULE_SPACE;
            }
        }
        rule(canvas, y + RULE_SPACE, HEAVY);
    }
}
