//! Every method of the registry at 4096 points, and Poisson disks at 100,000.

use std::hint::black_box;

use bn_core::{Seed, Unobserved};
use bn_samplers::METHODS;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

fn sampler(
    c: &mut Criterion,
    group: &str,
    name: &str,
    options: &[(&'static str, &'static str)],
    n: usize,
) {
    let method = bn_samplers::find(name).expect("a method of the registry");
    let sampler = method.with_options(options.iter().copied()).expect("valid options");
    let sample = |seed| sampler.sample(n, Seed::new(seed), &Unobserved).expect("a pattern");
    let mut group = c.benchmark_group(group);
    // The count follows from the radius for some.
    group.throughput(Throughput::Elements(sample(1).points.len() as u64));
    group.sample_size(10);
    group.bench_function(BenchmarkId::from_parameter(name), |b| {
        b.iter(|| sample(black_box(1)));
    });
    group.finish();
}

fn all(c: &mut Criterion) {
    for method in METHODS {
        sampler(c, "4096", method.name, &[], 4096);
    }
}

fn poisson_disks(c: &mut Criterion) {
    sampler(c, "100000", "dart-throwing", &[("radius", "0.7")], 100_000);
    sampler(c, "100000", "maximal-poisson-disk", &[], 100_000);
}

criterion_group!(benches, all, poisson_disks);
criterion_main!(benches);
