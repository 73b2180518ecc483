//! A tile's points in buckets, so that any rectangle of it is read in a few straight runs.

use std::ops::Range;

use bn_core::PointSet;

/// Points of [0, 1)² sorted into a square grid of buckets, row by row; the order within a bucket
/// is that of the set.
#[derive(Clone, Debug)]
pub(super) struct Buckets {
    side: usize,
    starts: Vec<u32>,
    xs: Vec<f64>,
    ys: Vec<f64>,
    /// Nothing if all points weigh the same.
    weights: Vec<f64>,
}

impl Buckets {
    /// About four points a bucket: small enough to read little too much, large enough for runs.
    const POINTS_PER_BUCKET: usize = 4;

    /// `weights` are one a point, or none.
    pub(super) fn new(set: &PointSet, weights: &[f64]) -> Self {
        let side = (set.len() / Self::POINTS_PER_BUCKET).isqrt().max(1);
        let column = |x: f64| ((x * side as f64) as usize).min(side - 1);
        let keys: Vec<u32> =
            set.points().iter().map(|p| (column(p.y) * side + column(p.x)) as u32).collect();
        let mut starts = vec![0_u32; side * side + 1];
        for &key in &keys {
            starts[key as usize + 1] += 1;
        }
        for i in 0..side * side {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let (mut xs, mut ys) = (vec![0.0; set.len()], vec![0.0; set.len()]);
        let mut sorted = vec![0.0; weights.len()];
        for (i, (p, &key)) in set.points().iter().zip(&keys).enumerate() {
            let slot = &mut next[key as usize];
            // −0 counts as 0 on the torus.
            xs[*slot as usize] = p.x + 0.0;
            ys[*slot as usize] = p.y + 0.0;
            if let Some(&weight) = weights.get(i) {
                sorted[*slot as usize] = weight;
            }
            *slot += 1;
        }
        Self { side, starts, xs, ys, weights: sorted }
    }

    pub(super) fn len(&self) -> usize {
        self.xs.len()
    }

    pub(super) fn xs(&self) -> &[f64] {
        &self.xs
    }

    pub(super) fn ys(&self) -> &[f64] {
        &self.ys
    }

    /// One a point, or nothing.
    pub(super) fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// The runs of points that hold all whose coordinates lie in the given intervals (which may
    /// reach outside [0, 1], where nothing lies), and some more; in ascending order.
    pub(super) fn runs(&self, x: Interval, y: Interval) -> impl Iterator<Item = Range<usize>> {
        let Range { start, end } = self.columns(x);
        self.columns(y).map(move |row| {
            let first = row * self.side;
            self.starts[first + start] as usize..self.starts[first + end] as usize
        })
    }

    fn columns(&self, (low, high): Interval) -> Range<usize> {
        if !(low < 1.0 && high >= 0.0) {
            return 0..0;
        }
        // Casts saturate, so a bound below 0 becomes column 0.
        let column = |x: f64| ((x * self.side as f64) as usize).min(self.side - 1);
        column(low)..column(high) + 1
    }
}

/// A closed interval of one coordinate, lower end first.
pub(super) type Interval = (f64, f64);

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::{DVec2, Seed};
    use rand::RngExt;

    #[test]
    fn runs_hold_every_point_of_the_rectangle_once_and_in_order() {
        let mut rng = Seed::new(3).stream(0);
        for n in [1, 3, 4, 17, 1000] {
            let points = (0..n).map(|_| DVec2::new(rng.random(), rng.random())).collect();
            let set = PointSet::new(points).expect("a set");
            let buckets = Buckets::new(&set, &[]);
            for _ in 0..50 {
                let mut interval = || {
                    let a: f64 = rng.random_range(-0.3..1.3);
                    (a, a + rng.random_range(0.0..0.7))
                };
                let (x, y) = (interval(), interval());
                let read: Vec<usize> = buckets.runs(x, y).flatten().collect();
                assert!(read.is_sorted_by(|a, b| a < b));
                let inside =
                    |px: f64, py: f64| (x.0..=x.1).contains(&px) && (y.0..=y.1).contains(&py);
                let want = set.points().iter().filter(|p| inside(p.x, p.y)).count();
                let got = read.iter().filter(|&&i| inside(buckets.xs[i], buckets.ys[i])).count();
                assert_eq!(got, want, "n = {n}, {x:?} × {y:?}");
            }
        }
    }
}
