//! The triangulation against brute force, whatever the points.

use crate::common::*;
use bn_core::{DVec2, Seed};
use bn_geometry::{Location, Triangulation};
use proptest::prelude::*;
use rand::RngExt;
use rand::seq::SliceRandom;

fn numbered(points: &[DVec2]) -> Vec<(usize, DVec2)> {
    points.iter().copied().enumerate().collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn is_delaunay_for_every_family(points in point_family()) {
        assert_delaunay(&Triangulation::new(&set(&points)), &numbered(&points));
    }

    #[test]
    fn is_a_function_of_the_point_set(points in point_family(), seed in any::<u64>()) {
        let bulk = canonical_faces(&Triangulation::new(&set(&points)));
        let mut order = numbered(&points);
        order.shuffle(&mut Seed::new(seed).stream(0));
        let mut one_by_one = Triangulation::empty();
        for &(index, p) in &order {
            one_by_one.insert(index, p);
        }
        one_by_one.sanity_check();
        prop_assert_eq!(canonical_faces(&one_by_one), bulk);
    }

    #[test]
    fn removal_undoes_insertion(points in point_family(), seed in any::<u64>()) {
        let mut rng = Seed::new(seed).stream(0);
        let mut triangulation = Triangulation::new(&set(&points));
        let mut order = numbered(&points);
        order.shuffle(&mut rng);
        while let Some((index, _)) = order.pop() {
            triangulation.remove(index);
            prop_assert!(!triangulation.contains(index));
            triangulation.sanity_check();
            prop_assert_eq!(triangulation.point_count(), order.len());
            let mut fresh = Triangulation::empty();
            for &(index, p) in &order {
                fresh.insert(index, p);
            }
            prop_assert_eq!(canonical_faces(&triangulation), canonical_faces(&fresh));
        }
    }

    #[test]
    fn mixed_insertions_and_removals(
        points in point_family(), other in point_family(), seed in any::<u64>()
    ) {
        let mut rng = Seed::new(seed).stream(0);
        let mut triangulation = Triangulation::new(&set(&points));
        let mut present = numbered(&points);
        for (index, p) in numbered(&other) {
            let gone = present.swap_remove(rng.random_range(0..present.len()));
            triangulation.remove(gone.0);
            let index = if index % 2 == 0 { gone.0 } else { 1000 + index };
            triangulation.insert(index, p);
            present.push((index, p));
        }
        assert_delaunay(&triangulation, &present);
    }

    #[test]
    fn neighbours_are_mutual_and_turn_counter_clockwise(points in point_family()) {
        let triangulation = Triangulation::new(&set(&points));
        for index in 0..points.len() {
            let around: Vec<_> = triangulation.neighbors(index).collect();
            let home = triangulation.representative(index);
            prop_assert!(around.len() >= 3);
            prop_assert_eq!(around.len(), triangulation.star(index).count());
            for (i, &(other, d)) in around.iter().enumerate() {
                let (_, next) = around[(i + 1) % around.len()];
                prop_assert!(d.perp_dot(next) > 0.0 || d.abs().max_element() < 1e-12);
                let place = triangulation.position(index) + d;
                prop_assert_eq!(bn_core::torus::wrap_point(place), triangulation.position(other));
                prop_assert!(triangulation.neighbors(other).any(|back| back == (home, -d)));
            }
        }
    }

    #[test]
    fn changed_faces_are_all_that_changed(
        points in point_family(), other in point_family(), seed in any::<u64>()
    ) {
        let mut rng = Seed::new(seed).stream(0);
        let mut triangulation = Triangulation::new(&set(&points));
        let mut faces: Vec<_> = triangulation.faces().map(Some).collect();
        let mut present: Vec<usize> = (0..points.len()).collect();
        let mut renew = |triangulation: &Triangulation| {
            faces.resize(triangulation.face_bound().max(faces.len()), None);
            let mut changed = triangulation.changed_faces().to_vec();
            for &id in &changed {
                faces[id.index()] = triangulation.has_face(id).then(|| triangulation.face(id));
            }
            assert!(faces.iter().flatten().copied().eq(triangulation.faces()));
            changed.sort_unstable();
            assert!(changed.is_sorted_by(|a, b| a < b), "each once");
        };
        for (index, p) in numbered(&other) {
            triangulation.insert(100 + index, p);
            present.push(100 + index);
            renew(&triangulation);
            triangulation.remove(present.swap_remove(rng.random_range(0..present.len())));
            renew(&triangulation);
        }
    }

    #[test]
    fn locates_corners_edges_and_faces(points in point_family(), x in 0.0..1.0, y in 0.0..1.0) {
        let triangulation = Triangulation::new(&set(&points));
        for (index, &p) in points.iter().enumerate() {
            let home = Location::Point(triangulation.representative(index));
            prop_assert_eq!(triangulation.locate(p), Some(home));
        }
        let p = at(x, y);
        let Some(Location::Face(id)) = triangulation.locate(p) else {
            return Ok(());
        };
        let corners = triangulation.face(id).corners;
        let holds = |q: DVec2| (0..3).all(|i| (corners[(i + 1) % 3] - corners[i]).perp_dot(q - corners[i]) > -1e-15);
        prop_assert!(copies(&[p]).any(holds), "{p} is not in {corners:?}");
    }
}

