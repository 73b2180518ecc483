//! `bn` as scripts call it.

#![expect(clippy::unwrap_used, reason = "a test that can't go on should stop")]

mod adaptive;
mod analyze;
mod folder;
mod generate;
mod matching;
mod reconstruction;
mod render;
mod report;
