//! The page of `bn report` for ordinary and for impossible data.

use bn_cli::plot::{Grid, Text};
use bn_cli::report::{ReportData, Statistic, page, to_html, to_png, to_svg};
use bn_core::{Curve, DVec2};

use super::document::{assert_legible, read};

/// A jittered grid of `side`² points and spectra that look like its own.
fn sample(side: usize, sets: usize) -> ReportData {
    let n = side * side;
    let noise = |i: usize| (i * 7919 % 10_007) as f64 / 10_007.0;
    let at = |i: usize| {
        let cell = DVec2::new((i % side) as f64, (i / side) as f64);
        (cell + DVec2::new(noise(i), noise(i + 3))) / side as f64
    };
    let cells = (10 * side + 1).min(640);
    let values = (0..cells * cells).map(|i| 2.0 * noise(i)).collect();
    let statistic = |label: &str, value| Statistic {
        label: Text::math(label),
        value,
        std_error: (sets > 1).then_some(0.01 * value),
    };
    ReportData {
        title: format!("jittered, {n} points"),
        points_per_set: n,
        sets,
        points: (0..n).map(at).collect(),
        autocorrelation: Grid::new(100, vec![1.0; 10_000], [-8.0, 8.0], [-8.0, 8.0]),
        spectrum: Grid::new(cells, values, [-10.0, 10.0], [-10.0, 10.0]),
        anisotropy: Curve::sample(0.1, 0.1, 100, |nu| (20.0 * nu).sin() - 10.0),
        rdf: Curve::sample(0.05, 0.1, 80, |r| 1.0 - (-r * r).exp()),
        radial_power: Curve::sample(0.1, 0.1, 100, |nu| 1.0 - (-nu * nu).exp()),
        statistics: vec![
            statistic("*Q*^{6}", 0.37),
            statistic("*R*_{c}", 1.08),
            statistic("*d*_{min}", 0.05),
            statistic("*d*_{avg}", 0.59),
            statistic("*ν*_{eff} (windowed)", 0.24),
            statistic("Ω (windowed)", 0.06),
            statistic("*ν*_{eff} (direct)", 0.25),
            statistic("Ω (direct)", f64::NAN),
        ],
        provenance: "bn report --seed 1 <jittered>".into(),
    }
}

#[test]
fn pages_of_any_size_are_legible() {
    for (side, sets, images) in [(4, 1, 2), (64, 10, 2), (1000, 10, 3)] {
        let data = sample(side, sets);
        let svg = page(&data).to_svg();
        assert_legible(&svg);
        let document = read(&svg);
        // Many points are an image themselves; else each is a disc.
        assert_eq!(document.images, images, "{side}");
        let discs = if images == 2 { data.points.len() } else { 200 };
        assert!(document.paths > discs, "{}", document.paths);
        // A page of 180 mm, more or less.
        assert!((450.0..560.0).contains(&(document.width * 0.75)), "{}", document.width);
    }
}

#[test]
fn files_repeat_and_carry_their_origin() {
    let data = sample(16, 2);
    let svg = to_svg(&data).unwrap();
    assert_eq!(svg, to_svg(&data).unwrap());
    assert!(svg.contains("bn report --seed 1 &lt;jittered&gt;") && !svg.contains("<text"));
    let html = to_html(&data).unwrap();
    assert!(html.contains(&svg) && html.starts_with("<!DOCTYPE html>"));
    let file = to_png(&data, None).unwrap();
    assert_eq!(file, to_png(&data, None).unwrap());
    for (width, expected) in [(Some(800), 800), (None, 2500)] {
        let file = to_png(&data, width).unwrap();
        let reader = png::Decoder::new(std::io::Cursor::new(&file)).read_info().unwrap();
        assert!(reader.info().width.abs_diff(expected) <= if width.is_some() { 0 } else { 500 });
        assert_eq!(reader.info().utf8_text[1].get_text().unwrap(), data.provenance);
    }
    assert!(to_png(&data, Some(5)).is_err());
}

#[test]
fn what_is_undefined_is_said_and_nothing_breaks() {
    let nothing = Curve::new(0.0, 1.0, vec![f64::NAN]);
    let grid = |value: f64| Grid::new(1, vec![value], [-1.0, 1.0], [-1.0, 1.0]);
    let mut data = sample(1, 1);
    data.points = vec![DVec2::ZERO];
    data.anisotropy = nothing.clone();
    data.rdf = nothing.clone();
    data.radial_power = nothing;
    data.autocorrelation = grid(f64::NAN);
    data.spectrum = grid(f64::NAN);
    let svg = page(&data).to_svg();
    assert_legible(&svg);
    assert_eq!(svg.matches("undefined for this set").count(), 3);
    assert!(to_png(&data, Some(600)).is_ok());

    for wild in [0.0, -1.0, 1e300, f64::INFINITY, f64::NEG_INFINITY] {
        let mut data = sample(3, 0);
        let curve = Curve::new(0.0, 0.5, vec![1.0, wild, f64::NAN, wild, wild, 2.0]);
        data.anisotropy = curve.clone();
        data.rdf = curve.clone();
        data.radial_power = curve;
        data.spectrum = Grid::new(2, vec![wild; 4], [wild, wild], [f64::NAN, wild]);
        data.points = vec![DVec2::splat(wild), DVec2::NAN];
        data.statistics.iter_mut().for_each(|s| (s.value, s.std_error) = (wild, Some(wild)));
        data.points_per_set = usize::MAX;
        data.sets = usize::MAX;
        data.title = "\u{0}wide 漢字 & <tags> ".repeat(40);
        assert_legible(&page(&data).to_svg());
        assert!(to_svg(&data).is_ok());
    }
}

#[test]
fn lattices_are_cut_off_and_their_peaks_shown() {
    let mut data = sample(64, 1);
    data.radial_power =
        data.radial_power.map(|nu, p| if (nu - 2.0).abs() < 0.01 { 4096.0 } else { p });
    let mut values = vec![0.0; 641 * 641];
    values[200 * 641 + 300] = 4096.0;
    data.spectrum = Grid::new(641, values, [-10.0, 10.0], [-10.0, 10.0]);
    let svg = page(&data).to_svg();
    let labels: Vec<String> = read(&svg).labels.into_iter().map(|(text, _)| text).collect();
    assert!(labels.iter().any(|text| text == "peak of P: 4096"), "{labels:?}");
    assert!(labels.join(" ").contains("peaks above 100 drawn larger"));
}
