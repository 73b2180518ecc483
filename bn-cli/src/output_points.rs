//! Sets of points into one file or several.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use anyhow::anyhow;
use bn_core::PointSet;
use bn_core::io::{self, Format, WriteError};

use crate::{Failure, Outcome, output};

/// Points in all sets of a run together: 3 GiB of coordinates.
const MAX_TOTAL: u64 = 200_000_000;

/// Refuses more points than a run can hold, before any work is done.
///
/// # Errors
/// If `sets` sets of `n` points are more than 200 million points in all.
pub fn check_total(n: u64, sets: u32) -> Outcome {
    if n.saturating_mul(u64::from(sets)) <= MAX_TOTAL {
        return Ok(());
    }
    Err(Failure::misuse(format!(
        "{sets} sets of {n} points are more than {MAX_TOTAL} points in all; make them in several runs"
    )))
}

/// Writes the sets: into one file if the format holds several sets or there is only one, else into
/// `name_0.ext`, `name_1.ext`, …; `{i}` in the name asks for one file a set and says where the
/// index goes. Standard output (`-`) is `.txt` for one set and `.dat` for several.
///
/// Returns after the last file is complete; each file appears whole or not at all.
///
/// # Errors
/// If the name tells no format, several sets are to go where one fits, or writing fails.
pub fn write(path: &Path, format: Option<Format>, sets: &[PointSet]) -> Outcome {
    let format = choose(path, format, sets.len())?;
    if one_a_file(path) || (sets.len() > 1 && !format.holds_ensembles()) {
        if path.as_os_str() == "-" {
            return Err(holds_one(format, sets.len()));
        }
        for (index, set) in sets.iter().enumerate() {
            write_one(&numbered(path, index), format, std::slice::from_ref(set))?;
        }
        return Ok(());
    }
    write_one(path, format, sets)
}

/// Refuses what can't be written, before any work is done: a name whose format can't be told, a
/// folder that isn't there, several sets where one fits.
///
/// # Errors
/// If [`write()`] of so many sets would fail for any of these.
pub fn check(path: &Path, format: Option<Format>, sets: usize) -> Outcome {
    let format = choose(path, format, sets)?;
    if path.as_os_str() == "-" {
        return if sets > 1 && !format.holds_ensembles() {
            Err(holds_one(format, sets))
        } else {
            Ok(())
        };
    }
    output::check_folder(path)
}

fn holds_one(format: Format, sets: usize) -> Failure {
    Failure::misuse(format!(
        "the format {} holds one set; write {sets} sets to files, or as dat, npy or json",
        format.name()
    ))
}

fn write_one(path: &Path, format: Format, sets: &[PointSet]) -> Outcome {
    output::write_to(path, |w| {
        io::write(format, sets, w).map_err(|error| match error {
            WriteError::Io(error) => Failure::failed(error),
            other => Failure::usage(anyhow!(other)),
        })
    })
}

fn choose(path: &Path, format: Option<Format>, sets: usize) -> Outcome<Format> {
    if let Some(format) = format {
        return Ok(format);
    }
    if path.as_os_str() == "-" {
        return Ok(if sets == 1 { Format::Txt } else { Format::Dat });
    }
    Format::from_path(path).map_err(|error| {
        Failure::misuse(format!("{}: {error}; rename the file or give --format", path.display()))
    })
}

const PLACE: &str = "{i}";

/// Whether the name asks for one file a set.
pub fn one_a_file(path: &Path) -> bool {
    path.file_name().and_then(OsStr::to_str).is_some_and(|name| name.contains(PLACE))
}

/// The name of set `index`: in the place of `{i}`, else before the extension.
fn numbered(path: &Path, index: usize) -> PathBuf {
    let name = path.file_name().and_then(OsStr::to_str).filter(|name| name.contains(PLACE));
    if let Some(name) = name {
        return path.with_file_name(name.replace(PLACE, &index.to_string()));
    }
    let mut stem = path.file_stem().unwrap_or_default().to_owned();
    stem.push(format!("_{index}"));
    if let Some(extension) = path.extension() {
        stem.push(OsString::from("."));
        stem.push(extension);
    }
    path.with_file_name(stem)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_go_where_they_are_asked_for() {
        let name = |path: &str| numbered(Path::new(path), 7).to_string_lossy().into_owned();
        assert_eq!(name("a/s.rps"), "a/s_7.rps");
        assert_eq!(name("a/s-{i}-b.rps"), "a/s-7-b.rps");
        assert_eq!(name("s"), "s_7");
    }

    #[test]
    fn unknown_extensions_are_refused() {
        assert_eq!(
            check(Path::new("points.xyz"), None, 1).expect_err("unknown").code(),
            Failure::USAGE
        );
        assert!(check(Path::new("points.xyz"), Some(Format::Txt), 1).is_ok());
    }

    #[test]
    fn what_could_not_be_written_is_refused_beforehand() {
        let code = |path: &str, format, sets| {
            check(Path::new(path), format, sets).err().map(|failure| failure.code())
        };
        assert_eq!(code("-", Some(Format::Rps), 3), Some(Failure::USAGE));
        assert_eq!(code("-", Some(Format::Rps), 1), None);
        assert_eq!(code("-", None, 3), None);
        assert_eq!(code("no/such/folder/a.txt", None, 1), Some(Failure::FAILED));
        assert_eq!(code("a.rps", None, 3), None);
    }
}
