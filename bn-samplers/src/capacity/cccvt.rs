//! Capacity-constrained centroidal Voronoi tessellations.

use std::sync::Arc;

use bn_core::{DensityFunction, NormalizedDistance, Observer, Progress, Seed};

use super::relaxation::{LOOSE, Relaxation};
use super::swapping;
use crate::common_options::{DENSITY_OPTION, check_tolerance, iterations, tolerance, uneven};
use crate::error::{check_count, observe};
use crate::{
    CountRule, DefaultValue, Method, OptionError, OptionKind, OptionSpec, PointOrder, Report,
    Sample, SampleError, Sampler, Stochastic,
};

/// Random points, each moved to the centroid of its cell over and over, where the cells are those of
/// the power diagram that gives every point the same area: Lloyd's method under a capacity
/// constraint, stopped before patches of the hexagonal lattice grow.
///
/// Cells of equal area keep the pattern irregular for long, and suppress low frequencies better
/// than any other method of the thesis does. The cells are exact, the weights of the power diagram
/// found by Newton's method ([`bn_geometry::BalancedDiagram`]). The original method swaps samples of
/// the plane between points instead; it is there as `discrete`, with the acceleration of H. Li,
/// D. Nehab, L.-Y. Wei, P. V. Sander and C.-W. Fu, "Fast capacity constrained Voronoi tessellation",
/// I3D 2010 (nearby samples together from the start, only pairs of points in reach of each other,
/// no heaps), from coarse samples to fine ones, and with points that swing around their centroids.
///
/// Each iteration lowers the energy n·Σ ∫ |x − xⱼ|². The pattern's
/// statistics are functions of how far that has gone: the default tolerance is where they are those
/// of the thesis's table, after some 12 iterations at any n.
///
/// Thesis p. 113; M. Balzer, T. Schlömer and O. Deussen, "Capacity-constrained point distributions: a
/// variant of Lloyd's method", ACM Trans. Graph. 28(3), 2009. O(n^1.5) an iteration, for the
/// linear systems; some 25 ms on one core at 4096 points.
///
/// With a density, the continuous method gives cells equal masses instead of equal areas.
#[derive(Clone, Debug, PartialEq)]
pub struct Cccvt {
    /// The most iterations.
    pub iterations: u32,
    /// Stop when the root mean square distance of points to their cells' centroids is below this,
    /// in the discrete method below a tenth of it.
    pub tolerance: NormalizedDistance,
    /// Give each point samples of the plane by swaps, as the original method does, instead of a
    /// cell of the power diagram.
    pub discrete: bool,
    /// How many samples each point has then.
    pub samples_per_site: u32,
    /// The density of the points, uniform if there is none; for the continuous method.
    pub density: Option<Arc<DensityFunction>>,
}

impl Default for Cccvt {
    fn default() -> Self {
        let tolerance = NormalizedDistance::new(0.0108);
        Self { iterations: 1000, tolerance, discrete: false, samples_per_site: 1024, density: None }
    }
}

/// The registry's entry.
pub(crate) const METHOD: Method = Method {
    name: "cccvt",
    aliases: &["ccvt", "capacity-constrained"],
    summary: "points at the centroids of power cells of equal area",
    page: Some(113),
    citation: "M. Balzer, T. Schlömer, O. Deussen, Capacity-constrained point distributions: a variant of Lloyd's method, ACM Trans. Graph. 28(3), 2009",
    complexity: "O(n^1.5) an iteration",
    order: PointOrder::Random,
    counts: CountRule::Any,
    seeded: true,
    options: &[
        iterations("1000"),
        tolerance(
            "0.0108",
            "stop when points are nearer to their cells' centroids, root mean square",
        ),
        OptionSpec {
            name: "discrete",
            kind: OptionKind::Flag,
            default: DefaultValue::Value("false"),
            help: "swap samples of the plane between points, as the original method does",
            unit: "",
        },
        OptionSpec {
            name: "samples-per-site",
            kind: OptionKind::Integer { min: 1, max: 65_536 },
            default: DefaultValue::Value("1024"),
            help: "samples that each point has in the discrete method",
            unit: "",
        },
        DENSITY_OPTION,
    ],
    build: |options| {
        let density = options.density("density");
        if options.flag("discrete") && density.is_some() {
            let reason = "samples are spread evenly; leave out --discrete".to_owned();
            return Err(OptionError::Conflict { option: "density", reason });
        }
        Ok(Box::new(Cccvt {
            iterations: options.count("iterations"),
            tolerance: options.distance("tolerance"),
            discrete: options.flag("discrete"),
            samples_per_site: options.count("samples-per-site"),
            density,
        }))
    },
    version: 2,
};

/// Areas are equal to this in the end, relative to 1/n.
const EXACT: f64 = 1e-9;

impl Sampler for Cccvt {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        check_count(METHOD.name, n)?;
        check_tolerance(self.tolerance)?;
        let density = uneven(self.density.as_ref());
        if self.discrete && density.is_some() {
            let reason = "the discrete method spreads its samples evenly".to_owned();
            return Err(SampleError::InvalidOption { option: "density", reason });
        }
        let start = Stochastic { density: density.clone() }.sample(n, seed, observer)?.points;
        if self.discrete {
            swapping::swap(self, &start, observer)
        } else {
            self.relax(Relaxation::new(&start, density.as_deref()), observer)
        }
    }
}

impl Cccvt {
    /// The continuous method.
    fn relax(
        &self,
        mut relaxation: Relaxation,
        observer: &dyn Observer,
    ) -> Result<Sample, SampleError> {
        let mut done = 0;
        relaxation.balance(LOOSE);
        observer.iterated(0, &|| relaxation.points());
        while relaxation.unrest() > self.tolerance && done < self.iterations {
            let figures =
                [("energy", relaxation.energy()), ("unrest", relaxation.unrest().value())];
            let progress = Progress::new("relaxing", done.into(), Some(self.iterations.into()));
            observe(observer, &progress.with_figures(&figures))?;
            relaxation.advance(1.0);
            relaxation.balance(LOOSE);
            done += 1;
            observer.iterated(done.into(), &|| relaxation.points());
        }
        let balance = relaxation.balance(EXACT);
        let unrest = relaxation.unrest();
        let report = Report::new()
            .with("iterations", u64::from(done))
            .with("energy", relaxation.energy())
            .with("unrest_d_hex", unrest.value())
            .with("residual", balance.residual)
            .with("converged", unrest <= self.tolerance && balance.converged);
        Ok(Sample::new(relaxation.points(), report))
    }
}
