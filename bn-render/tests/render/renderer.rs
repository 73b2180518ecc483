//! The renderer against nested loops, and what it promises to the bit.

use crate::common::{Silent, jittered_set, nested_loops, random_set};
use bn_core::{DVec2, PointSet, Seed};
use bn_render::{
    Channels, Checkerboard, Color, Constant, Frame, KERNELS, KernelTable, Normalization, Pattern,
    Rect, Renderer, Scene, SphereScene, TileVariation, Window, ZonePlate, kernel,
};
use proptest::prelude::*;

/// Three channels of different scenes.
struct Three(ZonePlate, SphereScene, Checkerboard);

impl Scene for Three {
    fn channels(&self) -> Channels {
        Channels::Rgb
    }
    fn values(&self, u: &[f64], v: &[f64], out: &mut [f64]) {
        let (a, rest) = out.split_at_mut(u.len());
        let (b, c) = rest.split_at_mut(u.len());
        self.0.values(u, v, a);
        self.1.values(u, v, b);
        self.2.values(u, v, c);
    }
}

fn frame(width: u32, height: u32) -> Frame {
    Frame::new(width, height).expect("a size")
}

fn table(name: &str) -> KernelTable {
    KernelTable::new(kernel(name).expect("a kernel"))
}

fn render(
    scene: &dyn Scene,
    pattern: &Pattern,
    table: &KernelTable,
    normalization: Normalization,
    frame: &Frame,
) -> (Vec<f32>, bn_render::RenderStats) {
    let renderer = Renderer::new(scene, pattern, table, normalization, frame);
    let (image, stats) = renderer.image().expect("small enough");
    (image.values().to_vec(), stats)
}

const BOTH: [Normalization; 2] = [Normalization::Density, Normalization::None];

#[test]
fn every_kernel_agrees_with_nested_loops() {
    let size = (45, 37);
    let frame = frame(size.0, size.1);
    let scene = ZonePlate::new(&frame, 0.8);
    for (set, spp) in
        [(jittered_set(10, 1), 3.7), (jittered_set(4, 2), 16.0), (random_set(1, 3), 1.3)]
    {
        let pattern = Pattern::tiled(&set, spp).expect("a pattern");
        for kernel in KERNELS {
            let table = KernelTable::new(*kernel);
            for normalization in BOTH {
                let (got, stats) = render(&scene, &pattern, &table, normalization, &frame);
                let want = nested_loops(&scene, &set, spp, *kernel, normalization, size, 0);
                let mut empty = 0;
                for (i, (got, want)) in got.iter().zip(&want).enumerate() {
                    empty += u64::from(want.is_nan());
                    // f32 output; sums that nearly cancel enlarge the table's error.
                    let ok =
                        want.is_nan() || (f64::from(*got) - want).abs() < 3e-7 * (1.0 + want.abs());
                    assert!(
                        ok,
                        "{} {normalization:?} {spp} pixel {i}: {got} against {want}",
                        kernel.name()
                    );
                }
                assert_eq!(stats.empty_pixels, empty);
                assert_eq!(stats.samples, stats.evaluated);
            }
        }
    }
}

#[test]
fn three_channels_are_three_images() {
    let size = (40, 41);
    let frame = frame(size.0, size.1);
    let scene = Three(
        ZonePlate::new(&frame, 0.8),
        SphereScene::new(&frame, 0.9),
        Checkerboard::new(&frame, 0.4, 5.0, 0.3),
    );
    let set = jittered_set(12, 5);
    let pattern = Pattern::tiled(&set, 5.0).expect("a pattern");
    let (got, _) = render(&scene, &pattern, &table("mitchell"), Normalization::Density, &frame);
    let parts: [&dyn Scene; 3] = [&scene.0, &scene.1, &scene.2];
    for (channel, part) in parts.into_iter().enumerate() {
        let (want, _) = render(part, &pattern, &table("mitchell"), Normalization::Density, &frame);
        let channel: Vec<f32> = got.iter().copied().skip(channel).step_by(3).collect();
        assert_eq!(channel, want);
    }
}

#[test]
fn constants_are_exact() {
    let frame = frame(70, 50);
    // Stochastic sets at low rates have pixels whose weights nearly cancel.
    for (set, spp) in
        [(random_set(300, 1), 0.9), (random_set(50, 2), 4.0), (jittered_set(8, 3), 2.3)]
    {
        let pattern = Pattern::tiled(&set, spp).expect("a pattern");
        for kernel in KERNELS {
            for level in [0.1, 1.0 / 3.0, 0.999_999_94, 12_345.678] {
                let scene = Constant::grey(level);
                let table = KernelTable::new(*kernel);
                let told = render(&scene, &pattern, &table, Normalization::Density, &frame);
                let silent =
                    render(&Silent(&scene), &pattern, &table, Normalization::Density, &frame);
                assert!(told.0.iter().all(|&v| v == level as f32), "{} {level}", kernel.name());
                assert_eq!(told.0, silent.0);
                assert_eq!((told.1.evaluated, told.1.skipped()), (0, told.1.samples));
                assert_eq!(silent.1.evaluated, silent.1.samples);
            }
        }
    }
}

