//! Quadrature of functions that are smooth between breaks, times Bessel functions.

use std::f64::consts::TAU;

use rayon::prelude::*;

use crate::bessel::j0_slice_alike;

/// The six-point Gauss–Legendre rule on (0, 1): abscissae and weights.
const RULE: [(f64, f64); 6] = [
    (0.033_765_242_898_423_97, 0.085_662_246_189_585_14),
    (0.169_395_306_766_867_76, 0.180_380_786_524_069_36),
    (0.380_690_406_958_401_56, 0.233_956_967_286_345_52),
    (0.619_309_593_041_598_5, 0.233_956_967_286_345_52),
    (0.830_604_693_233_132_2, 0.180_380_786_524_069_36),
    (0.966_234_757_101_575_9, 0.085_662_246_189_585_14),
];
/// Panels to a turn of the oscillation.
const PER_TURN: f64 = 4.0;
/// Nodes that a transform may take at one frequency; annuli serve functions that reach farther.
pub(crate) const MOST_NODES: f64 = 262_144.0;
/// Frequencies whose transforms are computed together, from one set of nodes …
const CHUNK: usize = 64;
/// … and values of J₀ that are made at once.
const BLOCK: usize = 512;

/// Nodes and weights of ∫ f(x) dx over the range of ascending `breaks`, for f smooth between them but
/// for an oscillation of up to `turns` a unit.
pub(crate) fn nodes(breaks: &[f64], turns: f64) -> Vec<(f64, f64)> {
    let mut nodes = Vec::with_capacity(count(breaks, turns) as usize);
    for pair in breaks.windows(2) {
        let length = pair[1] - pair[0];
        let panels = panels(length, turns);
        let width = length / panels;
        for panel in 0..panels as usize {
            let start = pair[0] + width * panel as f64;
            nodes.extend(RULE.iter().map(|(x, w)| (start + width * x, width * w)));
        }
    }
    nodes
}

/// How many nodes these are.
pub(crate) fn count(breaks: &[f64], turns: f64) -> f64 {
    let of = |pair: &[f64]| RULE.len() as f64 * panels(pair[1] - pair[0], turns);
    breaks.windows(2).map(of).sum()
}

fn panels(length: f64, turns: f64) -> f64 {
    (PER_TURN * turns * length).ceil().max(1.0)
}

/// F(u) = 2π ∫ x f(x) J₀(2πxu) dx over the range of `breaks`, between which f is smooth; for f that
/// is a polynomial of degree 3 there to 1e-9·2π ∫ x |f| dx. The same bits on every CPU.
///
/// Cost: for each u as many values of J₀ as there are nodes ([`count`]), on all threads.
pub(crate) fn transform(breaks: &[f64], f: impl Fn(f64) -> f64 + Sync, u: &[f64]) -> Vec<f64> {
    let mut transform = vec![0.0; u.len()];
    transform.par_chunks_mut(CHUNK).zip(u.par_chunks(CHUNK)).for_each(|(sums, u)| {
        let highest = u.iter().copied().fold(0.0, f64::max);
        let nodes = nodes(breaks, highest);
        let masses: Vec<f64> = nodes.iter().map(|&(x, w)| TAU * w * x * f(x)).collect();
        let (mut x, mut values) = ([0.0; BLOCK], [0.0; BLOCK]);
        for (sum, &u) in sums.iter_mut().zip(u) {
            for (nodes, masses) in nodes.chunks(BLOCK).zip(masses.chunks(BLOCK)) {
                for (x, (node, _)) in x.iter_mut().zip(nodes) {
                    *x = TAU * node * u;
                }
                j0_slice_alike(&x[..nodes.len()], &mut values[..nodes.len()]);
                *sum += masses.iter().zip(&values).map(|(m, j0)| m * j0).sum::<f64>();
            }
        }
    });
    transform
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_integrated() {
        for degree in 0..12 {
            let nodes = nodes(&[1.0, 1.5, 3.0], 0.4);
            assert_eq!(nodes.len() as f64, count(&[1.0, 1.5, 3.0], 0.4));
            let sum: f64 = nodes.iter().map(|(x, w)| w * x.powi(degree)).sum();
            let power = degree + 1;
            let want = (3.0_f64.powi(power) - 1.0) / f64::from(power);
            assert!((sum / want - 1.0).abs() < 1e-14, "degree {degree}: {sum}");
        }
    }

    /// A disk, whose transform is a jinc, up to thousands of turns.
    #[test]
    fn disks_have_their_transform() {
        let u: Vec<f64> = (0..2000).map(f64::from).collect();
        for (radius, got) in [0.3_f64, 1.0].map(|r| (r, transform(&[0.0, r], |_| 1.0, &u))) {
            for (u, got) in u.iter().zip(got) {
                let want = if *u == 0.0 {
                    0.5 * TAU * radius * radius
                } else {
                    radius * crate::j1(TAU * radius * u) / u
                };
                let bound = 1e-9 * 0.5 * TAU * radius * radius;
                assert!((got - want).abs() < bound, "{got}, not {want}, at {u}");
            }
        }
    }

    /// Powers and a cone on one panel and on many, against sums of 65,536 points.
    #[test]
    fn polynomials_have_their_transform() {
        let u: Vec<f64> = (0..40).map(|i| f64::from(i) / 16.0).collect();
        let shapes: [fn(f64) -> f64; 5] = [|_| 1.0, |x| x, |x| 1.0 - x, |x| x * x, |x| x * x * x];
        for f in shapes {
            let points = || (0..65_536).map(|i| (f64::from(i) + 0.5) / 65_536.0);
            let sum = |g: &dyn Fn(f64) -> f64| TAU * points().map(g).sum::<f64>() / 65_536.0;
            let size = sum(&|x| x * f(x));
            for (u, got) in u.iter().zip(transform(&[0.0, 1.0], f, &u)) {
                let want = sum(&|x| x * f(x) * crate::j0(TAU * x * u));
                // The sums themselves are good to (2πu)²/24/65,536².
                assert!((got - want).abs() < 1.5e-9 * size, "{got}, not {want}, at {u}");
            }
        }
    }
}
