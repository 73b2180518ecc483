//! Periodograms, their rings and images: modes per second.

use std::hint::black_box;
use std::time::Duration;

use bn_core::{DVec2, PointSet, Seed};
use bn_spectral::{
    Autocorrelation, Periodogram, PeriodogramOptions, PowerImage, RadialPower, power_below,
};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use rand::RngExt as _;

fn random_set(n: usize) -> PointSet {
    let mut rng = Seed::new(1).stream(0);
    let points = (0..n).map(|_| DVec2::new(rng.random(), rng.random())).collect();
    PointSet::new(points).expect("in the unit square")
}

/// K = 5√n, ten times the Nyquist frequency of a square grid.
fn periodogram(c: &mut Criterion) {
    let mut group = c.benchmark_group("periodogram");
    group.sample_size(10).warm_up_time(Duration::from_millis(200));
    group.measurement_time(Duration::from_secs(1));
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    for n in [4096, 65_536, 1_000_000] {
        let sets = [random_set(n)];
        let k = 5 * (n as f64).sqrt() as usize;
        let options = PeriodogramOptions::new(k);
        group.throughput(Throughput::Elements(((2 * k + 1) * (2 * k + 1)) as u64));
        if n < 1_000_000 {
            group.bench_function(BenchmarkId::new("all_modes_1_thread", n), |b| {
                b.iter(|| one_thread.install(|| Periodogram::of(black_box(&sets), options)));
            });
            group.bench_function(BenchmarkId::new("rings_1_thread", n), |b| {
                b.iter(|| one_thread.install(|| RadialPower::of(black_box(&sets), options)));
            });
        }
        group.bench_function(BenchmarkId::new("rings", n), |b| {
            b.iter(|| RadialPower::of(black_box(&sets), options));
        });
    }
    let sets = [random_set(4096)];
    group.throughput(Throughput::Elements(4096));
    group.bench_function(BenchmarkId::new("image_321", 4096), |b| {
        b.iter(|| PowerImage::of(black_box(&sets), PeriodogramOptions::new(320), 321));
    });
    group.bench_function(BenchmarkId::new("power_below_half", 4096), |b| {
        b.iter(|| power_below(black_box(&sets[0]), 32.0));
    });
    group.finish();
}

fn autocorrelation(c: &mut Criterion) {
    let mut group = c.benchmark_group("autocorrelation");
    group.sample_size(10).warm_up_time(Duration::from_millis(200));
    group.measurement_time(Duration::from_secs(1));
    for n in [4096, 65_536] {
        let sets = [random_set(n)];
        let half_width = 10.0 / (n as f64).sqrt();
        // Ordered pairs in the window: n·4·10².
        group.throughput(Throughput::Elements(n as u64 * 400));
        group.bench_function(BenchmarkId::new("ten_spacings", n), |b| {
            b.iter(|| Autocorrelation::of(black_box(&sets), half_width, 200));
        });
    }
    group.finish();
}

criterion_group!(benches, periodogram, autocorrelation);
criterion_main!(benches);
