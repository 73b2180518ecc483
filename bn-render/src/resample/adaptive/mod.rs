//! Adaptive sampling: more samples where two layers of the same pattern make different images.

mod patches;
mod progressive;
mod renderer;
mod tile;

pub use progressive::ProgressivePattern;
pub use renderer::{AdaptiveBand, AdaptiveRenderer, AdaptiveStats};

/// Side of the tiles of pixels that are rendered each for itself.
const TILE: u32 = 128;

/// Side of the blocks that are refined as a whole, in pixels or cells of samples; a divisor of
/// [`TILE`].
const PATCH: i64 = 4;
