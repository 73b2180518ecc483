//! Capacity constraints: points whose cells all have the same area.

pub(crate) mod bnot;
pub(crate) mod cccvt;
mod discrete;
mod regularity;
mod relaxation;
mod samples;
mod swapping;
