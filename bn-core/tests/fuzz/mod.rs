//! What the fuzz tests are made of.

pub mod allocation;
pub mod cases;
