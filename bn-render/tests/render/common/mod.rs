//! What several rooms' tests are made with.

mod areas;
mod nested_loops;
mod sets;
mod silent;

pub use areas::cell_areas;
pub use nested_loops::nested_loops;
pub use sets::{jittered_set, random_set};
pub use silent::Silent;
