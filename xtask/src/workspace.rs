//! Where the workspace is.

use std::path::PathBuf;
use std::process::Command;

use bn_cli::{Failure, Outcome};

/// The workspace's folder: the one above the running package's, or else what cargo says.
pub(crate) fn root() -> Outcome<PathBuf> {
    if let Some(package) = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from)
        && let Some(root) = package.parent()
    {
        return Ok(root.to_owned());
    }
    let output = cargo()
        .args(["locate-project", "--workspace", "--message-format", "plain"])
        .output()
        .map_err(|error| Failure::failed(anyhow::anyhow!("cannot run cargo: {error}")))?;
    let manifest = PathBuf::from(String::from_utf8_lossy(&output.stdout).trim());
    match manifest.parent() {
        Some(root) if output.status.success() => Ok(root.to_owned()),
        _ => Err(Failure::misuse("run xtask inside the workspace, as `cargo xtask`")),
    }
}

/// The cargo that runs us, or the one on the path.
pub(crate) fn cargo() -> Command {
    Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}
