//! Weights that give all cells the same area.

use crate::common::*;
use bn_core::{DVec2, PointSet, Seed};
use bn_geometry::*;
use proptest::prelude::*;
use rand::RngExt;

/// The dual function that balanced weights maximise: Σ ∫ (|x − pᵢ|² − wᵢ) + Σ wᵢ/n.
fn dual(set: &PointSet, weights: &[f64]) -> f64 {
    let n = set.len() as f64;
    let diagram = PowerDiagram::new(set, weights);
    let lacks = diagram.cells().iter().zip(weights).map(|(cell, w)| w * (1.0 / n - cell.area));
    diagram.transport_cost() + lacks.sum::<f64>()
}

fn assert_balanced(balanced: &BalancedDiagram, tolerance: f64) {
    let n = balanced.diagram().len() as f64;
    for cell in balanced.diagram().cells() {
        assert!((cell.area * n - 1.0).abs() <= tolerance, "area {} of {n} cells", cell.area);
    }
    let mean: f64 = balanced.weights().iter().sum::<f64>() / n;
    assert!(mean.abs() < 1e-15, "weights of mean {mean}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn any_points_that_are_apart_can_be_balanced(points in point_family(), seed in any::<u64>()) {
        let mut apart: Vec<DVec2> = Vec::new();
        for p in points {
            if apart.iter().all(|q| bn_core::torus::distance(p, *q) > 1e-6) {
                apart.push(p);
            }
        }
        let set = set(&apart);
        let mut balanced = BalancedDiagram::default();
        let balance = balanced.balance(&set, 1e-9, 200);
        prop_assert!(balance.converged, "{balance:?}");
        assert_balanced(&balanced, 1e-9);
        let best = dual(&set, balanced.weights());
        // What the areas lack still, times the weights.
        prop_assert!((best - balanced.diagram().transport_cost()).abs() < 1e-9);
        let mut rng = Seed::new(seed).stream(0);
        for size in [1e-6, 1e-3, 0.3] {
            let other: Vec<f64> =
                balanced.weights().iter().map(|w| w + size * (rng.random::<f64>() - 0.5)).collect();
            prop_assert!(dual(&set, &other) <= best + 1e-9 * size + 1e-14, "{size}");
        }
    }
}

#[test]
fn large_random_sets_can_be_balanced() {
    for (n, seed) in [(100, 1), (1000, 2), (4096, 3), (10_000, 4)] {
        let set = set(&random_points(n, seed));
        let mut balanced = BalancedDiagram::default();
        let balance = balanced.balance(&set, 1e-9, 50);
        assert!(balance.converged && balance.steps < 15, "{balance:?}");
        assert_balanced(&balanced, 1e-9);
        // Warm: nothing to do.
        assert_eq!(balanced.balance(&set, 1e-8, 50).steps, 0);
    }
}

#[test]
fn a_small_move_takes_two_steps() {
    let points = random_points(1000, 7);
    let mut balanced = BalancedDiagram::default();
    assert!(balanced.balance(&set(&points), 1e-6, 50).converged);
    let mut rng = Seed::new(1).stream(0);
    let mut nudge = || (at(rng.random(), rng.random()) - 0.5) * 2e-5;
    let moved: Vec<DVec2> =
        points.iter().map(|p| bn_core::torus::wrap_point(*p + nudge())).collect();
    let balance = balanced.balance(&set(&moved), 1e-6, 50);
    assert!(balance.converged && balance.steps <= 3, "{balance:?}");
}

#[test]
fn lattices_are_balanced_as_they_are() {
    for (columns, rows, slant) in [(1, 1, 0.0), (2, 1, 0.0), (3, 1, 0.0), (2, 2, 0.0), (8, 7, 0.5)]
    {
        let mut balanced = BalancedDiagram::default();
        let balance = balanced.balance(&set(&lattice(columns, rows, slant)), 1e-12, 10);
        assert!(balance.converged && balance.steps == 0, "{balance:?}");
    }
}

#[test]
fn two_points_in_closed_form() {
    // Two strips: each bisector lies where the strips are ½ wide.
    let set = set(&[at(0.2, 0.5), at(0.3, 0.5)]);
    let mut balanced = BalancedDiagram::default();
    assert!(balanced.balance(&set, 1e-13, 50).converged);
    for (cell, sign) in balanced.diagram().cells().iter().zip([1.0, -1.0]) {
        assert!((cell.area - 0.5).abs() < 1e-14);
        // The points are symmetric about x = ¼, so the weights are equal.
        assert!((cell.to_centroid - at(-0.2 * sign, 0.0)).length() < 1e-14);
    }
    let difference = balanced.weights()[0] - balanced.weights()[1];
    assert!(difference.abs() < 1e-14);
}

#[test]
fn coincident_points_cannot_be_balanced() {
    let mut balanced = BalancedDiagram::default();
    for points in [vec![at(0.5, 0.5); 3], vec![at(0.1, 0.1), at(0.1, 0.1), at(0.6, 0.7)]] {
        let balance = balanced.balance(&set(&points), 1e-9, 50);
        assert!(!balance.converged && balance.residual >= 1.0, "{balance:?}");
    }
    // The next set of points doesn't suffer.
    assert!(balanced.balance(&set(&random_points(30, 1)), 1e-9, 50).converged);
}

#[test]
fn impossible_tolerances_end() {
    let set = set(&random_points(500, 1));
    let balance = BalancedDiagram::default().balance(&set, 0.0, 100);
    assert!(!balance.converged && balance.residual < 1e-11, "{balance:?}");
    let none = BalancedDiagram::default().balance(&set, 1e-9, 0);
    assert!(!none.converged && none.steps == 0);
}

#[test]
fn balancing_is_the_same_on_any_number_of_threads() {
    let points = set(&random_points(35_000, 4));
    let on_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let mut balanced = BalancedDiagram::default();
            balanced.balance(&points, 1e-2, 1);
            balanced.weights().to_vec()
        })
    };
    assert_eq!(on_threads(1), on_threads(2));
}
