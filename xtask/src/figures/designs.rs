//! Figures 5.5 to 5.7: spectra of low oscillation, what they ask for and what point sets have.

use bn_cli::analysis::{Analysis, Statistic};
use bn_cli::plot::{Axis, Page, Panel, Row, Style, Text};
use bn_cli::{Failure, Outcome};
use bn_core::{Density, PointSet, Seed, Unobserved};
use bn_render::{Frame, ZonePlate};
use bn_samplers::{Algorithm, Sampler as _, SpectrumMatching};
use bn_spectral::{Realizability, SinglePeak, Target, highest_step};
use rayon::prelude::*;

use super::FigureSpec;
use super::gallery::{picture, rendered};
use super::panels::{self, Line};
use super::studio::Studio;

pub(super) const FIGURES: &[FigureSpec] = &[
    FigureSpec { id: "5.5", title: "step blue noise and its limit", draw: steps },
    FigureSpec { id: "5.6", title: "the shape of the single-peak spectrum", draw: shape },
    FigureSpec { id: "5.7", title: "four single-peak patterns", draw: peaks },
];

/// Height of the rows in points.
const HEIGHT: f64 = 125.0;

/// The highest local frequency of the zone plates, in cycles per pixel.
const PLATE: f64 = 1.5;

/// The highest frequency shown, in √n/2, and the largest distance, in `d_hex`.
const HIGHEST: f64 = 5.0;
const FARTHEST: f64 = 4.0;

/// Points and sets; a small version serves for a test.
fn size(studio: &Studio) -> (usize, u32) {
    if studio.quick() { (256, 2) } else { (4096, 10) }
}

fn steps(studio: &Studio) -> Outcome {
    let (n, count) = size(studio);
    let (density, highest) = (Density::new(n), highest_step(n as f64));
    let mut page = Page::new().titled(Text::plain("Step blue noise"));
    let (mut powers, mut rdfs) = (Vec::new(), Vec::new());
    let scales = [("0.8 *ν*_{max}", 0.8), ("*ν*_{max}", 1.0), ("1.2 *ν*_{max}", 1.2)];
    for (i, (name, scale)) in scales.into_iter().enumerate() {
        let target = Target::step(density, scale * highest).map_err(Failure::failed)?;
        powers.push(Line::new(name, power_of(&target), Style::Cycle(i)));
        rdfs.push(Line::new(name, rdf_of(&target), Style::Cycle(i)));
    }
    page = page.row(Row::new(
        125.0,
        vec![
            panels::power("spectra that are asked for", density, &powers, (3.0, 1.2)),
            panels::rdf("their RDFs", density, &rdfs, (FARTHEST, -0.5, 1.5)),
        ],
    ));
    let target = Target::step(density, highest).map_err(Failure::failed)?;
    let sets = studio.sets("step", &[], n, count)?;
    page = page.row(Row::new(HEIGHT, result("", &target, &sets, 1.5)));
    let text = format!(
        "Above: beyond *ν*_{{max}} = √(*n*/π) the RDF would be negative. Below: *ν*_{{0}} = *ν*_{{max}}, {count} sets of \
         {n} points: {}.",
        statistics(&sets)
    );
    studio.page("", &page.paragraph(Text::math(&text)))
}

fn shape(studio: &Studio) -> Outcome {
    let density = Density::new(4096);
    let shapes = [
        ("*σ* = 0", SinglePeak { nu0: 48.0, peak: 12.0, sigma: 0.0, width: 4.0 }),
        ("*σ* = 2", SinglePeak { nu0: 48.0, peak: 12.0, sigma: 2.0, width: 4.0 }),
        ("*σ* = 5", SinglePeak { nu0: 48.0, peak: 12.0, sigma: 5.0, width: 4.0 }),
    ];
    let (mut powers, mut rdfs) = (Vec::new(), Vec::new());
    for (i, (name, peak)) in shapes.into_iter().enumerate() {
        let target = Target::single_peak(density, peak).map_err(Failure::failed)?;
        powers.push(Line::new(name, power_of(&target), Style::Cycle(i)));
        rdfs.push(Line::new(name, rdf_of(&target), Style::Cycle(i)));
    }
    let row = Row::new(
        135.0,
        vec![
            panels::power("single-peak spectra", density, &powers, (4.0, 4.5)),
            panels::rdf("their RDFs", density, &rdfs, (FARTHEST, -0.2, 1.8)),
        ],
    );
    let text = "A peak of power *p*_{0} = 12 cycles (here over a width of 4) at *ν*_{0} = 48 cycles, 1.33 *ν*_{max} at \
                4096 points, and the step above it, smoothed by a Gaussian.";
    studio.page("", &Page::new().row(row).paragraph(Text::math(text)))
}

