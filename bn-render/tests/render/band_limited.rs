//! Fits of trigonometric polynomials against dense least squares, and what they make of degenerate
//! samples.

use std::f64::consts::TAU;

use crate::common::{cell_areas, jittered_set, random_set};
use bn_core::{DVec2, Seed, Unobserved};
use bn_render::{
    BandLimitedError, BandLimitedFit, Convergence, Degree, Stop, Stopping, TrigonometricPolynomial,
};
use bn_spectral::Complex;
use proptest::prelude::*;
use rand::RngExt;

const EXACTLY: Stopping = Stopping { iterations: 400, tolerance: 1e-13 };

type Fitted = (TrigonometricPolynomial, Convergence);

fn act(points: &[DVec2], weights: &[f64], values: &[f64], degree: Degree, to: Stopping) -> Fitted {
    let mut fit = BandLimitedFit::new(points.to_vec(), weights, degree).expect("a fit");
    fit.act(values, &to, &Unobserved).expect("finite values")
}

fn pocs(points: &[DVec2], weights: &[f64], values: &[f64], degree: Degree, to: Stopping) -> Fitted {
    let mut fit = BandLimitedFit::new(points.to_vec(), weights, degree).expect("a fit");
    fit.pocs(values, &to, &Unobserved).expect("finite values")
}

/// The real functions that span the polynomials: 1, and cos and sin of each pair ±k.
fn basis(degree: Degree) -> Vec<(i64, i64, bool)> {
    let (x, y) = (degree.x as i64, degree.y as i64);
    let mut all = vec![(0, 0, true)];
    for kx in 0..=x {
        for ky in -y..=y {
            if kx > 0 || ky > 0 {
                all.extend([(kx, ky, true), (kx, ky, false)]);
            }
        }
    }
    all
}

fn value(function: (i64, i64, bool), p: DVec2) -> f64 {
    let phase = TAU * (function.0 as f64 * p.x + function.1 as f64 * p.y);
    if function.2 { libm::cos(phase) } else { libm::sin(phase) }
}

/// Weighted least squares with all its equations, by elimination with pivots.
fn dense(points: &[DVec2], weights: &[f64], values: &[f64], degree: Degree) -> Vec<f64> {
    let basis = basis(degree);
    let n = basis.len();
    let mut rows = vec![vec![0.0; n + 1]; n];
    for ((p, w), f) in points.iter().zip(weights).zip(values) {
        let at: Vec<f64> = basis.iter().map(|&function| value(function, *p)).collect();
        for i in 0..n {
            for j in 0..n {
                rows[i][j] += w * at[i] * at[j];
            }
            rows[i][n] += w * at[i] * f;
        }
    }
    for i in 0..n {
        let pivot = (i..n).max_by(|&a, &b| rows[a][i].abs().total_cmp(&rows[b][i].abs()));
        rows.swap(i, pivot.expect("a row is left"));
        let (above, below) = rows.split_at_mut(i + 1);
        for row in below {
            let factor = row[i] / above[i][i];
            for j in i..=n {
                row[j] -= factor * above[i][j];
            }
        }
    }
    let mut solution = vec![0.0; n];
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|j| rows[i][j] * solution[j]).sum();
        solution[i] = (rows[i][n] - known) / rows[i][i];
    }
    solution
}

/// The polynomial by its functions' sum.
fn sum(degree: Degree, coefficients: &[f64], p: DVec2) -> f64 {
    basis(degree).iter().zip(coefficients).map(|(&f, c)| c * value(f, p)).sum()
}

fn random_values(n: usize, seed: u64) -> Vec<f64> {
    let mut rng = Seed::new(seed).stream(9);
    (0..n).map(|_| rng.random_range(-1.0..2.0)).collect()
}

#[test]
fn fits_are_the_least_squares() {
    let degrees = [(0, 0), (1, 0), (0, 2), (2, 1), (3, 3), (1, 4)];
    for (i, (x, y)) in degrees.into_iter().enumerate() {
        let degree = Degree { x, y };
        let set = random_set(6 * degree.coefficients() + 5, i as u64);
        let points = set.points();
        let (weights, values) = (cell_areas(&set, 128), random_values(points.len(), 3));
        let want = dense(points, &weights, &values, degree);
        for (fitted, tolerance) in [
            (act(points, &weights, &values, degree, EXACTLY), 1e-9),
            (pocs(points, &weights, &values, degree, EXACTLY), 1e-6),
        ] {
            for place in random_set(50, 77).points() {
                let got = fitted.0.values(&[*place]).expect("a small degree")[0];
                let want = sum(degree, &want, *place);
                assert!(
                    (got - want).abs() < tolerance,
                    "{degree:?} at {place}: {got} against {want}"
                );
            }
            assert!(fitted.1.residual < tolerance && !fitted.1.is_underdetermined());
            assert_eq!(fitted.0.degree(), degree);
        }
    }
}

