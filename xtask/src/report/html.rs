//! The report's page.

use std::fmt::Write as _;

use super::markdown::{self, escape};
use super::picture::Picture;
use crate::tables::Tally;
use crate::thesis::Verdict;

/// A table as the report shows it.
pub(super) struct TableEntry {
    /// Its number in the thesis.
    pub(super) id: &'static str,
    /// How its values fared.
    pub(super) tally: Tally,
    /// Its text in Markdown.
    pub(super) text: String,
}

/// A figure as the report shows it.
pub(super) struct FigureEntry {
    /// Its number or word.
    pub(super) id: &'static str,
    pub(super) title: &'static str,
    pub(super) pictures: Vec<Picture>,
}

/// The document; it needs no other file.
pub(super) fn document(note: &str, tables: &[TableEntry], figures: &[FigureEntry]) -> String {
    let mut html = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<title>{TITLE}</title>\n\
         <style>{STYLE}</style>\n</head>\n<body>\n<h1>{TITLE}</h1>\n<p>{}</p>\n",
        escape(note)
    );
    html.push_str(&verdicts(tables));
    html.push_str("<h2 id=\"sheet\">All figures</h2>\n<div class=\"sheet\">\n");
    for figure in figures {
        html.push_str(&thumbnails(figure));
    }
    html.push_str("</div>\n<h2 id=\"tables\">Tables</h2>\n");
    for table in tables {
        let body = markdown::to_html(&table.text);
        let _ = writeln!(html, "<section id=\"table-{}\">\n{body}</section>", table.id);
    }
    html.push_str("<h2 id=\"figures\">Figures</h2>\n");
    for figure in figures {
        html.push_str(&figure_section(figure));
    }
    html.push_str("</body>\n</html>\n");
    html
}

const TITLE: &str = "The thesis's tables and figures";

const STYLE: &str = "
body { font: 15px/1.45 Georgia, serif; max-width: 76rem; margin: 2rem auto; padding: 0 1rem; color: #1a1a1a }
h1, h2, h3 { font-weight: 600; line-height: 1.2 }
h2 { border-bottom: 1px solid #bbb; margin-top: 2.5rem }
code { font-size: 0.88em }
.wide { overflow-x: auto }
table { border-collapse: collapse; font-size: 0.88em; font-variant-numeric: tabular-nums }
th, td { padding: 0.12em 0.6em; text-align: left; white-space: nowrap }
th { border-bottom: 1px solid #888 }
tr.first td { border-top: 1px solid #ddd }
.right { text-align: right }
.ok { color: #176b2c } .explained { color: #8a5a00 } .outside { color: #fff; background: #b3261e } .idle { color: #777 }
.sheet { display: flex; flex-wrap: wrap; gap: 0.8rem }
.sheet a { width: 11rem; color: inherit; text-decoration: none; font-size: 0.85em; border: 1px solid #ddd; padding: 0.3rem }
.sheet svg { width: 100%; height: 9rem; display: block }
figure { margin: 1rem 0 }
figure svg { max-width: 100%; height: auto }
";

/// How the values of each table fared.
fn verdicts(tables: &[TableEntry]) -> String {
    let all = [
        Verdict::Agrees,
        Verdict::Explained,
        Verdict::Outside,
        Verdict::NotJudged,
        Verdict::NotYet,
    ];
    let mut html = String::from("<table>\n<tr><th>table</th>");
    for word in all.map(Verdict::word) {
        let _ = write!(html, "<th class=\"right\">{word}</th>");
    }
    html.push_str("</tr>\n");
    for table in tables {
        let _ = write!(html, "<tr><td><a href=\"#table-{0}\">{0}</a></td>", table.id);
        for count in all.map(|verdict| table.tally.count(verdict)) {
            let _ = write!(html, "<td class=\"right\">{count}</td>");
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</table>\n");
    html
}

/// The name of a picture inside the document.
fn name(figure: &FigureEntry, picture: usize) -> String {
    format!("picture-{}-{picture}", figure.id.replace('.', "-"))
}

/// What stands below a picture: the figure's title, and which part of it this is.
fn caption(figure: &FigureEntry, picture: &Picture) -> String {
    let comma = if picture.part.is_empty() { "" } else { ", " };
    escape(&format!("{}{comma}{}", figure.title, picture.part))
}

/// A small view of each picture: the same data as below, not a second copy.
fn thumbnails(figure: &FigureEntry) -> String {
    let mut html = String::new();
    for (i, picture) in figure.pictures.iter().enumerate() {
        let ((width, height), name) = (picture.size, name(figure, i));
        let _ = writeln!(
            html,
            "<a href=\"#figure-{0}\"><svg viewBox=\"0 0 {width:.1} {height:.1}\" role=\"img\" \
             aria-label=\"figure {0}\"><use href=\"#{name}\"/></svg>{0}: {1}</a>",
            escape(figure.id),
            caption(figure, picture),
        );
    }
    html
}

fn figure_section(figure: &FigureEntry) -> String {
    let (id, title) = (escape(figure.id), escape(figure.title));
    let mut html = format!("<section id=\"figure-{id}\">\n<h3>Figure {id}: {title}</h3>\n");
    for (i, picture) in figure.pictures.iter().enumerate() {
        let Picture { size: (width, height), uri, .. } = picture;
        let _ = writeln!(
            html,
            "<figure><svg width=\"{width:.1}\" height=\"{height:.1}\" viewBox=\"0 0 {width:.1} {height:.1}\" \
             role=\"img\" aria-label=\"{}\"><image id=\"{}\" width=\"{width:.1}\" \
             height=\"{height:.1}\" href=\"{uri}\"/></svg></figure>",
            caption(figure, picture),
            name(figure, i)
        );
    }
    html.push_str("</section>\n");
    html
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_picture_is_kept_once_and_shown_twice() {
        let text = "## Table 5.3: x\n\n| m | verdict |\n| :-- | :-- |\n| a | ok |\n".to_owned();
        let tally = serde_json::from_str(r#"{"agrees": 1}"#).expect("a tally");
        let tables = [TableEntry { id: "5.3", tally, text }];
        let uri = "data:image/png;base64,QQ==".to_owned();
        let picture = Picture { part: "fpo".to_owned(), size: (10.0, 5.0), uri };
        let figures = [FigureEntry {
            id: "5.7",
            title: "peaks & steps",
            pictures: vec![picture.clone(), picture],
        }];
        let html = document("A test.", &tables, &figures);
        assert_eq!(html.matches("base64,QQ==").count(), 2, "two pictures");
        assert_eq!(html.matches("<use href=\"#picture-5-7-1\"/>").count(), 1);
        assert_eq!(html.matches("id=\"picture-5-7-1\"").count(), 1);
        assert!(html.contains("<td><a href=\"#table-5.3\">5.3</a></td><td class=\"right\">1</td>"));
        assert_eq!(html.matches("5.7: peaks &amp; steps, fpo</a>").count(), 2);
        assert!(html.contains("<h3>Figure 5.7: peaks &amp; steps</h3>"));
        // Nothing is fetched: every reference is to the page itself or data.
        for reference in html.split("href=\"").skip(1) {
            assert!(
                reference.starts_with('#') || reference.starts_with("data:"),
                "{reference:.40}"
            );
        }
        assert!(!html.contains("src=") && !html.contains("url("), "{html}");
    }
}
