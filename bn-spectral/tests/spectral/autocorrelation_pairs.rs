//! The autocorrelation image against all pairs over nine copies, and against independent points.

use bn_core::{DVec2, PointSet, Seed};
use bn_spectral::Autocorrelation;
use rand::RngExt as _;

fn random_set(n: usize, task: u32) -> PointSet {
    let mut rng = Seed::new(47).stream(task);
    let points = (0..n).map(|_| DVec2::new(rng.random(), rng.random())).collect();
    PointSet::new(points).expect("in the unit square")
}

/// Ordered pairs by cell, over all copies of the second point.
fn brute_force(set: &PointSet, half_width: f64, side: usize) -> Vec<f64> {
    let n = set.len() as f64;
    let cell_size = 2.0 * half_width / side as f64;
    let one = 1.0 / (n * (n - 1.0) * cell_size * cell_size);
    let mut g = vec![0.0; side * side];
    for (i, &p) in set.points().iter().enumerate() {
        for (j, &q) in set.points().iter().enumerate() {
            for copy in 0..9 {
                let shift = DVec2::new(f64::from(copy % 3 - 1), f64::from(copy / 3 - 1));
                let cell = (q + shift - p + half_width) / cell_size;
                let inside = cell.min_element() >= 0.0 && cell.max_element() < side as f64;
                if i != j && inside {
                    g[cell.y as usize * side + cell.x as usize] += one;
                }
            }
        }
    }
    g
}

#[test]
fn counts_every_pair_once() {
    for (n, half_width, side) in [(2, 0.5, 4), (40, 0.5, 7), (90, 0.21, 16), (200, 0.05, 9)] {
        let set = random_set(n, n as u32);
        let got = Autocorrelation::of(std::slice::from_ref(&set), half_width, side);
        let want = brute_force(&set, half_width, side);
        assert_eq!((got.half_width(), got.side()), (half_width, side));
        for (i, (g, w)) in got.values().iter().zip(&want).enumerate() {
            assert!((g - w).abs() < 1e-9 * (1.0 + w), "n = {n}, cell {i}: {g}, not {w}");
        }
    }
}

#[test]
fn is_symmetric_and_one_for_independent_points() {
    let (n, sets, side) = (2000, 5, 15);
    let ensemble: Vec<_> = (0..sets).map(|i| random_set(n, 100 + i)).collect();
    let image = Autocorrelation::of(&ensemble, 0.1, side);
    let last = side * side - 1;
    // Unordered pairs are pairwise independent: c/2 of the c ordered ones of a cell and its mirror
    // image, so a relative variance of 2/c.
    let area = (0.2 / side as f64).powi(2);
    let expected = f64::from(sets) * (n * (n - 1)) as f64 * area;
    let sd = (1.0 / expected).sqrt();
    for i in 0..=last {
        let g = image.values()[i];
        assert!((g - image.values()[last - i]).abs() < 1e-12);
        // The middle cell is its own image.
        let sd = if 2 * i == last { sd * 2_f64.sqrt() } else { sd };
        assert!((g - 1.0).abs() < 5.0 * sd, "cell {i}: {g}, sd {sd}");
    }
}

#[test]
fn over_the_whole_torus_the_mean_is_one() {
    for n in [2, 3, 50] {
        let image = Autocorrelation::of(&[random_set(n, 200)], 0.5, 12);
        let mean = image.values().iter().sum::<f64>() / 144.0;
        assert!((mean - 1.0).abs() < 1e-12, "n = {n}: {mean}");
    }
}

#[test]
fn a_lattice_shows_its_vectors() {
    let m = 10;
    let points =
        (0..m * m).map(|i| DVec2::new(f64::from(i % m), f64::from(i / m)) / f64::from(m)).collect();
    let set = PointSet::new(points).expect("in the unit square");
    // 21 cells of 0.05·20/21: the lattice vectors lie well inside cells.
    let image = Autocorrelation::of(&[set], 0.25, 21);
    let occupied = image.values().iter().filter(|&&g| g > 0.0).count();
    // 5 × 5 vectors of −0.2 … 0.2, the middle one left out.
    assert_eq!(occupied, 24);
    let total: f64 = image.values().iter().sum();
    let area = (0.5_f64 / 21.0).powi(2);
    assert!((total - 24.0 * 100.0 / (100.0 * 99.0 * area)).abs() < 1e-9 * total);
}

#[test]
fn degenerate_sets_are_ordinary() {
    let one = PointSet::new(vec![DVec2::new(0.5, 0.5)]).expect("valid");
    assert!(Autocorrelation::of(&[one], 0.2, 3).values().iter().all(|&g| g == 1.0));
    let same = PointSet::new(vec![DVec2::new(0.999, 0.001); 50]).expect("valid");
    let image = Autocorrelation::of(&[same], 0.2, 3);
    let area = (0.4_f64 / 3.0).powi(2);
    assert!((image.values()[4] * area - 1.0).abs() < 1e-12);
    // Half a period apart: ±½ is one displacement, and has to be counted for both ordered pairs.
    let opposite = PointSet::new(vec![DVec2::new(0.0, 0.25), DVec2::new(0.5, 0.25)]);
    let image = Autocorrelation::of(&[opposite.expect("valid")], 0.5, 4);
    assert!((image.values().iter().sum::<f64>() / 16.0 - 1.0).abs() < 1e-12);
}
