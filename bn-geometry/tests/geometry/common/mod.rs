//! Point sets that geometry trips over, and the brute force that judges it.

use bn_core::{DVec2, PointSet, Seed, StreamRng, torus};
use bn_geometry::Triangulation;
use proptest::prelude::*;
use rand::{Rng, RngExt};

pub fn at(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

pub fn set(points: &[DVec2]) -> PointSet {
    PointSet::new(points.to_vec()).expect("points of the unit square")
}

pub fn random_points(n: usize, seed: u64) -> Vec<DVec2> {
    let mut rng = Seed::new(seed).stream(0);
    (0..n).map(|_| at(rng.random(), rng.random())).collect()
}

/// Points (i·a + j·b)/m modulo 1: every family of lattices, with many cocircular points.
pub fn lattice(columns: usize, rows: usize, slant: f64) -> Vec<DVec2> {
    let cell = |i: usize, j: usize| {
        at((i as f64 + slant * j as f64) / columns as f64, j as f64 / rows as f64)
    };
    (0..rows).flat_map(|j| (0..columns).map(move |i| torus::wrap_point(cell(i, j)))).collect()
}

/// One to forty points of a random family: in general position, on coarse grids (cocircular,
/// collinear and coincident), on lines, on a circle, at the seam, nearly coincident, clustered.
pub fn point_family() -> impl Strategy<Value = Vec<DVec2>> {
    let family = 0..FAMILIES.len();
    let n = prop_oneof![1_usize..=6, 1_usize..=40];
    (family, n, any::<u64>()).prop_map(|(family, n, seed)| {
        let mut rng = Seed::new(seed).stream(0);
        (0..n).map(|i| FAMILIES[family](i, n, &mut rng)).collect()
    })
}

type Family = fn(usize, usize, &mut StreamRng) -> DVec2;

const FAMILIES: &[Family] = &[
    |_, _, rng| at(rng.random(), rng.random()),
    |_, _, rng| on_grid(4, rng),
    |_, _, rng| on_grid(8, rng),
    |_, _, rng| on_grid(64, rng),
    |i, n, _| at(i as f64 / n as f64, 0.5),
    |i, n, _| at(0.0, i as f64 / n as f64),
    |i, n, _| at(i as f64 / n as f64, i as f64 / n as f64),
    |_, _, rng| at(f64::from(rng.random_range(0..16_u32)) / 16.0, 0.25),
    |_, _, rng| {
        let x = rng.random::<f64>();
        at(x, torus::wrap(2.0 * x))
    },
    |_, _, rng| on_circle(rng),
    |_, _, rng| at(*pick(&SEAM, rng), *pick(&SEAM, rng)),
    |_, _, rng| at(*pick(&SEAM, rng), rng.random()),
    |_, _, rng| at(0.5 + pick(&TINY, rng), 0.25 + pick(&TINY, rng)),
    |_, _, rng| at(*pick(&TINY, rng), *pick(&TINY, rng)),
    |_, _, rng| on_grid(4, rng) + at(*pick(&TINY, rng), *pick(&TINY, rng)),
    |_, _, rng| at(0.3, 0.9) + at(rng.random(), rng.random()) * 1e-3,
    |_, _, rng| at(0.3, 0.9) + at(rng.random(), rng.random()) * 1e-14,
    |_, _, _| at(0.125, 0.7),
];

const SEAM: [f64; 6] = [0.0, -0.0, 1e-300, torus::ONE_MINUS_EPSILON, 0.5, 1.0 - 1e-15];
const TINY: [f64; 7] = [0.0, 1e-300, 2e-300, 1e-17, 1e-16, 8.9e-16, 1e-15];

fn pick<'a, T>(of: &'a [T], rng: &mut StreamRng) -> &'a T {
    &of[rng.random_range(0..of.len() as u32) as usize]
}

fn on_grid(side: u32, rng: &mut StreamRng) -> DVec2 {
    let mut coordinate = || f64::from(rng.random_range(0..side)) / f64::from(side);
    at(coordinate(), coordinate())
}

fn on_circle(rng: &mut StreamRng) -> DVec2 {
    let (x, y) = *pick(&[(5, 0), (4, 3), (3, 4), (0, 5)], rng);
    let sign = rng.next_u32();
    let (x, y) = (if sign & 1 == 0 { x } else { -x }, if sign & 2 == 0 { y } else { -y });
    at(0.5 + f64::from(x) / 16.0, 0.5 + f64::from(y) / 16.0)
}

