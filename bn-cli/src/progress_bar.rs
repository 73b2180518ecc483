//! Progress of long work on standard error, where that is a terminal.

use std::fmt::Write;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use bn_core::{Observer, Progress};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A bar with the stage, the steps done and the figures of merit.
pub(crate) struct Bar {
    bar: ProgressBar,
}

impl Bar {
    /// A bar on standard error; invisible if that is not a terminal or `quiet` is asked for.
    pub(crate) fn new(quiet: bool) -> Self {
        let target = if quiet {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr_with_hz(10)
        };
        let bar = ProgressBar::with_draw_target(None, target);
        bar.set_style(style("{spinner} {msg} {human_pos}"));
        Self { bar }
    }
}

fn style(template: &str) -> ProgressStyle {
    // The templates are constants of this file; a slip in one shows the plain bar.
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}

impl Bar {
    /// The bar as a sign of life, with the time that has passed: for work that counts no steps.
    pub(crate) fn working(&self, stage: String) {
        self.bar.set_style(style("{spinner} {msg} {elapsed}"));
        self.bar.set_message(stage);
        self.bar.enable_steady_tick(Duration::from_millis(200));
    }

    /// The bar as a counter of `total` pieces that finish in any order.
    pub(crate) fn counting(&self, stage: &'static str, total: u64) -> Counter<'_> {
        let counter = Counter { bar: self, stage, total, done: AtomicU64::new(0) };
        counter.show(0);
        counter
    }
}

/// Counts pieces of work that are done, on a [`Bar`].
pub(crate) struct Counter<'a> {
    bar: &'a Bar,
    stage: &'static str,
    total: u64,
    done: AtomicU64,
}

impl Counter<'_> {
    /// One more piece is done.
    pub(crate) fn step(&self) {
        self.show(self.done.fetch_add(1, Ordering::Relaxed) + 1);
    }

    fn show(&self, done: u64) {
        // The bar never asks to stop: an interrupt ends the process.
        let _ = self.bar.observe(&Progress::new(self.stage, done, Some(self.total)));
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// A figure of merit in few characters, however small or large.
fn figure(value: f64) -> String {
    match value.abs() {
        size if size != 0.0 && !(0.01..1e5).contains(&size) => format!("{value:.3e}"),
        _ => format!("{value:.4}"),
    }
}

impl Observer for Bar {
    fn observe(&self, progress: &Progress<'_>) -> ControlFlow<()> {
        if self.bar.is_hidden() {
            return ControlFlow::Continue(());
        }
        if self.bar.length() != progress.total {
            match progress.total {
                Some(total) => {
                    self.bar.set_style(style("{msg} [{bar:30}] {human_pos}/{human_len} {eta}"));
                    self.bar.set_length(total);
                }
                None => self.bar.set_style(style("{spinner} {msg} {human_pos}")),
            }
        }
        let mut message = progress.stage.to_owned();
        for (name, value) in progress.figures {
            // Writing to a string cannot fail.
            let _ = write!(message, " {name} {}", figure(*value));
        }
        self.bar.set_message(message);
        self.bar.set_position(progress.done);
        ControlFlow::Continue(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_keep_their_digits() {
        for (value, want) in [
            (0.0, "0.0000"),
            (0.65432, "0.6543"),
            (-12.5, "-12.5000"),
            (0.01, "0.0100"),
            (9.8765e-3, "9.876e-3"),
            (-4.2e-6, "-4.200e-6"),
            (123_456.0, "1.235e5"),
            (f64::NAN, "NaN"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(figure(value), want);
        }
    }
}
