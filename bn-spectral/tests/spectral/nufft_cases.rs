//! Points that lie badly, other ways to the same sums, and what must not change them.

use std::f64::consts::TAU;

use bn_core::{DVec2, Seed};
use bn_spectral::{
    Complex, FullPlane, HalfPlane, Nufft, NufftError, NufftOptions, direct_complex_modes,
    direct_modes, direct_sums,
};
use rand::RngExt as _;

fn random_points(n: usize, task: u32) -> Vec<DVec2> {
    let mut rng = Seed::new(17).stream(task);
    (0..n).map(|_| DVec2::new(rng.random(), rng.random())).collect()
}

fn random_strengths(n: usize, task: u32) -> Vec<f64> {
    let mut rng = Seed::new(18).stream(task);
    (0..n).map(|_| rng.random::<f64>() - 0.5).collect()
}

fn plan(k: usize, tolerance: f64, points: usize) -> Nufft {
    NufftOptions::new(k, tolerance).expecting(points).plan().expect("a plan")
}

/// The largest error of a mode over Σ|wⱼ|, which bounds every mode.
fn worst_mode(plan: &mut Nufft, points: &[DVec2], strengths: &[f64]) -> f64 {
    let k = plan.max_frequency();
    let mut modes = HalfPlane::zeros(k);
    plan.points_to_modes(points, Some(strengths), &mut modes);
    let want = direct_modes(points, Some(strengths), k);
    let scale: f64 = strengths.iter().map(|w| w.abs()).sum();
    let pairs = modes.values().iter().zip(want.values());
    pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / scale
}

#[test]
fn direct_sums_are_the_definition() {
    let (k, points) = (5_i64, random_points(7, 1));
    let strengths = random_strengths(7, 1);
    let term = |kx: i64, ky: i64, p: DVec2, sign: f64| {
        let phase = sign * TAU * (kx as f64 * p.x + ky as f64 * p.y);
        Complex::new(phase.cos(), phase.sin())
    };
    let modes = direct_modes(&points, Some(&strengths), k as usize);
    let complex: Vec<_> = strengths.iter().map(|&w| Complex::new(w, 2.0 * w - 0.1)).collect();
    let full = direct_complex_modes(&points, &complex, k as usize);
    for kx in -k..=k {
        for ky in -k..=k {
            let pairs = points.iter().zip(&strengths);
            let want: Complex<f64> = pairs.map(|(&p, &w)| term(kx, ky, p, -1.0) * w).sum();
            assert!((modes.get(kx, ky) - want).norm() < 3e-14);
            let pairs = points.iter().zip(&complex);
            let want: Complex<f64> = pairs.map(|(&p, &w)| term(kx, ky, p, -1.0) * w).sum();
            assert!((full.get(kx, ky) - want).norm() < 3e-14);
        }
    }
    let sums = direct_sums(&points, &modes);
    for (&p, &sum) in points.iter().zip(&sums) {
        let mut want = Complex::new(0.0, 0.0);
        for kx in -k..=k {
            for ky in -k..=k {
                want += modes.get(kx, ky) * term(kx, ky, p, 1.0);
            }
        }
        assert!((sum - want.re).abs() < 1e-12 && want.im.abs() < 1e-12);
    }
}

/// Phases are reduced exactly: a lattice's sums are n or 0 at any frequency.
#[test]
fn direct_sums_keep_their_digits_at_high_frequencies() {
    let m = 8;
    let points: Vec<_> =
        (0..m * m).map(|i| DVec2::new(f64::from(i % m), f64::from(i / m)) / f64::from(m)).collect();
    let modes = direct_modes(&points, None, 2000);
    for (kx, ky) in [(2000, 2000), (2000, 1999), (1992, -1600), (1, 0), (0, -1999)] {
        let want = if kx % 8 == 0 && ky % 8 == 0 { 64.0 } else { 0.0 };
        assert!((modes.get(kx, ky) - Complex::new(want, 0.0)).norm() < 2e-13, "({kx}, {ky})");
    }
}

#[test]
fn few_points_are_summed_directly_and_meet_the_same_bound() {
    let k = 24;
    let mut plan = plan(k, 1e-4, 300);
    let crossover = plan.crossover();
    assert!((2..=128).contains(&crossover), "{crossover}");
    for (n, rounding_only) in [(0, true), (1, true), (crossover, true), (crossover + 1, false)] {
        let points = random_points(n, 2);
        let strengths = random_strengths(n, 2);
        if n == 0 {
            let mut modes = HalfPlane::zeros(k);
            plan.points_to_modes(&points, None, &mut modes);
            assert!(modes.values().iter().all(|z| z.norm() == 0.0));
            let mut full = FullPlane::zeros(k);
            plan.complex_points_to_modes(&[], &[], &mut full);
            plan.modes_to_points(&modes, &[], &mut []);
            continue;
        }
        let error = worst_mode(&mut plan, &points, &strengths);
        assert!(error <= if rounding_only { 1e-15 } else { 1e-4 }, "n = {n}: {error:e}");
        assert!(rounding_only || error > 1e-9, "n = {n} was summed directly: {error:e}");
    }
}

