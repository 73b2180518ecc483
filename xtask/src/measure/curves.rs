//! The curves of a row, for the figures of appendix B.

use std::fs;
use std::path::Path;

use anyhow::Context as _;
use bn_cli::analysis::Analysis;
use bn_cli::{Failure, Outcome, output};
use bn_core::Curve;

/// Writes RDF, radial power and anisotropy of an ensemble as CSV, as `bn analyze --curve` does.
pub(super) fn write(folder: &Path, name: &str, analysis: &Analysis<'_>) -> Outcome {
    fs::create_dir_all(folder)
        .with_context(|| format!("cannot make {}", folder.display()))
        .map_err(Failure::failed)?;
    let direct = analysis.direct();
    write_curve(folder, name, "rdf", "r,g", &analysis.rdf())?;
    write_curve(folder, name, "radial_power", "nu,power", &direct.radial_power())?;
    write_curve(folder, name, "anisotropy", "nu,anisotropy_db", &direct.anisotropy_db())
}

fn write_curve(folder: &Path, name: &str, what: &str, header: &str, curve: &Curve) -> Outcome {
    output::write_file(&folder.join(format!("{name}_{what}.csv")), |w| {
        writeln!(w, "{header}")?;
        // Rings without modes have no value.
        for (x, y) in curve.iter().filter(|(_, y)| y.is_finite()) {
            writeln!(w, "{x},{y}")?;
        }
        Ok(())
    })
}