#[test]
fn coefficients_are_those_of_the_sum() {
    let degree = Degree { x: 2, y: 3 };
    let points = jittered_set(14, 3).points().to_vec();
    let coefficients = random_values(basis(degree).len(), 8);
    let values: Vec<f64> = points.iter().map(|p| sum(degree, &coefficients, *p)).collect();
    let weights = vec![1.0; points.len()];
    let (polynomial, told) = act(&points, &weights, &values, degree, EXACTLY);
    assert!(told.converged(), "{told:?}");
    for ((kx, ky, even), want) in basis(degree).into_iter().zip(coefficients) {
        let (plus, minus) = (polynomial.coefficient(kx, ky), polynomial.coefficient(-kx, -ky));
        let got = match (kx, ky, even) {
            (0, 0, _) => plus.re,
            (_, _, true) => plus.re + minus.re,
            (_, _, false) => minus.im - plus.im,
        };
        assert!((got - want).abs() < 1e-10, "({kx}, {ky}): {got} against {want}");
    }
    for (kx, ky) in [(3, 0), (0, 4), (-3, 1), (i64::MIN, 0), (0, i64::MAX)] {
        assert_eq!(polynomial.coefficient(kx, ky).norm(), 0.0);
    }
}

#[test]
fn residuals_fall_as_theory_says() {
    let set = jittered_set(24, 5);
    let (points, degree) = (set.points(), Degree { x: 5, y: 5 });
    let weights = cell_areas(&set, 256);
    let coefficients = random_values(basis(degree).len(), 4);
    let values: Vec<f64> = points.iter().map(|p| sum(degree, &coefficients, *p)).collect();
    let to = Stopping { iterations: 60, tolerance: 1e-10 };
    let (_, fast) = act(points, &weights, &values, degree, to);
    let (_, slow) = pocs(points, &weights, &values, degree, to);
    let condition = fast.condition.expect("iterations were made");
    assert!(fast.converged() && slow.converged(), "{fast:?} {slow:?}");
    assert!((1.0..20.0).contains(&condition), "{condition}");
    assert!(fast.iterations() <= slow.iterations());
    // Steepest descent loses at least this factor an iteration in the error's energy norm, from which
    // the residual differs by √κ at most.
    let factor = (condition - 1.0) / (condition + 1.0);
    for (i, residual) in slow.history.iter().enumerate() {
        let bound = condition.sqrt() * (1.05 * factor).powi(i as i32 + 1);
        assert!(*residual <= bound, "{i}: {residual} above {bound}");
    }
    // Equal weights: the same polynomial, more slowly.
    let (_, equal) = act(points, &vec![1.0; points.len()], &values, degree, to);
    assert!(equal.converged() && equal.condition > fast.condition);
}

#[test]
fn lattices_take_one_iteration() {
    let at = |i: usize| DVec2::new((i % 12) as f64 / 12.0, (i / 12) as f64 / 10.0);
    let points: Vec<DVec2> = (0..120).map(at).collect();
    let degree = Degree { x: 5, y: 4 };
    let values: Vec<f64> = random_values(120, 6);
    let weights = vec![0.3; 120];
    for (polynomial, told) in [
        act(&points, &weights, &values, degree, Stopping { iterations: 9, tolerance: 1e-9 }),
        pocs(&points, &weights, &values, degree, Stopping { iterations: 9, tolerance: 1e-9 }),
    ] {
        assert_eq!((told.iterations(), told.stop), (1, Stop::Tolerance), "{told:?}");
        assert!(told.condition.is_none_or(|condition| (condition - 1.0).abs() < 1e-8));
        // Then T is the identity, and coefficients are the discrete transform.
        let mean = values.iter().sum::<f64>() / 120.0;
        assert!((polynomial.coefficient(0, 0).re - mean).abs() < 1e-9);
    }
}

