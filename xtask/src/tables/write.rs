//! Tables as files.

use std::fs;
use std::path::Path;

use anyhow::Context as _;
use bn_cli::{Failure, Outcome, output};
use serde_json::json;

use super::{Table, markdown};
use crate::measure::Plan;

/// The stem of the table's files.
pub(super) fn name(id: &str) -> String {
    match id {
        "B" => "appendix_b".to_owned(),
        _ => format!("table_{}", id.replace('.', "_")),
    }
}

/// Writes the table as Markdown into `folder`; the text.
pub(super) fn table(folder: &Path, table: &Table, plan: Plan) -> Outcome<String> {
    let text = markdown::render(table, plan);
    make_folder(folder)?;
    let path = folder.join(format!("{}.md", name(table.id)));
    output::write_file(&path, |w| Ok(w.write_all(text.as_bytes())?))?;
    Ok(text)
}

/// Writes the tables as one JSON object.
pub(super) fn json(path: &Path, tables: &[Table], plan: Plan) -> Outcome {
    if let Some(folder) = path.parent() {
        make_folder(folder)?;
    }
    let document = json!({
        "schema": "bn-thesis-tables",
        "version": 1,
        "sets": plan.sets,
        "points": plan.n,
        "seed": plan.seed,
        "tables": tables,
    });
    output::write_file(path, |w| Ok(writeln!(w, "{document:#}")?))
}

fn make_folder(folder: &Path) -> Outcome {
    if folder.as_os_str().is_empty() {
        return Ok(());
    }
    fs::create_dir_all(folder)
        .with_context(|| format!("cannot make {}", folder.display()))
        .map_err(Failure::failed)
}
