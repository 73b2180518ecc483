//! Why a pattern could not be made.

use bn_core::{Observer, PointSet, Progress};
use thiserror::Error;

/// Why a [`crate::Sampler`] made no pattern.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SampleError {
    /// The method cannot make this many points.
    #[error("{method} cannot make {n} points: it needs {need}; nearest possible: -n {nearest}")]
    InvalidCount {
        /// The method's name.
        method: &'static str,
        /// The count that was asked for.
        n: usize,
        /// Which counts are possible, as a noun phrase.
        need: &'static str,
        /// The possible count nearest to `n`.
        nearest: usize,
    },
    /// An option has a value that the method cannot work with, alone or with the others.
    #[error("--{option}: {reason}")]
    InvalidOption {
        /// The option's name, without dashes.
        option: &'static str,
        /// What is wrong and what would be right.
        reason: String,
    },
    /// The work ended within its budget but short of the number of points asked for.
    #[error("{method} placed {reached} of {n} points; {advice}")]
    NotReached {
        /// The method's name.
        method: &'static str,
        /// The count that was asked for.
        n: usize,
        /// The count that was reached.
        reached: usize,
        /// How to go on.
        advice: String,
    },
    /// There is not enough memory for this many points.
    #[error("not enough memory for {n} points; ask for fewer with -n")]
    OutOfMemory {
        /// The count that was asked for.
        n: usize,
    },
    /// The observer asked to stop.
    #[error("cancelled")]
    Cancelled,
}

impl SampleError {
    /// Whether the request itself was at fault (exit code 2) rather than the run (exit code 1).
    pub fn is_usage(&self) -> bool {
        matches!(self, Self::InvalidCount { .. } | Self::InvalidOption { .. })
    }
}

/// Checks 1 ≤ n ≤ [`PointSet::MAX_POINTS`], the counts that a [`PointSet`] can hold.
pub(crate) fn check_count(method: &'static str, n: usize) -> Result<(), SampleError> {
    let nearest = n.clamp(1, PointSet::MAX_POINTS);
    if n == nearest {
        return Ok(());
    }
    Err(SampleError::InvalidCount {
        method,
        n,
        need: "at least 1 and at most as many as a set can hold",
        nearest,
    })
}

/// An empty list with room for `n` items, or the error that there is no such room.
pub(crate) fn reserve<T>(n: usize) -> Result<Vec<T>, SampleError> {
    let mut list = Vec::new();
    list.try_reserve_exact(n).map_err(|_| SampleError::OutOfMemory { n })?;
    Ok(list)
}

/// Checks that the system doesn't refuse `bytes` at once, before work on `n` points is begun that
/// takes them. It may promise more than it has.
pub(crate) fn check_room(n: usize, bytes: usize) -> Result<(), SampleError> {
    let mut room: Vec<u8> = Vec::new();
    room.try_reserve_exact(bytes).map_err(|_| SampleError::OutOfMemory { n })?;
    // Or else nothing is asked for.
    std::hint::black_box(&room);
    Ok(())
}

/// Tells the observer, and turns its wish to stop into an error.
pub(crate) fn observe(observer: &dyn Observer, progress: &Progress<'_>) -> Result<(), SampleError> {
    if observer.observe(progress).is_break() { Err(SampleError::Cancelled) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_system_has_all_memory() {
        assert_eq!(check_room(7, usize::MAX), Err(SampleError::OutOfMemory { n: 7 }));
        assert_eq!(check_room(7, 1 << 10), Ok(()));
    }
}
