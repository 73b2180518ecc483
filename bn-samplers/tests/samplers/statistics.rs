//! What is known of patterns in closed form.

use bn_core::{PointSet, Seed, Unobserved};
use bn_geometry::{Spacing, Triangulation, bond_orientational_order};
use bn_samplers::{Construction, Jittered, Net, Sampler, Stochastic};
use bn_spectral::{JitteredGrid, Periodogram, PeriodogramOptions};

fn sets(sampler: &dyn Sampler, n: usize, count: u32) -> Vec<PointSet> {
    let sample = |set| sampler.sample(n, Seed::new(1).for_set(set), &Unobserved);
    (0..count).map(|set| sample(set).expect("valid").points).collect()
}

/// The periodogram of jittered grids is that of eq. 3.15, ring by ring.
#[test]
fn jittered_power_is_the_closed_form() {
    let (m, count) = (32, 20);
    let sets = sets(&Jittered::default(), m * m, count);
    let last = 80_i64;
    let got = Periodogram::of(&sets, PeriodogramOptions::new(last as usize)).expect("planned");
    let want = JitteredGrid::new(m);
    // One of each pair of conjugate modes, in rings of five cycles.
    let mut rings = vec![(0.0, 0.0); last as usize / 5];
    for kx in 0..=last {
        for ky in -last..=last {
            let ring = ((kx * kx + ky * ky) as f64).sqrt() as usize / 5;
            if (kx > 0 || ky > 0) && ring < rings.len() {
                let ratio = got.power(kx, ky) / want.power(kx as f64, ky as f64);
                rings[ring] = (rings[ring].0 + ratio, rings[ring].1 + 1.0);
            }
        }
    }
    for (ring, (sum, modes)) in rings.into_iter().enumerate() {
        // The amplitude of a mode is nearly normal, its power's relative variance 1 a set; where 2k
        // is a multiple of m in both axes, at a hundred modes of all, it can be twice as much.
        let error = (1.2 / (modes * f64::from(count))).sqrt();
        let ratio = sum / modes;
        assert!((ratio - 1.0).abs() < 5.0 * error, "ring {ring}: {ratio} ± {error}");
    }
}

/// Distances to nearest neighbours of a binomial process: mean ½·Γ(n)/Γ(n + ½), standard deviation
/// √(1/π − ¼)/√n but for 1/n; in units of `d_hex`.
#[test]
fn stochastic_neighbours_are_at_random_distances() {
    let (n, count) = (4096, 40);
    let (mut means, mut squares) = (0.0, 0.0);
    for set in sets(&Stochastic::default(), n, count) {
        let density = set.density();
        let distances = Spacing::new(&set);
        let normal = |d: f64| density.normalize_distance(d).value();
        means += normal(distances.mean());
        let squared = distances.nearest_distances().iter().map(|&d| normal(d).powi(2));
        squares += squared.sum::<f64>() / n as f64;
    }
    let mean = means / f64::from(count);
    let deviation = (squares / f64::from(count) - mean * mean).sqrt();
    // The mean of one set has a standard deviation of 0.0040; neighbours are correlated.
    let error = 0.0040 / f64::from(count).sqrt();
    assert!((mean - 0.46530).abs() < 5.0 * error, "{mean} ± {error}");
    // Relative to itself a standard deviation's error is about that of the mean of so many.
    assert!((deviation - 0.2432).abs() < 5.0 * error, "{deviation} ± {error}");
}

/// Q6 is no property of (0,m,2)-nets as such: the thesis's 0.66 is that of the net it shows.
#[test]
fn q6_differs_from_net_to_net() {
    let q6 = |construction| {
        let set = Net { construction }.sample(4096, Seed::new(1), &Unobserved).expect("valid");
        bond_orientational_order(&Triangulation::new(&set.points), 6).expect("points")
    };
    let families =
        [Construction::Maximin, Construction::Hammersley, Construction::LarcherPillichshammer];
    let [maximin, hammersley, larcher] = families.map(q6);
    // Measured; that of the maximin net is in the tables.
    for (got, want) in [(maximin, 0.682), (hammersley, 0.365), (larcher, 0.344)] {
        assert!((got - want).abs() < 0.005, "{maximin} {hammersley} {larcher}");
    }
}
