//! `.dat`: what UTK, the sampling toolkit, reads and writes; also all that `.txt` holds.

use std::io::Write;

use super::error::Fault;
use super::gather::Gather;
use super::{Source, WriteError, rows};
use crate::{Ensemble, PointSet};

pub(super) fn read(source: &mut Source<'_>, gather: Gather) -> Result<Ensemble, Fault> {
    rows::read(source, gather, true)
}

pub(super) fn write(sets: &[PointSet], writer: &mut dyn Write) -> Result<(), WriteError> {
    for (i, set) in sets.iter().enumerate() {
        if i > 0 {
            writeln!(writer, "#")?;
        }
        rows::write(set, writer)?;
    }
    Ok(())
}
