//! The transforms against sums taken term by term, over the whole range of tolerances.
//!
//! A transform passes where its relative l2 error is below SLACK·tolerance and below its own
//! prediction; the printed clearance is how many times smaller it is than that.

use bn_core::{DVec2, Seed};
use bn_spectral::{
    Complex, FullPlane, HalfPlane, Nufft, NufftOptions, Real, direct_complex_modes,
    direct_complex_sums, direct_modes, direct_sums,
};
use rand::RngExt as _;

/// The tolerance is for points in general position, as those here are: no slack.
const SLACK: f64 = 1.0;

fn random_points(n: usize, task: u32) -> Vec<DVec2> {
    let mut rng = Seed::new(7).stream(task);
    (0..n).map(|_| DVec2::new(rng.random(), rng.random())).collect()
}

fn random_complex(n: usize, task: u32) -> Vec<Complex<f64>> {
    let mut rng = Seed::new(8).stream(task);
    (0..n).map(|_| Complex::new(rng.random::<f64>() - 0.5, rng.random::<f64>() - 0.5)).collect()
}

fn narrow<T: Real>(z: Complex<f64>) -> Complex<T> {
    Complex::new(T::narrow(z.re), T::narrow(z.im))
}

fn widen<T: Real>(z: Complex<T>) -> Complex<f64> {
    Complex::new(z.re.wide(), z.im.wide())
}

/// ‖got − want‖₂/‖want‖₂.
fn relative_error(
    got: impl IntoIterator<Item = Complex<f64>>,
    want: impl IntoIterator<Item = Complex<f64>>,
) -> f64 {
    let (mut error, mut norm) = (0.0, 0.0);
    for (g, w) in got.into_iter().zip(want) {
        error += (g - w).norm_sqr();
        norm += w.norm_sqr();
    }
    (error / norm).sqrt()
}

fn check(name: &str, error: f64, tolerance: f64, predicted: f64) {
    println!("{name:>16} at {tolerance:.0e}: {error:.2e}, clearance {:.1}", tolerance / error);
    assert!(error <= SLACK * tolerance, "{name} at {tolerance:e}: {error:e}");
    assert!(error <= predicted, "{name} at {tolerance:e}: {error:e}, not {predicted:e}");
}

/// Errors of all four transforms at a tolerance.
fn sweep<T: Real>(n: usize, k: usize, tolerance: f64, task: u32) {
    let points = random_points(n, task);
    let strengths: Vec<f64> = random_complex(n, task).iter().map(|z| z.re).collect();
    let complex_strengths = random_complex(n, task + 1);
    let mut plan: Nufft<T> = NufftOptions::new(k, tolerance).expecting(n).plan().expect("a plan");
    assert!(plan.crossover() < n, "the sums would be direct");
    let predicted = plan.error();
    assert!(predicted <= tolerance);

    let mut half = HalfPlane::<T>::zeros(k);
    plan.points_to_modes(&points, Some(&strengths), &mut half);
    let want = direct_modes(&points, Some(&strengths), k);
    let got = half.values().iter().copied().map(widen);
    let error = relative_error(got, want.values().iter().copied());
    check("type 1, real", error, tolerance, predicted);

    let mut full = FullPlane::<T>::zeros(k);
    plan.complex_points_to_modes(&points, &complex_strengths, &mut full);
    let want = direct_complex_modes(&points, &complex_strengths, k);
    let got = full.values().iter().copied().map(widen);
    let error = relative_error(got, want.values().iter().copied());
    check("type 1, complex", error, tolerance, predicted);

    // Random modes, rounded to T first: that is not the transform's error.
    let side = 2 * k + 1;
    let coefficients: Vec<Complex<T>> =
        random_complex(side * side, task + 2).into_iter().map(narrow).collect();
    let (mut half, mut exact) = (HalfPlane::<T>::zeros(k), HalfPlane::<f64>::zeros(k));
    for kx in 0..=k {
        half.column_mut(kx).copy_from_slice(&coefficients[kx * side..][..side]);
        for (e, h) in exact.column_mut(kx).iter_mut().zip(half.column(kx)) {
            *e = widen(*h);
        }
    }
    let mut values = vec![0.0; n];
    plan.modes_to_points(&half, &points, &mut values);
    let want = direct_sums(&points, &exact);
    let error =
        relative_error(values.into_iter().map(Complex::from), want.into_iter().map(Complex::from));
    // Fewer values than modes, so a wider scatter: the mean over n points, not over all modes.
    check("type 2, real", error, tolerance, 1.1 * predicted);

    let mut exact = FullPlane::<f64>::zeros(k);
    for (column, from) in exact.columns_mut().zip(coefficients.chunks(side)) {
        column.iter_mut().zip(from).for_each(|(e, &c)| *e = widen(c));
    }
    let mut values = vec![Complex::new(0.0, 0.0); n];
    plan.columns_to_complex_points(&points, &mut values, |kx, column| {
        column.copy_from_slice(&coefficients[(kx + k as i64) as usize * side..][..side]);
    });
    let error = relative_error(values, direct_complex_sums(&points, &exact));
    check("type 2, complex", error, tolerance, 1.1 * predicted);
}

