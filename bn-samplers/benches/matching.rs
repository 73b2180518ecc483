//! Spectrum matching by the iteration: every algorithm on the step of 1024 and 4096 points.

use std::hint::black_box;

use bn_core::{Density, PointSet, Seed, Unobserved};
use bn_samplers::{Algorithm, Sampler as _, SpectrumMatching, Stochastic};
use bn_spectral::{Target, highest_step};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

/// Iterations a run, from random points on.
const ITERATIONS: u32 = 10;

fn iterations(c: &mut Criterion) {
    let mut group = c.benchmark_group("iterations");
    group.sample_size(10).throughput(Throughput::Elements(ITERATIONS.into()));
    for n in [1024, 4096] {
        for &name in Algorithm::NAMES {
            let algorithm = Algorithm::named(name).expect("listed").with_iterations(ITERATIONS);
            let target = Target::step(Density::new(n), highest_step(n as f64)).expect("valid");
            let matching = SpectrumMatching::new(target, algorithm);
            group.bench_function(BenchmarkId::new(name, n), |b| {
                b.iter(|| matching.sample(black_box(n), Seed::new(1), &Unobserved));
            });
        }
    }
    group.finish();
}

/// How far a set is from its target: one transform up to 6√n.
fn residual(c: &mut Criterion) {
    let mut group = c.benchmark_group("residual");
    for n in [1024, 4096] {
        let set: PointSet =
            Stochastic::default().sample(n, Seed::new(1), &Unobserved).expect("valid").points;
        let target = Target::step(Density::new(n), highest_step(n as f64)).expect("valid");
        let matching = SpectrumMatching::new(target, Algorithm::default());
        group.throughput(Throughput::Elements(n as u64));
        group.bench_function(BenchmarkId::from_parameter(n), |b| {
            b.iter(|| matching.residual(black_box(&set)));
        });
    }
    group.finish();
}

criterion_group!(benches, iterations, residual);
criterion_main!(benches);
