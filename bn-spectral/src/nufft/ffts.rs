//! The one-dimensional FFTs of a plan: rustfft's for speed, or our own with the same bits everywhere.

use std::sync::Arc;

use bn_fft::Complex;
use bn_fft::Fft;

use super::batch::{BatchFft, BatchTransform, LANES, Lanes};
use super::real::Real;
use super::simd::Simd;

/// Transforms of one length in both directions.
pub(super) enum Ffts<T> {
    Fastest { forward: Arc<dyn Fft<T>>, inverse: Arc<dyn Fft<T>> },
    Portable { batch: BatchFft<T>, simd: Simd },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Direction {
    /// e^(−2πi…)
    Forward,
    /// e^(+2πi…)
    Inverse,
}

/// What a thread's transforms work in.
#[derive(Debug)]
pub(super) struct FftScratch<T> {
    numbers: Vec<Complex<T>>,
    lanes: Vec<Lanes<T>>,
}

impl<T: Real> Ffts<T> {
    pub(super) fn new(size: usize, portable: bool) -> Self {
        if portable {
            Self::Portable { batch: BatchFft::new(size), simd: Simd::portable() }
        } else {
            let [forward, inverse] = T::plan_ffts(size);
            Self::Fastest { forward, inverse }
        }
    }

    pub(super) fn scratch(&self, size: usize) -> FftScratch<T> {
        let (numbers, lanes) = match self {
            Self::Fastest { forward, inverse } => {
                (forward.get_inplace_scratch_len().max(inverse.get_inplace_scratch_len()), 0)
            }
            Self::Portable { .. } => (0, 2 * size),
        };
        let zero = Complex::new(T::default(), T::default());
        FftScratch { numbers: vec![zero; numbers], lanes: vec![Lanes::zero(); lanes] }
    }

    /// Transforms the first `size` numbers of every `stride` in place.
    pub(super) fn transform(
        &self,
        direction: Direction,
        signals: &mut [Complex<T>],
        size: usize,
        stride: usize,
        scratch: &mut FftScratch<T>,
    ) {
        match self {
            Self::Fastest { forward, inverse } => {
                let fft = if direction == Direction::Forward { forward } else { inverse };
                for signal in signals.chunks_exact_mut(stride) {
                    fft.process_with_scratch(&mut signal[..size], &mut scratch.numbers);
                }
            }
            Self::Portable { batch, simd } => {
                for signals in signals.chunks_mut(LANES * stride) {
                    let inverse = direction == Direction::Inverse;
                    let scratch = &mut scratch.lanes[..];
                    let job = BatchTransform { fft: batch, inverse, signals, stride, scratch };
                    T::transform_batch(*simd, job);
                }
            }
        }
    }
}
