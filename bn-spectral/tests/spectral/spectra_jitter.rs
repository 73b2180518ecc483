//! Stratified jitter: closed form against tabulated integrals and against point sets.

use bn_core::{DVec2, Seed};
use bn_spectral::JitteredGrid;
use rand::RngExt as _;

/// Columns ν/√n, radial mean, cuts along the axis and the diagonal, 12 digits.
#[test]
fn radial_mean_and_cuts_match_the_table() {
    let cells = 64.0;
    let jitter = JitteredGrid::new(64);
    let rows = include_str!("../data/jitter_radial.csv").lines().skip(1);
    let mut count = 0;
    for row in rows {
        let cells_of_row: Vec<f64> =
            row.split(',').map(|cell| cell.parse().expect("a number")).collect();
        let nu = cells_of_row[0] * cells;
        let diagonal = nu * std::f64::consts::FRAC_1_SQRT_2;
        let got =
            [jitter.radial_power(nu), jitter.power(nu, 0.0), jitter.power(diagonal, diagonal)];
        for (got, want) in got.iter().zip(&cells_of_row[1..]) {
            assert!((got - want).abs() <= 6e-13, "{got} for {want} at {nu}");
        }
        count += 1;
    }
    assert_eq!(count, 401);
}

/// Mean power of 400 sets of 8×8 at some modes: the sample variance gives the tolerance.
#[test]
fn sets_have_the_expected_power() {
    let (m, sets) = (8_u32, 400_u32);
    let mut rng = Seed::new(11).stream(0);
    let modes = [(1.0, 0.0), (3.0, 2.0), (4.0, -4.0), (8.0, 1.0), (13.0, 5.0)];
    let (mut sum, mut squares) = ([0.0; 5], [0.0; 5]);
    for _ in 0..sets {
        let cells = (0..m * m).map(|c| DVec2::new(f64::from(c % m), f64::from(c / m)));
        let points: Vec<DVec2> = cells
            .map(|cell| (cell + DVec2::new(rng.random(), rng.random())) / f64::from(m))
            .collect();
        for (k, &(kx, ky)) in modes.iter().enumerate() {
            let phases = points.iter().map(|p| std::f64::consts::TAU * (kx * p.x + ky * p.y));
            let (re, im) = phases
                .fold((0.0, 0.0), |(re, im), phase| (re + libm::cos(phase), im + libm::sin(phase)));
            let power = (re * re + im * im) / f64::from(m * m);
            sum[k] += power / f64::from(sets);
            squares[k] += power * power / f64::from(sets);
        }
    }
    for (k, &(kx, ky)) in modes.iter().enumerate() {
        let deviation = ((squares[k] - sum[k] * sum[k]) / f64::from(sets)).sqrt();
        let want = JitteredGrid::new(m as usize).power(kx, ky);
        assert!((sum[k] - want).abs() < 5.0 * deviation, "{} for {want} at {kx}, {ky}", sum[k]);
    }
}
