//! The renderer: seconds against error, by pattern, kernel and rate.

use std::hint::black_box;

use bn_cli::{Failure, Outcome};
use bn_core::{PointSet, Seed, Unobserved};
use bn_render::{
    Frame, Image, KERNELS, Kernel, KernelTable, LimitedZonePlate, Normalization, Pattern, Renderer,
    exact_convolution, mean_square_error, peak_signal_to_noise,
};
use bn_samplers::METHODS;

use super::chapter::{Chapter, Curve, Diagram, Value};
use super::{Effort, SEED};

/// The kernel of the patterns' curves, the pattern of the kernels' curves.
const KERNEL: &str = "lanczos2";
const PATTERN: &str = "jittered";

/// A square that every method can make.
const POINTS: usize = 4096;
const QUICK_POINTS: usize = 256;

/// Samples per pixel.
const RATES: [f64; 4] = [1.0, 4.0, 16.0, 64.0];

/// A zone plate that ends at 0.9 cycles per pixel, in a frame.
struct Subject {
    frame: Frame,
    plate: LimitedZonePlate,
}

impl Subject {
    fn new(effort: Effort) -> Outcome<Self> {
        let side = if effort.quick { 64 } else { 256 };
        let frame = Frame::new(side, side).map_err(Failure::failed)?;
        Ok(Self { frame, plate: LimitedZonePlate::new(&frame, 0.9, 0.5 * f64::from(side)) })
    }

    fn reference(&self, kernel: &dyn Kernel) -> Outcome<Image> {
        let made = exact_convolution(&self.plate, kernel, &self.frame, 1e-7, &Unobserved);
        Ok(made.map_err(Failure::failed)?.image)
    }
}

pub(super) fn measure(effort: Effort) -> Outcome<Chapter> {
    let subject = Subject::new(effort)?;
    let n = if effort.quick { QUICK_POINTS } else { POINTS };
    let mut rows = Vec::new();
    let (mut patterns, mut kernels) = (Vec::new(), Vec::new());
    let default = bn_render::kernel(KERNEL).expect("in the list");
    let reference = subject.reference(default)?;
    for method in METHODS {
        let set = points(method.name, n)?;
        let case = Case { pattern: method.name, kernel: default, set: &set, reference: &reference };
        patterns.push(curve(&case, method.name, &subject, effort, &mut rows)?);
    }
    let set = points(PATTERN, n)?;
    for &kernel in KERNELS {
        let reference = subject.reference(kernel)?;
        let case = Case { pattern: PATTERN, kernel, set: &set, reference: &reference };
        kernels.push(curve(&case, kernel.name(), &subject, effort, &mut rows)?);
    }
    let diagram = |title: &str, curves: &[Curve]| Diagram {
        title: title.to_owned(),
        x: "time / s",
        y: "PSNR / dB",
        curves: curves.to_vec(),
    };
    let mut diagrams: Vec<_> =
        patterns.chunks(6).map(|curves| diagram("patterns, lanczos2", curves)).collect();
    diagrams.extend(kernels.chunks(5).map(|curves| diagram("kernels, jittered", curves)));
    Ok(Chapter {
        id: "rendering",
        title: "Rendering",
        method: format!(
            "A zone plate up to 0.9 cycles per pixel on {0} × {0} pixels, normalised by density, all \
             threads, the pattern ({n} points) made before. The error is that against the scene's \
             convolution with the same kernel, by quadrature.",
            subject.frame.width()
        ),
        columns: &["pattern", "kernel", "spp", "time / s", "samples / s", "PSNR / dB", "runs"],
        rows,
        diagrams,
    })
}

fn points(method: &str, n: usize) -> Outcome<PointSet> {
    let sampler = bn_samplers::find(method).map_err(Failure::failed)?.with_options([]);
    let sample = sampler.map_err(Failure::failed)?.sample(n, Seed::new(SEED), &Unobserved);
    Ok(sample.map_err(|error| Failure::failed(anyhow::anyhow!("{method}: {error}")))?.points)
}

/// What is rendered how, and held against what.
struct Case<'a> {
    pattern: &'a str,
    kernel: &'static dyn Kernel,
    set: &'a PointSet,
    reference: &'a Image,
}

/// Seconds and PSNR at all rates; a row for each.
fn curve(
    case: &Case<'_>,
    name: &str,
    subject: &Subject,
    effort: Effort,
    rows: &mut Vec<Vec<Value>>,
) -> Outcome<Curve> {
    let table = KernelTable::new(case.kernel);
    let mut points = Vec::new();
    for &rate in if effort.quick { &RATES[..2] } else { &RATES[..] } {
        let pattern = Pattern::tiled(case.set, rate).map_err(Failure::failed)?;
        let renderer =
            Renderer::new(&subject.plate, &pattern, &table, Normalization::Density, &subject.frame);
        let (image, stats) = renderer.image().map_err(Failure::failed)?;
        let timing = effort.budget.median(|| {
            black_box(renderer.image().is_ok());
        });
        let mse = mean_square_error(&image, case.reference).map_err(Failure::failed)?;
        let psnr = peak_signal_to_noise(mse);
        rows.push(vec![
            case.pattern.into(),
            case.kernel.name().into(),
            rate.into(),
            timing.seconds.into(),
            (stats.samples as f64 / timing.seconds).into(),
            psnr.into(),
            timing.runs.into(),
        ]);
        points.push([timing.seconds, psnr]);
    }
    Ok(Curve { name: name.to_owned(), points })
}
