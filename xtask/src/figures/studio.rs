//! Where figures are drawn: their points, their files.

use std::cell::RefCell;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use bn_cli::plot::Page;
use bn_cli::{Failure, Outcome, output};
use bn_core::PointSet;
use serde_json::{Value, json};

use super::DrawnPage;
use crate::measure::{Plan, Store, make};
use crate::thesis::RowSpec;

/// What a figure is drawn with.
#[derive(Debug)]
pub(crate) struct Studio {
    folder: PathBuf,
    id: &'static str,
    store: Store,
    quick: bool,
    /// The names of the pages' files.
    pages: RefCell<Vec<String>>,
}

impl Studio {
    /// A studio for the figure `id`, whose files go into `thesis/figures` and whose point sets are
    /// those that the tables keep in `thesis/points`.
    pub(super) fn new(thesis: &Path, id: &'static str, quick: bool) -> Outcome<Self> {
        let folder = thesis.join(if quick { "quick/figures" } else { "figures" });
        fs::create_dir_all(&folder)
            .with_context(|| format!("cannot make {}", folder.display()))
            .map_err(Failure::failed)?;
        let (store, pages) = (Store::new(thesis.join("points"), true), RefCell::default());
        Ok(Self { folder, id, store, quick, pages })
    }

    /// Whether a small version will do: the figure must be drawn, not say anything.
    pub(crate) fn quick(&self) -> bool {
        self.quick
    }

    /// `count` sets of `n` points by a method of the registry with its options as one types them,
    /// seed 1; kept on disk, so that tables and figures show the same points.
    pub(crate) fn sets(
        &self,
        method: &str,
        options: &[(&str, &str)],
        n: usize,
        count: u32,
    ) -> Outcome<Vec<PointSet>> {
        let row = RowSpec {
            thesis: String::new(),
            method: method.to_owned(),
            options: options.iter().map(|&(k, v)| (k.to_owned(), v.to_owned())).collect(),
            why: String::new(),
        };
        let known = row.method().ok_or_else(|| Failure::misuse(format!("no method {method}")))?;
        let plan = Plan { n, sets: count, seed: 1 };
        let (sets, _) =
            make::sets(&row, known, plan, Some(&self.store))?.map_err(Failure::failed)?;
        Ok(sets)
    }

    /// The place of one of the figure's files; `part` tells several apart, and may be empty.
    pub(crate) fn place(&self, part: &str, extension: &str) -> PathBuf {
        let dash = if part.is_empty() { "" } else { "-" };
        self.folder.join(format!("figure_{}{dash}{part}.{extension}", self.id.replace('.', "_")))
    }

    /// What tells the file of this name from others of the figure, in words.
    fn part(&self, name: &str) -> String {
        let whole = self.place("", "svg");
        let stem = whole.file_stem().unwrap_or_default().to_string_lossy();
        let part = name.strip_prefix(&*stem).and_then(|rest| rest.strip_suffix(".svg"));
        part.unwrap_or_default().replace('-', " ").trim().to_owned()
    }

    /// How the figure is made, for its files to carry.
    pub(crate) fn provenance(&self) -> String {
        format!("cargo xtask figures --only {}", self.id)
    }

    /// Writes a page of the figure as SVG, and as PNG beside it with the feature `png`.
    pub(crate) fn page(&self, part: &str, page: &Page) -> Outcome {
        let page = page.clone().made_by(&self.provenance());
        let (svg, place) = (page.to_svg(), self.place(part, "svg"));
        output::write_file(&place, |w| Ok(w.write_all(svg.as_bytes())?))?;
        let name = place.file_name().unwrap_or_default().to_string_lossy().into_owned();
        self.pages.borrow_mut().push(name);
        #[cfg(feature = "png")]
        {
            let png = page.to_png().map_err(Failure::failed)?;
            output::write_file(&self.place(part, "png"), |w| Ok(w.write_all(&png)?))?;
        }
        Ok(())
    }

    /// Notes that the figure is complete, and its pages.
    pub(super) fn finish(&self) -> Outcome {
        let pages = json!({ "made_by": self.provenance(), "pages": *self.pages.borrow() });
        output::write_file(&self.place("", "json"), |w| Ok(writeln!(w, "{pages:#}")?))
    }

    /// The figure's pages, if all have been drawn and are there.
    pub(super) fn finished(&self) -> Option<Vec<DrawnPage>> {
        let noted: Value = serde_json::from_slice(&fs::read(self.place("", "json")).ok()?).ok()?;
        let page = |name: &Value| {
            let name = name.as_str()?;
            let file = Some(self.folder.join(name)).filter(|file| file.exists())?;
            Some(DrawnPage { part: self.part(name), file })
        };
        noted["pages"].as_array()?.iter().map(page).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_named_by_the_figure() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let studio = Studio::new(folder.path(), "4.6", true).expect("writable");
        assert!(studio.quick());
        assert!(studio.place("", "svg").ends_with("quick/figures/figure_4_6.svg"));
        assert!(studio.place("b", "png").ends_with("figure_4_6-b.png"));
        studio.page("", &Page::new()).expect("written");
        let text = fs::read_to_string(studio.place("", "svg")).expect("there");
        assert!(text.contains("cargo xtask figures --only 4.6"), "{text}");
    }

    #[test]
    fn a_figure_is_complete_when_it_says_so_and_its_pages_are_there() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let studio = Studio::new(folder.path(), "4.6", true).expect("writable");
        for part in ["b-c", "a", ""] {
            studio.page(part, &Page::new()).expect("written");
        }
        assert_eq!(studio.finished(), None);
        studio.finish().expect("written");
        let page = |part: &str, file: &str| DrawnPage {
            part: part.to_owned(),
            file: studio.place(file, "svg"),
        };
        let pages = [page("b c", "b-c"), page("a", "a"), page("", "")];
        assert_eq!(studio.finished().as_deref(), Some(&pages[..]));
        fs::remove_file(&pages[1].file).expect("there");
        assert_eq!(studio.finished(), None);
    }

    #[test]
    fn points_are_kept_for_the_next_figure() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let studio = Studio::new(folder.path(), "3.1", true).expect("writable");
        let first = studio.sets("jittered", &[("width", "0.5")], 16, 2).expect("made");
        assert_eq!((first.len(), first[1].len()), (2, 16));
        assert_eq!(studio.sets("jittered", &[("width", "0.5")], 16, 2).expect("read"), first);
        assert!(studio.sets("jiterred", &[], 16, 1).is_err());
    }
}
