//! Point sets that every test can make.

use bn_core::{DVec2, PointSet, Seed};
use rand::RngExt;

/// Independent uniform points.
pub fn random_set(n: usize, seed: u64) -> PointSet {
    let mut rng = Seed::new(seed).stream(0);
    PointSet::new((0..n).map(|_| DVec2::new(rng.random(), rng.random())).collect()).expect("a set")
}

/// One random point in each cell of an m × m grid.
pub fn jittered_set(m: usize, seed: u64) -> PointSet {
    let mut rng = Seed::new(seed).stream(0);
    let mut jitter = |i: usize| (i as f64 + rng.random::<f64>()) / m as f64;
    let points = (0..m * m).map(|i| DVec2::new(jitter(i % m), jitter(i / m)));
    PointSet::wrapped(points.collect()).expect("a set")
}
