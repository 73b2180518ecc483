//! Images from band-limited reconstruction.

use crate::common::{cell_areas, jittered_set, random_set};
use bn_core::{DVec2, PointSet, Unobserved};
use bn_render::{
    BandLimitedError, BandLimitedMethod, BandLimitedOptions, BandLimitedRenderer, BandLimitedStats,
    Border, Channels, Constant, Frame, Image, LowPass, Pattern, PlaneWave, PlaneWaves, Scene,
    SphereScene, Stopping, Window, exact_convolution, kernel, mean_square_error,
    peak_signal_to_noise,
};

fn frame(width: u32, height: u32) -> Frame {
    Frame::new(width, height).expect("a size")
}

/// Waves of these frequencies in cycles per pixel.
fn waves(frequencies: &[(f64, f64)]) -> PlaneWaves {
    let count = frequencies.len() as f64;
    let wave = |(i, &(x, y)): (usize, &(f64, f64))| PlaneWave {
        amplitude: 0.5 / count,
        frequency: DVec2::new(x, y),
        phase_turns: 0.37 * i as f64,
    };
    PlaneWaves::new(0.5, frequencies.iter().enumerate().map(wave).collect())
}

fn weighted(set: &PointSet, rate: f64) -> Pattern {
    Pattern::weighted(set, &cell_areas(set, 512), rate).expect("weights")
}

fn render(
    scene: &dyn Scene,
    pattern: &Pattern,
    low_pass: LowPass<'_>,
    frame: Frame,
    options: BandLimitedOptions,
) -> (Image, BandLimitedStats) {
    let renderer = BandLimitedRenderer { scene, pattern, low_pass, frame, options };
    renderer.image(&Unobserved).expect("small enough")
}

/// The scene at the pixels' centres.
fn ideal(scene: &dyn Scene, frame: Frame) -> Image {
    let (width, height) = (frame.width(), frame.height());
    let at = |i: u32| {
        let centre = DVec2::new(f64::from(i % width) + 0.5, f64::from(i / width) + 0.5);
        scene.value(centre)[0] as f32
    };
    Image::new(width, height, Channels::Grey, (0..width * height).map(at).collect())
        .expect("finite")
}

fn psnr(a: &Image, b: &Image) -> f64 {
    peak_signal_to_noise(mean_square_error(a, b).expect("the same shape"))
}

#[test]
fn band_limited_images_are_found_from_jittered_samples() {
    // Periodic over the image, up to 31/64 cycles per pixel.
    let frame = frame(64, 64);
    let scene = waves(&[(31.0 / 64.0, 30.0 / 64.0), (-0.25, 0.125), (3.0 / 64.0, 0.0)]);
    let pattern = weighted(&jittered_set(128, 1), 4.0);
    let options = BandLimitedOptions { border: Border::Periodic, ..Default::default() };
    let (image, stats) = render(&scene, &pattern, LowPass::Nyquist, frame, options);
    let reached = psnr(&image, &ideal(&scene, frame));
    assert!(
        reached >= 100.0 && stats.iterations() <= 30 && stats.converged(),
        "{reached} {stats:?}"
    );
    assert_eq!((stats.samples, stats.evaluated, stats.band), (16_384, 16_384, 0.5));
    let kernel = kernel("lanczos2").expect("a kernel");
    let (image, _) = render(&scene, &pattern, LowPass::Kernel(kernel), frame, options);
    let exact = exact_convolution(&scene, kernel, &frame, 1e-9, &Unobserved).expect("small").image;
    assert!(psnr(&image, &exact) >= 100.0);
    let slow = BandLimitedOptions { method: BandLimitedMethod::Pocs, ..options };
    let (image, stats) = render(&scene, &pattern, LowPass::Nyquist, frame, slow);
    assert!(psnr(&image, &ideal(&scene, frame)) >= 45.0, "{stats:?}");
}

