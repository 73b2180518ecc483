//! Bessel functions: time per value of the slice functions beside that of the scalar ones.

use std::hint::black_box;
use std::time::Duration;

use bn_core::Seed;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use rand::RngExt as _;

const VALUES: usize = 4096;

/// The three ranges of the implementation, and mixtures of them.
const RANGES: [(&str, f64, f64); 5] = [
    ("0..4", 0.0, 4.0),
    ("4..25", 4.0, 25.0),
    ("25..1000", 25.0, 1000.0),
    ("0..100", 0.0, 100.0),
    ("0..1e6", 0.0, 1e6),
];

fn bessel(c: &mut Criterion) {
    let mut group = c.benchmark_group("bessel");
    group.throughput(Throughput::Elements(VALUES as u64));
    group.warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(1));
    let mut rng = Seed::new(1).stream(0);
    let mut out = vec![0.0; VALUES];
    for (name, from, to) in RANGES {
        let x: Vec<f64> = (0..VALUES).map(|_| rng.random_range(from..to)).collect();
        for (function, f) in [
            ("j0_slice", bn_spectral::j0_slice as fn(&[f64], &mut [f64])),
            ("j1_slice", bn_spectral::j1_slice),
            ("jinc_slice", bn_spectral::jinc_slice),
        ] {
            group.bench_function(BenchmarkId::new(function, name), |b| {
                b.iter(|| f(black_box(&x), black_box(&mut out)));
            });
        }
        for (function, f) in
            [("libm_j0", bn_spectral::j0 as fn(f64) -> f64), ("libm_j1", bn_spectral::j1)]
        {
            group.bench_function(BenchmarkId::new(function, name), |b| {
                b.iter(|| {
                    for (out, &x) in out.iter_mut().zip(black_box(&x)) {
                        *out = f(x);
                    }
                    black_box(&mut out);
                });
            });
        }
    }
    group.finish();
}

criterion_group!(benches, bessel);
criterion_main!(benches);
