//! Functions that are constant on annuli, and their transforms in closed form.

use std::f64::consts::TAU;

use rayon::prelude::*;

use crate::bessel::jinc_slice_alike;

/// Radii whose transforms are computed together.
const CHUNK: usize = 256;

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
