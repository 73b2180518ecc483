//! Periodic supersampling against its equations.

use bn_core::{DVec2, Unobserved};
use bn_render::{
    Constant, Frame, PlaneWave, PlaneWaves, SUPERSAMPLING, Scene, StripedCloth, Supersampling,
    SupersamplingError, Tap, Window, supersampling,
};

fn pattern(name: &str) -> Supersampling {
    supersampling(name).expect("a standard pattern")
}

#[test]
fn samples_and_weights_are_as_stated() {
    let stated = [
        ("none", 1, 1),
        ("lanczos2", 16, 289),
        ("quincunx", 2, 5),
        ("grid-2x2", 4, 4),
        ("rotated-grid", 4, 4),
        ("grid-4x4-box", 16, 16),
        ("grid-4x4-lanczos2", 16, 16),
    ];
    assert_eq!(SUPERSAMPLING.len(), stated.len());
    for (name, n, m) in stated {
        let pattern = pattern(name);
        assert!(SUPERSAMPLING.contains(&name));
        assert_eq!((pattern.samples_per_pixel(), pattern.weights_per_pixel()), (n, m), "{name}");
        let sum: f64 = pattern.taps().iter().map(|tap| tap.weight).sum();
        assert!((sum - 1.0).abs() < 1e-14 && (pattern.transfer(DVec2::ZERO) - 1.0).abs() < 1e-14);
        let mirrored: f64 = pattern.impulse_response().map(|tap| tap.weight * tap.offset.x).sum();
        assert!(mirrored.abs() < 1e-14, "{name} is centred");
    }
    assert!(supersampling("none such").is_none());
}

#[test]
fn transfer_functions_have_their_closed_forms() {
    let turn = std::f64::consts::TAU;
    for i in 0..400 {
        let f = DVec2::new(f64::from(i % 20) * 0.21 - 2.0, f64::from(i / 20) * 0.19 - 1.9);
        let want = (libm::cos(turn * f.x / 4.0) * libm::cos(turn * f.y / 4.0)).abs();
        assert!((pattern("grid-2x2").transfer(f) - want).abs() < 1e-14);
        let want = 0.5 + 0.5 * libm::cos(turn * f.x / 2.0) * libm::cos(turn * f.y / 2.0);
        assert!((pattern("quincunx").transfer(f) - want.abs()).abs() < 1e-14);
        // Four samples a quarter apart: sin(πf)/(4 sin(πf/4)) along each axis.
        let comb = |f: f64| {
            let x = turn * f / 2.0;
            if libm::sin(x / 4.0).abs() < 1e-9 {
                1.0
            } else {
                libm::sin(x) / (4.0 * libm::sin(x / 4.0))
            }
        };
        let want = (comb(f.x) * comb(f.y)).abs();
        assert!((pattern("grid-4x4-box").transfer(f) - want).abs() < 1e-13);
    }
}

#[test]
fn a_wave_is_damped_by_the_transfer_function() {
    let frame = Frame::new(20, 12).expect("a size");
    for name in SUPERSAMPLING {
        let pattern = pattern(name);
        for frequency in [DVec2::new(0.13, 0.31), DVec2::new(0.9, -0.4), DVec2::new(1.5, 1.1)] {
            let wave = PlaneWave { amplitude: 0.5, frequency, phase_turns: 0.1 };
            let scene = PlaneWaves::new(0.5, vec![wave]);
            let (image, _) = pattern.render(&scene, &frame, &Unobserved).expect("small");
            // Symmetric patterns have a real transform, of either sign.
            let gain: f64 = pattern
                .taps()
                .iter()
                .map(|tap| {
                    tap.weight * libm::cos(std::f64::consts::TAU * frequency.dot(tap.offset))
                })
                .sum();
            assert!((gain.abs() - pattern.transfer(frequency)).abs() < 1e-13, "{name}");
            for j in 0..12 {
                for i in 0..20 {
                    let centre = DVec2::new(f64::from(i) + 0.5, f64::from(j) + 0.5);
                    let want = 0.5 + gain * (scene.value(centre)[0] - 0.5);
                    let got = f64::from(image.pixel(i, j)[0]);
                    assert!((got - want).abs() < 1e-7, "{name} {frequency}: {got} {want}");
                }
            }
        }
    }
}

#[test]
fn images_follow_the_definition_and_share_samples() {
    let frame = Frame::new(64, 48).expect("a size");
    let scene = StripedCloth::new(&frame);
    for name in SUPERSAMPLING {
        let pattern = pattern(name);
        let (image, taken) = pattern.render(&scene, &frame, &Unobserved).expect("small");
        for (i, j) in [(0, 0), (63, 47), (20, 31), (40, 2)] {
            let centre = DVec2::new(f64::from(i) + 0.5, f64::from(j) + 0.5);
            let want: f64 = pattern
                .taps()
                .iter()
                .map(|tap| tap.weight * scene.value(centre + tap.offset)[0])
                .sum();
            assert!((f64::from(image.pixel(i, j)[0]) - want).abs() < 1e-7, "{name} ({i}, {j})");
        }
        let n = pattern.samples_per_pixel() as u64;
        // A margin of at most 4 pixels in all on either axis.
        assert!(taken >= n * 64 * 48 && taken <= n * 68 * 52, "{name}: {taken}");
        let window = Window { x: 10, y: 7, width: 9, height: 5 };
        let cropped = frame.cropped(window).expect("inside");
        let (part, fewer) = pattern.render(&scene, &cropped, &Unobserved).expect("small");
        assert_eq!(part.pixel(3, 4), image.pixel(13, 11));
        assert!(fewer <= n * 13 * 9);
    }
}

