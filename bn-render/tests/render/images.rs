//! Image files: what is written is read again, and what is broken is refused.

use std::io::Cursor;

use bn_render::{
    BitDepth, Channels, Encoding, Image, ImageError, PfmWriter, PngEncoding, PngOptions, PngWriter,
    read_pfm, read_png, write_pfm, write_png,
};
use proptest::prelude::*;

fn image(width: u32, height: u32, channels: Channels) -> Image {
    let n = width as usize * height as usize * channels.count();
    let values = (0..n).map(|i| (i * 37 % 256) as f32 / 255.0).collect();
    Image::new(width, height, channels, values).expect("an image")
}

fn png_bytes(image: &Image, options: &PngOptions) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_png(image, &mut bytes, options).expect("written");
    bytes
}

fn pfm_bytes(image: &Image) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    write_pfm(image, &mut file).expect("written");
    file.into_inner()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, ..ProptestConfig::default() })]

    #[test]
    fn pfm_keeps_every_bit(
        width in 1_u32..20, height in 1_u32..20, rgb in any::<bool>(), seed in any::<u32>(),
    ) {
        let channels = if rgb { Channels::Rgb } else { Channels::Grey };
        let n = (width * height) as usize * channels.count();
        let finite = |i: usize| {
            let bits = (i as u32 + 1).wrapping_mul(seed | 1).wrapping_mul(2_654_435_761);
            Some(f32::from_bits(bits)).filter(|v| v.is_finite()).unwrap_or(0.5)
        };
        let image = Image::new(width, height, channels, (0..n).map(finite).collect()).expect("an image");
        prop_assert_eq!(read_pfm(&pfm_bytes(&image)[..]).expect("read"), image);
    }

    #[test]
    fn broken_files_are_errors_not_panics(
        cut in 0.0_f64..1.0, flip in 0.0_f64..1.0, bit in 0_u8..8, format in 0_usize..FORMATS.len(),
    ) {
        let Format { name, write, read } = &FORMATS[format];
        let whole = write(&image(13, 7, Channels::Rgb));
        let short = &whole[..(cut * whole.len() as f64) as usize];
        prop_assert!(read(short).is_err(), "{name} cut at {}", short.len());
        let mut changed = whole.clone();
        let place = (flip * whole.len() as f64) as usize;
        changed[place] ^= 1 << bit;
        // Either refused or an image: values may differ, nothing may panic.
        if let Ok(image) = read(&changed) {
            prop_assert!(image.values().iter().all(|v| v.is_finite()));
            // Every chunk has a checksum; what a reader may skip decides nothing here.
            prop_assert!(*name != "png" || image == read(&whole).expect("whole"), "flip at {place}");
        }
    }
}

#[test]
fn png_keeps_what_its_depth_can_hold() {
    for channels in [Channels::Grey, Channels::Rgb] {
        for encoding in [Encoding::Srgb, Encoding::Linear] {
            for (depth, levels) in [(BitDepth::Eight, 255.0), (BitDepth::Sixteen, 65535.0)] {
                for compression in [PngEncoding::Fast, PngEncoding::Small] {
                    let image = image(31, 17, channels);
                    let options = PngOptions { depth, encoding, compression, text: vec![] };
                    let bytes = png_bytes(&image, &options);
                    let read = read_png(Cursor::new(&bytes), None).expect("read");
                    assert_eq!((read.width(), read.height(), read.channels()), (31, 17, channels));
                    for (got, want) in read.values().iter().zip(image.values()) {
                        let off =
                            encoding.encode(f64::from(*got)) - encoding.encode(f64::from(*want));
                        assert!(off.abs() <= 0.501 / levels, "{got} for {want}");
                    }
                    // What was read is exactly representable, so a second trip changes nothing.
                    let again = png_bytes(&read, &options);
                    assert_eq!(read_png(Cursor::new(again), None).expect("read"), read);
                }
            }
        }
    }
}

