//! Reconstruction kernels: what a sample contributes to the pixels around it.

mod functions;
mod table;

use functions::{
    Bicubic, BlackmanSinc, Box, Gaussian, Lanczos2, Lanczos3, Lanczos4, Mitchell, Tent,
};
pub use table::KernelTable;

/// A separable reconstruction kernel r(x)·r(y), with x and y in pixels.
///
/// `x` is a pixel's centre minus a sample's place. The support is half-open, (−radius, radius], so
/// that a box has exactly one pixel for every sample.
pub trait Kernel: Send + Sync {
    /// The name on the command line.
    fn name(&self) -> &'static str;

    /// Half the width of the support in pixels: a multiple of ½, at most [`MAX_RADIUS`].
    ///
    /// Within the support, r may bend or jump only at whole distances from ±radius: the tables
    /// rely on smooth pieces in between.
    fn radius(&self) -> f64;

    /// r(x) = r(−x), save at jumps; 0 outside the support.
    fn value(&self, x: f64) -> f64;

    /// ∫ r(x) dx over the support, exact to rounding: what plain convolution divides by, squared.
    fn integral(&self) -> f64;
}

/// The largest radius of a kernel, in pixels.
pub const MAX_RADIUS: f64 = 8.0;

/// All kernels, in the order in which they are listed.
pub const KERNELS: &[&dyn Kernel] =
    &[&Box, &Tent, &Gaussian, &Mitchell, &Bicubic, &Lanczos2, &Lanczos3, &Lanczos4, &BlackmanSinc];

/// The kernel of this name.
pub fn kernel(name: &str) -> Option<&'static dyn Kernel> {
    KERNELS.iter().copied().find(|kernel| kernel.name() == name)
}