#[test]
fn constants_are_exact() {
    let set = random_set(40, 2);
    let values = vec![1.0 / 3.0; 40];
    for degree in [Degree { x: 0, y: 0 }, Degree { x: 3, y: 2 }, Degree { x: 9, y: 9 }] {
        for (polynomial, told) in [
            act(set.points(), &[1.0; 40], &values, degree, EXACTLY),
            pocs(set.points(), &[1.0; 40], &values, degree, EXACTLY),
        ] {
            assert_eq!((told.iterations(), told.residual, told.stop), (0, 0.0, Stop::Tolerance));
            let values = polynomial.values(random_set(9, 3).points()).expect("a small degree");
            assert!(values.iter().all(|&v| v == 1.0 / 3.0));
        }
    }
}

#[test]
fn too_few_samples_are_fitted_with_the_least_energy_and_told_of() {
    // One sample: the polynomial of least energy about its value, which is that constant.
    let one = [DVec2::new(0.3, 0.9)];
    let (polynomial, told) = act(&one, &[2.0], &[5.0], Degree { x: 4, y: 4 }, EXACTLY);
    assert!(told.is_underdetermined() && polynomial.values(&one).expect("small") == [5.0]);
    // Two samples: both are met.
    let two = [DVec2::new(0.1, 0.2), DVec2::new(0.6, 0.25)];
    for (polynomial, told) in [
        act(&two, &[1.0; 2], &[0.0, 1.0], Degree { x: 6, y: 6 }, EXACTLY),
        pocs(&two, &[1.0; 2], &[0.0, 1.0], Degree { x: 6, y: 6 }, EXACTLY),
    ] {
        let values = polynomial.values(&two).expect("small");
        assert!(values[0].abs() < 1e-9 && (values[1] - 1.0).abs() < 1e-9, "{values:?}");
        assert!(told.is_underdetermined() && (told.samples, told.coefficients) == (2, 169));
    }
}

#[test]
fn coincident_samples_share_their_mean() {
    let place = DVec2::new(0.4, 0.4);
    let points = vec![place, place, place + 1e-17, DVec2::new(0.9, 0.9)];
    for weights in [[1.0; 4], [3.0, 0.0, 0.0, 1.0]] {
        let (polynomial, told) =
            act(&points, &weights, &[0.0, 1.0, 0.5, 0.25], Degree { x: 3, y: 3 }, EXACTLY);
        let values = polynomial.values(&[place, points[3]]).expect("small");
        let mean = if weights[1] > 0.0 { 0.5 } else { 0.0 };
        assert!(
            (values[0] - mean).abs() < 1e-9 && (values[1] - 0.25).abs() < 1e-9,
            "{values:?} {told:?}"
        );
    }
}

struct Stopper;

impl bn_core::Observer for Stopper {
    fn observe(&self, _: &bn_core::Progress<'_>) -> std::ops::ControlFlow<()> {
        std::ops::ControlFlow::Break(())
    }
}

/// Tolerances that no residual can keep to are not called reached.
#[test]
fn what_is_told_as_reached_is_reached() {
    let set = jittered_set(12, 1);
    let areas = cell_areas(&set, 200);
    let values: Vec<f64> =
        set.points().iter().map(|p| libm::sin(TAU * (p.x + 2.0 * p.y))).collect();
    let mut fit = BandLimitedFit::new(set.points().to_vec(), &areas, Degree { x: 3, y: 3 });
    let fit = fit.as_mut().expect("small");
    for tolerance in [0.0, 1e-20, 1e-14, 1e-9, 1e-6, 1e-3] {
        let stopping = Stopping { iterations: 2000, tolerance };
        let results =
            [fit.act(&values, &stopping, &Unobserved), fit.pocs(&values, &stopping, &Unobserved)];
        for result in results {
            let told = result.expect("a fit").1;
            assert!(told.iterations() < 2000, "{tolerance}: {told:?}");
            assert_eq!(
                told.converged(),
                told.residual <= 1.01 * tolerance,
                "{tolerance}: {told:?}"
            );
            assert!(told.converged() || tolerance < 1e-9, "{tolerance}: {told:?}");
        }
    }
}

