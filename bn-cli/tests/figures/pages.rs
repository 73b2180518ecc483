//! Pages of panels: legible, deterministic and unbreakable.

use bn_cli::plot::{Axis, Grid, Page, Panel, Picture, Reference, Row, Series, Style, Table, Text};
use bn_core::DVec2;
use proptest::prelude::*;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg;

use super::document::{assert_legible, read};

fn plain(text: &str) -> Text {
    Text::plain(text)
}

/// Run time against error for six programs, as the benches draw it.
fn crowded() -> Panel {
    let axes = (Axis::log(plain("run time in seconds")), Axis::log(Text::math("*l*_{2} error")));
    (0..6).fold(Panel::new(axes.0, axes.1).titled(plain("NUFFT")), |panel, i| {
        let points = (1..12).map(|k| [1e-3 * f64::from(k + i), 10f64.powi(-k)]);
        let name = plain(&format!("program {i}"));
        let style = Style::Cycle(i as usize);
        panel.line(Series::new(points).named(name).styled(style).with_markers())
    })
}

fn varied() -> Page {
    let wave = Series::new((0..500).map(|i| [0.1 * f64::from(i), (0.2 * f64::from(i)).sin()]));
    let picture = Picture::rgb(2, 2, (0..12).map(|i| 20 * i).collect());
    let first = Row::new(
        100.0,
        vec![
            crowded().with_aspect(1.4),
            Panel::new(Axis::linear(plain("x")), Axis::linear(Text::math("*P*(*ν*_{eff})")))
                .line(wave.named(plain("wave")))
                .reference(Reference::vertical(20.0).named(plain("here")))
                .noted(plain("a remark")),
        ],
    );
    let second = Row::new(
        60.0,
        vec![
            Panel::new(Axis::linear(plain("a")).over(0.0, 3e7), Axis::linear(plain("b")))
                .titled(plain("A title much too long to stand above a panel of such a width")),
            Panel::new(Axis::linear(plain("u")), Axis::linear(plain("v"))).picture(picture),
            Panel::new(Axis::linear(plain("c")).over(1.0, 1.0 + 1e-6), Axis::log(plain("d"))),
        ],
    );
    let table = Table::new(vec![plain(""), Text::math("*Q*^{6}"), plain("Ω")]).row(vec![
        plain("mean"),
        plain("0.43"),
        plain("4.58"),
    ]);
    Page::new()
        .titled(plain("Everything & <more>"))
        .made_by("bn figure --seed 1")
        .row(first)
        .row(second)
        .table(table)
        .paragraph(plain(&"words that fill several lines of a caption ".repeat(12)))
}

#[test]
fn labels_stay_on_the_page_and_apart() {
    assert_legible(&varied().to_svg());
    let document = read(&varied().to_svg());
    assert_eq!(document.images, 1);
    assert!(document.labels.iter().any(|(text, _)| text == "program 5"));
    assert!(document.labels.iter().any(|(text, _)| text == "Everything & <more>"));
    assert!(document.labels.iter().any(|(text, _)| text.contains("×10")));
}

#[test]
fn blank_axes_leave_only_the_frame() {
    let picture = Picture::grey(1, 1, vec![128]);
    let panel = Panel::new(Axis::blank(), Axis::blank()).picture(picture);
    let document = read(&Page::new().row(Row::new(50.0, vec![panel])).to_svg());
    // The page's ground and the frame.
    assert_eq!((document.labels.len(), document.images, document.paths), (0, 1, 2));
}

#[test]
fn an_empty_page_is_a_page() {
    let document = read(&Page::new().to_svg());
    assert_eq!(document.labels.len(), 0);
    assert!(Page::new().row(Row::new(50.0, vec![])).to_png().is_ok());
}

#[test]
fn outlined_text_looks_like_text() {
    let outlined = varied().to_outlined_svg().unwrap();
    assert!(!outlined.contains("<text") && !outlined.contains("font"));
    assert!(outlined.contains("<metadata>bn figure --seed 1</metadata>"));
    assert_eq!(read(&outlined).labels.len(), 0);
    // Drawn without any font, the outlines give the pixels of the PNG file.
    let file = varied().to_png().unwrap();
    let drawn = Pixmap::decode_png(&file).unwrap();
    let tree = usvg::Tree::from_str(&outlined, &usvg::Options::default()).unwrap();
    let mut again = Pixmap::new(drawn.width(), drawn.height()).unwrap();
    let scale = Transform::from_scale(
        drawn.width() as f32 / tree.size().width(),
        drawn.height() as f32 / tree.size().height(),
    );
    resvg::render(&tree, scale, &mut again.as_mut());
    let (mut far, mut inked) = (0, 0);
    for (a, b) in drawn.pixels().iter().zip(again.pixels()) {
        far += usize::from(a.red().abs_diff(b.red()) > 100);
        inked += usize::from(a.red() < 128);
    }
    // Outlines are rounded to 0.01 points, which moves an edge by one of the renderer's four
    // samples a pixel (a level of 64) here and there; a missing glyph would leave hundreds.
    assert!(inked > 10_000 && far < 10, "{far} of {inked} dark pixels differ");
}

