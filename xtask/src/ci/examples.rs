//! Every example of the workspace is run.

use bn_cli::{Failure, Outcome};
use serde::Deserialize;

use super::process::{cargo, cargo_output};

/// What cargo says about the workspace.
#[derive(Debug, Deserialize)]
pub(super) struct Metadata {
    packages: Vec<Package>,
    pub(super) target_directory: std::path::PathBuf,
}

#[derive(Debug, Deserialize)]
struct Package {
    name: String,
    targets: Vec<Target>,
}

#[derive(Debug, Deserialize)]
struct Target {
    name: String,
    kind: Vec<String>,
    #[serde(rename = "required-features", default)]
    features: Vec<String>,
}

impl Metadata {
    pub(super) fn load() -> Outcome<Self> {
        let json = cargo_output(&["metadata", "--no-deps", "--format-version", "1"])?;
        serde_json::from_slice(&json).map_err(Failure::failed)
    }

    /// The arguments of cargo that run each example.
    fn examples(&self) -> Vec<Vec<String>> {
        let mut runs = Vec::new();
        for package in &self.packages {
            for target in package.targets.iter().filter(|t| t.kind.iter().any(|k| k == "example")) {
                let mut run: Vec<String> =
                    ["run", "--quiet", "--release", "--package", &package.name, "--example"]
                        .map(str::to_owned)
                        .into();
                run.push(target.name.clone());
                if !target.features.is_empty() {
                    run.extend(["--features".to_owned(), target.features.join(",")]);
                }
                runs.push(run);
            }
        }
        runs
    }
}

pub(super) fn run() -> Outcome {
    for example in Metadata::load()?.examples() {
        let arguments: Vec<&str> = example.iter().map(String::as_str).collect();
        eprintln!("$ cargo {}", arguments.join(" "));
        cargo(&arguments, &[])?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn examples_are_found_with_their_features() {
        let metadata: Metadata = serde_json::from_str(
            r#"{"target_directory": "t", "packages": [{"name": "a", "targets": [
                {"name": "a", "kind": ["lib"]},
                {"name": "first", "kind": ["example"]},
                {"name": "second", "kind": ["example"], "required-features": ["x", "y"]}]}]}"#,
        )
        .expect("valid");
        let runs: Vec<_> = metadata.examples().iter().map(|run| run.join(" ")).collect();
        let head = "run --quiet --release --package a --example";
        assert_eq!(runs, [format!("{head} first"), format!("{head} second --features x,y")]);
    }
}
