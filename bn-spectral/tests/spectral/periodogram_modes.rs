//! Periodograms against the definition, against what is known of random points, near silence.

use bn_core::{DVec2, PointSet, Seed};
use bn_spectral::{NufftError, Periodogram, PeriodogramOptions, PowerImage, direct_modes};
use rand::RngExt as _;

fn random_set(n: usize, task: u32) -> PointSet {
    let mut rng = Seed::new(27).stream(task);
    let points = (0..n).map(|_| DVec2::new(rng.random(), rng.random())).collect();
    PointSet::new(points).expect("in the unit square")
}

/// An m × m grid, each point displaced by up to `size` in either axis.
fn shaken_grid(m: usize, size: f64, task: u32) -> PointSet {
    let mut rng = Seed::new(28).stream(task);
    let mut shake = || size * (2.0 * rng.random::<f64>() - 1.0);
    let points = (0..m * m)
        .map(|i| {
            let cell = DVec2::new((i % m) as f64 + 0.5, (i / m) as f64 + 0.5);
            cell / m as f64 + DVec2::new(shake(), shake())
        })
        .collect();
    PointSet::wrapped(points).expect("finite")
}

#[test]
fn power_is_the_squared_sum_over_the_number_of_points() {
    let k = 40;
    let sets = [random_set(300, 1), random_set(500, 2), random_set(20, 3)];
    let mean = Periodogram::of(&sets, PeriodogramOptions::new(k)).expect("a periodogram");
    let sums: Vec<_> = sets.iter().map(|set| direct_modes(set.points(), None, k)).collect();
    for kx in -(k as i64)..=k as i64 {
        for ky in -(k as i64)..=k as i64 {
            let powers = sets
                .iter()
                .zip(&sums)
                .map(|(set, sums)| sums.get(kx, ky).norm_sqr() / set.len() as f64);
            let want = powers.sum::<f64>() / 3.0;
            // The tolerance 1e-6 is an rms over the modes, the worst are ten times that.
            let bound = 1e-5 * (2.0 * want.sqrt() + 1e-5);
            assert!((mean.power(kx, ky) - want).abs() < bound, "({kx}, {ky})");
            // Both halves of the column kx = 0 are computed, to rounding alike.
            let opposite = mean.power(-kx, -ky);
            assert!((mean.power(kx, ky) - opposite).abs() <= 1e-9 * (1.0 + opposite));
        }
    }
    let sizes = (300.0 + 500.0 + 20.0) / 3.0;
    assert!((mean.power(0, 0) - sizes).abs() < 1e-3, "the mode 0 is n");
}

#[test]
fn random_points_have_power_one() {
    // Mean over M independent modes of variance (1 − 1/n)/R.
    let (n, k, sets) = (1000, 60_usize, 3);
    let ensemble: Vec<_> = (0..sets).map(|i| random_set(n, 10 + i)).collect();
    let mean = Periodogram::of(&ensemble, PeriodogramOptions::new(k)).expect("a periodogram");
    let (mut sum, mut squares, mut count) = (0.0, 0.0, 0);
    for kx in 0..=k as i64 {
        for ky in -(k as i64)..=k as i64 {
            if kx > 0 || ky > 0 {
                let p = mean.power(kx, ky);
                sum += p;
                squares += (p - 1.0).powi(2);
                count += 1;
            }
        }
    }
    let (average, variance) = (sum / f64::from(count), squares / f64::from(count));
    let sd = ((1.0 - 1.0 / n as f64) / f64::from(count) / f64::from(sets)).sqrt();
    assert!((average - 1.0).abs() < 5.0 * sd, "{average}, sd {sd}");
    // Means of 3 exponentials: fourth central moment 3/R² + 6/R³, so a variance known to √(1.2/M).
    let want = (1.0 - 1.0 / n as f64) / f64::from(sets);
    let sd = want * ((2.0 + 6.0 / f64::from(sets)) / f64::from(count)).sqrt();
    assert!((variance - want).abs() < 5.0 * sd, "{variance}, sd {sd}");
}

#[test]
fn a_lattice_has_its_peaks_and_nothing_else() {
    let set = shaken_grid(24, 0.0, 0);
    let spectrum = Periodogram::of(&[set], PeriodogramOptions::new(60)).expect("a periodogram");
    for kx in -60..=60 {
        for ky in -60..=60 {
            let power = spectrum.power(kx, ky);
            if kx % 24 == 0 && ky % 24 == 0 {
                assert!((power / 576.0 - 1.0).abs() < 1e-4, "({kx}, {ky}): {power}");
            } else {
                assert!(power < 1e-6, "({kx}, {ky}): {power:e}");
            }
        }
    }
}

