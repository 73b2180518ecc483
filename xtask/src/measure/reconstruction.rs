//! What chapter 6 leaves open: convolution against iterative reconstruction, in error and in time.

use std::time::Instant;

use bn_cli::{Failure, Outcome};
use bn_core::{PointSet, Unobserved};
use bn_geometry::{Coverage, Triangulation, voronoi_cells};
use bn_render::{
    BandLimitedMethod, BandLimitedOptions, BandLimitedRenderer, Frame, Image, Kernel, KernelTable,
    LimitedZonePlate, LowPass, Normalization, Pattern, Renderer, Scene, SphereScene, Stopping,
    exact_convolution, mean_square_error, peak_signal_to_noise,
};

/// The patterns that are compared.
pub(crate) const PATTERNS: [&str; 5] = ["stochastic", "jittered", "fpo", "cccvt", "step"];

/// The kernel of the convolutions, and after the iterations: the thesis's.
fn kernel() -> &'static dyn Kernel {
    bn_render::kernel("lanczos2").expect("in the list")
}

/// When iterations end: at 80 dB nobody sees a residual of 1e-4.
const STOPPING: Stopping = Stopping { iterations: 30, tolerance: 1e-4 };

/// How samples become pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    Convolution { normalization: Normalization, voronoi: bool },
    Fit(BandLimitedMethod),
}

impl Way {
    pub(crate) const ALL: [Self; 6] = [
        Self::Convolution { normalization: Normalization::None, voronoi: false },
        Self::Convolution { normalization: Normalization::Density, voronoi: false },
        Self::Convolution { normalization: Normalization::None, voronoi: true },
        Self::Convolution { normalization: Normalization::Density, voronoi: true },
        Self::Fit(BandLimitedMethod::Act),
        Self::Fit(BandLimitedMethod::Pocs),
    ];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Convolution { normalization: Normalization::None, voronoi: false } => "plain",
            Self::Convolution { voronoi: false, .. } => "normalised",
            Self::Convolution { normalization: Normalization::None, .. } => "Voronoi",
            Self::Convolution { .. } => "Voronoi, normalised",
            Self::Fit(BandLimitedMethod::Act) => "ACT",
            Self::Fit(BandLimitedMethod::Pocs) => "POCS",
        }
    }
}

/// A point set and what is known of its cells.
pub(crate) struct Cells {
    set: PointSet,
    areas: Vec<f64>,
    /// `R_c` over `d_hex`.
    pub(crate) coverage: f64,
}

impl Cells {
    pub(crate) fn of(set: &PointSet) -> Self {
        let triangulation = Triangulation::new(set);
        let areas = voronoi_cells(&triangulation).iter().map(|cell| cell.area.max(0.0)).collect();
        let coverage = Coverage::of(&triangulation).map_or(f64::NAN, |coverage| coverage.radius);
        let coverage = set.density().normalize_distance(coverage).value();
        Self { set: set.clone(), areas, coverage }
    }

    fn pattern(&self, samples_per_pixel: f64, voronoi: bool) -> Outcome<Pattern> {
        let pattern = if voronoi {
            Pattern::weighted(&self.set, &self.areas, samples_per_pixel)
        } else {
            Pattern::tiled(&self.set, samples_per_pixel)
        };
        pattern.map_err(Failure::failed)
    }
}

/// A scene with its convolution by quadrature.
pub(crate) struct Subject {
    pub(crate) name: &'static str,
    scene: Box<dyn Scene>,
    frame: Frame,
    reference: Image,
}

/// One image.
pub(crate) struct Made {
    pub(crate) image: Image,
    /// Against the convolution of the scene with the kernel.
    pub(crate) psnr: f64,
    pub(crate) seconds: f64,
}

impl Subject {
    /// What the scenes of [`Subject::both`] are called.
    pub(crate) const NAMES: [&str; 2] = ["zone plate up to 0.4 cycles per pixel", "sphere scene"];

    /// One scene with a band, one with edges, at so many pixels a side.
    pub(crate) fn both(side: u32) -> Outcome<[Self; 2]> {
        let frame = Frame::new(side, side).map_err(Failure::failed)?;
        let plate = LimitedZonePlate::new(&frame, 0.4, 0.5 * f64::from(side));
        Ok([
            Self::new(Self::NAMES[0], Box::new(plate), frame)?,
            Self::new(Self::NAMES[1], Box::new(SphereScene::new(&frame, 1.0)), frame)?,
        ])
    }

    fn new(name: &'static str, scene: Box<dyn Scene>, frame: Frame) -> Outcome<Self> {
        let made = exact_convolution(&*scene, kernel(), &frame, 1e-6, &Unobserved)
            .map_err(Failure::failed)?;
        Ok(Self { name, scene, frame, reference: made.image })
    }

    /// The scene by these points in this way.
    pub(crate) fn image(&self, cells: &Cells, samples_per_pixel: f64, way: Way) -> Outcome<Made> {
        let voronoi = matches!(way, Way::Fit(_) | Way::Convolution { voronoi: true, .. });
        let pattern = cells.pattern(samples_per_pixel, voronoi)?;
        let start = Instant::now();
        let image = match way {
            Way::Convolution { normalization, .. } => {
                let table = KernelTable::new(kernel());
                let renderer =
                    Renderer::new(&*self.scene, &pattern, &table, normalization, &self.frame);
                renderer.image().map_err(Failure::failed)?.0
            }
            Way::Fit(method) => {
                let options =
                    BandLimitedOptions { method, stopping: STOPPING, ..Default::default() };
                let renderer = BandLimitedRenderer {
                    scene: &*self.scene,
                    pattern: &pattern,
                    low_pass: LowPass::Kernel(kernel()),
                    frame: self.frame,
                    options,
                };
                renderer.image(&Unobserved).map_err(Failure::failed)?.0
            }
        };
        let seconds = start.elapsed().as_secs_f64();
        let mse = mean_square_error(&image, &self.reference).map_err(Failure::failed)?;
        Ok(Made { image, psnr: peak_signal_to_noise(mse), seconds })
    }
}
