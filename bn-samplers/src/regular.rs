//! The square grid.

use bn_core::{DVec2, Observer, Seed};

use crate::placing::{begin_placing, between_counts};
use crate::{CountRule, Method, PointOrder, Report, Sample, SampleError, Sampler};

/// The square grid: the centres of m × m equal cells, row by row; n = m².
///
/// `d_min` = (√3/2)^½ ≈ 0.9306 `d_hex`, `R_c` = 0.6580 `d_hex`, P(k) = n at multiples of m, else 0.
/// Thesis p. 116.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Regular;

/// The registry's entry.
pub(crate) const METHOD: Method = Method {
    name: "regular",
    aliases: &["grid", "square", "regular-grid"],
    summary: "square grid of cell centres",
    page: Some(116),
    citation: "D. Heck, Spatial and Spectral Methods for Irregular Sampling, 2013, B.11",
    complexity: "O(n)",
    order: PointOrder::Scan,
    counts: CountRule::Square,
    seeded: false,
    options: &[],
    build: |_| Ok(Box::new(Regular)),
    version: 1,
};

impl Sampler for Regular {
    fn sample(
        &self,
        n: usize,
        _seed: Seed,
        observer: &dyn Observer,
    ) -> Result<Sample, SampleError> {
        let mut points = begin_placing(METHOD.name, n, observer)?;
        let side = n.isqrt();
        if side * side != n {
            let squares = [side * side, (side + 1) * (side + 1)];
            return Err(between_counts(METHOD.name, n, "a square number", squares));
        }
        let centre = |i: usize| (i as f64 + 0.5) / side as f64;
        for row in 0..side {
            points.extend((0..side).map(|column| DVec2::new(centre(column), centre(row))));
        }
        Ok(Sample::new(points, Report::new()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::Unobserved;

    #[test]
    fn names_the_nearest_square() {
        for (n, want) in [(2, 1), (3, 4), (4000, 3969), (4090, 4096), (6, 4), (7, 9)] {
            let result = Regular.sample(n, Seed::new(1), &Unobserved);
            let Err(error @ SampleError::InvalidCount { nearest, .. }) = result else {
                panic!("{n} is not square")
            };
            assert!(error.is_usage());
            assert_eq!(nearest, want, "next to {n}");
            assert!(Regular.sample(nearest, Seed::new(1), &Unobserved).is_ok());
        }
    }
}
