//! The dictionary at the head of a .npy file.

use super::bytes::Width;
use super::error::NpyProblem;

/// What the header of a readable file says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) width: Width,
    /// Number of sets, if the array has three dimensions.
    pub(super) sets: Option<u64>,
    /// Points of each set.
    pub(super) points: u64,
    /// Bytes of all numbers.
    pub(super) bytes: u64,
}

/// Parses `{'descr': '<f8', 'fortran_order': False, 'shape': (n, 2), }`, keys in any order.
pub(super) fn parse(text: &[u8]) -> Result<Header, NpyProblem> {
    let mut cursor = Cursor { rest: text };
    let (mut width, mut fortran_order, mut shape) = (None, None, None);
    cursor.expect(b"{", "it does not start with {")?;
    while !cursor.skip(b"}") {
        let key = cursor.string().ok_or(damaged("a key is not a string"))?;
        cursor.expect(b":", "a colon is missing")?;
        match key {
            b"descr" => width = Some(cursor.width()?),
            b"fortran_order" => fortran_order = Some(cursor.boolean()?),
            b"shape" => shape = Some(cursor.shape()?),
            _ => return Err(damaged("it has a key other than descr, fortran_order and shape")),
        }
        if !cursor.skip(b",") {
            cursor.expect(b"}", "a comma is missing")?;
            break;
        }
    }
    if !cursor.rest.trim_ascii().is_empty() {
        return Err(damaged("something follows the closing }"));
    }
    let width = width.ok_or(damaged("the key descr is missing"))?;
    let (sets, points) = shape.ok_or(damaged("the key shape is missing"))?;
    if fortran_order.ok_or(damaged("the key fortran_order is missing"))? {
        return Err(NpyProblem::FortranOrder);
    }
    let bytes = (width.point() as u64)
        .checked_mul(points)
        .and_then(|bytes| bytes.checked_mul(sets.unwrap_or(1)))
        .ok_or(damaged("its shape asks for more than 2⁶⁴ bytes"))?;
    Ok(Header { width, sets, points, bytes })
}

fn damaged(what: &'static str) -> NpyProblem {
    NpyProblem::Header { what }
}

struct Cursor<'a> {
    rest: &'a [u8],
}

impl<'a> Cursor<'a> {
    /// Goes past `token` and blanks in front of it, if it comes next.
    fn skip(&mut self, token: &[u8]) -> bool {
        let rest = self.rest.trim_ascii_start().strip_prefix(token);
        self.rest = rest.unwrap_or(self.rest);
        rest.is_some()
    }

    fn expect(&mut self, token: &[u8], what: &'static str) -> Result<(), NpyProblem> {
        if self.skip(token) { Ok(()) } else { Err(damaged(what)) }
    }

