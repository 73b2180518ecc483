//! The inner loop of the pair count.

#![expect(clippy::inline_always, reason = "must be compiled anew under the features of the caller")]

use std::ops::Range;

use bn_core::DVec2;

/// Pairs whose bins are computed together before they are counted.
const CHUNK: usize = 256;

/// Points by coordinate, so that four of them fit a vector register.
pub struct Coordinates {
    x: Vec<f64>,
    y: Vec<f64>,
}

impl Coordinates {
    pub fn of(points: &[DVec2]) -> Self {
        Self { x: points.iter().map(|p| p.x).collect(), y: points.iter().map(|p| p.y).collect() }
    }

    pub fn len(&self) -> usize {
        self.x.len()
    }
}

/// Counts distances; `recent` is flushed into `counts` before one of its numbers can overflow.
pub struct Counter {
    bins_per_unit: f64,
    /// One for each bin and one for what lies beyond.
    recent: Vec<u32>,
    recent_pairs: u32,
    counts: Vec<u64>,
}

impl Counter {
    pub fn new(bins: usize, bins_per_unit: f64) -> Self {
        Self { bins_per_unit, recent: vec![0; bins + 1], recent_pairs: 0, counts: vec![0; bins] }
    }

    /// Counts the pairs of point `row` with those of `columns`, at most 2³² − 1.
    pub fn count(&mut self, points: &Coordinates, row: usize, columns: Range<usize>) {
        let pairs = columns.len() as u32;
        if self.recent_pairs.checked_add(pairs).is_none() {
            self.flush();
        }
        self.recent_pairs += pairs;
        let at = (points.x[row], points.y[row]);
        let others = (&points.x[columns.clone()], &points.y[columns]);
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") {
            // SAFETY: the CPU has just been found to have the feature.
            return unsafe { count_avx2(at, others, self.bins_per_unit, &mut self.recent) };
        }
        count(at, others, self.bins_per_unit, &mut self.recent);
    }

    pub fn into_counts(mut self) -> Vec<u64> {
        self.flush();
        self.counts
    }

    fn flush(&mut self) {
        for (sum, recent) in self.counts.iter_mut().zip(&self.recent) {
            *sum += u64::from(*recent);
        }
        self.recent.fill(0);
        self.recent_pairs = 0;
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn count_avx2(at: (f64, f64), others: (&[f64], &[f64]), bins_per_unit: f64, recent: &mut [u32]) {
    count(at, others, bins_per_unit, recent);
}

/// No branch depends on a distance: what is too far is counted in the last bin.
#[inline(always)]
fn count((x, y): (f64, f64), (xs, ys): (&[f64], &[f64]), bins_per_unit: f64, recent: &mut [u32]) {
    let last = (recent.len() - 1) as f64;
    let mut bins = [0_u32; CHUNK];
    for (xs, ys) in xs.chunks(CHUNK).zip(ys.chunks(CHUNK)) {
        for ((bin, &other_x), &other_y) in bins.iter_mut().zip(xs).zip(ys) {
            let dx = shortest((other_x - x).abs());
            let dy = shortest((other_y - y).abs());
            let position = (dx * dx + dy * dy).sqrt() * bins_per_unit;
            *bin = truncated(if position < last { position } else { last });
        }
        let (fours, rest) = bins[..xs.len()].as_chunks::<4>();
        for &[a, b, c, d] in fours {
            recent[a as usize] += 1;
            recent[b as usize] += 1;
            recent[c as usize] += 1;
            recent[d as usize] += 1;
        }
        for &bin in rest {
            recent[bin as usize] += 1;
        }
    }
}

/// The distance round the torus of two coordinates `d` apart, as `bn_core::torus` computes it.
#[inline(always)]
fn shortest(d: f64) -> f64 {
    if 1.0 - d < d { 1.0 - d } else { d }
}

/// ⌊x⌋ of 0 ≤ x < 2³²: 2⁵² + ⌊x⌋ has that integer in its lowest bits.
#[inline(always)]
fn truncated(x: f64) -> u32 {
    (x.floor() + 4_503_599_627_370_496.0).to_bits() as u32
}
