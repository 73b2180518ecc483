//! The legend of a panel: inside the frame, where it hides nothing, or else to its right.

use super::canvas::{Anchor, Canvas, Rect, Stroke, TextStyle};
use super::series::Series;
use super::text::Text;
use super::{clip, sizes};

/// A line that the legend names, or a remark.
#[derive(Clone, Copy)]
pub(super) enum Entry<'a> {
    Series(&'a Series),
    Reference(&'a Text, Stroke),
    Note(&'a Text),
}

impl Entry<'_> {
    fn name(&self) -> &Text {
        match self {
            Self::Series(series) => &series.name,
            Self::Reference(name, _) | Self::Note(name) => name,
        }
    }

    /// Where the name starts, from the left edge inside the box.
    fn indent(&self) -> f64 {
        if matches!(self, Self::Note(_)) { 0.0 } else { SAMPLE + GAP }
    }
}

/// What a legend should keep off: a polyline in page coordinates, with or without markers.
pub(super) struct Obstacle {
    pub points: Vec<(f64, f64)>,
    pub markers: bool,
}

/// Entries with names cut to fit.
pub(super) struct Legend<'a> {
    entries: Vec<(Entry<'a>, Text)>,
}

const SAMPLE: f64 = 15.0;
const GAP: f64 = 4.0;
const PADDING: f64 = 3.0;
const LEADING: f64 = 10.0;
/// Distance of the legend from the frame, inside or outside.
const INSET: f64 = 4.0;
/// Length of hidden line, in points, that is no reason to leave the frame.
const HARMLESS: f64 = 1.0;
/// What a hidden marker counts for, as a length of line.
const MARKER: f64 = 3.0;

impl<'a> Legend<'a> {
    /// The legend of those entries that have a name, for a frame of this width.
    pub fn new(entries: impl IntoIterator<Item = Entry<'a>>, frame_width: f64) -> Self {
        let room = frame_width - 2.0 * INSET - 2.0 * PADDING;
        let entries = entries
            .into_iter()
            .filter(|entry| !entry.name().is_empty())
            .map(|entry| {
                let name = entry.name().clone();
                (entry, name.shortened(sizes::LEGEND, room - entry.indent()))
            })
            .collect();
        Self { entries }
    }

    fn size(&self) -> (f64, f64) {
        let right_end = |(entry, name): &(Entry, Text)| entry.indent() + name.width(sizes::LEGEND);
        let width = self.entries.iter().map(right_end).fold(0.0, f64::max) + 2.0 * PADDING;
        (width, self.entries.len() as f64 * LEADING + 2.0 * PADDING - 1.0)
    }

    /// The place in `frame` or, if series are named and would be hidden by their own legend, to
    /// the right of it; `None` for an empty legend.
    pub fn place(&self, frame: Rect, obstacles: &[Obstacle]) -> Option<Rect> {
        if self.entries.is_empty() {
            return None;
        }
        let (width, height) = self.size();
        let (hidden, inside) = best_inside(frame, width, height, obstacles);
        let names_series = self.entries.iter().any(|(e, _)| matches!(e, Entry::Series(_)));
        let fits = height <= frame.height - 2.0 * INSET;
        if fits && (hidden <= HARMLESS || !names_series) {
            return Some(inside);
        }
        Some(Rect { x: frame.right() + INSET, y: frame.y, width, height })
    }

    pub fn draw(&self, canvas: &mut Canvas, place: Rect) {
        canvas.rect(place, "#fff", Stroke::solid("#c8c8c8", 0.35));
        let x = place.x + PADDING;
        for (i, (entry, name)) in self.entries.iter().enumerate() {
            let middle = place.y + PADDING + (i as f64 + 0.5) * LEADING - 0.5;
            match entry {
                Entry::Series(series) => series.draw_sample(canvas, x, middle, SAMPLE),
                Entry::Reference(_, stroke) => {
                    canvas.line((x, middle), (x + SAMPLE, middle), *stroke);
                }
                Entry::Note(_) => {}
            }
            let style = TextStyle::new(sizes::LEGEND, Anchor::Start);
            canvas.text((x + entry.indent(), middle + 0.32 * sizes::LEGEND), name, style);
        }
    }
}

/// The corner or edge of `frame` where a box hides least, and how much that is; of equal ones the
/// first of top right, bottom right, top left, bottom left, the middles of top, bottom, right, left.
fn best_inside(frame: Rect, width: f64, height: f64, obstacles: &[Obstacle]) -> (f64, Rect) {
    let left = frame.x + INSET;
    let right = frame.right() - INSET - width;
    let top = frame.y + INSET;
    let bottom = frame.bottom() - INSET - height;
    let (centre, middle) = (0.5 * (left + right), 0.5 * (top + bottom));
    let corners = [(right, top), (right, bottom), (left, top), (left, bottom)];
    let edges = [(centre, top), (centre, bottom), (right, middle), (left, middle)];
    corners
        .into_iter()
        .chain(edges)
        .map(|(x, y)| Rect { x, y, width, height })
        .map(|place| (obstacles.iter().map(|o| hidden(place, o)).sum::<f64>(), place))
        .reduce(|best, next| if next.0 < best.0 { next } else { best })
        .expect("there are eight places")
}

/// Length of line inside `place` and a border around it, markers included.
fn hidden(place: Rect, obstacle: &Obstacle) -> f64 {
    const BORDER: f64 = 2.0;
    let area = Rect {
        x: place.x - BORDER,
        y: place.y - BORDER,
        width: place.width + 2.0 * BORDER,
        height: place.height + 2.0 * BORDER,
    };
    let of_segment = |w: &[(f64, f64)]| {
        clip::segment(w[0], w[1], area)
            .map_or(0.0, |(from, to)| (to.0 - from.0).hypot(to.1 - from.1))
    };
    let points = &obstacle.points;
    let finite = |w: &&[(f64, f64)]| w.iter().all(|p| p.0.is_finite() && p.1.is_finite());
    let lines: f64 = points.windows(2).filter(finite).map(of_segment).sum();
    let markers = points.iter().filter(|&&p| obstacle.markers && clip::inside(p, area)).count();
    lines + MARKER * markers as f64
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    const FRAME: Rect = Rect { x: 0.0, y: 0.0, width: 100.0, height: 100.0 };

    fn line(points: &[(f64, f64)]) -> Obstacle {
        Obstacle { points: points.to_vec(), markers: false }
    }

    #[test]
    fn keeps_off_the_lines() {
        let corner = |obstacle: Obstacle| {
            let (hidden, place) = best_inside(FRAME, 30.0, 10.0, &[obstacle]);
            assert_eq!(hidden, 0.0);
            (place.x > 50.0, place.y > 50.0)
        };
        assert_eq!(corner(line(&[])), (true, false));
        assert_eq!(corner(line(&[(0.0, 100.0), (100.0, 0.0)])), (true, true));
        assert_eq!(corner(line(&[(90.0, 0.0), (90.0, 100.0)])), (false, false));
        let gap = [(90.0, 0.0), (90.0, 100.0), (f64::NAN, 0.0), (10.0, 0.0), (10.0, 60.0)];
        assert_eq!(corner(line(&gap)), (false, true));
        let lone = Obstacle { points: vec![(90.0, 8.0)], markers: true };
        assert_eq!(corner(lone), (true, true));
    }

    #[test]
    fn leaves_a_crowded_frame_only_for_series() {
        let zigzag: Vec<_> = (0..100).map(|i| (f64::from(i), f64::from(i % 2) * 100.0)).collect();
        let name = Text::plain("name");
        let series = Series::new([]).named(name.clone());
        let place = |entry| Legend::new([entry], 100.0).place(FRAME, &[line(&zigzag)]).unwrap();
        assert!(place(Entry::Series(&series)).x > FRAME.right());
        assert!(place(Entry::Note(&name)).right() < FRAME.right());
        assert!(Legend::new([Entry::Note(&Text::default())], 100.0).place(FRAME, &[]).is_none());
    }
}
