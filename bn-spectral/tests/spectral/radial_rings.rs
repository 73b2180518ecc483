//! Ring means, anisotropy and power below a frequency: against sums over single modes, closed
//! forms and the variances of random points.

use bn_core::{DVec2, PointSet, Seed};
use bn_spectral::{JitteredGrid, Periodogram, PeriodogramOptions, RadialPower, power_below};
use rand::RngExt as _;

fn random_set(n: usize, task: u32) -> PointSet {
    let mut rng = Seed::new(37).stream(task);
    let points = (0..n).map(|_| DVec2::new(rng.random(), rng.random())).collect();
    PointSet::new(points).expect("in the unit square")
}

fn jittered_set(m: usize, task: u32) -> PointSet {
    let mut rng = Seed::new(38).stream(task);
    let points = (0..m * m)
        .map(|i| {
            let corner = DVec2::new((i % m) as f64, (i / m) as f64);
            (corner + DVec2::new(rng.random(), rng.random())) / m as f64
        })
        .collect();
    PointSet::wrapped(points).expect("finite")
}

fn square_grid(m: usize) -> PointSet {
    let cell = |i: usize| DVec2::new((i % m) as f64, (i / m) as f64) / m as f64;
    PointSet::new((0..m * m).map(cell).collect()).expect("in the unit square")
}

fn radial(sets: &[PointSet], k: usize) -> RadialPower {
    RadialPower::of(sets, PeriodogramOptions::new(k)).expect("a spectrum")
}

/// All modes (kx, ky) ≠ 0 with |kx|, |ky| ≤ K and their |k|.
fn modes(k: i64) -> impl Iterator<Item = (i64, i64, f64)> {
    let square = (-k..=k).flat_map(move |kx| (-k..=k).map(move |ky| (kx, ky)));
    square
        .filter(|&mode| mode != (0, 0))
        .map(|(kx, ky)| (kx, ky, ((kx * kx + ky * ky) as f64).sqrt()))
}

#[test]
fn rings_hold_the_mean_and_the_variance_of_their_modes() {
    let sets = [random_set(150, 1), random_set(150, 2)];
    let k = 12;
    let spectrum = radial(&sets, k);
    // Wider, so that the outermost ring is whole.
    let all = Periodogram::of(&sets, PeriodogramOptions::new(k + 1)).expect("a periodogram");
    assert_eq!(spectrum.bounds().len(), k + 1);
    let decibels = spectrum.anisotropy_db().expect("rings");
    for ring in 0..k {
        let inside = spectrum.bounds()[ring]..spectrum.bounds()[ring + 1];
        assert_eq!(inside, ring as f64 + 0.5..ring as f64 + 1.5);
        let powers: Vec<f64> = modes(k as i64 + 1)
            .filter(|(_, _, nu)| inside.contains(nu))
            .map(|(kx, ky, _)| all.power(kx, ky))
            .collect();
        let count = powers.len() as f64;
        let mean = powers.iter().sum::<f64>() / count;
        // k and −k are one observation.
        let variance = powers.iter().map(|p| (p - mean).powi(2)).sum::<f64>() / (count - 2.0);
        assert_eq!(spectrum.modes()[ring], powers.len() as u64, "ring {ring}");
        assert!((spectrum.means()[ring] - mean).abs() < 1e-5 * mean, "ring {ring}");
        let want = 10.0 * (variance / (mean * mean)).log10();
        assert!((decibels.values()[ring] - want).abs() < 1e-3, "ring {ring}");
        assert_eq!(decibels.abscissa(ring), ring as f64 + 1.0);
    }
}

#[test]
fn modes_are_counted_like_lattice_points_in_a_disk() {
    let spectrum = radial(&[random_set(5, 3)], 400);
    let counted: u64 = spectrum.modes().iter().sum();
    let disk = std::f64::consts::PI * 400.5_f64.powi(2);
    // Gauss's circle problem: the difference is far below the circumference.
    assert!((counted as f64 - disk).abs() < 0.1 * disk.sqrt(), "{counted} in {disk}");
}

#[test]
fn ring_means_of_random_points_scatter_as_they_should() {
    let (n, k, sets) = (900, 80, 4);
    let ensemble: Vec<_> = (0..sets).map(|i| random_set(n, 10 + i)).collect();
    let spectrum = radial(&ensemble, k);
    let (mut chi_square, mut rings) = (0.0, 0);
    for (ring, (&mean, &modes)) in spectrum.means().iter().zip(spectrum.modes()).enumerate() {
        // c modes of R sets: variance (1 − 1/n)·2/(cR).
        let variance = (1.0 - 1.0 / n as f64) * 2.0 / (modes as f64 * f64::from(sets));
        let deviation = (mean - 1.0) / variance.sqrt();
        if modes >= 40 {
            assert!(deviation.abs() < 5.0, "ring {ring}: {mean}, {deviation} sd");
        }
        chi_square += deviation * deviation;
        rings += 1;
    }
    // χ² of that many nearly normal means: sd √(2·rings), a little more for the first ones' tails.
    let excess = (chi_square - f64::from(rings)) / (2.0 * f64::from(rings)).sqrt();
    assert!(excess.abs() < 5.0, "{excess}");
}

