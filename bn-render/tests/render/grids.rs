//! Band-limited images from square grids: within what each kernel states.

use bn_core::{DVec2, PointSet};
use bn_render::{
    Frame, KERNELS, KernelTable, Normalization, Pattern, PlaneWave, PlaneWaves, Renderer, Scene,
    grid_error,
};

/// What f32 pixels and tabulated kernels leave open.
const ROUNDING: f64 = 1e-6;

/// A square grid of 24 × 24 points, moved by parts of its spacing.
fn grid(shift: DVec2) -> PointSet {
    let point = |i: u32| (DVec2::new(f64::from(i % 24), f64::from(i / 24)) + shift) / 24.0;
    PointSet::new((0..24 * 24).map(point).collect()).expect("a set")
}

/// The largest difference between waves of this frequency and what becomes of them.
fn difference(
    table: &KernelTable,
    normalization: Normalization,
    frequency: DVec2,
    (rate, shift): (f64, DVec2),
) -> f64 {
    let frame = Frame::new(26, 22).expect("a size");
    let pattern = Pattern::tiled(&grid(shift), rate).expect("a rate");
    let of = |phase_turns: f64| {
        let wave = PlaneWave { amplitude: 1.0, frequency, phase_turns };
        let scene = PlaneWaves::new(0.0, vec![wave]);
        let renderer = Renderer::new(&scene, &pattern, table, normalization, &frame);
        let image = renderer.image().expect("small").0;
        let pixel = |i: usize| {
            let (x, y) = (i as u32 % 26, i as u32 / 26);
            let exact = scene.value(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5))[0];
            f64::from(image.pixel(x, y)[0]) - exact
        };
        (0..26 * 22).map(pixel).collect::<Vec<f64>>()
    };
    // Cosine and sine: together the modulus, which no phase exceeds.
    let parts = of(0.0).into_iter().zip(of(-0.25));
    parts.map(|(re, im)| re.hypot(im)).fold(0.0, f64::max)
}

#[test]
fn waves_below_the_nyquist_frequency_come_out_within_the_kernels_stated_error() {
    let shifts = [(0.0, 0.0), (0.5, 0.5), (0.25, 0.9), (0.125, 0.375)];
    let directions = [(1.0, 1.0), (1.0, -1.0), (1.0, 0.0), (0.0, 0.7), (0.45, -0.8)];
    for &kernel in KERNELS {
        let table = KernelTable::new(kernel);
        for normalization in [Normalization::Density, Normalization::None] {
            for (band, rate) in [(0.0, 1.0), (0.25, 1.0), (0.5, 1.0), (0.4, 2.25), (0.5, 4.0)] {
                let stated = grid_error(kernel, normalization, band, rate);
                let mut most = 0.0_f64;
                for shift in shifts.map(DVec2::from) {
                    for direction in directions.map(DVec2::from) {
                        let got =
                            difference(&table, normalization, direction * band, (rate, shift));
                        most = most.max(got);
                    }
                }
                let case = format!("{} to {band} from {rate}", kernel.name());
                assert!(most <= 1.01 * stated + ROUNDING, "{case}: {most} above {stated}");
                // It is no idle bound: these few waves and places already come near.
                assert!(most >= 0.6 * stated - ROUNDING, "{case}: {most} of {stated}");
            }
        }
    }
}

/// The table in the documentation of [`KERNELS`] is what is measured.
#[test]
fn the_documented_errors_are_those_of_the_kernels() {
    let source = include_str!("../../src/kernel/mod.rs");
    for &kernel in KERNELS {
        let errors = [(0.1, 1.0), (0.25, 1.0), (0.25, 4.0), (0.5, 4.0)];
        let error = |(band, rate)| {
            format!("{:.4} |", grid_error(kernel, Normalization::Density, band, rate))
        };
        let row = format!(
            "/// | `{}` | {} | {:.6} | {}",
            kernel.name(),
            kernel.radius(),
            kernel.integral(),
            errors.map(error).join(" ")
        );
        assert!(source.contains(&row), "no row {row}");
    }
}
