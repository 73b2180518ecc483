//! The hexagonal grid as nearly as the torus admits it.

use bn_core::{DVec2, Density, Observer, Progress, Seed};
use rayon::prelude::*;

use crate::error::{check_count, observe, reserve};
use crate::{CountRule, Method, PointOrder, Report, Sample, SampleError, Sampler};

/// The rank-1 lattice (i/n, a·i/n mod 1), 0 ≤ i < n, whose smallest distance on the torus is the
/// largest of all a; of equally good ones the smallest a.
///
/// A hexagonal lattice fits no square torus; this is the usual nearest thing. n = 4096 gives
/// a = 70, `d_min` = 0.9902 `d_hex`, the thesis's hexagonal grid (p. 117). Cost O(n log n): the
/// shortest vector of each of n/2 lattices by Lagrange's reduction.
///
/// S. Dammertz, H. Dammertz, A. Keller and H. P. A. Lensch, "Textures on rank-1 lattices",
/// Computer Graphics Forum 28(7), 2009.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Hexagonal;

/// The registry's entry.
pub(crate) const METHOD: Method = Method {
    name: "hexagonal",
    aliases: &["hex", "hexagonal-grid", "rank-1"],
    summary: "rank-1 lattice with the largest smallest distance",
    page: Some(117),
    citation: "S. Dammertz et al., Textures on rank-1 lattices, Comput. Graph. Forum 28(7), 2009",
    complexity: "O(n log n)",
    order: PointOrder::Scan,
    counts: CountRule::Any,
    seeded: false,
    options: &[],
    build: |_| Ok(Box::new(Hexagonal)),
    version: 1,
};

/// Generators that are tried between two looks at the observer.
const BLOCK: u64 = 1 << 16;

impl Sampler for Hexagonal {
    fn sample(
        &self,
        n: usize,
        _seed: Seed,
        observer: &dyn Observer,
    ) -> Result<Sample, SampleError> {
        check_count(METHOD.name, n)?;
        let mut points = reserve(n)?;
        let (a, squared) = best_generator(n as u64, observer)?;
        let scale = n as f64;
        let mut y = 0;
        for i in 0..n {
            points.push(DVec2::new(i as f64 / scale, y as f64 / scale));
            y = (y + a) % n as u64;
        }
        let d_min = Density::new(n).normalize_distance((squared as f64).sqrt() / scale).value();
        Ok(Sample::new(points, Report::new().with("generator", a).with("d_min_d_hex", d_min)))
    }
}

/// The a of the best lattice and the square of its smallest distance in units of 1/n.
fn best_generator(n: u64, observer: &dyn Observer) -> Result<(u64, u64), SampleError> {
    // a and n − a are mirror images. Blocks are joined in order, so the smallest a wins ties.
    let last = n / 2;
    let mut best = (0, shortest_squared(n, 0, 0));
    for first in (0..=last).step_by(16 * BLOCK as usize) {
        observe(observer, &Progress::new("searching lattices", first, Some(last)))?;
        let end = (first + 16 * BLOCK).min(last + 1);
        let starts: Vec<u64> = (first..end).step_by(BLOCK as usize).collect();
        let found: Vec<_> = starts
            .into_par_iter()
            .map(|start| best_of_block(n, start..(start + BLOCK).min(end), best))
            .collect();
        for candidate in found {
            if candidate.1 > best.1 {
                best = candidate;
            }
        }
    }
    Ok(best)
}

fn best_of_block(n: u64, block: std::ops::Range<u64>, mut best: (u64, u64)) -> (u64, u64) {
    for a in block {
        let squared = shortest_squared(n, a, best.1);
        if squared > best.1 {
            best = (a, squared);
        }
    }
    best
}

/// The squared length of the shortest vector of the lattice spanned by (1, a) and (0, n), a ≤ n/2;
/// or the squared length of any of its vectors that is at most `enough`.
fn shortest_squared(n: u64, a: u64, enough: u64) -> u64 {
    let (n, a, enough) = (n as i64, a as i64, enough as i64);
    // Lagrange: subtract from the longer vector the multiple of the shorter one that leaves least.
    let (mut long, mut short) = ([0, n], [1, a]);
    let mut squared = 1 + a * a;
    while squared > enough {
        let factor = divide_rounding(long[0] * short[0] + long[1] * short[1], squared);
        let rest = [long[0] - factor * short[0], long[1] - factor * short[1]];
        let rest_squared = rest[0] * rest[0] + rest[1] * rest[1];
        if rest_squared >= squared {
            break;
        }
        (long, short, squared) = (short, rest, rest_squared);
    }
    squared as u64
}

/// a/b rounded to a nearest whole number, b > 0.
fn divide_rounding(a: i64, b: i64) -> i64 {
    (2 * a + b).div_euclid(2 * b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::{Unobserved, torus};

    #[test]
    fn finds_the_lattice_of_the_thesis() {
        let sample = Hexagonal.sample(4096, Seed::new(1), &Unobserved).expect("valid");
        assert_eq!(sample.report.get("generator"), Some(70_u64.into()));
        let Some(crate::FigureValue::Real(d_min)) = sample.report.get("d_min_d_hex") else {
            panic!("d_min is reported")
        };
        assert!((d_min - 0.9902).abs() < 5e-5, "{d_min}");
    }

    #[test]
    fn no_generator_does_better() {
        for n in 1..=60_usize {
            let brute = |a: usize| {
                let at = |i: usize| DVec2::new(i as f64, (a * i % n) as f64) / n as f64;
                // A lattice: the distances from point 0 and to its own copies are all there are.
                (1..n).map(|i| torus::distance(at(0), at(i))).fold(1.0, f64::min)
            };
            let best = (0..n).map(brute).fold(0.0, f64::max);
            let (a, squared) = best_generator(n as u64, &Unobserved).expect("not stopped");
            let found = (squared as f64).sqrt() / n as f64;
            assert!((found - best).abs() < 1e-14, "n = {n}: {found} against {best}");
            assert!((brute(a as usize) - best).abs() < 1e-14);
        }
    }
}
