//! `.rps`: raw little-endian 32-bit floats, x and y in turn, as PSA reads and writes them.

use std::io::Write;

use super::bytes::{self, CHUNK, Width};
use super::error::{Fault, Place};
use super::gather::Gather;
use super::{ReadProblem, Source, WriteError};
use crate::{Ensemble, PointSet};

pub(super) fn read(source: &mut Source<'_>, mut gather: Gather) -> Result<Ensemble, Fault> {
    let size = Width::F32.point();
    let mut chunk = vec![0; CHUNK];
    let mut offset = 0;
    loop {
        let filled = bytes::fill(source, &mut chunk)?;
        for (i, point) in chunk[..filled].chunks_exact(size).enumerate() {
            let (x, y) = Width::F32.decode(point);
            let place = || Place::byte(offset + (i * size) as u64);
            gather.push(x, y).map_err(|problem| Fault::at(place(), problem))?;
        }
        offset += filled as u64;
        if filled < CHUNK {
            break;
        }
    }
    if !offset.is_multiple_of(size as u64) {
        return Err(ReadProblem::PartialPoint { bytes: offset }.into());
    }
    gather.end_set()?;
    Ok(gather.finish()?)
}

pub(super) fn write(set: &PointSet, writer: &mut dyn Write) -> Result<(), WriteError> {
    for p in set.points() {
        writer.write_all(&rounded(p.x).to_le_bytes())?;
        writer.write_all(&rounded(p.y).to_le_bytes())?;
    }
    Ok(())
}

/// The nearest 32-bit float modulo 1: what rounds to 1 becomes 0.
fn rounded(x: f64) -> f32 {
    let x = x as f32;
    if x < 1.0 { x } else { 0.0 }
}
