//! The most similar of some names, for "did you mean".

/// The candidate with the fewest edits from `word`; the first one of several.
pub(crate) fn nearest<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    candidates.into_iter().min_by_key(|c| edit_distance(word, c))
}

/// Letters to insert, drop, replace or swap with their neighbour (Damerau, *A technique for
/// computer detection and correction of spelling errors*, 1964). O(product of the lengths).
pub(super) fn edit_distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut before = vec![0; b.len() + 1];
    let mut above: Vec<usize> = (0..=b.len()).collect();
    for i in 0..a.len() {
        let mut row = vec![i + 1];
        for j in 0..b.len() {
            let replaced = above[j] + usize::from(a[i] != b[j]);
            let mut best = replaced.min(above[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j] {
                best = best.min(before[j - 1] + 1);
            }
            row.push(best);
        }
        (before, above) = (above, row);
    }
    above[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edits_are_counted() {
        let of = |pair: (&str, &str)| edit_distance(pair.0, pair.1);
        assert_eq!([("", "abc"), ("abc", ""), ("samples", "sampels")].map(of), [3, 3, 1]);
        assert_eq!([("crease", "crease"), ("crease", "grease"), ("√", "")].map(of), [0, 1, 1]);
    }

    #[test]
    fn the_first_of_the_nearest_wins() {
        assert_eq!(nearest("bat", ["dog", "cat", "rat"]), Some("cat"));
        assert_eq!(nearest("bat", []), None);
    }
}
