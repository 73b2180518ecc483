//! Curve files: what `bn analyze --curve` writes and `bn match --target FILE` reads.
//!
//! CSV with a header that says what the columns are: `nu,power` (cycles per unit), `nu_rel,power`
//! (√n/2), `r,g` (unit lengths) or `r_rel,g` (`d_hex`).

use bn_core::{Density, NormalizedDistance, NormalizedFrequency};
use bn_spectral::Target;

use crate::input::Source;
use crate::{Failure, Outcome};

/// What a header says about the columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Columns {
    Frequency,
    RelativeFrequency,
    Distance,
    RelativeDistance,
}

const HEADERS: [(&str, Columns); 4] = [
    ("nu,power", Columns::Frequency),
    ("nu_rel,power", Columns::RelativeFrequency),
    ("r,g", Columns::Distance),
    ("r_rel,g", Columns::RelativeDistance),
];

/// The longest file that is read, in bytes: more than any curve needs.
const LONGEST: u64 = 1 << 26;

impl Columns {
    fn of(line: &str) -> Option<Self> {
        let header: String = line.chars().filter(|c| !c.is_whitespace()).collect();
        HEADERS.iter().find(|(name, _)| *name == header).map(|(_, columns)| *columns)
    }

    /// The abscissa in cycles per unit or unit lengths.
    fn absolute(self, x: f64, density: Density) -> f64 {
        match self {
            Self::Frequency | Self::Distance => x,
            Self::RelativeFrequency => NormalizedFrequency::new(x).to_cycles_per_unit(density),
            Self::RelativeDistance => NormalizedDistance::new(x).to_unit_lengths(density),
        }
    }
}

/// Whether bytes begin like a curve: with two names and a comma between them that are not the
/// header of a point file.
///
/// Headers that no curve has count as well, since what can be said about them has to do with curves.
pub(crate) fn looks_like_curve(bytes: &[u8]) -> bool {
    let start = String::from_utf8_lossy(&bytes[..bytes.len().min(LONGEST_HEADER)]);
    let line = start.trim_start_matches('\u{feff}').lines().next().unwrap_or_default();
    let is_name = |word: &str| {
        let word = word.trim();
        word.starts_with(|c: char| c.is_ascii_alphabetic())
            && word.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
            // Numbers that are none: a matter for the reader of points.
            && word.parse::<f64>().is_err()
    };
    match line.split_once(',') {
        Some((x, y)) => is_name(x) && is_name(y) && (x.trim(), y.trim()) != ("x", "y"),
        None => false,
    }
}

/// Bytes in which a header has to end.
const LONGEST_HEADER: usize = 64;

/// The curve of a file, a pipe or standard input as a target at `density`.
///
/// # Errors
/// What can't be read, a header that is none of the four, a line that is no pair of numbers, or
/// samples that don't make a target: bad input.
pub(crate) fn read(source: Source, density: Density) -> Outcome<Target> {
    let name = source.name();
    let bytes = source.into_bytes(LONGEST)?;
    let text = if bytes.len() as u64 > LONGEST {
        Err(Failure::misuse(format!("more than {LONGEST} bytes are too many for a curve")))
    } else {
        std::str::from_utf8(&bytes).map_err(Failure::usage)
    };
    text.and_then(|text| parse(text, density)).map_err(|failure| failure.context(name))
}

fn parse(text: &str, density: Density) -> Outcome<Target> {
    let mut lines = text.trim_start_matches('\u{feff}').lines().enumerate();
    let header = lines.next().map_or("", |(_, line)| line);
    let columns = Columns::of(header).ok_or_else(|| {
        let known = HEADERS.map(|(name, _)| name).join(", ");
        Failure::misuse(format!("the first line must be one of {known}, not {header:?}"))
    })?;
    let mut samples = Vec::new();
    for (number, line) in lines.filter(|(_, line)| !line.trim().is_empty()) {
        let pair = line.split_once(',').and_then(|(x, y)| {
            Some((x.trim().parse::<f64>().ok()?, y.trim().parse::<f64>().ok()?))
        });
        let (x, y) = pair.ok_or_else(|| {
            Failure::misuse(format!("line {}: {line:?} is no pair of numbers", number + 1))
        })?;
        samples.push((columns.absolute(x, density), y));
    }
    let target = match columns {
        Columns::Frequency | Columns::RelativeFrequency => Target::power_curve(density, &samples),
        Columns::Distance | Columns::RelativeDistance => Target::rdf_curve(density, &samples),
    };
    target.map_err(Failure::usage)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn density() -> Density {
        Density::new(1024)
    }

    #[test]
    fn units_are_what_the_header_says() {
        let absolute = parse("nu,power\n16,0\n32,1\n", density()).expect("a curve");
        let relative = parse(" nu_rel , power\r\n1,0\r\n2,1\r\n\r\n", density()).expect("a curve");
        assert_eq!(absolute, relative);
        assert_eq!(absolute.power(24.0), 0.5);
        let d_hex = density().hexagonal_spacing();
        let absolute = parse(&format!("r,g\n0,0\n{d_hex},1\n"), density()).expect("a curve");
        assert_eq!(absolute, parse("r_rel,g\n0,0\n1,1\n", density()).expect("a curve"));
    }

    #[test]
    fn curves_are_told_from_points() {
        for curve in ["nu,power\n0,1\n", "r_rel, g\r\n", "\u{feff}nu,power\n", "k,P\n"] {
            assert!(looks_like_curve(curve.as_bytes()), "{curve}");
        }
        for points in ["", "x,y\n0.1,0.2\n", " x , y\n", "0.1,0.2\n", "nan,inf\n", "12\n0.5,0.5\n"]
        {
            assert!(!looks_like_curve(points.as_bytes()), "{points}");
        }
        assert!(!looks_like_curve(&[0xff; 9]));
    }

    #[test]
    fn slips_are_named_with_their_line() {
        for (text, want) in [
            ("", "nu_rel,power"),
            ("x,y\n1,2\n", "not \"x,y\""),
            ("r,g\n0,1\n0.1;1\n", "line 3"),
            ("r,g\n0,1\n", "1 samples"),
            ("nu,power\n0,1\n1,nan\n", "value 1 is NaN"),
            ("nu,power\n1,1\n0,1\n", "abscissa 1"),
        ] {
            let error = parse(text, density()).expect_err(text).to_string();
            assert!(error.contains(want), "{error}");
        }
    }
}