/// All points in one place, in one cell, on the seam and beside it, on a line, on lattices whose
/// power lies beyond the band. The worst mode's error over Σ|wⱼ| may be some ten times the l2
/// tolerance: the kernel's aliases are strongest at the band's edge.
#[test]
fn points_that_lie_badly_stay_within_the_bound_of_each_mode() {
    const WORST_OVER_TOLERANCE: f64 = 10.0;
    let (n, k) = (400, 20);
    let below_one = 1.0 - f64::EPSILON / 2.0;
    let mut rng = Seed::new(19).stream(0);
    let mut cluster = |size: f64| -> Vec<DVec2> {
        let at = DVec2::new(0.3, 0.7);
        (0..n).map(|_| at + size * DVec2::new(rng.random(), rng.random())).collect()
    };
    let lattice = |m: usize| -> Vec<DVec2> {
        (0..n).map(|i| DVec2::new((i % m) as f64, (i / m % m) as f64) / m as f64).collect()
    };
    let sets = [
        ("coincident", vec![DVec2::new(0.123_456_789, 0.987_654_321); n]),
        ("at the origin", vec![DVec2::ZERO; n]),
        ("below the seam", vec![DVec2::splat(below_one); n]),
        ("around the corner", {
            let corner = [0.0, below_one, 1e-300, 1e-17, 0.5 - 1e-17];
            (0..n).map(|i| DVec2::new(corner[i % 5], corner[i / 5 % 5])).collect()
        }),
        ("in one cell", cluster(1e-3)),
        ("1e-12 apart", cluster(1e-12)),
        ("collinear", (0..n).map(|i| DVec2::new(i as f64 / n as f64, 0.25)).collect()),
        ("square lattice", lattice(20)),
        ("aliased lattice", lattice(44)),
        ("lattice beyond the band", lattice(64)),
    ];
    for tolerance in [1e-2, 1e-6, 1e-12] {
        let mut plan = plan(k, tolerance, n);
        for (name, points) in &sets {
            for (kind, strengths) in [
                ("unit", vec![1.0; n]),
                ("alternating", (0..n).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 }).collect()),
                ("single", (0..n).map(|i| if i == 137 { 1.0 } else { 0.0 }).collect()),
            ] {
                let error = worst_mode(&mut plan, points, &strengths) / tolerance;
                println!("{name}, {kind}, {tolerance:e}: {error:.2} of the tolerance");
                assert!(error < WORST_OVER_TOLERANCE, "{name}, {kind}, {tolerance:e}: {error}");
            }
        }
    }
}

#[test]
fn the_smallest_ranges_work() {
    for k in 0..=3 {
        let points = random_points(500, 3);
        let strengths = random_strengths(500, 3);
        let mut plan = plan(k, 1e-9, 1_000_000);
        let error = worst_mode(&mut plan, &points, &strengths);
        assert!(error < 1e-9, "K = {k}: {error:e}");
    }
}

#[test]
fn threads_and_buffers_leave_no_trace() {
    let (n, k) = (3000, 150);
    let points = random_points(n, 4);
    let strengths = random_strengths(n, 4);
    let options = NufftOptions::new(k, 1e-6).expecting(n);
    let run = |plan: &mut Nufft| {
        let mut modes = HalfPlane::zeros(k);
        plan.points_to_modes(&points, Some(&strengths), &mut modes);
        let (mut real, mut complex) = (vec![0.0; n], vec![Complex::new(0.0, 0.0); n]);
        plan.modes_to_points(&modes, &points, &mut real);
        plan.columns_to_complex_points(&points, &mut complex, |kx, column| {
            column.copy_from_slice(modes.column(kx.unsigned_abs() as usize));
        });
        (modes, real, complex)
    };
    let want = run(&mut options.sequential().plan().expect("a plan"));
    for threads in [1, 2, 5] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let got = pool.install(|| run(&mut options.plan().expect("a plan")));
        assert!(got == want, "{threads} threads");
    }
    // A plan that has seen other points, more of them and fewer.
    let mut used: Nufft = options.plan().expect("a plan");
    for other in [random_points(9000, 5), random_points(200, 6), random_points(3, 7)] {
        used.points_to_modes(&other, None, &mut HalfPlane::zeros(k));
        used.modes_to_points(&want.0, &other, &mut vec![0.0; other.len()]);
    }
    assert!(run(&mut used) == want);
    // In a pool of more threads than the last.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(7).build().expect("a pool");
    assert!(pool.install(|| run(&mut used)) == want);
}

#[test]
fn portable_instructions_give_the_same_to_rounding() {
    let (n, k) = (1500, 90);
    let points = random_points(n, 8);
    let options = NufftOptions::new(k, 1e-9).expecting(n);
    let run = |options: NufftOptions| {
        let mut plan: Nufft = options.plan().expect("a plan");
        let mut modes = HalfPlane::zeros(k);
        plan.points_to_modes(&points, None, &mut modes);
        let mut values = vec![0.0; n];
        plan.modes_to_points(&modes, &points, &mut values);
        (modes, values)
    };
    let (fast, portable) = (run(options), run(options.portable()));
    let scale = (n as f64).sqrt();
    for (a, b) in fast.0.values().iter().zip(portable.0.values()) {
        assert!((a - b).norm() < 1e-10 * scale);
    }
    let largest = fast.1.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    for (a, b) in fast.1.iter().zip(&portable.1) {
        assert!((a - b).abs() < 1e-12 * largest);
    }
}

