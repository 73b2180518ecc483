//! Order along a Hilbert curve.

use bn_core::DVec2;

/// The indices of points of [0, 1)² in their order along a Hilbert curve, equal places in the order
/// given: neighbours in this order are neighbours on the torus. O(n log n).
///
/// ```
/// use bn_core::DVec2;
///
/// let corners = [(0.1, 0.1), (0.9, 0.9), (0.9, 0.1), (0.1, 0.9)].map(DVec2::from);
/// assert_eq!(bn_geometry::hilbert_order(&corners), [0, 3, 1, 2]);
/// ```
pub fn hilbert_order(points: &[DVec2]) -> Vec<u32> {
    let mut curve: Vec<(u64, u32)> = points.iter().map(|&p| index(p)).zip(0..).collect();
    curve.sort_unstable();
    curve.into_iter().map(|(_, i)| i).collect()
}

/// Bits a coordinate.
const ORDER: u32 = 32;

/// The place of a point of [0, 1)² along the Hilbert curve through 2³² × 2³² cells.
pub fn index(p: DVec2) -> u64 {
    let cells = (1_u64 << ORDER) as f64;
    let (x, y) = ((p.x * cells) as u32, (p.y * cells) as u32);
    let (mut d, mut state) = (0_u64, 0_u8);
    for shift in (0..ORDER / 2).rev().map(|pair| 2 * pair) {
        let quads = (x >> shift & 3) << 2 | (y >> shift & 3);
        let (digits, next) = STEPS[state as usize][quads as usize];
        d = d << 4 | u64::from(digits);
        state = next;
    }
    d
}

/// For each orientation of the curve and each of 4 × 4 cells (x the high bits): the place of the
/// cell among the 16 and the orientation within it.
const STEPS: [[(u8, u8); 16]; 4] = two_levels();

/// For each orientation and each quadrant (x the high bit): its place and its own orientation.
/// Orientation bit 0: x and y are exchanged; bit 1: both run backwards.
const fn one_level(state: u8, quadrant: u8) -> (u8, u8) {
    let (mut x, mut y) = (quadrant >> 1 & 1, quadrant & 1);
    if state & 2 != 0 {
        (x, y) = (1 - x, 1 - y);
    }
    if state & 1 != 0 {
        (x, y) = (y, x);
    }
    // The upright curve visits (0,0), (0,1), (1,1), (1,0); it is transposed in the first quadrant
    // and transposed about the other diagonal in the last.
    match (x, y) {
        (0, 0) => (0, state ^ 1),
        (0, _) => (1, state),
        (_, 0) => (3, state ^ 3),
        (_, _) => (2, state),
    }
}

const fn two_levels() -> [[(u8, u8); 16]; 4] {
    let mut steps = [[(0, 0); 16]; 4];
    let mut state = 0;
    while state < 4 {
        let mut cell = 0;
        while cell < 16 {
            let (high, inner) = one_level(state, (cell >> 3 & 1) << 1 | (cell >> 1 & 1));
            let (low, next) = one_level(inner, (cell >> 2 & 1) << 1 | (cell & 1));
            steps[state as usize][cell as usize] = (high << 2 | low, next);
            cell += 1;
        }
        state += 1;
    }
    steps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_visits_neighbouring_cells_in_turn() {
        let side = 64;
        let mut cells: Vec<(u64, i32, i32)> = Vec::new();
        for x in 0..side {
            for y in 0..side {
                let p = (DVec2::new(f64::from(x), f64::from(y)) + 0.5) / f64::from(side);
                cells.push((index(p) >> (2 * (ORDER - 6)), x, y));
            }
        }
        cells.sort_unstable();
        for (place, pair) in (0..).zip(cells.windows(2)) {
            assert_eq!(pair[0].0, place);
            let steps = (pair[0].1 - pair[1].1).abs() + (pair[0].2 - pair[1].2).abs();
            assert_eq!(steps, 1, "from {:?} to {:?}", pair[0], pair[1]);
        }
    }
}