#[test]
fn plain_convolution_of_a_constant_shows_the_density() {
    // With the exact integral, the mean over the whole plane is the constant itself.
    let (set, spp) = (random_set(64, 4), 4.0);
    let pattern = Pattern::tiled(&set, spp).expect("a pattern");
    assert_eq!(pattern.side(), 4.0);
    for kernel in KERNELS {
        let table = KernelTable::new(*kernel);
        let (values, _) =
            render(&Constant::grey(0.5), &pattern, &table, Normalization::None, &frame(4, 4));
        // Over one period pixels sum Σ_i r(i − x) for each sample, not ∫r: equal for kernels that
        // are a partition of unity, and within the ripple of the others.
        let mean = values.iter().map(|&v| f64::from(v)).sum::<f64>() / 16.0;
        let ripple = match kernel.name() {
            "box" | "tent" | "mitchell" | "bicubic" => 1e-7,
            _ => 2e-3,
        };
        assert!((mean - 0.5).abs() < ripple, "{}: {mean}", kernel.name());
    }
}

#[test]
fn threads_do_not_change_a_bit() {
    let frame = frame(150, 130);
    let scene = SphereScene::new(&frame, 1.0);
    let pattern = Pattern::tiled(&random_set(777, 6), 6.0).expect("a pattern");
    let table = table("lanczos3");
    let with_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| render(&scene, &pattern, &table, Normalization::Density, &frame))
    };
    let one = with_threads(1);
    for threads in [2, 3, 7] {
        assert!(with_threads(threads) == one, "{threads} threads");
    }
}

fn crop(whole: &[f32], frame: &Frame, window: Window) -> Vec<f32> {
    let row = |y: u32| {
        let start = (y * frame.width() + window.x) as usize;
        whole[start..start + window.width as usize].to_vec()
    };
    (window.y..window.y + window.height).flat_map(row).collect()
}

#[test]
fn a_window_is_cut_from_the_whole_image_bit_for_bit() {
    let frame = frame(140, 100);
    let scene = Checkerboard::new(&frame, 0.3, 7.0, 0.5);
    for (spp, variation) in [
        (5.3, TileVariation::Repeated),
        (0.7, TileVariation::TurnedAndShifted(Seed::new(3))),
        (40.0, TileVariation::Repeated),
    ] {
        let pattern =
            Pattern::tiled(&random_set(500, 7), spp).expect("a pattern").varied(variation);
        for name in ["box", "lanczos2", "sinc"] {
            for normalization in BOTH {
                let table = table(name);
                let (whole, all) = render(&scene, &pattern, &table, normalization, &frame);
                for (x, y, width, height) in [
                    (0, 0, 1, 1),
                    (31, 31, 2, 2),
                    (63, 20, 34, 77),
                    (139, 99, 1, 1),
                    (5, 90, 130, 10),
                ] {
                    let window = Window { x, y, width, height };
                    let cropped = frame.cropped(window).expect("inside");
                    let (part, stats) = render(&scene, &pattern, &table, normalization, &cropped);
                    assert!(
                        part == crop(&whole, &frame, window),
                        "{name} {normalization:?} {window:?}"
                    );
                    assert!(stats.samples < all.samples);
                }
            }
        }
    }
}

#[test]
fn skipping_constants_changes_nothing() {
    let frame = frame(200, 160);
    let scene = Checkerboard::new(&frame, 0.5, 3.0, 0.3);
    let pattern = Pattern::tiled(&random_set(2000, 8), 7.0).expect("a pattern");
    for name in ["box", "gaussian", "lanczos2", "lanczos4"] {
        for normalization in BOTH {
            let table = table(name);
            let (told, stats) = render(&scene, &pattern, &table, normalization, &frame);
            let (silent, all) = render(&Silent(&scene), &pattern, &table, normalization, &frame);
            assert!(told == silent, "{name} {normalization:?}");
            assert!(stats.evaluated * 3 < all.evaluated * 2, "{stats:?}");
            assert_eq!((stats.samples, all.evaluated), (all.samples, all.samples));
        }
    }
}

