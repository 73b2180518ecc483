//! The workbench for irregular sampling as a library: what the binary `bn` does, for programs that
//! want the same analysis, plots and reports as functions.
//!
//! - [`analysis`]: every statistic of a point set or an ensemble, each computed at most once and
//!   only if asked for;
//! - [`plot`] and [`report`]: figures as SVG (and PNG, with the feature `report`);
//! - [`input`], [`image_file`], [`density`]: point and image files, and density functions from
//!   images and formulas;
//! - [`output`]: files that appear whole or not at all;
//! - [`commands`]: the subcommands of `bn`.
//!
//! Invariant: what a statistic is, is defined in a lower crate; here are only its errors over the sets,
//! its units and its pictures. No value of the thesis's tables.

pub mod analysis;
pub mod commands;
mod curve_file;
pub mod density;
mod failure;
pub mod image_file;
pub mod input;
pub mod output;
pub mod output_points;
pub mod plot;
mod progress_bar;
pub mod report;

pub use failure::{Failure, Outcome};
