//! Runs of little-endian floats as points: what .rps and .npy share.

use std::io::{self, Read};

use super::Source;

/// Bytes read at a time: whole points of either width.
pub(super) const CHUNK: usize = 1 << 16;

/// Fills `buffer` as far as the source reaches and returns how far that is.
pub(super) fn fill(source: &mut Source<'_>, buffer: &mut [u8]) -> io::Result<usize> {
    let mut filled = 0;
    while filled < buffer.len() {
        match source.read(&mut buffer[filled..]) {
            Ok(0) => break,
            Ok(count) => filled += count,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(filled)
}

/// The width of a float in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Width {
    F32,
    F64,
}

impl Width {
    /// Bytes of a point.
    pub(super) fn point(self) -> usize {
        match self {
            Self::F32 => 8,
            Self::F64 => 16,
        }
    }

    /// The point that the first [`Self::point`] bytes hold.
    #[inline]
    pub(super) fn decode(self, bytes: &[u8]) -> (f64, f64) {
        match self {
            Self::F32 => {
                let x = f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
                let y = f32::from_le_bytes([bytes[4], bytes[5], bytes[6], bytes[7]]);
                (f64::from(x), f64::from(y))
            }
            Self::F64 => {
                let float = |at: usize| f64::from_le_bytes(std::array::from_fn(|i| bytes[at + i]));
                (float(0), float(8))
            }
        }
    }
}
