//! `cargo xtask figures`: the thesis's figures, drawn from our own points.

mod adaptive;
mod algorithms;
mod correlations;
mod designs;
mod drawing;
mod feasible;
mod gallery;
mod imitations;
mod moves;
mod optimization;
mod pages;
mod panels;
mod prediction;
mod reconstruction;
mod spectra;
mod studio;
mod supersampling;
mod test_scenes;
mod zone_plates;

use std::path::PathBuf;
use std::time::Instant;

use bn_cli::{Failure, Outcome};
use clap::Args;

use crate::workspace;
use studio::Studio;

/// A figure, or several that are drawn from the same data.
pub(crate) struct FigureSpec {
    /// Its number in the thesis, or a word for one that the thesis hasn't: the stem of its files.
    id: &'static str,
    title: &'static str,
    draw: fn(&Studio) -> Outcome,
}

/// All figures, in the thesis's order; one file a family.
static FIGURES: [&[FigureSpec]; 15] = [
    test_scenes::FIGURES,
    zone_plates::FIGURES,
    supersampling::FIGURES,
    prediction::FIGURES,
    spectra::FIGURES,
    moves::FIGURES,
    optimization::FIGURES,
    correlations::FIGURES,
    imitations::FIGURES,
    designs::FIGURES,
    feasible::FIGURES,
    algorithms::FIGURES,
    reconstruction::FIGURES,
    pages::FIGURES,
    adaptive::FIGURES,
];

/// The thesis's figures as SVG files (pictures as PNG) under target/thesis/figures/
#[derive(Debug, Args)]
pub(crate) struct FiguresArgs {
    /// Only these figures, by number or word (may be repeated)
    #[arg(long, value_name = "FIGURE")]
    only: Vec<String>,
    /// Names the figures and draws none
    #[arg(long, conflicts_with_all = ["only", "quick"])]
    list: bool,
    /// Fewer points and sets: whether the figures are drawn, not what they show
    #[arg(long)]
    quick: bool,
}

impl FiguresArgs {
    /// What CI runs.
    pub(crate) fn for_ci() -> Self {
        Self { only: Vec::new(), list: false, quick: true }
    }
}

pub(crate) fn run(args: &FiguresArgs) -> Outcome {
    let figures = select(&args.only)?;
    if args.list {
        return bn_cli::output::write_stdout(|w| {
            figures.iter().try_for_each(|f| writeln!(w, "{:<8} {}", f.id, f.title))?;
            Ok(())
        });
    }
    figures.into_iter().try_for_each(|figure| draw(figure, args.quick))
}

fn draw(figure: &FigureSpec, quick: bool) -> Outcome {
    let start = Instant::now();
    let studio = figure.studio(quick)?;
    (figure.draw)(&studio)?;
    studio.finish()?;
    let seconds = start.elapsed().as_secs_f64();
    eprintln!("figure {}: {seconds:.1} s ({})", figure.id, figure.title);
    Ok(())
}

impl FigureSpec {
    fn studio(&self, quick: bool) -> Outcome<Studio> {
        Studio::new(&workspace::root()?.join("target/thesis"), self.id, quick)
    }
}

/// A figure with its pages' files.
pub(crate) struct Drawn {
    pub(crate) id: &'static str,
    pub(crate) title: &'static str,
    pub(crate) pages: Vec<DrawnPage>,
}

/// A page of a figure that is on disk.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct DrawnPage {
    /// What tells it from the figure's other pages, in words; may be empty.
    pub(crate) part: String,
    /// The SVG file.
    pub(crate) file: PathBuf,
}

/// All figures; those that have been drawn are not drawn again unless `fresh`.
pub(crate) fn drawn(quick: bool, fresh: bool) -> Outcome<Vec<Drawn>> {
    let one = |figure: &'static FigureSpec| {
        let studio = figure.studio(quick)?;
        let kept = if fresh { None } else { studio.finished() };
        let pages = if let Some(pages) = kept {
            pages
        } else {
            draw(figure, quick)?;
            studio.finished().unwrap_or_default()
        };
        Ok(Drawn { id: figure.id, title: figure.title, pages })
    };
    select(&[])?.into_iter().map(one).collect()
}

/// The figures asked for; all if none is named.
fn select(only: &[String]) -> Outcome<Vec<&'static FigureSpec>> {
    let all = || FIGURES.iter().copied().flatten();
    if only.is_empty() {
        return Ok(all().collect());
    }
    let find = |name: &String| {
        all().find(|figure| figure.id.eq_ignore_ascii_case(name)).ok_or_else(|| {
            let known: Vec<_> = all().map(|figure| figure.id).collect();
            Failure::misuse(format!("no figure {name}; there are {}", known.join(", ")))
        })
    };
    only.iter().map(find).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_selected_by_name() {
        let count = FIGURES.iter().map(|family| family.len()).sum::<usize>();
        assert_eq!(select(&[]).expect("all").len(), count);
        let error = select(&["9.9".to_owned()]).err().expect("unknown");
        assert_eq!(error.code(), Failure::USAGE);
        for (i, figure) in select(&[]).expect("all").iter().enumerate() {
            assert_eq!(
                select(&[]).expect("all").iter().position(|other| other.id == figure.id),
                Some(i),
                "two figures named {}",
                figure.id
            );
        }
    }
}
