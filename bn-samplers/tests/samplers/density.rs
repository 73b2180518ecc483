//! One suite over all methods that take a density: points are as dense as it says.

use std::f64::consts::TAU;
use std::sync::Arc;

use bn_core::{DVec2, DensityFunction, PointSet, Seed, Unobserved, torus};
use bn_samplers::{Given, METHODS, Method, OptionKind, Sample, SampleError, Sampler};
use rayon::prelude::*;

/// Blocks on a side of the torus.
const BLOCKS: usize = 8;

fn methods() -> Vec<&'static Method> {
    let takes = |method: &&Method| method.options.iter().any(|o| o.kind == OptionKind::Density);
    METHODS.iter().copied().filter(takes).collect()
}

/// The method with this density and enough iterations to tell.
fn sampler(method: &Method, density: Option<&Arc<DensityFunction>>) -> Box<dyn Sampler> {
    let given = |density: &Arc<DensityFunction>| ("density", Given::Density(Arc::clone(density)));
    let iterates = method.options.iter().any(|option| option.name == "iterations");
    let iterations = iterates.then_some(("iterations", Given::Text("150")));
    method.with_values(density.map(given).into_iter().chain(iterations)).expect("valid")
}

fn sample(
    method: &Method,
    density: &Arc<DensityFunction>,
    n: usize,
) -> Result<Sample, SampleError> {
    sampler(method, Some(density)).sample(n, Seed::new(1), &Unobserved)
}

/// The number of points in each block, for some sets.
fn counts(sampler: &dyn Sampler, n: usize, sets: u32) -> Vec<Vec<f64>> {
    let count = |set| {
        let sample = sampler.sample(n, Seed::new(7).for_set(set), &Unobserved).expect("possible");
        assert_eq!(sample.points.len(), n);
        let mut counts = vec![0.0; BLOCKS * BLOCKS];
        for p in sample.points.points() {
            let index = |x: f64| (x * BLOCKS as f64) as usize;
            counts[index(p.y) * BLOCKS + index(p.x)] += 1.0;
        }
        counts
    };
    (0..sets).into_par_iter().map(count).collect()
}

#[test]
fn local_counts_follow_a_ramp() {
    let (n, sets) = (2048, 4);
    // Smooth around the torus as well: cells that lie across a jump blur it.
    let ramp = |p: DVec2| 1.0 - 0.4 * libm::cos(TAU * p.x) - 0.2 * libm::cos(TAU * (p.x + p.y));
    let ramp = Arc::new(DensityFunction::from_fn(100, ramp).expect("valid"));
    for method in methods() {
        let counts = counts(&*sampler(method, Some(&ramp)), n, sets);
        let blocks: Vec<_> = (0..BLOCKS * BLOCKS)
            .map(|block| {
                let corner = DVec2::new((block % BLOCKS) as f64, (block / BLOCKS) as f64);
                let [low, high] = [corner, corner + 1.0].map(|corner| corner / BLOCKS as f64);
                let want = ramp.mass(low, high) * n as f64;
                let mean = counts.iter().map(|counts| counts[block]).sum::<f64>() / f64::from(sets);
                let squares = counts.iter().map(|counts| (counts[block] - mean).powi(2));
                (want, mean, squares.sum::<f64>() / f64::from(sets - 1))
            })
            .collect();
        // The method's own noise: variances of counts, in proportion to the counts.
        let noise = blocks.iter().map(|(want, _, variance)| variance / want).sum::<f64>();
        let noise = noise / blocks.len() as f64;
        let is_off = |&&(want, mean, _): &&(f64, f64, f64)| {
            let sd = (noise * want / f64::from(sets)).sqrt();
            (mean - want).abs() > (0.05 * want).max(3.0 * sd)
        };
        // Of 64 normally distributed numbers 0.2 are beyond three standard deviations.
        let off: Vec<_> = blocks.iter().filter(is_off).collect();
        assert!(off.len() <= 1, "{}, noise {noise}: {off:?}", method.name);
    }
}

#[test]
fn an_even_density_changes_nothing() {
    let even = Arc::new(DensityFunction::from_raster(3, 2, vec![0.7; 6]).expect("valid"));
    for method in methods() {
        let without = sampler(method, None).sample(90, Seed::new(1), &Unobserved);
        assert!(sample(method, &even, 90) == without, "{}", method.name);
    }
}

#[test]
fn repeatable_on_any_number_of_threads() {
    let disk = |p: DVec2| if torus::distance(p, DVec2::splat(0.4)) < 0.3 { 1.0 } else { 0.1 };
    let density = Arc::new(DensityFunction::from_fn(64, disk).expect("valid"));
    for method in methods() {
        let on_threads = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.expect("threads").install(|| sample(method, &density, 3000)).expect("possible")
        };
        assert!(on_threads(1) == on_threads(2), "{}", method.name);
    }
}

/// The part of the points that lie where the density, blurred over a spacing or two, has nothing.
fn astray(points: &PointSet, is_outside: impl Fn(DVec2) -> bool) -> f64 {
    points.points().iter().filter(|p| is_outside(**p)).count() as f64 / points.len() as f64
}

#[test]
fn white_halves_stay_white() {
    let half = DensityFunction::from_raster(2, 1, vec![1.0, 0.0]).expect("valid");
    let half = Arc::new(half);
    for method in methods() {
        for n in [1, 2, 3, 10, 300] {
            let set = sample(method, &half, n).expect("possible").points;
            assert_eq!(set.len(), n, "{}", method.name);
            if n == 300 {
                // Two spacings, 1/√(2·300) each, beyond the edge.
                let part = astray(&set, |p| (0.58..0.92).contains(&p.x));
                assert!(part < 0.01, "{}: {part}", method.name);
            }
        }
    }
}

#[test]
fn a_single_pixel_gets_all_points() {
    let mut values = vec![0.0; 64 * 64];
    values[64 * 20 + 30] = 1.0;
    let pixel = Arc::new(DensityFunction::from_raster(64, 64, values).expect("valid"));
    let middle = DVec2::new(30.5, 20.5) / 64.0;
    for method in methods() {
        for n in [1, 2, 100] {
            match sample(method, &pixel, n) {
                Ok(sample) => {
                    assert_eq!(sample.points.len(), n, "{}", method.name);
                    // Two pixels, and what a charge is blurred to.
                    let far = 2.5 / 64.0 + 0.3 / (n as f64).sqrt();
                    let part = astray(&sample.points, |p| torus::distance(p, middle) > far);
                    assert!(part < 0.05, "{}: {part} of {n}", method.name);
                }
                Err(error) => assert!(!error.to_string().is_empty(), "{}", method.name),
            }
        }
    }
}

/// Densities of all sizes, a stripe as fine as pixels and one value of 10⁻³⁰⁰.
#[test]
fn absurd_densities_end() {
    let stripes = (0..4096).map(|i| f64::from(i % 2)).collect();
    let mut faint = vec![1e-300; 16];
    faint[5] = 1.0;
    for (width, height, values) in [(4096, 1, stripes), (4, 4, faint), (1, 2, vec![1e-5, 1e5])] {
        let density = DensityFunction::from_raster(width, height, values).expect("valid");
        let density = Arc::new(density);
        for method in methods() {
            for n in [1, 3, 64] {
                let set = sample(method, &density, n).expect("possible").points;
                assert_eq!(set.len(), n, "{}", method.name);
                assert!(set.points().iter().all(|p| torus::contains(*p)));
            }
        }
    }
}
