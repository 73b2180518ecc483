//! A page as the SVG library reads it.

use resvg::usvg::{self, Node, Rect, fontdb};

/// What a page's SVG holds.
pub struct Document {
    pub width: f32,
    pub height: f32,
    /// Every label with its ink's box, in pixels at 96 dpi.
    pub labels: Vec<(String, Rect)>,
    /// Numbers of paths and images.
    pub paths: usize,
    pub images: usize,
}

/// Parses `svg`, with the page's own font.
pub fn read(svg: &str) -> Document {
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(include_bytes!("../../fonts/LibertinusSerif-Regular.otf").to_vec());
    fonts.load_font_data(include_bytes!("../../fonts/LibertinusSerif-Italic.otf").to_vec());
    let options = usvg::Options { fontdb: fonts.into(), ..usvg::Options::default() };
    let tree = usvg::Tree::from_str(svg, &options).expect("a page is an SVG document");
    let mut document = Document {
        width: tree.size().width(),
        height: tree.size().height(),
        labels: vec![],
        paths: 0,
        images: 0,
    };
    collect(tree.root(), &mut document);
    document
}

fn collect(group: &usvg::Group, document: &mut Document) {
    for node in group.children() {
        match node {
            Node::Group(group) => collect(group, document),
            Node::Text(text) => {
                let characters: String = text.chunks().iter().map(usvg::TextChunk::text).collect();
                let ink = text.flattened().bounding_box().transform(text.abs_transform());
                let ink = ink.expect("a label's place is finite");
                document.labels.push((characters, ink));
            }
            Node::Path(_) => document.paths += 1,
            Node::Image(_) => document.images += 1,
        }
    }
}

/// Fails if a label leaves the page or meets another one.
pub fn assert_legible(svg: &str) {
    let document = read(svg);
    for (i, (text, area)) in document.labels.iter().enumerate() {
        let inside = area.left() >= 0.0
            && area.top() >= 0.0
            && area.right() <= document.width
            && area.bottom() <= document.height;
        assert!(inside, "“{text}” at {area:?} leaves the page");
        for (other, place) in &document.labels[..i] {
            let apart = area.left() >= place.right()
                || place.left() >= area.right()
                || area.top() >= place.bottom()
                || place.top() >= area.bottom();
            assert!(apart, "“{text}” at {area:?} meets “{other}” at {place:?}");
        }
    }
}
