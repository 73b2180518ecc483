//! Work that is asked to stop stops, however dense the samples are.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};

use bn_core::{Observer, Progress, Seed};
use bn_render::{
    AdaptiveRenderer, BandLimitedError, BandLimitedOptions, BandLimitedRenderer, Channels, Frame,
    KernelTable, LowPass, Normalization, Pattern, ProgressivePattern, RenderError, Renderer, Scene,
    exact_convolution, kernel, supersampling,
};

use crate::common::random_set;

/// Asks to stop when it is asked for the n-th time, and from then on.
struct StopsAt(u64, AtomicU64);

impl StopsAt {
    fn call(n: u64) -> Self {
        Self(n, AtomicU64::new(0))
    }
}

impl Observer for StopsAt {
    fn observe(&self, _: &Progress<'_>) -> ControlFlow<()> {
        let calls = self.1.fetch_add(1, Ordering::Relaxed) + 1;
        if calls < self.0 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }
}

/// Grey noise that counts how often it is looked at.
#[derive(Default)]
struct Counted(AtomicU64);

impl Counted {
    fn count(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }
}

impl Scene for Counted {
    fn channels(&self) -> Channels {
        Channels::Grey
    }
    fn values(&self, u: &[f64], v: &[f64], out: &mut [f64]) {
        self.0.fetch_add(u.len() as u64, Ordering::Relaxed);
        for ((out, u), v) in out.iter_mut().zip(u).zip(v) {
            *out = (1e4 * (u + 3.1 * v)).fract();
        }
    }
}

/// On two threads, each of which takes about a million samples before it asks.
fn on_two_threads(work: impl FnOnce() + Send) {
    rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("threads").install(work);
}

const A_FEW_MILLIONS: u64 = 5_000_000;

#[test]
fn dense_rendering_stops_within_a_band() {
    let frame = Frame::new(128, 128).expect("a size");
    // 67 million samples, 17 million in each of four bands.
    let pattern = Pattern::tiled(&random_set(4096, 1), 4096.0).expect("a rate");
    let (scene, table) = (Counted::default(), KernelTable::new(kernel("box").expect("a kernel")));
    on_two_threads(|| {
        let renderer = Renderer::new(&scene, &pattern, &table, Normalization::Density, &frame);
        let stopped = renderer.stream(&StopsAt::call(1), |_| Ok(()));
        assert!(matches!(stopped, Err(RenderError::Cancelled)));
    });
    assert!((1..A_FEW_MILLIONS).contains(&scene.count()), "{}", scene.count());
}

#[test]
fn adaptive_rendering_stops_within_a_group_of_tiles() {
    let frame = Frame::new(256, 256).expect("a size");
    for pilot in [64.0, 4096.0] {
        let pattern = ProgressivePattern::new(&random_set(1024, 1), pilot, 4096.0, Seed::new(1));
        let pattern = pattern.expect("rates");
        let (scene, table) =
            (Counted::default(), KernelTable::new(kernel("box").expect("a kernel")));
        on_two_threads(|| {
            let how = Normalization::Density;
            let renderer = AdaptiveRenderer::new(&scene, &pattern, &table, how, &frame, 1e-6);
            let stopped = renderer.stream(&StopsAt::call(1), |_| Ok(()));
            assert!(matches!(stopped, Err(RenderError::Cancelled)));
        });
        assert!((1..A_FEW_MILLIONS).contains(&scene.count()), "{}", scene.count());
    }
}

#[test]
fn supersampling_and_exact_convolution_stop_between_classes_of_samples() {
    let frame = Frame::new(40, 30).expect("a size");
    let pattern = supersampling("grid-4x4-box").expect("a standard pattern");
    for call in 1..=16 {
        let scene = Counted::default();
        let stopped = pattern.render(&scene, &frame, &StopsAt::call(call));
        assert!(matches!(stopped, Err(RenderError::Cancelled)));
        assert_eq!(scene.count(), (call - 1) * 40 * 30);
    }
    assert!(pattern.render(&Counted::default(), &frame, &StopsAt::call(17)).is_ok());
    let scene = Counted::default();
    let kernel = kernel("box").expect("a kernel");
    let stopped = exact_convolution(&scene, kernel, &frame, 0.0, &StopsAt::call(20));
    assert!(matches!(stopped, Err(RenderError::Cancelled)));
    // 16 of 4² nodes, then 3 of 8².
    assert_eq!(scene.count(), 19 * 40 * 30);
}

#[test]
fn band_limited_rendering_stops_while_it_samples() {
    let frame = Frame::new(256, 256).expect("a size");
    let pattern = Pattern::tiled(&random_set(4096, 1), 100.0).expect("a rate");
    let scene = Counted::default();
    on_two_threads(|| {
        let (low_pass, options) = (LowPass::Nyquist, BandLimitedOptions::default());
        let renderer =
            BandLimitedRenderer { scene: &scene, pattern: &pattern, low_pass, frame, options };
        let stopped = renderer.image(&StopsAt::call(1));
        assert!(matches!(stopped, Err(BandLimitedError::Cancelled)));
    });
    assert!((1..A_FEW_MILLIONS).contains(&scene.count()), "{}", scene.count());
}
