//! Asking an observer, from within parallel work, whether to go on.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use bn_core::{Observer, Progress};

/// Samples that a thread takes before it asks again: some tens of milliseconds.
const SAMPLES: usize = 1 << 20;

/// An observer, and what it knows of the work so far.
pub(crate) struct Watch<'a> {
    observer: &'a dyn Observer,
    done: AtomicU64,
    total: u64,
    stopped: AtomicBool,
}

/// A thread's samples since it asked.
#[derive(Default)]
pub(crate) struct Turn(usize);

impl<'a> Watch<'a> {
    /// A watch over `total` steps of rendering.
    pub(crate) fn new(observer: &'a dyn Observer, total: u64) -> Self {
        Self { observer, done: AtomicU64::new(0), total, stopped: AtomicBool::new(false) }
    }

    /// Tells that so many steps are done; whether to go on.
    pub(crate) fn reached(&self, done: u64) -> bool {
        self.done.store(done, Ordering::Relaxed);
        self.goes_on()
    }

    /// Adds to the steps that are done.
    pub(crate) fn advanced(&self, steps: usize) {
        self.done.fetch_add(steps as u64, Ordering::Relaxed);
    }

    /// Tells that a thread took so many samples more, and asks now and then; whether to go on.
    pub(crate) fn took(&self, samples: usize, turn: &mut Turn) -> bool {
        turn.0 += samples;
        if turn.0 < SAMPLES {
            return !self.is_stopped();
        }
        turn.0 = 0;
        self.goes_on()
    }

    /// Whether the observer has asked to stop.
    pub(crate) fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    fn goes_on(&self) -> bool {
        let done = self.done.load(Ordering::Relaxed);
        let progress = Progress::new("rendering", done, Some(self.total));
        if self.observer.observe(&progress) == ControlFlow::Break(()) {
            self.stopped.store(true, Ordering::Relaxed);
        }
        !self.is_stopped()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    /// Notes what it is told and stops at the given number of calls.
    struct Stops(Mutex<Vec<u64>>, usize);

    impl Observer for Stops {
        fn observe(&self, progress: &Progress<'_>) -> ControlFlow<()> {
            let mut told = self.0.lock().expect("no panic");
            told.push(progress.done);
            if told.len() >= self.1 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        }
    }

    #[test]
    fn a_watch_asks_after_so_many_samples_and_remembers_the_answer() {
        let observer = Stops(Mutex::default(), 3);
        let (watch, mut turn) = (Watch::new(&observer, 9), Turn::default());
        assert!(watch.reached(4));
        assert!(watch.took(SAMPLES - 1, &mut turn));
        assert!(watch.took(1, &mut turn) && watch.took(5, &mut turn));
        assert!(!watch.took(SAMPLES, &mut turn) && watch.is_stopped());
        assert!(!watch.took(1, &mut turn));
        assert_eq!(*observer.0.lock().expect("no panic"), [4, 4, 4]);
    }
}
