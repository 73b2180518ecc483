//! Properties of figures and report pages, seen from outside the crate.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod ticks;

#[cfg(feature = "report")]
mod document;
#[cfg(feature = "report")]
mod pages;
#[cfg(feature = "report")]
mod report;
