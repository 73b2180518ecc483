//! Targets: each way to the RDF against another one, and what is refused.

use bn_core::{Density, PointSet, Seed};
use bn_spectral::{
    HankelPlan, Realizability, SinglePeak, Target, TargetError, direct_modes, highest_step,
    step_rdf,
};
use rand::RngExt as _;

const N: usize = 1024;

fn density() -> Density {
    Density::new(N)
}

fn radii() -> Vec<f64> {
    (0..400).map(|i| f64::from(i) * 0.5 / 400.0).collect()
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn a_sharp_peak_is_a_step_and_an_annulus() {
    let (nu0, width, p0) = (20.0, 2.0, 3.0);
    let sharp = SinglePeak { nu0, peak: p0, sigma: 0.0, width };
    let target = Target::single_peak(density(), sharp).expect("valid");
    assert_eq!([19.9, 20.0, 21.9, 22.1].map(|nu| target.power(nu)), [0.0, 2.5, 2.5, 1.0]);
    // Step at ν₀ and p₀/width times the difference of two more.
    let n = N as f64;
    let want = |&r: &f64| {
        let step = |nu: f64| step_rdf(n, nu, r) - 1.0;
        1.0 + step(nu0) + p0 / width * (step(nu0) - step(nu0 + width))
    };
    let want: Vec<f64> = radii().iter().map(want).collect();
    assert!(largest_difference(&target.rdf(&radii()), &want) < 1e-12);
}

/// The Gaussian that smooths along ν turns the transform of a narrow one into that of a sharp peak.
#[test]
fn smooth_peaks_tend_to_the_sharp_one() {
    let peak = |sigma| {
        let peak = SinglePeak { nu0: 20.0, peak: 3.0, sigma, width: 2.0 };
        Target::single_peak(density(), peak).expect("valid").rdf(&radii())
    };
    // Smoothing changes g by about (2πσr)²/2 of itself, and by σ²/(2n)·(slopes) at 0.
    let (sharp, narrow, wide) = (peak(0.0), peak(0.05), peak(0.1));
    let (one, four) = (largest_difference(&sharp, &narrow), largest_difference(&sharp, &wide));
    assert!(one < 0.02 && (3.5..4.5).contains(&(four / one)), "{one} {four}");
}

/// However narrow the Gaussian, with the two slopes apart: the error goes like σ², and nothing takes
/// more nodes as it gets narrower.
#[test]
fn narrow_slopes_are_told_from_sharp_ones_while_they_differ() {
    let peak = |sigma| {
        let peak = SinglePeak { nu0: 20.0, peak: 3.0, sigma, width: 2.0 };
        Target::single_peak(density(), peak).expect("valid")
    };
    let sharp = peak(0.0).rdf(&radii());
    let difference = |sigma: f64| largest_difference(&sharp, &peak(sigma).rdf(&radii()));
    let ratio = difference(2e-3) / difference(1e-3);
    assert!((3.9..4.1).contains(&ratio), "{ratio}");
    // By (2π/n)·(σ²/2)·height·|d(ν J₀)/dν| at each edge.
    let most = |sigma: f64| 1e-12 + 0.2 * sigma * sigma;
    for exponent in 3..=13 {
        let sigma = 10.0_f64.powi(-exponent);
        assert!(difference(sigma) < most(sigma), "{sigma}: {}", difference(sigma));
        let verdict = Realizability::of(&peak(sigma));
        assert_eq!(verdict.realizable, Realizability::of(&peak(0.0)).realizable, "{sigma}");
    }
    let far = SinglePeak { nu0: 1e9, peak: 3.0, sigma: 1e-300, width: 1e-9 };
    assert!(!Realizability::of(&Target::single_peak(density(), far).expect("valid")).realizable);
}

#[test]
fn samples_of_a_smooth_spectrum_give_its_rdf() {
    let exact = Target::single_peak(density(), SinglePeak::thesis(density())).expect("valid");
    let error = |step: f64| {
        let samples: Vec<_> = (0..(100.0 / step) as u32)
            .map(|i| (f64::from(i) * step, exact.power(f64::from(i) * step)))
            .collect();
        let sampled = Target::power_curve(density(), &samples).expect("valid");
        largest_difference(&exact.rdf(&radii()), &sampled.rdf(&radii()))
    };
    // The midpoint rule: second order.
    let (coarse, fine) = (error(0.5), error(0.25));
    assert!(fine < 0.02 && (3.0..5.0).contains(&(coarse / fine)), "{coarse} {fine}");
}

/// The transform of lines between few samples against Gauss quadrature of them, both ways.
#[test]
fn curves_are_lines_between_their_samples() {
    let mut rng = Seed::new(21).stream(0);
    let root = (N as f64).sqrt();
    for samples in [2, 3, 5, 40] {
        let mut x: Vec<f64> = (0..samples).map(|_| 3.0 * rng.random::<f64>()).collect();
        x.sort_by(f64::total_cmp);
        let y: Vec<f64> = x.iter().map(|_| 2.0 * rng.random::<f64>()).collect();
        let curve = |unit: f64| -> Vec<(f64, f64)> {
            x.iter().zip(&y).map(|(x, y)| (x * unit, *y)).collect()
        };
        let oracle = |target: &dyn Fn(f64) -> f64, unit: f64, at: &[f64]| {
            let breaks: Vec<f64> = [0.0].iter().chain(&x).map(|x| x * unit).collect();
            HankelPlan::new(&breaks, unit, at).transform(|x| target(x) - 1.0)
        };
        let power = Target::power_curve(density(), &curve(root)).expect("valid");
        let want = oracle(&|nu| power.power(nu), root, &radii());
        let want: Vec<f64> = want.iter().map(|g| 1.0 + g / N as f64).collect();
        let error = largest_difference(&power.rdf(&radii()), &want);
        assert!(error < 1e-5, "{samples}: {error}");

        let rdf = Target::rdf_curve(density(), &curve(1.0 / root)).expect("valid");
        // At its table's own frequencies: what lies between is another matter.
        let nu: Vec<f64> = (0..1000).map(|i| f64::from(i) * root / 64.0).collect();
        let want = oracle(&|r| rdf.rdf(&[r])[0], 1.0 / root, &nu);
        let want: Vec<f64> = want.iter().map(|p| 1.0 + p * N as f64).collect();
        let got: Vec<f64> = nu.iter().map(|nu| rdf.power(*nu)).collect();
        let error = largest_difference(&got, &want);
        assert!(error < 1e-5, "{samples}: {error}");
    }
}

/// P → g → P: what is left is the blur of the samples.
#[test]
fn an_rdf_leads_back_to_its_spectrum() {
    let exact = Target::single_peak(density(), SinglePeak::thesis(density())).expect("valid");
    let r: Vec<f64> = (0..6000).map(|i| f64::from(i) * 1e-4).collect();
    let samples: Vec<_> = r.iter().copied().zip(exact.rdf(&r)).collect();
    let back = Target::rdf_curve(density(), &samples).expect("valid");
    for nu in (1..150).map(f64::from) {
        let (got, want) = (back.power(nu), exact.power(nu));
        assert!((got - want).abs() < 0.05, "P({nu}) = {got}, not {want}");
    }
    assert!((back.rdf(&[0.0123])[0] - exact.rdf(&[0.0123])[0]).abs() < 1e-4);
}

#[test]
fn sums_and_products() {
    let nu0 = highest_step(N as f64);
    let step = Target::step(density(), nu0).expect("valid");
    let other = Target::step(density(), 0.5 * nu0).expect("valid");
    let sum = Target::sum(vec![(0.25, step.clone()), (0.75, other.clone())]).expect("alike");
    assert_eq!([0.4, 0.7, 1.1].map(|x| sum.power(x * nu0)), [0.0, 0.75, 1.0]);
    let mixed =
        |r: &f64| 0.25 * step_rdf(N as f64, nu0, *r) + 0.75 * step_rdf(N as f64, 0.5 * nu0, *r);
    let want: Vec<f64> = radii().iter().map(mixed).collect();
    assert!(largest_difference(&sum.rdf(&radii()), &want) < 1e-13);
    // The product of two steps is the later one.
    let product = Target::product(vec![step.clone(), other]).expect("alike");
    assert!(largest_difference(&product.rdf(&radii()), &step.rdf(&radii())) < 1e-9);
    let elsewhere = Target::step(Density::new(5), 1.0).expect("valid");
    assert_eq!(Target::product(vec![step, elsewhere]), Err(TargetError::Parts));
    assert_eq!(Target::sum(vec![]), Err(TargetError::Parts));
}

#[test]
fn independent_points_are_imitated_by_one() {
    let mut rng = Seed::new(3).stream(0);
    let points = (0..N).map(|_| bn_core::DVec2::new(rng.random(), rng.random())).collect();
    let set = PointSet::new(points).expect("valid");
    let target = Target::imitating(&[set], 4 * N).expect("measurable");
    assert_eq!(target.density().points_per_unit_area(), 4.0 * N as f64);
    // Rings of c modes have a mean of variance 2/c. Frequencies are doubled: around ν there was a ring
    // of half a cycle at ν/2, of πν/2 modes.
    for nu in [100.0_f64, 200.0, 300.0] {
        let deviation = (4.0 / (std::f64::consts::PI * nu)).sqrt();
        assert!((target.power(nu) - 1.0).abs() < 5.0 * deviation, "P({nu}) = {}", target.power(nu));
    }
}

/// Over each ring of half a cycle that has modes the target is the mean of direct sums, also where a
/// ring beside it has none.
#[test]
fn what_is_imitated_is_the_mean_of_each_ring() {
    const M: usize = 30;
    let mut rng = Seed::new(4).stream(0);
    let points: Vec<_> = (0..M).map(|_| bn_core::DVec2::new(rng.random(), rng.random())).collect();
    let target = Target::imitating(&[PointSet::new(points.clone()).expect("valid")], M);
    let target = target.expect("measurable");
    // 6√30 ≈ 32.9.
    let limit = 33_i64;
    let modes = direct_modes(&points, None, limit as usize);
    let (mut count, mut sums) = (vec![0; 66], vec![[0.0; 2]; 66]);
    for kx in -limit..=limit {
        for ky in -limit..=limit {
            let nu = ((kx * kx + ky * ky) as f64).sqrt();
            let ring = (2.0 * nu) as usize;
            if (1..66).contains(&ring) {
                count[ring] += 1;
                sums[ring][0] += modes.get(kx, ky).norm_sqr() / M as f64;
                sums[ring][1] += target.power(nu);
            }
        }
    }
    assert_eq!((count[2], count[3], count[4]), (8, 0, 12));
    for (ring, [want, got]) in sums.into_iter().enumerate() {
        assert!((got - want).abs() <= 1e-6 * want, "ring {ring}: {got}, not {want}");
    }
}

#[test]
fn absurd_targets_are_refused() {
    let bad = f64::NAN;
    assert!(matches!(
        Target::step(density(), bad),
        Err(TargetError::Parameter { name: "nu0", .. })
    ));
    assert!(Target::step(density(), -1.0).is_err());
    let peak = SinglePeak { width: 0.0, ..SinglePeak::thesis(density()) };
    assert!(matches!(
        Target::single_peak(density(), peak),
        Err(TargetError::Parameter { name: "width", .. })
    ));
    let curve = |samples: &[(f64, f64)]| Target::power_curve(density(), samples);
    assert_eq!(curve(&[(1.0, 1.0)]), Err(TargetError::Count { count: 1 }));
    assert!(matches!(curve(&[(0.0, 1.0), (1.0, bad)]), Err(TargetError::Value { index: 1, .. })));
    for x in [0.0, -1.0, bad, f64::INFINITY] {
        let error = curve(&[(0.0, 1.0), (x, 1.0)]).expect_err("not ascending");
        assert!(matches!(error, TargetError::Abscissa { index: 1, .. }), "{error}");
    }
    assert_eq!(Target::imitating(&[], 5), Err(TargetError::Sets));
}

#[test]
fn the_original_program_s_table() {
    let density = Density::new(4096);
    let table = SinglePeak::tabulated(density, 60, 20.0, 5.0);
    assert_eq!((table.step(), table.values().len()), (0.5, 4096));
    // Bins of half a cycle from their lower edges, so a quarter of a cycle behind ours.
    let ours = SinglePeak::thesis(density);
    for nu in [40.0, 55.0, 60.0, 62.0, 70.0, 100.0] {
        let (got, want) = (table.interpolate(nu - 0.25), ours.power(nu));
        assert!((got - want).abs() < 0.02, "{got} at {nu}, not {want}");
    }
}
