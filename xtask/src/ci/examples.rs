//! Every example of the workspace is run.

use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;

use bn_cli::{Failure, Outcome};
use serde::Deserialize;

use super::process::{self, build, cargo_output};

/// No example shall take longer.
const LIMIT: Duration = Duration::from_secs(60);

/// What cargo says about the workspace.
#[derive(Debug, Deserialize)]
pub(super) struct Metadata {
    packages: Vec<Package>,
    target_directory: PathBuf,
}

#[derive(Debug, Deserialize)]
struct Package {
    targets: Vec<Target>,
}

#[derive(Debug, Deserialize)]
struct Target {
    name: String,
    kind: Vec<String>,
}

impl Metadata {
    pub(super) fn load() -> Outcome<Self> {
        let json = cargo_output(&["metadata", "--no-deps", "--format-version", "1"])?;
        serde_json::from_slice(&json).map_err(Failure::failed)
    }

    /// The names of all examples.
    fn examples(&self) -> impl Iterator<Item = &str> {
        let targets = self.packages.iter().flat_map(|package| &package.targets);
        let examples = targets.filter(|t| t.kind.iter().any(|kind| kind == "example"));
        examples.map(|target| target.name.as_str())
    }

    /// Where programs land that are built as the tests are.
    pub(super) fn programs(&self) -> PathBuf {
        self.target_directory.join("debug")
    }
}

pub(super) fn run() -> Outcome {
    build()?;
    let metadata = Metadata::load()?;
    let folder = metadata.programs().join("examples");
    for name in metadata.examples() {
        eprintln!("example {name}");
        process::run(&mut Command::new(folder.join(name)), LIMIT, name)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn examples_are_found() {
        let metadata: Metadata = serde_json::from_str(
            r#"{"target_directory": "t", "packages": [{"name": "a", "targets": [
                {"name": "a", "kind": ["lib"]},
                {"name": "first", "kind": ["example"]},
                {"name": "second", "kind": ["example"], "required-features": ["x", "y"]}]},
                {"name": "b", "targets": [{"name": "third", "kind": ["example"]}]}]}"#,
        )
        .expect("valid");
        assert_eq!(metadata.examples().collect::<Vec<_>>(), ["first", "second", "third"]);
        assert_eq!(metadata.programs(), Path::new("t/debug"));
    }
}
