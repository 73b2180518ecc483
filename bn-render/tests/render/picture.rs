//! Images as scenes.

use bn_core::DVec2;
use bn_render::{Channels, Frame, Image, Interpolation, Picture, Rect, Scene};

const ALL: [Interpolation; 4] =
    [Interpolation::Box, Interpolation::Bilinear, Interpolation::Bicubic, Interpolation::Lanczos];

fn image(width: u32, height: u32, value: impl Fn(u32, u32) -> f32) -> Image {
    let values = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let values = values.map(|(x, y)| value(x, y)).collect();
    Image::new(width, height, Channels::Grey, values).expect("an image")
}

fn frame(width: u32, height: u32) -> Frame {
    Frame::new(width, height).expect("a size")
}

#[test]
fn pixels_keep_their_values_at_their_centres() {
    let random = |x: u32, y: u32| ((x * 37 + y * 101) % 97) as f32 / 97.0;
    let image = image(31, 22, random);
    for interpolation in ALL {
        // Stretched by 2 and 3: the centre of pixel (x, y) comes to lie at (2x + 1, 3y + 1.5).
        let picture = Picture::covering(image.clone(), interpolation, &frame(62, 66));
        for y in 0..22 {
            for x in 0..31 {
                let at = DVec2::new(f64::from(2 * x + 1), f64::from(3 * y) + 1.5);
                let got = picture.value(at)[0];
                assert!((got - f64::from(random(x, y))).abs() < 1e-9, "{interpolation:?} {x} {y}");
            }
        }
    }
}

#[test]
fn ramps_stay_ramps() {
    // Lanczos is no ramp's friend: it errs by some per cent of the slope.
    let ramp = image(40, 40, |x, y| (2 * x + y) as f32 / 256.0);
    for (interpolation, tolerance) in [
        (Interpolation::Bilinear, 1e-12),
        (Interpolation::Bicubic, 1e-12),
        (Interpolation::Lanczos, 5e-4),
    ] {
        let picture = Picture::covering(ramp.clone(), interpolation, &frame(40, 40));
        for i in 0..900 {
            let at = DVec2::new(5.0 + 0.97 * f64::from(i % 30), 5.0 + 0.99 * f64::from(i / 30));
            let want = (2.0 * (at.x - 0.5) + (at.y - 0.5)) / 256.0;
            let got = picture.value(at)[0];
            assert!((got - want).abs() < tolerance, "{interpolation:?} at {at}: {got}, {want}");
        }
    }
}

#[test]
fn interpolations_follow_their_definitions() {
    let random = |x: u32, y: u32| ((x * 53 + y * 29) % 83) as f32 / 83.0;
    let image = image(16, 12, random);
    let pixel = |x: i64, y: i64| f64::from(random(x.clamp(0, 15) as u32, y.clamp(0, 11) as u32));
    for (interpolation, name) in ALL.into_iter().zip(["box", "tent", "bicubic", "lanczos3"]) {
        let kernel = bn_render::kernel(name).expect("a kernel");
        let picture = Picture::covering(image.clone(), interpolation, &frame(16, 12));
        // Beyond the border too.
        for i in 0..600 {
            let at = DVec2::new(f64::from(i % 25) * 0.83 - 2.0, f64::from(i / 25) * 0.71 - 2.0);
            let (mut sum, mut total) = (0.0, 0.0);
            for y in -12..24 {
                for x in -12..28 {
                    let w =
                        kernel.value(x as f64 + 0.5 - at.x) * kernel.value(y as f64 + 0.5 - at.y);
                    (sum, total) = (sum + w * pixel(x, y), total + w);
                }
            }
            let got = picture.value(at)[0];
            assert!((got - sum / total).abs() < 1e-9, "{name} at {at}: {got}, {}", sum / total);
        }
    }
}

#[test]
fn constant_parts_are_known_and_bounds_hold() {
    let patch = image(128, 96, |x, y| if x < 70 { 0.25 } else { ((x * y) % 11) as f32 / 10.0 });
    for interpolation in ALL {
        let picture = Picture::covering(patch.clone(), interpolation, &frame(64, 48));
        let mut known = 0;
        for i in 0..300 {
            let corner = DVec2::new(f64::from(i % 20) * 3.1, f64::from(i / 20) * 3.1);
            let rect = Rect { min: corner, max: corner + 1.7 };
            let (constant, bounds) = (picture.constant_over(&rect), picture.bounds_over(&rect));
            known += usize::from(constant.is_some());
            for j in 0..36 {
                let step = DVec2::new(f64::from(j % 6), f64::from(j / 6)) / 5.0;
                let value = picture.value(rect.min + step * (rect.max - rect.min))[0];
                assert!(constant.is_none_or(|color| color[0] == value));
                assert!(bounds.is_none_or(|(low, high)| (low..=high).contains(&value)));
            }
        }
        assert!(known > 60, "{interpolation:?}: {known}");
        let narrow = matches!(interpolation, Interpolation::Box | Interpolation::Bilinear);
        assert_eq!(picture.bounds_over(&Rect::new(40.0, 10.0, 42.0, 12.0)).is_some(), narrow);
    }
}
