//! Bytes in the forms that pages carry: PNG files and base 64.

use png::{
    BitDepth, ColorType, Compression, Encoder, EncodingError, Filter, PixelDimensions, Unit,
};

/// What a PNG file says besides its pixels.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PngNotes<'a> {
    /// Keyword and text of UTF-8 text chunks; empty texts are left out.
    pub texts: &'a [(&'a str, &'a str)],
    /// Pixels per metre for programs that print.
    pub pixels_per_metre: Option<u32>,
}

/// A PNG file of 8-bit samples, row by row from the top. Compression and filter are fixed, so that
/// the bytes depend on the pixels alone (and on the version of the compressor).
pub(super) fn png(
    (width, height): (u32, u32),
    color: ColorType,
    samples: &[u8],
    notes: PngNotes<'_>,
) -> Result<Vec<u8>, EncodingError> {
    let mut file = vec![];
    let mut encoder = Encoder::new(&mut file, width, height);
    encoder.set_color(color);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Balanced);
    // Pages are flat areas and noise: unfiltered rows came out smaller and sooner than filtered ones.
    encoder.set_filter(Filter::NoFilter);
    encoder.set_pixel_dims(notes.pixels_per_metre.map(|density| PixelDimensions {
        xppu: density,
        yppu: density,
        unit: Unit::Meter,
    }));
    for (keyword, text) in notes.texts.iter().filter(|(_, text)| !text.is_empty()) {
        // The format forbids a zero byte in a text.
        encoder.add_itxt_chunk((*keyword).to_string(), text.replace('\0', " "))?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(samples)?;
    writer.finish()?;
    Ok(file)
}

/// `bytes` as a URI that holds them, for pages that need no other file.
pub fn data_uri(media_type: &str, bytes: &[u8]) -> String {
    format!("data:{media_type};base64,{}", base64(bytes))
}

/// Base 64 with padding (RFC 4648, section 4).
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let byte = |i: usize| u32::from(group.get(i).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for digit in 0..4 {
            if digit <= group.len() {
                text.push(DIGITS[(bits >> (18 - 6 * digit)) as usize & 63] as char);
            } else {
                text.push('=');
            }
        }
    }
    text
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    #[test]
    fn base64_meets_the_vectors_of_rfc_4648() {
        for (bytes, text) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
    }

    #[test]
    fn png_round_trips_with_its_notes() {
        let pixels: Vec<u8> = (0..35).collect();
        let notes = PngNotes {
            texts: &[("Source", "n = 16, ν\0"), ("Title", "")],
            pixels_per_metre: Some(7),
        };
        let file = png((7, 5), ColorType::Grayscale, &pixels, notes).unwrap();
        assert_eq!(file, png((7, 5), ColorType::Grayscale, &pixels, notes).unwrap());
        let mut reader = png::Decoder::new(std::io::Cursor::new(&file)).read_info().unwrap();
        let mut read = vec![0; 35];
        reader.next_frame(&mut read).unwrap();
        assert_eq!(read, pixels);
        let info = reader.info();
        assert_eq!(info.pixel_dims.unwrap().xppu, 7);
        assert_eq!(info.utf8_text.len(), 1);
        assert_eq!(info.utf8_text[0].get_text().unwrap(), "n = 16, ν ");
    }
}
