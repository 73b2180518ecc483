//! Functions that are constant on annuli, or linear, and their transforms in closed form.

use std::f64::consts::TAU;

use rayon::prelude::*;

use crate::bessel::jinc_slice_alike;

/// Radii whose transforms are computed together.
const CHUNK: usize = 256;
/// How exact the transform of a ramp is to be.
const RAMP: f64 = 1e-6;
/// The most annuli that are made of all ramps, beyond one of each.
const MOST_PIECES: f64 = 131_072.0;

/// f = vₖ on the annulus [bₖ, bₖ₊₁), 0 elsewhere, as a sum of disks.
pub(super) struct Annuli {
    /// Radius and height of each disk.
    disks: Vec<(f64, f64)>,
}

impl Annuli {
    /// The annuli between `bounds`, ascending from 0 or more, one more than `values`.
    pub(super) fn new(bounds: &[f64], values: &[f64]) -> Self {
        assert_eq!(bounds.len(), values.len() + 1, "an annulus lies between two bounds");
        let value = |k: Option<usize>| k.and_then(|k| values.get(k)).copied().unwrap_or(0.0);
        let height = |k: usize| value(k.checked_sub(1)) - value(Some(k));
        let disks = bounds.iter().enumerate().map(|(k, &b)| (b, height(k)));
        Self { disks: disks.filter(|&(b, height)| b > 0.0 && height != 0.0).collect() }
    }

    /// The annuli between `bounds` with the values that `f` has in their middles.
    pub(super) fn of(bounds: &[f64], f: impl Fn(f64) -> f64) -> Self {
        let values: Vec<f64> = bounds.windows(2).map(|b| f(0.5 * (b[0] + b[1]))).collect();
        Self::new(bounds, &values)
    }

    /// F(u) = 2π ∫ r f(r) J₀(2πru) dr = Σ height·2πb² jinc(2πbu), to a few ε·Σ|height|πb².
    pub(super) fn transform(&self, u: &[f64]) -> Vec<f64> {
        let mut transform = vec![0.0; u.len()];
        transform.par_chunks_mut(CHUNK).zip(u.par_chunks(CHUNK)).for_each(|(sums, u)| {
            let (mut x, mut values) = ([0.0; CHUNK], [0.0; CHUNK]);
            for &(b, height) in &self.disks {
                for (x, u) in x.iter_mut().zip(u) {
                    *x = TAU * b * u;
                }
                jinc_slice_alike(&x[..u.len()], &mut values[..u.len()]);
                for (sum, jinc) in sums.iter_mut().zip(&values) {
                    *sum += height * TAU * b * b * jinc;
                }
            }
        });
        transform
    }

    /// 1 + F/n, the RDF of the spectrum 1 + f.
    pub(super) fn rdf(&self, n: f64, r: &[f64]) -> Vec<f64> {
        let mut g = self.transform(r);
        for g in &mut g {
            *g = 1.0 + *g / n;
        }
        g
    }
}

/// A function that is linear between its samples and 0 beyond the last, as narrow annuli.
pub(super) struct Ramps {
    /// Of the annuli, ascending from 0.
    pub(super) bounds: Vec<f64>,
    means: Vec<f64>,
}

impl Ramps {
    /// The function with samples (`x`, `f`), its first value down to 0, in annuli so narrow that none
    /// of its ramps changes the transform by more than about `RAMP`, with frequencies and distances
    /// in units of `unit` and its reciprocal; in 2¹⁷ annuli more than samples at most.
    pub(super) fn new(x: &[f64], f: &[f64], unit: f64) -> Self {
        // Annuli of width h take (2π/12)·(slope·h²)·[x J₀] off the transform of a ramp, |J₀| ≤ 1.
        let pieces = |i: usize| {
            let (length, end) = ((x[i + 1] - x[i]) / unit, x[i + 1] / unit);
            let wanted = (0.5 * (f[i + 1] - f[i]).abs() * length * end / RAMP).sqrt();
            if wanted > 1.0 { wanted.min(MOST_PIECES) } else { 1.0 }
        };
        let wanted: f64 = (0..x.len() - 1).map(|i| pieces(i) - 1.0).sum();
        let share = (MOST_PIECES / wanted).min(1.0);
        let (mut bounds, mut means) = (vec![0.0], Vec::new());
        if x[0] > 0.0 {
            (bounds, means) = (vec![0.0, x[0]], vec![f[0]]);
        }
        for i in 0..x.len() - 1 {
            let count = (1.0 + share * (pieces(i) - 1.0)).ceil() as u32;
            let at = |part: f64| x[i] + (x[i + 1] - x[i]) * (part / f64::from(count));
            for piece in 0..count {
                let (from, to) = (at(f64::from(piece)), at(f64::from(piece + 1)));
                // The mean over the annulus is the value at its centroid.
                let width = to - from;
                let centroid = 0.5 * (from + to) + width / 6.0 * (width / (from + to));
                let t = (centroid - x[i]) / (x[i + 1] - x[i]);
                bounds.push(to);
                means.push(f[i] * (1.0 - t) + f[i + 1] * t);
            }
        }
        Self { bounds, means }
    }

    pub(super) fn annuli(&self) -> Annuli {
        Annuli::new(&self.bounds, &self.means)
    }
}

/// Bounds between those of samples at `x`: each sample stands for the halves of the gaps next to
/// it, the first one down to 0.
pub(super) fn cells(x: &[f64]) -> Vec<f64> {
    let mut bounds = vec![0.0];
    bounds.extend(x.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])));
    bounds.push(x[x.len() - 1]);
    bounds
}

/// `from`, …, `to` in equal steps of about `step`, not more than 2¹⁶.
pub(super) fn steps_between(from: f64, to: f64, step: f64) -> Vec<f64> {
    let count = ((to - from) / step).ceil().clamp(1.0, 65_536.0) as usize;
    (0..=count).map(|i| from + (to - from) * i as f64 / count as f64).collect()
}
