//! Patterns on the image plane against the definition, tile by tile.

use crate::common::random_set;
use bn_core::{DVec2, PointSet, Seed};
use bn_render::{Pattern, Rect, SampleList, TileVariation};
use proptest::prelude::*;

fn samples(pattern: &Pattern, rect: &Rect) -> Vec<(f64, f64)> {
    let mut list = SampleList::default();
    pattern.samples_in(rect, &mut list);
    list.u().iter().copied().zip(list.v().iter().copied()).collect()
}

/// Every point of every tile that could matter, by the definition.
fn by_definition(set: &PointSet, side: f64, rect: &Rect) -> Vec<(f64, f64)> {
    let tiles = |low: f64, high: f64| (low / side) as i64 - 2..(high / side) as i64 + 2;
    let mut all = Vec::new();
    for b in tiles(rect.min.y, rect.max.y) {
        for a in tiles(rect.min.x, rect.max.x) {
            for p in set.points() {
                let (u, v) = ((a as f64 + p.x) * side, (b as f64 + p.y) * side);
                if (rect.min.x..rect.max.x).contains(&u) && (rect.min.y..rect.max.y).contains(&v) {
                    all.push((u, v));
                }
            }
        }
    }
    all
}

fn sorted(mut list: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    list.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
    list
}

proptest! {
    #[test]
    fn samples_are_those_of_the_definition(
        n in 1_usize..60, seed in 0_u64..1000, spp in 0.05_f64..40.0,
        u0 in -9.0_f64..20.0, v0 in -9.0_f64..20.0, w in 0.0_f64..15.0, h in 0.0_f64..15.0,
    ) {
        let set = random_set(n, seed);
        let pattern = Pattern::tiled(&set, spp).expect("a pattern");
        prop_assert_eq!(pattern.side(), (n as f64 / spp).sqrt());
        let rect = Rect::new(u0, v0, u0 + w, v0 + h);
        let got = samples(&pattern, &rect);
        prop_assert_eq!(pattern.count_in(&rect), got.len() as u64);
        prop_assert_eq!(sorted(got), sorted(by_definition(&set, pattern.side(), &rect)));
    }

    #[test]
    fn a_smaller_rectangle_keeps_the_order(
        n in 1_usize..200, spp in 0.2_f64..9.0, kind in 0_u8..4,
        cut in (0.0_f64..1.0, 0.0_f64..1.0, 0.0_f64..1.0, 0.0_f64..1.0),
    ) {
        let seed = Seed::new(4);
        let variation = match kind {
            0 => TileVariation::Repeated,
            1 => TileVariation::Turned(seed),
            2 => TileVariation::Shifted(seed),
            _ => TileVariation::TurnedAndShifted(seed),
        };
        let pattern = Pattern::tiled(&random_set(n, 7), spp).expect("a pattern").varied(variation);
        let large = Rect::new(-3.0, -2.0, 12.0, 14.0);
        let (w, h) = (large.max.x - large.min.x, large.max.y - large.min.y);
        let small = Rect::new(
            large.min.x + cut.0 * w, large.min.y + cut.1 * h,
            large.max.x - cut.2 * (1.0 - cut.0) * w, large.max.y - cut.3 * (1.0 - cut.1) * h,
        );
        let inside = |&(u, v): &(f64, f64)| {
            (small.min.x..small.max.x).contains(&u) && (small.min.y..small.max.y).contains(&v)
        };
        let want: Vec<_> = samples(&pattern, &large).into_iter().filter(inside).collect();
        prop_assert_eq!(pattern.count_in(&small), want.len() as u64);
        prop_assert_eq!(samples(&pattern, &small), want);
    }

    #[test]
    fn varied_tiles_hold_all_their_points(n in 1_usize..80, spp in 0.5_f64..9.0, seed in 0_u64..99) {
        let pattern = Pattern::tiled(&random_set(n, seed), spp).expect("a pattern");
        let side = pattern.side();
        let pattern = pattern.varied(TileVariation::TurnedAndShifted(Seed::new(seed)));
        // A point of a turned tile may wrap onto the tile's lower edge, never beyond the upper.
        let rect = Rect::new(-2.0 * side, side, 3.0 * side, 4.0 * side);
        let (count, tiles) = (samples(&pattern, &rect).len(), 5 * 3);
        // Points within rounding of the rectangle's own border may count to the next tile.
        prop_assert!(count.abs_diff(tiles * n) <= 2, "{} of {}", count, tiles * n);
    }
}

#[test]
fn the_first_tile_starts_at_the_corner() {
    let set = PointSet::new(vec![DVec2::new(0.0, 0.0), DVec2::new(0.5, 0.25)]).expect("a set");
    let pattern = Pattern::tiled(&set, 0.5).expect("a pattern");
    assert_eq!(pattern.side(), 2.0);
    let first = samples(&pattern, &Rect::new(0.0, 0.0, 2.0, 2.0));
    assert_eq!(first, [(0.0, 0.0), (1.0, 0.5)]);
    let left = samples(&pattern, &Rect::new(-2.0, 0.0, 0.0, 2.0));
    assert_eq!(left, [(-2.0, 0.0), (-1.0, 0.5)]);
}

#[test]
fn absurd_rates_are_refused() {
    let set = random_set(3, 1);
    for spp in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e9, 1e-9] {
        assert!(Pattern::tiled(&set, spp).is_err(), "{spp}");
    }
    assert!(
        samples(
            &Pattern::tiled(&set, 4.0).expect("a pattern"),
            &Rect::new(f64::NAN, 0.0, 1.0, 1.0)
        )
        .is_empty()
    );
}

#[test]
fn tiny_tiles_are_read_completely() {
    // One point and 2¹⁶ samples per pixel: 65,536 tiles in a pixel.
    let set = PointSet::new(vec![DVec2::new(0.999_999, 0.0)]).expect("a set");
    let pattern = Pattern::tiled(&set, 65_536.0).expect("a pattern");
    assert_eq!(pattern.count_in(&Rect::new(99_999.0, 7.0, 100_000.0, 7.5)), 256 * 128);
}

/// So many tiles can't be visited.
#[test]
fn tiles_of_large_frames_are_counted_together() {
    let set = PointSet::new(vec![DVec2::new(0.5, 0.25)]).expect("a set");
    let pattern = Pattern::tiled(&set, 65_536.0).expect("a pattern");
    let turned = pattern.clone().varied(TileVariation::Turned(Seed::new(1)));
    for pattern in [pattern, turned] {
        let frame = Rect::new(0.0, 0.0, 4096.0, 2048.0);
        assert_eq!(pattern.count_in(&frame), (4096 * 2048) << 16);
        // Half a tile more of each side, and a place inside the next tile.
        let crop = Rect::new(-1.9 / 256.0, 0.0, 1000.0, 700.0 + 0.9 / 256.0);
        assert_eq!(pattern.count_in(&crop), (256_000 + 2) * (179_200 + 1));
    }
}