#[test]
fn one_point_has_two_faces() {
    let mut triangulation = Triangulation::empty();
    assert_eq!(triangulation.locate(at(0.5, 0.5)), None);
    triangulation.insert(3, at(0.25, 0.5));
    assert_delaunay(&triangulation, &[(3, at(0.25, 0.5))]);
    let around: Vec<_> = triangulation.neighbors(3).collect();
    assert_eq!(around.len(), 6);
    assert!(around.iter().all(|&(index, _)| index == 3));
    triangulation.remove(3);
    assert_eq!((triangulation.face_count(), triangulation.point_count()), (0, 0));
    triangulation.insert(0, at(0.0, 0.0));
    triangulation.sanity_check();
}

#[test]
fn lattices_are_cut_alike_everywhere() {
    for points in [lattice(8, 8, 0.0), lattice(5, 7, 0.0), lattice(6, 6, 0.5), lattice(32, 32, 0.0)]
    {
        let triangulation = Triangulation::new(&set(&points));
        let around = |index: usize| {
            let mut d: Vec<DVec2> = triangulation.neighbors(index).map(|(_, d)| d).collect();
            d.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
            d
        };
        let first = around(0);
        assert_eq!(first.len(), 6);
        for index in 1..points.len() {
            let all = around(index);
            assert!(all.iter().zip(&first).all(|(a, b)| (a - b).abs().max_element() < 1e-14));
        }
    }
}

#[test]
fn coincident_points_share_a_vertex() {
    let same = at(0.3, 0.4);
    let points = [same, at(0.8, 0.1), same, same];
    let mut triangulation = Triangulation::new(&set(&points));
    assert_eq!([0, 1, 2, 3].map(|i| triangulation.representative(i)), [0, 1, 0, 0]);
    assert_eq!((triangulation.vertex_count(), triangulation.point_count()), (2, 4));
    triangulation.remove(0);
    assert_eq!(triangulation.representative(2), triangulation.representative(3));
    assert_delaunay(&triangulation, &[(1, points[1]), (2, same), (3, same)]);
    triangulation.remove(2);
    triangulation.remove(3);
    assert_delaunay(&triangulation, &[(1, points[1])]);
}

#[test]
fn a_million_moves_leave_a_delaunay_triangulation() {
    // 64-bit grids of three sizes and full positions mix, so that ties are common.
    let n = 256;
    let mut rng = Seed::new(7).stream(1);
    let mut points = random_points(n, 7);
    let mut triangulation = Triangulation::new(&set(&points));
    for step in 0..1_000_000_u32 {
        let index = rng.random_range(0..n as u32) as usize;
        let p = match step % 4 {
            0 => {
                at(f64::from(rng.random_range(0..32_u32)), f64::from(rng.random_range(0..32_u32)))
                    / 32.0
            }
            _ => at(rng.random(), rng.random()),
        };
        triangulation.remove(index);
        triangulation.insert(index, p);
        points[index] = p;
    }
    assert_delaunay(&triangulation, &numbered(&points));
    let rebuilt = Triangulation::new(&set(&points));
    assert_eq!(canonical_faces(&triangulation), canonical_faces(&rebuilt));
}
