//! From samples to pixels: convolution with a kernel, normalised by the density of samples or not.

mod accumulate;
mod adaptive;
mod band;
mod blocks;
mod cells;
mod grid_error;
mod renderer;

pub use adaptive::{AdaptiveBand, AdaptiveRenderer, AdaptiveStats, ProgressivePattern};
pub use grid_error::grid_error;
pub use renderer::{Band, Normalization, RenderError, RenderStats, Renderer};

/// Side of the blocks of pixels, and of samples, in which work is skipped; a power of 2 no smaller
/// than a kernel's diameter.
const BLOCK: i64 = 32;
