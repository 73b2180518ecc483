//! `OpenEXR` files: linear f32, one channel `Y` or three `R`, `G`, `B`.

use std::io::{BufRead, Seek, Write};

use ::exr::block::writer::{ChunkWriter, ChunksWriter};
use ::exr::block::{BlockIndex, UncompressedBlock};
use ::exr::compression::Compression;
use ::exr::math::Vec2;
use ::exr::meta::attribute::{ChannelDescription, LineOrder, SampleType, Text};
use ::exr::meta::header::Header;
use ::exr::meta::{BlockDescription, MetaData};
use ::exr::prelude::{ReadChannels, ReadLayers, ReadSpecificChannel, SmallVec, read};
use rayon::prelude::*;

use super::{Channels, Image, ImageError, check_sides, checked_len, malformed};

/// Reads the channels `R`, `G`, `B`, or `Y`, or one that is alone in its part, of an EXR file: of those
/// that the first part with any of them suggests, from the first part that holds them.
///
/// Memory: the image, and the blocks that are being decompressed, whatever other channels there are;
/// what a file announces and doesn't hold takes none.
///
/// # Errors
/// If the file can't be read, is malformed, too large, or has other channels.
pub fn read_exr(mut input: impl BufRead + Seek) -> Result<Image, ImageError> {
    let start = input.stream_position()?;
    let meta = MetaData::read_from_buffered(&mut input, false).map_err(from_exr)?;
    let flat = || meta.headers.iter().filter(|header| !header.deep);
    let wanted = flat().find_map(Wanted::of);
    // The first part that has those channels, though another may have suggested them.
    let found = wanted.and_then(|wanted| Some((flat().find(|h| wanted.is_in(h))?, wanted)));
    let Some((header, wanted)) = found else {
        return Err(malformed("EXR", "there are no channels R, G, B or Y"));
    };
    let (width, height) = (header.layer_size.0, header.layer_size.1);
    let len = checked_len(width as u64, height as u64, wanted.channels())?;
    if header.max_block_byte_size() > MAX_BLOCK {
        return Err(malformed("EXR", "its blocks are absurdly large"));
    }
    input.seek(std::io::SeekFrom::Start(start))?;
    // Zeros that nothing was written to take no memory.
    let zeros = move || vec![0.0_f32; len];
    let flat = read().no_deep_data().largest_resolution_level().specific_channels();
    let channels = wanted.channels();
    let values = match wanted {
        Wanted::Rgb => {
            flat.required("R")
                .required("G")
                .required("B")
                .collect_pixels(
                    move |_, _| zeros(),
                    move |values, at, (r, g, b): (f32, f32, f32)| {
                        values[3 * (at.1 * width + at.0)..][..3].copy_from_slice(&[r, g, b]);
                    },
                )
                .first_valid_layer()
                .all_attributes()
                .from_buffered(input)
                .map_err(from_exr)?
                .layer_data
                .channel_data
                .pixels
        }
        Wanted::One(name) => {
            flat.required(name)
                .collect_pixels(
                    move |_, _| zeros(),
                    move |values, at, (value,): (f32,)| values[at.1 * width + at.0] = value,
                )
                .first_valid_layer()
                .all_attributes()
                .from_buffered(input)
                .map_err(from_exr)?
                .layer_data
                .channel_data
                .pixels
        }
    };
    Image::new(width as u32, height as u32, channels, values)
}

/// Most bytes of a block, which is decompressed as a whole.
const MAX_BLOCK: usize = 1 << 30;

/// The channels that are read.
enum Wanted {
    Rgb,
    One(Text),
}

impl Wanted {
    /// Those of a layer, if it has any.
    fn of(header: &Header) -> Option<Self> {
        let list = &header.channels.list;
        match (find(header, "Y"), list.as_slice()) {
            _ if Self::Rgb.is_in(header) => Some(Self::Rgb),
            (Some(one), _) | (_, [one]) => Some(Self::One(one.name.clone())),
            _ => None,
        }
    }

    /// Whether a layer has them.
    fn is_in(&self, header: &Header) -> bool {
        match self {
            Self::Rgb => ["R", "G", "B"].iter().all(|name| find(header, name).is_some()),
            Self::One(name) => header.channels.list.iter().any(|c| c.name == *name),
        }
    }

    fn channels(&self) -> Channels {
        match self {
            Self::Rgb => Channels::Rgb,
            Self::One(_) => Channels::Grey,
        }
    }
}

/// The channel of a layer that has this name.
fn find<'a>(header: &'a Header, name: &str) -> Option<&'a ChannelDescription> {
    header.channels.list.iter().find(|channel| channel.name.to_string() == name)
}

/// Writes an image as an EXR file, values as they are, losslessly compressed.
///
/// # Errors
/// If the output fails.
pub fn write_exr(image: &Image, output: impl Write + Seek) -> Result<(), ImageError> {
    stream_exr(output, image.width(), image.height(), image.channels(), |rows| {
        rows.write_rows(image.values())
    })
}