#[test]
fn three_channels_are_kept_apart() {
    let frame = Frame::new(5, 4).expect("a size");
    let scene = Constant::rgb([0.25, 0.5, 1.0]);
    let (image, _) = pattern("lanczos2").render(&scene, &frame, &Unobserved).expect("small");
    for pixel in image.values().chunks_exact(3) {
        assert_eq!(pixel, [0.25, 0.5, 1.0]);
    }
}

#[test]
fn the_transfer_image_spans_four_times_nyquist() {
    let image = pattern("grid-2x2").transfer_image(9).expect("small");
    assert_eq!(image.pixel(4, 4), [1.0]);
    // At 2 cycles a pixel, along the border's middle, the quarter offsets give cos π = −1.
    assert!((image.pixel(8, 4)[0] - 1.0).abs() < 1e-6 && image.pixel(6, 4)[0] < 1e-6);
}

#[test]
fn samples_of_no_weight_are_not_taken() {
    let frame = Frame::new(8, 8).expect("a size");
    let tap = |x: f64, y: f64, weight: f64| Tap { offset: DVec2::new(x, y), weight };
    let taps = vec![tap(0.0, 0.0, 1.0), tap(0.3, 0.3, 0.0), tap(7.0, 0.0, 0.0)];
    let pattern = Supersampling::new("mine", taps).expect("a pattern");
    assert_eq!((pattern.samples_per_pixel(), pattern.weights_per_pixel()), (1, 3));
    let (_, taken) = pattern.render(&Constant::grey(0.5), &frame, &Unobserved).expect("small");
    assert_eq!(taken, 64);
}

#[test]
fn as_many_taps_as_are_allowed_are_grouped() {
    let side = 256;
    assert_eq!(side * side, Supersampling::MAX_TAPS);
    let place = |i: usize| i as f64 / 128.0 - 0.5;
    let taps = (0..side * side)
        .map(|i| Tap { offset: DVec2::new(place(i % side), place(i / side)), weight: 1.0 });
    let pattern = Supersampling::new("dense", taps.collect()).expect("a pattern");
    // Over 2 × 2 pixels, four weights share each sample.
    assert_eq!(pattern.samples_per_pixel(), side * side / 4);
}

#[test]
fn files_are_read_and_checked() {
    let read = |text: &str| Supersampling::parse("mine", text);
    let pattern = read("# two samples\n 0.25 0 3\n\n-0.25 0 # weight 1\n").expect("a pattern");
    assert_eq!(pattern.taps()[0], Tap { offset: DVec2::new(0.25, 0.0), weight: 0.75 });
    assert_eq!(pattern.taps()[1].weight, 0.25);
    assert!(matches!(read(""), Err(SupersamplingError::Count { count: 0 })));
    assert!(matches!(read("0 0\n1 2 x\n"), Err(SupersamplingError::Line { line: 2, .. })));
    assert!(matches!(read("1 2 3 4"), Err(SupersamplingError::Line { line: 1, .. })));
    assert!(matches!(read("0 nan"), Err(SupersamplingError::Line { line: 1, .. })));
    assert!(matches!(read("0 0\n\n0 1e9"), Err(SupersamplingError::Line { line: 3, .. })));
    assert!(matches!(read("0 0 inf"), Err(SupersamplingError::Line { line: 1, .. })));
    for (x, y, weight) in [(f64::NAN, 0.0, 1.0), (0.0, -65.0, 1.0), (0.0, 0.0, f64::INFINITY)] {
        let taps = vec![
            Tap { offset: DVec2::ZERO, weight: 1.0 },
            Tap { offset: DVec2::new(x, y), weight },
        ];
        let refused = Supersampling::new("mine", taps);
        assert!(matches!(refused, Err(SupersamplingError::Tap { index: 1 })));
    }
    assert!(matches!(read("0 0 1\n0.5 0 -1"), Err(SupersamplingError::Weights { .. })));
}

/// A tap at the other end of what is allowed doesn't draw in all samples between: two a pixel, and the
/// same pixels for any window.
#[test]
fn far_taps_take_their_own_samples() {
    let tap = |x: f64, y: f64| Tap { offset: DVec2::new(x, y), weight: 1.0 };
    let pattern = Supersampling::new("far", vec![tap(0.0, 0.0), tap(64.0, -64.0)]).expect("two");
    let frame = Frame::new(40, 30).expect("a size");
    let scene = waves(&frame);
    let (whole, taken) = pattern.render(&*scene, &frame, &Unobserved).expect("small");
    assert_eq!(taken, 2 * 40 * 30);
    for (x, y) in [(0_u32, 0_u32), (17, 21), (39, 29)] {
        let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let taps = pattern.taps().iter().map(|tap| scene.value(centre + tap.offset)[0]);
        let want = 0.5 * taps.sum::<f64>();
        let got = f64::from(whole.values()[(y * 40 + x) as usize]);
        assert!((got - want).abs() < 1e-7, "({x}, {y}): {got} {want}");
        let window = Window { x, y, width: 1, height: 1 };
        let one = frame.cropped(window).expect("within");
        let (pixel, taken) = pattern.render(&*scene, &one, &Unobserved).expect("small");
        assert_eq!(taken, 2);
        assert_eq!(pixel.values()[0], whole.values()[(y * 40 + x) as usize]);
    }
}

fn waves(frame: &Frame) -> Box<dyn Scene> {
    bn_render::scene("zone-plate", frame, &bn_render::SceneOptions::default()).expect("a scene")
}
