//! Renderings beside each other, shown pixel by pixel.

use bn_cli::plot::{Axis, Page, Panel, Picture, Row, Text};
use bn_cli::{Failure, Outcome};
use bn_core::PointSet;
use bn_render::{
    Channels, Frame, Image, KernelTable, Normalization, Pattern, Renderer, Scene, srgb_from_linear,
};

/// An image with what stands above it.
pub(super) struct Exhibit {
    pub(super) title: String,
    pub(super) image: Image,
}

impl Exhibit {
    pub(super) fn new(title: impl Into<String>, image: Image) -> Self {
        Self { title: title.into(), image }
    }
}

/// Points of the page to a pixel of an image, which gets this many pixels a side in a PNG.
const PIXEL: f64 = 0.5;
const ENLARGED: f64 = 1.0;

/// Images are shown at least so many pixels high, so that their titles have room.
const LEAST_HEIGHT: u32 = 200;

/// Rows of images, those of a row all of one height; each pixel of an image is one of the PNG, or a
/// square of several if the images are small.
pub(super) fn hang(title: &str, rows: Vec<Vec<Exhibit>>) -> Page {
    let page = Page::new().titled(Text::math(title)).with_density(ENLARGED / PIXEL);
    let height = |row: &[Exhibit]| row.iter().map(|e| e.image.height()).max().unwrap_or(1);
    let least = rows.iter().map(|row| height(row)).min().unwrap_or(1);
    let pixel = PIXEL * f64::from(LEAST_HEIGHT.div_ceil(least));
    rows.into_iter().fold(page, |page, row| {
        page.row(Row::new(pixel * f64::from(height(&row)), row.iter().map(panel).collect()))
    })
}

fn panel(exhibit: &Exhibit) -> Panel {
    let image = &exhibit.image;
    Panel::new(Axis::blank(), Axis::blank())
        .titled(Text::math(&exhibit.title))
        .with_aspect(f64::from(image.width()) / f64::from(image.height()))
        .picture(picture(image))
}

/// The image with the curve of sRGB.
pub(super) fn picture(image: &Image) -> Picture {
    let encode =
        |&light: &f32| (255.0 * srgb_from_linear(f64::from(light).clamp(0.0, 1.0))).round() as u8;
    let samples = image.values().iter().map(encode).collect();
    match image.channels() {
        Channels::Grey => Picture::grey(image.width(), image.height(), samples),
        Channels::Rgb => Picture::rgb(image.width(), image.height(), samples),
    }
}

/// The image with each pixel made `times` × `times`.
pub(super) fn enlarged(image: &Image, times: u32) -> Outcome<Image> {
    let (width, height) = (image.width() * times, image.height() * times);
    let mut values =
        Vec::with_capacity(width as usize * height as usize * image.channels().count());
    for y in 0..height {
        for x in 0..width {
            values.extend_from_slice(image.pixel(x / times, y / times));
        }
    }
    Image::new(width, height, image.channels(), values).map_err(Failure::failed)
}

/// The frame's window of a scene by the thesis's kernel, normalised by density.
pub(super) fn rendered(
    scene: &dyn Scene,
    frame: &Frame,
    set: &PointSet,
    samples_per_pixel: f64,
) -> Outcome<Image> {
    let pattern = Pattern::tiled(set, samples_per_pixel).map_err(Failure::failed)?;
    let kernel = KernelTable::new(bn_render::kernel("lanczos2").expect("in the list"));
    let renderer = Renderer::new(scene, &pattern, &kernel, Normalization::Density, frame);
    Ok(renderer.image().map_err(Failure::failed)?.0)
}
