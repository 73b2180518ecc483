//! Light beyond what pixels can hold.

use crate::common::jittered_set;
use bn_core::{Seed, Unobserved};
use bn_render::{
    AdaptiveRenderer, Channels, Frame, ImageError, KernelTable, Normalization, Pattern,
    ProgressivePattern, RenderError, Renderer, Scene, kernel,
};

/// 0, and right of a column more than f32 can hold.
struct Blinding {
    from: f64,
}

impl Scene for Blinding {
    fn channels(&self) -> Channels {
        Channels::Grey
    }

    fn values(&self, u: &[f64], _: &[f64], out: &mut [f64]) {
        for (value, &u) in out.iter_mut().zip(u) {
            *value = if u > self.from { 1e39 } else { 0.0 };
        }
    }
}

/// No row with an infinity leaves the renderers, and the pixel at fault is named.
#[test]
fn pixels_beyond_f32_are_refused_however_they_are_taken() {
    let frame = Frame::new(300, 40).expect("a size");
    let set = jittered_set(16, 1);
    let table = KernelTable::new(kernel("box").expect("a kernel"));
    let at_column = |result: Result<(), RenderError>, from: u32| {
        assert!(
            matches!(result, Err(RenderError::Image(ImageError::NotFinite { x, y: 0 })) if x == from),
            "{result:?}"
        );
    };
    for from in [0_u32, 17, 200] {
        let scene = Blinding { from: f64::from(from) };
        let pattern = Pattern::tiled(&set, 4.0).expect("a rate");
        let renderer = Renderer::new(&scene, &pattern, &table, Normalization::Density, &frame);
        let mut rows = 0;
        let stream = renderer.stream(&Unobserved, |_| {
            rows += 1;
            Ok(())
        });
        at_column(stream.map(drop), from);
        assert_eq!(rows, 0);
        at_column(renderer.image().map(drop), from);
        let layers = ProgressivePattern::new(&set, 4.0, 4.0, Seed::new(1)).expect("rates");
        let adaptive =
            AdaptiveRenderer::new(&scene, &layers, &table, Normalization::Density, &frame, 0.1);
        at_column(adaptive.stream(&Unobserved, |_| Ok(())).map(drop), from);
    }
}
