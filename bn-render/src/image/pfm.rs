//! Portable float maps: a three-line header and raw f32 values, the last row first.

use std::io::{BufRead, Read, Seek, SeekFrom, Write};

use super::{Channels, Image, ImageError, check_sides, checked_len, malformed};

/// The longest header line that is read before the file is given up.
const MAX_LINE: u64 = 128;

/// Reads a PFM file: `Pf` (grey) or `PF` (RGB), width and height, a scale whose sign tells the
/// byte order (negative: little-endian), then rows from the bottom.
///
/// The scale's size is a unit that the format leaves to its user; values are taken as they are.
///
/// # Errors
/// If the file can't be read, is malformed, too large, or holds numbers that are not finite.
pub fn read_pfm(mut input: impl BufRead) -> Result<Image, ImageError> {
    let channels = match header_line(&mut input)?.as_str() {
        "Pf" => Channels::Grey,
        "PF" => Channels::Rgb,
        other => return Err(malformed("PFM", format!("it begins with {other:?}, not Pf or PF"))),
    };
    let sizes = header_line(&mut input)?;
    let mut numbers = sizes.split_ascii_whitespace().map(str::parse::<u32>);
    let (Some(Ok(width)), Some(Ok(height)), None) =
        (numbers.next(), numbers.next(), numbers.next())
    else {
        return Err(malformed("PFM", format!("{sizes:?} is not a width and a height")));
    };
    let scale_line = header_line(&mut input)?;
    let scale: f64 = scale_line.trim().parse().unwrap_or(f64::NAN);
    if !scale.is_finite() || scale == 0.0 {
        return Err(malformed("PFM", format!("{scale_line:?} is not a scale")));
    }
    let len = checked_len(u64::from(width), u64::from(height), channels)?;
    // Read as it comes: a header that promises too much can't claim memory.
    let mut bytes = Vec::new();
    input.take(4 * len as u64).read_to_end(&mut bytes)?;
    if bytes.len() != 4 * len {
        return Err(malformed(
            "PFM",
            format!("{} bytes of values, {} needed", bytes.len(), 4 * len),
        ));
    }
    let decode = |b: &[u8]| {
        let word = [b[0], b[1], b[2], b[3]];
        if scale < 0.0 { f32::from_le_bytes(word) } else { f32::from_be_bytes(word) }
    };
    let row_bytes = 4 * width as usize * channels.count();
    let rows = bytes.chunks_exact(row_bytes).rev();
    let values = rows.flat_map(|row| row.chunks_exact(4).map(decode)).collect();
    Image::new(width, height, channels, values)
}

/// A header line without its end.
fn header_line(input: &mut impl BufRead) -> Result<String, ImageError> {
    let mut line = Vec::new();
    input.by_ref().take(MAX_LINE).read_until(b'\n', &mut line)?;
    if line.pop() != Some(b'\n') {
        return Err(malformed("PFM", "the header breaks off or runs on"));
    }
    let text = String::from_utf8(line).map_err(|_| malformed("PFM", "the header is not text"))?;
    Ok(text.trim_end_matches('\r').to_owned())
}

/// Writes an image as a little-endian PFM file, values as they are.
///
/// # Errors
/// If the output fails.
pub fn write_pfm(image: &Image, output: impl Write + Seek) -> Result<(), ImageError> {
    let mut writer = PfmWriter::new(output, image.width(), image.height(), image.channels())?;
    writer.write_rows(image.values())?;
    writer.finish()
}

/// Writes a PFM file from rows that come from the top, as the renderer makes them.
///
/// The format wants the last row first, so each batch of rows is put in its place in the file.
pub struct PfmWriter<W: Write + Seek> {
    output: W,
    /// Where the values begin.
    data_start: u64,
    row_len: usize,
    rows_left: u64,
    bytes: Vec<u8>,
}

impl<W: Write + Seek> PfmWriter<W> {
    /// Writes the header at the output's current position.
    ///
    /// # Errors
    /// If a side is 0 or the output fails.
    pub fn new(
        mut output: W,
        width: u32,
        height: u32,
        channels: Channels,
    ) -> Result<Self, ImageError> {
        check_sides(width, height)?;
        let magic = match channels {
            Channels::Grey => "Pf",
            Channels::Rgb => "PF",
        };
        write!(output, "{magic}\n{width} {height}\n-1.0\n")?;
        let data_start = output.stream_position()?;
        let row_len = width as usize * channels.count();
        Ok(Self { output, data_start, row_len, rows_left: u64::from(height), bytes: Vec::new() })
    }

    /// Writes the next rows, from the top.
    ///
    /// # Errors
    /// If the output fails.
    ///
    /// # Panics
    /// If `values` is not a number of whole rows, or more than are left.
    pub fn write_rows(&mut self, values: &[f32]) -> Result<(), ImageError> {
        let rows = values.len() / self.row_len;
        assert!(
            rows * self.row_len == values.len() && rows as u64 <= self.rows_left,
            "not rows of this image"
        );
        self.rows_left -= rows as u64;
        self.bytes.clear();
        for row in values.chunks_exact(self.row_len).rev() {
            self.bytes.extend(row.iter().flat_map(|v| v.to_le_bytes()));
        }
        let place = self.data_start + self.rows_left * 4 * self.row_len as u64;
        self.output.seek(SeekFrom::Start(place))?;
        self.output.write_all(&self.bytes)?;
        Ok(())
    }

    /// Ends the file.
    ///
    /// # Errors
    /// If rows are missing or the output fails.
    pub fn finish(mut self) -> Result<(), ImageError> {
        if self.rows_left > 0 {
            return Err(malformed("PFM", format!("{} rows were never written", self.rows_left)));
        }
        self.output.flush()?;
        Ok(())
    }
}
