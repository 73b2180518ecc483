//! Samples per second of the renderer: on one thread and all, by kernel, by scene, and what skipping
//! saves (`cargo xtask bench --only skipping` has nested loops beside it).

mod common;
#[path = "../tests/render/common/silent.rs"]
mod silent;

use std::hint::black_box;

use bn_render::{
    Checkerboard, Frame, KERNELS, KernelTable, Normalization, Pattern, Renderer, SCENES, Scene,
    SceneOptions, Window, ZonePlate, kernel, scene,
};
use common::{frame, jittered};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use silent::Silent;

fn pattern(spp: f64) -> Pattern {
    Pattern::tiled(&jittered(64), spp).expect("a pattern")
}

fn table(name: &str) -> KernelTable {
    KernelTable::new(kernel(name).expect("a kernel"))
}

/// Renders and gives the rows away.
fn rendered(scene: &dyn Scene, pattern: &Pattern, table: &KernelTable, frame: &Frame) -> u64 {
    let renderer = Renderer::new(scene, pattern, table, Normalization::Density, frame);
    let stats = renderer.stream(&bn_core::Unobserved, |band| {
        black_box(band.values);
        Ok(())
    });
    stats.expect("nothing can fail").evaluated
}

fn threads_and_weights(c: &mut Criterion) {
    const SIZE: u32 = 256;
    let (frame, set) = (frame(SIZE, SIZE), jittered(64));
    let (plate, pattern, table) = (ZonePlate::new(&frame, 1.0), pattern(16.0), table("lanczos2"));
    let mut group = c.benchmark_group("zone-plate-256-16spp-lanczos2");
    group.throughput(Throughput::Elements(u64::from(SIZE * SIZE) * 16));
    group.sample_size(20);
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    group.bench_function("renderer-one-thread", |b| {
        one.install(|| b.iter(|| rendered(&plate, black_box(&pattern), &table, &frame)));
    });
    group.bench_function("renderer", |b| {
        b.iter(|| rendered(&plate, black_box(&pattern), &table, &frame));
    });
    group.bench_function("renderer-weighted", |b| {
        let weights: Vec<f64> = (0..set.len()).map(|i| 1.0 + (i % 3) as f64).collect();
        let weighted = Pattern::weighted(&set, &weights, 16.0).expect("weights");
        b.iter(|| rendered(&plate, black_box(&weighted), &table, &frame));
    });
    group.finish();
}

fn kernels(c: &mut Criterion) {
    let frame = frame(512, 512);
    let (plate, pattern) = (ZonePlate::new(&frame, 1.0), pattern(8.0));
    let mut group = c.benchmark_group("kernels");
    group.throughput(Throughput::Elements(512 * 512 * 8));
    group.sample_size(20);
    for kernel in KERNELS {
        let table = KernelTable::new(*kernel);
        group.bench_function(kernel.name(), |b| {
            b.iter(|| rendered(&plate, black_box(&pattern), &table, &frame));
        });
    }
    group.finish();
}

fn scenes(c: &mut Criterion) {
    let frame = frame(512, 512);
    let (pattern, table) = (pattern(4.0), table("lanczos2"));
    let mut group = c.benchmark_group("scenes");
    group.throughput(Throughput::Elements(512 * 512 * 4));
    group.sample_size(20);
    for entry in SCENES {
        let scene =
            scene(entry.name, &frame, &SceneOptions::default()).expect("defaults are valid");
        group.bench_function(entry.name, |b| {
            b.iter(|| rendered(&*scene, black_box(&pattern), &table, &frame));
        });
    }
    group.finish();
}

/// A board under a sky that takes half of the image, and a small window of a large image.
fn skipping(c: &mut Criterion) {
    let (pattern, table) = (pattern(8.0), table("lanczos2"));
    let mut group = c.benchmark_group("skipping");
    group.sample_size(20);
    let half = frame(1024, 1024);
    let board = Checkerboard::new(&half, 0.5, 12.0, 0.5);
    group.bench_function("half-constant", |b| {
        b.iter(|| rendered(&board, black_box(&pattern), &table, &half));
    });
    group.bench_function("half-constant-untold", |b| {
        b.iter(|| rendered(&Silent(&board), black_box(&pattern), &table, &half));
    });
    let large = frame(3840, 2160);
    let plate = ZonePlate::new(&large, 1.0);
    for side in [64, 256, 1024] {
        let window = Window { x: 1000, y: 700, width: side, height: side };
        let window = large.cropped(window).expect("inside");
        group.bench_with_input(BenchmarkId::new("window-of-4k", side), &window, |b, window| {
            b.iter(|| rendered(&plate, black_box(&pattern), &table, window));
        });
    }
    group.finish();
}

criterion_group!(benches, threads_and_weights, kernels, scenes, skipping);
criterion_main!(benches);
