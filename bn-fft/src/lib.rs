//! Fast Fourier transforms in single and double precision: `rustfft`, compiled once.
//!
//! The transforms of `rustfft` are generic, so every crate that plans one compiles all of them, for
//! each precision, which takes minutes. [`Planner`] has no generic functions: what plans through it
//! only links.
//!
//! ```
//! use bn_fft::{Complex, Planner};
//!
//! let fft = Planner::<f64>::new().forward(4);
//! let mut signal = [1.0, 2.0, 3.0, 4.0].map(|x| Complex::new(x, 0.0));
//! fft.process(&mut signal);
//! assert_eq!(signal[0].re, 10.0);
//! ```
//!
//! Invariant: no transform of its own.

use std::sync::Arc;

pub use rustfft::num_complex::Complex;
pub use rustfft::{Fft, FftNum, num_traits};

use rustfft::FftPlanner;

/// Plans unnormalised transforms, the fastest that this CPU has, and shares what lengths have in
/// common; for `f32` and `f64`.
///
/// Results have a relative l2 error of a few ε·√(log n) and differ in their last bits between CPUs.
pub struct Planner<T: FftNum>(FftPlanner<T>);

macro_rules! implement {
    ($($real:ty)*) => {$(
        impl Planner<$real> {
            /// A planner that has planned nothing yet.
            #[expect(clippy::new_without_default, reason = "nobody plans by default")]
            pub fn new() -> Self {
                Self(FftPlanner::new())
            }

            /// The transform with e^(−2πi jk/n) of n = `length` numbers.
            pub fn forward(&mut self, length: usize) -> Arc<dyn Fft<$real>> {
                self.0.plan_fft_forward(length)
            }

            /// The transform with e^(+2πi jk/n) of n = `length` numbers.
            pub fn inverse(&mut self, length: usize) -> Arc<dyn Fft<$real>> {
                self.0.plan_fft_inverse(length)
            }
        }
    )*};
}

implement!(f32 f64);