/// Where the image's border cuts tiles apart, samples are as irregular as anywhere.
#[test]
fn tiles_need_not_divide_a_periodic_image() {
    let frame = frame(64, 64);
    let scene = waves(&[(31.0 / 64.0, 30.0 / 64.0), (-0.25, 0.125), (3.0 / 64.0, 0.0)]);
    for (m, side) in [(100, 50.0), (46, 23.0)] {
        let pattern = weighted(&jittered_set(m, 1), 4.0);
        assert_eq!(pattern.side(), side);
        let options = BandLimitedOptions { border: Border::Periodic, ..Default::default() };
        let (image, stats) = render(&scene, &pattern, LowPass::Nyquist, frame, options);
        let reached = psnr(&image, &ideal(&scene, frame));
        assert!(reached >= 100.0 && stats.converged(), "{reached} {stats:?}");
    }
}

#[test]
fn images_that_do_not_repeat_are_found_too() {
    let frame = frame(90, 61);
    let scene = waves(&[(0.2371, 0.1), (-0.05, 0.2917), (0.0113, 0.007)]);
    let pattern = weighted(&jittered_set(96, 2), 4.0);
    for (low_pass, want) in [
        (LowPass::Nyquist, ideal(&scene, frame)),
        (LowPass::Kernel(kernel("mitchell").expect("a kernel")), {
            let kernel = kernel("mitchell").expect("a kernel");
            exact_convolution(&scene, kernel, &frame, 1e-9, &Unobserved).expect("small").image
        }),
    ] {
        let (image, stats) =
            render(&scene, &pattern, low_pass, frame, BandLimitedOptions::default());
        let reached = psnr(&image, &want);
        assert!(reached >= 80.0 && stats.iterations() <= 30, "{low_pass:?} {reached} {stats:?}");
    }
}

/// Whatever lies within the pixels' own band, by default: up to 0.48 cycles per pixel along both axes,
/// with four samples a pixel of patterns that leave no large gaps.
#[test]
fn images_of_the_pixels_own_band_are_found_from_four_samples_a_pixel() {
    let frame = frame(96, 70);
    let kernel = kernel("lanczos2").expect("a kernel");
    for frequencies in [[(0.47, 0.47), (0.3, -0.46)], [(0.48, 0.0), (0.0113, 0.007)]] {
        let scene = waves(&frequencies);
        let exact = exact_convolution(&scene, kernel, &frame, 1e-9, &Unobserved).expect("small");
        let pattern = weighted(&jittered_set(64, 5), 4.0);
        let options = BandLimitedOptions::default();
        let (image, stats) = render(&scene, &pattern, LowPass::Kernel(kernel), frame, options);
        let reached = psnr(&image, &exact.image);
        assert!(reached >= 90.0 && stats.converged(), "{frequencies:?}: {reached} {stats:?}");
        assert!(stats.iterations() <= 30);
    }
}

#[test]
fn windows_threads_and_channels_change_no_bit() {
    let whole = frame(70, 55);
    let scene = Constant::rgb([0.1, 1.0 / 3.0, 0.9]);
    let pattern = weighted(&random_set(500, 3), 3.0);
    let low_pass = LowPass::Kernel(kernel("lanczos3").expect("a kernel"));
    let (image, stats) = render(&scene, &pattern, low_pass, whole, BandLimitedOptions::default());
    let color = [0.1_f64, 1.0 / 3.0, 0.9].map(|c| c as f32);
    assert!(image.values().chunks_exact(3).all(|pixel| pixel == color));
    assert_eq!((stats.evaluated, stats.iterations(), stats.convergence.len()), (0, 0, 3));

    let sphere = SphereScene::new(&whole, 1.0);
    let of = |frame, method| {
        let stopping = Stopping { iterations: 12, tolerance: 1e-6 };
        let options = BandLimitedOptions { method, stopping, ..Default::default() };
        render(&sphere, &pattern, low_pass, frame, options).0
    };
    for method in [BandLimitedMethod::Act, BandLimitedMethod::Pocs] {
        let with_threads = |threads: usize| {
            let pool =
                rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            pool.install(|| of(whole, method))
        };
        let image = with_threads(1);
        assert!(image == with_threads(2) && image == with_threads(5), "{method:?}");
        let window = Window { x: 20, y: 31, width: 33, height: 11 };
        let part = of(whole.cropped(window).expect("inside"), method);
        for (y, x) in (0..11).flat_map(|y| (0..33).map(move |x| (y, x))) {
            assert_eq!(part.pixel(x, y), image.pixel(x + 20, y + 31));
        }
    }
}

