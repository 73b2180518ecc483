//! Farthest-point optimisation: points move to the largest holes among the others.

mod arrangement;
mod blocks;
mod field;
mod options;
mod plug;
mod swarm;

use std::sync::Arc;

use bn_core::{
    DVec2, Density, DensityFunction, NormalizedDistance, Observer, PointSet, Progress, Seed,
};

use self::arrangement::{Arrangement, Moves, Search, Spread, Stages};
use self::blocks::Blocks;
use self::field::{Even, Field};
use self::plug::{Plugged, plug};
use self::swarm::{Order, Swarm};
use crate::common_options::uneven;
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
    /// Whether to close the holes that remain: `R_c` falls from 0.86 to 0.76 and `d_min` to 0.90, and
    /// little else changes.
    pub plug: bool,
    /// The density ϱ of the points, uniform if there is none. Distances are measured as
    /// |x − y|·(ϱ(x)·ϱ(y))^¼; with [`FpoUntil::Spacing`] the end comes when `d_avg` in this sense
    /// grows by less than 2·10⁻⁵ in an iteration at the latest.
    pub density: Option<Arc<DensityFunction>>,
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
    /// As [`FpoVariant::Hybrid`], but the largest hole of the block of the torus that the point is
    /// in. Needs no triangulation of the whole: independent blocks are worked on by all threads. In
    /// an iteration each block is triangulated once and its points are visited 16 times. Fewer than
    /// 905 points make one block: the torus. R. Chen and C. Gotsman, "Parallel blue-noise sampling by constrained farthest point
    /// optimization", Comput. Graph. Forum 31(5), 2012.
    Constrained,
}

/// When [`FarthestPointOptimization`] is done; at the latest when no point moved at all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FpoUntil {
    /// When no two points are nearer to each other than this.
    Spacing(NormalizedDistance),
    /// When no point moved by more than 10⁻⁶ `d_hex` in an iteration. From there on moves shrink
    /// geometrically, and `d_min` grows by some 10⁻⁵ in all; n = 4096 random points end at 0.931 to
    /// 0.933. For that [`FpoVariant::Hybrid`] goes through blocks as [`FpoVariant::Constrained`] does:
    /// points that are spread over the whole torus at once jam earlier, at 0.929 to 0.931.
    Converged,
}

impl Default for FarthestPointOptimization {
    fn default() -> Self {
        // Points written as f32 still have 0.925.
        let until = FpoUntil::Spacing(NormalizedDistance::new(0.9251));
        Self {
            variant: FpoVariant::default(),
            until,
            iterations: 10_000,
            start: FpoStart::Random,
            plug: false,
            density: None,
        }
    }
}

/// Iterations that the hybrid variant spends on blocks on the way to convergence: after four of them,
/// as after two or forty, all of ten sets of 4096 points end at a `d_min` of 0.9304 to 0.9328.
const BLOCK_PASSES: u32 = 4;

/// Ways in `d_hex` that count as none.
const STILL: f64 = 1e-6;

/// A gain of `d_avg` in an iteration that counts as none where the density is uneven: there `d_min`
/// ends between 0.5 and 0.9, as the density's slopes and edges let it, and `d_avg` at 0.92 to 0.93.
const SETTLED: f64 = 2e-5;

/// Sweeps over all points that the hybrid variant makes with the global search. Measured at
/// n = 4096, means of 6 seeds: 349, 99, 89, 95 and 91 sweeps in all after 0, 1, 2, 3 and 4 global
/// ones; 84 if all are. From 10⁵ points on a global sweep takes three times as long as a local one,
/// because its points move all over the memory.
const GLOBAL_SWEEPS: u32 = 2;

impl Sampler for FarthestPointOptimization {
    fn sample(&self, n: usize, seed: Seed, observer: &dyn Observer) -> Result<Sample, SampleError> {
        check_count(METHOD.name, n)?;
        let start = self.start(n, seed, observer)?;
        let order = Order::new(seed);
        match uneven(self.density.as_ref()) {
            Some(density) => self.optimize(&start, density, order, observer),
            None => self.optimize(&start, Even, order, observer),
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
            FpoStart::Random => {
                Stochastic { density: self.density.clone() }.sample(n, seed, observer)?.points
            }
            FpoStart::Points(points) => PointSet::clone(points),
            FpoStart::Method(method) => sample_by(method, n, seed, observer)?,
        };
        if start.len() == n {
            return Ok(start);
        }
        let reason = format!("there are {} points to start from, but {n} are wanted", start.len());
        Err(SampleError::InvalidOption { option: "initial", reason })
    }

