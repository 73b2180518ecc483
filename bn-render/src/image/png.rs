//! PNG files of 8 or 16 bits a channel.

use std::io::{BufRead, Seek, Write};

use png::{ColorType, Compression, ScaledFloat, SrgbRenderingIntent, Transformations};

use super::encoding::{Encoding, Quantizer};
use super::{Channels, Image, ImageError, checked_len, malformed};

/// Bits for each channel of a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum BitDepth {
    /// 8 bits: 256 levels.
    #[default]
    Eight,
    /// 16 bits: 65,536 levels.
    Sixteen,
}

/// How much work goes into making the file small.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PngEncoding {
    /// Little: hundreds of megabytes a second, the file half as large again.
    #[default]
    Fast,
    /// Ten times as much.
    Small,
}

/// What a PNG file is to be like.
#[derive(Clone, Debug, Default)]
pub struct PngOptions {
    /// Bits for each channel.
    pub depth: BitDepth,
    /// The transfer curve; told to readers by an `sRGB` chunk or a `gAMA` chunk of 1.
    pub encoding: Encoding,
    /// Speed against size.
    pub compression: PngEncoding,
    /// Keywords (1 to 79 Latin-1 characters) and texts to put into the file, such as the command.
    pub text: Vec<(String, String)>,
}

/// The largest interlaced image that is read, in bytes: it has to be held twice.
const MAX_INTERLACED: usize = 1 << 28;

/// Reads a PNG file of any kind as linear light; an alpha channel is ignored.
///
/// The transfer curve is `encoding` where given, else what the file says (`sRGB` or `gAMA`), else
/// sRGB. A gamma of 1/2.2 is taken for sRGB, which it is written for; any other is a power law.
///
/// # Errors
/// If the file can't be read, is malformed, larger than [`Image::MAX_SAMPLES`], or interlaced and larger than 256 MB.
pub fn read_png(
    input: impl BufRead + Seek,
    encoding: Option<Encoding>,
) -> Result<Image, ImageError> {
    let mut decoder = png::Decoder::new_with_limits(input, png::Limits { bytes: 1 << 30 });
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(from_decoding)?;
    let (color, depth) = reader.output_color_type();
    let info = reader.info();
    let curve = encoding.map_or_else(|| Curve::of_file(info), Curve::from);
    let (width, height, interlaced) = (info.width, info.height, info.interlaced);
    let channels = match color {
        ColorType::Grayscale | ColorType::GrayscaleAlpha => Channels::Grey,
        _ => Channels::Rgb,
    };
    checked_len(u64::from(width), u64::from(height), channels)?;
    let light = curve.table(depth == png::BitDepth::Sixteen);
    let mut pixels =
        Pixels { samples: color.samples(), used: channels.count(), light, values: Vec::new() };
    if interlaced {
        let size = reader.output_buffer_size().filter(|&size| size <= MAX_INTERLACED);
        let size = size.ok_or_else(|| {
            malformed(
                "PNG",
                "the interlaced image is larger than 256 MB; save it without interlacing",
            )
        })?;
        let mut bytes = vec![0; size];
        reader.next_frame(&mut bytes).map_err(from_decoding)?;
        pixels.append(&bytes);
    } else {
        // Row by row: a header that promises too much can't claim memory.
        for _ in 0..height {
            let row = reader.next_row().map_err(from_decoding)?;
            pixels.append(row.ok_or_else(|| malformed("PNG", "rows are missing"))?.data());
        }
    }
    // Rows are complete before the checksum of the last of them is read.
    reader.finish().map_err(from_decoding)?;
    Image::new(width, height, channels, pixels.values)
}

/// Collects pixels as linear light.
struct Pixels {
    /// Numbers stored for a pixel, alpha included.
    samples: usize,
    /// Of these, the ones that are kept.
    used: usize,
    /// Linear light of each stored integer; 256 or 65,536 of them.
    light: Vec<f32>,
    values: Vec<f32>,
}

impl Pixels {
    fn append(&mut self, bytes: &[u8]) {
        let (used, light) = (self.used, &self.light);
        if light.len() == 256 {
            let pixels = bytes.chunks_exact(self.samples);
            self.values
                .extend(pixels.flat_map(|p| p[..used].iter().map(|&b| light[usize::from(b)])));
        } else {
            let word = |w: &[u8]| light[usize::from(u16::from_be_bytes([w[0], w[1]]))];
            let pixels = bytes.chunks_exact(2 * self.samples);
            self.values.extend(pixels.flat_map(|p| p[..2 * used].chunks_exact(2).map(word)));
        }
    }
}

/// The transfer curve of a file.
enum Curve {
    Standard(Encoding),
    /// Light is the stored value to this power.
    Power(f64),
}

impl From<Encoding> for Curve {
    fn from(encoding: Encoding) -> Self {
        Self::Standard(encoding)
    }
}

