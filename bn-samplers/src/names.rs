//! Finding the name that was probably meant.

/// The candidate that is nearest to `name` by edit distance, if one is near enough to be meant.
pub(crate) fn nearest_name<'a>(
    name: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let (distance, best) = candidates
        .into_iter()
        .map(|candidate| (edit_distance(name, candidate), candidate))
        .min_by_key(|&(distance, _)| distance)?;
    let length = best.chars().count();
    (distance <= length.div_ceil(3)).then_some(best)
}

/// The number of letters to insert, delete or replace to get from `a` to `b` (Levenshtein), only
/// the first 64 letters looked at: names are short and the cost is the product of the lengths.
fn edit_distance(a: &str, b: &str) -> usize {
    let a: Vec<char> = a.chars().take(64).collect();
    let b: Vec<char> = b.chars().take(64).collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.iter().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_edits() {
        for (a, b, want) in [("", "abc", 3), ("kitten", "sitting", 3), ("fpo", "fpo", 0)] {
            assert_eq!(edit_distance(a, b), want);
            assert_eq!(edit_distance(b, a), want);
        }
    }

    #[test]
    fn suggests_only_what_is_near() {
        let names = ["jittered", "halton", "net"];
        assert_eq!(nearest_name("jitered", names), Some("jittered"));
        assert_eq!(nearest_name("Halton", names), Some("halton"));
        assert_eq!(nearest_name("nosuch", names), None);
        assert_eq!(nearest_name("x", []), None);
    }
}
