//! The public geometry, against brute force, other programs and itself.

mod common;
mod measures;
mod power;
mod power_balance;
mod power_density;
mod reference;
mod relocation;
mod spade;
mod triangulation;
