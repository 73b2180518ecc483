//! Farthest-point optimisation: points move to the largest holes among the others.

mod options;
mod swarm;

use std::sync::Arc;

use bn_core::{Density, NormalizedDistance, Observer, PointSet, Progress, Seed};
use bn_geometry::Spacing;

use self::swarm::{Search, Swarm};
use crate::error::{check_count, observe};
use crate::{Method, Report, Sample, SampleError, Sampler, Stochastic};

pub(crate) use self::options::METHOD;

/// Farthest-point optimisation (FPO): in each iteration every point in turn moves to the place that
/// is farthest from all others, if it is farther from them there than where it is.
///
/// No distance between points ever falls below that to which a point moves, so `d_min` never falls,
/// the sorted list of all nearest-neighbour distances grows lexicographically, and the end is a
/// pattern that no single point can improve: `d_min` about 0.93, `d_avg` 0.93, isotropic, every hole
/// smaller than `d_min`. (That `d_avg` never falls, as §4.2.3 says, is not so.) Lattices are such
/// ends too, but a single defect makes them break up.
///
/// Thesis chapter 4 and p. 118; T. Schlömer, D. Heck and O. Deussen, "Farthest-point optimized point
/// sets with maximized minimum distance", High Performance Graphics 2011. Works on a dynamic
/// Delaunay triangulation of the torus in exact arithmetic. From n = 4096 random points it takes
/// some 90 iterations of O(n) to the default `d_min`; the first of them, where points move far, take
/// O(n log n).
#[derive(Clone, Debug)]
pub struct FarthestPointOptimization {
    /// Where points look for a place.
    pub variant: FpoVariant,
    /// When to stop.
    pub until: FpoUntil,
    /// The most iterations.
    pub iterations: u32,
    /// Where the points start.
    pub start: FpoStart,
}

/// Where the points of [`FarthestPointOptimization`] start.
#[derive(Clone, Debug, Default)]
pub enum FpoStart {
    /// Anywhere.
    #[default]
    Random,
    /// Here: as many points as are asked for.
    Points(Arc<PointSet>),
    /// Where this method places them by default, with the same seed.
    Method(&'static Method),
}

/// Where the points of [`FarthestPointOptimization`] look for a place. All end alike.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FpoVariant {
    /// The largest hole of all.
    Global,
    /// The largest hole among the triangles at the point's neighbours; takes some three times as
    /// many iterations from random points.
    Local,
    /// Twice the largest hole of all, then at the neighbours: as few iterations as
    /// [`FpoVariant::Global`], and faster ones where points are many.
    #[default]
    Hybrid,
}

/// When [`FarthestPointOptimization`] is done; at the latest when no point moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FpoUntil {
    /// When no two points are nearer to each other than this.
    Spacing(NormalizedDistance),
    /// When no point moved.
    Converged,
}

impl Default for FarthestPointOptimization {
    fn default() -> Self {
        // Points written as f32 still have 0.925.
        let until = FpoUntil::Spacing(NormalizedDistance::new(0.9251));
        Self { variant: FpoVariant::default(), until, iterations: 10_000, start: FpoStart::Random }
    }
}

/// Sweeps over all points that the hybrid variant makes with the global search. Measured at
/// n = 4096, means of 6 seeds: 349, 99, 89, 95 and 91 sweeps in all after 0, 1, 2, 3 and 4 global
/// ones; 84 if all are. From 10⁵ points on a global sweep takes three times as long as a local one,
/// because its points move all over the memory.
const GLOBAL_SWEEPS: u32 = 2;

impl Sampler for FarthestPointOptimization {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        check_count(METHOD.name, n)?;
        let start = self.start(n, seed, observer)?;
        let mut swarm = Swarm::new(&start, seed);
        let (mut done, mut moved) = (0, n);
        loop {
            let spacing = swarm.spacing();
            let state = State::new(&spacing, done, moved);
            state.tell(self.iterations, observer)?;
            observer.iterated(done.into(), &|| swarm.points());
            if self.is_done(&state) || done == self.iterations {
                return Ok(Sample::new(swarm.points(), self.report(&state)));
            }
            if self.variant == FpoVariant::Hybrid && done == GLOBAL_SWEEPS {
                swarm.stay_local();
            }
            swarm.settle(spacing.min());
            moved = swarm.sweep(self.search(done));
            done += 1;
        }
    }
}

impl FarthestPointOptimization {
    fn start(
        &self,
        n: usize,
        seed: Seed,
        observer: &dyn Observer,
    ) -> Result<PointSet, SampleError> {
        let start = match &self.start {
            FpoStart::Random => Stochastic::default().sample(n, seed, observer)?.points,
            FpoStart::Points(points) => PointSet::clone(points),
            FpoStart::Method(method) => sample_by(method, n, seed, observer)?,
        };
        if start.len() == n {
            return Ok(start);
        }
        let reason = format!("there are {} points to start from, but {n} are wanted", start.len());
        Err(SampleError::InvalidOption { option: "initial", reason })
    }

    fn search(&self, sweep: u32) -> Search {
        match self.variant {
            FpoVariant::Global => Search::Global,
            FpoVariant::Hybrid if sweep < GLOBAL_SWEEPS => Search::Global,
            FpoVariant::Hybrid | FpoVariant::Local => Search::Local,
        }
    }

    /// Whether the goal is reached, or no further iteration would change anything.
    fn is_done(&self, state: &State) -> bool {
        state.moved == 0 || self.is_reached(state)
    }

    fn is_reached(&self, state: &State) -> bool {
        match self.until {
            FpoUntil::Spacing(target) => state.d_min >= target,
            FpoUntil::Converged => state.moved == 0,
        }
    }

    fn report(&self, state: &State) -> Report {
        let report = Report::new()
            .with("iterations", u64::from(state.done))
            .with("d_min", state.d_min.value())
            .with("d_avg", state.d_avg.value())
            .with("converged", self.is_reached(state));
        match self.until {
            FpoUntil::Spacing(target) if !self.is_reached(state) => report.with_note(format!(
                "d_min is {:.4}, not {target}, after {} iterations",
                state.d_min.value(),
                state.done
            )),
            _ => report,
        }
    }
}

/// A pattern by a method's defaults.
fn sample_by(
    method: &Method,
    n: usize,
    seed: Seed,
    observer: &dyn Observer,
) -> Result<PointSet, SampleError> {
    let sampler = method.with_options([]).expect("every method can do without options");
    Ok(sampler.sample(n, seed, observer)?.points)
}

/// How far the optimisation has come.
struct State {
    done: u32,
    /// Points that moved in the last iteration; all before the first.
    moved: usize,
    d_min: NormalizedDistance,
    d_avg: NormalizedDistance,
}

impl State {
    fn new(spacing: &Spacing, done: u32, moved: usize) -> Self {
        let density = Density::new(spacing.nearest_distances().len());
        Self {
            done,
            moved,
            d_min: density.normalize_distance(spacing.min()),
            d_avg: density.normalize_distance(spacing.mean()),
        }
    }

    fn tell(&self, iterations: u32, observer: &dyn Observer) -> Result<(), SampleError> {
        let figures = [
            ("d_min", self.d_min.value()),
            ("d_avg", self.d_avg.value()),
            ("moved", self.moved as f64),
        ];
        let progress = Progress::new("optimizing", self.done.into(), Some(iterations.into()));
        observe(observer, &progress.with_figures(&figures))
    }
}
