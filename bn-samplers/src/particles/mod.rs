//! Points as particles that repel each other.

mod background;
pub(crate) mod electrostatic;
mod ewald;
pub(crate) mod kernel_density;
mod pair_forces;
