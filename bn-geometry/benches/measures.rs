//! What is measured on a point set: spacing, and coverage, order and cells of its triangulation.

use std::hint::black_box;

use bn_core::{DVec2, PointSet, Seed};
use bn_geometry::{
    Coverage, EmptyCircles, PowerDiagram, Spacing, Triangulation, bond_orientational_order,
    voronoi_cells_into,
};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use rand::RngExt;

fn random_set(n: usize) -> PointSet {
    let mut rng = Seed::new(1).stream(0);
    let points = (0..n).map(|_| DVec2::new(rng.random(), rng.random()));
    PointSet::new(points.collect()).expect("valid points")
}

fn spacing(c: &mut Criterion) {
    let mut group = c.benchmark_group("spacing");
    for n in [4096, 65_536, 1_000_000] {
        let set = random_set(n);
        group.throughput(Throughput::Elements(n as u64));
        group.sample_size(if n > 100_000 { 10 } else { 50 });
        group.bench_with_input(BenchmarkId::from_parameter(n), &set, |b, set| {
            b.iter(|| Spacing::new(black_box(set)));
        });
    }
    group.finish();
}

fn triangulated(c: &mut Criterion) {
    let mut group = c.benchmark_group("triangulated");
    for n in [4096, 65_536] {
        let triangulation = Triangulation::new(&random_set(n));
        group.throughput(Throughput::Elements(n as u64));
        group.bench_function(BenchmarkId::new("coverage", n), |b| {
            b.iter(|| Coverage::of(black_box(&triangulation)));
        });
        group.bench_function(BenchmarkId::new("order_6", n), |b| {
            b.iter(|| bond_orientational_order(black_box(&triangulation), 6));
        });
        let mut cells = Vec::new();
        group.bench_function(BenchmarkId::new("voronoi_cells", n), |b| {
            b.iter(|| voronoi_cells_into(black_box(&triangulation), &mut cells));
        });
        group.bench_function(BenchmarkId::new("empty_circles", n), |b| {
            b.iter(|| EmptyCircles::new(black_box(&triangulation)));
        });
    }
    group.finish();
}

/// All that `bn analyze` wants of one set: spacing, coverage radius and Q6.
fn everything(c: &mut Criterion) {
    let set = random_set(4096);
    let mut group = c.benchmark_group("everything");
    group.throughput(Throughput::Elements(4096));
    group.bench_function("4096", |b| {
        b.iter(|| {
            let triangulation = Triangulation::new(black_box(&set));
            let order = bond_orientational_order(&triangulation, 6);
            (Spacing::new(&set).mean(), Coverage::of(&triangulation), order)
        });
    });
    group.finish();
}

/// Voronoi cells cut one by one: of random points (widely varying cells) and of a jittered lattice.
fn power_diagram(c: &mut Criterion) {
    let mut group = c.benchmark_group("power_diagram");
    for side in [64, 256] {
        let n = side * side;
        let mut rng = Seed::new(2).stream(0);
        let jittered = (0..n).map(|i| {
            let cell = DVec2::new((i % side) as f64, (i / side) as f64);
            (cell + DVec2::new(rng.random(), rng.random())) / side as f64
        });
        let jittered = PointSet::new(jittered.collect()).expect("valid points");
        group.throughput(Throughput::Elements(n as u64));
        for (name, set) in [("random", random_set(n)), ("jittered", jittered)] {
            let weights = vec![0.0; n];
            group.bench_function(BenchmarkId::new(format!("{name}/new"), n), |b| {
                b.iter(|| PowerDiagram::new(black_box(&set), &weights));
            });
            let mut diagram = PowerDiagram::new(&set, &weights);
            group.bench_function(BenchmarkId::new(format!("{name}/update"), n), |b| {
                b.iter(|| diagram.update(black_box(&set), &weights));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, spacing, triangulated, everything, power_diagram);
criterion_main!(benches);
