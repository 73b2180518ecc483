//! The neighbour grid: building it, nearest neighbours of all points, and disks.

use std::hint::black_box;

use bn_core::{CellGrid, DVec2, PointSet, Seed};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use rand::RngExt;

fn uniform(n: usize) -> PointSet {
    let mut rng = Seed::new(1).stream(0);
    PointSet::new((0..n).map(|_| DVec2::new(rng.random(), rng.random())).collect())
        .expect("drawn from [0, 1)²")
}

/// Half of the points in a thousandth of the area.
fn clustered(n: usize) -> PointSet {
    let points = uniform(n).into_points().into_iter().enumerate();
    PointSet::new(points.map(|(i, p)| if i % 2 == 0 { p } else { 0.03 * p }).collect())
        .expect("shrunk into [0, 1)²")
}

fn nearest_of_all(grid: &CellGrid) -> f64 {
    let all = grid.all();
    let distances = all.points.iter().zip(all.indices);
    distances.filter_map(|(&p, &i)| grid.nearest(p, Some(i))).map(|(_, d)| d).sum()
}

fn benches(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("cell_grid");
    group.sample_size(10);
    for n in [4096, 100_000, 1_000_000] {
        group.throughput(Throughput::Elements(n as u64));
        let set = uniform(n);
        group.bench_function(BenchmarkId::new("build", n), |b| {
            b.iter(|| CellGrid::new(black_box(&set)));
        });
        let grid = CellGrid::new(&set);
        group.bench_function(BenchmarkId::new("nearest_of_all", n), |b| {
            b.iter(|| nearest_of_all(black_box(&grid)));
        });
        let radius = set.density().hexagonal_spacing() * 2.0;
        group.bench_function(BenchmarkId::new("within_2_d_hex_of_all", n), |b| {
            b.iter(|| {
                let mut count = 0_u64;
                for &p in grid.all().points {
                    grid.for_each_within(p, radius, |_, _| count += 1);
                }
                count
            });
        });
        let crowded = CellGrid::new(&clustered(n));
        group.bench_function(BenchmarkId::new("nearest_of_all_clustered", n), |b| {
            b.iter(|| nearest_of_all(black_box(&crowded)));
        });
    }
    group.finish();
}

criterion_group!(all, benches);
criterion_main!(all);
