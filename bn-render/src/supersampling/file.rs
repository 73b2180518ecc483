//! Patterns from text.

use bn_core::DVec2;

use super::{Supersampling, SupersamplingError, Tap};

impl Supersampling {
    /// Reads a pattern from text: a line `x y weight` for each tap, offsets from the pixel's
    /// centre in pixels with y down, the weight 1 where it is left out; blank lines and what
    /// follows a `#` are skipped.
    ///
    /// # Errors
    /// If a line says something else, or the taps don't make a pattern.
    pub fn parse(name: impl Into<String>, text: &str) -> Result<Self, SupersamplingError> {
        let mut taps = Vec::new();
        for (i, line) in text.lines().enumerate() {
            let content = line.split('#').next().unwrap_or_default();
            let numbers: Result<Vec<f64>, _> =
                content.split_ascii_whitespace().map(str::parse).collect();
            let tap = match numbers.as_deref() {
                Ok([]) => continue,
                Ok(&[x, y]) => Some(Tap { offset: DVec2::new(x, y), weight: 1.0 }),
                Ok(&[x, y, weight]) => Some(Tap { offset: DVec2::new(x, y), weight }),
                _ => None,
            };
            let unusable = || {
                let text = line.chars().take(80).collect();
                SupersamplingError::Line { line: i + 1, text }
            };
            taps.push(tap.filter(Tap::is_usable).ok_or_else(unusable)?);
            if taps.len() > Self::MAX_TAPS {
                return Err(SupersamplingError::Count { count: taps.len() });
            }
        }
        Self::new(name, taps)
    }
}
