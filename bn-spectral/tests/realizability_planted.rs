//! Realizability of spectra whose answer is known.

use bn_core::{DVec2, Density, PointSet, Seed};
use bn_spectral::{Realizability, SinglePeak, Target, Warning, feasible_region, highest_step};
use rand::RngExt as _;

const N: usize = 4096;

fn density() -> Density {
    Density::new(N)
}

#[test]
fn the_step_is_realizable_up_to_its_highest_frequency() {
    for (scale, want) in [(0.99, true), (1.0, true), (1.01, false)] {
        let target = Target::step(density(), scale * highest_step(N as f64)).expect("valid");
        let verdict = Realizability::of(&target);
        assert_eq!(verdict.realizable, want, "{scale}: {verdict:?}");
        // g(0) = 1 − (ν₀/ν_max)².
        assert!((verdict.min_g - (1.0 - scale * scale)).abs() < 1e-12 && verdict.at_r == 0.0);
        assert_eq!(verdict.min_power, 0.0);
        assert_eq!(verdict.reason().is_none(), want);
    }
}

/// Errata 6: the thesis's reference peak leaves g at about −0.2; 1.33 ν_max leaves 0.24 at best.
#[test]
fn the_reference_peak_is_not_realizable() {
    let peak = SinglePeak::thesis(density());
    let verdict = Realizability::of(&Target::single_peak(density(), peak).expect("valid"));
    assert!(!verdict.realizable && (-0.25..-0.15).contains(&verdict.min_g), "{verdict:?}");
    let lower = SinglePeak { nu0: 48.0, peak: 12.0, sigma: 2.0, width: 1.0 };
    let verdict = Realizability::of(&Target::single_peak(density(), lower).expect("valid"));
    assert!(verdict.realizable, "{verdict:?}");
}

#[test]
fn lattices_exist() {
    let m = 32_u32;
    let lattice = (0..m * m).map(|i| DVec2::new(f64::from(i % m), f64::from(i / m)) / f64::from(m));
    let set = PointSet::new(lattice.collect()).expect("valid");
    let verdict = Realizability::of(&Target::imitating(&[set], 1024).expect("measurable"));
    assert!(verdict.realizable, "{verdict:?}");
}

#[test]
fn negative_power_is_found_where_it_is() {
    let dip = |nu: f64| if (40.0..42.0).contains(&nu) { -0.3 } else { 1.0 };
    let samples: Vec<_> =
        (0..400).map(|i| (f64::from(i) * 0.25, dip(f64::from(i) * 0.25))).collect();
    let verdict = Realizability::of(&Target::power_curve(density(), &samples).expect("valid"));
    assert!(!verdict.realizable && verdict.min_power == -0.3);
    assert!((40.0..42.0).contains(&verdict.at_nu), "{verdict:?}");
}

/// P whose g is 1 but for a dip of half-width w around r₀, planted through its transform.
#[test]
fn a_negative_rdf_in_a_narrow_band_is_found() {
    let (r0, w) = (0.03, 0.0015);
    for (depth, want) in [(0.9, true), (1.1, false)] {
        let g = |r: f64| 1.0 - depth * libm::exp(-0.5 * ((r - r0) / w).powi(2));
        let samples: Vec<_> =
            (0..6000).map(|i| (f64::from(i) * 5e-5, g(f64::from(i) * 5e-5))).collect();
        let from_g = Target::rdf_curve(density(), &samples).expect("valid");
        // To a curve of P, and from there alone.
        let spectrum: Vec<_> =
            (0..4000).map(|i| (f64::from(i) * 0.2, from_g.power(f64::from(i) * 0.2))).collect();
        let low = spectrum.iter().map(|(_, p)| *p).fold(1.0, f64::min);
        // The dip also takes power away: P ≥ 0 must not be what decides.
        let lifted: Vec<_> = if low < 0.0 {
            spectrum.iter().map(|&(nu, p)| (nu, p.max(0.0))).collect()
        } else {
            spectrum
        };
        let verdict = Realizability::of(&Target::power_curve(density(), &lifted).expect("valid"));
        if low >= 0.0 {
            assert_eq!(verdict.realizable, want, "{verdict:?}");
            assert!((verdict.at_r - r0).abs() < w, "{verdict:?}");
        }
        let direct = Realizability::of(&from_g);
        assert!((direct.min_g - (1.0 - depth)).abs() < 2e-3 && (direct.at_r - r0).abs() < 0.2 * w);
    }
}