#[test]
fn the_same_page_gives_the_same_bytes() {
    assert_eq!(varied().to_svg(), varied().to_svg());
    assert_eq!(varied().to_outlined_svg().unwrap(), varied().to_outlined_svg().unwrap());
    assert_eq!(varied().to_png().unwrap(), varied().to_png().unwrap());
}

#[test]
fn the_png_file_tells_its_origin_and_size() {
    let page = varied();
    let file = page.clone().with_density(2.0).to_png().unwrap();
    let reader = png::Decoder::new(std::io::Cursor::new(&file)).read_info().unwrap();
    let info = reader.info();
    let text = |i: usize| info.utf8_text[i].get_text().unwrap();
    assert_eq!((text(0).as_str(), text(1).as_str()), ("Everything & <more>", "bn figure --seed 1"));
    // 144 dpi.
    assert_eq!(info.pixel_dims.unwrap().xppu, 5669);
    for width in [100, 777, 1234] {
        let density = page.density_for_width(width).unwrap();
        let file = page.clone().with_density(density).to_png().unwrap();
        let reader = png::Decoder::new(std::io::Cursor::new(&file)).read_info().unwrap();
        assert_eq!(reader.info().width, width);
    }
    assert!(page.density_for_width(3).is_err());
    assert!(page.density_for_width(u32::MAX).is_err());
}

#[test]
fn an_image_is_shown_pixel_by_pixel() {
    let values: Vec<f64> = (0..100 * 100).map(|i| f64::from(i * 7919 % 256)).collect();
    let grid = Grid::new(100, values, [0.0, 1.0], [0.0, 1.0]);
    let picture = grid.to_picture(100, 100, 255.0);
    let axis = || Axis::linear(plain("x")).over(0.0, 1.0);
    let panel = Panel::new(axis(), axis()).picture(picture.clone());
    // Frames of 30 points at 10/3 pixels a point: 100 pixels.
    let page = Page::new().with_density(10.0 / 3.0).row(Row::new(30.0, vec![panel]));
    let drawn = Pixmap::decode_png(&page.to_png().unwrap()).unwrap();
    let red = |x: usize, y: usize| drawn.pixels()[y * drawn.width() as usize + x].red();
    let inner = |x: usize, y: usize| picture.samples()[y * 100 + x];
    // The frame's stroke covers the outermost pixels of the image.
    let matches =
        |x0: usize, y0: usize| (2..98).all(|y| (2..98).all(|x| red(x0 + x, y0 + y) == inner(x, y)));
    let places = (0..drawn.width() as usize - 100)
        .flat_map(|x| (0..drawn.height() as usize - 100).map(move |y| (x, y)));
    assert_eq!(places.filter(|&(x, y)| matches(x, y)).count(), 1);
}

/// A number that may be anything.
fn wild() -> impl Strategy<Value = f64> {
    prop_oneof![any::<f64>(), -1.0..1.0, Just(f64::NAN), Just(f64::INFINITY), Just(0.0)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn no_data_break_a_page(
        data in prop::collection::vec((wild(), wild()), 0..40),
        ends in (wild(), wild()),
        log in any::<bool>(),
        name in "\\PC{0,60}|.{0,20}",
    ) {
        let axis = || if log { Axis::log(plain("t")) } else { Axis::linear(plain("t")) };
        let points: Vec<[f64; 2]> = data.iter().map(|&(x, y)| [x, y]).collect();
        let series = Series::new(points).named(plain(&name)).with_markers();
        let dots = bn_cli::plot::Dots::new(data.iter().map(|&(x, y)| DVec2::new(x, y)));
        let page = Page::new()
            .titled(plain(&name))
            .made_by(&name)
            .row(Row::new(60.0, vec![
                Panel::new(axis(), axis()).line(series.clone()).reference(Reference::horizontal(ends.0)),
                Panel::new(axis().over(ends.0, ends.1), axis()).line(series).titled(plain(&name)),
                Panel::new(axis(), axis()).dots(dots),
            ]));
        let document = read(&page.to_svg());
        prop_assert!(document.paths > 10 && document.width < 5000.0 && document.height < 5000.0);
        prop_assert!(page.to_outlined_svg().is_ok());
    }
}
