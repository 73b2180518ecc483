//! Tables as aligned Markdown, which is also what the terminal shows.

use std::fmt::Write as _;

use super::{Cell, Row, Table};
use crate::markdown::{Align, Grid};
use crate::measure::Plan;
use crate::thesis::{Judgement, Verdict};

/// The table with a heading, its values, the reasons for what differs, and the options used.
pub(super) fn render(table: &Table, plan: Plan) -> String {
    let mut text = format!("## {}: {}\n\n", heading(table.id), table.title);
    let _ = writeln!(
        text,
        "{} sets of {} points, seed {}; one set where no seed matters.\n",
        plan.sets, plan.n, plan.seed
    );
    let mut reasons = Vec::new();
    let mut grid = Grid::new(&[
        ("method", Align::Left),
        ("quantity", Align::Left),
        ("thesis", Align::Right),
        ("ours", Align::Right),
        ("±", Align::Right),
        ("difference", Align::Right),
        ("expected", Align::Right),
        ("tolerance", Align::Right),
        ("verdict", Align::Left),
    ]);
    for row in &table.rows {
        for (i, cell) in row.cells.iter().enumerate() {
            let label = if i == 0 { name(row) } else { String::new() };
            let verdict = verdict(row, cell, &mut reasons);
            grid.row(line(label, cell, verdict, table.decimals));
        }
    }
    text.push_str(&grid.to_string());
    for (i, reason) in reasons.iter().enumerate() {
        let _ = writeln!(text, "\n[{}] {reason}", i + 1);
    }
    text.push_str(&options(table));
    text
}

fn heading(id: &str) -> String {
    match id {
        "B" => "Appendix B".to_owned(),
        number if number.starts_with(|c: char| c.is_ascii_digit()) => format!("Table {number}"),
        _ => "Beyond the thesis".to_owned(),
    }
}

fn name(row: &Row) -> String {
    if row.method.is_empty() {
        return row.label.clone();
    }
    format!("{} (`{}`)", row.label, row.method)
}

fn line(label: String, cell: &Cell, verdict: String, decimals: usize) -> Vec<String> {
    let judgement = &cell.judgement;
    let more = decimals + 1;
    let number = |value: Option<f64>| value.map(|v| format!("{v:.more$}")).unwrap_or_default();
    vec![
        label,
        cell.quantity.clone(),
        judgement.thesis.map(|v| format!("{v:.decimals$}")).unwrap_or_default(),
        cell.ours.map_or_else(|| "-".to_owned(), |v| format!("{v:.more$}")),
        number(cell.std_error),
        cell.difference.map(|d| format!("{d:+.more$}")).unwrap_or_default(),
        expected(judgement, decimals),
        number(judgement.tolerance),
        verdict,
    ]
}

/// The verdict with the numbers of its reasons, which are added to `reasons`.
fn verdict(row: &Row, cell: &Cell, reasons: &mut Vec<String>) -> String {
    let judgement = &cell.judgement;
    let mut verdict = judgement.verdict.word().to_owned();
    // A row that failed or isn't judged says why once, not once a cell.
    let of_row = row.failure.as_ref().map(|reason| format!("{}: {reason}", row.label));
    let of_cell = judgement.reason.as_ref().map(|reason| match judgement.verdict {
        Verdict::NotJudged => reason.clone(),
        _ => format!("{}, {}: {reason}", row.label, cell.quantity),
    });
    for reason in [of_cell, of_row].into_iter().flatten() {
        let place = reasons.iter().position(|known| *known == reason).unwrap_or_else(|| {
            reasons.push(reason);
            reasons.len() - 1
        });
        let _ = write!(verdict, " [{}]", place + 1);
    }
    verdict
}

/// What is expected where that is not simply the thesis's value.
fn expected(judgement: &Judgement, decimals: usize) -> String {
    let more = decimals + 1;
    match judgement.expected {
        Some((low, high)) if low < high => format!("{low:.decimals$}–{high:.decimals$}"),
        Some((value, _)) if Some(value) != judgement.thesis => format!("{value:.more$}"),
        _ => String::new(),
    }
}

/// The options of the rows that were measured, where they need a word.
fn options(table: &Table) -> String {
    let mut text = String::new();
    for row in &table.rows {
        let made = row.cells.iter().any(|cell| cell.ours.is_some());
        if !made || (row.options.is_empty() && row.why.is_empty()) {
            continue;
        }
        let options = match &*row.options {
            "" => "its defaults".to_owned(),
            typed => format!("`{typed}`"),
        };
        let why = if row.why.is_empty() { String::new() } else { format!(": {}", row.why) };
        let _ = writeln!(text, "- `{}` with {options}{why}", row.method);
    }
    if text.is_empty() { text } else { format!("\nOptions:\n\n{text}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::thesis::{Judge, Quantity, Rows};
    use bn_cli::analysis::Estimate;

    fn table() -> Table {
        let rows = Rows::load().expect("parses");
        let judge = Judge::for_thesis(4096, 10).expect("parses");
        let row = |method: &str, value: Option<f64>, failure: Option<&str>| {
            let spec = rows.iter().find(|row| row.method == method).expect("a row");
            let cell = |quantity| {
                let ours = value.map(|value| Estimate { value, std_error: Some(0.001) });
                Cell::new(&quantity, ours, judge.judge("4.2", spec, quantity, value))
            };
            Row {
                label: judge.thesis().method_name(&spec.thesis).to_owned(),
                method: method.to_owned(),
                options: spec.options_text(),
                why: spec.why.clone(),
                failure: failure.map(str::to_owned),
                cells: [Quantity::DMin, Quantity::RC].map(cell).into(),
            }
        };
        let rows =
            vec![row("dart-throwing", Some(0.81), None), row("regular", None, Some("no square"))];
        Table { id: "4.2", title: "a test", decimals: 2, rows }
    }

    #[test]
    fn columns_are_aligned_and_reasons_numbered() {
        let text = render(&table(), Plan { n: 4096, sets: 10, seed: 1 });
        let lines: Vec<_> = text.lines().filter(|line| line.starts_with('|')).collect();
        assert_eq!(lines.len(), 6, "{text}");
        let width = lines[0].chars().count();
        assert!(lines.iter().all(|line| line.chars().count() == width), "{text}");
        assert!(text.starts_with("## Table 4.2: a test\n\n10 sets of 4096 points, seed 1; one set where no seed matters.\n"));
        assert!(lines[3].contains("explained [1]") && lines[3].contains("1.07"), "{text}");
        assert!(lines[4].contains("OUTSIDE [2]") && lines[5].contains("OUTSIDE [2]"), "{text}");
        assert!(text.contains("[2] Regular (square) grid: no square\n"), "{text}");
        assert!(text.contains("- `dart-throwing` with `--radius"), "{text}");
    }
}
