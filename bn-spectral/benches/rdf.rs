//! Pair histograms: pairs per second for all pairs and for the near ones only.

use std::hint::black_box;
use std::time::Duration;

use bn_core::{DVec2, PointSet, Seed};
use bn_spectral::{Autocorrelation, PairHistogram, WindowedSpectrum};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use rand::RngExt as _;

fn random_set(n: usize) -> PointSet {
    let mut rng = Seed::new(1).stream(0);
    let points = (0..n).map(|_| DVec2::new(rng.random(), rng.random())).collect();
    PointSet::new(points).expect("in the unit square")
}

fn rdf(c: &mut Criterion) {
    let mut group = c.benchmark_group("rdf");
    group.sample_size(10).warm_up_time(Duration::from_millis(300));
    group.measurement_time(Duration::from_secs(2));
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    for n in [1024, 4096, 16384] {
        let set = random_set(n);
        let bins = 100 * (n as f64).sqrt() as usize;
        group.throughput(Throughput::Elements((n * (n - 1) / 2) as u64));
        group.bench_function(BenchmarkId::new("all_pairs_1_thread", n), |b| {
            b.iter(|| one_thread.install(|| PairHistogram::new(black_box(&set), bins)));
        });
        group.bench_function(BenchmarkId::new("all_pairs", n), |b| {
            b.iter(|| PairHistogram::new(black_box(&set), bins));
        });
    }
    let set = random_set(100_000);
    group.throughput(Throughput::Elements(100_000));
    group.bench_function(BenchmarkId::new("within_10_spacings", 100_000), |b| {
        b.iter(|| PairHistogram::within(black_box(&set), 10.0 / 100_000_f64.sqrt(), 1000));
    });
    let set = [set];
    group.bench_function(BenchmarkId::new("autocorrelation_8_spacings", 100_000), |b| {
        b.iter(|| Autocorrelation::of(black_box(&set), 8.0 / 100_000_f64.sqrt(), 161));
    });
    let set = [random_set(4096)];
    group.throughput(Throughput::Elements(4096));
    group.bench_function(BenchmarkId::new("windowed_spectrum_1_thread", 4096), |b| {
        b.iter(|| one_thread.install(|| WindowedSpectrum::of(black_box(&set))));
    });
    group.bench_function(BenchmarkId::new("windowed_spectrum", 4096), |b| {
        b.iter(|| WindowedSpectrum::of(black_box(&set)));
    });
    group.finish();
}

criterion_group!(benches, rdf);
criterion_main!(benches);
