//! The best candidate of several random ones.

mod voids;

use bn_core::{DVec2, Observer, Progress, Seed, StreamRng};
use rand::RngExt;

use self::voids::Voids;
use crate::bucket_grid::BucketGrid;
use crate::error::{check_count, observe};
use crate::{
    CountRule, DefaultValue, Method, OptionKind, OptionSpec, PointOrder, Report, Sample,
    SampleError, Sampler,
};

/// Each point is the best of many uniform random candidates: the one farthest from all points so
/// far. The k-th point has `candidates`·(k − 1) of them, so that the pattern is the same at any
/// scale.
///
/// Thesis p. 110; D. P. Mitchell, "Spectrally optimal sampling for distribution ray tracing",
/// Computer Graphics 25(4), 1991. Not all candidates are made: how many fall where one could be
/// the best is drawn first, and only those are placed, which is the same in distribution. Some
/// tens of candidates a point are placed instead of n/2 times `candidates`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BestCandidate {
    /// Candidates for each point, as a multiple of the points before it; from 1 to 1000. With 8,
    /// the default, patterns have the spacing and the spectrum that the thesis shows.
    pub candidates: u32,
}

impl Default for BestCandidate {
    fn default() -> Self {
        Self { candidates: 8 }
    }
}

/// The registry's entry.
pub(crate) const METHOD: Method = Method {
    name: "best-candidate",
    aliases: &["mitchell"],
    summary: "each point the farthest of many random candidates",
    page: Some(110),
    citation: "D. P. Mitchell, Spectrally optimal sampling for distribution ray tracing, Computer Graphics 25(4), 1991",
    complexity: "O(n log n)",
    order: PointOrder::Progressive,
    counts: CountRule::Any,
    seeded: true,
    options: &[OptionSpec {
        name: "candidates",
        kind: OptionKind::Integer { min: 1, max: MOST },
        default: DefaultValue::Value("8"),
        help: "candidates for each point, as a multiple of the points before it",
        unit: "",
    }],
    build: |options| {
        let defaults = BestCandidate::default();
        let candidates = options.integer("candidates");
        let candidates = candidates.map_or(defaults.candidates, |candidates| candidates as u32);
        Ok(Box::new(BestCandidate { candidates }))
    },
    version: 2,
};

const MOST: u64 = 1000;

/// Points that are chosen among candidates all over the torus, before the voids are small.
const FIRST_POINTS: usize = 64;

/// Points between two looks at the observer.
const POINTS_PER_LOOK: usize = 1 << 8;

/// With fewer candidates in the voids than this, the distance that makes a void is lowered: far
/// enough from 0 that there is nearly always one.
const FEWEST_HITS: usize = 8;
/// The first such distance over that of the last point.
const LOWERING: f64 = 0.96;

impl Sampler for BestCandidate {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        check_count(METHOD.name, n)?;
        if !(1..=MOST).contains(&self.candidates.into()) {
            let reason = format!("{} is not a number from 1 to {MOST}", self.candidates);
            return Err(SampleError::InvalidOption { option: "candidates", reason });
        }
        let mut rng = seed.stream(0);
        let mut points = BucketGrid::new(1);
        let mut voids: Option<Voids> = None;
        for k in 0..n {
            if k % POINTS_PER_LOOK == 0 {
                observe(observer, &Progress::new("placing", k as u64, Some(n as u64)))?;
            }
            let count = (u64::from(self.candidates) * k as u64).max(1);
            let best = match &mut voids {
                Some(voids) => best_in_voids(&points, voids, count, &mut rng),
                None => best_anywhere(&points, count, f64::INFINITY, &mut rng),
            };
            points.insert(best.place);
            let to_come = f64::from(self.candidates) * (k + 1) as f64;
            match &mut voids {
                Some(voids) if best.hits < FEWEST_HITS => {
                    points.fit();
                    voids.lower(&points, to_come);
                }
                None if k + 1 >= FIRST_POINTS => {
                    points.fit();
                    voids = Some(Voids::new(&points, LOWERING * best.distance, to_come));
                }
                _ => {}
            }
        }
        Ok(Sample::new(points.into_points(), Report::new()))
    }
}

/// The farthest of some candidates.
struct Best {
    place: DVec2,
    distance: f64,
    /// Candidates in the voids.
    hits: usize,
}

