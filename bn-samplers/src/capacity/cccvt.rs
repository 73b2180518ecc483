//! Capacity-constrained centroidal Voronoi tessellations.

use bn_core::{NormalizedDistance, Observer, Progress, Seed};

use super::relaxation::Relaxation;
use crate::error::{check_count, observe};
use crate::{
    CountRule, DefaultValue, Method, OptionKind, OptionSpec, PointOrder, Report, Sample,
    SampleError, Sampler, Stochastic,
};

/// Random points, each moved to the centroid of its cell over and over, where the cells are those of
/// the power diagram that gives every point the same area: Lloyd's method under a capacity
/// constraint, stopped before patches of the hexagonal lattice grow.
///
/// Cells of equal area keep the pattern irregular for long, and suppress low frequencies better
/// than any other method of the thesis does. The original moves
/// samples of the plane between sites; here the cells are exact, and the weights of the power diagram
/// are found by Newton's method ([`bn_geometry::BalancedDiagram`]).
///
/// Each iteration lowers the energy n·Σ ∫ |x − xⱼ|². The pattern's
/// statistics are functions of how far that has gone: the default tolerance is where they are those
/// of the thesis's table, after some 12 iterations at any n.
///
/// Thesis p. 113; M. Balzer, T. Schlömer and O. Deussen, "Capacity-constrained point distributions: a
/// variant of Lloyd's method", ACM Trans. Graph. 28(3), 2009. O(n^1.5) an iteration, for the
/// linear systems; 4 ms at 4096 points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cccvt {
    /// The most iterations.
    pub iterations: u32,
    /// Stop when the root mean square distance of points to their cells' centroids is below this.
    pub tolerance: NormalizedDistance,
}

impl Default for Cccvt {
    fn default() -> Self {
        Self { iterations: 1000, tolerance: NormalizedDistance::new(0.0108) }
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
        OptionSpec {
            name: "iterations",
            kind: OptionKind::Integer { min: 0, max: 1_000_000 },
            default: DefaultValue::Value("1000"),
            help: "the most iterations",
            unit: "",
        },
        OptionSpec {
            name: "tolerance",
            kind: OptionKind::Real { min: 0.0, max: 1.0 },
            default: DefaultValue::Value("0.0108"),
            help: "stop when points are nearer to their cells' centroids, root mean square",
            unit: "d_hex",
        },
    ],
    build: |options| {
        let defaults = Cccvt::default();
        let iterations = options.integer("iterations");
        let tolerance = options.real("tolerance").map(NormalizedDistance::new);
        Ok(Box::new(Cccvt {
            // The option's range ends below 2³².
            iterations: iterations.map_or(defaults.iterations, |count| count as u32),
            tolerance: tolerance.unwrap_or(defaults.tolerance),
        }))
    },
    version: 1,
};

/// Areas need to be no better than this, relative to 1/n, for centroids to move towards.
const LOOSE: f64 = 1e-3;

/// Areas are equal to this in the end, relative to 1/n.
const EXACT: f64 = 1e-9;

impl Sampler for Cccvt {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        check_count(METHOD.name, n)?;
        if !(0.0..f64::INFINITY).contains(&self.tolerance.value()) {
            let reason = format!("{} is not a distance", self.tolerance);
            return Err(SampleError::InvalidOption { option: "tolerance", reason });
        }
        let start = Stochastic::default().sample(n, seed, observer)?.points;
        let mut relaxation = Relaxation::new(&start);
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
