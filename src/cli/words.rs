//! Small things as people read them.

/// A count with its thousands in groups, from five digits on: 4346, but 12,345.
#[must_use]
pub fn count(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) && digits.len() > 4 {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// The boundary of a surface that has so many boundary edges.
#[must_use]
pub fn boundary(edges: u64) -> String {
    match edges {
        0 => "closed".to_owned(),
        n => format!("{} boundary edges", count(n)),
    }
}

/// The candidate at the smallest edit distance, if that is at most a third of the word (and not
/// the word itself); the first in alphabetical order among equals.
#[must_use]
pub fn nearest<'a>(wanted: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    candidates
        .map(|name| (edit_distance(wanted, name), name))
        .filter(|&(distance, _)| distance > 0 && distance <= wanted.chars().count().div_ceil(3))
        .min()
        .map(|(_, name)| name)
}

/// How many letters must be put in, left out, replaced or exchanged with the next to make one word of
/// the other, ignoring case (optimal string alignment).
fn edit_distance(a: &str, b: &str) -> usize {
    let [a, b] = [a, b].map(|word| word.to_lowercase().chars().collect::<Vec<char>>());
    let mut rows = vec![(0..=b.len()).collect::<Vec<usize>>()];
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let replaced = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut least = replaced.min(row[j - 1] + 1).min(rows[i - 1][j] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                least = least.min(rows[i - 2][j - 2] + 1);
            }
            row.push(least);
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
}

/// What to say when `wanted` is none of the words known, but near to one of them: `; did you mean
/// `growth`?`, or nothing.
#[must_use]
pub fn did_you_mean<'a>(wanted: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let near = nearest(wanted, known.into_iter());
    near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_grouped() {
        for (n, text) in
            [(0, "0"), (999, "999"), (4346, "4346"), (12345, "12,345"), (1234567, "1,234,567")]
        {
            assert_eq!(count(n), text);
        }
    }

    #[test]
    fn a_surface_without_a_boundary_is_closed() {
        assert_eq!([boundary(0), boundary(12345)], ["closed", "12,345 boundary edges"]);
    }

    #[test]
    fn edit_distances() {
        for (a, b, distance) in [
            ("", "", 0),
            ("abc", "", 3),
            ("kitten", "sitting", 3),
            ("Off", "oFF", 0),
            ("mhs", "msh", 1),
        ] {
            assert_eq!(edit_distance(a, b), distance, "{a} {b}");
        }
    }

    #[test]
    fn far_words_are_not_suggested() {
        assert_eq!(nearest("wing.poly", ["plate.json", "lake.poly"].into_iter()), None);
        assert_eq!(nearest("M33", ["M3", "M13", "D1"].into_iter()), Some("M13"));
    }

    // spec: K42
    #[test]
    fn near_words_are_suggested() {
        assert_eq!(did_you_mean("grwoth", ["mean", "growth"]), "; did you mean `growth`?");
        assert_eq!(did_you_mean("0.1*x", ["mean", "growth"]), "");
    }
}
