//! How long something takes.

use std::time::{Duration, Instant};

/// Runs of one thing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Timing {
    /// The median time of a run.
    pub(super) seconds: f64,
    /// Number of runs.
    pub(super) runs: usize,
}

/// How much time one figure may take.
#[derive(Clone, Copy, Debug)]
pub(super) struct Budget {
    /// Runs are repeated until they took this long together …
    pub(super) time: Duration,
    /// … or this many are done.
    pub(super) runs: usize,
}

impl Budget {
    /// Enough for a median that repeats within a few per cent on a quiet machine; a fifth of that
    /// if `quick`.
    pub(super) fn new(quick: bool) -> Self {
        Self { time: Duration::from_millis(if quick { 50 } else { 250 }), runs: 1001 }
    }

    /// The median time of `run`, after one run that warms caches and buffers; of that one alone if
    /// it used up the time.
    pub(super) fn median(self, mut run: impl FnMut()) -> Timing {
        let mut time = || {
            let start = Instant::now();
            run();
            start.elapsed()
        };
        let start = Instant::now();
        let first = time();
        if start.elapsed() >= self.time {
            return Timing { seconds: first.as_secs_f64(), runs: 1 };
        }
        let mut times = Vec::new();
        let start = Instant::now();
        while times.is_empty() || (times.len() < self.runs && start.elapsed() < self.time) {
            times.push(time());
        }
        times.sort_unstable();
        Timing { seconds: times[times.len() / 2].as_secs_f64(), runs: times.len() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_bounded_by_count_and_time() {
        let count = |budget: Budget, pause| {
            let mut runs = 0;
            let timing = budget.median(|| {
                runs += 1;
                std::thread::sleep(Duration::from_millis(pause));
            });
            assert!(timing.seconds >= pause as f64 / 1e3);
            (runs, timing.runs)
        };
        assert_eq!(count(Budget { time: Duration::from_secs(60), runs: 3 }, 1), (4, 3));
        assert_eq!(count(Budget { time: Duration::from_millis(1), runs: 9 }, 2), (1, 1));
    }
}