#[test]
fn the_encoding_can_be_overruled() {
    let image = Image::new(1, 1, Channels::Grey, vec![1.0 / 255.0 * 128.0]).expect("an image");
    let linear = PngOptions { encoding: Encoding::Linear, ..PngOptions::default() };
    let bytes = png_bytes(&image, &linear);
    let as_said = read_png(Cursor::new(&bytes), None).expect("read");
    assert!((as_said.values()[0] - 128.0 / 255.0).abs() < 1e-6);
    let as_told = read_png(Cursor::new(&bytes), Some(Encoding::Srgb)).expect("read");
    assert!((as_told.values()[0] - 0.215_860_5).abs() < 1e-6);
}

#[test]
fn values_out_of_range_are_clamped() {
    let image = Image::new(2, 1, Channels::Grey, vec![-0.5, 1.5]).expect("an image");
    let read =
        read_png(Cursor::new(png_bytes(&image, &PngOptions::default())), None).expect("read");
    assert_eq!(read.values(), [0.0, 1.0]);
}

#[test]
fn streaming_gives_the_same_bytes() {
    let image = image(40, 33, Channels::Rgb);
    let options =
        PngOptions { text: vec![("Comment".into(), "seed 1".into())], ..PngOptions::default() };
    let shared = tempfile();
    let mut png = PngWriter::new(shared.clone(), 40, 33, Channels::Rgb, &options).expect("begun");
    let mut pfm = PfmWriter::new(Cursor::new(Vec::new()), 40, 33, Channels::Rgb).expect("begun");
    for rows in image.values().chunks(40 * 3 * 10) {
        png.write_rows(rows).expect("written");
        pfm.write_rows(rows).expect("written");
    }
    png.finish().expect("complete");
    pfm.finish().expect("complete");
    assert_eq!(shared.bytes(), png_bytes(&image, &options));
}

/// A file in memory that outlives its writer.
#[derive(Clone)]
struct Shared(std::sync::Arc<std::sync::Mutex<Vec<u8>>>);

fn tempfile() -> Shared {
    Shared(std::sync::Arc::default())
}

impl Shared {
    fn bytes(&self) -> Vec<u8> {
        self.0.lock().expect("no panic").clone()
    }
}

impl std::io::Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().expect("no panic").extend_from_slice(bytes);
        Ok(bytes.len())
    }
    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[test]
fn unfinished_files_are_told() {
    let mut pfm = PfmWriter::new(Cursor::new(Vec::new()), 4, 4, Channels::Grey).expect("begun");
    pfm.write_rows(&[0.0; 8]).expect("written");
    assert!(matches!(pfm.finish(), Err(ImageError::Format { .. })));
    let mut png =
        PngWriter::new(tempfile(), 4, 4, Channels::Grey, &PngOptions::default()).expect("begun");
    png.write_rows(&[0.0; 8]).expect("written");
    assert!(png.finish().is_err());
}

#[test]
fn pfm_headers_are_checked() {
    let refused = |bytes: &[u8]| {
        matches!(read_pfm(bytes), Err(ImageError::Format { .. } | ImageError::Size { .. }))
    };
    for bad in [
        &b""[..],
        b"P5\n1 1\n-1\n\0\0\0\0",
        b"Pf\n1\n-1\n\0\0\0\0",
        b"Pf\n1 1 1\n-1\n\0\0\0\0",
        b"Pf\n-1 1\n-1\n\0\0\0\0",
        b"Pf\n1 1\n0\n\0\0\0\0",
        b"Pf\n1 1\nnan\n\0\0\0\0",
        b"Pf\n1 1\n-1\n\0\0\0",
        b"Pf\n0 1\n-1\n",
        b"Pf\n4000000000 4000000000\n-1\n\0\0\0\0",
        b"Pf\n30000 30000\n-1\n\0\0\0\0",
        b"\xff\xfe\n1 1\n-1\n",
    ] {
        assert!(refused(bad), "{bad:?}");
    }
    assert!(matches!(
        read_pfm(&b"Pf\n1 1\n-1\n\0\0\x80\x7f"[..]),
        Err(ImageError::NotFinite { .. })
    ));
    // Big-endian, Windows line ends, two rows: the first in the file is the lower.
    let big = b"Pf\r\n1 2\r\n1.0\r\n\x3f\x00\x00\x00\x3e\x80\x00\x00";
    assert_eq!(read_pfm(&big[..]).expect("read").values(), [0.25, 0.5]);
}

