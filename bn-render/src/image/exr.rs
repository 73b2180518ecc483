//! `OpenEXR` files: linear f32, one channel `Y` or three `R`, `G`, `B`.

use std::io::{BufRead, Seek, Write};

use ::exr::meta::MetaData;
use ::exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Layer, LayerAttributes, ReadChannels,
    ReadLayers, SmallVec, WritableImage, read,
};

use super::{Channels, Image, ImageError, checked_len, malformed};

/// Reads the first flat layer of an EXR file: its channels `R`, `G`, `B`, or `Y`, or the only one.
///
/// # Errors
/// If the file can't be read, is malformed, too large, or has other channels.
pub fn read_exr(mut input: impl BufRead + Seek) -> Result<Image, ImageError> {
    let start = input.stream_position()?;
    let meta = MetaData::read_from_buffered(&mut input, false).map_err(from_exr)?;
    for header in &meta.headers {
        let size = header.layer_size;
        checked_len(size.0 as u64, size.1 as u64, Channels::Rgb)?;
    }
    input.seek(std::io::SeekFrom::Start(start))?;
    let file = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(input)
        .map_err(from_exr)?;
    let layer = file.layer_data;
    let list = &layer.channel_data.list;
    if list.iter().any(|c| c.sampling.0 != 1 || c.sampling.1 != 1) {
        return Err(malformed("EXR", "subsampled channels are not supported"));
    }
    let find = |name: &str| list.iter().find(|c| c.name.to_string() == name);
    let (channels, planes) = match (find("R"), find("G"), find("B"), find("Y"), list.as_slice()) {
        (Some(r), Some(g), Some(b), ..) => (Channels::Rgb, vec![r, g, b]),
        (.., Some(y), _) => (Channels::Grey, vec![y]),
        (.., [only]) => (Channels::Grey, vec![only]),
        _ => return Err(malformed("EXR", "there are no channels R, G, B or Y")),
    };
    let (width, height) = (layer.size.0, layer.size.1);
    let count = channels.count();
    let mut values = vec![0.0; width * height * count];
    for (offset, plane) in planes.into_iter().enumerate() {
        let slots = values.iter_mut().skip(offset).step_by(count);
        for (slot, value) in slots.zip(plane.sample_data.values_as_f32()) {
            *slot = value;
        }
    }
    Image::new(width as u32, height as u32, channels, values)
}

/// Writes an image as an EXR file, values as they are, losslessly compressed.
///
/// # Errors
/// If the output fails.
pub fn write_exr(image: &Image, output: impl Write + Seek) -> Result<(), ImageError> {
    let names: &[&str] = match image.channels() {
        Channels::Grey => &["Y"],
        Channels::Rgb => &["R", "G", "B"],
    };
    let plane = |offset: usize| {
        let values = image.values().iter().copied().skip(offset).step_by(names.len());
        FlatSamples::F32(values.collect())
    };
    let channels: SmallVec<[_; 4]> =
        names.iter().enumerate().map(|(i, &name)| AnyChannel::new(name, plane(i))).collect();
    let size = (image.width() as usize, image.height() as usize);
    let layer = Layer::new(
        size,
        LayerAttributes::named("image"),
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(channels),
    );
    ::exr::prelude::Image::from_layer(layer).write().to_buffered(output).map_err(from_exr)
}

fn from_exr(error: ::exr::error::Error) -> ImageError {
    match error {
        ::exr::error::Error::Io(error) if error.kind() != std::io::ErrorKind::UnexpectedEof => {
            ImageError::Io(error)
        }
        other => malformed("EXR", other.to_string()),
    }
}
