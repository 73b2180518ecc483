//! Windowed statistics against those of the thesis's authors' program, psa 1.1.

use bn_core::{DVec2, PointSet, Seed};
use bn_spectral::{JitteredGrid, RdfToPower, SpectrumError, WindowedSpectrum, effective_nyquist};
use rand::RngExt as _;

fn read(bytes: &[u8]) -> PointSet {
    let number = |b: &[u8]| f64::from(f32::from_le_bytes(b.try_into().expect("four bytes")));
    let points = bytes.chunks_exact(8).map(|b| DVec2::new(number(&b[..4]), number(&b[4..])));
    PointSet::new(points.collect()).expect("in the unit square")
}

/// The six sets with ν_eff (given to 0.005) and Ω (to 0.001) of `data/psa_values.csv`.
fn sets() -> Vec<(&'static str, PointSet, f64, f64)> {
    let files: [(&str, &[u8]); 6] = [
        ("random_0.rps", include_bytes!("../data/random_0.rps")),
        ("step_0.rps", include_bytes!("../data/step_0.rps")),
        ("singlepeak_0.rps", include_bytes!("../data/singlepeak_0.rps")),
        ("fpo_0.rps", include_bytes!("../data/fpo_0.rps")),
        ("grid_0.rps", include_bytes!("../data/grid_0.rps")),
        ("hexapprox_0.rps", include_bytes!("../data/hexapprox_0.rps")),
    ];
    let values = include_str!("../data/psa_values.csv");
    let row = |(name, bytes): (&'static str, &[u8])| {
        let row = values.lines().find(|row| row.starts_with(name)).expect("a row for every file");
        let mut last = row.rsplit(',').map(|cell| cell.parse().expect("a number"));
        let omega = last.next().expect("omega");
        (name, read(bytes), last.next().expect("nu_eff"), omega)
    };
    files.into_iter().map(row).collect()
}

/// psa computes in single precision: its ν_eff is met to the sample, its Ω to 1e-3 of itself.
#[test]
fn single_sets() {
    for (name, set, nu_eff, omega) in sets() {
        let spectrum = WindowedSpectrum::of(std::slice::from_ref(&set)).expect("one set");
        let got = spectrum.effective_nyquist().expect("exists").value();
        assert!((got - nu_eff).abs() < 1e-9, "ν_eff of {name}: {got} for {nu_eff}");
        let got = spectrum.oscillation().expect("exists");
        assert!((got - omega).abs() < 5e-4 + 2e-4 * omega, "Ω of {name}: {got} for {omega}");
    }
}

/// The mean of ten jittered sets: ν_eff 0.24 and Ω 0.06 in the thesis's table 3.1.
#[test]
fn ensembles_are_averaged_before_they_are_measured() {
    let mut sets = Vec::new();
    for set in 0..10 {
        let mut rng = Seed::new(5).for_set(set).stream(0);
        let cells = (0..4096_u32).map(|c| DVec2::new(f64::from(c % 64), f64::from(c / 64)));
        let points = cells.map(|cell| (cell + DVec2::new(rng.random(), rng.random())) / 64.0);
        sets.push(PointSet::new(points.collect()).expect("in the unit square"));
    }
    let each = WindowedSpectrum::of_each(&sets).expect("equal sizes");
    let mean = WindowedSpectrum::of(&sets).expect("equal sizes");
    assert_eq!(mean, WindowedSpectrum::mean(&each).expect("equal sizes"));
    let nu_eff = mean.effective_nyquist().expect("exists").value();
    assert!((nu_eff - 0.24).abs() <= 0.02, "{nu_eff}");
    let omega = mean.oscillation().expect("exists");
    assert!((omega - 0.06).abs() <= 0.03, "{omega}");
    // Noise of one set is √10 times that of the mean.
    let single = each[0].oscillation().expect("exists") / omega;
    assert!((2.0..5.0).contains(&single), "{single}");
    // The closed form behind it, unblurred: 0.2538; the sum in C and the grid take one sample each.
    let exact = mean.power().map(|nu, _| JitteredGrid::new(64).radial_power(nu));
    let exact = effective_nyquist(&exact, mean.density(), 0.1).expect("exists").value();
    assert!((exact - 0.2538).abs() <= 0.01, "{exact}");
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let [(_, random, ..), (_, step, ..), ..] = &sets()[..] else { panic!("six sets") };
    let both = [random.clone(), step.clone()];
    let spectrum = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| WindowedSpectrum::of(&both).expect("equal sizes"))
    };
    assert_eq!(spectrum(1), spectrum(3));
}

#[test]
fn tiny_sets_have_what_exists() {
    for n in [1, 2, 3, 5, 99, 150] {
        let mut rng = Seed::new(9).stream(n);
        let points = (0..n).map(|_| DVec2::new(rng.random(), rng.random())).collect();
        let set = PointSet::new(points).expect("in the unit square");
        let spectrum = WindowedSpectrum::of(&[set]).expect("one set");
        assert_eq!(spectrum.power().values().len(), RdfToPower::default_bins(n as usize));
        assert!(spectrum.power().values().iter().all(|p| p.is_finite()));
        assert_eq!(spectrum.oscillation().is_some(), n == 150, "{n} points");
        if n == 1 {
            // The samples end at n/2 = √n/2.
            assert!(spectrum.power().values().iter().all(|&p| p == 1.0));
            assert_eq!(spectrum.effective_nyquist(), None);
        }
    }
}

#[test]
fn sets_that_do_not_belong_together_are_refused() {
    let set = |n: usize| PointSet::new(vec![DVec2::ZERO; n]).expect("in the unit square");
    assert_eq!(WindowedSpectrum::of(&[]), Err(SpectrumError::NoSets));
    let mixed = WindowedSpectrum::of(&[set(3), set(3), set(4)]);
    assert_eq!(mixed, Err(SpectrumError::MixedSizes { first: 3, other: 4 }));
}
