//! The public renderer, against plain loops, closed forms and itself.

mod adaptive;
mod band_limited;
mod band_limited_images;
mod cancelling;
mod common;
mod grids;
mod images;
mod overflow;
mod pattern;
mod picture;
mod prediction;
mod renderer;
mod statistics;
mod supersampling;
mod weights;
