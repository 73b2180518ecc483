//! The formats by name.

use std::fmt;
use std::path::Path;
use std::str::FromStr;

use thiserror::Error;

/// A format of point files; the [module documentation](super) says what each one holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
#[non_exhaustive]
pub enum Format {
    /// `.txt`: an optional line with the number of points, then a line `x y` for each.
    Txt,
    /// `.rps`: raw little-endian 32-bit floats, x and y in turn.
    Rps,
    /// `.dat`: lines `x y`, with lines that start with `#` between sets.
    Dat,
    /// `.csv`: a line `x,y` for each point under the header `x,y`.
    Csv,
    /// `.npy`: a NumPy array of shape (n, 2) or (m, n, 2).
    Npy,
    /// `.json`: `{"points": [[x, y], …]}` or `{"sets": [[[x, y], …], …]}`.
    Json,
    /// `.eps`: a drawing in PostScript in which the lines `x y p` are the points.
    Eps,
}

/// A name or a path that tells no format.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{tried} is no known format; known are {}", known_names())]
pub struct UnknownFormat {
    tried: String,
}

fn known_names() -> String {
    Format::ALL.map(Format::name).join(", ")
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 7] =
        [Self::Txt, Self::Rps, Self::Dat, Self::Csv, Self::Npy, Self::Json, Self::Eps];

    /// The format's name, which is its file extension without the dot.
    pub fn name(self) -> &'static str {
        match self {
            Self::Txt => "txt",
            Self::Rps => "rps",
            Self::Dat => "dat",
            Self::Csv => "csv",
            Self::Npy => "npy",
            Self::Json => "json",
            Self::Eps => "eps",
        }
    }

    /// The format of this name, in any case, with or without a dot in front.
    ///
    /// # Errors
    /// [`UnknownFormat`], whose message lists the names.
    pub fn from_name(name: &str) -> Result<Self, UnknownFormat> {
        let bare = name.strip_prefix('.').unwrap_or(name);
        let format = Self::ALL.into_iter().find(|format| bare.eq_ignore_ascii_case(format.name()));
        format.ok_or_else(|| UnknownFormat { tried: format!("'{}'", name.escape_debug()) })
    }

    /// The format that the path's extension names.
    ///
    /// # Errors
    /// [`UnknownFormat`] if there is no extension or none of ours.
    pub fn from_path(path: &Path) -> Result<Self, UnknownFormat> {
        match path.extension() {
            Some(extension) => Self::from_name(&format!(".{}", extension.display())),
            None => Err(UnknownFormat { tried: "a name without extension".into() }),
        }
    }

    /// Whether a file can hold several sets; the other formats hold exactly one.
    pub fn holds_ensembles(self) -> bool {
        matches!(self, Self::Dat | Self::Npy | Self::Json)
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Format {
    type Err = UnknownFormat;

    fn from_str(name: &str) -> Result<Self, UnknownFormat> {
        Self::from_name(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_extensions_go_both_ways() {
        for format in Format::ALL {
            assert_eq!(Format::from_name(format.name()), Ok(format));
            assert_eq!(format.to_string().to_uppercase().parse(), Ok(format));
            let path = format!("some.dir/points.0.{format}");
            assert_eq!(Format::from_path(Path::new(&path)), Ok(format));
        }
        assert_eq!(Format::from_name(".RPS"), Ok(Format::Rps));
    }

    #[test]
    fn unknown_names_list_the_known_ones() {
        let error = Format::from_path(Path::new("points.xyz")).expect_err("no such format");
        assert_eq!(
            error.to_string(),
            "'.xyz' is no known format; known are txt, rps, dat, csv, npy, json, eps"
        );
        for path in ["points", "-", ".txt", ""] {
            let error = Format::from_path(Path::new(path)).expect_err("no extension");
            assert!(error.to_string().starts_with("a name without extension"), "{error}");
        }
    }
}