/// A way to files and back.
struct Format {
    name: &'static str,
    write: fn(&Image) -> Vec<u8>,
    read: fn(&[u8]) -> Result<Image, ImageError>,
}

const FORMATS: &[Format] = &[
    Format {
        name: "png",
        write: |image| png_bytes(image, &PngOptions::default()),
        read: |bytes| read_png(Cursor::new(bytes), None),
    },
    Format { name: "pfm", write: pfm_bytes, read: |bytes| read_pfm(bytes) },
    #[cfg(feature = "exr")]
    Format { name: "exr", write: exr_bytes, read: |bytes| bn_render::read_exr(Cursor::new(bytes)) },
];

#[cfg(feature = "exr")]
fn exr_bytes(image: &Image) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    bn_render::write_exr(image, &mut file).expect("written");
    file.into_inner()
}

#[cfg(feature = "exr")]
#[test]
fn exr_keeps_every_bit() {
    for channels in [Channels::Grey, Channels::Rgb] {
        let image = image(19, 11, channels);
        let bytes = exr_bytes(&image);
        assert_eq!(bn_render::read_exr(Cursor::new(&bytes)).expect("read"), image);
        for length in (0..bytes.len()).step_by(29) {
            assert!(bn_render::read_exr(Cursor::new(&bytes[..length])).is_err(), "{length}");
        }
    }
}

/// The attributes of a part of 32-bit channels in an EXR file.
#[cfg(feature = "exr")]
fn exr_header(names: &[String], [width, height]: [i32; 2]) -> Vec<u8> {
    let mut file = Vec::new();
    let mut attribute = |name: &str, kind: &str, value: &[u8]| {
        file.extend([name.as_bytes(), &[0], kind.as_bytes(), &[0]].concat());
        file.extend((value.len() as i32).to_le_bytes());
        file.extend(value);
    };
    let mut list = Vec::new();
    for name in names {
        list.extend([name.as_bytes(), &[0]].concat());
        list.extend([2_i32, 0, 1, 1].iter().flat_map(|x| x.to_le_bytes()));
    }
    list.push(0);
    let window: Vec<u8> =
        [0, 0, width - 1, height - 1].iter().flat_map(|x: &i32| x.to_le_bytes()).collect();
    attribute("channels", "chlist", &list);
    attribute("compression", "compression", &[0]);
    attribute("dataWindow", "box2i", &window);
    attribute("displayWindow", "box2i", &window);
    attribute("lineOrder", "lineOrder", &[0]);
    attribute("pixelAspectRatio", "float", &1.0_f32.to_le_bytes());
    attribute("screenWindowCenter", "v2f", &[0; 8]);
    attribute("screenWindowWidth", "float", &1.0_f32.to_le_bytes());
    file
}

/// The start of an EXR file of one part, or of several.
#[cfg(feature = "exr")]
fn exr_start(parts: bool) -> Vec<u8> {
    vec![0x76, 0x2f, 0x31, 0x01, 2, if parts { 0x10 } else { 0 }, 0, 0]
}

/// An uncompressed EXR file's head, and its rows if there is a value for them.
#[cfg(feature = "exr")]
fn exr_by_hand(names: &[String], [width, height]: [i32; 2], value: Option<f32>) -> Vec<u8> {
    let mut file = [exr_start(false), exr_header(names, [width, height]), vec![0]].concat();
    let Some(value) = value else { return file };
    let (head, row) = (file.len() as u64 + 8 * height as u64, 4 * names.len() * width as usize);
    for y in 0..height as u64 {
        file.extend((head + y * (row as u64 + 8)).to_le_bytes());
    }
    for y in 0..height {
        file.extend([y.to_le_bytes(), (row as i32).to_le_bytes()].concat());
        for channel in 0..names.len() {
            let value = value + channel as f32;
            file.extend((0..width).flat_map(|_| value.to_le_bytes()));
        }
    }
    file
}

