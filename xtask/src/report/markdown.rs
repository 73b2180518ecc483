//! HTML of the Markdown that this program writes.

use std::fmt::Write as _;

/// The HTML of headings, paragraphs, lists, aligned tables and code in backticks. Other Markdown is
/// text here: the tables have none.
pub(super) fn to_html(text: &str) -> String {
    let mut html = String::new();
    let mut lines = text.lines().peekable();
    while let Some(line) = lines.next() {
        if let Some(heading) = line.strip_prefix("## ") {
            let _ = writeln!(html, "<h3>{}</h3>", inline(heading));
        } else if line.starts_with('|') {
            let mut rows = vec![line];
            rows.extend(std::iter::from_fn(|| lines.next_if(|next| next.starts_with('|'))));
            html.push_str(&table(&rows));
        } else if let Some(item) = line.strip_prefix("- ") {
            let _ = writeln!(html, "<ul>\n<li>{}</li>", inline(item));
            while let Some(next) = lines.next_if(|next| next.starts_with("- ")) {
                let _ = writeln!(html, "<li>{}</li>", inline(&next[2..]));
            }
            html.push_str("</ul>\n");
        } else if !line.trim().is_empty() {
            let _ = writeln!(html, "<p>{}</p>", inline(line));
        }
    }
    html
}

/// A table from its head, its rule and its rows.
fn table(lines: &[&str]) -> String {
    let mut html = String::from("<div class=\"wide\"><table>\n");
    let right: Vec<bool> = lines
        .get(1)
        .map_or_else(Vec::new, |rule| cells(rule))
        .iter()
        .map(|c| c.ends_with(':'))
        .collect();
    for (i, line) in lines.iter().enumerate().filter(|(i, _)| *i != 1) {
        let (tag, cells) = (if i == 0 { "th" } else { "td" }, cells(line));
        // A row whose first cell is filled begins a group.
        let begins = i > 1 && cells.first().is_some_and(|cell| !cell.is_empty());
        html.push_str(if begins { "<tr class=\"first\">" } else { "<tr>" });
        for (column, cell) in cells.iter().enumerate() {
            let is_right = right.get(column).copied().unwrap_or(false);
            let class = [if is_right { "right" } else { "" }, verdict_class(cell)].join(" ");
            let _ = write!(html, "<{tag} class=\"{}\">{}</{tag}>", class.trim(), inline(cell));
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</table></div>\n");
    html
}

/// The cells of a line, without the bars that are escaped.
fn cells(line: &str) -> Vec<String> {
    let bar = "\u{1}";
    let line = line.trim().trim_start_matches('|').replace("\\|", bar);
    let line = line.strip_suffix('|').unwrap_or(&line);
    line.split('|').map(|cell| cell.trim().replace(bar, "|")).collect()
}

/// The class of a cell that tells how a value fared.
fn verdict_class(cell: &str) -> &'static str {
    let word = cell.split(" [").next().unwrap_or_default();
    match word {
        "ok" => "ok",
        "explained" => "explained",
        "OUTSIDE" => "outside",
        "not judged" | "not yet" => "idle",
        _ => "",
    }
}

/// Text with its code marked.
fn inline(text: &str) -> String {
    let mut html = String::new();
    for (i, part) in text.split('`').enumerate() {
        let part = escape(part);
        let _ =
            if i % 2 == 1 { write!(html, "<code>{part}</code>") } else { write!(html, "{part}") };
    }
    html
}

/// Text for HTML, fit for attributes too.
pub(super) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::markdown::{Align, Grid};

    #[test]
    fn what_the_tables_write_becomes_html() {
        let mut grid =
            Grid::new(&[("name", Align::Left), ("x", Align::Right), ("verdict", Align::Left)]);
        grid.row(vec!["a|b (`c`)".to_owned(), "1".to_owned(), "ok".to_owned()]);
        grid.row(vec![String::new(), "2".to_owned(), "OUTSIDE [1]".to_owned()]);
        let text = format!("## Table 1: <x>\n\n{grid}\n[1] why & how\n\nOptions:\n\n- `c`\n- d\n");
        let html = to_html(&text);
        for part in [
            "<h3>Table 1: &lt;x&gt;</h3>",
            "<tr class=\"first\"><td class=\"\">a|b (<code>c</code>)</td><td class=\"right\">1</td><td class=\"ok\">ok</td></tr>",
            "<td class=\"outside\">OUTSIDE [1]</td>",
            "<p>[1] why &amp; how</p>",
            "<ul>\n<li><code>c</code></li>\n<li>d</li>\n</ul>",
        ] {
            assert!(html.contains(part), "{part}\n{html}");
        }
        assert!(!html.contains("---"), "{html}");
    }
}
