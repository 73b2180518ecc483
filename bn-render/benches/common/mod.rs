//! Inputs of all benches.

use bn_core::{DVec2, PointSet, Seed};
use bn_render::Frame;
use rand::RngExt;

/// One random point in each cell of an m × m grid.
pub fn jittered(m: u32) -> PointSet {
    let mut rng = Seed::new(1).stream(0);
    let mut jitter = |i: u32| (f64::from(i) + rng.random::<f64>()) / f64::from(m);
    let points = (0..m * m).map(|i| DVec2::new(jitter(i % m), jitter(i / m)));
    PointSet::wrapped(points.collect()).expect("valid points")
}

pub fn frame(width: u32, height: u32) -> Frame {
    Frame::new(width, height).expect("a size")
}