#[test]
fn what_cannot_be_fitted_is_refused() {
    let points = vec![DVec2::ZERO, DVec2::splat(0.5)];
    let degree = Degree { x: 1, y: 1 };
    let fit = |weights: &[f64], degree| BandLimitedFit::new(points.clone(), weights, degree);
    assert!(matches!(fit(&[1.0, -1.0], degree), Err(BandLimitedError::Weight { index: 1, .. })));
    assert!(matches!(fit(&[0.0, 0.0], degree), Err(BandLimitedError::NoSamples)));
    for (x, y) in [(1 << 20, 0), (40_000, 0), (0, 40_000), (4000, 4000), (usize::MAX, usize::MAX)] {
        let far = fit(&[1.0, 1.0], Degree { x, y });
        assert!(matches!(far, Err(BandLimitedError::TooLarge { .. })), "{x}, {y}");
    }
    assert!(matches!(BandLimitedFit::new(vec![], &[], degree), Err(BandLimitedError::NoSamples)));
    let mut good = fit(&[1.0, f64::MAX], degree).expect("weights");
    for bad in [f64::NAN, f64::INFINITY] {
        let refused = good.act(&[0.0, bad], &EXACTLY, &Unobserved);
        assert!(matches!(refused, Err(BandLimitedError::Value { index: 1 })), "{refused:?}");
    }
    let mut even = fit(&[1.0, 1.0], degree).expect("weights");
    for stopped in
        [even.act(&[0.0, 1.0], &EXACTLY, &Stopper), even.pocs(&[0.0, 1.0], &EXACTLY, &Stopper)]
    {
        assert!(matches!(stopped, Err(BandLimitedError::Cancelled)));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, ..ProptestConfig::default() })]

    /// Few or many points, absurd values: numbers come out, no point is fitted worse than by the mean,
    /// and the residual told is that of the polynomial returned.
    #[test]
    fn nothing_becomes_nan(
        n in 1_usize..40, seed in 0_u64..1000, x in 0_usize..9, y in 0_usize..9,
        size in prop::sample::select(vec![1.0, 1e-300, 1e250]), clustered in any::<bool>(),
        iterations in 0_usize..60,
    ) {
        let mut points = random_set(n, seed).points().to_vec();
        if clustered {
            for p in &mut points {
                *p = 0.5 + *p * 1e-9;
            }
        }
        let values: Vec<f64> = random_values(n, seed).iter().map(|v| v * size).collect();
        let degree = Degree { x, y };
        let to = Stopping { iterations, tolerance: 1e-12 };
        for (polynomial, told) in [
            act(&points, &vec![1.0; n], &values, degree, to),
            pocs(&points, &vec![1.0; n], &values, degree, to),
        ] {
            let got = polynomial.values(&points).expect("a small degree");
            prop_assert!(got.iter().all(|v| v.is_finite()), "{:?} {:?}", got, told);
            prop_assert!(told.residual.is_finite() && told.history.iter().all(|r| r.is_finite()));
            prop_assert!(told.iterations() <= iterations);
            // Nothing is fitted worse than by the mean.
            let mean = values.iter().sum::<f64>() / n as f64;
            let misfit = |f: &dyn Fn(usize) -> f64| {
                (0..n).map(|i| ((f(i) - values[i]) / size).powi(2)).sum::<f64>()
            };
            let bound = misfit(&|_| mean) * (1.0 + 1e-9) + 1e-18;
            prop_assert!(misfit(&|i| got[i]) <= bound);
            // ‖b − T a‖/‖b‖ of the normal equations for what the mean leaves, by their definition.
            let normal = |f: &dyn Fn(usize) -> f64| -> f64 {
                let modes = (-(x as i64)..=x as i64)
                    .flat_map(|kx| (-(y as i64)..=y as i64).map(move |ky| DVec2::new(kx as f64, ky as f64)));
                modes.map(|k| {
                    let term = |i: usize| Complex::cis(-TAU * k.dot(points[i])) * (f(i) / size);
                    (0..n).map(term).sum::<Complex<f64>>().norm_sqr()
                }).sum()
            };
            let whole = normal(&|i| values[i] - mean);
            // Of points all but in one place even the mean leaves nothing but rounding.
            if whole > 1e-9 * n as f64 * misfit(&|_| mean) {
                let want = (normal(&|i| values[i] - got[i]) / whole).sqrt();
                prop_assert!((told.residual - want).abs() <= 1e-3 * want + 1e-9, "{} {:?}", want, told);
            }
        }
    }
}
