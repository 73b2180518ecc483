//! Pictures as data of the page that shows them.

use std::fs;
use std::path::Path;

use anyhow::Context as _;
use bn_cli::{Failure, Outcome};

use crate::figures::DrawnPage;

/// A picture and its size as it is to be shown.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Picture {
    /// What tells it from others of its figure; may be empty.
    pub(super) part: String,
    /// Width and height in CSS pixels.
    pub(super) size: (f64, f64),
    /// The file as a data URI.
    pub(super) uri: String,
}

/// CSS pixels in a point.
const PIXELS: f64 = 4.0 / 3.0;

impl Picture {
    /// The page's SVG file, or the PNG file beside it if `rasters` are asked for, there is one no
    /// older, and it is the smaller.
    pub(super) fn read(page: DrawnPage, rasters: bool) -> Outcome<Self> {
        let path = page.file.as_path();
        let text = fs::read_to_string(path)
            .with_context(|| format!("cannot read {}", path.display()))
            .map_err(Failure::failed)?;
        let size = size_of(&text).ok_or_else(|| {
            Failure::failed(anyhow::anyhow!("{} doesn't say how large it is", path.display()))
        })?;
        let raster = path.with_extension("png");
        let is_current = rasters && modified(&raster) >= modified(path) && raster.exists();
        let raster = is_current.then(|| fs::read(&raster).ok()).flatten();
        let uri = match raster.filter(|bytes| bytes.len() < text.len()) {
            Some(bytes) => bn_cli::plot::data_uri("image/png", &bytes),
            None => bn_cli::plot::data_uri("image/svg+xml", text.as_bytes()),
        };
        Ok(Self { part: page.part, size, uri })
    }
}

fn modified(path: &Path) -> Option<std::time::SystemTime> {
    fs::metadata(path).ok()?.modified().ok()
}

/// The size that an SVG file's view box tells.
fn size_of(svg: &str) -> Option<(f64, f64)> {
    let (_, rest) = svg.split_once("viewBox=\"0 0 ")?;
    let (width, height) = rest.split_once('"')?.0.split_once(' ')?;
    Some((PIXELS * width.parse::<f64>().ok()?, PIXELS * height.parse::<f64>().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_cli::plot::{Page, Text};

    #[test]
    fn the_smaller_file_that_is_current_is_taken() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("figure.svg");
        fs::write(&path, Page::new().titled(Text::plain("a test")).to_svg()).expect("written");
        let page = DrawnPage { part: "a part".to_owned(), file: path.clone() };
        let read = |rasters: bool| Picture::read(page.clone(), rasters);
        let vectors = read(true).expect("read");
        assert_eq!(vectors.part, "a part");
        assert!(vectors.uri.starts_with("data:image/svg+xml;base64,PHN2Zy"), "{}", vectors.uri);
        // A page has borders of 10 points and is 240 wide at least.
        assert_eq!(vectors.size.0, PIXELS * 260.0);
        fs::write(folder.path().join("figure.png"), b"png").expect("written");
        let raster = read(true).expect("read");
        assert_eq!(
            raster,
            Picture { uri: "data:image/png;base64,cG5n".to_owned(), ..vectors.clone() }
        );
        assert_eq!(read(false).expect("read"), vectors);
        fs::write(&path, "<svg/>").expect("written");
        assert!(read(true).is_err());
    }
}
