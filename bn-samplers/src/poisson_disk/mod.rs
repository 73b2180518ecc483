//! Points that keep a minimum distance, thrown at random.

pub(crate) mod dart_throwing;
mod disk_grid;
pub(crate) mod maximal;
mod thrower;
