//! Moving points, and what they would leave behind, against taking them out and adding them.

use crate::common::*;
use bn_core::{DVec2, Seed, torus};
use bn_geometry::{Circle, Spacing, Triangulation, Vacancy};
use proptest::prelude::*;
use rand::RngExt;

fn numbered(points: &[DVec2]) -> Vec<(usize, DVec2)> {
    points.iter().copied().enumerate().collect()
}

fn vacancy(triangulation: &mut Triangulation, index: usize) -> Option<Vacancy> {
    let size = |corners| Circle::through(corners).radius_squared;
    triangulation.vacancy(index, size, DVec2::length_squared)
}

/// What is left behind by really taking the point out: squares of the distance to the nearest
/// neighbour and of the largest circle's radius.
fn vacancy_by_removal(triangulation: &Triangulation, index: usize) -> (f64, f64) {
    let neighbors = triangulation.neighbors(index);
    let clearance_squared =
        neighbors.map(|(_, d)| d.length_squared()).fold(f64::INFINITY, f64::min);
    let mut without = triangulation.clone();
    without.remove(index);
    let faces = without.changed_faces().iter().filter(|&&face| without.has_face(face));
    let largest = faces
        .map(|&face| without.circumcircle(face))
        .max_by(|a, b| a.radius_squared.total_cmp(&b.radius_squared))
        .expect("a polygon holds a face");
    (clearance_squared, largest.radius_squared)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn vacancies_are_what_removal_leaves(points in point_family()) {
        let mut triangulation = Triangulation::new(&set(&points));
        let before = canonical_faces(&triangulation);
        for index in 0..points.len() {
            let Some(vacancy) = vacancy(&mut triangulation, index) else {
                let home = triangulation.representative(index);
                let shares = (0..points.len()).filter(|&i| triangulation.representative(i) == home).count() > 1;
                let touches = triangulation.neighbors(home).any(|(other, _)| other == home);
                prop_assert!(shares || touches);
                continue;
            };
            let want = vacancy_by_removal(&triangulation, index);
            prop_assert_eq!(vacancy.clearance, want.0);
            // Corners in another order: some tens of rounding errors.
            let ratio = vacancy.size / want.1;
            prop_assert!((ratio - 1.0).abs() < 1e-12, "{vacancy:?} {want:?}");
            // The centre is as far from all other points as the radius says.
            let center = vacancy.face.map(|corners| Circle::through(corners).center).expect("a face");
            let center = torus::wrap_point(triangulation.position(index) + center);
            let others = (0..points.len()).filter(|&i| i != index);
            let nearest = others.map(|i| torus::distance(center, triangulation.position(i)));
            let nearest = nearest.fold(f64::INFINITY, f64::min);
            prop_assert!((nearest - vacancy.size.sqrt()).abs() < 1e-12);
        }
        prop_assert_eq!(canonical_faces(&triangulation), before);
    }

    #[test]
    fn the_triangulation_knows_the_spacing(points in point_family()) {
        let by_edges = Spacing::of(&Triangulation::new(&set(&points)));
        let by_search = Spacing::new(&set(&points));
        let pairs = by_edges.nearest_distances().iter().zip(by_search.nearest_distances());
        for (a, b) in pairs {
            prop_assert!((a - b).abs() < 2.0_f64.powi(-49), "{a} {b}");
        }
    }

    #[test]
    fn moved_points_leave_the_same_faces_as_new_ones(
        points in point_family(), seed in any::<u64>(), reach in prop_oneof![Just(1e-15), Just(1e-3), Just(0.05), Just(1.0)]
    ) {
        let mut rng = Seed::new(seed).stream(0);
        let mut triangulation = Triangulation::new(&set(&points));
        let mut points = points;
        for step in 0..60_u32 {
            let index = rng.random_range(0..points.len() as u32) as usize;
            let way = at(rng.random::<f64>() - 0.5, rng.random::<f64>() - 0.5) * reach;
            let p = match step % 8 {
                0 => points[rng.random_range(0..points.len() as u32) as usize],
                _ => torus::wrap_point(triangulation.position(index) + way),
            };
            if step % 2 == 0 {
                // Makes the star ready.
                let _ = vacancy(&mut triangulation, index);
            }
            let faces: Vec<_> = triangulation.faces().collect();
            triangulation.relocate(index, p);
            points[index] = p;
            let changed = triangulation.changed_faces();
            for face in faces {
                let is_same = triangulation.has_face(face.id) && triangulation.face(face.id) == face;
                prop_assert!(is_same || changed.contains(&face.id), "{face:?} changed unseen");
            }
        }
        assert_delaunay(&triangulation, &numbered(&points));
        let fresh = Triangulation::new(&set(&points));
        prop_assert_eq!(canonical_faces(&triangulation), canonical_faces(&fresh));
    }

    #[test]
    fn all_points_can_move_at_once(
        points in point_family(), seed in any::<u64>(), reach in prop_oneof![Just(0.0), Just(1e-15), Just(1e-3), Just(0.02), Just(0.3)]
    ) {
        let mut rng = Seed::new(seed).stream(0);
        let mut triangulation = Triangulation::new(&set(&points));
        let mut points = points;
        for _ in 0..5 {
            let ways: Vec<_> =
                points.iter().map(|_| at(rng.random::<f64>() - 0.5, rng.random::<f64>() - 0.5) * reach).collect();
            points = (0..points.len())
                .map(|i| torus::wrap_point(triangulation.position(i) + ways[triangulation.representative(i)]))
                .collect();
            triangulation.relocate_all(|i, p| torus::wrap_point(p + ways[i]));
            assert_delaunay(&triangulation, &numbered(&points));
            let fresh = Triangulation::new(&set(&points));
            prop_assert_eq!(canonical_faces(&triangulation), canonical_faces(&fresh));
        }
    }
}