/// Writes an EXR file from rows that come from the top: `make` is called once and hands them to the
/// [`ExrRows`] it is given. Memory holds 64 rows and what compression takes.
///
/// # Errors
/// What `make` returns, or that rows are missing or the output fails.
pub fn stream_exr<W: Write + Seek, E: From<ImageError>>(
    output: W,
    width: u32,
    height: u32,
    channels: Channels,
    make: impl FnOnce(&mut ExrRows<'_, W>) -> Result<(), E>,
) -> Result<(), E> {
    let names: &[&str] = match channels {
        Channels::Grey => &["Y"],
        Channels::Rgb => &["B", "G", "R"],
    };
    let described =
        names.iter().map(|&name| ChannelDescription::named(name, SampleType::F32)).collect();
    check_sides(width, height).map_err(E::from)?;
    let size = Vec2(width as usize, height as usize);
    let header = Header::new(Text::from("image"), size, described).with_encoding(
        Compression::ZIP16,
        BlockDescription::ScanLines,
        LineOrder::Increasing,
    );
    let mut headers = SmallVec::new();
    headers.push(header);
    // What `make` fails with passes by the writer, which knows its own errors only.
    let mut failure = None;
    let written = ::exr::block::write(output, headers, false, |meta, writer| {
        let mut rows = ExrRows {
            meta: &meta,
            writer,
            width: size.0,
            height: size.1,
            channels,
            row: 0,
            pending: Vec::new(),
        };
        let made = make(&mut rows).and_then(|()| rows.finish().map_err(E::from));
        made.map_err(|error| {
            failure = Some(error);
            ::exr::error::Error::Aborted
        })
    });
    match failure {
        Some(error) => Err(error),
        None => Ok(written.map_err(from_exr)?),
    }
}

/// Rows of a block, as ZIP16 wants them.
const BLOCK_ROWS: usize = 16;

/// Blocks that are compressed at once.
const BLOCKS_AT_ONCE: usize = 4;

/// Takes the rows of an EXR file, from the top; see [`stream_exr`].
pub struct ExrRows<'w, W> {
    meta: &'w MetaData,
    writer: &'w mut ChunkWriter<W>,
    width: usize,
    height: usize,
    channels: Channels,
    /// Rows that are in the file.
    row: usize,
    /// Values of rows to come.
    pending: Vec<f32>,
}

impl<W: Write + Seek> ExrRows<'_, W> {
    /// Takes the next rows.
    ///
    /// # Errors
    /// If the output fails or there are more rows than the image has.
    pub fn write_rows(&mut self, values: &[f32]) -> Result<(), ImageError> {
        let group = BLOCKS_AT_ONCE * BLOCK_ROWS * self.row_len();
        let mut values = values;
        while !values.is_empty() {
            let (now, later) = values.split_at(values.len().min(group - self.pending.len()));
            self.pending.extend_from_slice(now);
            values = later;
            if self.pending.len() == group {
                self.flush()?;
            }
        }
        Ok(())
    }

    fn row_len(&self) -> usize {
        self.width * self.channels.count()
    }

    /// Compresses what is pending, in parallel, and writes it in order.
    fn flush(&mut self) -> Result<(), ImageError> {
        let rows = self.pending.len() / self.row_len();
        if self.row + rows > self.height {
            return Err(malformed("EXR", "there are more rows than the image has"));
        }
        let (first, meta) = (self.row, self.meta);
        let (width, channels) = (self.width, self.channels);
        let block_len = BLOCK_ROWS * self.row_len();
        let chunks: Vec<_> = self
            .pending
            .par_chunks(block_len)
            .enumerate()
            .map(|(i, values)| {
                let index = BlockIndex {
                    layer: 0,
                    pixel_position: Vec2(0, first + i * BLOCK_ROWS),
                    pixel_size: Vec2(width, values.len() / (width * channels.count())),
                    level: Vec2(0, 0),
                };
                let data = planar_bytes(values, width, channels);
                UncompressedBlock { index, data }.compress_to_chunk(&meta.headers)
            })
            .collect();
        for (i, chunk) in chunks.into_iter().enumerate() {
            let index = first / BLOCK_ROWS + i;
            self.writer.write_chunk(index, chunk.map_err(from_exr)?).map_err(from_exr)?;
        }
        self.row += rows;
        self.pending.clear();
        Ok(())
    }

    fn finish(&mut self) -> Result<(), ImageError> {
        let (rows, rest) =
            (self.row + self.pending.len() / self.row_len(), self.pending.len() % self.row_len());
        if rest > 0 {
            return Err(malformed("EXR", "the last row is not whole"));
        }
        if rows < self.height {
            let missing = self.height - rows;
            return Err(malformed("EXR", format!("{missing} rows were never written")));
        }
        self.flush()
    }
}

/// Rows as the format has them: in each row one channel after another, by name.
fn planar_bytes(values: &[f32], width: usize, channels: Channels) -> Vec<u8> {
    let count = channels.count();
    let mut bytes = Vec::with_capacity(4 * values.len());
    for row in values.chunks_exact(width * count) {
        // B, G, R: backwards.
        for channel in (0..count).rev() {
            let plane = row.iter().skip(channel).step_by(count);
            bytes.extend(plane.flat_map(|value| value.to_ne_bytes()));
        }
    }
    bytes
}

fn from_exr(error: ::exr::error::Error) -> ImageError {
    match error {
        ::exr::error::Error::Io(error) if error.kind() != std::io::ErrorKind::UnexpectedEof => {
            ImageError::Io(error)
        }
        other => malformed("EXR", other.to_string()),
    }
}
