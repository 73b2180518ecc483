//! The commands in the documentation are run, so that they can't rot.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use anyhow::Context;
use bn_cli::{Failure, Outcome};

use super::examples::Metadata;
use super::process::{self, build};

/// A command in the documentation shall not take longer.
const LIMIT: Duration = Duration::from_secs(120);

/// Runs every line that starts with `bn ` in a code block of the README and of `docs/*.md`, one
/// file's in order and in one empty folder, so that later ones find what earlier ones wrote.
pub(super) fn run() -> Outcome {
    build()?;
    let programs = Metadata::load()?.programs();
    let mut found = 0;
    for document in documents()? {
        let text = fs::read_to_string(&document)
            .with_context(|| format!("cannot read {}", document.display()))
            .map_err(Failure::failed)?;
        let folder = tempfile::tempdir()?;
        let commands = commands(&text);
        found += commands.len();
        for line in commands {
            eprintln!("$ {line}");
            let name = format!("{}: {line}", document.display());
            process::run(&mut shell(&line, folder.path(), &programs)?, LIMIT, &name)?;
        }
    }
    if found == 0 {
        return Err(Failure::failed(anyhow::anyhow!("the documentation shows no command")));
    }
    Ok(())
}

/// The README and the documents, in order of their names.
fn documents() -> Outcome<Vec<PathBuf>> {
    let mut documents = Vec::new();
    if let Ok(entries) = fs::read_dir("docs") {
        for entry in entries {
            documents.push(entry?.path());
        }
    }
    documents.retain(|path| path.extension().is_some_and(|extension| extension == "md"));
    documents.sort();
    documents.insert(0, PathBuf::from("README.md"));
    Ok(documents)
}

/// The lines that start with `bn ` in the fenced code blocks, a prompt `$ ` left out, continued
/// lines joined.
fn commands(text: &str) -> Vec<String> {
    let mut commands: Vec<String> = Vec::new();
    let (mut inside, mut continued) = (false, false);
    for line in text.lines().map(str::trim) {
        if line.starts_with("```") {
            (inside, continued) = (!inside, false);
            continue;
        }
        if !inside {
            continue;
        }
        let plain = line.strip_prefix("$ ").unwrap_or(line);
        let (part, goes_on) = match plain.strip_suffix('\\') {
            Some(part) => (part.trim_end(), true),
            None => (plain, false),
        };
        match commands.last_mut() {
            Some(command) if continued => {
                command.push(' ');
                command.push_str(part);
                continued = goes_on;
            }
            _ if plain.starts_with("bn ") => {
                commands.push(part.to_owned());
                continued = goes_on;
            }
            _ => {}
        }
    }
    commands
}

/// The line in a shell that finds our `bn` first; what it prints is of no interest.
fn shell(line: &str, folder: &Path, programs: &Path) -> Outcome<Command> {
    let old = env::var_os("PATH").unwrap_or_default();
    let path = env::join_paths(std::iter::once(programs.to_owned()).chain(env::split_paths(&old)))
        .map_err(Failure::failed)?;
    let mut command = Command::new("bash");
    command.args(["-o", "pipefail", "-c", line]).current_dir(folder).env("PATH", path);
    command.stdin(std::process::Stdio::null()).stdout(std::process::Stdio::null());
    Ok(command)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_found_in_code_blocks_only() {
        let text = "\
Use bn like this:
bn not in a block
```sh
$ bn generate fpo -n 64 -o a.txt   # a comment
cargo build
bn analyze a.txt \\
    --json | head -1
  bn list
bnx no
```
bn after
```
bn completions bash
```
";
        let want = [
            "bn generate fpo -n 64 -o a.txt   # a comment",
            "bn analyze a.txt --json | head -1",
            "bn list",
            "bn completions bash",
        ];
        assert_eq!(commands(text), want);
    }

    #[cfg(unix)]
    #[test]
    fn a_line_runs_in_its_folder_with_its_path() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let line = "echo \"$PATH\" | grep -q '^/a/b:' && echo x > here";
        let mut command = shell(line, folder.path(), Path::new("/a/b")).expect("a path");
        process::run(&mut command, LIMIT, "a line").expect("it runs");
        assert!(folder.path().join("here").exists());
        let mut failing = shell("false | cat", folder.path(), Path::new("/a/b")).expect("a path");
        assert!(process::run(&mut failing, LIMIT, "a pipe").is_err());
    }
}
