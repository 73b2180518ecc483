//! `.csv`: rows `x,y` under an optional header.

use std::io::Write;

use super::error::Fault;
use super::gather::Gather;
use super::lines::{self, Lines};
use super::{Source, WriteError};
use crate::{Ensemble, PointSet};

pub(super) fn read(source: &mut Source<'_>, mut gather: Gather) -> Result<Ensemble, Fault> {
    let mut lines = Lines::new(source);
    let mut first = true;
    while let Some(line) = lines.next()? {
        let header = std::mem::replace(&mut first, false) && is_header(line);
        if !header {
            let problem =
                match fields(line).and_then(|(x, y)| lines::number(x).zip(lines::number(y))) {
                    Some((x, y)) => gather.push(x, y).err(),
                    None => Some(lines::not_a_point(line)),
                };
            if let Some(problem) = problem {
                return Err(Fault::at(lines.place(), problem));
            }
        }
    }
    gather.end_set()?;
    Ok(gather.finish()?)
}

fn is_header(line: &[u8]) -> bool {
    fields(line).is_some_and(|(x, y)| x.eq_ignore_ascii_case(b"x") && y.eq_ignore_ascii_case(b"y"))
}

/// The two fields of a row, without blanks and quotes around them.
fn fields(line: &[u8]) -> Option<(&[u8], &[u8])> {
    let comma = line.iter().position(|&b| b == b',')?;
    Some((unquoted(&line[..comma]), unquoted(&line[comma + 1..])))
}

fn unquoted(field: &[u8]) -> &[u8] {
    let field = field.trim_ascii();
    let inner = field.strip_prefix(b"\"").and_then(|rest| rest.strip_suffix(b"\""));
    inner.unwrap_or(field)
}

pub(super) fn write(set: &PointSet, writer: &mut dyn Write) -> Result<(), WriteError> {
    writeln!(writer, "x,y")?;
    for p in set.points() {
        writeln!(writer, "{:?},{:?}", p.x, p.y)?;
    }
    Ok(())
}
