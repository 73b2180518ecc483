//! The plain renderer that the fast one is held against: nested loops straight from the
//! definitions.

use bn_core::{DVec2, PointSet};
use bn_render::{Kernel, Normalization, Scene};

/// All pixels of channel `channel`, in f64; NaN where no sample has weight.
pub fn nested_loops(
    scene: &dyn Scene,
    set: &PointSet,
    spp: f64,
    kernel: &dyn Kernel,
    normalization: Normalization,
    (width, height): (u32, u32),
    channel: usize,
) -> Vec<f64> {
    let side = (set.len() as f64 / spp).sqrt();
    let radius = kernel.radius();
    let pixels = (width * height) as usize;
    let (mut sums, mut weights) = (vec![0.0; pixels], vec![0.0; pixels]);
    let tiles = |length: u32| {
        let reach = (radius / side).ceil() as i64 + 1;
        -reach..(f64::from(length) / side) as i64 + reach + 1
    };
    for b in tiles(height) {
        for a in tiles(width) {
            for p in set.points() {
                let at = DVec2::new((a as f64 + p.x) * side, (b as f64 + p.y) * side);
                let near = |x: f64, length: u32| {
                    let first = (x - radius - 1.5).floor().max(0.0) as u32;
                    first..((x + radius + 1.5).ceil().max(0.0) as u32).min(length)
                };
                let (columns, rows) = (near(at.x, width), near(at.y, height));
                if columns.is_empty() || rows.is_empty() {
                    continue;
                }
                let value = scene.value(at)[channel];
                for j in rows {
                    let wy = kernel.value(f64::from(j) + 0.5 - at.y);
                    for i in columns.clone() {
                        let w = wy * kernel.value(f64::from(i) + 0.5 - at.x);
                        sums[(j * width + i) as usize] += w * value;
                        weights[(j * width + i) as usize] += w;
                    }
                }
            }
        }
    }
    let scale = 1.0 / (spp * kernel.integral().powi(2));
    sums.into_iter()
        .zip(weights)
        .map(|(sum, weight)| match normalization {
            Normalization::Density if weight == 0.0 => f64::NAN,
            Normalization::Density => sum / weight,
            Normalization::None => sum * scale,
        })
        .collect()
}
