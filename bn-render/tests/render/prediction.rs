//! Predicted noise against the renderer's own, and against closed forms.

use crate::common::{jittered_set, random_set};
use bn_core::{DVec2, PointSet, Seed};
use bn_render::{
    Frame, Image, ImageSpectrum, KernelTable, KernelTransfer, Normalization, Pattern, PatternError,
    PatternPower, PlaneWave, PlaneWaves, Prediction, Renderer, Scene, kernel,
};
use bn_spectral::JitteredGrid;
use proptest::prelude::*;
use rand::RngExt;

fn waves(mean: f64, list: &[(f64, f64, f64)]) -> PlaneWaves {
    let wave =
        |&(amplitude, x, y)| PlaneWave { amplitude, frequency: DVec2::new(x, y), phase_turns: 0.3 };
    PlaneWaves::new(mean, list.iter().map(wave).collect())
}

/// The plain convolution of a scene sampled at `rate`.
fn plain(scene: &dyn Scene, set: &PointSet, rate: f64, name: &str, frame: &Frame) -> Image {
    let pattern = Pattern::tiled(set, rate).expect("a rate");
    let table = KernelTable::new(kernel(name).expect("a kernel"));
    let renderer = Renderer::new(scene, &pattern, &table, Normalization::None, frame);
    renderer.image().expect("small").0
}

/// The mean square error of plain convolution over many shifts of the pattern on the torus: what a
/// prediction means, computed the long way.
fn noise_over_shifts(scene: &PlaneWaves, set: &PointSet, rate: f64, name: &str) -> f64 {
    const SHIFTS: u32 = 100;
    let frame = Frame::new(11, 9).expect("a size");
    let transfer = KernelTransfer::new(kernel(name).expect("a kernel"), 2.0);
    let exact = |at: DVec2| {
        let wave = |w: &PlaneWave| {
            let one = PlaneWaves::new(0.0, vec![*w]);
            transfer.response(w.frequency) * one.value(at)[0]
        };
        scene.mean() + scene.waves().iter().map(wave).sum::<f64>()
    };
    let mut sum = 0.0;
    let mut rng = Seed::new(11).stream(0);
    for _ in 0..SHIFTS {
        let shifted = set.translated(DVec2::new(rng.random(), rng.random()));
        let image = plain(scene, &shifted, rate, name, &frame);
        for y in 0..9 {
            for x in 0..11 {
                let at = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                sum += (f64::from(image.pixel(x, y)[0]) - exact(at)).powi(2);
            }
        }
    }
    sum / f64::from(SHIFTS * 99)
}

#[test]
fn noise_is_the_mean_over_all_shifts() {
    // Tiles of 2.4 to 8 pixels: smaller than some kernels, so that what wraps around counts too.
    for (set, rate) in
        [(jittered_set(8, 1), 1.0), (random_set(50, 2), 9.0), (jittered_set(5, 3), 4.0)]
    {
        let power = PatternPower::of(std::slice::from_ref(&set), 100).expect("small");
        let prediction = Prediction::new(&power, rate).expect("a rate");
        for name in ["box", "lanczos2", "gaussian"] {
            let kernel = kernel(name).expect("a kernel");
            for scene in [
                waves(0.5, &[]),
                waves(0.0, &[(0.4, 0.31, -0.12)]),
                waves(0.2, &[(0.3, 0.9, 0.4), (0.2, -0.17, 0.6)]),
            ] {
                let predicted = prediction.noise(&ImageSpectrum::of_waves(&scene), kernel);
                let found = noise_over_shifts(&scene, &set, rate, name);
                // 100 shifts, a tile or more in each image: a standard error of up to 6 %.
                let ratio = predicted / found;
                assert!((ratio - 1.0).abs() < 0.25, "{name}, {rate}: {predicted:e} {found:e}");
            }
        }
    }
}

#[test]
fn independent_points_make_white_noise() {
    let power = PatternPower::from_fn(400, 60, |_| 1.0);
    let image = ImageSpectrum::of_waves(&waves(0.5, &[(0.3, 0.2, 0.1)]));
    let lanczos = kernel("lanczos2").expect("a kernel");
    let prediction = Prediction::new(&power, 4.0).expect("a rate");
    // ε = power/s everywhere (section 3.2.2).
    for at in [DVec2::ZERO, DVec2::new(0.2, 0.1), DVec2::new(3.0, -2.0)] {
        let epsilon = prediction.error_spectrum(&image, at);
        assert!((epsilon - image.total_power() / 4.0).abs() < 1e-12, "{epsilon}");
    }
    // ∫|R|² = (∫r²/(∫r)²)² by the midpoint rule, less what the tile's own mode 0 has.
    let squares: f64 = (0..4000)
        .map(|i| lanczos.value((f64::from(i) + 0.5) / 1000.0 - 2.0).powi(2) / 1000.0)
        .sum();
    let energy = (squares / lanczos.integral().powi(2)).powi(2);
    let transfer = KernelTransfer::new(lanczos, 1.0);
    let own: f64 = image.lines().iter().map(|l| l.power * transfer.power(l.frequency)).sum();
    let want = image.total_power() * energy / 4.0 - own / 400.0;
    let got = prediction.noise(&image, lanczos);
    assert!((got - want).abs() < 1e-6 * want, "{got} {want}");
}

