//! Hankel transforms: planned on quadrature nodes, and between lattices as the windowed estimator
//! uses them, beside the plain sum with vectorised J₀.

use std::hint::black_box;
use std::time::Duration;

use bn_spectral::{BesselSums, HankelPlan, j0_slice};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

/// The estimator's lattice has Δr·Δν = 1/40000 for every n.
const ALPHA: f64 = 1.0 / 40_000.0;

fn coefficients(radii: usize) -> Vec<f64> {
    (0..radii).map(|i| (i * 7919 % 1013) as f64 / 1013.0 - 0.5).collect()
}

fn lattice(c: &mut Criterion) {
    let mut group = c.benchmark_group("hankel");
    group.sample_size(20).warm_up_time(Duration::from_millis(300));
    group.measurement_time(Duration::from_secs(1));
    for n in [1024_u32, 4096, 65_536] {
        let bins = 100 * f64::from(n).sqrt() as usize;
        let (radii, c) = (bins / 2, coefficients(bins / 2));
        group.throughput(Throughput::Elements((radii * bins) as u64));
        group.bench_function(BenchmarkId::new("lattice_plan", n), |b| {
            b.iter(|| BesselSums::new(black_box(radii), bins, ALPHA));
        });
        let plan = BesselSums::new(radii, bins, ALPHA);
        let (mut sums, mut scratch) = (vec![0.0; bins], plan.scratch());
        group.bench_function(BenchmarkId::new("lattice_apply", n), |b| {
            b.iter(|| plan.apply_into(black_box(&c), &mut sums, &mut scratch));
        });
    }
    let (radii, bins, c) = (3200, 6400, coefficients(3200));
    let (mut x, mut bessel) = (vec![0.0; radii], vec![0.0; radii]);
    group.throughput(Throughput::Elements((radii * bins) as u64));
    group.bench_function(BenchmarkId::new("plain_sum", 4096), |b| {
        b.iter(|| {
            let mut total = 0.0;
            for j in 0..bins {
                for (i, x) in x.iter_mut().enumerate() {
                    *x = std::f64::consts::TAU * ALPHA * (i * j) as f64;
                }
                j0_slice(&x, &mut bessel);
                total += bessel.iter().zip(&c).map(|(b, c)| b * c).sum::<f64>();
            }
            black_box(total)
        });
    });
    for count in [64, 1024] {
        let frequencies: Vec<f64> = (0..count).map(|j| j as f64 * 64.0 / count as f64).collect();
        let plan = HankelPlan::new(&[0.0, 4.0], 0.5, &frequencies);
        let f: Vec<f64> = plan.nodes().iter().map(|r| (-r * r).exp()).collect();
        let mut transform = vec![0.0; count];
        group.throughput(Throughput::Elements((f.len() * count) as u64));
        group.bench_function(BenchmarkId::new("nodes_apply", count), |b| {
            b.iter(|| plan.apply_into(black_box(&f), &mut transform));
        });
    }
    group.finish();
}

criterion_group!(benches, lattice);
criterion_main!(benches);
