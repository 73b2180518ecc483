//! Realizability of spectra whose answer is known.

use bn_core::{DVec2, Density, PointSet, Seed};
use bn_spectral::{
    Realizability, SinglePeak, Target, TargetError, Warning, feasible_region, highest_step,
};
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

/// The square lattice, and the nearly hexagonal one of 60 × 70 points in shifted rows.
#[test]
fn lattices_exist() {
    for (across, down, shift) in [(32_u32, 32_u32, 0.0), (60, 70, 0.5)] {
        let place = |i: u32| {
            let (ix, iy) = (i % across, i / across);
            let x = f64::from(ix) + shift * f64::from(iy % 2);
            DVec2::new(x / f64::from(across), f64::from(iy) / f64::from(down))
        };
        let set = PointSet::new((0..across * down).map(place).collect()).expect("valid");
        let n = set.len();
        let verdict = Realizability::of(&Target::imitating(&[set], n).expect("measurable"));
        assert!(verdict.realizable && verdict.warnings.is_empty(), "{verdict:?}");
    }
}

/// A thin ring of g at r₀ adds A·J₀(2πνr₀) to P: the mirror of the ring of power, at distances where P
/// turns many times a spacing.
#[test]
fn a_ring_of_neighbours_takes_power_away() {
    for (n, r0, a, want) in [
        (4096, 0.45, 2.46, true),
        (4096, 0.45, 2.51, false),
        (4096, 0.02, 2.46, true),
        (4096, 0.02, 2.51, false),
        (4096, 0.02, 6.0, false),
        (65_536, 0.49, 6.0, false),
    ] {
        let half = 0.001_f64.min(0.02 * r0);
        // A triangle's second moment shifts the mean of r J₀ by (half/r₀)²/6.
        let height = a / (std::f64::consts::TAU * n as f64 * r0 * half);
        let samples = [(r0 - half, 1.0), (r0, 1.0 + height), (r0 + half, 1.0)];
        let target = Target::rdf_curve(Density::new(n), &samples).expect("valid");
        let verdict = Realizability::of(&target);
        let least = 1.0 - 0.402_759_4 * a;
        assert_eq!(verdict.realizable, want, "{n}, {r0}, {a}: {verdict:?}");
        assert!((verdict.min_power - least).abs() < 1e-3 * a, "{n}, {r0}, {a}: {verdict:?}");
        let first = 3.831_706 / (std::f64::consts::TAU * r0);
        assert!((verdict.at_nu - first).abs() < 0.02 * first, "{n}, {r0}, {a}: {verdict:?}");
    }
}

/// Samples that say nothing new change nothing: many on a line, and one of 1 far beyond the last.
#[test]
fn verdicts_are_about_functions_not_samples() {
    let ring = |c: f64| {
        let height = 1.0 + c * N as f64 / (std::f64::consts::TAU * 192.0) / 0.02;
        vec![(191.97, 1.0), (191.98, 1.0), (192.0, height), (192.02, 1.0), (192.03, 1.0)]
    };
    for (c, want) in [(2.47, true), (2.52, false)] {
        let mut samples = ring(c);
        let near = Realizability::of(&Target::power_curve(density(), &samples).expect("valid"));
        samples.push((1e7, 1.0));
        let far = Realizability::of(&Target::power_curve(density(), &samples).expect("valid"));
        assert!(near.realizable == want && far.realizable == want, "{near:?} {far:?}");
        assert!((near.min_g - far.min_g).abs() < 1e-6, "{near:?} {far:?}");
    }
    // The same of g, whose table is as fine as its last distance asks for.
    for far in [None, Some(0.5), Some(64.0)] {
        let height = 6.0 / (std::f64::consts::TAU * N as f64 * 0.002 * 5e-5);
        let mut samples = vec![(0.00195, 1.0), (0.002, 1.0 + height), (0.00205, 1.0)];
        samples.extend(far.map(|r| (r, 1.0)));
        let verdict = Realizability::of(&Target::rdf_curve(density(), &samples).expect("valid"));
        assert!(
            (verdict.min_power - (1.0 - 0.402_759_4 * 6.0)).abs() < 6e-3,
            "{far:?}: {verdict:?}"
        );
    }
    // P = 1 differs nowhere, wherever it is sampled.
    let flat = Target::power_curve(density(), &[(1.0, 1.0), (100.0, 1.0)]).expect("valid");
    assert!(flat.end() == 0.0 && Realizability::of(&flat).is_unobjectionable());
    let flat = Target::rdf_curve(density(), &[(0.1, 1.0), (0.3, 1.0)]).expect("valid");
    assert!(Realizability::of(&flat).is_unobjectionable() && flat.power(9.0) == 1.0);
    // A narrow peak above an empty region: few samples, and thousands on the same lines.
    let corners = [(0.0, 0.0), (51.2, 0.0), (51.21, 400.0), (51.22, 1.0), (60.0, 1.0)];
    let mut many = Vec::new();
    for pair in corners.windows(2) {
        let ((x, p), (y, q)) = (pair[0], pair[1]);
        many.extend(
            (0..2000).map(|i| f64::from(i) / 2000.0).map(|t| (x + (y - x) * t, p + (q - p) * t)),
        );
    }
    many.push((60.0, 1.0));
    let [few, many] = [&corners[..], &many[..]]
        .map(|samples| Realizability::of(&Target::power_curve(density(), samples).expect("valid")));
    assert!((few.min_g - many.min_g).abs() < 1e-6, "{few:?} {many:?}");
    assert_eq!(few.warnings.len(), many.warnings.len(), "{few:?} {many:?}");
}

