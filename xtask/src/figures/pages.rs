//! The pages of appendix B: each row's points, spectra and statistics.

use bn_cli::Outcome;
use bn_cli::analysis::Analysis;
use bn_cli::report;

use super::FigureSpec;
use super::studio::Studio;
use crate::thesis::Rows;

pub(super) const FIGURES: &[FigureSpec] =
    &[FigureSpec { id: "B", title: "pages of all methods", draw }];

/// Spectra are shown up to this many √n/2.
const RANGE: f64 = 10.0;

fn draw(studio: &Studio) -> Outcome {
    let (n, sets) = if studio.quick() { (256, 2) } else { (4096, 10) };
    for row in Rows::load()?.iter().filter(|row| row.method().is_some()) {
        let options: Vec<_> = row.options.iter().map(|(k, v)| (k.as_str(), v.as_str())).collect();
        let sets = studio.sets(&row.method, &options, n, sets)?;
        let analysis = Analysis::of(&sets);
        let frequency = (RANGE * analysis.density().grid_nyquist()).ceil() as usize;
        let title = format!("{} {}", row.method, row.options_text());
        let data = analysis.report_data(title.trim().to_owned(), studio.provenance(), frequency);
        studio.page(&row.method, &report::page(&data))?;
    }
    Ok(())
}