#[test]
fn every_tolerance_is_met_in_double_precision() {
    for digits in 2..=13 {
        sweep::<f64>(600, 40, 10_f64.powi(-digits), digits as u32);
    }
}

#[test]
fn every_tolerance_is_met_in_single_precision() {
    for digits in 2..=5 {
        sweep::<f32>(600, 40, 10_f64.powi(-digits), digits as u32);
    }
}

#[test]
fn larger_grids_of_several_strips_meet_it_too() {
    sweep::<f64>(2000, 130, 1e-6, 50);
    sweep::<f64>(2000, 130, 1e-12, 51);
    sweep::<f32>(2000, 130, 1e-4, 52);
}

#[test]
fn what_cannot_be_reached_is_said() {
    let plan: Nufft<f32> = NufftOptions::new(100, 1e-9).plan().expect("a plan");
    assert!((1e-9..1e-5).contains(&plan.error()), "{}", plan.error());
    let plan: Nufft = NufftOptions::new(100, 1e-30).plan().expect("a plan");
    assert!(plan.error() <= 1e-13, "clamped: {}", plan.error());
    let plan: Nufft = NufftOptions::new(100, 5.0).plan().expect("a plan");
    assert!(plan.error() <= 1e-2, "clamped: {}", plan.error());
}

/// ⟨A w, f⟩ = ⟨w, Aᵀ f⟩ for type 1 A and type 2 Aᵀ. The scale is ‖A w‖·‖f‖, which bounds either
/// side, and not their value, which is a sum of random signs and may be anywhere near 0. The error
/// is rounding alone, whatever the tolerance: type 2 is type 1 transposed, step by step.
#[test]
fn the_types_are_adjoint() {
    let (n, k) = (500, 30);
    let points = random_points(n, 60);
    for tolerance in [1e-3, 1e-11] {
        let mut plan: Nufft = NufftOptions::new(k, tolerance).expecting(n).plan().expect("a plan");
        let strengths = random_complex(n, 61);
        let mut modes = FullPlane::zeros(k);
        plan.complex_points_to_modes(&points, &strengths, &mut modes);
        let coefficients = random_complex(modes.values().len(), 62);
        let mut given = FullPlane::zeros(k);
        given.columns_mut().zip(coefficients.chunks(2 * k + 1)).for_each(|(column, from)| {
            column.copy_from_slice(from);
        });
        let mut values = vec![Complex::new(0.0, 0.0); n];
        plan.complex_modes_to_points(&given, &points, &mut values);
        // Type 2 has the conjugate exponent: the inner product conjugates type 1's side.
        let left: Complex<f64> =
            modes.values().iter().zip(&coefficients).map(|(a, b)| a.conj() * b).sum();
        let right: Complex<f64> = strengths.iter().zip(&values).map(|(w, v)| w.conj() * v).sum();
        let norm = |z: &[Complex<f64>]| z.iter().map(Complex::norm_sqr).sum::<f64>().sqrt();
        let scale = norm(modes.values()) * norm(&coefficients);
        let error = (left - right).norm() / scale;
        println!("adjointness at {tolerance:e}: {error:.2e}");
        assert!(error < 1e-14, "{error:e}");
    }
}
