//! The grid's answers against looking at every periodic copy of every point.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use bn_core::{CellGrid, DVec2, PointSet, Seed, torus};
use proptest::prelude::*;
use rand::RngExt;

/// Distance to the nearest of 5×5 copies. Its error is that of adding whole numbers below 3 to
/// coordinates, at most 2 ulp of 2 in either coordinate.
fn copies_distance(p: DVec2, q: DVec2) -> f64 {
    let mut least = f64::INFINITY;
    for i in -2..=2 {
        for j in -2..=2 {
            least = least.min((q + DVec2::new(f64::from(i), f64::from(j)) - p).length());
        }
    }
    least
}

const COPIES_ERROR: f64 = 1e-15;

/// The nearest of all points by brute force, at equal distance by index. Roots merge distances
/// whose squares differ; squares below 1e-290 merge distances that differ.
fn nearest_of_all(points: &[DVec2], p: DVec2, except: Option<u32>) -> Option<(u32, f64)> {
    let others = (0..points.len() as u32).filter(|&i| Some(i) != except);
    others
        .map(|i| {
            let q = points[i as usize];
            let squared = torus::distance_squared(p, q);
            (i, torus::distance(p, q), if squared < 1e-290 { 0.0 } else { squared })
        })
        .min_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2)).then(a.0.cmp(&b.0)))
        .map(|(i, distance, _)| (i, distance))
}

fn check_nearest(set: &PointSet, grid: &CellGrid, p: DVec2, except: Option<u32>) {
    let points = set.points();
    let (got, want) = (grid.nearest(p, except), nearest_of_all(points, p, except));
    let (Some((index, distance)), Some((want_index, want_distance))) = (got, want) else {
        assert_eq!(got, want);
        return;
    };
    assert_eq!(distance, want_distance, "from {p} in {grid:?}");
    if distance > 0.0 {
        assert_eq!(index, want_index, "from {p} in {grid:?}");
    } else {
        assert_ne!(Some(index), except);
        assert_eq!(torus::distance(p, points[index as usize]), 0.0);
    }
    let copies = copies_distance(p, points[index as usize]);
    assert!((distance - copies).abs() <= COPIES_ERROR, "{distance} against {copies}");
}

fn check_nearest_k(set: &PointSet, grid: &CellGrid, p: DVec2, k: usize, except: Option<u32>) {
    let points = set.points();
    let got = grid.nearest_k(p, k, except);
    let mut all: Vec<_> = (0..points.len() as u32)
        .filter(|&i| Some(i) != except)
        .map(|i| (torus::distance_squared(p, points[i as usize]), i))
        .collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    all.truncate(k);
    assert_eq!(got.len(), all.len());
    for (&(index, distance), &(want_squared, want)) in got.iter().zip(&all) {
        assert_eq!(distance, torus::distance(p, points[index as usize]));
        assert_eq!(torus::distance_squared(p, points[index as usize]), want_squared);
        // Where more than k coincide, which of them is free.
        assert!(index == want || want_squared == 0.0, "{index} instead of {want}");
    }
}

fn check_within(set: &PointSet, grid: &CellGrid, p: DVec2, radius: f64) {
    let mut got = BTreeMap::new();
    grid.for_each_within(p, radius, |index, squared| {
        assert!(got.insert(index, squared).is_none(), "point {index} twice within {radius}");
    });
    for (index, &q) in (0..).zip(set.points()) {
        let squared = torus::distance_squared(p, q);
        let within = squared <= radius * radius;
        assert_eq!(got.get(&index), within.then_some(&squared), "{q} from {p}, radius {radius}");
        let copies = copies_distance(p, q);
        if (copies - radius).abs() > COPIES_ERROR {
            assert_eq!(within, copies < radius, "{q} from {p}, radius {radius}");
        }
    }
    let all_but_one = (0..set.len() as u32).find(|i| got.contains_key(i));
    assert_eq!(grid.any_within(p, radius, None), !got.is_empty());
    assert_eq!(grid.any_within(p, radius, all_but_one), got.len() > 1);
}

