//! What the figures were measured on.

use std::process::Command;

use serde::Serialize;

/// The machine, the compiler and the state of the sources.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Machine {
    pub(super) cpu: String,
    pub(super) architecture: String,
    pub(super) threads: usize,
    pub(super) compiler: String,
    pub(super) commit: String,
}

impl Machine {
    /// This machine; what can't be found out is "unknown".
    pub(super) fn this() -> Self {
        Self {
            cpu: cpu().unwrap_or_else(unknown),
            architecture: format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS),
            threads: rayon::current_num_threads(),
            compiler: said_by("rustc", &["--version"]).unwrap_or_else(unknown),
            commit: said_by("git", &["describe", "--always", "--dirty"]).unwrap_or_else(unknown),
        }
    }

    /// One line for the head of a report.
    pub(super) fn line(&self) -> String {
        let Self { cpu, architecture, threads, compiler, commit } = self;
        format!("{cpu}, {architecture}, {threads} threads; {compiler}; commit {commit}")
    }
}

fn unknown() -> String {
    "unknown".to_owned()
}

/// The processor's name, where the system tells it in a file.
fn cpu() -> Option<String> {
    let text = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = text.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}

fn said_by(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout).trim().to_owned();
    (output.status.success() && !text.is_empty()).then_some(text)
}
