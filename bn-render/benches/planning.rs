//! Adaptive sampling against uniform sampling of the same error, and what predictions cost.

mod common;
#[path = "../tests/render/common/silent.rs"]
mod silent;

use std::hint::black_box;

use bn_core::{DVec2, Seed, Unobserved};
use bn_render::{
    AdaptiveRenderer, Channels, Checkerboard, Image, ImageSpectrum, KernelTable, Normalization,
    Pattern, PatternPower, PlaneWave, PlaneWaves, Prediction, ProgressivePattern, Renderer, Scene,
    SphereScene, kernel,
};
use common::{frame, jittered};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use silent::Silent;

fn adaptive(c: &mut Criterion) {
    let frame = frame(512, 512);
    let table = KernelTable::new(kernel("lanczos2").expect("a kernel"));
    let set = jittered(64);
    let progressive = ProgressivePattern::new(&set, 4.0, 1024.0, Seed::new(1)).expect("rates");
    let board = Checkerboard::new(&frame, 0.5, 12.0, 0.5);
    let sphere = SphereScene::new(&frame, 1.0);
    let scenes: [(&str, &dyn Scene); 2] = [("half-constant", &board), ("sphere", &sphere)];
    for (name, scene) in scenes {
        // What is known of constants would help both.
        let scene = &Silent(scene);
        let mut group = c.benchmark_group(format!("adaptive-{name}"));
        group.sample_size(10);
        let how = Normalization::Density;
        let renderer = AdaptiveRenderer::new(scene, &progressive, &table, how, &frame, 0.02);
        let samples = renderer.image().expect("small").1.samples;
        group.throughput(Throughput::Elements(samples));
        group.bench_function("adaptive", |b| {
            b.iter(|| {
                let stats = renderer.stream(&Unobserved, |band| {
                    black_box(band.values);
                    Ok(())
                });
                stats.expect("nothing can fail").samples
            });
        });
        // As many samples, evenly.
        let pattern = Pattern::tiled(&set, samples as f64 / (512.0 * 512.0)).expect("a rate");
        let uniform = Renderer::new(scene, &pattern, &table, how, &frame);
        group.bench_function("uniform", |b| {
            b.iter(|| {
                let stats = uniform.stream(&Unobserved, |band| {
                    black_box(band.values);
                    Ok(())
                });
                stats.expect("nothing can fail").samples
            });
        });
        group.finish();
    }
}

fn prediction(c: &mut Criterion) {
    let sets = [jittered(64)];
    let lanczos = kernel("lanczos2").expect("a kernel");
    let mut group = c.benchmark_group("prediction");
    group.sample_size(20);
    group.bench_function("spectrum-256", |b| {
        b.iter(|| PatternPower::of(black_box(&sets), 256).expect("small"));
    });
    let power = PatternPower::of(&sets, 256).expect("small");
    let prediction = Prediction::new(&power, 4.0).expect("a rate");
    let frequency = DVec2::new(0.3, 0.2);
    let wave = PlaneWave { amplitude: 0.5, frequency, phase_turns: 0.0 };
    let wave = ImageSpectrum::of_waves(&PlaneWaves::new(0.5, vec![wave]));
    group.bench_function("noise-of-a-wave", |b| {
        b.iter(|| prediction.noise(black_box(&wave), lanczos));
    });
    for side in [32, 128] {
        let frame = frame(side, side);
        let values = (0..side * side).map(|i| ((i * 7919) % 1009) as f32 / 1009.0).collect();
        let image = Image::new(side, side, Channels::Grey, values).expect("an image");
        let spectrum = ImageSpectrum::of_image(&image, &frame);
        group.throughput(Throughput::Elements(u64::from(side * side)));
        group.bench_with_input(BenchmarkId::new("noise-of-an-image", side), &spectrum, |b, s| {
            b.iter(|| prediction.noise(black_box(s), lanczos));
        });
    }
    group.finish();
}

criterion_group!(benches, adaptive, prediction);
criterion_main!(benches);
