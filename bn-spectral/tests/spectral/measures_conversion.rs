//! RDF → radial power → RDF with the thesis's windows, on closed forms and back again.

use bn_core::{Curve, DVec2, Density, PointSet, Seed};
use bn_spectral::{
    HankelPlan, PairHistogram, PowerToRdf, RdfToPower, Window, highest_step, j0, step_rdf,
};
use rand::RngExt as _;

const N: usize = 4096;

fn rdf_of(g: impl Fn(f64) -> f64) -> Curve {
    let bins = RdfToPower::default_bins(N);
    Curve::sample(0.0, 0.5 / bins as f64, bins, g)
}

/// The definition, as a plain sum for noisy data and any n, square or not.
#[test]
fn power_is_the_plain_sum() {
    for (n, bins) in [(400, 2000), (400, 333), (397, 1993), (50, 707)] {
        let mut rng = Seed::new(3).stream(n);
        let points = (0..n).map(|_| DVec2::new(rng.random(), rng.random())).collect();
        let set = PointSet::new(points).expect("in the unit square");
        let rdf = PairHistogram::new(&set, bins).rdf();
        let power = RdfToPower::new(n as usize, bins).power(&rdf);
        let root = f64::from(n).sqrt();
        assert_eq!(power.values().len(), (100.0 * root).round() as usize);
        assert!((power.step() / (root / 200.0) - 1.0).abs() < 0.005 / root);
        for (nu, got) in power.iter().step_by(17).chain(power.iter().take(30)) {
            let half_width = 0.5 * (4.0 * nu / root).clamp(0.2, 0.5);
            let terms = rdf.iter().map(|(r, g)| {
                let j0 = j0(std::f64::consts::TAU * nu * r);
                r * rdf.step() * (g - 1.0) * j0 * Window::THESIS.at(r, half_width)
            });
            let want = 1.0 + std::f64::consts::TAU * f64::from(n) * terms.sum::<f64>();
            assert!((got - want).abs() < 1e-9, "{got} for {want} at {nu}");
        }
    }
}

/// g of the step spectrum against the same integral by Gauss–Legendre panels. The trapezoid rule
/// misses n·2π·Δr²/12·(1 − g(0)) w(0) = 1.3e-5 at the origin, by its definition.
#[test]
fn step_spectrum_through_the_window() {
    let n = N as f64;
    let nu0 = highest_step(n);
    let g = |r| step_rdf(n, nu0, r);
    let power = RdfToPower::new(N, RdfToPower::default_bins(N)).power(&rdf_of(g));
    let some: Vec<usize> = (25..6400).step_by(25).collect();
    let frequencies: Vec<f64> = some.iter().map(|&j| power.abscissa(j)).collect();
    let plan = HankelPlan::new(&[0.0, 0.25], 0.02, &frequencies);
    let exact = plan.transform(|r| n * (g(r) - 1.0) * Window::THESIS.at(r, 0.25));
    for (&j, want) in some.iter().zip(&exact) {
        let got = power.values()[j] - 1.0;
        assert!((got - want).abs() < 2e-5, "{got} for {want} at {}", power.abscissa(j));
    }
    // Beyond the main lobe of ±6 cycles it is a step.
    assert!(power.interpolate(nu0 - 7.0).abs() < 0.01);
    assert!((power.interpolate(nu0 + 7.0) - 1.0).abs() < 0.01);
}

/// P = 1 − exp(−πν²/s²) has g − 1 = −(s²/n) exp(−πs²r²), smooth and narrow in both domains.
#[test]
fn gaussian_well_from_power_to_rdf() {
    let (n, s) = (N as f64, 64.0);
    let well = |nu: f64| 1.0 - libm::exp(-std::f64::consts::PI * nu * nu / (s * s));
    let power = Curve::sample(0.0, 0.32, 6400, well);
    let g = PowerToRdf::new(Density::new(N), 6400, 0.32, 6400).rdf(&power);
    for (r, got) in g.iter() {
        // Blackman's window over ν ≤ 2048 takes (π² 0.82/2)(ν/2048)² = 0.4 % off the well's flank.
        let want = 1.0 - s * s / n * libm::exp(-std::f64::consts::PI * s * s * r * r);
        assert!((got - want).abs() < 3e-3, "{got} for {want} at {r}");
    }
    // Far out the correction at ν = 0 leaves (2π/n)·(2πr)²Δν⁴/480 = 3e-7 of 1.3e-5.
    assert!((g.values()[6000] - 1.0).abs() < 4e-7, "{}", g.values()[6000]);
}

/// There and back: 1 + w(r)(g(r) − 1) for a g whose structure is that of 100 cycles, as the window
/// narrows only for the lowest 8.
#[test]
fn round_trip_returns_the_windowed_rdf() {
    let (n, s) = (N as f64, 64.0);
    let g = |r: f64| {
        1.0 - s * s / n * libm::exp(-std::f64::consts::PI * s * s * r * r)
            + 0.3 * libm::exp(-((r - 0.06) / 0.01).powi(2)) * libm::cos(628.0 * (r - 0.06))
    };
    let bins = RdfToPower::default_bins(N);
    let power = RdfToPower::new(N, bins).power(&rdf_of(g));
    let back =
        PowerToRdf::new(Density::new(N), power.values().len(), power.step(), bins).rdf(&power);
    let mut squares = 0.0;
    for (r, got) in back.iter() {
        let want = 1.0 + Window::THESIS.at(r, 0.25) * (g(r) - 1.0);
        squares += (got - want).powi(2);
        assert!((got - want).abs() < 0.02, "{got} for {want} at {r}");
    }
    let rms = (squares / bins as f64).sqrt();
    assert!(rms < 2e-3, "{rms}");
}
