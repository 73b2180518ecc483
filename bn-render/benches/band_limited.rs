//! Iterative reconstruction: what its stages cost, and images as wholes.

mod common;

use std::hint::black_box;

use bn_core::{DVec2, PointSet, Unobserved};
use bn_render::{
    BandLimitedFit, BandLimitedMethod, BandLimitedOptions, BandLimitedRenderer, Degree,
    LimitedZonePlate, LowPass, Pattern, Stopping, kernel,
};
use common::{frame, jittered};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

/// Exactly so many iterations.
fn to(iterations: usize) -> Stopping {
    Stopping { iterations, tolerance: 0.0 }
}

fn values(points: &[DVec2]) -> Vec<f64> {
    points.iter().map(|p| 0.5 + 0.5 * libm::sin(90.0 * p.x * p.x - 40.0 * p.y)).collect()
}

/// What comes before the first iteration, and what ten cost: four samples a coefficient.
fn stages(c: &mut Criterion) {
    for m in [128_u32, 512] {
        let set: PointSet = jittered(m);
        let (points, values) = (set.points(), values(set.points()));
        let degree = Degree { x: m as usize / 4, y: m as usize / 4 };
        let weights = vec![1.0; points.len()];
        let new = || BandLimitedFit::new(points.to_vec(), &weights, degree).expect("a fit");
        let mut group = c.benchmark_group(format!("fit-{}-samples", m * m));
        group.throughput(Throughput::Elements(u64::from(m * m))).sample_size(10);
        group.bench_function("plan", |b| b.iter(|| black_box(new())));
        group.bench_function("act-matrix-and-right-side", |b| {
            b.iter(|| new().act(&values, &to(0), &Unobserved).expect("finite"));
        });
        let mut fit = new();
        for iterations in [0, 10] {
            group.bench_function(BenchmarkId::new("act", iterations), |b| {
                b.iter(|| fit.act(black_box(&values), &to(iterations), &Unobserved));
            });
            group.bench_function(BenchmarkId::new("pocs", iterations), |b| {
                b.iter(|| fit.pocs(black_box(&values), &to(iterations), &Unobserved));
            });
        }
        group.finish();
    }
}

/// Images of 256 × 256 pixels at 4 samples per pixel.
fn images(c: &mut Criterion) {
    let frame = frame(256, 256);
    let scene = LimitedZonePlate::new(&frame, 0.4, 128.0);
    let set = jittered(64);
    let pattern = Pattern::weighted(&set, &vec![1.0; set.len()], 4.0).expect("weights");
    let mut group = c.benchmark_group("image-256-4spp");
    group.throughput(Throughput::Elements(256 * 256 * 4)).sample_size(10);
    for (name, method) in [("act", BandLimitedMethod::Act), ("pocs", BandLimitedMethod::Pocs)] {
        let options = BandLimitedOptions { method, stopping: to(10), ..Default::default() };
        let low_pass = LowPass::Kernel(kernel("lanczos2").expect("a kernel"));
        let renderer =
            BandLimitedRenderer { scene: &scene, pattern: &pattern, low_pass, frame, options };
        group.bench_function(BenchmarkId::new(name, "10 iterations"), |b| {
            b.iter(|| renderer.image(&Unobserved).expect("small enough"));
        });
    }
    group.finish();
}

criterion_group!(benches, stages, images);
criterion_main!(benches);