/// The error in S/√n is about ε, so with ε = 1e-6 powers of 1e-9 keep two digits and the mean over
/// many of them more, next to modes of power 1 and beyond.
#[test]
fn powers_near_zero_are_resolved() {
    for (size, range) in [(2e-6, 1e-9..1e-6), (1e-7, 1e-12..1e-9)] {
        let set = shaken_grid(40, size, 5);
        let spectrum = Periodogram::of(std::slice::from_ref(&set), PeriodogramOptions::new(200))
            .expect("a periodogram");
        let exact = direct_modes(set.points(), None, 30);
        let (mut got, mut want, mut worst) = (0.0, 0.0, 0.0_f64);
        for kx in 0..=30 {
            for ky in 1..=30 {
                let power = exact.get(kx, ky).norm_sqr() / 1600.0;
                got += spectrum.power(kx, ky);
                want += power;
                let error = (spectrum.power(kx, ky) - power).abs();
                worst = worst.max(error / (2.0 * power.sqrt() + 1e-6));
            }
        }
        let (got, want) = (got / 930.0, want / 930.0);
        println!("mean power {want:.3e}, computed {got:.3e}, errors {worst:.1e} in S/√n");
        assert!(range.contains(&want), "{want:e}");
        assert!((got / want - 1.0).abs() < 0.01, "{got:e}, not {want:e}");
        assert!(worst < 3e-6);
    }
}

#[test]
fn the_smallest_cases_work() {
    let one = PointSet::new(vec![DVec2::new(0.2, 0.9)]).expect("valid");
    let spectrum =
        Periodogram::of(std::slice::from_ref(&one), PeriodogramOptions::new(0)).expect("K = 0");
    assert!((spectrum.power(0, 0) - 1.0).abs() < 1e-12);
    let spectrum = Periodogram::of(&[one], PeriodogramOptions::new(3)).expect("K = 3");
    for kx in -3..=3 {
        for ky in -3..=3 {
            assert!((spectrum.power(kx, ky) - 1.0).abs() < 1e-12);
        }
    }
    let same = PointSet::new(vec![DVec2::new(0.7, 0.1); 900]).expect("valid");
    let spectrum = Periodogram::of(&[same], PeriodogramOptions::new(12)).expect("coincident");
    assert!((spectrum.power(12, -12) / 900.0 - 1.0).abs() < 1e-4);
    assert!((spectrum.power(5, 7) / 900.0 - 1.0).abs() < 1e-5);
    let refused = PeriodogramOptions::new(usize::MAX);
    let set = random_set(10, 9);
    assert!(matches!(Periodogram::of(&[set], refused), Err(NufftError::Frequency { .. })));
}

#[test]
fn images_average_blocks_of_modes() {
    let set = random_set(400, 11);
    let sets = std::slice::from_ref(&set);
    let modes = Periodogram::of(sets, PeriodogramOptions::new(40)).expect("a periodogram");
    for (k, most) in [(20_i64, 41), (20, 20), (20, 13), (20, 5), (7, 1), (0, 3)] {
        let options = PeriodogramOptions::new(k as usize);
        let image = PowerImage::of(sets, options, most).expect("an image");
        assert!(image.side() <= most && image.side() % 2 == 1, "{} cells", image.side());
        let block = (2.0 * image.half_width()) as i64 / image.side() as i64;
        let limit = (image.half_width() - 0.5) as i64;
        assert!(limit >= k && limit < k + block, "K = {limit} for {k}");
        for (i, &got) in image.power().iter().enumerate() {
            let corner = |c: usize| c as i64 * block - limit;
            let (x, y) = (corner(i % image.side()), corner(i / image.side()));
            let cell = (0..block).flat_map(|dx| (0..block).map(move |dy| (x + dx, y + dy)));
            let powers: Vec<f64> =
                cell.filter(|&c| c != (0, 0)).map(|(kx, ky)| modes.power(kx, ky)).collect();
            let want = powers.iter().sum::<f64>() / powers.len() as f64;
            let alike = (got - want).abs() < 1e-4 * (1.0 + want);
            assert!(alike || powers.is_empty() && got.is_nan(), "({x}, {y}): {got}, not {want}");
        }
    }
}
