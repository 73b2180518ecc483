//! Point files and standard input.

use std::io::Read;
use std::path::Path;

use anyhow::{Context, anyhow};
use bn_core::Ensemble;
use bn_core::io::{self, Format, ReadError, ReadOptions, ReadProblem};

use crate::{Failure, Outcome};

/// The sets of a file, or of standard input for `-`.
///
/// Without `format` a file's extension decides; on standard input the contents do.
///
/// # Errors
/// A file that is bad or absent is bad input; a disk that fails is a failure.
pub fn read(path: &Path, format: Option<Format>, wrap: bool) -> Outcome<Ensemble> {
    let options = ReadOptions { wrap };
    if path.as_os_str() == "-" {
        return read_stdin(format, options);
    }
    io::read_path(path, format, options).map_err(failure)
}

fn read_stdin(format: Option<Format>, options: ReadOptions) -> Outcome<Ensemble> {
    parse_stdin(&stdin_bytes()?, format, options)
}

/// All of standard input, to be looked at before it is read as something.
pub(crate) fn stdin_bytes() -> Outcome<Vec<u8>> {
    let mut bytes = Vec::new();
    std::io::stdin()
        .lock()
        .read_to_end(&mut bytes)
        .context("cannot read standard input")
        .map_err(Failure::failed)?;
    Ok(bytes)
}

/// The sets in what came from standard input.
pub(crate) fn parse_stdin(
    bytes: &[u8],
    format: Option<Format>,
    options: ReadOptions,
) -> Outcome<Ensemble> {
    let format = format.unwrap_or_else(|| recognize(bytes));
    io::read(format, "standard input", bytes, options).map_err(failure)
}

/// The format that bytes without a name are most likely in: by the mark of `.npy`, `.json` or `.eps`,
/// lines with `#` anywhere, a comma in the first line. `.rps` has no mark of its own and must
/// be named.
fn recognize(bytes: &[u8]) -> Format {
    let text = bytes.trim_ascii_start();
    let first = text.split(|&byte| byte == b'\n').next().unwrap_or_default();
    if bytes.starts_with(b"\x93NUMPY") {
        Format::Npy
    } else if text.starts_with(b"{") {
        Format::Json
    } else if text.starts_with(b"%!") {
        Format::Eps
    } else if text.contains(&b'#') {
        Format::Dat
    } else if first.contains(&b',') {
        Format::Csv
    } else {
        Format::Txt
    }
}

/// A disk that fails is a failure; bad contents and names that lead nowhere are bad input. Names
/// the option where the mend is one.
fn failure(error: ReadError) -> Failure {
    use std::io::ErrorKind::{IsADirectory, NotADirectory, NotFound};
    match error.problem() {
        ReadProblem::OutOfDomain { .. } => Failure::misuse(format!("{error} (--wrap)")),
        ReadProblem::Format(_) => {
            Failure::misuse(format!("{error} (--format; --from of bn convert)"))
        }
        // Its text is part of the error's own.
        ReadProblem::Npy(_) => Failure::misuse(error),
        ReadProblem::Io(io) if !matches!(io.kind(), NotFound | IsADirectory | NotADirectory) => {
            Failure::failed(anyhow!(error))
        }
        _ => Failure::usage(anyhow!(error)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_count_says_that_commas_are_no_csv() {
        assert_eq!(recognize(b"2\n0.1,0.2\n0.3,0.4\n"), Format::Txt);
        assert_eq!(recognize(b"0.1,0.2\n0.3,0.4\n"), Format::Csv);
    }

    #[test]
    fn formats_are_recognized_by_their_first_bytes() {
        let set = bn_core::PointSet::new(vec![bn_core::DVec2::new(0.25, 0.5); 3]).expect("valid");
        for format in Format::ALL {
            let sets = if format == Format::Dat { vec![set.clone(); 2] } else { vec![set.clone()] };
            let mut bytes = Vec::new();
            io::write(format, &sets, &mut bytes).expect("in memory");
            if format != Format::Rps {
                assert_eq!(recognize(&bytes), format);
            }
        }
    }
}
