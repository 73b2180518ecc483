//! What farthest-point optimisation makes, and how soon: figures 4.4, 4.6 to 4.8 and the experiment
//! of §4.3.1 on initialisation.

use bn_cli::analysis::Analysis;
use bn_cli::plot::{Axis, Dots, Page, Panel, Reference, Row, Series, Style, Text};
use bn_cli::{Failure, Outcome, report};
use bn_core::{PointSet, Seed};
use bn_geometry::{Coverage, Spacing, Triangulation};

use super::FigureSpec;
use super::drawing::{circles, square};
use super::studio::Studio;
use crate::measure::course::{self, Moment};

pub(super) const FIGURES: &[FigureSpec] = &[
    FigureSpec { id: "4.4", title: "steps of an optimisation", draw: steps },
    FigureSpec { id: "4.6", title: "convergence", draw: convergence },
    FigureSpec { id: "4.7", title: "holes, and none", draw: holes },
    FigureSpec { id: "4.8", title: "spectra of optimised and of thrown points", draw: spectra },
    FigureSpec { id: "initial", title: "convergence from other starts", draw: initialization },
];

/// Sides of panels in points.
const SIDE: f64 = 150.0;

type Options = &'static [(&'static str, &'static str)];

type Measure = fn(&PointSet) -> f64;

/// One run of farthest-point optimisation.
fn run(options: &[(&str, &str)], n: usize, set: u32) -> Outcome<Vec<Moment>> {
    let method = bn_samplers::find("fpo").map_err(Failure::usage)?;
    let sampler = method.with_options(options.iter().copied()).map_err(Failure::usage)?;
    course::follow(&*sampler, n, Seed::new(1).for_set(set))
}

fn d_min(set: &PointSet) -> f64 {
    set.density().normalize_distance(Spacing::new(set).min()).value()
}

fn d_avg(set: &PointSet) -> f64 {
    set.density().normalize_distance(Spacing::new(set).mean()).value()
}

fn steps(studio: &Studio) -> Outcome {
    let n = if studio.quick() { 256 } else { 1024 };
    let moments = run(&[("variant", "global")], n, 0)?;
    let last = moments.last().map_or(0, |moment| moment.iteration);
    let shown = |moment: &&Moment| [0, 1, 5, last].contains(&moment.iteration);
    let panel = |moment: &Moment| {
        let (points, i) = (&moment.points, moment.iteration);
        let title = format!(
            "{i} iterations: *d*_{{min}} {:.3}, *d*_{{avg}} {:.3}",
            d_min(points),
            d_avg(points)
        );
        square(&title).dots(Dots::new(points.points().iter().copied()))
    };
    let panels: Vec<Panel> = moments.iter().filter(shown).map(panel).collect();
    let rows = panels.chunks(2).map(|pair| Row::new(1.3 * SIDE, pair.to_vec()));
    studio.page("", &rows.fold(Page::new(), Page::row))
}

/// Iterations shown.
const ITERATIONS: &str = "200";

fn convergence(studio: &Studio) -> Outcome {
    let cases: &[(usize, u32)] =
        if studio.quick() { &[(64, 2)] } else { &[(512, 10), (4096, 4), (32_768, 1)] };
    let (mut whole, mut magnified) = (Vec::new(), Vec::new());
    for &(n, sets) in cases {
        let mut lines = Vec::new();
        for (i, variant) in ["global", "local"].into_iter().enumerate() {
            // No pattern has a spacing of 1: all runs are of one length.
            let options = [("variant", variant), ("iterations", ITERATIONS), ("d-min", "1")];
            let runs = (0..sets).map(|set| run(&options, n, set)).collect::<Outcome<Vec<_>>>()?;
            let measures: [(&str, Measure); 2] = [("*d*_{min}", d_min), ("*d*_{avg}", d_avg)];
            for (j, (name, measure)) in measures.into_iter().enumerate() {
                let name = Text::math(&format!("{name}, {variant}"));
                let series = Series::new(mean_course(&runs, measure));
                lines.push(series.named(name).styled(Style::Cycle(2 * i + j)));
            }
        }
        let panel = |low: f64, high: f64| {
            let x = Axis::log(Text::plain("iterations"));
            let y = Axis::linear(Text::math("distance/*d*_{hex}")).over(low, high);
            let panel = Panel::new(x, y).titled(Text::math(&format!("*n* = {n}")));
            lines.iter().cloned().fold(panel, Panel::line)
        };
        whole.push(panel(0.0, 1.0));
        magnified.push(panel(0.75, 0.95));
    }
    let page = Page::new().row(Row::new(SIDE, whole)).row(Row::new(SIDE, magnified));
    studio.page("", &page)
}

/// The mean over runs at the iterations that all of them have.
fn mean_course(runs: &[Vec<Moment>], measure: Measure) -> Vec<[f64; 2]> {
    let shortest = runs.iter().map(Vec::len).min().unwrap_or(0);
    let mean = |i: usize| {
        let sum: f64 = runs.iter().map(|moments| measure(&moments[i].points)).sum();
        [runs[0][i].iteration as f64, sum / runs.len() as f64]
    };
    (1..shortest).map(mean).collect()
}