/// The best of `count` uniform candidates that are nearer to the points than `limit`.
fn best_anywhere(points: &BucketGrid, count: u64, limit: f64, rng: &mut StreamRng) -> Best {
    let mut best = Best { place: DVec2::ZERO, distance: -1.0, hits: 0 };
    let mut left = count;
    while left > 0 {
        let place = DVec2::new(rng.random(), rng.random());
        if best.distance > 0.0 && points.any_within(place, best.distance) {
            left -= 1;
            continue;
        }
        let distance = points.nearest(place).map_or(f64::INFINITY, |(_, squared)| squared.sqrt());
        if distance < limit || limit.is_infinite() {
            left -= 1;
            best = if distance > best.distance { Best { place, distance, hits: 0 } } else { best };
        }
    }
    best
}

/// The best of `count` uniform candidates.
///
/// The candidates outside the voids' squares are skipped: between two inside them lie as many as a
/// geometric distribution says. If one inside is as far from the points as a void has to be, none
/// outside is better. Otherwise all candidates are known to be nearer, and are drawn as such.
fn best_in_voids(points: &BucketGrid, voids: &mut Voids, count: u64, rng: &mut StreamRng) -> Best {
    let mut best = Best { place: DVec2::ZERO, distance: 0.0, hits: 0 };
    let mut closed = Vec::new();
    let mut left = count as f64;
    let share = voids.area();
    loop {
        left -= 1.0 + skipped(share, rng);
        if left < 0.0 {
            break;
        }
        let (place, square) = voids.draw(rng);
        let (nearest, squared) = points.nearest(place).expect("there are points");
        let distance = squared.sqrt();
        if distance >= voids.radius() {
            best.hits += 1;
            if distance > best.distance {
                best = Best { place, distance, ..best };
            }
        } else if voids.is_covered(square, nearest) {
            closed.push(square);
        }
    }
    voids.remove(&mut closed);
    if best.hits > 0 { best } else { best_anywhere(points, count, voids.radius(), rng) }
}

/// The number of candidates that miss a region of this share before one hits it.
fn skipped(share: f64, rng: &mut StreamRng) -> f64 {
    if share <= 0.0 {
        return f64::INFINITY;
    }
    if share >= 1.0 {
        return 0.0;
    }
    // 1 − u is in (0, 1]. Geometric by inversion: P(at least k) = (1 − share)^k.
    let u: f64 = rng.random();
    (libm::log1p(-u) / libm::log1p(-share)).floor()
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::{Unobserved, torus};

    /// Mitchell's algorithm as it stands; the distance of the last point.
    fn last_distance_by_definition(n: usize, candidates: u32, seed: Seed) -> f64 {
        let mut rng = seed.stream(1);
        let mut points: Vec<DVec2> = Vec::new();
        let mut last = 0.0;
        for k in 0..n {
            let mut best = (DVec2::ZERO, -1.0);
            for _ in 0..(candidates as usize * k).max(1) {
                let p = DVec2::new(rng.random(), rng.random());
                let distances = points.iter().map(|&q| torus::distance(p, q));
                let distance = distances.fold(f64::INFINITY, f64::min);
                if distance > best.1 {
                    best = (p, distance);
                }
            }
            points.push(best.0);
            last = best.1;
        }
        last
    }

    #[test]
    fn skipping_candidates_changes_no_distribution() {
        let (n, runs) = (90, 200);
        for candidates in [1, 3] {
            let method = BestCandidate { candidates };
            let mut sums = [[0.0; 2]; 2];
            for run in 0..runs {
                let seed = Seed::new(run);
                let set = method.sample(n, seed, &Unobserved).expect("valid").points;
                let (last, before) = set.points().split_last().expect("points");
                let skipping = before.iter().map(|&q| torus::distance(*last, q));
                let skipping = skipping.fold(f64::INFINITY, f64::min);
                let defined = last_distance_by_definition(n, candidates, seed);
                for (sum, x) in sums.iter_mut().zip([skipping, defined]) {
                    *sum = [sum[0] + x, sum[1] + x * x];
                }
            }
            let [(mean, variance), (want, want_variance)] = sums.map(|[sum, squares]| {
                let mean = sum / runs as f64;
                (mean, squares / runs as f64 - mean * mean)
            });
            let error = ((variance + want_variance) / runs as f64).sqrt();
            assert!((mean - want).abs() < 5.0 * error, "{mean} against {want} ± {error}");
            // The spread too: a variance has a relative standard error of about √(2/runs).
            let ratio = variance / want_variance;
            assert!((0.5..2.0).contains(&ratio), "variances {variance}, {want_variance}");
        }
    }
}
