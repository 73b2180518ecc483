//! Readers and writers of all formats, in memory.

use std::hint::black_box;

use bn_core::io::{self, Format, ReadOptions};
use bn_core::{DVec2, PointSet, Seed};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use rand::RngExt;

fn benches(criterion: &mut Criterion) {
    let n = 1_000_000;
    let mut rng = Seed::new(1).stream(0);
    let points = (0..n).map(|_| DVec2::new(rng.random(), rng.random())).collect();
    let sets = [PointSet::new(points).expect("drawn from [0, 1)²")];
    for format in Format::ALL {
        let mut file = Vec::new();
        io::write(format, &sets, &mut file).expect("in memory");
        let mut group = criterion.benchmark_group("io");
        group.sample_size(10).throughput(Throughput::Elements(n));
        group.bench_function(BenchmarkId::new("read", format), |b| {
            b.iter(|| io::read(format, "memory", black_box(&file[..]), ReadOptions::default()));
        });
        let mut target = Vec::with_capacity(file.len());
        group.bench_function(BenchmarkId::new("write", format), |b| {
            b.iter(|| {
                target.clear();
                io::write(format, black_box(&sets), &mut target)
            });
        });
        group.finish();
    }
}

criterion_group!(all, benches);
criterion_main!(all);