/// Eq. 3.16, 3.19 with the closed form of jittered grids.
#[test]
fn error_spectra_of_constants_and_waves_are_copies_of_the_patterns() {
    let grid = JitteredGrid::new(20);
    let power = PatternPower::from_fn(400, 120, |k| grid.power(k.x, k.y));
    let prediction = Prediction::new(&power, 4.0).expect("a rate");
    assert_eq!(prediction.side(), 10.0);
    let p = |nu: DVec2| grid.power(10.0 * nu.x, 10.0 * nu.y);
    let f = DVec2::new(0.3, -0.4);
    for at in [DVec2::new(0.1, 0.2), DVec2::new(-1.3, 0.7), DVec2::new(2.0, 0.0)] {
        let constant = prediction.error_spectrum(&ImageSpectrum::of_constant(0.6), at);
        assert!((constant - 0.36 / 4.0 * p(at)).abs() < 1e-12);
        let wave = ImageSpectrum::of_waves(&waves(0.0, &[(0.6, f.x, f.y)]));
        let got = prediction.error_spectrum(&wave, at);
        let want = 0.36 / 16.0 * (p(at - f) + p(at + f));
        assert!((got - want).abs() < 1e-12, "{got} {want}");
    }
}

/// All frequencies of a lattice below its Nyquist frequency pass a kernel without error, but for what
/// the kernel lets through: the copies at ν ± 1/T.
#[test]
fn lattices_alias_at_their_copies() {
    let points = (0..256).map(|i| DVec2::new(f64::from(i % 16), f64::from(i / 16)) / 16.0);
    let set = PointSet::new(points.collect()).expect("a set");
    let power = PatternPower::of(&[set], 40).expect("small");
    let prediction = Prediction::new(&power, 4.0).expect("a rate");
    let (lanczos, f) = (kernel("lanczos4").expect("a kernel"), DVec2::new(1.7, 0.2));
    let transfer = KernelTransfer::new(lanczos, 10.0);
    let image = ImageSpectrum::of_waves(&waves(0.0, &[(1.0, f.x, f.y)]));
    // Copies at multiples of 2 cycles per pixel, up to ±4.
    let steps = || (-2..=2).map(|i| 2.0 * f64::from(i));
    let shifts = steps().flat_map(|y| steps().map(move |x| DVec2::new(x, y)));
    let copies = shifts.filter(|k| *k != DVec2::ZERO).map(|k| transfer.power(f + k));
    let want: f64 = copies.sum::<f64>() / 2.0;
    let got = prediction.noise(&image, lanczos);
    // Nearly all of it at (−0.3, 0.2): half the wave's power.
    assert!(want > 0.4 * 0.9 && (got / want - 1.0).abs() < 1e-2, "{got} {want}");
}

#[test]
fn an_images_noise_is_that_of_its_lines() {
    let frame = Frame::new(24, 18).expect("a size");
    let scene = waves(0.4, &[(0.2, 5.0 / 24.0, -3.0 / 18.0), (0.1, 2.0 / 24.0, 7.0 / 18.0)]);
    let at = |i: u32| scene.value(DVec2::new(f64::from(i % 24) + 0.5, f64::from(i / 24) + 0.5));
    let values = (0..24 * 18).map(|i| at(i)[0] as f32).collect();
    let image = Image::new(24, 18, scene.channels(), values).expect("fits");
    let power = PatternPower::of(&[jittered_set(12, 4)], 50).expect("small");
    let prediction = Prediction::new(&power, 2.0).expect("a rate");
    let mitchell = kernel("mitchell").expect("a kernel");
    let of_image = ImageSpectrum::of_image(&image, &frame);
    let got = prediction.noise(&of_image, mitchell);
    let want = prediction.noise(&ImageSpectrum::of_waves(&scene), mitchell);
    assert!((got / want - 1.0).abs() < 1e-5, "{got} {want}");
}

#[test]
fn bad_rates_are_refused() {
    let power = PatternPower::from_fn(1, 0, |_| 1.0);
    for rate in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e9] {
        let refused = Prediction::new(&power, rate);
        assert!(matches!(refused, Err(PatternError::SamplesPerPixel { .. })));
    }
    // One point: P = 1 at all modes, and nothing is left to chance but the shift.
    let prediction = Prediction::new(&power, 1.0).expect("a rate");
    let noise = prediction.noise(&ImageSpectrum::of_constant(1.0), kernel("box").expect("one"));
    assert!(noise.abs() < 1e-12, "a box of one pixel always holds one sample: {noise}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 30, ..ProptestConfig::default() })]

    #[test]
    fn noise_is_linear_in_power_and_never_negative(
        fx in -1.5_f64..1.5, fy in -1.5_f64..1.5, a in 0.0_f64..1.0, rate in 0.3_f64..20.0,
        seed in 0_u64..50,
    ) {
        let power = PatternPower::of(&[jittered_set(6, seed)], 40).expect("small");
        let prediction = Prediction::new(&power, rate).expect("a rate");
        let tent = kernel("tent").expect("a kernel");
        let noise = |scene: &PlaneWaves| prediction.noise(&ImageSpectrum::of_waves(scene), tent);
        let one = noise(&waves(0.0, &[(a, fx, fy)]));
        let flat = noise(&waves(0.7, &[]));
        let both = noise(&waves(0.7, &[(a, fx, fy)]));
        prop_assert!(one >= -1e-12 && flat >= -1e-12, "{one} {flat}");
        prop_assert!((both - one - flat).abs() < 1e-12 * (1.0 + both), "{both} {one} {flat}");
        let double = noise(&waves(0.0, &[(2.0 * a, fx, fy)]));
        prop_assert!((double - 4.0 * one).abs() < 1e-11, "{double} {one}");
    }
}
