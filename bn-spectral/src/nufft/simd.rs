//! Loops compiled for any CPU, for AVX2, and for AVX2 with fused multiply-add, taken where the CPU
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
    level: Level,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Level {
    Any,
    /// AVX2, products and sums rounded one by one: the same bits as [`Level::Any`].
    Wide,
    /// AVX2 and fused multiply-add.
    Fused,
}

impl Simd {
    /// The best that this CPU has.
    pub(super) fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            return Self { level: Level::Fused };
        }
        Self { level: Level::Any }
    }

    /// The best whose results are the same bits on every CPU.
    pub(super) fn portable() -> Self {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") {
            return Self { level: Level::Wide };
        }
        Self { level: Level::Any }
    }

    /// What any CPU has; in tests, to compare the others with.
    #[cfg(test)]
    pub(super) fn any() -> Self {
        Self { level: Level::Any }
    }

    #[inline]
    pub(super) fn run<J: Job>(self, job: J) -> J::Output {
        #[cfg(target_arch = "x86_64")]
        match self.level {
            // SAFETY: this level is set only where the CPU has AVX2 and FMA.
            Level::Fused => return unsafe { run_with_avx2_and_fma(job) },
            // SAFETY: this level is set only where the CPU has AVX2.
            Level::Wide => return unsafe { run_with_avx2(job) },
            Level::Any => {}
        }
        job.run::<false>()
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn run_with_avx2<J: Job>(job: J) -> J::Output {
    job.run::<false>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn run_with_avx2_and_fma<J: Job>(job: J) -> J::Output {
    job.run::<true>()
}