/// Holes above this radius are shown, in `d_hex`.
const HOLE: f64 = 0.77;

fn holes(studio: &Studio) -> Outcome {
    let n = if studio.quick() { 256 } else { 1024 };
    let mut panels = Vec::new();
    for (name, options) in [("as it ends", &[][..]), ("plugged", &[("plug", "true")][..])] {
        let set = studio.sets("fpo", options, n, 1)?.remove(0);
        let density = set.density();
        let triangulation = Triangulation::new(&set);
        let coverage = Coverage::of(&triangulation).map_or(0.0, |coverage| coverage.radius);
        let limit = HOLE * density.hexagonal_spacing();
        let large = triangulation.circumcircles().filter(|(_, circle)| circle.radius() > limit);
        let centres: Vec<_> = large.map(|(_, circle)| circle.center).collect();
        let title = format!(
            "{name}: *R*_{{c}} {:.3}, *d*_{{min}} {:.3}",
            density.normalize_distance(coverage).value(),
            d_min(&set)
        );
        let panel = square(&title).dots(Dots::new(set.points().iter().copied()));
        panels.push(panel.line(circles(centres, limit).styled(Style::Contrast)));
    }
    studio.page("", &Page::new().row(Row::new(2.0 * SIDE, panels)))
}

fn spectra(studio: &Studio) -> Outcome {
    let (n, count) = if studio.quick() { (256, 2) } else { (4096, 10) };
    let mut page = Page::new();
    for method in ["fpo", "dart-throwing"] {
        let sets = studio.sets(method, &[], n, count)?;
        let analysis = Analysis::of(&sets);
        let range = (6.0 * analysis.density().grid_nyquist()).ceil() as usize;
        let data = analysis.report_data(method.to_owned(), studio.provenance(), range);
        let spectrum = &data.spectrum;
        let pixels = |cells: usize| cells.min(report::MOST_CELLS) as u32;
        let side = |name: &str, [low, high]: [f64; 2]| {
            Axis::linear(Text::math(&format!("{name}/(√*n*/2)"))).over(low, high)
        };
        let picture =
            spectrum.to_picture(pixels(spectrum.columns()), pixels(spectrum.rows()), report::WHITE);
        let power = Panel::new(side("*ν*_{x}", spectrum.x()), side("*ν*_{y}", spectrum.y()))
            .titled(Text::plain(&format!("{method}: power spectrum")))
            .picture(picture);
        let frequency = || Axis::linear(Text::math("*ν*/(√*n*/2)")).over(0.0, 6.0);
        let radial = Panel::new(frequency(), Axis::linear(Text::math("*P*")).over(0.0, 6.0))
            .titled(Text::plain("radial power"))
            .line(Series::of_curve(&data.radial_power))
            .reference(Reference::horizontal(1.0));
        let expected = -10.0 * libm::log10(f64::from(count));
        let decibels = Axis::linear(Text::plain("anisotropy in dB"));
        let anisotropy = Panel::new(frequency(), decibels.over(expected - 10.0, expected + 20.0))
            .titled(Text::plain("anisotropy"))
            .line(Series::of_curve(&data.anisotropy))
            .reference(Reference::horizontal(expected));
        page = page.row(Row::new(SIDE, vec![power, radial, anisotropy]));
    }
    studio.page("", &page)
}

fn initialization(studio: &Studio) -> Outcome {
    let (n, sets) = if studio.quick() { (64, 1) } else { (4096, 4) };
    let starts: [(&str, Options); 3] = [
        ("random", &[("variant", "global")]),
        ("jittered", &[("variant", "global"), ("initial-method", "jittered")]),
        ("Poisson disk", &[("variant", "global"), ("initial-method", "dart-throwing")]),
    ];
    let axis = |label: &str, low| Axis::linear(Text::math(label)).over(low, 0.94);
    let iterations = || Axis::log(Text::plain("iterations"));
    let mut panels = [
        Panel::new(iterations(), axis("*d*_{min}/*d*_{hex}", 0.6)),
        Panel::new(iterations(), axis("*d*_{avg}/*d*_{hex}", 0.8)),
    ];
    for (i, (name, options)) in starts.into_iter().enumerate() {
        let runs = (0..sets).map(|set| run(options, n, set)).collect::<Outcome<Vec<_>>>()?;
        let mean = |value: fn(&Moment) -> f64| {
            runs.iter().filter_map(|run| run.last()).map(value).sum::<f64>() / f64::from(sets)
        };
        let (count, seconds) = (mean(|last| last.iteration as f64), mean(|last| last.seconds));
        let name = Text::plain(&format!("{name}: {count:.0} iterations, {seconds:.2} s"));
        let lines = [mean_course(&runs, d_min), mean_course(&runs, d_avg)].map(Series::new);
        let lines = lines.map(|line| line.styled(Style::Cycle(i)));
        let [least, mean] = panels;
        let [of_least, of_mean] = lines;
        panels = [least.line(of_least.named(name)), mean.line(of_mean)];
    }
    let [least, mean] = panels;
    studio.page("", &Page::new().row(Row::new(1.3 * SIDE, vec![least, mean])))
}
