//! `.npy`: NumPy's array files, format versions 1 to 3.
//!
//! Source: NumPy's documentation of `numpy.lib.format`. After the magic string come the version (two
//! bytes), the header's length (2 bytes in version 1, then 4), the header, a Python dictionary with
//! the keys descr, `fortran_order` and shape, and the numbers.

use std::io::{Read, Write};

use super::bytes::{self, CHUNK};
use super::error::{Fault, NpyProblem, Place};
use super::gather::Gather;
use super::npy_header::{self, Header};
use super::{Source, WriteError};
use crate::{Ensemble, PointSet};

const MAGIC: &[u8; 6] = b"\x93NUMPY";

/// NumPy itself refuses to evaluate headers above 10,000 bytes.
const LONGEST_HEADER: usize = 10_000;

pub(super) fn read(source: &mut Source<'_>, mut gather: Gather) -> Result<Ensemble, Fault> {
    let (header, start) = read_header(source)?;
    let several = header.sets.is_some();
    // Fits: the header's reader has multiplied it out.
    let expected = header.bytes;
    let mut chunk = vec![0; CHUNK];
    let mut offset = 0_u64;
    while offset < expected {
        let wanted = CHUNK.min(usize::try_from(expected - offset).unwrap_or(CHUNK));
        let filled = bytes::fill(source, &mut chunk[..wanted])?;
        let size = header.width.point();
        for (i, point) in chunk[..filled].chunks_exact(size).enumerate() {
            let (x, y) = header.width.decode(point);
            gather.push(x, y).map_err(|problem| {
                let place = Place::byte(start + offset + (i * size) as u64);
                Fault::at(if several { place.in_set(gather.sets()) } else { place }, problem)
            })?;
            if gather.points() as u64 == header.points {
                gather.end_set()?;
            }
        }
        offset += filled as u64;
        if filled < wanted {
            return Err(NpyProblem::Length { expected, found: Some(offset) }.into());
        }
    }
    if bytes::fill(source, &mut [0])? > 0 {
        return Err(NpyProblem::Length { expected, found: None }.into());
    }
    Ok(gather.finish()?)
}

/// The header, and where the numbers start.
fn read_header(source: &mut Source<'_>) -> Result<(Header, u64), Fault> {
    let mut prefix = [0; 8];
    let filled = bytes::fill(source, &mut prefix)?;
    if filled < prefix.len() || prefix[..6] != *MAGIC {
        return Err(NpyProblem::Magic.into());
    }
    let (major, minor) = (prefix[6], prefix[7]);
    let length_bytes = match major {
        1 => 2,
        2 | 3 => 4,
        _ => return Err(NpyProblem::Version { major, minor }.into()),
    };
    let cut = NpyProblem::Header { what: "the file ends in it" };
    let mut length = [0; 4];
    if bytes::fill(source, &mut length[..length_bytes])? < length_bytes {
        return Err(cut.into());
    }
    let length = u32::from_le_bytes(length) as usize;
    if length > LONGEST_HEADER {
        return Err(NpyProblem::Header { what: "it is longer than 10,000 bytes" }.into());
    }
    let mut header = Vec::with_capacity(length);
    source.take(length as u64).read_to_end(&mut header)?;
    if header.len() < length {
        return Err(cut.into());
    }
    let start = prefix.len() + length_bytes + length;
    Ok((npy_header::parse(&header)?, start as u64))
}

pub(super) fn write(sets: &[PointSet], writer: &mut dyn Write) -> Result<(), WriteError> {
    let n = sets[0].len();
    if let Some(set) = sets.iter().position(|set| set.len() != n) {
        return Err(WriteError::UnequalSets { first: n, set, points: sets[set].len() });
    }
    let shape = match sets.len() {
        1 => format!("({n}, 2)"),
        m => format!("({m}, {n}, 2)"),
    };
    let mut header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}");
    // The numbers start at a multiple of 64 bytes, after a line feed.
    let before = MAGIC.len() + 2 + 2;
    while !(before + header.len() + 1).is_multiple_of(64) {
        header.push(' ');
    }
    header.push('\n');
    writer.write_all(MAGIC)?;
    writer.write_all(&[1, 0])?;
    writer.write_all(&(header.len() as u16).to_le_bytes())?;
    writer.write_all(header.as_bytes())?;
    for p in sets.iter().flat_map(PointSet::points) {
        writer.write_all(&p.x.to_le_bytes())?;
        writer.write_all(&p.y.to_le_bytes())?;
    }
    Ok(())
}
