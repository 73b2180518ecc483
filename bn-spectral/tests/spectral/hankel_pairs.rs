//! The planned transform against closed forms and high-precision quadratures.

use std::f64::consts::{PI, TAU};

use bn_spectral::{HankelPlan, Window, j1, jinc};

/// u and F(u) of the rows of one pair.
fn rows(pair: &str, params: &str) -> Vec<(f64, f64)> {
    let prefix = format!("{pair},{params},");
    let rows = include_str!("../data/hankel_pairs.csv").lines();
    let rows: Vec<(f64, f64)> = rows
        .filter_map(|row| row.strip_prefix(&prefix)?.split_once(','))
        .map(|(u, f)| (u.parse().expect("a number"), f.parse().expect("a number")))
        .collect();
    assert!(rows.len() >= 9, "{prefix} has {} rows", rows.len());
    rows
}

/// The transform on the range of `breaks` meets the rows to `bound`.
fn check(
    (pair, params): (&str, &str),
    (breaks, scale): (&[f64], f64),
    bound: f64,
    f: impl FnMut(f64) -> f64,
) {
    let rows = rows(pair, params);
    let frequencies: Vec<f64> = rows.iter().map(|row| row.0).collect();
    let got = HankelPlan::new(breaks, scale, &frequencies).transform(f);
    for ((u, want), got) in rows.iter().zip(&got) {
        assert!((got - want).abs() <= bound, "{pair} {params} at {u}: {got} for {want}");
    }
}

#[test]
fn gaussians() {
    for (params, a) in [("a=1", 1.0), ("a=0.5", 0.5), ("a=2", 2.0)] {
        let f = |r: f64| libm::exp(-PI * r * r / (a * a));
        check(("gaussian", params), (&[0.0, 4.0 * a], a), 1e-13, f);
    }
}

/// exp(−36) = 2e-16 is where the range ends; F(0) = 25 for a = ½.
#[test]
fn exponentials() {
    for (params, a) in [("a=1", 1.0), ("a=0.5", 0.5), ("a=2", 2.0)] {
        check(("exp", params), (&[0.0, 40.0 / a], 1.0 / a), 1e-12, |r| libm::exp(-a * r));
    }
}

#[test]
fn jumps_lie_on_breaks() {
    for (params, a) in [("a=1", 1.0), ("a=0.5", 0.5), ("a=2", 2.0)] {
        check(("disk", params), (&[0.0, a], 1.0), 1e-13, |_| 1.0);
    }
    check(("annulus", "a=1;b=2"), (&[1.0, 2.0], 1.0), 1e-13, |_| 1.0);
}

#[test]
fn windowed_steps() {
    let nu0 = 1.0 / PI.sqrt();
    // −ν₀ J₁(2πν₀r)/r, finite at 0.
    let step = |r: f64| -TAU * nu0 * nu0 * jinc(TAU * nu0 * r);
    for (params, half_width) in [("nu0=1/sqrt(pi);R=4", 4.0), ("nu0=1/sqrt(pi);R=16", 16.0)] {
        let f = |r| Window::BLACKMAN.at(r, half_width) * step(r);
        check(("blackman_step", params), (&[0.0, half_width], 0.5), 1e-13, f);
    }
    for (params, s) in [("a=1/sqrt(pi);s=0.1", 0.1), ("a=1/sqrt(pi);s=0.25", 0.25)] {
        let f = |r: f64| -step(r) * libm::exp(-PI * s * s * r * r);
        check(("gauss_windowed_jinc", params), (&[0.0, 3.6 / s], 0.5), 1e-13, f);
    }
}

/// Falls off as r⁻³ only. Cut by a wide smooth step, which changes nothing at frequencies whose
/// period is shorter than the step; at u = 0 the integral is taken to 10¹² on growing panels.
#[test]
fn a_slow_tail_cut_smoothly() {
    let f = |r: f64| (1.0 + r * r).powf(-1.5);
    let rows = rows("inverse_cubic", "");
    let high: Vec<(f64, f64)> = rows.iter().copied().filter(|row| row.0 >= 0.05).collect();
    assert_eq!(high.len(), rows.len() - 2);
    let frequencies: Vec<f64> = high.iter().map(|row| row.0).collect();
    let plan = HankelPlan::new(&[0.0, 1.0, 400.0], 1.0, &frequencies);
    let got = plan.transform(|r| f(r) * 0.5 * libm::erfc((r - 200.0) / 30.0));
    for ((u, want), got) in high.iter().zip(&got) {
        assert!((got - want).abs() <= 1e-10, "at {u}: {got} for {want}");
    }
    let breaks: Vec<f64> = std::iter::once(0.0).chain((0..41).map(|k| 2.0_f64.powi(k))).collect();
    let total = HankelPlan::new(&breaks, f64::INFINITY, &[0.0]).transform(f)[0];
    assert!((total - TAU).abs() <= 1e-10, "{total}");
}

/// The pair of the row above in the other direction, to radii where 2πru is 10⁵.
#[test]
fn inverse_at_large_radii() {
    let radii = [0.0, 0.3, 1.0, 7.0, 50.0, 300.0, 2000.0];
    let plan = HankelPlan::new(&[0.0, 6.5], 0.5, &radii);
    let got = plan.transform(|u| TAU * libm::exp(-TAU * u));
    for (r, got) in radii.iter().zip(&got) {
        let want = (1.0 + r * r).powf(-1.5);
        assert!((got - want).abs() <= 1e-13, "at {r}: {got} for {want}");
    }
}

/// H[disk of radius a](u) = a J₁(2πau)/u: with quadratures that do not resolve J₀ the values at
/// high frequencies would be of the order of 1 instead of 1e-7.
#[test]
fn high_frequencies_are_not_aliased() {
    let frequencies = [999.0, 5000.25, 10_000.0];
    let plan = HankelPlan::new(&[0.0, 1.0], 1.0, &frequencies);
    for (u, got) in frequencies.iter().zip(plan.transform(|_| 1.0)) {
        let want = j1(TAU * u) / u;
        assert!((got - want).abs() <= 1e-13, "at {u}: {got} for {want}");
    }
}

/// A batch gives the bits of single applications, with the kernel kept (small) and not (large).
#[test]
fn batches_are_single_transforms() {
    for count in [3, 4000] {
        let frequencies: Vec<f64> = (0..count).map(|j| f64::from(j) * 0.01).collect();
        let plan = HankelPlan::new(&[0.0, 2.0], 0.05, &frequencies);
        assert_eq!(plan.nodes().len() * frequencies.len() > 1 << 21, count == 4000);
        let a: Vec<f64> = plan.nodes().iter().map(|r| libm::exp(-r)).collect();
        let b: Vec<f64> = plan.nodes().iter().map(|r| r * r).collect();
        let mut both = vec![f64::NAN; 2 * frequencies.len()];
        plan.apply_batch_into(&[a.clone(), b.clone()].concat(), &mut both);
        let mut one = vec![f64::NAN; frequencies.len()];
        for (f, batch) in [a, b].iter().zip(both.chunks(frequencies.len())) {
            plan.apply_into(f, &mut one);
            assert_eq!(one, batch);
        }
    }
}