#[test]
fn cost_of_a_window_follows_the_window() {
    let whole = frame(4096, 2160);
    let pattern = Pattern::tiled(&random_set(1024, 9), 4.0).expect("a pattern");
    let scene = ZonePlate::new(&whole, 1.0);
    let window = Window { x: 1000, y: 700, width: 64, height: 64 };
    let cropped = whole.cropped(window).expect("inside");
    let (_, stats) = render(&scene, &pattern, &table("lanczos2"), Normalization::Density, &cropped);
    // 67 × 67 cells of 4 samples in the mean; the count of 4096 points varies little.
    let expected = 67.0 * 67.0 * 4.0;
    assert!((stats.samples as f64 / expected - 1.0).abs() < 0.03, "{stats:?}");
    assert_eq!(stats.evaluated, stats.samples);
}

#[test]
fn a_band_limited_image_survives_sampling_on_a_grid() {
    // A plane wave below the Nyquist frequency of pixels, 4 × 4 samples a pixel: what is lost is
    // the kernel's own response at that frequency, known from its values at the samples.
    let size = 48;
    let frame = frame(size, size);
    let wave = bn_render::PlaneWave {
        amplitude: 0.5,
        frequency: DVec2::new(0.11, 0.05),
        phase_turns: 0.2,
    };
    let scene = bn_render::PlaneWaves::new(0.5, vec![wave]);
    let grid: Vec<DVec2> = (0..16)
        .map(|i| DVec2::new((f64::from(i % 4) + 0.5) / 4.0, (f64::from(i / 4) + 0.5) / 4.0))
        .collect();
    let pattern = Pattern::tiled(&PointSet::new(grid).expect("a set"), 16.0).expect("a pattern");
    for kernel in KERNELS {
        let (values, _) =
            render(&scene, &pattern, &KernelTable::new(*kernel), Normalization::Density, &frame);
        // The gain along an axis: Σ r(x) cos 2πfx / Σ r(x) over the samples' places.
        let gain = |f: f64| {
            let places = (-40..40).map(|i| (f64::from(i) + 0.5) / 4.0);
            let (mut sum, mut total) = (0.0, 0.0);
            for x in places {
                sum += kernel.value(x) * libm::cos(std::f64::consts::TAU * f * x);
                total += kernel.value(x);
            }
            sum / total
        };
        let gain = gain(0.11) * gain(0.05);
        for (i, &got) in values.iter().enumerate() {
            let centre =
                DVec2::new(f64::from(i as u32 % size) + 0.5, f64::from(i as u32 / size) + 0.5);
            let want = 0.5 + gain * (scene.value(centre)[0] - 0.5);
            assert!(
                (f64::from(got) - want).abs() < 1e-7,
                "{} pixel {i}: {got} against {want}",
                kernel.name()
            );
        }
        // The long kernels hardly touch frequencies well below Nyquist.
        if matches!(kernel.name(), "lanczos3" | "lanczos4" | "sinc") {
            assert!((gain - 1.0).abs() < 0.02, "{}: gain {gain}", kernel.name());
        }
    }
}

#[test]
fn pixels_without_samples_take_their_blocks_value() {
    let frame = frame(8, 8);
    let set = PointSet::new(vec![DVec2::new(0.5, 0.5)]).expect("a set");
    // One sample for each 8 × 8 pixels, at (4, 4).
    let pattern = Pattern::tiled(&set, 1.0 / 64.0).expect("a pattern");
    let scene = ZonePlate::new(&frame, 0.3);
    let (values, stats) = render(&scene, &pattern, &table("box"), Normalization::Density, &frame);
    assert_eq!((stats.samples, stats.empty_pixels), (1, 63));
    assert!(values.iter().all(|&v| v == 1.0), "the block's centre is the plate's");
    let (plain, stats) = render(&scene, &pattern, &table("box"), Normalization::None, &frame);
    assert_eq!((plain[4 * 8 + 4], plain[0], stats.empty_pixels), (64.0, 0.0, 63));
    // A constant needs no sample to be exact where weights divide.
    for (normalization, empty) in [(Normalization::Density, 0), (Normalization::None, 63)] {
        let (_, stats) =
            render(&Constant::grey(0.3), &pattern, &table("box"), normalization, &frame);
        assert_eq!((stats.samples, stats.empty_pixels), (1, empty), "{normalization:?}");
    }
}