/// Other programs' files: channels beside those that are read, a single one of any name, and heads
/// that announce more than there is.
#[cfg(feature = "exr")]
#[test]
fn exr_files_of_other_programs_are_read_as_far_as_they_make_sense() {
    let names = |list: &[&str]| list.iter().map(|&name| name.to_owned()).collect::<Vec<_>>();
    let read = |bytes: &[u8]| bn_render::read_exr(Cursor::new(bytes));
    let rich = read(&exr_by_hand(&names(&["A", "B", "G", "R", "Z"]), [3, 2], Some(0.5)));
    let rich = rich.expect("it has all three");
    assert_eq!((rich.width(), rich.height(), rich.channels()), (3, 2, Channels::Rgb));
    assert!(rich.values().chunks_exact(3).all(|pixel| pixel == [3.5, 2.5, 1.5]));
    let depth = read(&exr_by_hand(&names(&["Z"]), [2, 2], Some(7.0))).expect("one is enough");
    assert_eq!((depth.channels(), depth.values()), (Channels::Grey, &[7.0; 4][..]));
    assert!(read(&exr_by_hand(&names(&["A", "Z"]), [2, 2], Some(7.0))).is_err());
    let infinite = exr_by_hand(&names(&["Y"]), [2, 2], Some(f32::INFINITY));
    assert!(matches!(read(&infinite), Err(ImageError::NotFinite { .. })));
    // 52 GB, if one believed it.
    let many: Vec<String> = (0..40).map(|i| format!("c{i:02}")).chain(["Y".to_owned()]).collect();
    for (names, size) in [
        (names(&["B", "G", "R"]), [350_000_000, 1]),
        (many, [18_000, 18_000]),
        (names(&["Y"]), [i32::MAX, 1]),
        (names(&["Y"]), [1, i32::MAX]),
    ] {
        assert!(read(&exr_by_hand(&names, size, None)).is_err(), "{size:?}");
    }
}

/// Two parts, of which the second alone says which channel is meant: the first that has it is read.
#[cfg(feature = "exr")]
#[test]
fn parts_of_exr_files_are_not_mixed_up() {
    let attribute = |name: &str, kind: &str, value: &[u8]| {
        let length = (value.len() as i32).to_le_bytes();
        [name.as_bytes(), &[0], kind.as_bytes(), &[0], &length, value].concat()
    };
    let names = |list: &[&str]| list.iter().map(|&name| name.to_owned()).collect::<Vec<_>>();
    let (first, second) = (names(&["A", "Z"]), names(&["Z"]));
    let part = |name: &str, header: Vec<u8>, rows: i32| {
        let of_part = [
            attribute("name", "string", name.as_bytes()),
            attribute("type", "string", b"scanlineimage"),
            attribute("chunkCount", "int", &rows.to_le_bytes()),
        ];
        [header, of_part.concat(), vec![0]].concat()
    };
    let head = [
        exr_start(true),
        part("large", exr_header(&first, [5, 3]), 3),
        part("small", exr_header(&second, [2, 1]), 1),
        vec![0],
    ];
    let mut file = head.concat();
    // A chunk: part, row, size, and all of a channel before the next.
    let chunk = |part: i32, y: i32, values: &[f32]| {
        let data: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        [&part.to_le_bytes()[..], &y.to_le_bytes(), &(data.len() as i32).to_le_bytes(), &data]
            .concat()
    };
    let row = [[9.0; 5], [0.25; 5]].concat();
    let mut chunks: Vec<Vec<u8>> = (0..3).map(|y| chunk(0, y, &row)).collect();
    chunks.push(chunk(1, 0, &[0.75; 2]));
    let mut at = file.len() as u64 + 8 * chunks.len() as u64;
    for chunk in &chunks {
        file.extend(at.to_le_bytes());
        at += chunk.len() as u64;
    }
    file.extend(chunks.concat());
    let read = bn_render::read_exr(Cursor::new(&file)).expect("whole");
    assert_eq!((read.width(), read.height()), (5, 3));
    assert!(read.values().iter().all(|&value| value == 0.25));
}

#[test]
fn files_without_pixels_are_not_begun() {
    for (width, height) in [(0, 5), (5, 0)] {
        let pfm = PfmWriter::new(Cursor::new(Vec::new()), width, height, Channels::Grey);
        assert!(matches!(pfm, Err(ImageError::Size { .. })));
        let png = PngWriter::new(Vec::new(), width, height, Channels::Grey, &PngOptions::default());
        assert!(png.is_err());
    }
}
