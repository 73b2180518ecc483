//! How long work tells where it stands, and learns that it should stop.

use std::ops::ControlFlow;

use glam::DVec2;

/// Where a long computation stands.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Progress<'a> {
    /// What is being done, in one or two words: `"relaxing"`, `"throwing darts"`.
    pub stage: &'a str,
    /// Steps done in this stage: iterations, points, rows.
    pub done: u64,
    /// Steps of this stage in all, where that is known beforehand.
    pub total: Option<u64>,
    /// Figures of merit by name, such as `("d_min", 0.91)`.
    pub figures: &'a [(&'a str, f64)],
}

impl<'a> Progress<'a> {
    /// `done` steps of `stage`, of which `total` are planned.
    pub fn new(stage: &'a str, done: u64, total: Option<u64>) -> Self {
        Self { stage, done, total, figures: &[] }
    }

    /// The same with figures of merit.
    #[must_use]
    pub fn with_figures(self, figures: &'a [(&'a str, f64)]) -> Self {
        Self { figures, ..self }
    }
}

/// Watches long work. Called a few times a second to a few thousand times, from any thread.
///
/// Returning [`ControlFlow::Break`] asks the work to stop as soon as it can; the work then
/// returns its own "cancelled" error. What is observed never changes a result.
pub trait Observer: Sync {
    /// Takes note of the progress and says whether to go on.
    fn observe(&self, progress: &Progress<'_>) -> ControlFlow<()>;

    /// Follows a method that moves points: called after each iteration, and with 0 before the
    /// first. `points` makes a copy of them, in the order in which they will be returned; who
    /// doesn't call it pays nothing, as by default.
    fn iterated(&self, iteration: u64, points: &dyn Fn() -> Vec<DVec2>) {
        let _ = (iteration, points);
    }
}

/// Watches nothing and never stops anything.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unobserved;

impl Observer for Unobserved {
    fn observe(&self, _: &Progress<'_>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}
