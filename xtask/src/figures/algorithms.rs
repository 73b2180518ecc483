//! Figure 5.13: the step and the single peak by gradient descent, forces and spectral matching.

use bn_cli::Outcome;
use bn_cli::analysis::{Analysis, Statistic};
use bn_cli::plot::{Page, Row, Style, Text};
use bn_core::Density;
use bn_spectral::{SinglePeak, Target, highest_step};

use super::FigureSpec;
use super::panels::{self, Line};
use super::studio::Studio;

pub(super) const FIGURES: &[FigureSpec] =
    &[FigureSpec { id: "5.13", title: "the algorithms on step and single peak", draw }];

/// The thesis compares the first two.
const ALGORITHMS: [(&str, &str); 3] =
    [("gradient", "Zhou et al. 2012"), ("force", "forces (the thesis)"), ("spectral", "spectral")];
/// The highest frequency shown, in √n/2.
const HIGHEST: f64 = 6.0;

fn draw(studio: &Studio) -> Outcome {
    let (n, count) = if studio.quick() { (64, 1) } else { (1024, 10) };
    let density = Density::new(n);
    let step = Target::step(density, highest_step(n as f64)).map_err(bn_cli::Failure::failed)?;
    let peak = Target::single_peak(density, SinglePeak::thesis(density))
        .map_err(bn_cli::Failure::failed)?;
    let mut page = Page::new().titled(Text::plain("Algorithms that match a spectrum"));
    for (algorithm, name) in ALGORITHMS {
        let mut row = Vec::new();
        for (method, target, top) in [("step", &step, 1.5), ("single-peak", &peak, 4.5)] {
            let sets = studio.sets(method, &[("algorithm", algorithm)], n, count)?;
            let analysis = Analysis::of(&sets);
            let highest = (HIGHEST * density.grid_nyquist()) as usize;
            let wanted = panels::grid(HIGHEST * density.grid_nyquist(), 1500);
            let wanted = wanted.into_iter().map(|nu| [nu, target.power(nu)]).collect();
            let mut lines = vec![Line::new("target", wanted, Style::Contrast)];
            if let Some(power) = analysis.radial_power(highest).curve() {
                lines.push(Line::of_curve("points", &power, Style::Accent));
            }
            let omega = analysis.estimate(Statistic::OmegaDirect).map_or(f64::NAN, |e| e.value);
            let title = format!("{name}, Ω = {omega:.2}");
            row.push(panels::power(&title, density, &lines, (HIGHEST, top)));
        }
        page = page.row(Row::new(120.0, row));
    }
    let sets = if count == 1 { "One set".to_owned() } else { format!("Means of {count} sets") };
    let text = format!("{sets} of {n} points; Ω from the exact ring means.");
    studio.page("", &page.paragraph(Text::plain(&text)))
}
