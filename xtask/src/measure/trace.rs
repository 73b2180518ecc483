//! How many iterations a method takes to spread points so far.

use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use bn_cli::{Failure, Outcome};
use bn_core::{DVec2, Observer, PointSet, Progress, Seed};
use bn_geometry::Spacing;
use bn_samplers::SampleError;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::store::Notes;
use super::{Plan, Store};
use crate::thesis::RowSpec;

/// The levels of `d_min` and `d_avg`, over `d_hex`.
pub(crate) const LEVELS: [f64; 8] = [0.75, 0.775, 0.8, 0.825, 0.85, 0.875, 0.9, 0.925];

/// Runs end after this many iterations, as the thesis's did.
pub(crate) const MOST_ITERATIONS: u64 = 1000;

/// The iteration at which one run reached each level of [`LEVELS`] first.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Reached {
    pub(crate) d_min: [Option<u64>; LEVELS.len()],
    pub(crate) d_avg: [Option<u64>; LEVELS.len()],
}

/// The runs of a row's method from `plan.sets` random sets; kept in `store`.
pub(crate) fn runs(row: &RowSpec, plan: Plan, store: Option<&Store>) -> Outcome<Vec<Reached>> {
    let method = row.method().ok_or_else(|| Failure::misuse("no such method"))?;
    let options = row.options.iter().map(|(name, value)| (&**name, &**value));
    let sampler = method.with_options(options).map_err(Failure::usage)?;
    let one = |set: u32| {
        let place = store.map(|store| store.place(method, row, plan, set).trace());
        if let Some(reached) = place.as_ref().and_then(Notes::read) {
            return Ok(reached);
        }
        let trace = Trace::default();
        match sampler.sample(plan.n, Seed::new(plan.seed).for_set(set), &trace) {
            Ok(_) | Err(SampleError::Cancelled) => {}
            Err(error) => return Err(Failure::failed(error)),
        }
        let reached = trace.reached.into_inner().expect("no run panicked");
        if let Some(place) = place {
            place.write(&reached)?;
        }
        Ok(reached)
    };
    (0..plan.sets).into_par_iter().map(one).collect()
}

/// Watches one run and ends it when nothing more can be learnt.
#[derive(Debug, Default)]
struct Trace {
    reached: Mutex<Reached>,
    done: AtomicBool,
}

impl Observer for Trace {
    fn observe(&self, _: &Progress<'_>) -> ControlFlow<()> {
        if self.done.load(Ordering::Relaxed) {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    fn iterated(&self, iteration: u64, points: &dyn Fn() -> Vec<DVec2>) {
        let points = PointSet::new(points()).expect("methods keep points on the torus");
        let spacing = Spacing::new(&points);
        let value = |distance| points.density().normalize_distance(distance).value();
        let mut reached = self.reached.lock().expect("no run panicked");
        let note = |slots: &mut [Option<u64>], distance: f64| {
            for (slot, level) in slots.iter_mut().zip(LEVELS) {
                if slot.is_none() && distance >= level {
                    *slot = Some(iteration);
                }
            }
        };
        note(&mut reached.d_min, value(spacing.min()));
        note(&mut reached.d_avg, value(spacing.mean()));
        let all = reached.d_min.iter().chain(&reached.d_avg).all(Option::is_some);
        self.done.store(all || iteration >= MOST_ITERATIONS, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_noted_once_and_the_run_ends_when_all_are_reached() {
        let grid = |side: u32| {
            let at = move |i: u32| DVec2::new(f64::from(i % side), f64::from(i / side));
            (0..side * side).map(|i| at(i) / f64::from(side)).collect::<Vec<_>>()
        };
        let trace = Trace::default();
        let progress = Progress::new("a test", 0, None);
        trace.iterated(0, &|| vec![DVec2::new(0.1, 0.1), DVec2::new(0.12, 0.1)]);
        assert_eq!(*trace.reached.lock().expect("free"), Reached::default());
        assert!(trace.observe(&progress).is_continue());
        // The square grid's spacing is 0.9306.
        trace.iterated(3, &|| grid(8));
        assert_eq!(trace.reached.lock().expect("free").d_min, [Some(3); LEVELS.len()]);
        assert!(trace.observe(&progress).is_break());
    }

    #[test]
    fn a_run_without_end_is_ended() {
        let trace = Trace::default();
        trace.iterated(MOST_ITERATIONS, &|| vec![DVec2::ZERO; 2]);
        assert!(trace.observe(&Progress::new("a test", 0, None)).is_break());
    }
}
