//! The square grid.

use bn_core::{DVec2, Observer, Progress, Seed};

use crate::error::{check_count, observe, reserve};
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
        check_count(METHOD.name, n)?;
        observe(observer, &Progress::new("placing", 0, Some(n as u64)))?;
        let side = n.isqrt();
        if side * side != n {
            return Err(not_square(n));
        }
        let centre = |i: usize| (i as f64 + 0.5) / side as f64;
        let mut points = reserve(n)?;
        for row in 0..side {
            points.extend((0..side).map(|column| DVec2::new(centre(column), centre(row))));
        }
        Ok(Sample::new(points, Report::new()))
    }
}

fn not_square(n: usize) -> SampleError {
    let below = n.isqrt();
    let above = below + 1;
    let nearest = if n - below * below <= above * above - n { below } else { above };
    SampleError::InvalidCount {
        method: METHOD.name,
        n,
        need: "a square number",
        nearest: nearest * nearest,
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
