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
}
