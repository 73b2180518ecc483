//! Statistics of errors: mean and energy of random scenes against integration by brute force, and
//! tiles that join without a trace.

use crate::common::{jittered_set, random_set};
use bn_core::{DVec2, PointSet, Seed};
use bn_render::{
    Frame, Kernel, KernelTable, Normalization, Pattern, PlaneWave, PlaneWaves, Renderer, Scene,
    TileVariation, kernel,
};
use proptest::prelude::*;

/// ∫ r cos 2πfx / ∫ r by the midpoint rule.
fn gain(kernel: &dyn Kernel, f: f64) -> f64 {
    let places = (-2000..2000).map(|i| (f64::from(i) + 0.5) / 1000.0);
    let (mut sum, mut total) = (0.0, 0.0);
    for x in places {
        sum += kernel.value(x) * libm::cos(std::f64::consts::TAU * f * x);
        total += kernel.value(x);
    }
    sum / total
}

/// Mean square errors of pixels whose centres lie within 1.5 pixels of a tile's border, and of the
/// others, for a wave that is all noise.
fn errors(pattern: &Pattern, normalization: Normalization, seed: u64) -> [f64; 2] {
    let frame = Frame::new(200, 190).expect("a size");
    let direction = DVec2::new(0.61, 0.47 + 0.01 * seed as f64);
    let wave = PlaneWave { amplitude: 0.5, frequency: direction, phase_turns: 0.0 };
    let scene = PlaneWaves::new(0.5, vec![wave]);
    let lanczos = kernel("lanczos2").expect("a kernel");
    let gain = gain(lanczos, direction.x) * gain(lanczos, direction.y);
    let table = KernelTable::new(lanczos);
    let renderer = Renderer::new(&scene, pattern, &table, normalization, &frame);
    let image = renderer.image().expect("small").0;
    let mut sums = [(0.0, 0.0); 2];
    for y in 0..frame.height() {
        for x in 0..frame.width() {
            let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let truth = 0.5 + gain * (scene.value(centre)[0] - 0.5);
            let error = f64::from(image.pixel(x, y)[0]) - truth;
            let place = centre / pattern.side();
            let from_border = (place - place.round()).abs().min_element() * pattern.side();
            let sum = &mut sums[usize::from(from_border > 1.5)];
            *sum = (sum.0 + error * error, sum.1 + 1.0);
        }
    }
    sums.map(|(sum, count)| sum / count)
}

#[test]
fn borders_of_tiles_err_as_all_pixels_do() {
    // Sides of 15.4, 12 and 9.6 pixels.
    for spp in [4.3, 1024.0 / 144.0, 11.1] {
        for jittered in [true, false] {
            let (mut border, mut inner) = (0.0, 0.0);
            for seed in 0..12 {
                let set = if jittered { jittered_set(32, seed) } else { random_set(1024, seed) };
                let pattern = Pattern::tiled(&set, spp).expect("a pattern");
                // At low rates the weights of independent samples nearly cancel in some pixels,
                // whose errors then outweigh all others': plain convolution has no such tail.
                let how = if jittered { Normalization::Density } else { Normalization::None };
                let [b, i] = errors(&pattern, how, seed);
                (border, inner) = (border + b, inner + i);
            }
            // Some 80 places along a tile's border in 12 sets, whose errors vary by some 100 %, and
            // are alike over a kernel's width: a standard error of 7 % or less.
            let ratio = border / inner;
            assert!((ratio - 1.0).abs() < 0.25, "{spp} spp, jittered: {jittered}: {ratio}");
        }
    }
}

#[test]
fn torn_seams_would_show() {
    // A lattice whose tiles are shifted against each other: perfect inside, torn along the seams.
    let grid = (0..1024).map(|i| DVec2::new(f64::from(i % 32), f64::from(i / 32)) / 32.0);
    let set = PointSet::new(grid.collect()).expect("a set");
    let pattern = Pattern::tiled(&set, 4.3).expect("a pattern");
    let shifted = TileVariation::Shifted(Seed::new(1));
    let [border, inner] = errors(&pattern.varied(shifted), Normalization::Density, 0);
    assert!(border > 2.0 * inner, "{border} {inner}");
}

/// Midpoints to a pixel along each axis.
const STEPS: i32 = 16;

/// ∫∫ r(d) I / (∫r)² for the pixel whose centre is `at`, by the midpoint rule: its error is below
/// (π f/16)²/6, 0.65 % of an amplitude, for frequencies f up to 1 cycle per pixel.
fn convolved(scene: &dyn Scene, kernel: &dyn Kernel, at: DVec2) -> f64 {
    let reach = (kernel.radius() * f64::from(STEPS)) as i32;
    let offsets = || (-reach..reach).map(|i| (f64::from(i) + 0.5) / f64::from(STEPS));
    let (mut sum, mut total) = (0.0, 0.0);
    for y in offsets() {
        for x in offsets() {
            let w = kernel.value(-x) * kernel.value(-y);
            (sum, total) = (sum + w * scene.value(at + DVec2::new(x, y))[0], total + w);
        }
    }
    sum / total
}

fn waves() -> impl Strategy<Value = PlaneWaves> {
    let wave = (0.02_f64..0.12, -0.7_f64..0.7, -0.7_f64..0.7, 0.0_f64..1.0).prop_map(
        |(amplitude, x, y, phase_turns)| PlaneWave {
            amplitude,
            frequency: DVec2::new(x, y),
            phase_turns,
        },
    );
    (0.3_f64..0.7, prop::collection::vec(wave, 1..5))
        .prop_map(|(mean, waves)| PlaneWaves::new(mean, waves))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    #[test]
    fn mean_and_energy_are_those_of_the_convolution(
        scene in waves(), which in 0_usize..4, plain in any::<bool>(), seed in 0_u64..100,
    ) {
        let frame = Frame::new(9, 7).expect("a size");
        let kernel = kernel(["box", "tent", "mitchell", "lanczos2"][which]).expect("a kernel");
        let pattern = Pattern::tiled(&jittered_set(64, seed), 256.0).expect("a pattern");
        let normalization = if plain { Normalization::None } else { Normalization::Density };
        let table = KernelTable::new(kernel);
        let renderer = Renderer::new(&scene, &pattern, &table, normalization, &frame);
        let image = renderer.image().expect("small").0;
        let (mut got, mut want) = ([0.0; 2], [0.0; 2]);
        for y in 0..7 {
            for x in 0..9 {
                let value = f64::from(image.pixel(x, y)[0]);
                let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let brute = convolved(&scene, kernel, centre);
                got = [got[0] + value / 63.0, got[1] + value * value / 63.0];
                want = [want[0] + brute / 63.0, want[1] + brute * brute / 63.0];
            }
        }
        // A pixel's 256 or more samples are jittered over 1/16 pixel: where plain convolution of the
        // box counts them, as many as lie on the border may be in or out: 1 % of the level. The mean
        // of 63 pixels has an eighth of that, and brute force its own error.
        prop_assert!((got[0] - want[0]).abs() < 4e-3, "means {got:?} {want:?}");
        prop_assert!((got[1] - want[1]).abs() < 5e-3, "energies {got:?} {want:?}");
    }
}
