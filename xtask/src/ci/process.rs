//! Child processes that must succeed.

use std::process::{Child, Command, ExitStatus};
use std::time::{Duration, Instant};

use anyhow::{Context, anyhow};
use bn_cli::{Failure, Outcome};

use crate::workspace;

/// Runs cargo, showing what it prints.
pub(super) fn cargo(arguments: &[&str], environment: &[(&str, &str)]) -> Outcome {
    let mut command = workspace::cargo();
    command.args(arguments).envs(environment.iter().copied());
    succeed(command.status(), || format!("cargo {}", arguments.join(" ")))
}

/// Builds all programs and examples as the tests are built, so that nothing is compiled for both:
/// examples have the tests' dependencies, which decide about the features of all others.
pub(super) fn build() -> Outcome {
    cargo(
        &[
            "build",
            "--quiet",
            "--profile",
            "test",
            "--workspace",
            "--all-features",
            "--bins",
            "--examples",
        ],
        &[],
    )
}

/// What cargo prints on standard output.
pub(super) fn cargo_output(arguments: &[&str]) -> Outcome<Vec<u8>> {
    let mut command = workspace::cargo();
    command.args(arguments).stderr(std::process::Stdio::inherit());
    let output = command.output().context("cannot run cargo").map_err(Failure::failed)?;
    succeed(Ok(output.status), || format!("cargo {}", arguments.join(" ")))?;
    Ok(output.stdout)
}

/// Runs `command`, stopping it after `limit`.
pub(super) fn run(command: &mut Command, limit: Duration, name: &str) -> Outcome {
    let mut child =
        command.spawn().with_context(|| format!("cannot run {name}")).map_err(Failure::failed)?;
    if let Some(status) = wait(&mut child, limit)? {
        return succeed(Ok(status), || name.to_owned());
    }
    child.kill()?;
    child.wait()?;
    Err(Failure::failed(anyhow!("{name} was stopped after {} s", limit.as_secs())))
}

/// The child's status, or none if it still runs after `limit`.
fn wait(child: &mut Child, limit: Duration) -> std::io::Result<Option<ExitStatus>> {
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(Some(status));
        }
        if start.elapsed() > limit {
            return Ok(None);
        }
        std::thread::sleep(Duration::from_millis(10));
    }
}

fn succeed(status: std::io::Result<ExitStatus>, name: impl Fn() -> String) -> Outcome {
    let status =
        status.with_context(|| format!("cannot run {}", name())).map_err(Failure::failed)?;
    if status.success() {
        return Ok(());
    }
    Err(Failure::failed(anyhow!("{}: {status}", name())))
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn failures_and_endless_runs_are_told_apart() {
        let limit = Duration::from_secs(60);
        let run = |program: &str, argument: &str, limit| {
            run(Command::new(program).arg(argument), limit, program)
        };
        assert!(run("true", "", limit).is_ok());
        let failed = run("false", "", limit).expect_err("it fails");
        assert!(failed.to_string().contains("false: exit status: 1"), "{failed}");
        let stopped = run("sleep", "60", Duration::from_millis(30)).expect_err("it hangs");
        assert!(stopped.to_string().contains("stopped after"), "{stopped}");
        let absent = run("no-such-program-anywhere", "", limit).expect_err("absent");
        assert!(absent.to_string().contains("cannot run"), "{absent}");
    }
}
