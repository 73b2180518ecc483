//! Building, changing and searching the triangulation.

use std::hint::black_box;

use bn_core::{DVec2, PointSet, Seed, torus};
use bn_geometry::{EmptyCircles, Triangulation};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use rand::RngExt;

fn random_set(n: usize) -> PointSet {
    let mut rng = Seed::new(1).stream(0);
    PointSet::new((0..n).map(|_| random_point(&mut rng)).collect()).expect("valid points")
}

fn random_point(rng: &mut bn_core::StreamRng) -> DVec2 {
    DVec2::new(rng.random(), rng.random())
}

fn square_lattice(side: usize) -> PointSet {
    let at = |i: usize| i as f64 / side as f64;
    let points = (0..side * side).map(|i| DVec2::new(at(i % side), at(i / side)));
    PointSet::new(points.collect()).expect("valid points")
}

fn build(c: &mut Criterion) {
    let mut group = c.benchmark_group("build");
    for n in [4096, 65_536, 1_000_000] {
        let set = random_set(n);
        group.throughput(Throughput::Elements(n as u64));
        group.sample_size(if n > 100_000 { 10 } else { 50 });
        group.bench_with_input(BenchmarkId::new("random", n), &set, |b, set| {
            b.iter(|| Triangulation::new(black_box(set)));
        });
    }
    let lattice = square_lattice(64);
    group.throughput(Throughput::Elements(4096));
    group.bench_function("lattice/4096", |b| b.iter(|| Triangulation::new(black_box(&lattice))));
    group.finish();
}

/// One point leaves and comes back elsewhere.
fn moves(c: &mut Criterion) {
    let mut group = c.benchmark_group("move");
    group.throughput(Throughput::Elements(1));
    for n in [4096, 262_144] {
        let mut rng = Seed::new(2).stream(0);
        let mut triangulation = Triangulation::new(&random_set(n));
        group.bench_function(BenchmarkId::new("anywhere", n), |b| {
            b.iter(|| {
                let index = rng.random_range(0..n as u32) as usize;
                triangulation.remove(index);
                triangulation.insert(index, random_point(&mut rng));
            });
        });
        group.bench_function(BenchmarkId::new("and_back", n), |b| {
            b.iter(|| {
                let index = rng.random_range(0..n as u32) as usize;
                let p = triangulation.position(index);
                triangulation.remove(index);
                triangulation.insert_near(index, p, triangulation.changed_faces()[2]);
            });
        });
        let mut holes = EmptyCircles::new(&triangulation);
        group.bench_function(BenchmarkId::new("into_the_largest_hole", n), |b| {
            b.iter(|| {
                let index = rng.random_range(0..n as u32) as usize;
                triangulation.remove(index);
                holes.update(&triangulation);
                let face = holes.largest().expect("points are left");
                let center = torus::wrap_point(triangulation.circumcircle(face).center);
                triangulation.insert_near(index, center, face);
                holes.update(&triangulation);
            });
        });
    }
    group.finish();
}

fn locate(c: &mut Criterion) {
    let mut group = c.benchmark_group("locate");
    group.throughput(Throughput::Elements(1));
    for n in [4096, 262_144] {
        let mut rng = Seed::new(3).stream(0);
        let triangulation = Triangulation::new(&random_set(n));
        group.bench_function(BenchmarkId::from_parameter(n), |b| {
            b.iter(|| triangulation.locate(random_point(&mut rng)));
        });
    }
    group.finish();
}

criterion_group!(benches, build, moves, locate);
criterion_main!(benches);
