//! Polylines cut at a rectangle and thinned to what can be seen.

use std::fmt::Write as _;

use super::canvas::{Rect, px};

/// The SVG path of the polyline through `points` (page coordinates) inside `frame`. A point that
/// is not finite breaks the line; one that stands alone becomes a dot-long stroke.
pub(super) fn path(points: &[(f64, f64)], frame: Rect) -> String {
    let mut data = String::new();
    for stretch in points.split(|p| !(p.0.is_finite() && p.1.is_finite())) {
        match stretch {
            [] => {}
            &[(x, y)] if inside((x, y), frame) => {
                // Writing to a string cannot fail, here and below.
                let _ = write!(data, "M{} {}h0.01", px(x - 0.005), px(y));
            }
            _ => push_stretch(&mut data, &thinned(stretch), frame),
        }
    }
    data
}

/// Whether a point lies in the closed rectangle.
pub(super) fn inside((x, y): (f64, f64), frame: Rect) -> bool {
    (frame.x..=frame.right()).contains(&x) && (frame.y..=frame.bottom()).contains(&y)
}

fn push_stretch(data: &mut String, points: &[(f64, f64)], frame: Rect) {
    let mut pen = None;
    for pair in points.windows(2) {
        let Some((from, to)) = segment(pair[0], pair[1], frame) else { continue };
        if pen != Some(from) {
            let _ = write!(data, "M{} {}", px(from.0), px(from.1));
        }
        let _ = write!(data, "L{} {}", px(to.0), px(to.1));
        pen = Some(to);
    }
}

/// The part of a segment inside the rectangle (Liang and Barsky 1984), its ends exact where they
/// were inside.
pub(super) fn segment(
    a: (f64, f64),
    b: (f64, f64),
    frame: Rect,
) -> Option<((f64, f64), (f64, f64))> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for (step, room) in [
        (-dx, a.0 - frame.x),
        (dx, frame.right() - a.0),
        (-dy, a.1 - frame.y),
        (dy, frame.bottom() - a.1),
    ] {
        let t = room / step;
        if step < 0.0 {
            enter = enter.max(t);
        } else if step > 0.0 {
            leave = leave.min(t);
        } else if room < 0.0 {
            return None;
        }
    }
    if enter > leave {
        return None;
    }
    let at = |t: f64| (a.0 + t * dx, a.1 + t * dy);
    let start = if enter == 0.0 { a } else { at(enter) };
    let end = if leave == 1.0 { b } else { at(leave) };
    Some((start, end))
}

/// Width of the columns, in points, within which a line is reduced to its extremes.
const COLUMN: f64 = 0.2;

/// First, lowest, highest and last of the points in each column, in their order: looks the same
/// and is at most four points a column. Lines that go back in x stay as they are.
fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let column = |x: f64| (x / COLUMN).floor();
    if points.windows(2).any(|w| w[1].0 < w[0].0) {
        return points.to_vec();
    }
    points
        .chunk_by(|a, b| column(a.0) == column(b.0))
        .flat_map(|chunk| {
            let by = |better: fn(f64, f64) -> bool| {
                (1..chunk.len())
                    .fold(0, |best, i| if better(chunk[i].1, chunk[best].1) { i } else { best })
            };
            let mut kept = vec![0, by(|a, b| a < b), by(|a, b| a > b), chunk.len() - 1];
            kept.sort_unstable();
            kept.dedup();
            kept.into_iter().map(|i| chunk[i])
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Rect = Rect { x: 10.0, y: 20.0, width: 100.0, height: 50.0 };

    #[test]
    fn cuts_at_the_frame() {
        assert_eq!(path(&[(20.0, 30.0), (40.0, 60.0)], FRAME), "M20 30L40 60");
        assert_eq!(path(&[(0.0, 45.0), (120.0, 45.0)], FRAME), "M10 45L110 45");
        assert_eq!(path(&[(60.0, 0.0), (60.0, 1e9)], FRAME), "M60 20L60 70");
        assert_eq!(path(&[(0.0, 0.0), (5.0, 90.0)], FRAME), "");
        assert_eq!(path(&[(0.0, 25.0), (15.0, 0.0)], FRAME), "");
    }

    #[test]
    fn leaves_and_returns() {
        let roof = [(20.0, 60.0), (30.0, 0.0), (40.0, 60.0)];
        assert_eq!(path(&roof, FRAME), "M20 60L26.67 20M33.33 20L40 60");
    }

    #[test]
    fn breaks_at_what_is_not_finite() {
        let points = [(20.0, 30.0), (25.0, f64::NAN), (30.0, 30.0), (35.0, 30.0)];
        assert_eq!(path(&points, FRAME), "M20 30h0.01M30 30L35 30");
        assert_eq!(path(&[(f64::INFINITY, 30.0)], FRAME), "");
        assert_eq!(path(&[], FRAME), "");
    }

    #[test]
    fn thinning_keeps_the_extremes_of_every_column() {
        let wild = |i: usize| ((i * 7919) % 104_729) as f64 / 104_729.0;
        let points: Vec<_> = (0..100_000).map(|i| (i as f64 * 1e-3, wild(i))).collect();
        let few = thinned(&points);
        assert!(few.len() <= 4 * 502, "{}", few.len());
        let column = |x: f64| (x / COLUMN).floor();
        for (all, kept) in points
            .chunk_by(|a, b| column(a.0) == column(b.0))
            .zip(few.chunk_by(|a, b| column(a.0) == column(b.0)))
        {
            let top = |c: &[(f64, f64)]| c.iter().map(|p| p.1).fold(0.0, f64::max);
            assert_eq!(top(all), top(kept));
            assert_eq!((all[0], all[all.len() - 1]), (kept[0], kept[kept.len() - 1]));
        }
        let back = vec![(1.0, 1.0), (0.5, 2.0), (0.5, 3.0), (0.5, 1.0)];
        assert_eq!(thinned(&back), back);
    }
}
