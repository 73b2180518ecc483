//! Files that appear whole or not at all, and standard output that may close early.

use std::fs::{self, File};
use std::io::{self, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use anyhow::{Context, anyhow};

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
    renamed(path, |file| fill(file, write)).map_err(|failure| while_writing(path, failure))
}

/// A disk that failed, with the name of the file that it failed for.
fn while_writing(path: &Path, failure: Failure) -> Failure {
    if failure.code() == Failure::FAILED {
        failure.context(format!("cannot write {}", path.display()))
    } else {
        failure
    }
}

/// [`write_to`] for formats whose parts are not written in order: `write` gets the file itself,
/// unbuffered. For `-` that is a temporary file which is copied to standard output in the end.
///
/// # Errors
/// As [`write_to`].
pub fn write_seekable<T>(path: &Path, write: impl FnOnce(File) -> Outcome<T>) -> Outcome<T> {
    if path.as_os_str() == "-" {
        let mut file = tempfile::tempfile()?;
        let made = write(file.try_clone()?)?;
        file.rewind()?;
        write_stdout(|w| Ok(io::copy(&mut file, w).map(drop)?))?;
        return Ok(made);
    }
    renamed(path, |file| write(file.try_clone()?)).map_err(|failure| while_writing(path, failure))
}

/// Whether a file of this name could be made, as far as that can be told beforehand.
///
/// # Errors
/// If there is no such folder, or the name is that of a folder.
pub fn check_folder(path: &Path) -> Outcome {
    if path.is_dir() {
        return Err(Failure::failed(anyhow!("cannot write {}: it is a folder", path.display())));
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    match folder {
        Some(folder) if !folder.is_dir() => Err(Failure::failed(anyhow::anyhow!(
            "cannot write {}: there is no folder {}",
            path.display(),
            folder.display()
        ))),
        _ => Ok(()),
    }
}

/// Whether writing `output` would replace what is read from `input`.
pub fn replaces(output: &Path, input: &Path) -> bool {
    let real = |path: &Path| path.canonicalize().ok().filter(|real| real.is_file());
    real(input).is_some_and(|input| real(output) == Some(input))
}

/// Lets `write` fill the file that is to be `path` and gives it that name, if all went well.
fn renamed<T>(path: &Path, write: impl FnOnce(&File) -> Outcome<T>) -> Outcome<T> {
    if fs::metadata(path).is_ok_and(|file| !file.is_file() && !file.is_dir()) {
        return write(&File::options().write(true).open(path)?);
    }
    let target = behind_links(path);
    if fs::metadata(&target).is_ok_and(|file| file.permissions().readonly()) {
        return Err(io::Error::new(io::ErrorKind::PermissionDenied, "the file is read-only").into());
    }
    let directory = match target.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    if !directory.is_dir() {
        return Err(Failure::failed(anyhow!("there is no folder {}", directory.display())));
    }
    let temporary = Unfinished::within(directory)?;
    let made = write(temporary.file.as_file())?;
    temporary.finish(&target)?;
    Ok(made)
}

/// What a name stands for: a link stays a link, and the file that it leads to, there or not yet, is
/// what gets replaced.
fn behind_links(path: &Path) -> PathBuf {
    /// As many as systems follow; a ring of links ends in the error of the last.
    const MOST_LINKS: u32 = 40;
    let mut target = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(next) = fs::read_link(&target) else { break };
        // A relative link starts from the folder that it is in.
        target = target.parent().map_or_else(|| next.clone(), |folder| folder.join(&next));
    }
    target
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
    let doing = "cannot write to standard output";
    write(&mut writer).map_err(|failure| match failure.code() {
        Failure::FAILED => failure.context(doing),
        _ => failure,
    })?;
    writer.flush().context(doing).map_err(Failure::failed)
}

/// [`write_file`], or [`write_stdout`] for the name `-`.
///
/// # Errors
/// As those.
pub fn write_to(path: &Path, write: impl FnOnce(&mut dyn Write) -> Outcome) -> Outcome {
    if path.as_os_str() == "-" { write_stdout(write) } else { write_file(path, write) }
}

/// A line on standard error. One that nobody can read is no reason to stop.
pub fn remark(line: impl std::fmt::Display) {
    let _ = writeln!(io::stderr(), "{line}");
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
    fn within(directory: &Path) -> io::Result<Self> {
        let mut builder = tempfile::Builder::new();
        // Short, since the name itself may be as long as names can be.
        builder.prefix(".bn-").suffix(".part");
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
        // An older file keeps its permissions.
        if let Ok(old) = fs::metadata(target) {
            self.file.as_file().set_permissions(old.permissions())?;
        }
        // Renamed, the guard finds nothing left to remove.
        fs::rename(self.file.path(), target)
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        let mut unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
        unfinished.retain(|path| path != self.file.path());
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
        // A link to what isn't there yet, in a folder of its own.
        let (dangling, later) = (folder.path().join("dangling"), folder.path().join("later"));
        std::os::unix::fs::symlink("later", &dangling).expect("linkable");
        write_file(&dangling, |w| Ok(w.write_all(b"new")?)).expect("writable");
        assert!(fs::symlink_metadata(&dangling).expect("the link").is_symlink());
        assert_eq!(fs::read(&later).expect("the file"), b"new");
    }

    #[test]
    fn read_only_files_are_kept_and_long_names_written() {
        let folder = folder();
        let long = folder.path().join("n".repeat(250));
        write_file(&long, |w| Ok(w.write_all(b"x")?)).expect("a name of 250 bytes is allowed");
        let path = folder.path().join("points.txt");
        fs::write(&path, "old").expect("writable");
        let mut permissions = fs::metadata(&path).expect("there").permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&path, permissions).expect("ours");
        let error = write_file(&path, |w| Ok(w.write_all(b"new")?)).expect_err("read-only");
        assert!(error.to_string().contains("read-only"), "{error}");
        assert_eq!(fs::read(&path).expect("there"), b"old");
        assert!(UNFINISHED.lock().expect("free").iter().all(|p| !p.starts_with(folder.path())));
    }
}