    /// A string in single or double quotes, without escapes.
    fn string(&mut self) -> Option<&'a [u8]> {
        let (&quote, rest) = self.rest.trim_ascii_start().split_first()?;
        if quote != b'\'' && quote != b'"' {
            return None;
        }
        let end = rest.iter().position(|&b| b == quote)?;
        self.rest = &rest[end + 1..];
        Some(&rest[..end])
    }

    fn width(&mut self) -> Result<Width, NpyProblem> {
        let before = self.rest.trim_ascii();
        match self.string() {
            Some(b"<f4") => Ok(Width::F32),
            Some(b"<f8") => Ok(Width::F64),
            other => {
                // Structured types are lists.
                let descr = other.unwrap_or(before);
                let shown = &descr[..descr.len().min(40)];
                Err(NpyProblem::Type { descr: shown.escape_ascii().to_string() })
            }
        }
    }

    fn boolean(&mut self) -> Result<bool, NpyProblem> {
        if self.skip(b"True") {
            Ok(true)
        } else {
            self.expect(b"False", "fortran_order is neither True nor False").map(|()| false)
        }
    }

    /// Number of sets, if given, and of points.
    fn shape(&mut self) -> Result<(Option<u64>, u64), NpyProblem> {
        self.expect(b"(", "the shape does not start with (")?;
        let end = self.rest.iter().position(|&b| b == b')').ok_or(damaged("the shape has no )"))?;
        let (inside, rest) = self.rest.split_at(end);
        self.rest = &rest[1..];
        let sizes: Option<Vec<u64>> = std::str::from_utf8(inside).ok().and_then(|inside| {
            let inside = inside.trim();
            // Python 2 wrote its long integers as 4096L; a comma may follow the last size.
            let sizes = inside.strip_suffix(',').unwrap_or(inside).split(',').map(str::trim);
            sizes.map(|size| size.strip_suffix('L').unwrap_or(size).parse().ok()).collect()
        });
        match sizes.as_deref() {
            Some(&[points, 2]) => Ok((None, points)),
            Some(&[sets, points, 2]) => Ok((Some(sets), points)),
            _ => {
                let shown = &inside[..inside.len().min(40)];
                Err(NpyProblem::Shape { shape: format!("({})", shown.escape_ascii()) })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(descr: &str, order: &str, shape: &str) -> Result<Header, NpyProblem> {
        let text =
            format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}   \n");
        parse(text.as_bytes())
    }

    #[test]
    fn reads_what_numpy_writes() {
        let set = Header { width: Width::F64, sets: None, points: 10, bytes: 160 };
        assert_eq!(header("'<f8'", "False", "(10, 2)"), Ok(set));
        let sets = Header { width: Width::F32, sets: Some(3), points: 10, bytes: 240 };
        assert_eq!(header("'<f4'", "False", "(3L, 10L, 2L)"), Ok(sets));
        let other_order = br#"{"shape":(10,2,),"descr":"<f8","fortran_order":False}"#;
        assert_eq!(parse(other_order), Ok(set));
    }

    #[test]
    fn says_what_is_not_read() {
        for descr in ["'>f8'", "'<f2'", "'<i8'", "'|u1'", "'=f8'"] {
            let error = header(descr, "False", "(10, 2)").expect_err("another type");
            let bare = descr.trim_matches('\'').to_owned();
            assert_eq!(error, NpyProblem::Type { descr: bare });
        }
        let structured = header("[('x', '<f8'), ('y', '<f8')]", "False", "(10,)");
        assert!(matches!(structured, Err(NpyProblem::Type { descr }) if descr.starts_with("[(")));
        assert_eq!(header("'<f8'", "True", "(10, 2)"), Err(NpyProblem::FortranOrder));
        for shape in ["()", "(2,)", "(2, 10)", "(10, 3)", "(1, 1, 10, 2)", "(-1, 2)", "(1e3, 2)"] {
            assert_eq!(
                header("'<f8'", "False", shape),
                Err(NpyProblem::Shape { shape: shape.to_owned() })
            );
        }
        let vast = "(9223372036854775807, 9223372036854775807, 2)";
        assert!(matches!(header("'<f8'", "False", vast), Err(NpyProblem::Header { .. })));
        let beyond_u64 = "(99999999999999999999, 2)";
        assert!(matches!(header("'<f8'", "False", beyond_u64), Err(NpyProblem::Shape { .. })));
    }

    #[test]
    fn damage_is_an_error() {
        let good = b"{'descr': '<f8', 'fortran_order': False, 'shape': (10, 2), }";
        assert!(parse(good).is_ok());
        for end in 0..good.len() {
            assert!(parse(&good[..end]).is_err(), "cut at {end}");
        }
        for text in ["", "{}", "{'descr': '<f8'}", "{'a': 1}", "{'shape': (1, 2), 'shape'}"] {
            assert!(matches!(parse(text.as_bytes()), Err(NpyProblem::Header { .. })), "{text}");
        }
        assert!(parse(b"{'descr': '<f8', 'fortran_order': False, 'shape': (10, 2), } x").is_err());
    }
}
