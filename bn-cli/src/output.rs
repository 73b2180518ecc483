//! Files that appear whole or not at all, and standard output that may close early.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use anyhow::Context;

use crate::{Failure, Outcome};

/// Temporary files that exist at this moment; an interrupt removes them.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Writes a file by way of a temporary one beside it that is renamed when it is complete, so that
/// a reader never sees half of it. A device or pipe (`/dev/stdout`) is written directly.
///
/// `write` gets a buffered writer; an error of `write` or of the disk leaves no file behind and an
/// older file of that name as it was.
///
/// # Errors
/// What `write` returns, or that the file cannot be written.
pub fn write_file(path: &Path, write: impl FnOnce(&mut dyn Write) -> Outcome) -> Outcome {
    write_renamed(path, write).map_err(|failure| {
        if failure.code() == Failure::FAILED {
            failure.context(format!("cannot write {}", path.display()))
        } else {
            failure
        }
    })
}

fn write_renamed(path: &Path, write: impl FnOnce(&mut dyn Write) -> Outcome) -> Outcome {
    if fs::metadata(path).is_ok_and(|file| !file.is_file() && !file.is_dir()) {
        return fill(File::options().write(true).open(path)?, write);
    }
    // A link stays a link: the file that it leads to is what gets replaced.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let directory = match target.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let temporary = Unfinished::beside(&target, directory)?;
    fill(temporary.file.as_file(), write)?;
    Ok(temporary.finish(&target)?)
}

/// Runs `write` on a buffered `file` and flushes it down to the disk's acceptance.
fn fill<F: Write>(file: F, write: impl FnOnce(&mut dyn Write) -> Outcome) -> Outcome {
    let mut writer = BufWriter::with_capacity(1 << 16, file);
    write(&mut writer)?;
    Ok(writer.flush()?)
}

/// Standard output, locked and buffered; a reader that goes away ends the command quietly.
///
/// # Errors
/// What `write` returns, or that standard output cannot be written.
pub fn write_stdout(write: impl FnOnce(&mut dyn Write) -> Outcome) -> Outcome {
    let mut writer = BufWriter::with_capacity(1 << 16, io::stdout().lock());
    write(&mut writer)?;
    writer.flush().context("cannot write to standard output").map_err(Failure::failed)
}

/// [`write_file`], or [`write_stdout`] for the name `-`.
///
/// # Errors
/// As those.
pub fn write_to(path: &Path, write: impl FnOnce(&mut dyn Write) -> Outcome) -> Outcome {
    if path.as_os_str() == "-" { write_stdout(write) } else { write_file(path, write) }
}

/// Removes every unfinished file; for the moment of an interrupt, just before the process ends.
pub fn discard_unfinished() {
    for path in UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner).drain(..) {
        // The process ends in any case, and a file that can't be removed can't be reported better.
        let _ = fs::remove_file(path);
    }
}

/// A temporary file that an interrupt knows of.
struct Unfinished {
    file: tempfile::NamedTempFile,
}

impl Unfinished {
    fn beside(target: &Path, directory: &Path) -> io::Result<Self> {
        let mut prefix = std::ffi::OsString::from(".");
        prefix.push(target.file_name().unwrap_or_default());
        let mut builder = tempfile::Builder::new();
        builder.prefix(&prefix).suffix(".part");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // What an ordinary new file gets; the user's umask takes its share.
            builder.permissions(fs::Permissions::from_mode(0o666));
        }
        let mut unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
        let file = builder.tempfile_in(directory)?;
        unfinished.push(file.path().to_owned());
        Ok(Self { file })
    }

    fn finish(self, target: &Path) -> io::Result<()> {
        let mut unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
        unfinished.retain(|path| path != self.file.path());
        // An older file keeps its permissions.
        if let Ok(old) = fs::metadata(target) {
            self.file.as_file().set_permissions(old.permissions())?;
        }
        self.file.persist(target).map_err(|error| error.error)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> tempfile::TempDir {
        tempfile::tempdir().expect("a temporary folder")
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("a readable folder");
        entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned()).collect()
    }

    #[test]
    fn a_failed_write_leaves_the_old_file() {
        let folder = folder();
        let path = folder.path().join("points.txt");
        write_file(&path, |w| Ok(w.write_all(b"old")?)).expect("writable");
        let failed = write_file(&path, |w| {
            w.write_all(b"new")?;
            Err(Failure::misuse("stop"))
        });
        assert!(failed.is_err());
        assert_eq!(fs::read(&path).expect("the old file"), b"old");
        assert_eq!(names(folder.path()), ["points.txt"]);
    }

    #[test]
    fn an_absent_folder_is_named() {
        let path = folder().path().join("absent/points.txt");
        let error = write_file(&path, |_| Ok(())).expect_err("no folder");
        assert_eq!(error.code(), Failure::FAILED);
        assert!(error.to_string().contains("points.txt"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_written_and_links_followed() {
        write_file(Path::new("/dev/null"), |w| Ok(w.write_all(b"x")?)).expect("null takes all");
        assert!(!fs::metadata("/dev/null").expect("still there").is_file());
        let full = write_file(Path::new("/dev/full"), |w| Ok(w.write_all(b"x")?));
        assert_eq!(full.expect_err("a full disk").code(), Failure::FAILED);
        let folder = folder();
        let (link, file) = (folder.path().join("link"), folder.path().join("file"));
        fs::write(&file, "old").expect("writable");
        std::os::unix::fs::symlink(&file, &link).expect("linkable");
        write_file(&link, |w| Ok(w.write_all(b"new")?)).expect("writable");
        assert_eq!(fs::read(&file).expect("the file"), b"new");
        assert!(fs::symlink_metadata(&link).expect("the link").is_symlink());
    }
}
