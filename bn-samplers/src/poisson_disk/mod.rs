//! Points that keep a minimum distance, thrown at random.

mod contest;
pub(crate) mod dart_throwing;
mod disk_grid;
pub(crate) mod maximal;
mod thrower;
mod tile;
mod uneven;