fn check_cells(set: &PointSet, grid: &CellGrid) {
    let m = grid.cells_per_side();
    let mut seen = vec![false; set.len()];
    for iy in 0..m {
        for ix in 0..m {
            let cell = grid.cell(ix, iy);
            assert_eq!(cell.points.len(), cell.indices.len());
            assert!(cell.indices.is_sorted());
            for (&p, &i) in cell.points.iter().zip(cell.indices) {
                assert_eq!(grid.cell_of(p), (ix, iy));
                assert_eq!(p, set.points()[i as usize]);
                assert!(!std::mem::replace(&mut seen[i as usize], true));
            }
        }
        let row: usize = (0..m).map(|ix| grid.cell(ix, iy).points.len()).sum();
        assert_eq!(grid.row_cells(iy, 0..m).points.len(), row);
    }
    assert!(seen.iter().all(|&s| s));
    assert_eq!(grid.all().points.len(), set.len());
}

fn check_everything(set: &PointSet, cells_per_side: usize, queries: &[DVec2], radii: &[f64]) {
    let grid = CellGrid::with_cells_per_side(set, cells_per_side);
    check_cells(set, &grid);
    for (i, &p) in (0..).zip(set.points()) {
        check_nearest(set, &grid, p, Some(i));
        check_nearest(set, &grid, p, None);
        check_nearest_k(set, &grid, p, 1 + i as usize % 7, Some(i));
    }
    for &p in queries {
        check_nearest(set, &grid, p, None);
        check_nearest_k(set, &grid, p, 3, None);
        for &radius in radii {
            check_within(set, &grid, p, radius);
        }
    }
}

/// Coordinates that meet cell borders, the seam and each other often.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => 0.0..1.0_f64,
        2 => (0..12_u8).prop_map(|i| f64::from(i) / 12.0),
        1 => (0..8_u8).prop_map(|i| f64::from(i) / 8.0),
        1 => prop::sample::select(vec![
            0.0, -0.0, 1e-300, 3e-300, 1e-17, 1e-16, 0.5, 0.5 - 1e-16, 0.5 + 2e-16,
            1.0 / 3.0, torus::ONE_MINUS_EPSILON, torus::ONE_MINUS_EPSILON - 1e-15,
        ]),
        1 => (0.0..1e-12_f64).prop_map(|e| 0.25 + e),
    ]
}

fn point() -> impl Strategy<Value = DVec2> {
    (coordinate(), coordinate()).prop_map(|(x, y)| DVec2::new(x, y))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn agrees_with_brute_force(
        points in prop::collection::vec(point(), 1..60),
        cells_per_side in 1_usize..14,
        queries in prop::collection::vec(point(), 1..4),
        radius in prop_oneof![0.0..1.0_f64, (0..13_u8).prop_map(|i| f64::from(i) / 12.0)],
    ) {
        let set = PointSet::new(points).expect("valid");
        let radii = [0.0, radius, radius / 8.0, 0.5, torus::DIAMETER, f64::INFINITY];
        check_everything(&set, cells_per_side, &queries, &radii);
    }
}

/// Sets that are clustered enough for the tree, within a cell and all over.
#[test]
fn clusters_agree_with_brute_force() {
    let mut rng = Seed::new(7).stream(0);
    for scale in [1e-2, 1e-9, 1e-16, 1e-200, 1e-300] {
        for center in [DVec2::ZERO, DVec2::new(0.3, 0.999_999)] {
            let mut points: Vec<_> = (0..300)
                .map(|_| center + scale * DVec2::new(rng.random::<f64>(), rng.random::<f64>()))
                .collect();
            points.extend((0..20).map(|_| DVec2::new(rng.random(), rng.random())));
            let set = PointSet::wrapped(points).expect("finite");
            let queries = [center, DVec2::new(0.5, 0.5), DVec2::splat(torus::ONE_MINUS_EPSILON)];
            check_everything(&set, 13, &queries, &[0.0, scale, 1e-150, 0.1, 0.6, 1.0]);
        }
    }
}

