//! Finding regular patches, and breaking them up.

use bn_core::{DVec2, StreamRng, torus};
use bn_geometry::PowerDiagram;
use rand::RngExt;

/// n²·∫ |x − p|² over a regular hexagon of area 1/n: 5/(18√3).
pub(super) const HEXAGON: f64 = 0.160_375_074_774_896;

/// The most points that are thrown anywhere at a time.
const MOST_THROWN: usize = 100;

/// Points are shaken by up to this many times 1/√n.
const SHAKE: f64 = 0.5;

/// The points whose cells' second moments differ from those of the cells around by less than
/// `threshold` in the mean, in units of the regular hexagon's: cells of one shape.
pub(super) fn regular_points(diagram: &PowerDiagram, threshold: f64) -> Vec<usize> {
    let n = diagram.len() as f64;
    let moment = |i: usize| diagram.cells()[i].second_moment * (n * n / HEXAGON);
    let difference = |i: usize| {
        let edges = diagram.edges(i);
        let sum: f64 =
            edges.iter().map(|e| (moment(e.neighbor.index as usize) - moment(i)).abs()).sum();
        sum / edges.len() as f64
    };
    (0..diagram.len()).filter(|&i| difference(i) < threshold).collect()
}

/// Shakes the regular points and their neighbours, and throws some of the former anywhere.
pub(super) fn break_up(
    points: &mut [DVec2],
    diagram: &PowerDiagram,
    regular: &[usize],
    rng: &mut StreamRng,
) {
    let n = points.len();
    let neighbors = |&i: &usize| diagram.edges(i).iter().map(|e| e.neighbor.index as usize);
    let mut shaken: Vec<usize> = regular.iter().flat_map(neighbors).collect();
    shaken.extend(regular);
    shaken.sort_unstable();
    shaken.dedup();
    let radius = SHAKE / (n as f64).sqrt();
    for i in shaken {
        points[i] = torus::wrap_point(points[i] + in_unit_disk(rng) * radius);
    }
    let mut thrown = regular.to_vec();
    for k in 0..thrown.len().min(MOST_THROWN) {
        let other = rng.random_range(k as u32..thrown.len() as u32);
        thrown.swap(k, other as usize);
        points[thrown[k]] = DVec2::new(rng.random(), rng.random());
    }
}

/// A uniform point of the unit disk, by rejection: four draws in π hit.
fn in_unit_disk(rng: &mut StreamRng) -> DVec2 {
    loop {
        let p = 2.0 * DVec2::new(rng.random(), rng.random()) - 1.0;
        if p.length_squared() <= 1.0 {
            return p;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::{PointSet, Seed};

    /// 8 × 7 points, nearly hexagonal.
    fn lattice() -> PointSet {
        let place = |i: u32| {
            let (column, row) = (i % 7, i / 7);
            DVec2::new((f64::from(column) + f64::from(row % 2) / 2.0) / 7.0, f64::from(row) / 8.0)
        };
        PointSet::new((0..56).map(place).collect()).expect("valid")
    }

    #[test]
    fn all_of_a_lattice_is_regular() {
        let diagram = PowerDiagram::new(&lattice(), &[0.0; 56]);
        assert_eq!(regular_points(&diagram, 1e-9), (0..56).collect::<Vec<_>>());
        assert!(regular_points(&diagram, 0.0).is_empty());
    }

    #[test]
    fn a_dislodged_point_makes_its_surroundings_irregular() {
        let mut points = lattice().into_points();
        points[30] += DVec2::new(0.02, 0.01);
        let diagram = PowerDiagram::new(&PointSet::new(points).expect("valid"), &[0.0; 56]);
        let regular = regular_points(&diagram, 1e-3);
        assert!(!regular.contains(&30) && !regular.contains(&31));
        assert!(regular.contains(&0) && regular.len() > 20);
    }

    #[test]
    fn what_is_broken_up_moves_and_nothing_else() {
        let set = lattice();
        let diagram = PowerDiagram::new(&set, &[0.0; 56]);
        let mut points = set.points().to_vec();
        break_up(&mut points, &diagram, &[10], &mut Seed::new(1).stream(0));
        let moved: Vec<usize> = (0..56).filter(|&i| points[i] != set.points()[i]).collect();
        assert_eq!(moved.len(), 7, "the point and its six neighbours: {moved:?}");
        for i in moved.into_iter().filter(|&i| i != 10) {
            assert!(torus::distance(points[i], set.points()[i]) <= 0.5 / 56.0_f64.sqrt());
        }
        // More than can be thrown at a time.
        break_up(&mut points, &diagram, &(0..56).collect::<Vec<_>>(), &mut Seed::new(1).stream(1));
        assert!(points.iter().all(|p| torus::contains(*p)));
    }

    #[test]
    fn the_hexagon_has_its_moment() {
        assert!((HEXAGON - 5.0 / (18.0 * 3.0_f64.sqrt())).abs() < 1e-12);
    }
}