/// Judges a triangulation of the points without trusting any of its own predicates: places, Euler
/// counts, positive areas that sum to 1, and no copy of a point inside the circle of a face.
pub fn assert_delaunay(triangulation: &Triangulation, points: &[(usize, DVec2)]) {
    triangulation.sanity_check();
    let mut places: Vec<DVec2> = Vec::new();
    for &(index, p) in points {
        let q = triangulation.position(index);
        assert!(torus::delta(p, q).abs().max_element() <= 0.5_f64.powi(51), "{p} became {q}");
        places.push(q);
    }
    places.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    places.dedup();
    assert_eq!(triangulation.point_count(), points.len());
    assert_eq!(triangulation.vertex_count(), places.len());
    assert_eq!(triangulation.faces().count(), 2 * places.len());
    let mut area = 0.0;
    for face in triangulation.faces() {
        let [a, b, c] = face.corners.map(|p| robust::Coord { x: p.x, y: p.y });
        let orientation = robust::orient2d(a, b, c);
        assert!(orientation > 0.0, "{face:?} turns clockwise");
        area += 0.5 * orientation;
        for q in copies(&places) {
            let inside = robust::incircle(a, b, c, robust::Coord { x: q.x, y: q.y });
            assert!(inside <= 0.0, "{q} lies inside the circle of {face:?}");
        }
    }
    assert!((area - 1.0).abs() < 1e-13 || places.is_empty(), "the faces cover {area}");
}

/// The 5 × 5 copies of points in [−2, 3)².
pub fn copies(points: &[DVec2]) -> impl Iterator<Item = DVec2> {
    let shifts = (-2..=2).flat_map(|i| (-2..=2).map(move |j| at(f64::from(i), f64::from(j))));
    shifts.flat_map(move |shift| points.iter().map(move |&p| p + shift))
}

/// The faces as places of corners, in an order and in frames that depend on the point set alone.
pub fn canonical_faces(triangulation: &Triangulation) -> Vec<[[u64; 2]; 3]> {
    let mut faces: Vec<_> = triangulation.faces().map(|f| canonical_face(f.corners)).collect();
    faces.sort_unstable();
    faces
}

/// The bits of a face's corners, from that corner and in that copy which make them least.
pub fn canonical_face(corners: [DVec2; 3]) -> [[u64; 2]; 3] {
    let turned = |first: usize| {
        let p = [0, 1, 2].map(|i| corners[(first + i) % 3]);
        let home = torus::wrap_point(p[0]) - p[0];
        // Adding 0 makes −0 into 0.
        p.map(|q| [(q.x + home.x + 0.0).to_bits(), (q.y + home.y + 0.0).to_bits()])
    };
    [turned(0), turned(1), turned(2)].into_iter().min().expect("three corners")
}

/// The cell of a point in the power diagram, about the point: cut out of a large square by the
/// bisectors to all copies of all points.
pub fn clipped_cell(points: &[DVec2], weights: &[f64], index: usize) -> Vec<DVec2> {
    let mut cell = vec![at(-1.5, -1.5), at(1.5, -1.5), at(1.5, 1.5), at(-1.5, 1.5)];
    for (k, q) in copies(points).enumerate() {
        let d = q - points[index];
        if d == DVec2::ZERO {
            continue;
        }
        let offset = 0.5 * (d.length_squared() + (weights[index] - weights[k % points.len()]));
        let beyond = |x: DVec2| x.dot(d) - offset;
        let mut kept = Vec::new();
        for (i, &a) in cell.iter().enumerate() {
            let b = cell[(i + 1) % cell.len()];
            if beyond(a) <= 0.0 {
                kept.push(a);
            }
            if (beyond(a) < 0.0) != (beyond(b) < 0.0) && beyond(a) != beyond(b) {
                kept.push(a + (b - a) * (beyond(a) / (beyond(a) - beyond(b))));
            }
        }
        cell = kept;
    }
    cell
}

/// Area, first moment and second moment of a polygon about the origin.
pub fn moments(polygon: &[DVec2]) -> (f64, DVec2, f64) {
    let (mut area, mut first, mut second) = (0.0, DVec2::ZERO, 0.0);
    for (i, &a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let part = 0.5 * a.perp_dot(b);
        area += part;
        first += (a + b) * (part / 3.0);
        second += part / 6.0 * (a.length_squared() + a.dot(b) + b.length_squared());
    }
    (area, first, second)
}