#[test]
fn lattices_and_lines_agree_with_brute_force() {
    let lattice = |m: u32| (0..m * m).map(move |i| DVec2::new(f64::from(i % m), f64::from(i / m)));
    let sets = [
        lattice(12).map(|p| p / 12.0).collect(),
        lattice(16).map(|p| p / 16.0).collect(),
        (0..100).map(|i| DVec2::new(f64::from(i) / 100.0, 0.0)).collect(),
        (0..100).map(|i| DVec2::splat(f64::from(i) / 100.0)).collect(),
    ];
    for points in sets {
        let set = PointSet::new(points).expect("valid");
        let side = CellGrid::new(&set).cells_per_side();
        for cells in [side, 12, 100] {
            let queries = [DVec2::ZERO, DVec2::new(1.0 / 3.0, 0.75)];
            check_everything(&set, cells, &queries, &[1.0 / 12.0, 0.125, 0.5, 0.8]);
        }
    }
}

/// Large sets are sorted in blocks of rows; here the last block is smaller.
#[test]
fn large_sets_are_in_their_cells() {
    let mut rng = Seed::new(9).stream(0);
    let points = (0..150_000).map(|_| DVec2::new(rng.random(), rng.random())).collect();
    let set = PointSet::new(points).expect("valid");
    for cells_per_side in [1, 2, 3, 101, 1000] {
        check_cells(&set, &CellGrid::with_cells_per_side(&set, cells_per_side));
    }
}

#[test]
fn one_point_is_alone_unless_nobody_is_left_out() {
    let p = DVec2::new(0.9, 0.1);
    let grid = CellGrid::new(&PointSet::new(vec![p]).expect("valid"));
    assert_eq!(grid.nearest(p, Some(0)), None);
    assert_eq!(
        grid.nearest(DVec2::new(0.1, 0.1), None),
        Some((0, torus::distance(p, DVec2::new(0.1, 0.1))))
    );
    assert_eq!(grid.nearest_k(p, 0, None), []);
    assert_eq!(grid.nearest_k(p, 5, None), [(0, 0.0)]);
    assert!(!grid.any_within(p, 1.0, Some(0)));
}

/// Quadratic work would take minutes here.
#[test]
fn clustered_sets_do_not_go_quadratic() {
    let n = 200_000;
    let mut rng = Seed::new(8).stream(0);
    let equal = vec![DVec2::new(0.25, 0.75); n];
    let mut within = |size: f64| -> Vec<DVec2> {
        (0..n).map(|_| size * DVec2::new(rng.random(), rng.random())).collect()
    };
    // Squares of distances: ordinary, with few digits, 0.
    for points in [equal, within(1e-4), within(1e-158), within(1e-300)] {
        let set = PointSet::new(points).expect("valid");
        let grid = CellGrid::new(&set);
        for (i, &p) in (0..).zip(set.points()) {
            let (neighbor, distance) = grid.nearest(p, Some(i)).expect("not alone");
            assert!(neighbor != i && distance < 1e-4);
            assert_eq!(grid.nearest_k(p, 2, None).len(), 2);
        }
    }
}

#[test]
fn a_visit_ends_where_the_visitor_says() {
    let set = PointSet::new(vec![DVec2::new(0.5, 0.5); 10]).expect("valid");
    let grid = CellGrid::new(&set);
    let mut visits = 0;
    let found = grid.try_for_each_within(DVec2::new(0.5, 0.5), 0.1, |index, _| {
        visits += 1;
        if visits == 4 { ControlFlow::Break(index) } else { ControlFlow::Continue(()) }
    });
    assert!(found.is_break());
    assert_eq!(visits, 4);
}

#[test]
#[should_panic(expected = "not a distance")]
fn a_radius_is_not_nan() {
    let set = PointSet::new(vec![DVec2::ZERO]).expect("valid");
    CellGrid::new(&set).any_within(DVec2::ZERO, f64::NAN, None);
}

#[test]
#[should_panic(expected = "is not in [0, 1)²")]
fn a_query_is_on_the_torus() {
    let set = PointSet::new(vec![DVec2::ZERO]).expect("valid");
    let _ = CellGrid::new(&set).nearest(DVec2::ONE, None);
}
