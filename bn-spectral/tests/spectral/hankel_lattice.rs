//! Lattice sums against the plain double loop.

use bn_spectral::{BesselSums, j0};
use proptest::prelude::*;

fn plain_sum(c: &[f64], j: usize, alpha: f64) -> f64 {
    let term = |(i, c): (usize, &f64)| c * j0(std::f64::consts::TAU * alpha * i as f64 * j as f64);
    c.iter().enumerate().filter(|(_, c)| **c != 0.0).map(term).sum()
}

/// Without order, of size 1: what a noisy histogram leaves.
fn noise(n: usize, seed: u64) -> Vec<f64> {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    (0..n).map(|_| next()).collect()
}

/// The bound that is documented, 4e-12·Σ|c|, and the rounding of the oracle's argument, ε·x.
fn check(c: &[f64], frequencies: usize, alpha: f64, some: impl Iterator<Item = usize>) {
    let plan = BesselSums::new(c.len(), frequencies, alpha);
    let mut sums = vec![f64::NAN; frequencies];
    plan.apply_into(c, &mut sums, &mut plan.scratch());
    let total: f64 = c.iter().map(|c| c.abs()).sum();
    for j in some {
        let (got, want) = (sums[j], plain_sum(c, j, alpha));
        let x = std::f64::consts::TAU * alpha * (c.len() * j) as f64;
        let bound = (4e-12 + f64::EPSILON * x.sqrt()) * total;
        assert!((got - want).abs() <= bound, "{got} for {want} at {j} of {frequencies}, α {alpha}");
    }
}

/// The size of the windowed estimator at n = 4096; noise at every radius, and each radius alone.
#[test]
fn sums_of_the_estimator_are_exact_enough() {
    let alpha = 1.0 / 40_000.0;
    check(&noise(3200, 1), 6400, alpha, (0..6400).step_by(31).chain([1, 63, 64, 79, 80, 6399]));
    for i in [0, 1, 2, 19, 20, 21, 39, 40, 41, 900, 3199] {
        let mut c = vec![0.0; 3200];
        c[i] = 1.0;
        check(&c, 6400, alpha, 0..6400);
    }
}

#[test]
fn a_lattice_too_fine_for_a_table_is_summed_all_the_same() {
    check(&noise(3000, 2), 4000, 1e-7, (0..4000).step_by(371));
}

#[test]
fn scratch_and_plan_can_be_used_again() {
    let plan = BesselSums::new(500, 900, 1e-3);
    let mut scratch = plan.scratch();
    let (a, b) = (noise(500, 3), noise(500, 4));
    let mut first = vec![0.0; 900];
    let mut again = vec![1.0; 900];
    plan.apply_into(&a, &mut first, &mut scratch);
    plan.apply_into(&b, &mut again, &mut scratch);
    plan.apply_into(&a, &mut again, &mut scratch);
    assert_eq!(first, again);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn sums_are_those_of_the_definition(
        radii in 1..400_usize, frequencies in 1..400_usize, log_alpha in -14.0..1.0_f64, seed in 0..1000_u64,
    ) {
        check(&noise(radii, seed), frequencies, log_alpha.exp(), 0..frequencies);
    }
}
