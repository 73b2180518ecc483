//! The page as files.

use super::ReportData;
use super::page::{page, page_at};
use crate::plot::{RenderError, escape};

/// The page as SVG, text as paths.
///
/// # Errors
/// As `Page::to_outlined_svg`.
pub fn to_svg(data: &ReportData) -> Result<String, RenderError> {
    page(data).to_outlined_svg()
}

/// The page as a PNG file, `width` pixels wide or at its natural resolution (about 2500 pixels).
///
/// # Errors
/// [`RenderError::Width`] for a width outside what a page can have, [`RenderError::TooLarge`] for more
/// than 5·10⁸ pixels.
pub fn to_png(data: &ReportData, width: Option<u32>) -> Result<Vec<u8>, RenderError> {
    let page = page(data);
    match width {
        None => page.to_png(),
        Some(width) => {
            let density = page.density_for_width(width)?;
            page_at(data, density).to_png()
        }
    }
}

/// The page as an HTML document that needs no other file.
///
/// # Errors
/// As [`to_svg`].
pub fn to_html(data: &ReportData) -> Result<String, RenderError> {
    let title = escape(&data.title);
    let svg = to_svg(data)?;
    let provenance = escape(&data.provenance);
    Ok(format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>\n\
         body {{ margin: 0 auto; max-width: 72rem; background: #fff; color: #000; \
         font: 1rem/1.4 serif; }}\n\
         svg {{ width: 100%; height: auto; }}\n\
         footer {{ padding: 0 1.5rem 1.5rem; color: #555; font-size: .85rem; \
         overflow-wrap: anywhere; white-space: pre-wrap; }}\n\
         </style>\n</head>\n<body>\n<main>\n{svg}</main>\n\
         <footer>{provenance}</footer>\n</body>\n</html>\n"
    ))
}
