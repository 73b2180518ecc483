//! The two floating-point types a transform can compute in.

use std::sync::Arc;

use bn_fft::num_traits::NumAssign;
use bn_fft::{Fft, FftNum, Planner};

use super::batch::BatchTransform;
use super::simd::Simd;
use super::taps::{Gather, GatherGradient, Spread};
use super::transpose::{FromColumns, Scale, ToColumns};

/// `f64`, or `f32` where speed and memory count more than digits.
///
/// Implemented for these two types only.
pub trait Real: FftNum + NumAssign + Default + PartialOrd + sealed::Sealed {
    /// The distance from 1 to the next number.
    const EPSILON: f64;
    /// The nearest number of this type.
    fn narrow(x: f64) -> Self;
    /// The same number in double precision.
    fn wide(self) -> f64;
    /// self·a + b, rounded once. Slow where the CPU can't do it, so for code compiled for FMA.
    #[must_use]
    fn fused(self, a: Self, b: Self) -> Self;
}

pub(super) mod sealed {
    use super::{
        Arc, BatchTransform, Fft, FromColumns, Gather, GatherGradient, Scale, Simd, Spread,
        ToColumns,
    };

    /// What is compiled once for each type, here: a generic function would be compiled anew by
    /// every crate that uses a transform.
    pub trait Sealed: Sized {
        fn spread(job: Spread<'_, '_, Self>);
        fn gather(job: Gather<'_, '_, Self>);
        fn gather_gradient(job: GatherGradient<'_, '_, Self>);
        fn to_columns(simd: Simd, job: ToColumns<'_, '_, Self>);
        fn from_columns(simd: Simd, job: FromColumns<'_, '_, Self>);
        fn scale(simd: Simd, job: Scale<'_, Self>);
        fn transform_batch(simd: Simd, job: BatchTransform<'_, Self>);
        /// Transforms of this size with e^(−2πi…) and e^(+2πi…), the fastest that this CPU has.
        fn plan_ffts(size: usize) -> [Arc<dyn Fft<Self>>; 2];
    }
}

macro_rules! implement {
    ($($real:ty)*) => {$(
        impl sealed::Sealed for $real {
            fn spread(job: Spread<'_, '_, Self>) {
                job.taps.simd.run(job);
            }

            fn gather(job: Gather<'_, '_, Self>) {
                job.taps.simd.run(job);
            }

            fn gather_gradient(job: GatherGradient<'_, '_, Self>) {
                job.0.taps.simd.run(job);
            }

            fn to_columns(simd: Simd, job: ToColumns<'_, '_, Self>) {
                simd.run(job);
            }

            fn from_columns(simd: Simd, job: FromColumns<'_, '_, Self>) {
                simd.run(job);
            }

            fn scale(simd: Simd, job: Scale<'_, Self>) {
                simd.run(job);
            }

            fn transform_batch(simd: Simd, job: BatchTransform<'_, Self>) {
                simd.run(job);
            }

            fn plan_ffts(size: usize) -> [Arc<dyn Fft<Self>>; 2] {
                let mut planner = Planner::<$real>::new();
                [planner.forward(size), planner.inverse(size)]
            }
        }

        impl Real for $real {
            const EPSILON: f64 = <$real>::EPSILON as f64;

            #[inline(always)]
            fn narrow(x: f64) -> Self {
                x as $real
            }

            #[inline(always)]
            fn wide(self) -> f64 {
                self.into()
            }

            #[inline(always)]
            fn fused(self, a: Self, b: Self) -> Self {
                self.mul_add(a, b)
            }
        }
    )*};
}

implement!(f32 f64);
