//! The farthest point strategy: each point where the largest hole is.

use bn_core::{Density, Observer, Progress, Seed, Unobserved};

use crate::error::{check_count, observe};
use crate::farthest_points::fill_holes;
use crate::{
    CountRule, DartThrowing, DefaultValue, Method, OptionKind, OptionSpec, PointOrder, Report,
    Sample, SampleError, Sampler,
};

/// A few random points, then each point at the place that is farthest from all before it: the
/// centre of the largest empty circle.
///
/// With any number of points `d_min` is at least the coverage radius but for the random beginning.
/// The seed enters through the beginning alone. Thesis p. 110; Y. Eldar, M. Lindenbaum, M. Porat
/// and Y. Y. Zeevi, "The farthest point strategy for progressive image sampling", IEEE Trans. Image
/// Process. 6(9), 1997. On a dynamic Delaunay triangulation of the torus, O(n log n).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FarthestPointStrategy {
    /// Random points at the beginning, from 1 to 2¹⁶: dart throwing at its default radius.
    pub start: usize,
}

impl Default for FarthestPointStrategy {
    fn default() -> Self {
        Self { start: 16 }
    }
}

/// The registry's entry.
pub(crate) const METHOD: Method = Method {
    name: "farthest-point-strategy",
    aliases: &["fps", "farthest-point"],
    summary: "each point at the centre of the largest hole",
    page: Some(110),
    citation: "Y. Eldar et al., The farthest point strategy for progressive image sampling, IEEE Trans. Image Process. 6(9), 1997",
    complexity: "O(n log n)",
    order: PointOrder::Progressive,
    counts: CountRule::Any,
    seeded: true,
    options: &[OptionSpec {
        name: "start",
        kind: OptionKind::Integer { min: 1, max: MOST },
        default: DefaultValue::Value("16"),
        help: "random points at the beginning; one or two lead to symmetric patterns",
        unit: "points",
    }],
    build: |options| {
        let defaults = FarthestPointStrategy::default();
        let start = options.integer("start").map_or(defaults.start, |start| start as usize);
        Ok(Box::new(FarthestPointStrategy { start }))
    },
    version: 2,
};

/// The most random points at the beginning.
const MOST: u64 = 1 << 16;

impl Sampler for FarthestPointStrategy {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        check_count(METHOD.name, n)?;
        if !(1..=MOST).contains(&(self.start as u64)) {
            let reason = format!("{} is not a number from 1 to {MOST}", self.start);
            return Err(SampleError::InvalidOption { option: "start", reason });
        }
        observe(observer, &Progress::new("placing", 0, Some(n as u64)))?;
        // Cut after drawing, so that the points of a smaller pattern are the first of a larger one.
        let start = DartThrowing::default().sample(self.start, seed, &Unobserved)?;
        let mut points = start.points.into_points();
        points.truncate(n);
        let filled = fill_holes(&mut points, n, observer)?;
        let mut report = Report::new();
        if filled.is_finite() {
            let filled = Density::new(n).normalize_distance(filled);
            report = report.with("last_hole_radius_d_hex", filled.value());
        }
        Ok(Sample::new(points, report))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::{DVec2, torus};

    /// Each point lies as far from all before it as any place does, up to a lattice of probes.
    #[test]
    fn every_point_fills_the_largest_hole() {
        let method = FarthestPointStrategy { start: 3 };
        let points = method.sample(40, Seed::new(2), &Unobserved).expect("valid").points;
        let points = points.points();
        let clearance = |before: &[DVec2], p: DVec2| {
            before.iter().map(|&q| torus::distance(p, q)).fold(f64::INFINITY, f64::min)
        };
        for i in 3..points.len() {
            let own = clearance(&points[..i], points[i]);
            for probe in 0..100 * 100 {
                let probe = DVec2::new(f64::from(probe % 100), f64::from(probe / 100)) / 100.0;
                let largest = clearance(&points[..i], probe);
                assert!(own >= largest - 1e-14, "point {i}: {own}, but {largest} at {probe}");
            }
        }
    }

    #[test]
    fn small_patterns_are_the_beginnings_of_large_ones() {
        let sample = |n| {
            let sample = FarthestPointStrategy::default().sample(n, Seed::new(5), &Unobserved);
            sample.expect("valid").points.into_points()
        };
        let large = sample(200);
        for n in [1, 7, 16, 17, 150] {
            assert_eq!(sample(n), large[..n]);
        }
    }
}
