//! Patterns whose samples weigh differently.

use crate::common::{cell_areas, jittered_set, random_set};
use bn_core::{CellGrid, DVec2, PointSet};
use bn_render::{
    Constant, Frame, KernelTable, Normalization, Pattern, PatternError, Renderer, Scene,
    SphereScene, Window, ZonePlate, kernel,
};

fn frame(width: u32, height: u32) -> Frame {
    Frame::new(width, height).expect("a size")
}

fn render(
    scene: &dyn Scene,
    pattern: &Pattern,
    name: &str,
    normalization: Normalization,
    frame: &Frame,
) -> Vec<f32> {
    let table = KernelTable::new(kernel(name).expect("a kernel"));
    let renderer = Renderer::new(scene, pattern, &table, normalization, frame);
    renderer.image().expect("small enough").0.values().to_vec()
}

const BOTH: [Normalization; 2] = [Normalization::Density, Normalization::None];

#[test]
fn a_sample_counts_as_often_as_it_weighs() {
    // The oracle: every point as many times as it weighs, at the rate that keeps the tile's side.
    let set = jittered_set(9, 4);
    let count = |i: usize| [1, 2, 0, 3, 1][i % 5];
    let repeated: Vec<DVec2> = (set.points().iter().enumerate())
        .flat_map(|(i, p)| std::iter::repeat_n(*p, count(i)))
        .collect();
    let rate = 3.3 * repeated.len() as f64 / set.len() as f64;
    let repeated = Pattern::tiled(&PointSet::new(repeated).expect("a set"), rate).expect("a rate");
    // The unit doesn't matter.
    let weights: Vec<f64> = (0..set.len()).map(|i| 0.01 * count(i) as f64).collect();
    let weighted = Pattern::weighted(&set, &weights, 3.3).expect("weights");
    assert!((weighted.side() - repeated.side()).abs() < 1e-12 && weighted.is_weighted());
    let frame = frame(60, 45);
    let scene = ZonePlate::new(&frame, 0.7);
    for name in ["box", "tent", "lanczos2", "sinc"] {
        for normalization in BOTH {
            let got = render(&scene, &weighted, name, normalization, &frame);
            let want = render(&scene, &repeated, name, normalization, &frame);
            for (i, (got, want)) in got.iter().zip(&want).enumerate() {
                // f32, and weights that nearly cancel.
                let close = (got - want).abs() < 2e-6 * (1.0 + want * want);
                assert!(close, "{name} {normalization:?} pixel {i}: {got} against {want}");
            }
        }
    }
}

#[test]
fn equal_weights_change_no_bit() {
    let set = random_set(300, 5);
    let frame = frame(70, 66);
    let scene = SphereScene::new(&frame, 1.0);
    let plain = Pattern::tiled(&set, 5.0).expect("a rate");
    let weighted = Pattern::weighted(&set, &[0.125; 300], 5.0).expect("weights");
    for normalization in BOTH {
        let got = render(&scene, &weighted, "lanczos2", normalization, &frame);
        assert!(got == render(&scene, &plain, "lanczos2", normalization, &frame));
    }
}

#[test]
fn threads_windows_and_skipping_change_no_bit() {
    let set = random_set(700, 6);
    let pattern = Pattern::weighted(&set, &cell_areas(&set, 256), 6.0).expect("weights");
    let frame = frame(150, 130);
    let scene = SphereScene::new(&frame, 1.0);
    let window = Window { x: 37, y: 60, width: 50, height: 41 };
    let cropped = frame.cropped(window).expect("inside");
    for normalization in BOTH {
        let with_threads = |threads: usize| {
            let pool =
                rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            pool.install(|| render(&scene, &pattern, "lanczos3", normalization, &frame))
        };
        let whole = with_threads(1);
        assert!(whole == with_threads(3));
        let part = render(&scene, &pattern, "lanczos3", normalization, &cropped);
        for (y, row) in part.chunks_exact(50).enumerate() {
            let start = (y + 60) * 150 + 37;
            assert!(row == &whole[start..start + 50], "row {y}");
        }
    }
    let constant = Constant::grey(0.3);
    let values = render(&constant, &pattern, "lanczos3", Normalization::Density, &frame);
    assert!(values.iter().all(|&v| v == 0.3));
}

/// Mean square deviation from 1 of plain convolution of the constant 1.
fn unevenness(pattern: &Pattern) -> f64 {
    let frame = frame(64, 64);
    let values = render(&Constant::grey(1.0), pattern, "gaussian", Normalization::None, &frame);
    values.iter().map(|&v| (f64::from(v) - 1.0).powi(2)).sum::<f64>() / values.len() as f64
}

#[test]
fn areas_as_weights_even_out_the_density() {
    for set in [random_set(1024, 7), jittered_set(32, 8)] {
        let plain = unevenness(&Pattern::tiled(&set, 4.0).expect("a rate"));
        let areas = cell_areas(&set, 512);
        let weighted = unevenness(&Pattern::weighted(&set, &areas, 4.0).expect("weights"));
        // Sums over cells are integrals by one node each: measured 7 times less and more.
        assert!(weighted < plain / 5.0, "{weighted} against {plain}");
    }
}

#[test]
fn cells_are_found_by_brute_force() {
    let set = jittered_set(4, 1);
    let areas = cell_areas(&set, 64);
    assert!((areas.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    assert_eq!(CellGrid::new(&set).nearest(set.points()[3], None).map(|(i, _)| i), Some(3));
}

#[test]
fn what_is_no_weight_is_refused() {
    let set = random_set(3, 1);
    let of = |weights: &[f64]| Pattern::weighted(&set, weights, 4.0);
    assert!(matches!(of(&[1.0; 2]), Err(PatternError::WeightCount { weights: 2, points: 3 })));
    assert!(matches!(of(&[1.0, -1.0, 1.0]), Err(PatternError::Weight { index: 1, .. })));
    assert!(matches!(of(&[1.0, 1.0, f64::NAN]), Err(PatternError::Weight { index: 2, .. })));
    assert!(matches!(of(&[0.0; 3]), Err(PatternError::WeightSum { .. })));
    assert!(matches!(of(&[f64::MAX; 3]), Err(PatternError::WeightSum { .. })));
    assert!(of(&[0.0, 0.0, 1e-300]).is_ok());
}
