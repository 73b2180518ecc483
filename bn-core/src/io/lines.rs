//! Text as lines, and lines as points.

use std::io::{BufRead, Read};

use super::error::{Fault, Place};
use super::{ReadProblem, Source};

/// Longer lines are not of a file with one point a line.
const LONGEST_LINE: usize = 1 << 14;

const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

/// The lines of a text file, ended by LF or CR LF.
pub(super) struct Lines<'a, 'b> {
    source: &'a mut Source<'b>,
    line: Vec<u8>,
    number: u64,
}

impl<'a, 'b> Lines<'a, 'b> {
    pub(super) fn new(source: &'a mut Source<'b>) -> Self {
        Self { source, line: Vec::with_capacity(128), number: 0 }
    }

    /// The next line that is not blank, without the blanks around it and without a byte order mark.
    pub(super) fn next(&mut self) -> Result<Option<&[u8]>, Fault> {
        loop {
            self.line.clear();
            let mut limited = Read::take(&mut *self.source, LONGEST_LINE as u64 + 1);
            if limited.read_until(b'\n', &mut self.line)? == 0 {
                return Ok(None);
            }
            self.number += 1;
            if self.line.len() > LONGEST_LINE {
                let limit = LONGEST_LINE;
                return Err(Fault::at(self.place(), ReadProblem::LongLine { limit }));
            }
            if self.number == 1 && self.line.starts_with(BYTE_ORDER_MARK) {
                self.line.drain(..BYTE_ORDER_MARK.len());
            }
            if !self.line.trim_ascii().is_empty() {
                break;
            }
        }
        Ok(Some(self.line.trim_ascii()))
    }

    /// Where the last line is.
    pub(super) fn place(&self) -> Place {
        Place::line(self.number)
    }
}

/// The number that a word is: decimal digits with optional sign, point and exponent, or one of the
/// words that are read only to be refused as not finite, nan, inf and infinity. Correctly rounded.
pub(super) fn number(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// The two numbers of `x y`, `x, y` or `x,y`.
pub(super) fn pair(line: &[u8]) -> Option<(f64, f64)> {
    let end = line.iter().position(|&b| b == b',' || b.is_ascii_whitespace())?;
    let (x, rest) = line.split_at(end);
    let rest = rest.trim_ascii_start();
    let y = rest.strip_prefix(b",").unwrap_or(rest).trim_ascii_start();
    Some((number(x)?, number(y)?))
}

/// What to say of a line that is not a point.
pub(super) fn not_a_point(line: &[u8]) -> ReadProblem {
    const SHOWN: usize = 40;
    let mut text = line[..line.len().min(SHOWN)].escape_ascii().to_string();
    if line.len() > SHOWN {
        text.push('…');
    }
    ReadProblem::NotAPoint { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_two_numbers_with_a_blank_or_a_comma_between() {
        for line in
            ["0.5 0.25", "0.5\t \t.25", "0.5,0.25", "0.5 , 2.5e-1", "+0.5, 0.25", "5E-1 0.250"]
        {
            assert_eq!(pair(line.as_bytes()), Some((0.5, 0.25)), "{line}");
        }
        for line in [
            "",
            "0.5",
            "0.5,",
            ",0.5",
            "0.5,,0.5",
            "0.5 0.5 0.5",
            "0.5 0.5,",
            "0,5 0,5",
            "0.5;0.5",
            "0x1p-1 0.5",
            "0.5 1_0",
            "0.5d0 0.5",
            "a b",
            "0.5 0.5 # a",
            "1/2 1/2",
            "\u{221e} 0",
        ] {
            assert_eq!(pair(line.as_bytes()), None, "{line}");
        }
        assert!(pair(b"nan inf").is_some_and(|(x, y)| x.is_nan() && y.is_infinite()));
        assert_eq!(pair(b"\xFF\xFE0 1"), None);
    }

    #[test]
    fn long_or_binary_lines_are_shown_in_part() {
        let ReadProblem::NotAPoint { text } = not_a_point(&[0xFF; 100]) else {
            panic!("another problem");
        };
        assert_eq!(text, "\\xff".repeat(40) + "…");
    }
}
