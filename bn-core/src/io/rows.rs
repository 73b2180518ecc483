//! Rows `x y` with an optional count in front and `#` lines around: what .txt and .dat share.

use std::io::Write;

use super::error::{Fault, Place};
use super::gather::Gather;
use super::lines::{self, Lines};
use super::{ReadProblem, Source, WriteError};
use crate::{Ensemble, PointSet};

/// Reads rows into sets. Lines that start with `#` end a set if `several` are allowed; otherwise no
/// point may follow one that follows a point.
pub(super) fn read(
    source: &mut Source<'_>,
    mut gather: Gather,
    several: bool,
) -> Result<Ensemble, Fault> {
    let mut lines = Lines::new(source);
    let mut count = None;
    let mut separated = false;
    while let Some(line) = lines.next()? {
        let in_set = |place: Place, sets| if several { place.in_set(sets) } else { place };
        if line[0] == b'#' {
            separated = gather.points() > 0;
            if separated && several {
                end_set(&mut gather, count.take(), several)?;
                separated = false;
            }
        } else if gather.points() == 0 && count.is_none() && line.iter().all(u8::is_ascii_digit) {
            let stated = String::from_utf8_lossy(line).into_owned();
            count = Some((stated, lines.place()));
        } else {
            let problem = match lines::pair(line) {
                _ if separated => Some(ReadProblem::SecondSet),
                Some((x, y)) => gather.push(x, y).err(),
                None => Some(lines::not_a_point(line)),
            };
            if let Some(problem) = problem {
                return Err(Fault::at(in_set(lines.place(), gather.sets()), problem));
            }
        }
    }
    if gather.points() > 0 || count.is_some() {
        end_set(&mut gather, count, several)?;
    }
    Ok(gather.finish()?)
}

fn end_set(
    gather: &mut Gather,
    count: Option<(String, Place)>,
    several: bool,
) -> Result<(), Fault> {
    let in_set = |place: Place| if several { place.in_set(gather.sets()) } else { place };
    if let Some((stated, place)) = count {
        let found = gather.points();
        if stated.parse() != Ok(found) {
            return Err(Fault::at(in_set(place), ReadProblem::Count { stated, found }));
        }
    }
    let place = in_set(Place::default());
    gather.end_set().map_err(|problem| Fault::at(place, problem))
}

/// Writes a row for each point of `set`.
pub(super) fn write(set: &PointSet, writer: &mut dyn Write) -> Result<(), WriteError> {
    for p in set.points() {
        // Debug output of floats is the shortest that reads back as the same number.
        writeln!(writer, "{:?} {:?}", p.x, p.y)?;
    }
    Ok(())
}
