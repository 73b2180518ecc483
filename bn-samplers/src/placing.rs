//! Patterns whose points are placed directly, one by one.

use bn_core::{DVec2, Observer, Progress};

use crate::error::{check_count, observe, reserve};
use crate::{Report, Sample, SampleError};

/// An empty list with room for `n` points, once the count and the observer allow them.
pub(crate) fn begin_placing(
    method: &'static str,
    n: usize,
    observer: &dyn Observer,
) -> Result<Vec<DVec2>, SampleError> {
    check_count(method, n)?;
    observe(observer, &Progress::new("placing", 0, Some(n as u64)))?;
    reserve(n)
}

/// The error for a count between two possible ones.
pub(crate) fn between_counts(
    method: &'static str,
    n: usize,
    need: &'static str,
    [below, above]: [usize; 2],
) -> SampleError {
    let nearest = if n - below <= above - n { below } else { above };
    SampleError::InvalidCount { method, n, need, nearest }
}

/// The pattern of the points `start`, `start` + 1, … of a sequence.
pub(crate) fn place_sequence(
    method: &'static str,
    n: usize,
    start: u32,
    observer: &dyn Observer,
    point: impl Fn(u64) -> DVec2,
) -> Result<Sample, SampleError> {
    let mut points = begin_placing(method, n, observer)?;
    points.extend((u64::from(start)..).take(n).map(point));
    Ok(Sample::new(points, Report::new()))
}