impl Curve {
    fn of_file(info: &png::Info<'_>) -> Self {
        let gamma = info.gama_chunk.map(|gamma| f64::from(gamma.into_value()));
        match gamma {
            _ if info.srgb.is_some() => Self::Standard(Encoding::Srgb),
            Some(gamma) if (gamma - 1.0).abs() < 1e-4 => Self::Standard(Encoding::Linear),
            Some(gamma) if gamma > 0.01 && (gamma - 1.0 / 2.2).abs() > 1e-3 => {
                Self::Power(1.0 / gamma)
            }
            _ => Self::Standard(Encoding::Srgb),
        }
    }

    /// Linear light of all stored integers.
    fn table(&self, sixteen: bool) -> Vec<f32> {
        let max = if sixteen { u32::from(u16::MAX) } else { u32::from(u8::MAX) };
        let light = |k: u32| {
            let stored = f64::from(k) / f64::from(max);
            match self {
                Self::Standard(encoding) => encoding.decode(stored) as f32,
                Self::Power(power) => libm::pow(stored, *power) as f32,
            }
        };
        (0..=max).map(light).collect()
    }
}

/// Writes an image as a PNG file; values outside [0, 1] are clamped.
///
/// # Errors
/// If the output fails or a text is not fit for PNG.
pub fn write_png(
    image: &Image,
    output: impl Write,
    options: &PngOptions,
) -> Result<(), ImageError> {
    let mut header =
        write_header(output, image.width(), image.height(), image.channels(), options)?;
    let mut stream = header.stream_writer().map_err(from_encoding)?;
    stream.write_all(&Samples::new(options).bytes(image.values()))?;
    stream.finish().map_err(from_encoding)
}

/// Writes a PNG file row by row. The bytes don't depend on how the rows are divided into calls.
pub struct PngWriter<W: Write + 'static> {
    stream: png::StreamWriter<'static, W>,
    samples: Samples,
}

impl<W: Write + 'static> PngWriter<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// If the output fails or a text is not fit for PNG.
    pub fn new(
        output: W,
        width: u32,
        height: u32,
        channels: Channels,
        options: &PngOptions,
    ) -> Result<Self, ImageError> {
        let header = write_header(output, width, height, channels, options)?;
        let stream = header.into_stream_writer().map_err(from_encoding)?;
        Ok(Self { stream, samples: Samples::new(options) })
    }

    /// Writes the next rows.
    ///
    /// # Errors
    /// If the output fails or there are more rows than the image has.
    pub fn write_rows(&mut self, values: &[f32]) -> Result<(), ImageError> {
        self.stream.write_all(&self.samples.bytes(values))?;
        Ok(())
    }

    /// Ends the file.
    ///
    /// # Errors
    /// If the output fails or rows are missing.
    pub fn finish(self) -> Result<(), ImageError> {
        self.stream.finish().map_err(from_encoding)
    }
}

fn write_header<W: Write>(
    output: W,
    width: u32,
    height: u32,
    channels: Channels,
    options: &PngOptions,
) -> Result<png::Writer<W>, ImageError> {
    let mut encoder = png::Encoder::new(output, width, height);
    encoder.set_color(match channels {
        Channels::Grey => ColorType::Grayscale,
        Channels::Rgb => ColorType::Rgb,
    });
    encoder.set_depth(match options.depth {
        BitDepth::Eight => png::BitDepth::Eight,
        BitDepth::Sixteen => png::BitDepth::Sixteen,
    });
    encoder.set_compression(match options.compression {
        PngEncoding::Fast => Compression::Fast,
        PngEncoding::Small => Compression::High,
    });
    match options.encoding {
        Encoding::Srgb => encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric),
        Encoding::Linear => encoder.set_source_gamma(ScaledFloat::new(1.0)),
    }
    for (keyword, text) in &options.text {
        encoder.add_text_chunk(keyword.clone(), text.clone()).map_err(from_encoding)?;
    }
    encoder.write_header().map_err(from_encoding)
}

/// Turns linear light into the bytes of samples.
struct Samples {
    quantizer: Quantizer,
    depth: BitDepth,
}

impl Samples {
    fn new(options: &PngOptions) -> Self {
        let max = match options.depth {
            BitDepth::Eight => u16::from(u8::MAX),
            BitDepth::Sixteen => u16::MAX,
        };
        Self { quantizer: Quantizer::new(options.encoding, max), depth: options.depth }
    }

    fn bytes(&self, values: &[f32]) -> Vec<u8> {
        let codes = values.iter().map(|&v| self.quantizer.quantize(v));
        match self.depth {
            BitDepth::Eight => codes.map(|code| code as u8).collect(),
            BitDepth::Sixteen => codes.flat_map(u16::to_be_bytes).collect(),
        }
    }
}

fn from_decoding(error: png::DecodingError) -> ImageError {
    match error {
        png::DecodingError::IoError(error) if error.kind() != std::io::ErrorKind::UnexpectedEof => {
            ImageError::Io(error)
        }
        other => malformed("PNG", other.to_string()),
    }
}

fn from_encoding(error: png::EncodingError) -> ImageError {
    match error {
        png::EncodingError::IoError(error) => ImageError::Io(error),
        other => malformed("PNG", other.to_string()),
    }
}