#[test]
fn hard_cases_end_with_numbers_and_are_told_of() {
    let frame = frame(40, 30);
    let scene = SphereScene::new(&frame, 1.0);
    let one = PointSet::new(vec![DVec2::new(0.3, 0.4)]).expect("a set");
    for (set, rate, band) in [
        (one.clone(), 1.0 / 64.0, None),
        (one, 1.0, Some(0.5)),
        (random_set(64, 1), 0.5, Some(0.5)),
        (random_set(64, 1), 0.05, None),
        (jittered_set(20, 2), 40.0, None),
    ] {
        for method in [BandLimitedMethod::Act, BandLimitedMethod::Pocs] {
            let options = BandLimitedOptions { method, band, ..Default::default() };
            let pattern = Pattern::tiled(&set, rate).expect("a rate");
            let (image, stats) = render(&scene, &pattern, LowPass::Nyquist, frame, options);
            // The scene's values lie in [0, 1]; polynomials overshoot most in the gaps of few samples.
            let over = if rate == 0.5 { 1.0 } else { 0.25 };
            let range = -over..=1.0 + over;
            assert!(image.values().iter().all(|v| range.contains(v)), "{rate} {band:?}");
            let few = stats.convergence.iter().any(bn_render::Convergence::is_underdetermined);
            assert_eq!(few, rate == 0.5, "{stats:?}");
        }
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let scene = Constant::grey(0.5);
    let pattern = Pattern::tiled(&random_set(64, 1), 4.0).expect("a rate");
    let try_with = |frame, band| {
        let options = BandLimitedOptions { band, ..Default::default() };
        let low_pass = LowPass::Nyquist;
        BandLimitedRenderer { scene: &scene, pattern: &pattern, low_pass, frame, options }
            .image(&Unobserved)
    };
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = try_with(frame(8, 8), Some(bad));
        assert!(matches!(refused, Err(BandLimitedError::Band { .. })), "{bad}");
    }
    let large = try_with(frame(8, 8), Some(1e7));
    assert!(matches!(large, Err(BandLimitedError::TooLarge { .. })));
    let large = try_with(frame(16_384, 16_384), None);
    assert!(matches!(large, Err(BandLimitedError::TooLarge { .. })));
    let sparse =
        Pattern::tiled(&PointSet::new(vec![DVec2::splat(0.5)]).expect("a set"), 1.0 / 65_536.0)
            .expect("a rate");
    let low_pass = LowPass::Nyquist;
    let options = BandLimitedOptions::default();
    let frame = frame(8, 8);
    let renderer =
        BandLimitedRenderer { scene: &scene, pattern: &sparse, low_pass, frame, options };
    assert!(matches!(renderer.image(&Unobserved), Err(BandLimitedError::NoSamples)));
}

#[test]
fn usual_bands_leave_enough_samples() {
    let fade = |rate| BandLimitedOptions::usual_band(Border::Fade, rate);
    let periodic = |rate| BandLimitedOptions::usual_band(Border::Periodic, rate);
    for (rate, want) in [(4.0, 0.5), (2.0, 0.5), (16.0, 1.0), (0.5, 0.25)] {
        assert!((periodic(rate) - want).abs() < 1e-12, "{rate}");
    }
    for (rate, want) in [(4.0, 7.0 / 12.0), (2.0, 0.5), (16.0, 1.0), (0.5, 0.25)] {
        assert!((fade(rate) - want).abs() < 1e-12, "{rate}");
    }
    for rate in (1..200).map(|i| f64::from(i) / 7.0) {
        for band in [fade(rate), periodic(rate)] {
            let samples = rate / (2.0 * band).powi(2);
            assert!((2.0 - 1e-12..=4.0 + 1e-12).contains(&samples), "{rate}: {samples}");
        }
    }
}
