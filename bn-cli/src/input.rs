//! Point files and standard input.

use std::io::Read;
use std::path::Path;

use anyhow::anyhow;
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
    Stdin::open()?.into_sets(format, options)
}

/// Standard input, of which the first bytes can be looked at before it is read as something.
pub(crate) struct Stdin {
    head: Vec<u8>,
    rest: std::io::StdinLock<'static>,
}

/// Bytes to tell formats by.
const HEAD: u64 = 1 << 10;

impl Stdin {
    pub(crate) fn open() -> Outcome<Self> {
        let (mut head, mut rest) = (Vec::new(), std::io::stdin().lock());
        rest.by_ref().take(HEAD).read_to_end(&mut head).map_err(unreadable)?;
        Ok(Self { head, rest })
    }

    /// The first bytes.
    pub(crate) fn head(&self) -> &[u8] {
        &self.head
    }

    /// All sets, read as a stream.
    pub(crate) fn into_sets(
        self,
        format: Option<Format>,
        options: ReadOptions,
    ) -> Outcome<Ensemble> {
        let format = format.unwrap_or_else(|| recognize(&self.head));
        io::read(format, "standard input", self.head.chain(self.rest), options).map_err(failure)
    }

    /// All bytes, or one more than `most`.
    pub(crate) fn into_bytes(self, most: u64) -> Outcome<Vec<u8>> {
        let Self { head: mut bytes, rest } = self;
        let left = (most + 1).saturating_sub(bytes.len() as u64);
        rest.take(left).read_to_end(&mut bytes).map_err(unreadable)?;
        Ok(bytes)
    }
}

fn unreadable(error: std::io::Error) -> Failure {
    Failure::failed(anyhow!(error).context("cannot read standard input"))
}

/// The format that bytes without a name are most likely in: by the mark of `.npy`, `.json` or `.eps`,
/// a comma in the first line. `.rps` has no mark of its own and must be named; other text may hold
/// several sets.
fn recognize(head: &[u8]) -> Format {
    let text = head.trim_ascii_start();
    let first = text.split(|&byte| byte == b'\n').next().unwrap_or_default();
    if head.starts_with(b"\x93NUMPY") {
        Format::Npy
    } else if text.starts_with(b"{") {
        Format::Json
    } else if text.starts_with(b"%!") {
        Format::Eps
    } else if first.contains(&b',') && !first.starts_with(b"#") {
        Format::Csv
    } else {
        Format::Dat
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
        assert_eq!(recognize(b"2\n0.1,0.2\n0.3,0.4\n"), Format::Dat);
        assert_eq!(recognize(b"# a, b\n0.1 0.2\n"), Format::Dat);
        assert_eq!(recognize(b"0.1,0.2\n0.3,0.4\n"), Format::Csv);
    }

    #[test]
    fn formats_are_recognized_by_their_first_bytes() {
        let set = bn_core::PointSet::new(vec![bn_core::DVec2::new(0.25, 0.5); 3]).expect("valid");
        for format in Format::ALL {
            let mut bytes = Vec::new();
            io::write(format, std::slice::from_ref(&set), &mut bytes).expect("in memory");
            match format {
                Format::Rps => {}
                // All that is a .txt is a .dat.
                Format::Txt => assert_eq!(recognize(&bytes), Format::Dat),
                _ => assert_eq!(recognize(&bytes), format),
            }
        }
    }
}
