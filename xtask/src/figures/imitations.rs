//! Figures 5.3 and 5.4: other methods simulated by their spectra.

use bn_cli::Outcome;
use bn_cli::analysis::Analysis;
use bn_cli::plot::{Page, Row, Style, Text};
use bn_core::{Density, PointSet};

use super::FigureSpec;
use super::panels::{self, Line};
use super::studio::Studio;
use crate::measure::imitation::{Curves, Imitation};

pub(super) const FIGURES: &[FigureSpec] = &[
    FigureSpec {
        id: "5.3",
        title: "jittered grid and dart throwing simulated by their spectra",
        draw: |studio| {
            draw(studio, [("jittered", "jittered grid"), ("dart-throwing", "dart throwing")])
        },
    },
    FigureSpec {
        id: "5.4",
        title: "CCCVT and Lloyd's method simulated by their spectra",
        draw: |studio| draw(studio, [("cccvt", "CCCVT"), ("lloyd", "Lloyd")]),
    },
];

const SEED: u64 = 1;
/// Bins of the RDFs, and how far they reach in `d_hex`.
const BINS: usize = 250;
const FARTHEST: f64 = 5.0;
/// The highest frequency shown, in √n/2.
const HIGHEST: f64 = 6.0;

fn draw(studio: &Studio, models: [(&'static str, &'static str); 2]) -> Outcome {
    let (n, sets) = if studio.quick() { (144, 2) } else { (1024, 10) };
    let mut page = Page::new().titled(Text::plain("Other methods, simulated by their spectra"));
    let mut errors = Vec::new();
    for (method, name) in models {
        let made = Imitation::of(method, n, sets, SEED)?;
        let wanted = Curves::of(&made.model)?;
        for (who, sets) in [("spectral", &made.spectral), ("force", &made.force)] {
            let [power, rdf] = Curves::of(sets)?.differences(&wanted);
            errors.push(format!("{name}, {who}: {power:.3} in P, {rdf:.3} in g"));
        }
        page = page.row(points(name, &made)).row(curves(n, &made));
    }
    let text = format!(
        "Means of {sets} sets of {n} points. *spectral* was given the model's radial power, *force* its RDF. \
         Root mean square of the differences from the model, up to 6√*n* and 5/√*n*: {}.",
        errors.join("; ")
    );
    studio.page("", &page.paragraph(Text::math(&text)))
}

fn points(name: &str, made: &Imitation) -> Row {
    Row::new(
        125.0,
        vec![
            panels::points(name, &made.model[0]),
            panels::points(&format!("{name}, by *spectral*"), &made.spectral[0]),
            panels::points(&format!("{name}, by *force*"), &made.force[0]),
        ],
    )
}

fn curves(n: usize, made: &Imitation) -> Row {
    let density = Density::new(n);
    let all: [(&str, &[PointSet], Style); 3] = [
        ("model", &made.model, Style::Cycle(5)),
        ("*spectral*", &made.spectral, Style::Accent),
        ("*force*", &made.force, Style::Contrast),
    ];
    let range = (FARTHEST * density.hexagonal_spacing()).min(0.5);
    let (mut rdfs, mut powers) = (Vec::new(), Vec::new());
    for (name, sets, style) in all {
        let analysis = Analysis::of(sets);
        rdfs.push(Line::of_curve(name, &analysis.rdf_within(range, BINS), style));
        let highest = (HIGHEST * density.grid_nyquist()) as usize;
        if let Some(power) = analysis.radial_power(highest).curve() {
            powers.push(Line::of_curve(name, &power, style));
        }
    }
    Row::new(
        125.0,
        vec![
            panels::rdf("", density, &rdfs, (FARTHEST, 0.0, 3.0)),
            panels::power("", density, &powers, (HIGHEST, 3.0)),
        ],
    )
}
