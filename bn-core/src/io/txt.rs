//! `.txt`: what PSA, the analysis program of the thesis's authors, reads and writes.

use std::io::Write;

use super::error::Fault;
use super::gather::Gather;
use super::{Source, WriteError, rows};
use crate::{Ensemble, PointSet};

pub(super) fn read(source: &mut Source<'_>, gather: Gather) -> Result<Ensemble, Fault> {
    rows::read(source, gather, false)
}

pub(super) fn write(set: &PointSet, writer: &mut dyn Write) -> Result<(), WriteError> {
    writeln!(writer, "{}", set.len())?;
    rows::write(set, writer)
}
