//! The renderer: what it leaves out because nobody needs it, and against nested loops.

use std::hint::black_box;

use bn_cli::{Failure, Outcome};
use bn_core::{DVec2, PointSet, Seed, Unobserved};
use bn_render::{
    Channels, Checkerboard, Frame, Image, Kernel, KernelTable, Normalization, Pattern, RenderStats,
    Renderer, Scene, Window, ZonePlate,
};
use bn_samplers::{Jittered, Sampler as _};

use super::chapter::{Chapter, Value};
use super::{Effort, SEED};

const KERNEL: &str = "lanczos2";
const POINTS: usize = 4096;

/// Samples per pixel against nested loops, and of what is left out.
const DENSE: f64 = 16.0;
const SPARSE: f64 = 8.0;

pub(super) fn measure(effort: Effort) -> Outcome<Chapter> {
    let sample = Jittered::default().sample(POINTS, Seed::new(SEED), &Unobserved);
    let set = sample.map_err(Failure::failed)?.points;
    let kernel = bn_render::kernel(KERNEL).expect("in the list");
    let easel = Easel { set, kernel, table: KernelTable::new(kernel), effort };
    let mut rows = easel.half_constant()?;
    rows.extend(easel.window()?);
    rows.extend(easel.against_nested_loops()?);
    Ok(Chapter {
        id: "skipping",
        title: "Rendering no more than is needed",
        method: format!(
            "Jittered points, {KERNEL}, normalised by density. A checkerboard under a sky that takes half \
             of the image, with and without saying that the sky is constant ({SPARSE} spp); a window of a \
             zone plate, and the whole ({SPARSE} spp); a zone plate by nested loops over samples and the \
             pixels that they reach, one kernel value after another, and by the renderer ({DENSE} spp). \
             The difference is the largest from the first row of each."
        ),
        columns: &[
            "scene",
            "rendered",
            "pixels",
            "samples",
            "evaluated",
            "time / s",
            "samples / s",
            "difference",
            "runs",
        ],
        rows,
        diagrams: Vec::new(),
    })
}

/// What all rows are rendered with.
struct Easel {
    set: PointSet,
    kernel: &'static dyn Kernel,
    table: KernelTable,
    effort: Effort,
}

/// A rendering and how long it takes.
struct Timed {
    image: Image,
    stats: RenderStats,
    seconds: f64,
    runs: usize,
}

impl Timed {
    fn row(&self, scene: &str, rendered: &str, difference: f64) -> Vec<Value> {
        let pixels = self.image.width() as usize * self.image.height() as usize;
        vec![
            scene.into(),
            rendered.into(),
            pixels.into(),
            (self.stats.samples as usize).into(),
            (self.stats.evaluated as usize).into(),
            self.seconds.into(),
            (self.stats.samples as f64 / self.seconds).into(),
            difference.into(),
            self.runs.into(),
        ]
    }
}

/// The largest difference of two images' values.
fn farthest(a: &Image, b: &Image) -> f64 {
    let pairs = a.values().iter().zip(b.values());
    pairs.map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max)
}

impl Easel {
    fn render(&self, scene: &dyn Scene, frame: &Frame, rate: f64) -> Outcome<Timed> {
        let pattern = Pattern::tiled(&self.set, rate).map_err(Failure::failed)?;
        let renderer = Renderer::new(scene, &pattern, &self.table, Normalization::Density, frame);
        let (image, stats) = renderer.image().map_err(Failure::failed)?;
        let timing = self.effort.budget.median(|| {
            black_box(renderer.image().is_ok());
        });
        Ok(Timed { image, stats, seconds: timing.seconds, runs: timing.runs })
    }

    fn half_constant(&self) -> Outcome<Vec<Vec<Value>>> {
        let side = if self.effort.quick { 128 } else { 1024 };
        let frame = Frame::new(side, side).map_err(Failure::failed)?;
        let board = Checkerboard::new(&frame, 0.5, 12.0, 0.5);
        let all = self.render(&Silent(&board), &frame, SPARSE)?;
        let half = self.render(&board, &frame, SPARSE)?;
        let difference = farthest(&all.image, &half.image);
        let name = "half sky";
        Ok(vec![all.row(name, "all samples", 0.0), half.row(name, "the sky known", difference)])
    }

    fn window(&self) -> Outcome<Vec<Vec<Value>>> {
        let (width, height) = if self.effort.quick { (320, 256) } else { (3840, 2160) };
        let frame = Frame::new(width, height).map_err(Failure::failed)?;
        let plate = ZonePlate::new(&frame, 1.0);
        let place = Window { x: width / 3, y: height / 3, width: 64, height: 64 };
        let window = frame.cropped(place).map_err(Failure::failed)?;
        let whole = self.render(&plate, &frame, SPARSE)?;
        let part = self.render(&plate, &window, SPARSE)?;
        let differences = (0..64).flat_map(|y| (0..64).map(move |x| (x, y))).map(|(x, y)| {
            let inside = whole.image.pixel(place.x + x, place.y + y)[0];
            f64::from((inside - part.image.pixel(x, y)[0]).abs())
        });
        let difference = differences.fold(0.0, f64::max);
        let name = format!("{width} × {height}");
        Ok(vec![whole.row(&name, "whole", 0.0), part.row(&name, "64 × 64 pixels", difference)])
    }

