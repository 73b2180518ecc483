//! What a command ends with when it doesn't end well.

use std::fmt;

/// A failed command: a message for the person, and whose fault it was.
#[derive(Debug)]
pub struct Failure {
    error: anyhow::Error,
    code: u8,
}

/// The result of a command.
pub type Outcome<T = ()> = Result<T, Failure>;

impl Failure {
    /// Exit code of a run that failed: a disk that is full, a radius that was not reached.
    pub const FAILED: u8 = 1;
    /// Exit code of bad use or bad input: the same call would fail again.
    pub const USAGE: u8 = 2;

    /// The run failed (exit code 1).
    pub fn failed(error: impl Into<anyhow::Error>) -> Self {
        Self { error: error.into(), code: Self::FAILED }
    }

    /// The command was misused or its input is bad (exit code 2).
    pub fn usage(error: impl Into<anyhow::Error>) -> Self {
        Self { error: error.into(), code: Self::USAGE }
    }

    /// Bad use, said in words.
    pub fn misuse(message: impl fmt::Display) -> Self {
        Self::usage(anyhow::anyhow!("{message}"))
    }

    /// The process's exit code.
    pub fn code(&self) -> u8 {
        self.code
    }

    /// The same failure with what was being done before the colon.
    #[must_use]
    pub fn context(self, doing: impl fmt::Display + Send + Sync + 'static) -> Self {
        Self { error: self.error.context(doing), code: self.code }
    }

    /// Whether this is only the reader of our output having gone away, as `| head` does.
    pub fn is_broken_pipe(&self) -> bool {
        self.error
            .chain()
            .filter_map(|cause| cause.downcast_ref::<std::io::Error>())
            .any(|error| error.kind() == std::io::ErrorKind::BrokenPipe)
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:#}", self.error)
    }
}

impl From<std::io::Error> for Failure {
    fn from(error: std::io::Error) -> Self {
        Self::failed(error)
    }
}
