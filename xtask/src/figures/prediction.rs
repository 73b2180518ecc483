//! The spectrum of sampled images, predicted and measured (figures 3.5 and 3.6).

use bn_cli::plot::{Axis, Grid, Page, Panel, Reference, Row, Series, Style, Table, Text};
use bn_cli::{Failure, Outcome};
use bn_core::{DVec2, PointSet};
use bn_render::{ImageSpectrum, PatternPower, PlaneWave, PlaneWaves, Prediction, SpectralLine};

use super::FigureSpec;
use super::studio::Studio;
use crate::measure::noise::{RATE, Sampled};

pub(super) const FIGURES: &[FigureSpec] = &[
    FigureSpec { id: "3.5", title: "the spectrum of a sampled image", draw: convolution },
    FigureSpec { id: "3.6", title: "the error's spectrum for waves", draw: waves },
    FigureSpec { id: "3.6-noise", title: "noise predicted and measured", draw: noise },
];

/// Points of the pictured sets, and how many sets.
const POINTS: usize = 1024;
const SETS: u32 = 10;

/// The waves' frequencies in 2√n, the unit in which the thesis's rings meet at 0.5.
const FREQUENCIES: [f64; 5] = [0.0, 0.1, 0.3, 0.5, 0.7];

/// Height of a row of pictures in points of the page.
const SIDE: f64 = 92.0;

fn power(studio: &Studio, method: &str) -> Outcome<PatternPower> {
    let count = if studio.quick() { 2 } else { SETS };
    let sets = studio.sets(method, &[], POINTS, count)?;
    PatternPower::of(&sets, 4 * 32).map_err(Failure::failed)
}

/// One function of frequency as a picture over ±`reach`·√n, white at `white`.
fn map(studio: &Studio, reach: f64, white: f64, value: impl Fn(DVec2) -> f64) -> Panel {
    // One cell a mode, at most.
    let arm = if studio.quick() { 16 } else { (reach * 32.0) as i32 };
    let at = |i: i32| reach * f64::from(i) / f64::from(arm);
    let row = |y: i32| (-arm..=arm).map(move |x| DVec2::new(at(x), at(y)));
    let values: Vec<f64> = (-arm..=arm).flat_map(row).map(value).collect();
    let side = (2 * arm + 1) as usize;
    let grid = Grid::new(side, values, [-reach, reach], [-reach, reach]);
    let picture =
        grid.with_peaks_widened(6.0 * white, 1).to_picture(side as u32, side as u32, white);
    Panel::new(Axis::blank(), Axis::blank()).picture(picture)
}

/// An image's spectrum for show: a disc of radius 0.3√n, falling off to its border, of power 1.
fn disc() -> ImageSpectrum {
    const RADIUS: f64 = 0.3;
    let lines = (-10..=10).flat_map(|y| (-10..=10).map(move |x| (x, y))).filter_map(|(x, y)| {
        // On the modes of a tile at one sample per pixel.
        let frequency = DVec2::new(f64::from(x), f64::from(y)) / 32.0;
        let fall = 1.0 - (frequency.length() / RADIUS).powi(2);
        (fall > 0.0).then_some(SpectralLine { frequency, power: fall })
    });
    let lines: Vec<_> = lines.collect();
    let sum: f64 = lines.iter().map(|line| line.power).sum();
    let scaled = lines.iter().map(|line| SpectralLine { power: line.power / sum, ..*line });
    ImageSpectrum::from_lines(scaled.collect())
}

fn convolution(studio: &Studio) -> Outcome {
    const REACH: f64 = 1.75;
    let image = disc();
    // Lines as a density: each stands for one mode of the tile.
    let own = |nu: DVec2| {
        let near = |line: &&SpectralLine| line.frequency.distance(nu) < 0.5 / 32.0;
        image.lines().iter().find(near).map_or(0.0, |line| line.power * POINTS as f64)
    };
    let white = own(DVec2::ZERO);
    let mut page =
        Page::new().titled(Text::math("*P*_{J}: *P*_{I} convolved with *P*_{S}")).with_density(3.0);
    for (method, label) in [
        ("regular", "square grid"),
        ("stochastic", "stochastic sampling"),
        ("dart-throwing", "dart throwing"),
    ] {
        let power = power(studio, method)?;
        let prediction = Prediction::new(&power, 1.0).map_err(Failure::failed)?;
        let pattern = map(studio, REACH, 2.0, |nu| power.interpolated(nu * prediction.side()));
        let sampled = |nu| own(nu) + prediction.error_spectrum(&image, nu);
        page = page.row(Row::new(
            SIDE * 1.4,
            vec![
                map(studio, REACH, white, own).titled(Text::math("*P*_{I}")),
                pattern.titled(Text::plain(label)),
                map(studio, REACH, white, sampled).titled(Text::math("*P*_{J}")),
            ],
        ));
    }
    let text = "From left to right: an image's spectrum, a disc of radius 0.3 √*n*; the pattern's, white \
                at 2; the sampled image's over *n*², by convolution. All over ±1.75 √*n*.";
    studio.page("", &page.paragraph(Text::math(text)))
}

