//! Fewer points where pairs would be too many to count.

use bn_core::{CellGrid, PointSet, Seed};
use rand::RngExt as _;

/// Pairs of a set that are counted in a few seconds: those of 2 million points that spread evenly,
/// up to eight `d_hex`.
const MOST_PAIRS: f64 = 5e8;

/// Points whose surroundings tell how many pairs there are.
const PROBES: usize = 64;

/// Some of each set's points, if a set has too many pairs nearer than `range` to count them all: where
/// points crowd in one place, or are very many. Which points stay is left to chance, which changes no pair
/// correlation on average.
pub(super) fn thinned(sets: &[PointSet], range: f64) -> Option<Vec<PointSet>> {
    let pairs = sets.iter().map(|set| estimated_pairs(set, range)).fold(0.0, f64::max);
    if pairs <= MOST_PAIRS {
        return None;
    }
    let part = (MOST_PAIRS / pairs).sqrt();
    let thin = |(i, set): (usize, &PointSet)| {
        let mut points = set.points().to_vec();
        let keep = ((part * points.len() as f64) as usize).clamp(2, points.len());
        let mut rng = Seed::new(0).stream(i as u32);
        // The first steps of a shuffle.
        for place in 0..keep {
            let other = rng.random_range(place as u64..points.len() as u64) as usize;
            points.swap(place, other);
        }
        points.truncate(keep);
        PointSet::new(points).expect("some of a set's points are a set")
    };
    Some(sets.iter().enumerate().map(thin).collect())
}

/// Ordered pairs nearer than `range`, from evenly spread indices.
fn estimated_pairs(set: &PointSet, range: f64) -> f64 {
    let grid = CellGrid::new(set);
    let step = set.len().div_ceil(PROBES);
    let probes = set.points().iter().step_by(step);
    let (mut count, mut total) = (0_u64, 0_u64);
    for &probe in probes {
        grid.for_each_within(probe, range, |_, _| count += 1);
        total += 1;
    }
    count as f64 / total as f64 * set.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::DVec2;

    #[test]
    fn only_crowds_are_thinned() {
        let even = |i: u32| DVec2::new(f64::from(i % 300), f64::from(i / 300)) / 300.0;
        let spread = PointSet::new((0..90_000).map(even).collect()).expect("valid");
        assert_eq!(thinned(std::slice::from_ref(&spread), 0.03), None);
        let crowd = PointSet::new(vec![DVec2::new(0.5, 0.25); 200_000]).expect("valid");
        let fewer = thinned(&[crowd.clone(), crowd], 0.03).expect("4·10¹⁰ pairs");
        // √(5·10⁸ / 4·10¹⁰) of the points.
        assert_eq!(fewer[0].len(), 22_360);
        assert_eq!(fewer.len(), 2);
    }
}
