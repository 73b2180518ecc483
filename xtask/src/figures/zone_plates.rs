//! Zone plates: what patterns do to all frequencies at once (figures 2.5, 3.7, 5.8, 5.9).

use bn_cli::{Failure, Outcome};
use bn_core::Unobserved;
use bn_render::{
    Frame, Image, LimitedZonePlate, Scene, Window, ZonePlate, error_picture, exact_convolution,
};

use super::FigureSpec;
use super::gallery::{Exhibit, hang, rendered};
use super::studio::Studio;
use crate::thesis::Rows;

pub(super) const FIGURES: &[FigureSpec] = &[
    FigureSpec { id: "2.5", title: "moiré of the square grid at growing rates", draw: moire },
    FigureSpec { id: "3.7", title: "zone plates from a bird's eye view", draw: birds_eye },
    FigureSpec { id: "5.8", title: "low frequencies: step against dart throwing", draw: low },
    FigureSpec { id: "5.9", title: "high frequencies: single peak against FPO", draw: high },
    FigureSpec { id: "zone-plates", title: "zone plates of all patterns", draw: all },
];

/// Points of the sets: the thesis's.
fn points(studio: &Studio) -> usize {
    if studio.quick() { 256 } else { 4096 }
}

/// Pixels on a side.
fn side(studio: &Studio) -> u32 {
    if studio.quick() { 64 } else { 400 }
}

fn square(side: u32) -> Outcome<Frame> {
    Frame::new(side, side).map_err(Failure::failed)
}

fn sampled(
    studio: &Studio,
    method: &str,
    options: &[(&str, &str)],
    scene: &dyn Scene,
    frame: &Frame,
    rate: f64,
) -> Outcome<Image> {
    let sets = studio.sets(method, options, points(studio), 1)?;
    rendered(scene, frame, &sets[0], rate)
}

fn moire(studio: &Studio) -> Outcome {
    let frame = square(side(studio))?;
    let plate = ZonePlate::new(&frame, 2.0);
    let one = |rate: f64| -> Outcome<Exhibit> {
        let image = sampled(studio, "regular", &[], &plate, &frame, rate)?;
        Ok(Exhibit::new(format!("{rate} spp"), image))
    };
    let rows = [[1.0, 2.0], [4.0, 8.0]]
        .map(|rates| rates.into_iter().map(one).collect::<Outcome<Vec<_>>>());
    let rows = rows.into_iter().collect::<Outcome<Vec<_>>>()?;
    let title = "Square grid: local frequency up to 2 cycles per pixel at the middle of each side";
    studio.page("", &hang(title, rows))
}

/// Exhibits by their methods, two a row.
fn pairs(
    studio: &Studio,
    title: &str,
    methods: &[(&str, &str)],
    scene: &dyn Scene,
    frame: &Frame,
    rate: f64,
) -> Outcome {
    let rows = methods
        .chunks(2)
        .map(|row| {
            row.iter()
                .map(|&(method, label)| {
                    let image = sampled(studio, method, &[], scene, frame, rate)?;
                    Ok(Exhibit::new(label, image))
                })
                .collect()
        })
        .collect::<Outcome<Vec<_>>>()?;
    studio.page("", &hang(title, rows))
}

fn birds_eye(studio: &Studio) -> Outcome {
    let frame = square(side(studio))?;
    let plate = ZonePlate::new(&frame, 3.0);
    let methods = [
        ("fpo", "farthest-point optimisation"),
        ("lloyd", "Lloyd"),
        ("dart-throwing", "dart throwing"),
        ("step", "step blue noise"),
    ];
    let title = "1 spp, local frequency up to 3 cycles per pixel at the middle of each side";
    pairs(studio, title, &methods, &plate, &frame, 1.0)
}

fn low(studio: &Studio) -> Outcome {
    let frame = square(2 * side(studio))?;
    let plate = LimitedZonePlate::new(&frame, 0.35, f64::from(side(studio)));
    let corner =
        Window { x: side(studio), y: side(studio), width: side(studio), height: side(studio) };
    let corner = frame.cropped(corner).map_err(Failure::failed)?;
    let exact = bn_render::kernel("lanczos2").expect("in the list");
    let exact = exact_convolution(&plate, exact, &corner, 1e-4, &Unobserved)
        .map_err(Failure::failed)?
        .image;
    let (mut images, mut errors) = (Vec::new(), Vec::new());
    for (method, label) in [("step", "step blue noise"), ("dart-throwing", "dart throwing")] {
        let image = sampled(studio, method, &[], &plate, &corner, 1.0)?;
        let error = error_picture(&image, &exact, 4.0).map_err(Failure::failed)?;
        images.push(Exhibit::new(label, image));
        errors.push(Exhibit::new("error, four times", error));
    }
    let title = "1 spp, the centre in the upper left corner, up to 0.35 cycles per pixel";
    studio.page("", &hang(title, vec![images, errors]))
}

fn high(studio: &Studio) -> Outcome {
    let frame = square(2 * side(studio))?;
    let plate = ZonePlate::new(&frame, 1.5);
    let corner =
        Window { x: side(studio), y: side(studio), width: side(studio), height: side(studio) };
    let corner = frame.cropped(corner).map_err(Failure::failed)?;
    let methods =
        [("single-peak", "single-peak blue noise"), ("fpo", "farthest-point optimisation")];
    let title =
        "1 spp, the centre in the upper left corner, up to 1.5 cycles per pixel at the sides";
    pairs(studio, title, &methods, &plate, &corner, 1.0)
}

fn all(studio: &Studio) -> Outcome {
    let frame = square(if studio.quick() { 48 } else { 320 })?;
    let plate = ZonePlate::new(&frame, 1.5);
    let mut exhibits = Vec::new();
    for row in Rows::load()?.iter().filter(|row| row.method().is_some()) {
        let options: Vec<_> = row.options.iter().map(|(k, v)| (k.as_str(), v.as_str())).collect();
        let image = sampled(studio, &row.method, &options, &plate, &frame, 1.0)?;
        exhibits.push(Exhibit::new(row.method.clone(), image));
    }
    let mut rows: Vec<Vec<Exhibit>> = Vec::new();
    for exhibit in exhibits {
        match rows.last_mut().filter(|row| row.len() < 4) {
            Some(row) => row.push(exhibit),
            None => rows.push(vec![exhibit]),
        }
    }
    let title =
        "1 spp, local frequency up to 1.5 cycles per pixel at the middle of each side, Lanczos 2";
    studio.page("", &hang(title, rows))
}