/// A sum of one part, and a product of one, is that part.
#[test]
fn combinations_of_one_part_are_that_part() {
    let set = |seed| {
        let mut rng = Seed::new(seed).stream(0);
        let points = (0..200).map(|_| DVec2::new(rng.random(), rng.random()));
        PointSet::new(points.collect()).expect("valid")
    };
    let density = Density::new(200);
    let peak = SinglePeak::thesis(density);
    let measured = |seed| Target::imitating(&[set(seed)], 200).expect("measurable");
    for target in [
        Target::step(density, 7.0).expect("valid"),
        Target::single_peak(density, peak).expect("valid"),
        Target::power_curve(density, &[(0.0, 0.0), (7.0, 0.0)]).expect("valid"),
        Target::rdf_curve(density, &[(0.0, 0.0), (0.03, 0.5)]).expect("valid"),
        measured(1),
    ] {
        let want = Realizability::of(&target);
        for one in [Target::sum(vec![(1.0, target.clone())]), Target::product(vec![target.clone()])]
        {
            let one = one.expect("a part");
            assert_eq!(one.is_measured(), target.is_measured());
            let got = Realizability::of(&one);
            assert_eq!((got.realizable, &got.warnings), (want.realizable, &want.warnings));
            assert!((got.min_power - want.min_power).abs() < 1e-9, "{got:?} {want:?}");
            assert!((got.min_g - want.min_g).abs() < 1e-4, "{got:?} {want:?}");
        }
    }
    let everything = Target::step(density, 0.0).expect("valid");
    let product = Target::product(vec![measured(1), everything]).expect("alike");
    let radii: Vec<f64> = (0..400).map(|i| f64::from(i) / 400.0).collect();
    for (got, want) in product.rdf(&radii).iter().zip(measured(1).rdf(&radii)) {
        assert!((got - want).abs() < 1e-3, "{got}, not {want}");
    }
    // What two measured spectra scatter by is allowed for in their mean, too.
    let mean = Target::sum(vec![(0.5, measured(1)), (0.5, measured(2))]).expect("alike");
    let verdict = Realizability::of(&mean);
    assert!(verdict.realizable && mean.is_measured(), "{verdict:?}");
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

/// P whose g is 1 but for a dip of half-width w around r₀, planted through its transform. The dip
/// takes 2πn·r₀·w·√(2π) ≈ 0.32 of the power away at most: P ≥ 0 holds.
#[test]
fn a_negative_rdf_in_a_narrow_band_is_found() {
    let (r0, w) = (0.01, 0.0005);
    for (depth, want) in [(0.9, true), (1.1, false)] {
        let g = |r: f64| 1.0 - depth * libm::exp(-0.5 * ((r - r0) / w).powi(2));
        let samples: Vec<_> =
            (0..6000).map(|i| (f64::from(i) * 5e-6, g(f64::from(i) * 5e-6))).collect();
        let from_g = Target::rdf_curve(density(), &samples).expect("valid");
        let direct = Realizability::of(&from_g);
        assert_eq!(direct.realizable, want, "{direct:?}");
        assert!(direct.min_power > 0.5, "{direct:?}");
        assert!((direct.min_g - (1.0 - depth)).abs() < 2e-3 && (direct.at_r - r0).abs() < 0.2 * w);
        // To a curve of P, and from there alone: what lies beyond 16√n takes 1 % off the dip.
        let spectrum: Vec<_> =
            (0..5100).map(|i| (f64::from(i) * 0.2, from_g.power(f64::from(i) * 0.2))).collect();
        let verdict = Realizability::of(&Target::power_curve(density(), &spectrum).expect("valid"));
        assert_eq!(verdict.realizable, want, "{verdict:?}");
        assert!((verdict.min_g - (1.0 - depth)).abs() < 0.02, "{verdict:?}");
        assert!((verdict.at_r - r0).abs() < 0.2 * w, "{verdict:?}");
    }
}

/// A thin ring of power p at ν₁ adds c·J₀(2πν₁r) to g, c = 2πν₁p/n, and J₀ is never below −0.402759
/// (DLMF 10.21: where J₁ has its first zero, 3.831706): realizable up to c = 2.482871.
#[test]
fn a_ring_may_have_as_much_power_as_the_bessel_function_allows() {
    let (nu, width) = (64.0, 0.02);
    for (c, want) in [(2.47, true), (2.50, false)] {
        let height = c * N as f64 / (std::f64::consts::TAU * nu) / width;
        let edge = 0.5 * width;
        let samples = [
            (nu - 3.0 * edge, 1.0),
            (nu - 2.0 * edge, 1.0),
            (nu, 1.0 + height),
            (nu + 2.0 * edge, 1.0),
            (nu + 3.0 * edge, 1.0),
        ];
        let verdict = Realizability::of(&Target::power_curve(density(), &samples).expect("valid"));
        assert_eq!(verdict.realizable, want, "{verdict:?}");
        assert!((verdict.min_g - (1.0 - 0.402_759_4 * c)).abs() < 1e-4, "{verdict:?}");
        let first = 3.831_706 / (std::f64::consts::TAU * nu);
        assert!((verdict.at_r - first).abs() < 0.01 * first, "{verdict:?}");
    }
}

/// Random spectra of a few annuli, whose g is a sum of jincs.
#[test]
fn random_annuli_agree_with_brute_force() {
    let mut rng = Seed::new(12).stream(0);
    let (mut yes, mut no) = (0, 0);
    for _ in 0..60 {
        let rings = 2 + (4.0 * rng.random::<f64>()) as usize;
        let mut edges: Vec<f64> = (0..rings).map(|_| 30.0 + 90.0 * rng.random::<f64>()).collect();
        edges.sort_by(f64::total_cmp);
        edges.insert(0, 0.0);
        let values: Vec<f64> = (0..rings).map(|_| 2.0 * rng.random::<f64>()).collect();
        // Samples so close to the edges that P is constant between them.
        let close = 1e-7;
        let ends = |k: usize| [(edges[k] + close, values[k]), (edges[k + 1] - close, values[k])];
        let mut samples: Vec<(f64, f64)> = (0..rings).flat_map(ends).collect();
        // Every other curve ends with a value that is not 1, which it has beyond.
        if values.len().is_multiple_of(2) {
            samples.extend([(edges[rings] + close, 1.0), (edges[rings] + 1.0, 1.0)]);
        }
        let verdict = Realizability::of(&Target::power_curve(density(), &samples).expect("valid"));
        let least = (1..20_000).map(|i| annuli_rdf(&edges, &values, f64::from(i) * 5e-6));
        let least = least.fold(f64::INFINITY, f64::min);
        assert!((verdict.min_g - least).abs() < 1e-4, "{edges:?} {values:?}: {verdict:?}, {least}");
        assert_eq!(verdict.realizable, least > -1e-9, "{edges:?} {values:?}: {verdict:?}");
        let is_unsettled = |w: &Warning| matches!(w, Warning::UnsettledPower { .. });
        assert_eq!(verdict.warnings.iter().any(is_unsettled), values.len() % 2 == 1);
        if verdict.realizable { yes += 1 } else { no += 1 }
    }
    assert!(yes > 5 && no > 5, "{yes} realizable, {no} not: nothing was tested");
}

/// g(r) of annuli between `edges`, P = 1 beyond the last.
fn annuli_rdf(edges: &[f64], values: &[f64], r: f64) -> f64 {
    let disk = |edge: f64| edge * bn_spectral::j1(std::f64::consts::TAU * edge * r) / r;
    let rings = values.iter().zip(edges.windows(2));
    1.0 + rings.map(|(p, e)| (p - 1.0) * (disk(e[1]) - disk(e[0]))).sum::<f64>() / N as f64
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

/// What a curve says holds as far as it goes, and 1 beyond: no end is rounded off.
#[test]
fn curves_that_end_early_are_judged_as_they_are() {
    let n = N as f64;
    // P = 0 up to the end is a step there, realizable up to √(n/π).
    for (factor, want) in [(0.99, true), (1.01, false)] {
        let end = factor * highest_step(n);
        let target = Target::power_curve(density(), &[(0.0, 0.0), (end, 0.0)]).expect("valid");
        let verdict = Realizability::of(&target);
        assert_eq!(verdict.realizable, want, "{verdict:?}");
        assert!((verdict.min_g - (1.0 - factor * factor)).abs() < 1e-6, "{verdict:?}");
        assert!(verdict.warnings.contains(&Warning::UnsettledPower { end, deviation: 1.0 }));
        assert_eq!(verdict.is_unobjectionable(), want);
        assert_eq!((target.power(0.999 * end), target.power(1.001 * end)), (0.0, 1.0));
    }
    // g = 0 up to the end is a gap of hard disks that nothing makes up for: P = 1 − 2n·A·jinc, A the
    // area of the disk, falls to 1 − nA at 0.
    for (share, want) in [(0.99_f64, true), (1.01, false)] {
        let end = (share / (n * std::f64::consts::PI)).sqrt();
        let samples: Vec<_> = (0..=2000).map(|i| (f64::from(i) / 2000.0 * end, 0.0)).collect();
        let verdict = Realizability::of(&Target::rdf_curve(density(), &samples).expect("valid"));
        assert_eq!(verdict.realizable, want, "{verdict:?}");
        assert!((verdict.min_power - (1.0 - share)).abs() < 1e-3, "{verdict:?}");
        assert!(verdict.warnings.contains(&Warning::UnsettledRdf { end, deviation: 1.0 }));
    }
    let settled = [(0.0, 0.0), (30.0, 0.0), (40.0, 1.0), (50.0, 1.0)];
    let settled = Realizability::of(&Target::power_curve(density(), &settled).expect("valid"));
    assert!(settled.is_unobjectionable() && settled.warnings.is_empty(), "{settled:?}");
}

/// Curves of two samples are ramps, of known integrals: a staircase in their place has the other verdict.
#[test]
fn coarse_curves_are_lines() {
    let n = N as f64;
    // P = ν/ν₁ up to ν₁: g(0) = 1 + (2π/n)·ν₁²·(1/3 − 1/2).
    for (square, want) in [(0.94, true), (0.97, false), (1.0, false)] {
        let end = (square * n).sqrt();
        let target = Target::power_curve(density(), &[(0.0, 0.0), (end, 1.0)]).expect("valid");
        let verdict = Realizability::of(&target);
        let g = 1.0 - std::f64::consts::PI / 3.0 * square;
        assert!((verdict.min_g - g).abs() < 1e-9 && verdict.at_r == 0.0, "{verdict:?}");
        assert_eq!(verdict.realizable, want, "{verdict:?}");
    }
    // The same of g, where P(0) = 1 + 2πn·r₁²·(1/3 − 1/2).
    for (square, want) in [(0.94, true), (0.97, false), (1.1547, false)] {
        let end = (square / n).sqrt();
        let target = Target::rdf_curve(density(), &[(0.0, 0.0), (end, 1.0)]).expect("valid");
        let verdict = Realizability::of(&target);
        let power = 1.0 - std::f64::consts::PI / 3.0 * square;
        assert!((verdict.min_power - power).abs() < 1e-9 && verdict.at_nu == 0.0, "{verdict:?}");
        assert_eq!(verdict.realizable, want, "{verdict:?}");
    }
}

/// Abscissae that differ in their last bits, whose halfway marks do not.
#[test]
fn neighbouring_numbers_are_no_obstacle() {
    let ulp = f64::EPSILON;
    let x = [0.0, 1.0, 1.0 + ulp, 1.0 + 2.0 * ulp, 1.0 + 3.0 * ulp, 2.0];
    let samples: Vec<_> = x.into_iter().zip([0.0, 0.0, 0.0, 0.0, 1.0, 1.0]).collect();
    let verdict = Realizability::of(&Target::power_curve(density(), &samples).expect("valid"));
    let step = Target::step(density(), 1.0).expect("valid");
    assert!((verdict.min_g - step.rdf(&[0.0])[0]).abs() < 1e-12, "{verdict:?}");
    assert!(
        Realizability::of(&Target::rdf_curve(density(), &samples).expect("valid")).min_g == 0.0
    );
    let tiny = [(0.0, 1e9), (5e-324, -1e9), (1e-323, 1.0), (1e300, 1.0)];
    for target in [Target::power_curve, Target::rdf_curve].map(|of| of(density(), &tiny)) {
        assert!(!Realizability::of(&target.expect("valid")).realizable);
    }
    let absurd = Target::power_curve(density(), &[(0.0, 1.0), (1.0, 1.1e9)]);
    assert_eq!(absurd, Err(TargetError::Value { index: 1, value: 1.1e9 }));
}