#[test]
fn anisotropy_of_an_ensemble_is_minus_ten_log_of_its_size() {
    for sets in [1, 8] {
        let ensemble: Vec<_> = (0..sets).map(|i| random_set(500, 20 + i)).collect();
        let spectrum = radial(&ensemble, 60);
        let decibels = spectrum.anisotropy_db().expect("rings");
        // Var/mean² of rings of c/2 = M modes: expectation 1/R·(1 − 1/M), relative sd below
        // √(8/M) for exponential powers; over rings 10 … 59 there are 5500 modes.
        let ratios = decibels.values()[9..].iter().map(|d| 10_f64.powf(d / 10.0));
        let weights = spectrum.modes()[9..].iter().map(|&c| c as f64);
        let (mut sum, mut weight) = (0.0, 0.0);
        for (ratio, w) in ratios.zip(weights) {
            sum += ratio * w;
            weight += w;
        }
        let ratio = sum / weight * f64::from(sets);
        let bound = 5.0 * (8.0 / (weight / 2.0)).sqrt();
        assert!((ratio - 1.0).abs() < bound, "{sets} sets: {ratio}, within {bound}");
    }
}

#[test]
fn jittered_points_follow_their_closed_form() {
    let (m, sets) = (24, 8);
    let ensemble: Vec<_> = (0..sets).map(|i| jittered_set(m, i)).collect();
    let spectrum = radial(&ensemble, 70);
    let model = JitteredGrid::new(m);
    for (ring, (&mean, &count)) in spectrum.means().iter().zip(spectrum.modes()).enumerate() {
        let inside = spectrum.bounds()[ring]..spectrum.bounds()[ring + 1];
        let (mut want, mut squares) = (0.0, 0.0);
        for (kx, ky, _) in modes(72).filter(|(_, _, nu)| inside.contains(nu)) {
            let power = model.power(kx as f64, ky as f64);
            want += power;
            squares += power * power;
        }
        // Amplitudes are nearly Gaussian: Var P = P² each, k and −k together.
        let c = count as f64;
        let sd = (2.0 * squares / f64::from(sets)).sqrt() / c;
        assert!((mean - want / c).abs() < 6.0 * sd, "ring {ring}: {mean}, not {}", want / c);
    }
}

#[test]
fn a_square_grid_is_silent_up_to_its_first_ring() {
    let spectrum = radial(&[square_grid(32)], 70);
    for (ring, &mean) in spectrum.means().iter().enumerate() {
        let nu = ring + 1;
        let peaks = match nu {
            // (±32, 0) and (0, ±32); (±32, ±32) at 45.25; (±64, 0) and (0, ±64).
            32 | 45 | 64 => 4.0,
            _ => 0.0,
        };
        let want = 1024.0 * peaks / spectrum.modes()[ring] as f64;
        assert!((mean - want).abs() < 1e-4 * want + 1e-9, "ν = {nu}: {mean}, not {want}");
    }
    let nu_eff = spectrum.effective_nyquist().expect("reaches the thresholds").value();
    assert!((nu_eff - 1.0).abs() <= 0.5 / 32.0, "{nu_eff}");
    assert!(power_below(&square_grid(32), 32.0).expect("planned").expect("modes") < 1e-9);
}

#[test]
fn power_below_counts_modes_strictly_inside() {
    let set = random_set(200, 30);
    let all = Periodogram::of(std::slice::from_ref(&set), PeriodogramOptions::new(20))
        .expect("a periodogram");
    for frequency in [1.01, std::f64::consts::SQRT_2, 2.0, 5.0, 7.3, 18.999] {
        let powers: Vec<f64> = modes(20)
            .filter(|&(.., nu)| nu < frequency)
            .map(|(kx, ky, _)| all.power(kx, ky))
            .collect();
        let want = powers.iter().sum::<f64>() / powers.len() as f64;
        let got = power_below(&set, frequency).expect("planned").expect("modes");
        assert!((got - want).abs() < 1e-5 * want, "below {frequency}: {got}, not {want}");
    }
    for frequency in [f64::NAN, -3.0, 0.0, 0.5, 1.0] {
        assert_eq!(power_below(&set, frequency), Ok(None), "{frequency}");
    }
    assert!(power_below(&set, f64::INFINITY).is_err());
}

/// Several blocks of columns, several threads: the same bytes as one after the other.
#[test]
fn rings_do_not_depend_on_threads() {
    let set = random_set(300, 31);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| radial(std::slice::from_ref(&set), 260))
    };
    let one = run(1);
    assert!(one == run(2) && one == run(3));
}

#[test]
fn no_ring_no_curve() {
    let spectrum = radial(&[random_set(10, 32)], 0);
    assert!(spectrum.curve().is_none() && spectrum.anisotropy_db().is_none());
    assert_eq!(spectrum.effective_nyquist(), None);
    assert_eq!(spectrum.oscillation(), None);
}
