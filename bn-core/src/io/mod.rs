//! Point files: one function that reads and one that writes, for all formats.
//!
//! | format | holds | as |
//! |---|---|---|
//! | `.txt` | a set | an optional line with the number of points, then a line `x y` for each point |
//! | `.dat` | sets | the same, with one or more lines that start with `#` between sets |
//! | `.csv` | a set | a line `x,y` for each point; the first line may be the header `x,y` |
//! | `.json` | sets | `{"points": [[x, y], …]}` or `{"sets": [[[x, y], …], …]}` |
//! | `.npy` | sets | a NumPy array of `<f4` or `<f8` in C order, of shape (n, 2) or (m, n, 2) |
//! | `.rps` | a set | raw little-endian 32-bit floats, x and y in turn |
//! | `.eps` | a set | PostScript that draws the points, each by a line `x y p` |
//!
//! # Reading
//!
//! Every point must be finite and in [0, 1)², unless [`ReadOptions::wrap`] asks for wrapping; a set
//! holds at least one point, a file at least one set. Files are read as streams, in memory at most
//! 16 times their size plus 1 MiB whatever they claim to hold. Errors name the file, the line (or
//! the byte) and the set, and say how to go on.
//!
//! In formats of lines, blank lines, blanks and tabs around numbers, CR LF and a byte order mark are
//! passed over. Numbers are decimal, with sign, point and exponent as one likes, and are rounded
//! correctly; −0 stays −0; `nan` and `inf` are read and refused as not finite; anything else, such
//! as hexadecimal or `1_000`, is not a number. Lines of more than 16 KiB are refused.
//!
//! - `.txt` and `.dat`: a comma with or without blanks may stand between x and y. A first line of
//!   nothing but digits is the number of points and has to be right. Lines that start with `#` may
//!   come before the first point and after the last; between points they separate sets, which
//!   `.txt` refuses. In `.dat` each set may begin with its number of points, so that whatever is a
//!   `.txt` file is a `.dat` file too.
//! - `.csv`: fields may be quoted. There is no other column, no comment, no other separator.
//! - `.json`: other keys of the object are passed over; both keys, or neither, are errors. Whole
//!   numbers are numbers too; `null` is not.
//! - `.npy`: other types and Fortran order are refused; so are bytes missing or left over.
//! - `.rps`: a size that is not a multiple of 8 bytes is refused.
//! - `.eps`: what PSA does. A line is a point if it has three words, two numbers and one that starts
//!   with `p`; lines that start with `%` and all others are passed over. A line whose third word is
//!   just `p` after something else than two numbers is an error, and so is a wrong number in the
//!   comment `%points n`, which our own files have.
//!
//! # Writing
//!
//! Text formats get the shortest decimals that read back as the same number, `.npy` 64-bit floats:
//! what is written is read back bit for bit. `.rps` rounds to 32 bits, and a coordinate that rounds
//! to 1 becomes 0; a set that came from an `.rps` file, unless wrapped, survives any conversion and
//! back unchanged.
//!
//! ```
//! use bn_core::io::{self, Format, ReadOptions};
//!
//! let file = b"2\n0.25 0.5\n0.75 1.0\n";
//! let error = io::read(Format::Txt, "a.txt", &file[..], ReadOptions::default()).unwrap_err();
//! assert!(error.to_string().starts_with("a.txt, line 3: the point (0.75, 1.0) lies outside"));
//!
//! let ensemble = io::read(Format::Txt, "a.txt", &file[..], ReadOptions { wrap: true })?;
//! let mut csv = Vec::new();
//! io::write(Format::Csv, ensemble.sets(), &mut csv)?;
//! assert_eq!(csv, b"x,y\n0.25,0.5\n0.75,0.0\n");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bytes;
mod csv;
mod dat;
mod eps;
mod error;
mod format;
mod gather;
mod json;
mod lines;
mod npy;
mod npy_header;
mod rows;
mod rps;
mod txt;

use std::fs::File;
use std::io::{BufReader, BufWriter, Read, Write};
use std::path::Path;

use crate::{Ensemble, PointSet};
use error::Fault;
use gather::Gather;

pub use error::{NpyProblem, Place, ReadError, ReadProblem, WriteError};
pub use format::{Format, UnknownFormat};

/// How to read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ReadOptions {
    /// Take coordinates outside [0, 1) modulo 1 instead of refusing them.
    pub wrap: bool,
}

/// Where readers read from: of one type, so that they are compiled once.
type Source<'a> = BufReader<&'a mut dyn Read>;

/// Bytes read or written at a time.
const BUFFER: usize = 1 << 16;

/// Reads all sets from `source`; `name` is what errors call it.
///
/// # Errors
/// [`ReadError`] if reading fails or the [module documentation](self) doesn't allow what is read.
pub fn read(
    format: Format,
    name: &str,
    mut source: impl Read,
    options: ReadOptions,
) -> Result<Ensemble, ReadError> {
    let mut source = BufReader::with_capacity(BUFFER, &mut source as &mut dyn Read);
    read_format(format, &mut source, Gather::new(options)).map_err(|fault| fault.of_file(name))
}

fn read_format(format: Format, source: &mut Source<'_>, gather: Gather) -> Result<Ensemble, Fault> {
    match format {
        Format::Txt => txt::read(source, gather),
        Format::Rps => rps::read(source, gather),
        Format::Dat => dat::read(source, gather),
        Format::Csv => csv::read(source, gather),
        Format::Npy => npy::read(source, gather),
        Format::Json => json::read(source, gather),
        Format::Eps => eps::read(source, gather),
    }
}

/// Reads all sets of a file, of the format that its extension names unless one is given.
///
/// # Errors
/// As [`read`], or if the extension names no format.
pub fn read_path(
    path: &Path,
    format: Option<Format>,
    options: ReadOptions,
) -> Result<Ensemble, ReadError> {
    let name = path.display().to_string();
    let format = match format {
        Some(format) => format,
        None => Format::from_path(path).map_err(|unknown| Fault::from(unknown).of_file(&name))?,
    };
    let file = File::open(path).map_err(|error| Fault::from(error).of_file(&name))?;
    read(format, &name, file, options)
}

/// Writes `sets` to `target`, which needs no buffer of its own.
///
/// # Errors
/// [`WriteError`] if writing fails, if there is no set, if there are several and the format holds
/// one, or if they differ in size and the format is `.npy`. In all cases but the first nothing has
/// been written.
pub fn write(format: Format, sets: &[PointSet], mut target: impl Write) -> Result<(), WriteError> {
    let first = sets.first().ok_or(WriteError::Empty)?;
    if sets.len() > 1 && !format.holds_ensembles() {
        return Err(WriteError::OneSetOnly { format, sets: sets.len() });
    }
    let mut writer = BufWriter::with_capacity(BUFFER, &mut target as &mut dyn Write);
    match format {
        Format::Txt => txt::write(first, &mut writer),
        Format::Rps => rps::write(first, &mut writer),
        Format::Dat => dat::write(sets, &mut writer),
        Format::Csv => csv::write(first, &mut writer),
        Format::Npy => npy::write(sets, &mut writer),
        Format::Json => json::write(sets, &mut writer),
        Format::Eps => eps::write(first, &mut writer),
    }?;
    writer.flush()?;
    Ok(())
}
