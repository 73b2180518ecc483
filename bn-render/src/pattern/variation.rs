//! What sets one tile of a pattern apart from the next.

use bn_core::{DVec2, Seed, torus};
use rand::{Rng, RngExt};

use super::buckets::Interval;

/// How the tiles of a pattern differ from each other.
///
/// Turns and shifts are drawn for each tile from its own stream of the seed, whatever part of the
/// image is rendered; the choice repeats after 65,536 tiles along an axis. A turned or shifted
/// tile no longer joins its neighbours: samples may come closer across the seam than the pattern
/// allows within.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum TileVariation {
    /// All tiles are alike and join without a seam, if the pattern is periodic.
    #[default]
    Repeated,
    /// Each tile is turned by a multiple of 90°.
    Turned(Seed),
    /// Each tile is shifted on the torus.
    Shifted(Seed),
    /// Both.
    TurnedAndShifted(Seed),
}

/// The change of one tile: first a number of quarter turns, then a shift on the torus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Change {
    quarter_turns: u32,
    shift: DVec2,
}

impl TileVariation {
    /// The change of tile (a, b); none if all are alike.
    pub(super) fn of_tile(self, a: i64, b: i64) -> Option<Change> {
        let (seed, turned, shifted) = match self {
            Self::Repeated => return None,
            Self::Turned(seed) => (seed, true, false),
            Self::Shifted(seed) => (seed, false, true),
            Self::TurnedAndShifted(seed) => (seed, true, true),
        };
        let mut rng = seed.stream((a as u32 & 0xffff) << 16 | (b as u32 & 0xffff));
        let quarter_turns = if turned { rng.next_u32() >> 30 } else { 0 };
        let shift = if shifted { DVec2::new(rng.random(), rng.random()) } else { DVec2::ZERO };
        Some(Change { quarter_turns, shift })
    }
}

impl Change {
    /// Where a point of the tile comes to lie.
    pub(super) fn apply(self, p: DVec2) -> DVec2 {
        let turned = match self.quarter_turns {
            0 => p,
            1 => DVec2::new(1.0 - p.y, p.x),
            2 => 1.0 - p,
            _ => DVec2::new(p.y, 1.0 - p.x),
        };
        torus::wrap_point(turned + self.shift)
    }

    /// The intervals of x and y that points come from when they come to lie in `x` × `y`: up to
    /// two along each axis, disjoint and ascending, generous by a rounding error.
    pub(super) fn sources(self, x: Interval, y: Interval) -> [[Interval; 2]; 2] {
        let x = (x.0 - self.shift.x, x.1 - self.shift.x);
        let y = (y.0 - self.shift.y, y.1 - self.shift.y);
        let back = |(low, high): Interval| (1.0 - high, 1.0 - low);
        let (x, y) = match self.quarter_turns {
            0 => (x, y),
            1 => (y, back(x)),
            2 => (back(x), back(y)),
            _ => (back(y), x),
        };
        [wrapped(x), wrapped(y)]
    }
}

/// An interval on the circle as one or two intervals of [0, 1], ascending; empty ones are (2, 2).
fn wrapped((low, high): Interval) -> [Interval; 2] {
    const SLACK: f64 = 1e-9;
    const EMPTY: Interval = (2.0, 2.0);
    let (low, high) = (low - SLACK, high + SLACK);
    if high - low >= 1.0 {
        return [(0.0, 1.0), EMPTY];
    }
    let start = torus::wrap(low);
    let end = start + (high - low);
    if end < 1.0 { [(start, end), EMPTY] } else { [(0.0, end - 1.0), (start, 1.0)] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_lead_back_to_where_points_come_from() {
        let mut rng = Seed::new(8).stream(1);
        for tile in 0..400 {
            let change = TileVariation::TurnedAndShifted(Seed::new(5)).of_tile(tile, -tile);
            let change = change.expect("tiles differ");
            let mut interval = || {
                let low: f64 = rng.random_range(0.0..1.0);
                (low, rng.random_range(low..1.0))
            };
            let (x, y) = (interval(), interval());
            let [from_x, from_y] = change.sources(x, y);
            assert!(from_x[0].1 < from_x[1].0 && from_y[0].1 < from_y[1].0);
            for _ in 0..100 {
                let p = DVec2::new(rng.random(), rng.random());
                let q = change.apply(p);
                assert!(torus::contains(q));
                let landed = (x.0..=x.1).contains(&q.x) && (y.0..=y.1).contains(&q.y);
                let holds = |i: &Interval, c: f64| (i.0..=i.1).contains(&c);
                let sought =
                    from_x.iter().any(|i| holds(i, p.x)) && from_y.iter().any(|i| holds(i, p.y));
                assert!(sought || !landed, "{p} → {q} by {change:?}");
            }
        }
    }

    #[test]
    fn tiles_draw_their_own_change() {
        let variation = TileVariation::Turned(Seed::new(1));
        let turns: Vec<u32> = (0..64)
            .map(|a| variation.of_tile(a, -1).expect("tiles differ").quarter_turns)
            .collect();
        for k in 0..4 {
            assert!(turns.contains(&k));
        }
        assert_eq!(TileVariation::Repeated.of_tile(3, 4), None);
        let one = Change { quarter_turns: 1, shift: DVec2::ZERO };
        assert_eq!(one.apply(DVec2::new(0.25, 0.0)), DVec2::new(0.0, 0.25));
    }
}
