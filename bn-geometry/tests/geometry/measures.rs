//! Spacing, coverage, cells and order against brute force, whatever the points.

use crate::common::*;
use bn_core::{DVec2, Seed, torus};
use bn_geometry::*;
use proptest::prelude::*;
use rand::RngExt;

/// Distances to the nearest other point, or own copy, over 5 × 5 copies.
fn brute_force_spacing(points: &[DVec2]) -> Vec<f64> {
    let distance = |i: usize| {
        let apart = |k: usize, q: DVec2| {
            let same = k % points.len() == i && k / points.len() == 12;
            if same { f64::INFINITY } else { f64::hypot(q.x - points[i].x, q.y - points[i].y) }
        };
        copies(points).enumerate().map(|(k, q)| apart(k, q)).fold(f64::INFINITY, f64::min)
    };
    (0..points.len()).map(distance).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn spacing_is_the_brute_force_one(points in point_family()) {
        let spacing = Spacing::new(&set(&points));
        let want = brute_force_spacing(&points);
        for (&got, &want) in spacing.nearest_distances().iter().zip(&want) {
            // Copies round the coordinates of points next to the seam by 2⁻⁵³.
            prop_assert!((got - want).abs() <= 4e-16, "{got}, brute force {want}");
        }
        let n = points.len() as f64;
        prop_assert!((spacing.mean() - want.iter().sum::<f64>() / n).abs() <= 5e-16);
        let least = want.iter().copied().fold(1.0, f64::min);
        prop_assert!((spacing.min() - least).abs() <= 4e-16);
    }

    #[test]
    fn coverage_is_where_no_point_is(points in point_family(), x in 0.0..1.0, y in 0.0..1.0) {
        let coverage = Coverage::of(&Triangulation::new(&set(&points))).expect("not empty");
        let clearance = |q: DVec2| {
            points.iter().map(|&p| torus::distance(p, q)).fold(f64::INFINITY, f64::min)
        };
        prop_assert!(torus::contains(coverage.farthest_point));
        prop_assert!((clearance(coverage.farthest_point) - coverage.radius).abs() < 1e-14);
        // No other place is farther from the points, least of all one next to the hole's centre.
        let offset = (at(x, y) - 0.5) * 1e-3;
        let near = torus::wrap_point(coverage.farthest_point + offset);
        for place in [at(x, y), near] {
            prop_assert!(clearance(place) <= coverage.radius + 1e-14);
        }
    }

    #[test]
    fn cells_are_what_bisectors_leave(points in point_family()) {
        let triangulation = Triangulation::new(&set(&points));
        let cells = voronoi_cells(&triangulation);
        let sum: f64 = cells.iter().map(|cell| cell.area).sum();
        prop_assert!((sum - 1.0).abs() < 1e-14 * points.len() as f64, "areas sum to {sum}");
        let places: Vec<DVec2> = (0..points.len()).map(|i| triangulation.position(i)).collect();
        for (index, &cell) in cells.iter().enumerate() {
            if triangulation.representative(index) != index {
                prop_assert_eq!(cell, VoronoiCell::EMPTY);
                continue;
            }
            let (area, first, second) = moments(&clipped_cell(&places, &vec![0.0; places.len()], index));
            prop_assert!((cell.area - area).abs() < 1e-13, "area {}, clipped {area}", cell.area);
            prop_assert!((cell.to_centroid * cell.area - first).length() < 1e-13);
            prop_assert!((cell.second_moment - second).abs() < 1e-13);
            let corners: Vec<DVec2> = triangulation.cell_corners(index).collect();
            let (by_corners, _, _) = moments(&corners);
            prop_assert!((by_corners - cell.area).abs() < 1e-13);
        }
    }

    #[test]
    fn order_is_that_of_the_angles(points in point_family(), fold in 0_u32..20) {
        let triangulation = Triangulation::new(&set(&points));
        let local = local_bond_orientational_order(&triangulation, fold);
        for (index, got) in local.iter().enumerate() {
            let bonds: Vec<DVec2> = triangulation.neighbors(index).map(|(_, d)| d).collect();
            let turn = |d: &DVec2| DVec2::from_angle(d.y.atan2(d.x) * f64::from(fold));
            let want = bonds.iter().map(turn).sum::<DVec2>().length() / bonds.len() as f64;
            // The bound, and as much for the angles.
            let bound = 2e-15 * f64::from(fold + 10);
            prop_assert!((got - want).abs() < bound, "q of {index} is {got}, by angles {want}");
        }
        let mean = local.iter().sum::<f64>() / points.len() as f64;
        let got = bond_orientational_order(&triangulation, fold).expect("not empty");
        prop_assert!((got - mean).abs() < 1e-14);
    }

    #[test]
    fn measures_do_not_see_the_seam(points in point_family(), x in 0_u32..64, y in 0_u32..64) {
        // Whole 64ths keep the points on the coordinate grid, so nothing is rounded.
        let grid = (1_u64 << 50) as f64;
        let snapped = points.iter().map(|&p| torus::wrap_point((p * grid).round() / grid));
        let here = set(&snapped.collect::<Vec<_>>());
        let there = here.translated(at(f64::from(x), f64::from(y)) / 64.0);
        let all = |set: &bn_core::PointSet| {
            let triangulation = Triangulation::new(set);
            let spacing = Spacing::new(set);
            let coverage = Coverage::of(&triangulation).expect("not empty");
            let order = bond_orientational_order(&triangulation, 6).expect("not empty");
            [spacing.min(), spacing.mean(), coverage.radius, order]
        };
        for (a, b) in all(&here).into_iter().zip(all(&there)) {
            prop_assert!((a - b).abs() < 1e-13, "{a} here, {b} there");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn empty_circles_follow_every_change(
        points in point_family(), other in point_family(), seed in any::<u64>()
    ) {
        let mut rng = Seed::new(seed).stream(0);
        let mut triangulation = Triangulation::new(&set(&points));
        let mut holes = EmptyCircles::new(&triangulation);
        let mut present: Vec<usize> = (0..points.len()).collect();
        for (index, p) in other.iter().enumerate() {
            triangulation.insert(100 + index, *p);
            holes.update(&triangulation);
            present.push(100 + index);
            for _ in 0..rng.random_range(0..3) {
                if let Some(gone) = present.pop() {
                    triangulation.remove(gone);
                    holes.update(&triangulation);
                }
            }
            let coverage = Coverage::of(&triangulation);
            let largest = holes.largest().map(|face| holes.size(face).sqrt());
            prop_assert_eq!(largest, coverage.map(|coverage| coverage.radius));
            prop_assert!(holes.largest().is_none_or(|face| triangulation.has_face(face)));
        }
    }
}

#[test]
fn one_point_is_its_own_neighbour() {
    let alone = set(&[at(0.3, 0.6)]);
    let spacing = Spacing::new(&alone);
    assert_eq!((spacing.min(), spacing.mean()), (1.0, 1.0));
    let triangulation = Triangulation::new(&alone);
    let coverage = Coverage::of(&triangulation).expect("one point");
    assert!((coverage.radius - torus::DIAMETER).abs() < 1e-15);
    let cell = voronoi_cells(&triangulation)[0];
    assert!((cell.area - 1.0).abs() < 1e-15 && cell.to_centroid.length() < 1e-15);
    assert!((cell.second_moment - 1.0 / 6.0).abs() < 1e-15);
    let order = bond_orientational_order(&triangulation, 6).expect("one point");
    assert!((order - 1.0 / 3.0).abs() < 1e-15);
}

#[test]
fn no_point_has_no_measures() {
    let empty = Triangulation::empty();
    assert_eq!(Coverage::of(&empty), None);
    assert_eq!(bond_orientational_order(&empty, 6), None);
    assert!(voronoi_cells(&empty).is_empty());
}

#[test]
fn points_next_to_nothing_apart_are_apart() {
    let spacing = Spacing::new(&set(&[at(0.0, 0.0), at(1e-300, 0.0), at(0.5, 0.5)]));
    assert_eq!(spacing.min(), 1e-300);
    let same = Spacing::new(&set(&[at(0.25, 0.5); 100]));
    assert_eq!((same.min(), same.mean()), (0.0, 0.0));
}

#[test]
fn square_lattice_in_closed_form() {
    let side = 64;
    let lattice = set(&lattice(side, side, 0.0));
    let triangulation = Triangulation::new(&lattice);
    let spacing = Spacing::new(&lattice);
    let h = 1.0 / side as f64;
    assert_eq!((spacing.min(), spacing.mean()), (h, h));
    let coverage = Coverage::of(&triangulation).expect("not empty");
    assert!((coverage.radius - h * 0.5_f64.sqrt()).abs() < 1e-16);
    for cell in voronoi_cells(&triangulation) {
        assert!((cell.area - h * h).abs() < 1e-18);
        assert!(cell.to_centroid.length() < 1e-15);
        assert!((cell.second_moment - h.powi(4) / 6.0).abs() < 1e-22);
    }
}

#[test]
fn parallel_spacing_is_the_sequential_one() {
    let points = random_points(50_000, 3);
    let spacing = Spacing::new(&set(&points));
    let grid = bn_core::CellGrid::new(&set(&points));
    for (i, &p) in points.iter().enumerate() {
        let (_, distance) = grid.nearest(p, Some(i as u32)).expect("not alone");
        assert_eq!(spacing.nearest_distances()[i], distance);
    }
}
