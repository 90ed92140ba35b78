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

/// Levenshtein distance, ignoring case.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.to_lowercase().chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.to_lowercase().chars().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], i + 1);
        for (j, &cb) in b.iter().enumerate() {
            let substituted = diagonal + usize::from(ca != cb);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
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
        for (a, b, distance) in
            [("", "", 0), ("abc", "", 3), ("kitten", "sitting", 3), ("Off", "oFF", 0)]
        {
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
