//! The NUFFT: points and modes per second on one thread and on all, and where direct sums end.

use std::hint::black_box;
use std::time::Duration;

use bn_core::{DVec2, Seed};
use bn_spectral::{Complex, HalfPlane, Nufft, NufftOptions, Real, direct_modes};
use criterion::measurement::WallTime;
use criterion::{
    BenchmarkGroup, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main,
};
use rand::RngExt as _;

fn random_points(n: usize) -> Vec<DVec2> {
    let mut rng = Seed::new(1).stream(0);
    (0..n).map(|_| DVec2::new(rng.random(), rng.random())).collect()
}

/// One n, K and tolerance: `name` says which, throughput is in modes of the half plane.
fn types<T: Real>(
    group: &mut BenchmarkGroup<'_, WallTime>,
    n: usize,
    options: NufftOptions,
    id: &str,
) {
    let points = random_points(n);
    let mut plan: Nufft<T> = options.expecting(n).plan().expect("a plan");
    let k = plan.max_frequency();
    let mut modes = HalfPlane::<T>::zeros(k);
    let (mut real, mut complex) = (vec![0.0; n], vec![Complex::new(0.0, 0.0); n]);
    group.throughput(Throughput::Elements(modes.values().len() as u64));
    group.bench_function(BenchmarkId::new("type1", id), |b| {
        b.iter(|| plan.points_to_modes(black_box(&points), None, &mut modes));
    });
    group.bench_function(BenchmarkId::new("type2", id), |b| {
        b.iter(|| plan.modes_to_points(&modes, black_box(&points), &mut real));
    });
    group.bench_function(BenchmarkId::new("type2_complex", id), |b| {
        b.iter(|| {
            plan.columns_to_complex_points(black_box(&points), &mut complex, |kx, column| {
                column.copy_from_slice(modes.column(kx.unsigned_abs() as usize));
            });
        });
    });
}

fn nufft(c: &mut Criterion) {
    let mut group = c.benchmark_group("nufft");
    group.sample_size(10).warm_up_time(Duration::from_millis(200));
    group.measurement_time(Duration::from_secs(1));
    for (n, k) in [(4096, 320), (65_536, 1280)] {
        for tolerance in [1e-3, 1e-6, 1e-12] {
            let options = NufftOptions::new(k, tolerance).sequential();
            types::<f64>(&mut group, n, options, &format!("{n}_K{k}_{tolerance:e}_1_thread"));
        }
        let options = NufftOptions::new(k, 1e-6);
        types::<f64>(&mut group, n, options, &format!("{n}_K{k}_1e-6"));
    }
    // What spectral matching evaluates: K = 2√n, then 6√n, in single precision.
    for k in [128, 384] {
        let options = NufftOptions::new(k, 1e-4).sequential();
        types::<f32>(&mut group, 4096, options, &format!("4096_K{k}_1e-4_f32_1_thread"));
    }
    group.bench_function("plan_K320_1e-6", |b| {
        b.iter(|| NufftOptions::new(black_box(320), 1e-6).plan::<f64>().expect("a plan"));
    });
    group.finish();
}

/// Direct sums and the transform on ever more points: they should meet near `Nufft::crossover`.
fn crossover(c: &mut Criterion) {
    let mut group = c.benchmark_group("nufft_crossover");
    group.sample_size(10).warm_up_time(Duration::from_millis(100));
    group.measurement_time(Duration::from_millis(500));
    for k in [32, 320] {
        let mut plan: Nufft =
            NufftOptions::new(k, 1e-6).expecting(64).sequential().plan().expect("a plan");
        println!("K = {k}: direct up to {} points", plan.crossover());
        let mut modes = HalfPlane::zeros(k);
        for n in [16, 32, 64, 128] {
            let points = random_points(n);
            group.throughput(Throughput::Elements((n * modes.values().len()) as u64));
            group.bench_function(BenchmarkId::new(format!("direct_K{k}"), n), |b| {
                b.iter(|| direct_modes(black_box(&points), None, k));
            });
        }
        let points = random_points(plan.crossover() + 1);
        group.throughput(Throughput::Elements((points.len() * modes.values().len()) as u64));
        group.bench_function(BenchmarkId::new(format!("fast_K{k}"), points.len()), |b| {
            b.iter(|| plan.points_to_modes(black_box(&points), None, &mut modes));
        });
    }
    group.finish();
}

criterion_group!(benches, nufft, crossover);
criterion_main!(benches);
