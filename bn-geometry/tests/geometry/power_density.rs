//! Power diagrams whose cells are measured by a density.

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::common::*;
use bn_core::{DVec2, DensityFunction, DensityIntegrals, torus};
use bn_geometry::*;

fn wave(p: DVec2) -> f64 {
    1.0 + 0.7 * (TAU * p.x).sin() * (TAU * p.y).cos()
}

fn weights(n: usize) -> Vec<f64> {
    (0..n).map(|i| (i % 7) as f64 * 1e-3).collect()
}

/// Masses and moments by the places in the middle of many small squares.
#[test]
fn cells_hold_the_mass_of_their_places() {
    let density = DensityFunction::from_fn(24, wave).expect("valid");
    let (points, weights) = (random_points(20, 3), weights(20));
    let mut diagram = PowerDiagram::of_density(Arc::new(DensityIntegrals::new(&density)));
    diagram.update(&set(&points), &weights);
    let side = 24_usize * 25;
    let mut sums = [(0.0, DVec2::ZERO, 0.0); 20];
    for i in 0..side * side {
        let x = at((i % side) as f64 + 0.5, (i / side) as f64 + 0.5) / side as f64;
        let power = |i: &usize| torus::distance_squared(x, points[*i]) - weights[*i];
        let owner = (0..20).min_by(|a, b| power(a).total_cmp(&power(b))).expect("points");
        let mass = density.at(x) / (side * side) as f64;
        let from = torus::delta(points[owner], x);
        sums[owner].0 += mass;
        sums[owner].1 += from * mass;
        sums[owner].2 += from.length_squared() * mass;
    }
    for (cell, (mass, first, second)) in diagram.cells().iter().zip(sums) {
        // Some 200 squares on a cell's border are right to half of their area each, at random.
        assert!((cell.area - mass).abs() < 1e-4, "{} instead of {mass}", cell.area);
        assert!((cell.to_centroid * cell.area - first).length() < 5e-5);
        assert!((cell.second_moment - second).abs() < 5e-5);
    }
    let all: f64 = diagram.cells().iter().map(|cell| cell.area).sum();
    assert!((all - 1.0).abs() < 1e-13, "{all}");
}

/// What Newton's method goes by: a weight moves the borders of its cell, and the mass that they sweep is
/// that of the edges.
#[test]
fn masses_change_by_the_mass_of_edges() {
    let density = DensityFunction::from_fn(200, wave).expect("valid");
    let density = Arc::new(DensityIntegrals::new(&density));
    let (points, base) = (set(&random_points(40, 5)), weights(40));
    let masses = |weights: &[f64]| {
        let mut diagram = PowerDiagram::of_density(Arc::clone(&density));
        diagram.update(&points, weights);
        diagram
    };
    let diagram = masses(&base);
    let step = 1e-7;
    for i in (0..40).filter(|&i| diagram.cells()[i].area > 0.0) {
        let changed = |by: f64| {
            let mut weights = base.clone();
            weights[i] += by;
            masses(&weights).cells()[i].area
        };
        let got = (changed(step) - changed(-step)) / (2.0 * step);
        let edges = diagram.edges(i).iter().filter(|edge| edge.neighbor.index as usize != i);
        let want: f64 = edges.map(|e| 0.5 * e.mass / e.neighbor.displacement.length()).sum();
        // Borders that lie along the pixels' sides jump by their differences, a hundredth.
        assert!((got / want - 1.0).abs() < 0.02, "{got} instead of {want}");
    }
}

#[test]
fn an_even_density_measures_areas() {
    let even = DensityFunction::from_fn(3, |_| 1.0).expect("valid");
    let (points, weights) = (set(&random_points(300, 5)), weights(300));
    let mut weighed = PowerDiagram::of_density(Arc::new(DensityIntegrals::new(&even)));
    weighed.update(&points, &weights);
    let plain = PowerDiagram::new(&points, &weights);
    for i in 0..300 {
        let (a, b) = (weighed.cells()[i], plain.cells()[i]);
        assert!((a.area - b.area).abs() < 1e-14);
        assert!((a.to_centroid - b.to_centroid).length() < 1e-10);
        assert!((a.second_moment - b.second_moment).abs() < 1e-14);
        for (a, b) in weighed.edges(i).iter().zip(plain.edges(i)) {
            assert!((a.mass - b.length).abs() < 1e-14 && a.neighbor == b.neighbor);
        }
    }
}

#[test]
fn masses_are_balanced() {
    let density = DensityFunction::from_fn(64, |p| 0.01 + wave(p).powi(2)).expect("valid");
    for n in [1, 2, 10, 1000] {
        let mut uniform = random_points(n, 9);
        for p in &mut uniform {
            *p = density.place(*p);
        }
        let mut balanced = BalancedDiagram::of_density(Arc::new(DensityIntegrals::new(&density)));
        let balance = balanced.balance(&set(&uniform), 1e-9, 100);
        assert!(balance.converged, "{balance:?}");
        for cell in balanced.diagram().cells() {
            assert!((cell.area * n as f64 - 1.0).abs() <= 1e-9);
        }
    }
}
