//! Pair histograms against brute force, exact lattices and the statistics of random sets.

use bn_core::{DVec2, PointSet, Seed, torus};
use bn_spectral::PairHistogram;
use proptest::prelude::*;

fn random_set(n: usize, seed: u64) -> PointSet {
    let mut rng = Seed::new(seed).stream(0);
    let points = (0..n).map(|_| DVec2::new(rng.random(), rng.random())).collect();
    PointSet::new(points).expect("in the unit square")
}

fn square_grid(m: usize) -> PointSet {
    let at = |i: usize| DVec2::new((i % m) as f64, (i / m) as f64) / m as f64;
    PointSet::new((0..m * m).map(at).collect()).expect("in the unit square")
}

fn brute_force(set: &PointSet, range: f64, bins: usize) -> Vec<u64> {
    let mut counts = vec![0; bins];
    for (i, &a) in set.points().iter().enumerate() {
        for &b in &set.points()[..i] {
            let bin = (torus::distance(a, b) * (bins as f64 / range)).floor();
            if bin < bins as f64 {
                counts[bin as usize] += 1;
            }
        }
    }
    counts
}

/// Enough points for several blocks and threads, with ranges on both sides of the cell grid's.
#[test]
fn counts_are_those_of_brute_force() {
    let set = random_set(2500, 1);
    for (range, bins) in [(0.5, 5000), (0.5, 1), (0.34, 77), (0.33, 100), (0.02, 500), (1e-3, 3)] {
        let histogram = PairHistogram::within(&set, range, bins);
        assert_eq!(histogram.counts(), brute_force(&set, range, bins), "{bins} bins to {range}");
    }
    assert_eq!(PairHistogram::new(&set, 640), PairHistogram::within(&set, 0.5, 640));
}

/// Distances of a 64×64 grid are √(a² + b²)/64; with bins of 1/12800, k/64 is the edge of bin 200k.
#[test]
fn distances_on_an_edge_belong_to_the_upper_bin() {
    let histogram = PairHistogram::new(&square_grid(64), 6400);
    let mut want = vec![0_u64; 6400];
    for a in -32_i32..32 {
        for b in -32_i32..32 {
            // ⌊200·√(a² + b²)⌋ in integers.
            let bin = (40_000 * (a * a + b * b) as u64).isqrt() as usize;
            if (a, b) != (0, 0) && bin < 6400 {
                want[bin] += 4096 / 2;
            }
        }
    }
    assert_eq!(histogram.counts(), want);
}

#[test]
fn any_number_of_threads_gives_the_same_counts() {
    let set = random_set(5000, 2);
    let counted = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| (PairHistogram::new(&set, 7071), PairHistogram::within(&set, 0.1, 999)))
    };
    assert_eq!(counted(1), counted(3));
}

/// Mean 1 and variance (1 − p)/(M p) in every bin: see `PairHistogram::rdf`.
#[test]
fn random_sets_have_a_flat_rdf() {
    let (n, bins) = (3000, 60);
    let rdf = PairHistogram::new(&random_set(n, 3), bins).rdf();
    let pairs = (n * (n - 1) / 2) as f64;
    let mut chi_square = 0.0;
    for (i, (r, g)) in rdf.iter().enumerate() {
        assert!((r - i as f64 / 120.0).abs() < 1e-15);
        let p = std::f64::consts::PI * rdf.step().powi(2) * (2 * i + 1) as f64;
        let deviation = (g - 1.0) / ((1.0 - p) / (pairs * p)).sqrt();
        assert!(deviation.abs() < 5.0, "{deviation} standard deviations at {r}");
        chi_square += deviation * deviation;
    }
    // 60 degrees of freedom: mean 60, standard deviation 11. Also too good a fit would be wrong.
    assert!((chi_square - 60.0).abs() < 55.0, "χ² = {chi_square}");
}

#[test]
fn a_single_point_and_coincident_ones_are_ordinary() {
    let one = PairHistogram::new(&random_set(1, 4), 10);
    assert!(one.counts().iter().all(|&count| count == 0));
    assert!(one.rdf().values().iter().all(|&g| g == 1.0));
    let at = DVec2::new(0.25, torus::ONE_MINUS_EPSILON);
    let same = PointSet::new(vec![at; 100]).expect("in the unit square");
    for range in [0.5, 0.01] {
        let histogram = PairHistogram::within(&same, range, 10);
        assert_eq!(histogram.counts()[0], 100 * 99 / 2);
        assert_eq!(histogram.counts()[1..].iter().sum::<u64>(), 0);
    }
    // Across the seam, and closer than squares can tell.
    let near = [at, DVec2::new(0.25, 0.0), DVec2::new(0.25, 1e-300)];
    let near = PointSet::new(near.to_vec()).expect("in the unit square");
    assert_eq!(PairHistogram::within(&near, 1e-9, 4).counts(), [3, 0, 0, 0]);
}

proptest! {
    #[test]
    fn small_sets_on_and_off_a_lattice(
        places in prop::collection::vec((0..12_u32, 0..12_u32, 0.0..1.0_f64), 1..40),
        bins in 1..200_usize, range in prop_oneof![Just(0.5), 0.01..0.5_f64],
    ) {
        let off = |k: u32, t: f64| torus::wrap(f64::from(k) / 12.0 + if t < 0.5 { 0.0 } else { t * 1e-3 });
        let points = places.iter().map(|&(i, j, t)| DVec2::new(off(i, t), off(j, 1.0 - t))).collect();
        let set = PointSet::new(points).expect("in the unit square");
        let histogram = PairHistogram::within(&set, range, bins);
        prop_assert_eq!(histogram.counts(), brute_force(&set, range, bins));
    }
}