/// ν₀, p₀ and σ in cycles at 4096 points. The thesis gives the heights of (a) and (b), and the
/// positions; (d) is its reference.
const PEAKS: [(&str, f64, f64, f64); 4] = [
    ("(a) *ν*_{0} = 1.33 *ν*_{max}, narrow", 48.0, 19.0, 0.4),
    ("(b) *ν*_{0} = 1.33 *ν*_{max}, wide", 48.0, 19.0, 2.1),
    ("(c) *ν*_{0} = 1.66 *ν*_{max}, narrow", 60.0, 19.0, 1.0),
    ("(d) *ν*_{0} = 1.66 *ν*_{max}, wide", 60.0, 19.0, 2.5),
];

fn peaks(studio: &Studio) -> Outcome {
    let (n, count) = size(studio);
    let scale = (n as f64 / 4096.0).sqrt();
    let mut page = Page::new().titled(Text::plain("Single-peak blue noise"));
    let mut notes = Vec::new();
    for (name, nu0, peak, sigma) in PEAKS {
        let peak =
            SinglePeak { nu0: nu0 * scale, peak: peak * scale, sigma: sigma * scale, width: scale };
        let target = Target::single_peak(Density::new(n), peak).map_err(Failure::failed)?;
        let sets = matched(&target, n, count)?;
        let least = format!("{:.2}", Realizability::of(&target).min_g).replace('-', "−");
        notes.push(format!("{}: least *g* {least}, {}", &name[..3], statistics(&sets)));
        let mut panels = result(name, &target, &sets, target_top(&target));
        panels.insert(1, plate(&sets[0])?);
        page = page.row(Row::new(HEIGHT, panels));
    }
    let text = format!(
        "{count} sets of {n} points each; zone plates at 1 spp up to {PLATE} cycles per pixel at the middle of \
         each side. {}.",
        notes.join(". ")
    );
    studio.page("", &page.paragraph(Text::math(&text)))
}

fn matched(target: &Target, n: usize, count: u32) -> Outcome<Vec<PointSet>> {
    let matching = SpectrumMatching::new(target.clone(), Algorithm::default());
    let one = |set: u32| {
        let sample = matching.sample(n, Seed::new(1).for_set(set), &Unobserved);
        sample.map(|sample| sample.points).map_err(Failure::failed)
    };
    (0..count).into_par_iter().map(one).collect()
}

/// A whole number above the target's peak.
fn target_top(target: &Target) -> f64 {
    let highest = power_of(target).iter().map(|[_, p]| *p).fold(1.0, f64::max);
    (1.1 * highest).ceil()
}

/// Points, radial power and RDF of an ensemble, with those of the target.
fn result(title: &str, target: &Target, sets: &[PointSet], top: f64) -> Vec<Panel> {
    let density = target.density();
    let analysis = Analysis::of(sets);
    let range = (FARTHEST * density.hexagonal_spacing()).min(0.5);
    let bins = if sets[0].len() < 1000 { 60 } else { 300 };
    let mut powers = vec![Line::new("target", power_of(target), Style::Contrast)];
    let highest = (HIGHEST * density.grid_nyquist()) as usize;
    if let Some(power) = analysis.radial_power(highest).curve() {
        powers.push(Line::of_curve("points", &power, Style::Accent));
    }
    let rdfs = [
        Line::new("target", rdf_of(target), Style::Contrast),
        Line::of_curve("points", &analysis.rdf_within(range, bins), Style::Accent),
    ];
    vec![
        panels::points(title, &sets[0]),
        panels::power("", density, &powers, (HIGHEST, top)),
        panels::rdf("", density, &rdfs, (FARTHEST, -0.5, 2.0)),
    ]
}

/// A zone plate sampled by the points.
fn plate(set: &PointSet) -> Outcome<Panel> {
    let frame = Frame::new(250, 250).map_err(Failure::failed)?;
    let image = rendered(&ZonePlate::new(&frame, PLATE), &frame, set, 1.0)?;
    Ok(Panel::new(Axis::blank(), Axis::blank()).picture(picture(&image)))
}

fn power_of(target: &Target) -> Vec<[f64; 2]> {
    let end = HIGHEST * target.density().grid_nyquist();
    panels::grid(end, 2000).into_iter().map(|nu| [nu, target.power(nu)]).collect()
}

fn rdf_of(target: &Target) -> Vec<[f64; 2]> {
    let r = panels::grid(FARTHEST * target.density().hexagonal_spacing(), 500);
    r.iter().zip(target.rdf(&r)).map(|(&r, g)| [r, g]).collect()
}

/// The statistics that the thesis prints, in words.
fn statistics(sets: &[PointSet]) -> String {
    let analysis = Analysis::of(sets);
    let value = |statistic| analysis.estimate(statistic).map_or(f64::NAN, |e| e.value);
    format!(
        "*ν*_{{eff}} {:.2}, Ω {:.2}, *d*_{{avg}} {:.2}",
        value(Statistic::NuEff),
        value(Statistic::Omega),
        value(Statistic::MeanDistance)
    )
}
