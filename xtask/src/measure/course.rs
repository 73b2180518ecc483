//! The course of a run: how what it makes gets better with time.

use std::ops::ControlFlow;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use bn_cli::{Failure, Outcome};
use bn_core::{DVec2, Observer, PointSet, Progress, Seed};
use bn_samplers::Sampler;

/// A moment of a run.
#[derive(Clone, Debug)]
pub(crate) struct Moment {
    /// Iterations done.
    pub(crate) iteration: u64,
    /// Time since the start of the run, without what watching it took.
    pub(crate) seconds: f64,
    /// The points as they were.
    pub(crate) points: PointSet,
}

/// The moments of one run: all iterations to the tenth, then some ten between each and its double;
/// the last in any case.
pub(crate) fn follow(sampler: &dyn Sampler, n: usize, seed: Seed) -> Outcome<Vec<Moment>> {
    let watch = Watch::new();
    let sample = sampler.sample(n, seed, &watch).map_err(Failure::failed)?;
    let mut tape = watch.tape.into_inner().expect("no run panicked");
    let seconds = tape.running_time().as_secs_f64();
    if tape.moments.last().is_none_or(|last| last.points != sample.points) {
        let iteration = tape.iteration;
        tape.moments.push(Moment { iteration, seconds, points: sample.points });
    }
    Ok(tape.moments)
}

/// Records a run.
struct Watch {
    tape: Mutex<Tape>,
}

struct Tape {
    start: Instant,
    /// Time spent on recording.
    spent: Duration,
    moments: Vec<Moment>,
    /// The latest iteration.
    iteration: u64,
    /// The next iteration to be recorded.
    next: u64,
}

impl Watch {
    fn new() -> Self {
        let (start, spent) = (Instant::now(), Duration::ZERO);
        let tape = Tape { start, spent, moments: Vec::new(), iteration: 0, next: 0 };
        Self { tape: Mutex::new(tape) }
    }
}

impl Tape {
    fn running_time(&self) -> Duration {
        self.start.elapsed().saturating_sub(self.spent)
    }
}

impl Observer for Watch {
    fn observe(&self, _: &Progress<'_>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    fn iterated(&self, iteration: u64, points: &dyn Fn() -> Vec<DVec2>) {
        let mut tape = self.tape.lock().expect("no run panicked");
        tape.iteration = iteration;
        if iteration < tape.next {
            return;
        }
        let now = Instant::now();
        let seconds = tape.running_time().as_secs_f64();
        let points = PointSet::new(points()).expect("methods keep points on the torus");
        tape.moments.push(Moment { iteration, seconds, points });
        tape.next = iteration + 1 + iteration / 10;
        tape.spent += now.elapsed();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_samplers::Lloyd;

    #[test]
    fn moments_grow_apart_and_reach_the_end() {
        let method = Lloyd { iterations: 100, ..Default::default() };
        let moments = follow(&method, 50, Seed::new(1)).expect("valid");
        let iterations: Vec<u64> = moments.iter().map(|moment| moment.iteration).collect();
        assert_eq!(iterations[..12], [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12]);
        assert_eq!(iterations.last(), Some(&100));
        assert!(iterations.len() < 40, "{iterations:?}");
        assert!(moments.windows(2).all(|pair| pair[0].seconds <= pair[1].seconds));
        let whole = method.sample(50, Seed::new(1), &bn_core::Unobserved).expect("valid");
        assert_eq!(moments.last().expect("some").points, whole.points);
    }
}
