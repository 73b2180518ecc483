//! `cargo xtask report`: all tables and figures on one page that needs no other file.

mod html;
mod markdown;
mod picture;

use bn_cli::{Outcome, output};
use clap::Args;

use crate::figures::DrawnPage;
use crate::tables::{Kept, Tally};
use crate::{figures, tables, workspace};
use html::{FigureEntry, TableEntry};
use picture::Picture;

/// One HTML page of all tables and figures, target/thesis/report.html, from the files that they
/// wrote; what is missing is made, and tables of other points or by another build are made again
#[derive(Debug, Args)]
pub(crate) struct ReportArgs {
    /// From the quick tables and figures, into target/thesis/quick/
    #[arg(long)]
    quick: bool,
    /// Make all tables and figures again
    #[arg(long)]
    fresh: bool,
}

impl ReportArgs {
    /// What CI runs.
    pub(crate) fn for_ci() -> Self {
        Self { quick: true, fresh: false }
    }
}

pub(crate) fn run(args: &ReportArgs) -> Outcome {
    let mut folder = workspace::root()?.join("target/thesis");
    let tables = table_entries(args)?;
    let figures = figure_entries(args)?;
    let (scale, quick) = if args.quick {
        folder.push("quick");
        (
            " Quick versions: fewer and smaller point sets, which show that everything is made.",
            " --quick",
        )
    } else {
        ("", "")
    };
    let note = format!(
        "Made by cargo xtask report{quick} from what cargo xtask tables{quick} and cargo xtask \
         figures{quick} wrote.{scale}"
    );
    let path = folder.join("report.html");
    let page = html::document(&note, &tables, &figures);
    output::write_file(&path, |w| Ok(w.write_all(page.as_bytes())?))?;
    eprintln!("wrote {} ({:.1} MB)", path.display(), page.len() as f64 / 1e6);
    Tally::sum(tables.iter().map(|table| &table.tally)).outcome()
}

fn table_entries(args: &ReportArgs) -> Outcome<Vec<TableEntry>> {
    let made = tables::all(args.quick, args.fresh)?;
    Ok(made
        .into_iter()
        .map(|(id, Kept { tally, text, .. })| TableEntry { id, tally, text })
        .collect())
}

fn figure_entries(args: &ReportArgs) -> Outcome<Vec<FigureEntry>> {
    let entry = |figure: figures::Drawn| {
        let picture = |page: DrawnPage| Picture::read(page, cfg!(feature = "png"));
        let pictures = figure.pages.into_iter().map(picture).collect::<Outcome<_>>()?;
        Ok(FigureEntry { id: figure.id, title: figure.title, pictures })
    };
    figures::drawn(args.quick, args.fresh)?.into_iter().map(entry).collect()
}
