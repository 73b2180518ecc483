//! Capacity constraints: points whose cells all have the same area.

pub(crate) mod cccvt;
mod relaxation;
