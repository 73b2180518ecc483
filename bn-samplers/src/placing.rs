//! Patterns whose points are placed directly, one by one.

use bn_core::{DVec2, Observer, Progress};

use crate::error::{check_count, observe, reserve};
use crate::{DefaultValue, OptionKind, OptionSpec, OptionValues, SampleError};

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

/// The option of sequences that need not begin at their beginning.
pub(crate) const START: OptionSpec = OptionSpec {
    name: "start",
    kind: OptionKind::Integer { min: 0, max: u32::MAX as u64 },
    default: DefaultValue::Value("0"),
    help: "index of the first point of the sequence",
    unit: "",
};

/// The value of [`START`].
pub(crate) fn start(options: &OptionValues) -> u32 {
    options.integer(START.name).unwrap_or(0) as u32
}
