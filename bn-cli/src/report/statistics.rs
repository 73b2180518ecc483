//! The table of statistics.

use crate::plot::{Table, Text};

/// A number of the table.
#[derive(Clone, Debug, PartialEq)]
pub struct Statistic {
    /// Its symbol.
    pub label: Text,
    /// Its value; NaN where it was not computed.
    pub value: f64,
    /// The standard error of the mean over the sets, where there is one.
    pub std_error: Option<f64>,
}

/// Columns that fit a page.
const MOST_COLUMNS: usize = 8;

/// The statistics in tables of at most eight columns, a row of standard errors where any is known.
pub(super) fn tables(statistics: &[Statistic], sets: usize) -> Vec<Table> {
    statistics.chunks(MOST_COLUMNS).map(|part| table(part, sets)).collect()
}

fn table(statistics: &[Statistic], sets: usize) -> Table {
    let row = |name: &str, cell: &dyn Fn(&Statistic) -> String| -> Vec<Text> {
        let cells = statistics.iter().map(|s| Text::math(&cell(s)));
        std::iter::once(Text::plain(name)).chain(cells).collect()
    };
    let labels = statistics.iter().map(|s| s.label.clone());
    let head = std::iter::once(Text::default()).chain(labels).collect();
    let name = if sets > 1 { "mean" } else { "value" };
    let table = Table::new(head).row(row(name, &|s| formatted(s.value, decimals(s.std_error))));
    if statistics.iter().all(|s| s.std_error.is_none()) {
        return table;
    }
    let error = |s: &Statistic| {
        s.std_error.map_or_else(|| "–".into(), |e| formatted(e, decimals(s.std_error)))
    };
    table.row(row("std. error", &error))
}

/// Decimals that show two digits of the error: three if there is none, and always two to five.
fn decimals(std_error: Option<f64>) -> usize {
    match std_error {
        Some(error) if error > 0.0 && error.is_finite() => {
            (1.0 - error.log10().floor()).clamp(2.0, 5.0) as usize
        }
        _ => 3,
    }
}

/// The value with so many decimals, as a power of ten where that would be long, – where there is
/// none.
fn formatted(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return "–".into();
    }
    let sign = if value < 0.0 { "−" } else { "" };
    let size = value.abs();
    if size < 1e5 {
        return format!("{sign}{size:.decimals$}");
    }
    let power = size.log10().floor();
    format!("{sign}{:.2}·10^{{{power}}}", size / 10f64.powf(power))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_show_what_their_error_allows() {
        assert_eq!(formatted(0.903_417, decimals(Some(0.002_3))), "0.9034");
        assert_eq!(formatted(0.903_417, decimals(Some(0.4))), "0.90");
        assert_eq!(formatted(0.903_417, decimals(None)), "0.903");
        assert_eq!(formatted(0.5, decimals(Some(f64::NAN))), "0.500");
        assert_eq!(formatted(f64::NAN, 3), "–");
        assert_eq!(formatted(-1.23e6, 3), "−1.23·10^{6}");
    }

    #[test]
    fn tables_break_at_the_page_width() {
        let one = Statistic { label: Text::plain("q"), value: 1.0, std_error: None };
        assert_eq!(tables(&vec![one.clone(); 19], 1).len(), 3);
        assert_eq!(tables(&[], 1).len(), 0);
    }
}