    fn optimize<F: Field + Clone + Sync>(
        &self,
        start: &PointSet,
        field: F,
        order: Order,
        observer: &dyn Observer,
    ) -> Result<Sample, SampleError> {
        let (n, points) = (start.len(), start.points());
        let passes = if Blocks::<F>::can_divide(n) { self.block_passes() } else { 0 };
        let arrangement = match passes {
            0 => Stages::Whole(Box::new(Swarm::new(points, field, order))),
            passes => Stages::Blocks(Blocks::new(points, field, order), passes),
        };
        self.iterate(n, arrangement, observer)
    }

    fn iterate(
        &self,
        n: usize,
        mut arrangement: impl Arrangement,
        observer: &dyn Observer,
    ) -> Result<Sample, SampleError> {
        let (mut done, mut moves) = (0, Moves { count: n, longest: f64::INFINITY });
        let mut d_avg_before = f64::NEG_INFINITY;
        loop {
            let points = || arrangement.points();
            let spread = arrangement.spread();
            let mut state = State::new(spread, n, done, moves);
            state.gain = state.d_avg.value() - d_avg_before;
            d_avg_before = state.d_avg.value();
            state.tell(self.iterations, observer)?;
            observer.iterated(done.into(), &points);
            if self.is_done(&state) || done == self.iterations {
                return Ok(self.finish(points(), &state));
            }
            moves = arrangement.sweep(self.search(done), spread.min);
            done += 1;
        }
    }

    /// Iterations to be spent on blocks.
    fn block_passes(&self) -> u32 {
        match (self.variant, self.until) {
            (FpoVariant::Constrained, _) => u32::MAX,
            (FpoVariant::Hybrid, FpoUntil::Converged) => BLOCK_PASSES,
            _ => 0,
        }
    }

    fn search(&self, sweep: u32) -> Search {
        match self.variant {
            FpoVariant::Global => Search::Global,
            FpoVariant::Hybrid | FpoVariant::Constrained if sweep < GLOBAL_SWEEPS => Search::Global,
            FpoVariant::Local | FpoVariant::Hybrid | FpoVariant::Constrained => Search::Local,
        }
    }

    /// Whether the goal is reached, or no further iteration would change anything.
    fn is_done(&self, state: &State) -> bool {
        state.moved == 0 || self.is_reached(state)
    }

    fn is_reached(&self, state: &State) -> bool {
        match self.until {
            FpoUntil::Spacing(target) => {
                state.d_min >= target
                    || (uneven(self.density.as_ref()).is_some() && state.gain < SETTLED)
            }
            FpoUntil::Converged => state.longest.value() <= STILL,
        }
    }

    /// The sample of the points as they ended, perhaps without their holes.
    fn finish(&self, points: Vec<DVec2>, state: &State) -> Sample {
        let report = Report::new().with("iterations", u64::from(state.done));
        let (points, [d_min, d_avg], report) = if self.plug {
            let Plugged { points, steps, distances, hole, is_tight } = plug(points);
            let report = report.with("plugging_steps", u64::from(steps)).with("largest_hole", hole);
            let note = "holes remain: start from a pattern nearer to its end";
            (points, distances, if is_tight { report } else { report.with_note(note) })
        } else {
            (points, [state.d_min.value(), state.d_avg.value()], report)
        };
        let report = report
            .with("d_min", d_min)
            .with("d_avg", d_avg)
            .with("converged", self.is_reached(state));
        Sample::new(points, self.with_shortfall(report, state))
    }

    /// The report with a note if the goal was not reached.
    fn with_shortfall(&self, report: Report, state: &State) -> Report {
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
    /// The longest way of a point in the last iteration.
    longest: NormalizedDistance,
    /// By how much `d_avg` grew in the last iteration.
    gain: f64,
    d_min: NormalizedDistance,
    d_avg: NormalizedDistance,
}

impl State {
    fn new(spread: Spread, n: usize, done: u32, moves: Moves) -> Self {
        let density = Density::new(n);
        Self {
            done,
            moved: moves.count,
            longest: density.normalize_distance(moves.longest),
            gain: f64::INFINITY,
            d_min: density.normalize_distance(spread.min),
            d_avg: density.normalize_distance(spread.mean),
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
