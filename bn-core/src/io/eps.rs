//! `.eps`: PostScript of the kind that PSA writes, in which every point is a line `x y p`.

use std::io::Write;

use super::error::{Fault, Place};
use super::gather::Gather;
use super::lines::{self, Lines};
use super::{ReadProblem, Source, WriteError};
use crate::{Ensemble, PointSet};

/// A comment of our own: the number of points, so that a file that was cut off is noticed.
const COUNT: &[u8] = b"%points";

/// Edge of the drawing in PostScript points.
const EDGE: u32 = 512;

pub(super) fn read(source: &mut Source<'_>, mut gather: Gather) -> Result<Ensemble, Fault> {
    let mut lines = Lines::new(source);
    let mut count: Option<(String, Place)> = None;
    while let Some(line) = lines.next()? {
        if let Some(stated) = stated_count(line) {
            count = Some((stated, lines.place()));
            continue;
        }
        let problem = match dot(line) {
            Line::Dot(x, y) => gather.push(x, y).err(),
            Line::BrokenDot => Some(lines::not_a_point(line)),
            Line::Other => None,
        };
        if let Some(problem) = problem {
            return Err(Fault::at(lines.place(), problem));
        }
    }
    if let Some((stated, place)) = count {
        let found = gather.points();
        if stated.parse() != Ok(found) {
            return Err(Fault::at(place, ReadProblem::Count { stated, found }));
        }
    }
    gather.end_set()?;
    Ok(gather.finish()?)
}

/// What follows the word `%points`.
fn stated_count(line: &[u8]) -> Option<String> {
    let stated = line.strip_prefix(COUNT)?;
    let is_word = stated.first().is_none_or(u8::is_ascii_whitespace);
    is_word.then(|| stated.trim_ascii().escape_ascii().to_string())
}

enum Line {
    Dot(f64, f64),
    /// The dot operator on something else than two numbers.
    BrokenDot,
    Other,
}

/// A point is a line of three words, two numbers and one that starts with p; comments are not.
fn dot(line: &[u8]) -> Line {
    let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    let (Some(x), Some(y), Some(operator), None) =
        (words.next(), words.next(), words.next(), words.next())
    else {
        return Line::Other;
    };
    if x[0] == b'%' || operator[0] != b'p' {
        return Line::Other;
    }
    match lines::number(x).zip(lines::number(y)) {
        Some((x, y)) => Line::Dot(x, y),
        None if operator == b"p" => Line::BrokenDot,
        None => Line::Other,
    }
}

pub(super) fn write(set: &PointSet, writer: &mut dyn Write) -> Result<(), WriteError> {
    // Dots of a fifth of the hexagonal spacing, but never larger than 3 of 512 units.
    let radius = (0.2 * set.density().hexagonal_spacing()).min(3.0 / f64::from(EDGE));
    writeln!(writer, "%!PS-Adobe-3.0 EPSF-3.0")?;
    writeln!(writer, "%%BoundingBox: -3 -3 {0} {0}", EDGE + 3)?;
    writeln!(writer, "%%EndComments")?;
    writeln!(writer, "%points {}", set.len())?;
    writeln!(writer, "/radius {{ {radius:.8} }} def")?;
    writeln!(writer, "/p {{ newpath radius 0 360 arc fill }} def")?;
    writeln!(writer, "gsave")?;
    writeln!(writer, "{EDGE} {EDGE} scale")?;
    writeln!(writer, "0 setgray")?;
    for p in set.points() {
        writeln!(writer, "{:?} {:?} p", p.x, p.y)?;
    }
    writeln!(writer, "grestore\nshowpage\n%%EOF")?;
    Ok(())
}
