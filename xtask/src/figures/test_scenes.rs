//! Checkerboards and the sphere scene (figures 1.1, 5.10, 5.11, 5.12).

use bn_cli::{Failure, Outcome};
use bn_render::{
    Checkerboard, Frame, Image, Scene, SphereScene, Window, error_picture, mean_square_error,
    peak_signal_to_noise,
};

use super::FigureSpec;
use super::gallery::{Exhibit, enlarged, hang, rendered};
use super::studio::Studio;

pub(super) const FIGURES: &[FigureSpec] = &[
    FigureSpec { id: "1.1", title: "more samples, or irregular ones", draw: introduction },
    FigureSpec { id: "5.10", title: "the sphere scene and a detail", draw: sphere },
    FigureSpec { id: "5.11", title: "checkerboards of lattices and random points", draw: coarse },
    FigureSpec { id: "5.12", title: "checkerboards of blue noise", draw: blue },
];

/// Samples per pixel of the references, by a hexagonal lattice.
const REFERENCE: f64 = 512.0;

fn frame(width: u32, height: u32) -> Outcome<Frame> {
    Frame::new(width, height).map_err(Failure::failed)
}

fn sampled(
    studio: &Studio,
    method: &str,
    scene: &dyn Scene,
    frame: &Frame,
    rate: f64,
) -> Outcome<Image> {
    let n = if studio.quick() { 256 } else { 4096 };
    rendered(scene, frame, &studio.sets(method, &[], n, 1)?[0], rate)
}

fn introduction(studio: &Studio) -> Outcome {
    let frame = frame(160, 160)?;
    let scene = SphereScene::new(&frame, 1.0);
    let exhibit = |method: &str, label: String, rate: f64| -> Outcome<Exhibit> {
        let image = sampled(studio, method, &scene, &frame, rate)?;
        Ok(Exhibit::new(label, enlarged(&image, 2)?))
    };
    let top = [1.0, 4.0, 16.0]
        .into_iter()
        .map(|rate| exhibit("regular", format!("square grid, {rate} spp"), rate))
        .collect::<Outcome<Vec<_>>>()?;
    let bottom = ["stochastic", "jittered", "step"]
        .into_iter()
        .map(|method| exhibit(method, format!("{method}, 4 spp"), 4.0))
        .collect::<Outcome<Vec<_>>>()?;
    studio.page("", &hang("Moiré or noise: 160 × 160 pixels, enlarged twice", vec![top, bottom]))
}

fn sphere(studio: &Studio) -> Outcome {
    let whole = frame(640, 640)?;
    let image = sampled(studio, "hexagonal", &SphereScene::new(&whole, 1.0), &whole, 16.0)?;
    let large = frame(2560, 2560)?;
    let detail = large.cropped(Window { x: 1300, y: 900, width: 640, height: 640 });
    let scene = SphereScene::new(&large, 1.0);
    let detail = sampled(studio, "hexagonal", &scene, &detail.map_err(Failure::failed)?, 4.0)?;
    let row = vec![
        Exhibit::new("the scene", image),
        Exhibit::new("a detail, four times as large", detail),
    ];
    studio.page("", &hang("The sphere scene", vec![row]))
}

/// Rows of image and error, with their PSNR.
fn boards(studio: &Studio, methods: &[(&str, &str)]) -> Outcome {
    let frame = if studio.quick() { frame(96, 64)? } else { frame(480, 320)? };
    let scene = Checkerboard::new(&frame, 0.3, 12.0, 0.5);
    let reference = sampled(studio, "hexagonal", &scene, &frame, REFERENCE)?;
    let rows = methods
        .iter()
        .map(|(method, label)| {
            let image = sampled(studio, method, &scene, &frame, 8.0)?;
            let mse = mean_square_error(&image, &reference).map_err(Failure::failed)?;
            let error = error_picture(&image, &reference, 2.0).map_err(Failure::failed)?;
            Ok(vec![
                Exhibit::new(*label, image),
                Exhibit::new(format!("error, doubled: {:.1} dB", peak_signal_to_noise(mse)), error),
            ])
        })
        .collect::<Outcome<Vec<_>>>()?;
    studio.page("", &hang("Checkerboard, 8 spp; reference: hexagonal grid, 512 spp", rows))
}

fn coarse(studio: &Studio) -> Outcome {
    boards(
        studio,
        &[
            ("hexagonal", "hexagonal grid"),
            ("regular", "square grid"),
            ("stochastic", "stochastic sampling"),
        ],
    )
}

fn blue(studio: &Studio) -> Outcome {
    boards(
        studio,
        &[
            ("cccvt", "CCCVT"),
            ("single-peak", "single-peak blue noise"),
            ("step", "step blue noise"),
        ],
    )
}