/// The wave of `frequency` cycles per pixel along u, of power 1 at every frequency but 0.
fn spectrum(frequency: f64) -> ImageSpectrum {
    let frequency = DVec2::new(frequency, 0.0);
    let amplitude = if frequency.x == 0.0 { 1.0 } else { std::f64::consts::SQRT_2 };
    let wave = PlaneWave { amplitude, frequency, phase_turns: 0.0 };
    ImageSpectrum::of_waves(&PlaneWaves::new(0.0, vec![wave]))
}

fn waves(studio: &Studio) -> Outcome {
    // In √n: ±1 of the figure's unit.
    const REACH: f64 = 2.0;
    let columns = [
        ("regular", "square grid"),
        ("stochastic", "stochastic"),
        ("dart-throwing", "dart throwing"),
        ("fpo", "FPO"),
        ("step", "step"),
    ];
    let powers =
        columns.iter().map(|(method, _)| power(studio, method)).collect::<Outcome<Vec<_>>>()?;
    let mut page = Page::new().with_density(3.0);
    for (row, frequency) in FREQUENCIES.into_iter().enumerate() {
        let image = spectrum(2.0 * frequency);
        let near = |nu: DVec2| {
            let line =
                |line: &&SpectralLine| line.power > 0.0 && line.frequency.distance(nu) < 1.5 / 32.0;
            f64::from(u8::from(image.lines().iter().any(|l| line(&l))))
        };
        let mut panels =
            vec![map(studio, REACH, 1.0, near).titled(Text::math(&format!("*f* = {frequency}")))];
        for ((_, label), power) in columns.iter().zip(&powers) {
            let prediction = Prediction::new(power, 1.0).map_err(Failure::failed)?;
            let panel = map(studio, REACH, 2.5, |nu| prediction.error_spectrum(&image, nu));
            let title = if row == 0 { *label } else { "" };
            panels.push(panel.titled(Text::plain(title)));
        }
        page = page.row(Row::new(SIDE, panels));
    }
    let text = "Left: the wave's spectrum. Then its sampling error *ε*(*ν*) over ±2 √*n* in both directions, \
                white at 2.5 times that of stochastic sampling. The frequency *f* is in 2 √*n*, so that rings \
                meet at the origin at *f* = 0.5.";
    studio.page("", &page.paragraph(Text::math(text)))
}

/// The patterns of the comparison.
const COMPARED: [(&str, &str); 4] =
    [("jittered", "jittered"), ("fpo", "FPO"), ("cccvt", "CCCVT"), ("step", "step")];

fn noise(studio: &Studio) -> Outcome {
    let (points, count) = if studio.quick() { (256, 2) } else { (4096, SETS) };
    let side = if studio.quick() { 64 } else { 256 };
    let lanczos = bn_render::kernel("lanczos2").expect("in the list");
    let mut sets: Vec<Vec<PointSet>> = Vec::new();
    for (method, _) in COMPARED {
        sets.push(studio.sets(method, &[], points, count)?);
    }
    let sampled = sets.iter().map(|sets| Sampled::new(sets)).collect::<Outcome<Vec<_>>>()?;
    let cells = |text: &str| Text::math(text);
    let mut head = vec![cells("*f*")];
    head.extend(COMPARED.map(|(_, label)| cells(label)));
    let mut table = Table::new(head);
    let mut page = Page::new().titled(Text::plain("Predicted and measured noise of sampled waves"));
    let mut panels = Vec::new();
    for frequency in FREQUENCIES {
        let mut row = vec![Text::plain(&format!("{frequency}"))];
        let axis = Axis::linear(Text::math("*ν*/√*n*")).over(0.0, 2.0);
        let mut panel = Panel::new(axis, Axis::linear(Text::math("*ε*")).over(0.0, 3.0))
            .titled(Text::math(&format!("*f* = {frequency}")))
            .reference(Reference::horizontal(1.0));
        for (i, (sampled, (_, label))) in sampled.iter().zip(COMPARED).enumerate() {
            let [predicted, found] = sampled.spectra(2.0 * frequency, 2.0)?;
            let line = Series::new(predicted).styled(Style::Cycle(i)).named(Text::plain(label));
            let dots = Series::new(found).styled(Style::Cycle(i)).with_markers().without_line();
            panel = panel.line(line).line(dots);
            let noise = sampled.noise(2.0 * frequency, lanczos, side)?;
            let decibels = |power: f64| 10.0 * libm::log10(power);
            row.push(Text::plain(&format!(
                "{:.2} / {:.2} ({:+.2})",
                decibels(noise.predicted),
                decibels(noise.measured),
                noise.difference_db()
            )));
        }
        panels.push(panel);
        table = table.row(row);
    }
    while !panels.is_empty() {
        let rest = panels.split_off(panels.len().min(3));
        page = page.row(Row::new(120.0, panels));
        panels = rest;
    }
    let text = format!(
        "Above: the error's spectrum over that of stochastic sampling, predicted (lines) from the mean \
         periodogram of {count} sets of {points} points and measured (dots) from the waves' samples; *f* in 2 √*n*. \
         Below: noise of the pixels in dB under 1, predicted / measured (difference), at {RATE} samples per \
         pixel through plain Lanczos 2, amplitude ½. *f* = 0 is predicted by eq. 3.16."
    );
    studio.page("", &page.table(table).paragraph(Text::math(&text)))
}