#[test]
fn rows_come_in_order_and_cancelling_stops() {
    use std::ops::ControlFlow;
    struct Stop;
    impl bn_core::Observer for Stop {
        fn observe(&self, _: &bn_core::Progress<'_>) -> ControlFlow<()> {
            ControlFlow::Break(())
        }
    }
    let frame = frame(30, 400);
    let pattern = Pattern::tiled(&random_set(64, 2), 2.0).expect("a pattern");
    let (scene, table) = (Constant::rgb([0.1, 0.5, 0.9]), table("tent"));
    let renderer = Renderer::new(&scene, &pattern, &table, Normalization::Density, &frame);
    let mut next = 0;
    let taken = renderer.stream(&bn_core::Unobserved, |band| {
        assert_eq!(band.first_row, next);
        next += (band.values.len() / 90) as u32;
        Ok(())
    });
    assert!(taken.is_ok() && next == 400);
    let stopped = renderer.stream(&Stop, |_| Ok(()));
    assert!(matches!(stopped, Err(bn_render::RenderError::Cancelled)));
    let failed = renderer.stream(&bn_core::Unobserved, |_| Err(std::io::Error::other("full")));
    assert!(matches!(failed, Err(bn_render::RenderError::Output(_))));
}

/// A scene that promises what it must not: to see that promises are used.
struct Half;

impl Scene for Half {
    fn channels(&self) -> Channels {
        Channels::Grey
    }
    fn values(&self, u: &[f64], _: &[f64], out: &mut [f64]) {
        for (value, u) in out.iter_mut().zip(u) {
            *value = if *u < 64.0 { 0.7 } else { 0.5 + 0.5 * libm::sin(*u) };
        }
    }
    fn constant_over(&self, rect: &Rect) -> Option<Color> {
        (rect.max.x < 64.0).then_some([0.7, 0.0, 0.0])
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn random_settings_agree_with_nested_loops(
        n in 1_usize..90, seed in 0_u64..1000, spp in 0.3_f64..20.0, which in 0_usize..9,
        width in 1_u32..75, height in 1_u32..40, plain in any::<bool>(),
    ) {
        let frame = frame(width, height);
        let set = random_set(n, seed);
        let pattern = Pattern::tiled(&set, spp).expect("a pattern");
        let kernel = KERNELS[which];
        let normalization = if plain { Normalization::None } else { Normalization::Density };
        let table = KernelTable::new(kernel);
        let (got, stats) = render(&Half, &pattern, &table, normalization, &frame);
        let (silent, _) = render(&Silent(&Half), &pattern, &table, normalization, &frame);
        prop_assert!(got == silent);
        prop_assert!(stats.evaluated <= stats.samples);
        let want = nested_loops(&Half, &set, spp, kernel, normalization, (width, height), 0);
        for (i, (&got, want)) in got.iter().zip(want).enumerate() {
            // Where weights cancel to a part in 10⁵, rounding is enlarged as much.
            let ok = want.is_nan() || (f64::from(got) - want).abs() < 1e-5 * (1.0 + want.abs().powi(2));
            prop_assert!(ok, "pixel {}: {} against {}", i, got, want);
        }
    }

    #[test]
    fn the_mean_of_a_wide_window_is_the_integral(
        seed in 0_u64..1000, fx in -0.4_f64..0.4, fy in -0.4_f64..0.4, phase in 0.0_f64..1.0,
    ) {
        // Energy: plain convolution over whole tiles is Monte Carlo integration of the scene.
        let frame = frame(32, 32);
        let wave = bn_render::PlaneWave { amplitude: 0.3, frequency: DVec2::new(fx, fy), phase_turns: phase };
        let scene = bn_render::PlaneWaves::new(0.5, vec![wave]);
        let set = jittered_set(64, seed);
        let pattern = Pattern::tiled(&set, 4.0).expect("a pattern");
        let (values, _) = render(&scene, &pattern, &table("box"), Normalization::None, &frame);
        let got = values.iter().map(|&v| f64::from(v)).sum::<f64>() / 1024.0;
        // ∫∫ over [0, 32]² of the wave, in closed form.
        // cos(a + b) integrates to Re e^{iφ} Π (e^{2πi·32f} − 1)/(2πi·32f), each factor a modulus
        // sin(x)/x and a phase x, x = 32πf.
        let turn = std::f64::consts::TAU;
        let modulus = |f: f64| {
            let x = turn * f * 16.0;
            if x.abs() < 1e-9 { 1.0 } else { libm::sin(x) / x }
        };
        let want = 0.5 + 0.3 * modulus(fx) * modulus(fy) * libm::cos(turn * (phase + 16.0 * (fx + fy)));
        // One jittered sample for each quarter of a pixel's area: variance below
        // (0.3·2π|f|/2)²/12·2/4096, so the standard error is below 0.003.
        prop_assert!((got - want).abs() < 0.012, "{} against {}", got, want);
    }
}