#[test]
fn columns_come_on_demand_and_in_parts() {
    let (n, k) = (700, 33);
    let points = random_points(n, 9);
    let mut plan = plan(k, 1e-8, n);
    let mut whole = HalfPlane::zeros(k);
    plan.points_to_modes(&points, None, &mut whole);
    for kept in [0..k + 1, 5..20, k..k + 1, 7..7] {
        let columns = plan.transform(&points, None, kept.clone());
        for wanted in [kept.clone(), kept.start..kept.start + kept.len() / 2] {
            let mut got = vec![Vec::new(); wanted.len()];
            columns.each(wanted.clone(), got.iter_mut().collect(), |kx, got, modes| {
                assert!(wanted.contains(&kx));
                got.extend_from_slice(modes);
            });
            for (kx, got) in wanted.clone().zip(&got) {
                assert!(got == whole.column(kx), "column {kx} of {kept:?}");
            }
        }
    }
}

#[test]
fn a_lopsided_column_zero_gives_real_parts() {
    let (n, k) = (300, 16);
    let points = random_points(n, 10);
    let mut modes = HalfPlane::zeros(k);
    for (i, z) in modes.columns_mut().flatten().enumerate() {
        let i = i as f64;
        *z = Complex::new((1.3 * i).sin(), (0.7 * i).cos());
    }
    let mut values = vec![0.0; n];
    plan(k, 1e-12, n).modes_to_points(&modes, &points, &mut values);
    let want = direct_sums(&points, &modes);
    let largest = want.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    for (got, want) in values.iter().zip(&want) {
        assert!((got - want).abs() < 1e-11 * largest);
    }
}

#[test]
fn coordinates_are_taken_modulo_one() {
    let (n, k) = (300, 16);
    let points = random_points(n, 11);
    let moved: Vec<_> = points.iter().map(|&p| p + DVec2::new(3.0, -2.0)).collect();
    let mut plan = plan(k, 1e-9, n);
    let (mut a, mut b) = (HalfPlane::zeros(k), HalfPlane::zeros(k));
    plan.points_to_modes(&points, None, &mut a);
    plan.points_to_modes(&moved, None, &mut b);
    for (a, b) in a.values().iter().zip(b.values()) {
        assert!((a - b).norm() < 1e-9 * (n as f64).sqrt());
    }
    // NaN spreads over all modes, without a panic.
    let mut broken = points;
    broken[5].x = f64::NAN;
    broken[9].y = f64::INFINITY;
    plan.points_to_modes(&broken, None, &mut a);
    assert!(a.get(3, -4).re.is_nan());
    plan.modes_to_points(&b, &broken, &mut vec![0.0; n]);
}

#[test]
fn absurd_plans_are_refused() {
    for tolerance in [0.0, -1e-6, f64::NAN] {
        let refused = NufftOptions::new(10, tolerance).plan::<f64>();
        assert!(matches!(refused, Err(NufftError::Tolerance { .. })), "{tolerance}");
    }
    let refused = NufftOptions::new(usize::MAX / 4, 1e-6).plan::<f64>();
    assert!(matches!(refused, Err(NufftError::Frequency { .. })));
}

/// Gradients against the modes' own derivatives, for many points and few.
#[test]
fn gradients_are_those_of_the_sums() {
    let max_frequency = 20;
    for n in [3, 400] {
        let points = random_points(n, 77);
        let modes = direct_modes(&random_points(50, 78), None, max_frequency);
        let options = NufftOptions::new(max_frequency, 1e-9).expecting(n).portable();
        let mut plan: Nufft = options.plan().expect("valid");
        let mut got = vec![DVec2::ZERO; n];
        plan.columns_to_gradients(&points, &mut got, |kx, out| {
            out.copy_from_slice(modes.column(kx));
        });
        for axis in 0..2 {
            let mut turned = modes.clone();
            for (kx, column) in turned.columns_mut().enumerate() {
                for (j, mode) in column.iter_mut().enumerate() {
                    let k = if axis == 0 { kx as f64 } else { j as f64 - max_frequency as f64 };
                    *mode *= Complex::new(0.0, std::f64::consts::TAU * k);
                }
            }
            let want = direct_sums(&points, &turned);
            let scale = want.iter().map(|v| v * v).sum::<f64>().sqrt();
            let error =
                got.iter().zip(&want).map(|(g, w)| (g[axis] - w).powi(2)).sum::<f64>().sqrt();
            // The kernel's derivative loses a factor of its width's order, here about 10.
            assert!(error < 3e-8 * scale, "{n} points, axis {axis}: {error} of {scale}");
        }
    }
}
