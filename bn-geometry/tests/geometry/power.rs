//! Power diagrams against brute force and closed forms, whatever the points and weights.

use crate::common::*;
use bn_core::{DVec2, Seed};
use bn_geometry::*;
use proptest::prelude::*;
use rand::RngExt;

/// Points and weights: none, next to none, as large as squared distances, so large that most
/// points are hidden, a few heavy ones.
fn weighted_family() -> impl Strategy<Value = (Vec<DVec2>, Vec<f64>)> {
    (point_family(), 0..6_usize, any::<u64>()).prop_map(|(points, family, seed)| {
        let mut rng = Seed::new(seed).stream(1);
        let n = points.len() as f64;
        let mut weight = |_| match family {
            0 => 0.0,
            1 => 1e-17 * rng.random::<f64>(),
            2 => 0.2 / n * rng.random::<f64>(),
            3 => 2.0 / n * rng.random::<f64>(),
            4 => f64::from(rng.random_range(0..3_u32)) * 0.25,
            _ => {
                if rng.random::<f64>() < 0.1 {
                    1e3
                } else {
                    -1e-300
                }
            }
        };
        let weights = (0..points.len()).map(&mut weight).collect();
        (points, weights)
    })
}

/// Whether another point at the same place has the cell of point `index`.
fn is_covered(points: &[DVec2], weights: &[f64], index: usize) -> bool {
    (0..points.len()).any(|j| {
        let comes_first = (weights[j], index) > (weights[index], j);
        points[j] == points[index] && j != index && comes_first
    })
}

/// That every edge has its mate, seen from the other cell, but for edges that rounding decides on.
fn assert_symmetric(diagram: &PowerDiagram, tolerance: f64) {
    // Next to nothing, a cell may be hidden for one neighbour and not for another.
    let is_cell = |i: usize| diagram.cells()[i].area > 1e-13;
    for i in (0..diagram.len()).filter(|&i| is_cell(i)) {
        for edge in diagram.edges(i).iter().filter(|edge| edge.length > tolerance) {
            if !is_cell(edge.neighbor.index as usize) {
                continue;
            }
            let mates = diagram.edges(edge.neighbor.index as usize);
            let is_mate = |mate: &&PowerEdge| {
                mate.neighbor.index as usize == i
                    && mate.neighbor.displacement == -edge.neighbor.displacement
            };
            let Some(mate) = mates.iter().find(is_mate) else {
                // The bisector with a point that is just hidden may be the same line.
                let is_hidden = |mate: &PowerEdge| !is_cell(mate.neighbor.index as usize);
                assert!(mates.iter().any(is_hidden), "{edge:?} of {i} has no mate");
                continue;
            };
            // Displacements are rounded to 1e-16; neighbours close together turn that into an angle.
            assert!((mate.length - edge.length).abs() < tolerance, "{edge:?} of {i} and {mate:?}");
        }
    }
}