    fn against_nested_loops(&self) -> Outcome<Vec<Vec<Value>>> {
        let side = if self.effort.quick { 32 } else { 256 };
        let frame = Frame::new(side, side).map_err(Failure::failed)?;
        let plate = ZonePlate::new(&frame, 1.0);
        let (image, evaluated) = nested_loops(&plate, &self.set, DENSE, self.kernel, side);
        let timing = self.effort.budget.median(|| {
            black_box(nested_loops(&plate, &self.set, DENSE, self.kernel, side));
        });
        let stats = RenderStats { samples: evaluated, evaluated, ..RenderStats::default() };
        let image = Image::new(side, side, Channels::Grey, image).map_err(Failure::failed)?;
        let plain = Timed { image, stats, seconds: timing.seconds, runs: timing.runs };
        let one =
            rayon::ThreadPoolBuilder::new().num_threads(1).build().map_err(Failure::failed)?;
        let single = one.install(|| self.render(&plate, &frame, DENSE))?;
        let all = self.render(&plate, &frame, DENSE)?;
        let row = |timed: &Timed, how: &str| {
            timed.row("zone plate", how, farthest(&plain.image, &timed.image))
        };
        Ok(vec![
            row(&plain, "nested loops, one thread"),
            row(&single, "one thread"),
            row(&all, "all threads"),
        ])
    }
}

/// A scene that keeps what it knows to itself.
struct Silent<'a>(&'a dyn Scene);

impl Scene for Silent<'_> {
    fn channels(&self) -> Channels {
        self.0.channels()
    }

    fn values(&self, u: &[f64], v: &[f64], out: &mut [f64]) {
        self.0.values(u, v, out);
    }
}

/// What one writes first: for each sample all pixels within reach, one kernel value after another.
/// The image, and how many samples reached it.
fn nested_loops(
    scene: &dyn Scene,
    set: &PointSet,
    rate: f64,
    kernel: &dyn Kernel,
    size: u32,
) -> (Vec<f32>, u64) {
    let tile = (set.len() as f64 / rate).sqrt();
    let mut sums = vec![[0.0; 2]; (size * size) as usize];
    let mut count = 0;
    let pixels = |x: f64| {
        let first = (x - kernel.radius() - 0.5).ceil().max(0.0) as u32;
        first..((x + kernel.radius() - 0.5).floor() + 1.0).clamp(0.0, f64::from(size)) as u32
    };
    let tiles = -1..=(f64::from(size) / tile) as i64 + 1;
    for corner in tiles.clone().flat_map(|b| tiles.clone().map(move |a| (a as f64, b as f64))) {
        for p in set.points() {
            let at = (DVec2::from(corner) + *p) * tile;
            if pixels(at.x).is_empty() || pixels(at.y).is_empty() {
                continue;
            }
            count += 1;
            let value = scene.value(at)[0];
            for j in pixels(at.y) {
                let wy = kernel.value(f64::from(j) + 0.5 - at.y);
                for i in pixels(at.x) {
                    let w = wy * kernel.value(f64::from(i) + 0.5 - at.x);
                    let [sum, weight] = &mut sums[(j * size + i) as usize];
                    *sum += w * value;
                    *weight += w;
                }
            }
        }
    }
    (sums.iter().map(|[sum, weight]| (sum / weight) as f32).collect(), count)
}

#[cfg(test)]
mod tests {
    use super::super::timing::Budget;
    use super::*;

    #[test]
    fn what_is_left_out_makes_no_difference() {
        let chapter = measure(Effort { quick: true, budget: Budget::new(true) }).expect("measured");
        let count = |row: usize, column: usize| match chapter.rows[row][column] {
            Value::Count(count) => count,
            _ => panic!("no count: {:?}", chapter.rows[row]),
        };
        let difference = |row: usize| match chapter.rows[row][7] {
            Value::Real(real) => real,
            _ => panic!("no number: {:?}", chapter.rows[row]),
        };
        // Half of the pixels, but only one of four rows of blocks of 32 pixels sees nothing but sky.
        assert!(count(1, 4) < 8 * count(0, 4) / 10);
        assert!(count(3, 4) < count(2, 4) / 10);
        assert_eq!([difference(1), difference(3)], [0.0; 2]);
        assert_eq!(count(4, 4), count(5, 4));
        assert!(difference(5) < 1e-4 && difference(6) == difference(5));
    }
}
