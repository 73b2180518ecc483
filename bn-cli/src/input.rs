//! Point files, pipes and standard input.

use std::fs::{File, Metadata};
use std::io::Read;
use std::path::{Path, PathBuf};

use anyhow::anyhow;
use bn_core::Ensemble;
use bn_core::io::{self, Format, ReadError, ReadOptions, ReadProblem};

use crate::{Failure, Outcome};

/// The sets of a file, or of standard input for `-`.
///
/// Without `format` a file's extension decides; of standard input and of pipes whose name tells no
/// format, the contents do.
///
/// # Errors
/// A file that is bad or absent is bad input; a disk that fails is a failure.
pub fn read(path: &Path, format: Option<Format>, wrap: bool) -> Outcome<Ensemble> {
    let options = ReadOptions { wrap };
    if path.is_dir() {
        return Err(Failure::misuse(format!(
            "{} is a folder, not a file of points",
            path.display()
        )));
    }
    if can_be_read_again(path) {
        return io::read_path(path, format, options).map_err(failure);
    }
    Source::open(path)?.into_sets(format, options)
}

/// Whether the path is no pipe: a file, or nothing that can be read at all.
fn can_be_read_again(path: &Path) -> bool {
    let is_pipe = |data: Metadata| !data.is_file() && !data.is_dir();
    path.as_os_str() != "-" && !path.metadata().is_ok_and(is_pipe)
}

/// A file, a pipe or standard input, of which the first bytes can be looked at before it is read as
/// something.
pub(crate) struct Source {
    path: PathBuf,
    head: Vec<u8>,
    rest: Box<dyn Read>,
}

/// Bytes to tell formats by.
const HEAD: u64 = 1 << 10;

impl Source {
    /// Opens a file, or standard input for `-`.
    pub(crate) fn open(path: &Path) -> Outcome<Self> {
        let mut rest: Box<dyn Read> = if path.as_os_str() == "-" {
            Box::new(std::io::stdin().lock())
        } else {
            Box::new(File::open(path).map_err(|error| unreadable(path, error))?)
        };
        let mut head = Vec::new();
        let read = rest.by_ref().take(HEAD).read_to_end(&mut head);
        read.map_err(|error| unreadable(path, error))?;
        Ok(Self { path: path.to_owned(), head, rest })
    }

    /// The first bytes.
    pub(crate) fn head(&self) -> &[u8] {
        &self.head
    }

    /// What messages call it.
    pub(crate) fn name(&self) -> String {
        name(&self.path)
    }

    /// All sets, read as a stream, in the format that [`read`] would take.
    pub(crate) fn into_sets(
        self,
        format: Option<Format>,
        options: ReadOptions,
    ) -> Outcome<Ensemble> {
        if can_be_read_again(&self.path) {
            return io::read_path(&self.path, format, options).map_err(failure);
        }
        let format = format.or_else(|| Format::from_path(&self.path).ok());
        let format = format.unwrap_or_else(|| recognize(&self.head));
        io::read(format, &self.name(), self.head.chain(self.rest), options).map_err(failure)
    }

    /// All bytes, or one more than `most`.
    pub(crate) fn into_bytes(self, most: u64) -> Outcome<Vec<u8>> {
        let Self { path, head: mut bytes, rest } = self;
        let left = (most + 1).saturating_sub(bytes.len() as u64);
        rest.take(left).read_to_end(&mut bytes).map_err(|error| unreadable(&path, error))?;
        Ok(bytes)
    }
}

fn name(path: &Path) -> String {
    if path.as_os_str() == "-" { "standard input".to_owned() } else { path.display().to_string() }
}

fn unreadable(path: &Path, error: std::io::Error) -> Failure {
    let is_usage = leads_nowhere(&error);
    let error = anyhow!(error).context(format!("cannot read {}", name(path)));
    if is_usage { Failure::usage(error) } else { Failure::failed(error) }
}

/// Whether the name is at fault, not the disk.
fn leads_nowhere(error: &std::io::Error) -> bool {
    use std::io::ErrorKind::{IsADirectory, NotADirectory, NotFound};
    matches!(error.kind(), NotFound | IsADirectory | NotADirectory)
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
    match error.problem() {
        ReadProblem::OutOfDomain { .. } => {
            Failure::misuse(format!("{error} (--wrap of bn analyze, report and convert)"))
        }
        ReadProblem::Format(_) => Failure::misuse(format!(
            "{error} (--format of bn analyze and report, --from of bn convert)"
        )),
        // Its text is part of the error's own.
        ReadProblem::Npy(_) => Failure::misuse(error),
        ReadProblem::Io(io) if !leads_nowhere(io) => Failure::failed(anyhow!(error)),
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
