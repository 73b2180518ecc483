//! The curves of a row, for the figures of appendix B.

use std::fs;
use std::path::Path;

use anyhow::Context as _;
use bn_cli::analysis::Analysis;
use bn_cli::{Failure, Outcome, output};

/// Writes RDF, radial power and anisotropy of an ensemble as CSV, as `bn analyze --curve` does.
pub(super) fn write(folder: &Path, name: &str, analysis: &Analysis<'_>) -> Outcome {
    fs::create_dir_all(folder)
        .with_context(|| format!("cannot make {}", folder.display()))
        .map_err(Failure::failed)?;
    let spectrum = analysis.radial_power(analysis.shown_frequency());
    let curves = [
        ("rdf", "r,g", Some(analysis.rdf())),
        ("radial_power", "nu,power", spectrum.curve()),
        ("anisotropy", "nu,anisotropy_db", spectrum.anisotropy_db()),
    ];
    for (what, header, curve) in curves {
        let Some(curve) = curve else { continue };
        let path = folder.join(format!("{name}_{what}.csv"));
        output::write_file(&path, |w| {
            writeln!(w, "{header}")?;
            // Rings without modes have no value.
            for (x, y) in curve.iter().filter(|(_, y)| y.is_finite()) {
                writeln!(w, "{x},{y}")?;
            }
            Ok(())
        })?;
    }
    Ok(())
}
