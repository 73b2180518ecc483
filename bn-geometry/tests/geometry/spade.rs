//! The triangulation against spade's of 3 × 3 copies.

use std::collections::BTreeSet;

use crate::common::{at, canonical_face, canonical_faces, random_points, set};
use bn_core::{DVec2, Seed};
use bn_geometry::Triangulation;
use rand::RngExt;
use spade::{DelaunayTriangulation, Point2, Triangulation as _};

/// The faces of spade's triangulation that touch the middle copy, in the form of
/// [`canonical_faces`]. Far more than 9 points leave no hole that reaches beyond the outer copies.
fn spade_faces(places: &[DVec2]) -> BTreeSet<[[u64; 2]; 3]> {
    let shifts = (-1..=1).flat_map(|i| (-1..=1).map(move |j| at(f64::from(i), f64::from(j))));
    let copies = shifts.flat_map(|shift| places.iter().map(move |&p| p + shift));
    let points = copies.map(|p| Point2::new(p.x, p.y)).collect();
    let spade = DelaunayTriangulation::<Point2<f64>>::bulk_load(points).expect("valid points");
    let mut faces = BTreeSet::new();
    for face in spade.inner_faces() {
        let corners = face.positions().map(|p| at(p.x, p.y));
        if corners.iter().any(|&p| bn_core::torus::contains(p)) {
            faces.insert(canonical_face(corners));
        }
    }
    faces
}

#[test]
fn random_sets_have_spades_faces() {
    for (n, seed) in [(30, 1), (100, 2), (1000, 3), (5000, 4)] {
        let triangulation = Triangulation::new(&set(&random_points(n, seed)));
        let places: Vec<DVec2> = (0..n).map(|i| triangulation.position(i)).collect();
        let ours: BTreeSet<_> = canonical_faces(&triangulation).into_iter().collect();
        assert_eq!(ours.len(), 2 * n);
        assert_eq!(ours, spade_faces(&places), "{n} points");
    }
}

#[test]
fn moved_sets_have_spades_faces() {
    let n = 400;
    let mut rng = Seed::new(9).stream(0);
    let mut triangulation = Triangulation::new(&set(&random_points(n, 5)));
    for _ in 0..20_000 {
        let index = rng.random_range(0..n as u32) as usize;
        triangulation.remove(index);
        triangulation.insert(index, at(rng.random(), rng.random()));
    }
    let places: Vec<DVec2> = (0..n).map(|i| triangulation.position(i)).collect();
    let ours: BTreeSet<_> = canonical_faces(&triangulation).into_iter().collect();
    assert_eq!(ours, spade_faces(&places));
}
