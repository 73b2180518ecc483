//! Capacity-constrained centroidal Voronoi tessellations.

use bn_core::{NormalizedDistance, Observer, PointSet, Progress, Seed};

use super::discrete::Assignment;
use super::relaxation::{LOOSE, Relaxation};
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
/// than any other method of the thesis does. The cells are exact, the weights of the power diagram
/// found by Newton's method ([`bn_geometry::BalancedDiagram`]). The original method swaps samples of
/// the plane between points instead; it is there as `discrete`, with the acceleration of H. Li,
/// D. Nehab, L.-Y. Wei, P. V. Sander and C.-W. Fu, "Fast capacity constrained Voronoi tessellation",
/// I3D 2010 (nearby samples together from the start, only pairs of points in reach of each other,
/// no heaps) and from coarse samples to fine ones.
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
    /// Stop when the root mean square distance of points to their cells' centroids is below this,
    /// in the discrete method below a fifth of it.
    pub tolerance: NormalizedDistance,
    /// Give each point samples of the plane by swaps, as the original method does, instead of a
    /// cell of the power diagram.
    pub discrete: bool,
    /// How many samples each point has then.
    pub samples_per_site: u32,
}

impl Default for Cccvt {
    fn default() -> Self {
        let tolerance = NormalizedDistance::new(0.0108);
        Self { iterations: 1000, tolerance, discrete: false, samples_per_site: 1024 }
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
    ],
    build: |options| {
        let defaults = Cccvt::default();
        let iterations = options.integer("iterations");
        let tolerance = options.real("tolerance").map(NormalizedDistance::new);
        Ok(Box::new(Cccvt {
            // The option's range ends below 2³².
            iterations: iterations.map_or(defaults.iterations, |count| count as u32),
            tolerance: tolerance.unwrap_or(defaults.tolerance),
            discrete: options.flag("discrete"),
            samples_per_site: options
                .integer("samples-per-site")
                .map_or(defaults.samples_per_site, |count| count as u32),
        }))
    },
    version: 1,
};

/// Samples that the discrete method can swap, 16 GB of them.
const MOST_SAMPLES: usize = 1 << 30;

/// Points begin to move when fewer than one in so many samples is swapped in a sweep.
const SETTLED: u64 = 100;

/// The discrete method's tolerance over the continuous one's: samples hold the borders of cells
/// in place until points have moved by a good part of a sample's width, so points are near their
/// centroids long before cells have their shapes.
const FINER: f64 = 0.2;

/// Sweeps without moves at each number of samples, at most.
const MOST_SWEEPS: u64 = 1000;

/// Points have at least so many samples when swaps begin, unless there are fewer in all.
const FEWEST: usize = 16;

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
        if self.discrete { self.swap(&start, observer) } else { self.relax(&start, observer) }
    }
}

impl Cccvt {
    /// The continuous method.
    fn relax(&self, start: &PointSet, observer: &dyn Observer) -> Result<Sample, SampleError> {
        let mut relaxation = Relaxation::new(start);
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
    /// The discrete method: swaps alone first, of few samples and then of four times as many until
    /// there are all, and then moves and swaps in turn.
    fn swap(&self, start: &PointSet, observer: &dyn Observer) -> Result<Sample, SampleError> {
        let capacity = self.samples_per_site as usize;
        let count = start.len().saturating_mul(capacity);
        if !(1..=MOST_SAMPLES).contains(&count) {
            let reason = format!("{count} samples in all, but 1 to {MOST_SAMPLES} are possible");
            return Err(SampleError::InvalidOption { option: "samples-per-site", reason });
        }
        let mut levels = 0;
        while capacity >> (2 * levels) >= 4 * FEWEST && (capacity >> (2 * levels)).is_multiple_of(4)
        {
            levels += 1;
        }
        let mut assignment = Assignment::new(start, capacity >> (2 * levels))?;
        observer.iterated(0, &|| assignment.sites().to_vec());
        let mut sweeps = 0;
        for level in 0..=levels {
            sweeps += settle(&mut assignment, count >> (2 * (levels - level)), observer)?;
            if level < levels {
                assignment.refine()?;
            }
        }
        let mut done = 0;
        let tolerance = NormalizedDistance::new(self.tolerance.value() * FINER);
        while done < self.iterations && assignment.unrest() > tolerance {
            let figures =
                [("energy", assignment.energy()), ("unrest", assignment.unrest().value())];
            let progress = Progress::new("moving", done.into(), Some(self.iterations.into()));
            observe(observer, &progress.with_figures(&figures))?;
            assignment.centre();
            assignment.sweep();
            done += 1;
            observer.iterated(done.into(), &|| assignment.sites().to_vec());
        }
        let unrest = assignment.unrest();
        let report = Report::new()
            .with("iterations", u64::from(done))
            .with("sweeps", sweeps + u64::from(done))
            .with("samples", count)
            .with("energy", assignment.energy())
            .with("unrest_d_hex", unrest.value())
            .with("converged", unrest <= tolerance);
        Ok(Sample::new(assignment.sites().to_vec(), report))
    }
}

/// Sweeps until few of `count` samples change their site; returns the number of sweeps.
fn settle(
    assignment: &mut Assignment,
    count: usize,
    observer: &dyn Observer,
) -> Result<u64, SampleError> {
    for sweep in 0..MOST_SWEEPS {
        observe(observer, &Progress::new("swapping", sweep, None))?;
        if assignment.sweep() * SETTLED <= count as u64 {
            return Ok(sweep + 1);
        }
    }
    Ok(MOST_SWEEPS)
}
