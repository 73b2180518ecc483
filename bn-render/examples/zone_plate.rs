//! Renders a zone plate of 1920 × 1080 pixels with 16 jittered samples a pixel and tells the time.
//!
//! `cargo run --release --example zone_plate [kernel] [file.png]`

use std::fs::File;
use std::io::BufWriter;
use std::time::Instant;

use bn_core::{DVec2, PointSet, Seed, Unobserved};
use bn_render::{
    Frame, KernelTable, Normalization, Pattern, PngOptions, PngWriter, Renderer, ZonePlate, kernel,
};
use rand::RngExt;

fn jittered(side: usize) -> PointSet {
    let mut rng = Seed::new(1).stream(0);
    let mut jitter = |i: usize| (i as f64 + rng.random::<f64>()) / side as f64;
    let points = (0..side * side).map(|i| DVec2::new(jitter(i % side), jitter(i / side)));
    PointSet::wrapped(points.collect()).expect("finite points")
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "lanczos2".into());
    let path = arguments.next();
    let set = jittered(64);
    let start = Instant::now();
    let frame = Frame::new(1920, 1080)?;
    let scene = ZonePlate::new(&frame, 1.0);
    let pattern = Pattern::tiled(&set, 16.0)?;
    let table = KernelTable::new(kernel(&name).ok_or("no such kernel")?);
    let renderer = Renderer::new(&scene, &pattern, &table, Normalization::Density, &frame);
    let stats = match path {
        Some(path) => {
            let file = BufWriter::new(File::create(path)?);
            let (width, height) = (frame.width(), frame.height());
            let mut png =
                PngWriter::new(file, width, height, renderer.channels(), &PngOptions::default())?;
            let stats = renderer.stream(&Unobserved, |band| {
                png.write_rows(band.values).map_err(std::io::Error::other)
            })?;
            png.finish()?;
            stats
        }
        None => renderer.image()?.1,
    };
    let seconds = start.elapsed().as_secs_f64();
    let rate = stats.samples as f64 / seconds / 1e6;
    println!("{name}: {} samples in {seconds:.3} s, {rate:.1} million a second", stats.samples);
    Ok(())
}
