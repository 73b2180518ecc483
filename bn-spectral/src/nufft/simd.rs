//! Loops compiled twice: for any CPU, and for AVX2 with fused multiply-add, taken where the CPU
//! has them.

use super::real::Real;

/// A loop over arrays of fixed length that the compiler turns into vector instructions.
pub(super) trait Job {
    type Output;

    /// Does it; to be marked `#[inline(always)]`, or it stays compiled for any CPU. `FUSED` says
    /// whether a·b + c is one instruction, to be passed on to [`multiply_add`].
    fn run<const FUSED: bool>(self) -> Self::Output;
}

/// a·b + c, rounded once only where that is one instruction.
#[inline(always)]
pub(super) fn multiply_add<T: Real, const FUSED: bool>(a: T, b: T, c: T) -> T {
    if FUSED { a.fused(b, c) } else { a * b + c }
}

/// The instructions that jobs are run with.
#[derive(Clone, Copy, Debug)]
pub struct Simd {
    fused: bool,
}

impl Simd {
    /// The best that this CPU has.
    pub(super) fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        let fused = is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma");
        #[cfg(not(target_arch = "x86_64"))]
        let fused = false;
        Self { fused }
    }

    /// What every CPU has, with the same result on all of them.
    pub(super) fn portable() -> Self {
        Self { fused: false }
    }

    #[inline]
    pub(super) fn run<J: Job>(self, job: J) -> J::Output {
        #[cfg(target_arch = "x86_64")]
        if self.fused {
            // SAFETY: `fused` is set only where the CPU has AVX2 and FMA.
            return unsafe { run_with_avx2_and_fma(job) };
        }
        job.run::<false>()
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn run_with_avx2_and_fma<J: Job>(job: J) -> J::Output {
    job.run::<true>()
}
