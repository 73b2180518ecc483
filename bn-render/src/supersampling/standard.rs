//! The patterns of the thesis's figures 3.2 and 3.3.

use bn_core::DVec2;

use super::{Supersampling, Tap};

/// The names of the standard patterns, in the order of the thesis's figures.
///
/// | name | n | m | taps |
/// |---|---|---|---|
/// | `none` | 1 | 1 | the pixel's centre |
/// | `lanczos2` | 16 | 289 | a grid of spacing ¼ over ±2 pixels, Lanczos-2 weights |
/// | `quincunx` | 2 | 5 | centre (½) and corners (⅛ each) |
/// | `grid-2x2` | 4 | 4 | (±¼, ±¼) |
/// | `rotated-grid` | 4 | 4 | (⅛, ⅜) and its quarter turns |
/// | `grid-4x4-box` | 16 | 16 | (±⅛ or ±⅜, ±⅛ or ±⅜), equal weights |
/// | `grid-4x4-lanczos2` | 16 | 16 | the same with Lanczos-2 weights |
pub const SUPERSAMPLING: &[&str] = &[
    "none",
    "lanczos2",
    "quincunx",
    "grid-2x2",
    "rotated-grid",
    "grid-4x4-box",
    "grid-4x4-lanczos2",
];

/// The standard pattern of this name.
pub fn supersampling(name: &str) -> Option<Supersampling> {
    let taps = match name {
        "none" => vec![tap(0.0, 0.0, 1.0)],
        "lanczos2" => grid(&quarters(-8..=8), lanczos2),
        "quincunx" => quincunx(),
        "grid-2x2" => grid(&[-0.25, 0.25], |_| 1.0),
        "rotated-grid" => [(0.125, 0.375), (-0.375, 0.125), (-0.125, -0.375), (0.375, -0.125)]
            .map(|(x, y)| tap(x, y, 1.0))
            .to_vec(),
        "grid-4x4-box" => grid(&EIGHTHS, |_| 1.0),
        "grid-4x4-lanczos2" => grid(&EIGHTHS, lanczos2),
        _ => return None,
    };
    Supersampling::new(name, taps).ok()
}

const EIGHTHS: [f64; 4] = [-0.375, -0.125, 0.125, 0.375];

fn tap(x: f64, y: f64, weight: f64) -> Tap {
    Tap { offset: DVec2::new(x, y), weight }
}

fn quarters(range: std::ops::RangeInclusive<i32>) -> Vec<f64> {
    range.map(|i| f64::from(i) * 0.25).collect()
}

/// All pairs of places, with separable weights.
fn grid(places: &[f64], weight: impl Fn(f64) -> f64) -> Vec<Tap> {
    let row = |y: f64| places.iter().map(move |&x| (x, y));
    places.iter().flat_map(|&y| row(y)).map(|(x, y)| tap(x, y, weight(x) * weight(y))).collect()
}

fn lanczos2(x: f64) -> f64 {
    // Where it is 0, without what rounding leaves: such samples aren't needed.
    let zero = x != 0.0 && x.fract() == 0.0;
    crate::kernel("lanczos2").filter(|_| !zero).map_or(0.0, |kernel| kernel.value(x))
}

fn quincunx() -> Vec<Tap> {
    let corners = [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)];
    let mut taps = vec![tap(0.0, 0.0, 0.5)];
    taps.extend(corners.map(|(x, y)| tap(x, y, 0.125)));
    taps
}
