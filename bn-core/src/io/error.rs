//! What can be wrong with a point file, in words that say how to go on.

use std::{error, fmt, io};

use thiserror::Error;

use super::{Format, UnknownFormat};

/// Why a point file could not be read: which file, where in it, what is wrong, and the mend.
#[derive(Debug)]
pub struct ReadError {
    name: String,
    place: Place,
    problem: ReadProblem,
}

impl ReadError {
    /// The name that the file was read under.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Where in the file.
    pub fn place(&self) -> Place {
        self.place
    }

    /// What is wrong.
    pub fn problem(&self) -> &ReadProblem {
        &self.problem
    }

    /// What is wrong, by value.
    pub fn into_problem(self) -> ReadProblem {
        self.problem
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}: {}", self.name, self.place, self.problem)
    }
}

impl error::Error for ReadError {
    fn source(&self) -> Option<&(dyn error::Error + 'static)> {
        error::Error::source(&self.problem)
    }
}

/// Where something is in a file, as far as that is known. Displayed as `, line 7, set 2`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Place {
    /// The line, from 1, in formats of lines.
    pub line: Option<u64>,
    /// The offset in bytes, from 0, in binary formats.
    pub byte: Option<u64>,
    /// The set, from 0, in files that hold several.
    pub set: Option<usize>,
}

impl Place {
    pub(super) fn line(line: u64) -> Self {
        Self { line: Some(line), ..Self::default() }
    }

    pub(super) fn byte(byte: u64) -> Self {
        Self { byte: Some(byte), ..Self::default() }
    }

    pub(super) fn in_set(self, set: usize) -> Self {
        Self { set: Some(set), ..self }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(f, ", line {line}")?;
        }
        if let Some(byte) = self.byte {
            write!(f, ", byte {byte}")?;
        }
        if let Some(set) = self.set {
            write!(f, ", set {set}")?;
        }
        Ok(())
    }
}

/// What is wrong with a point file.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReadProblem {
    /// The file can't be opened or read.
    #[error("cannot be read")]
    Io(#[from] io::Error),
    /// The file's name doesn't tell its format.
    #[error("{0}; rename the file or give its format")]
    Format(#[from] UnknownFormat),
    /// A file or a set without points.
    #[error("there is no point; a set needs at least one")]
    Empty,
    /// More points in a set than 32-bit indices can number.
    #[error("there are more than 2²⁹ points in a set; split it")]
    TooMany,
    /// A coordinate is NaN or infinite.
    #[error("the point ({x:?}, {y:?}) is nowhere; coordinates must be finite numbers")]
    NotFinite {
        /// The abscissa.
        x: f64,
        /// The ordinate.
        y: f64,
    },
    /// A coordinate lies outside [0, 1), and wrapping was not asked for.
    #[error(
        "the point ({x:?}, {y:?}) lies outside the unit square [0, 1)²; scale the points, or ask for \
         them to be wrapped round the torus"
    )]
    OutOfDomain {
        /// The abscissa.
        x: f64,
        /// The ordinate.
        y: f64,
    },
    /// A line that should hold a point.
    #[error("'{text}' is not a point; a line holds two numbers, x and y")]
    NotAPoint {
        /// The line, shortened, with unprintable bytes escaped.
        text: String,
    },
    /// A line so long that the file can't be one of ours.
    #[error("the line has more than {limit} bytes; a line holds one point")]
    LongLine {
        /// The longest line that is read.
        limit: usize,
    },
    /// The stated number of points is not that of the points that follow.
    #[error(
        "{stated} points are announced but {found} follow; the file is cut off, or the number \
         needs correcting"
    )]
    Count {
        /// The number as it stands in the file.
        stated: String,
        /// Points that follow.
        found: usize,
    },
    /// More points after a line with `#`, in a format of one set.
    #[error(
        "points go on after a line with '#', which separates sets in .dat files; name the file \
         .dat, give that format, or remove the line"
    )]
    SecondSet,
    /// A number of bytes that is not a multiple of a point's.
    #[error(
        "{bytes} bytes are not a whole number of points of 8 bytes, two 32-bit floats; the file \
         is cut off or of another format"
    )]
    PartialPoint {
        /// The file's size.
        bytes: u64,
    },
    /// Not a NumPy file, or not one of ours.
    #[error("{0}")]
    Npy(#[from] NpyProblem),
    /// Not JSON, or not of the expected structure.
    #[error("{message}; expected {{\"points\": [[x, y], …]}} or {{\"sets\": [[[x, y], …], …]}}")]
    Json {
        /// What was met, and where in the line.
        message: String,
    },
}

/// What is wrong with a NumPy file.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum NpyProblem {
    /// The first bytes are not those of a NumPy file.
    #[error("not a NumPy file: it does not start with \\x93NUMPY")]
    Magic,
    /// A version of the format that did not exist when this was written.
    #[error("version {major}.{minor} of the NumPy format is not known; save it as 1.0")]
    Version {
        /// The first number.
        major: u8,
        /// The second number.
        minor: u8,
    },
    /// The header is not the dictionary that it should be.
    #[error("the NumPy header is damaged: {what}")]
    Header {
        /// What was missed.
        what: &'static str,
    },
    /// Numbers other than little-endian floats.
    #[error("numbers of type {descr} are not read; save the array with astype('<f8') or '<f4'")]
    Type {
        /// The type as the header has it.
        descr: String,
    },
    /// Fortran order.
    #[error("the array is in Fortran order; save it with numpy.ascontiguousarray")]
    FortranOrder,
    /// A shape that is neither (n, 2) nor (m, n, 2).
    #[error("the shape is {shape}; expected (n, 2) for a set or (m, n, 2) for m sets of n points")]
    Shape {
        /// The shape as the header has it.
        shape: String,
    },
    /// Fewer or more bytes than the shape asks for.
    #[error(
        "the shape asks for {expected} bytes of numbers, there are {}; the file is cut off or \
         its header is wrong", found.map_or("more".to_owned(), |found| found.to_string())
    )]
    Length {
        /// Bytes that the shape asks for.
        expected: u64,
        /// Bytes that there are; `None` if more than expected.
        found: Option<u64>,
    },
}

/// A problem with its place, before the file's name is added.
#[derive(Debug)]
pub(super) struct Fault {
    pub(super) place: Place,
    pub(super) problem: ReadProblem,
}

impl Fault {
    pub(super) fn at(place: Place, problem: impl Into<ReadProblem>) -> Self {
        Self { place, problem: problem.into() }
    }

    pub(super) fn of_file(self, name: &str) -> ReadError {
        ReadError { name: name.to_owned(), place: self.place, problem: self.problem }
    }
}

/// A problem of the file as a whole.
impl<P: Into<ReadProblem>> From<P> for Fault {
    fn from(problem: P) -> Self {
        Self::at(Place::default(), problem)
    }
}

/// Why points could not be written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The file can't be written.
    #[error("cannot be written")]
    Io(#[from] io::Error),
    /// Nothing to write.
    #[error("there is no set to write")]
    Empty,
    /// Several sets, in a format of one.
    #[error(
        "the format {format} holds one set, not {sets}; write one file a set, or use dat, npy \
         or json"
    )]
    OneSetOnly {
        /// The format.
        format: Format,
        /// How many sets were to be written.
        sets: usize,
    },
    /// Sets of different sizes, in a format of arrays.
    #[error(
        "the format npy holds sets of one size, but set {set} has {points} points and set 0 \
         has {first}; use dat or json"
    )]
    UnequalSets {
        /// Points of set 0.
        first: usize,
        /// The first set that differs.
        set: usize,
        /// Its number of points.
        points: usize,
    },
}