/// Random members of the peaks' family against g on a dense grid, summed from thin annuli.
#[test]
fn random_families_agree_with_brute_force() {
    let mut rng = Seed::new(11).stream(0);
    let (mut yes, mut no) = (0, 0);
    for _ in 0..40 {
        let nu0 = 36.108 * (0.9 + 0.7 * rng.random::<f64>());
        let sigma = 0.5 + 4.0 * rng.random::<f64>();
        let peak = SinglePeak { nu0, peak: 20.0 * rng.random::<f64>(), sigma, width: 1.0 };
        let target = Target::single_peak(density(), peak).expect("valid");
        let least = brute_force(peak);
        let verdict = Realizability::of(&target);
        assert!((verdict.min_g - least).abs() < 2e-3, "{peak:?}: {} and {least}", verdict.min_g);
        if least.abs() > 2e-3 {
            assert_eq!(verdict.realizable, least > 0.0, "{peak:?}");
        }
        if verdict.realizable { yes += 1 } else { no += 1 }
    }
    assert!(yes > 5 && no > 5, "{yes} realizable, {no} not: nothing was tested");
}

/// The least of g = 1 + (2π/n) Σ ν (P − 1) J₀(2πνr) Δν on a dense grid.
fn brute_force(peak: SinglePeak) -> f64 {
    let (step, n) = (0.1, N as f64);
    let nu: Vec<f64> = (0..1000).map(|i| (f64::from(i) + 0.5) * step).collect();
    let excess: Vec<f64> = nu.iter().map(|nu| peak.power(*nu) - 1.0).collect();
    let g = |r: f64| {
        let x: Vec<f64> = nu.iter().map(|nu| std::f64::consts::TAU * nu * r).collect();
        let mut j0 = vec![0.0; x.len()];
        bn_spectral::j0_slice(&x, &mut j0);
        let sum: f64 = (0..x.len()).map(|i| nu[i] * excess[i] * j0[i]).sum();
        1.0 + std::f64::consts::TAU / n * step * sum
    };
    (0..800).map(|i| g(f64::from(i) * 2e-4)).fold(1.0, f64::min)
}

#[test]
fn empty_regions_that_are_too_wide_are_named() {
    let root = (N as f64).sqrt();
    for (edge, want) in [(0.5, "none"), (0.85, "stealthy"), (1.1, "hexagonal")] {
        let verdict = Realizability::of(&Target::step(density(), edge * root).expect("valid"));
        let named = verdict.warnings.iter().find_map(|warning| match warning {
            Warning::Stealthy { .. } => Some("stealthy"),
            Warning::BeyondHexagonal { .. } => Some("hexagonal"),
            _ => None,
        });
        assert_eq!(named.unwrap_or("none"), want, "{verdict:?}");
    }
}

/// The number variance of the step at R = 0.5/√n is πR²n less what P = 0 takes away; Yamada's bound
/// bites for spectra with no power at all up to 0.95 √n.
#[test]
fn too_regular_numbers_are_warned_of() {
    let of = |z: f64| {
        let nu0 = z * (N as f64).sqrt();
        Realizability::of(&Target::step(density(), nu0).expect("valid")).warnings
    };
    let number = |warnings: &[Warning]| {
        warnings.iter().any(|warning| matches!(warning, Warning::NumberVariance { .. }))
    };
    assert!(!number(&of(0.56)) && number(&of(0.95)));
}

#[test]
fn the_feasible_region_ends_where_the_step_does() {
    let highest = highest_step(N as f64);
    let nu0 = [0.9 * highest, 1.1 * highest];
    let margins = feasible_region(&nu0, &[1e-3, 2.5], |nu0, sigma| {
        let peak = SinglePeak { nu0, peak: 0.0, sigma, width: 1.0 };
        Target::single_peak(density(), peak).ok()
    });
    assert!(margins[0] >= -1e-9 && margins[1] < 0.0, "{margins:?}");
    assert!(feasible_region(&[1.0], &[1.0], |_, _| None)[0].is_nan());
}