/// The least distance of two points, at most 1.
fn least_distance(points: &[DVec2]) -> f64 {
    let pairs = (0..points.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
    let distances = pairs.map(|(i, j)| bn_core::torus::distance(points[i], points[j]));
    distances.fold(1.0, f64::min)
}

fn total_area(diagram: &PowerDiagram) -> f64 {
    diagram.cells().iter().map(|cell| cell.area).sum()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn cells_are_what_all_bisectors_leave((points, weights) in weighted_family()) {
        let diagram = PowerDiagram::new(&set(&points), &weights);
        for (index, cell) in diagram.cells().iter().enumerate() {
            if is_covered(&points, &weights, index) {
                prop_assert_eq!(*cell, VoronoiCell::EMPTY);
                prop_assert!(diagram.edges(index).is_empty());
                continue;
            }
            let (area, first, second) = moments(&clipped_cell(&points, &weights, index));
            prop_assert!((cell.area - area).abs() < 1e-13, "area {}, clipped {area}", cell.area);
            prop_assert!((cell.to_centroid * cell.area - first).length() < 1e-13);
            prop_assert!((cell.second_moment - second).abs() < 1e-13);
            let corners: Vec<DVec2> = diagram.edges(index).iter().map(|e| e.corner).collect();
            let (by_corners, _, _) = moments(&corners);
            prop_assert!((by_corners - cell.area).abs() < 1e-13);
        }
        let sum = total_area(&diagram);
        prop_assert!((sum - 1.0).abs() < 1e-14 * points.len() as f64, "areas sum to {sum}");
        // Of neighbours at about the same place either may be the one that cuts.
        let least = least_distance(&points);
        if least > 1e-9 {
            assert_symmetric(&diagram, 1e-13 + 1e-15 / least);
        }
    }

    #[test]
    fn updates_leave_no_trace(
        (points, weights) in weighted_family(), (others, other_weights) in weighted_family()
    ) {
        let mut diagram = PowerDiagram::new(&set(&others), &other_weights);
        diagram.update(&set(&points), &weights);
        let fresh = PowerDiagram::new(&set(&points), &weights);
        for (a, b) in diagram.cells().iter().zip(fresh.cells()) {
            prop_assert!((a.area - b.area).abs() < 1e-14);
            prop_assert!((a.second_moment - b.second_moment).abs() < 1e-14);
        }
        prop_assert_eq!(diagram.len(), points.len());
    }

    #[test]
    fn only_differences_of_weights_matter((points, weights) in weighted_family()) {
        let mut apart: Vec<usize> = (0..points.len()).collect();
        apart.retain(|&i| !points[..i].contains(&points[i]));
        let points: Vec<DVec2> = apart.iter().map(|&i| points[i]).collect();
        let weights: Vec<f64> = apart.iter().map(|&i| weights[i]).collect();
        let raised: Vec<f64> = weights.iter().map(|w| w + 0.5).collect();
        let here = PowerDiagram::new(&set(&points), &weights);
        let there = PowerDiagram::new(&set(&points), &raised);
        let least = least_distance(&points);
        // The rounding of weights moves bisectors by 1e-16 over the distance.
        let tolerance = 1e-13 + 1e-15 / least;
        for (a, b) in here.cells().iter().zip(there.cells()) {
            prop_assert!((a.area - b.area).abs() < tolerance, "{} and {}", a.area, b.area);
        }
    }
}

#[test]
fn equal_weights_give_voronoi_cells() {
    for (points, weight) in [
        (random_points(2000, 1), 0.0),
        (random_points(300, 2), -7.25),
        (lattice(16, 16, 0.0), 1.0),
        (lattice(7, 8, 0.5), 0.25),
        (lattice(1, 1, 0.0), 0.0),
        (lattice(2, 1, 0.0), 0.0),
        (lattice(3, 1, 0.0), 0.5),
    ] {
        let set = set(&points);
        let diagram = PowerDiagram::new(&set, &vec![weight; points.len()]);
        let voronoi = voronoi_cells(&Triangulation::new(&set));
        for (power, voronoi) in diagram.cells().iter().zip(voronoi) {
            // The triangulation moves points to multiples of 2⁻⁵⁰.
            assert!((power.area - voronoi.area).abs() < 2e-15);
            assert!((power.to_centroid - voronoi.to_centroid).length() < 2e-14);
            assert!((power.second_moment - voronoi.second_moment).abs() < 2e-15);
        }
        assert_symmetric(&diagram, 1e-13);
    }
}

#[test]
fn one_point_has_all_whatever_its_weight() {
    for weight in [0.0, 1e300, -1e300, 5e-324] {
        let diagram = PowerDiagram::new(&set(&[at(0.99, 0.0)]), &[weight]);
        let cell = diagram.cells()[0];
        assert_eq!((cell.area, cell.to_centroid), (1.0, DVec2::ZERO));
        assert!((cell.second_moment - 1.0 / 6.0).abs() < 1e-15);
        assert_eq!(diagram.edges(0).len(), 4);
        assert!(diagram.edges(0).iter().all(|edge| edge.neighbor.index == 0));
    }
}

#[test]
fn heavy_points_hide_light_ones() {
    // The strip between two points at distance ½ is w/½ wider for the heavier one: all at w = ¼.
    let pair = set(&[at(0.1, 0.3), at(0.6, 0.3)]);
    for (weight, area) in [(0.0, 0.5), (0.125, 0.75), (0.2, 0.9), (0.25, 1.0), (4.0, 1.0)] {
        let diagram = PowerDiagram::new(&pair, &[weight, 0.0]);
        assert!((diagram.cells()[0].area - area).abs() < 1e-15, "weight {weight}");
        assert!((diagram.cells()[1].area - (1.0 - area)).abs() < 1e-15, "weight {weight}");
        assert_eq!(diagram.edges(1).is_empty(), area == 1.0);
    }
    // Ten points with a weight beyond reach of the others leave nothing to these.
    let points = random_points(200, 5);
    let weights: Vec<f64> = (0..200).map(|i| if i < 10 { 2.0 } else { 0.0 }).collect();
    let diagram = PowerDiagram::new(&set(&points), &weights);
    assert!(diagram.cells()[10..].iter().all(|cell| *cell == VoronoiCell::EMPTY));
    let heavy = PowerDiagram::new(&set(&points[..10]), &[0.0; 10]);
    for (a, b) in diagram.cells().iter().zip(heavy.cells()) {
        assert!((a.area - b.area).abs() < 1e-14);
    }
}

#[test]
fn coincident_points_have_one_cell() {
    let points = [at(0.5, 0.5); 4];
    for (weights, owner) in [([0.0; 4], 0), ([0.0, 1e-300, 0.0, 0.0], 1), ([0.0, 0.0, 2.0, 2.0], 2)]
    {
        let diagram = PowerDiagram::new(&set(&points), &weights);
        for (i, cell) in diagram.cells().iter().enumerate() {
            assert_eq!(cell.area, if i == owner { 1.0 } else { 0.0 });
        }
    }
}

#[test]
fn next_to_coincident_points_share_fairly() {
    // 1e-300 and even 5e-324 apart, the bisector still runs between them.
    for gap in [1e-16, 1e-300, 5e-324] {
        let diagram = PowerDiagram::new(&set(&[at(0.0, 0.5), at(gap, 0.5)]), &[0.0; 2]);
        for cell in diagram.cells() {
            assert!((cell.area - 0.5).abs() < 1e-15, "{} at {gap:e}", cell.area);
        }
    }
}

#[test]
fn areas_change_by_edges() {
    // ∂Aᵢ/∂wⱼ = −length/(2 distance): the Hessian of the weight solve.
    let points = set(&random_points(40, 8));
    let mut rng = Seed::new(9).stream(0);
    let weights: Vec<f64> = (0..40).map(|_| 4e-3 * rng.random::<f64>()).collect();
    let diagram = PowerDiagram::new(&points, &weights);
    let step = 1e-6;
    for j in 0..40 {
        let area_at = |step: f64| {
            let mut moved = weights.clone();
            moved[j] += step;
            PowerDiagram::new(&points, &moved).cells().iter().map(|c| c.area).collect::<Vec<_>>()
        };
        let (above, below) = (area_at(step), area_at(-step));
        for i in (0..40).filter(|&i| i != j) {
            let edges = diagram.edges(i).iter().filter(|edge| edge.neighbor.index as usize == j);
            let slope: f64 =
                edges.map(|e| e.length / (2.0 * e.neighbor.displacement.length())).sum();
            let measured = (above[i] - below[i]) / (2.0 * step);
            // Areas are quadratic in the weights as long as no edge comes or goes.
            assert!((measured + slope).abs() < 1e-4 * (1.0 + slope), "{measured} for {slope}");
        }
    }
}

#[test]
fn large_sets_are_the_same_on_any_number_of_threads() {
    let points = set(&random_points(5000, 4));
    let mut rng = Seed::new(2).stream(0);
    let weights: Vec<f64> = (0..5000).map(|_| 3e-4 * rng.random::<f64>()).collect();
    let on_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| PowerDiagram::new(&points, &weights))
    };
    let (one, two) = (on_threads(1), on_threads(2));
    assert_eq!(one.cells(), two.cells());
    assert!((0..5000).all(|i| one.edges(i) == two.edges(i)));
    assert!((total_area(&one) - 1.0).abs() < 1e-12);
    let hidden = one.cells().iter().filter(|cell| cell.area == 0.0).count();
    assert!((100..4000).contains(&hidden), "{hidden} hidden");
    assert_symmetric(&one, 1e-11);
}

#[test]
fn crowds_are_no_trouble() {
    let points: Vec<DVec2> =
        random_points(1500, 6).iter().map(|p| at(0.7, 0.2) + *p * 1e-3).collect();
    let diagram = PowerDiagram::new(&set(&points), &vec![0.0; 1500]);
    assert!((total_area(&diagram) - 1.0).abs() < 1e-11);
}

#[test]
#[should_panic(expected = "one weight for each point")]
fn a_weight_too_few_is_a_slip() {
    PowerDiagram::new(&set(&[at(0.5, 0.5)]), &[]);
}
