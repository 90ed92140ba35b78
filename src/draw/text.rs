//! Text in SVG: escaping and numbers for people.

use std::fmt::Write as _;

/// Sans-serif of the reader's system; the PNG writer resolves every name to its built-in font.
pub const FONT: &str = "Helvetica,Arial,DejaVu Sans,sans-serif";

/// `text` as XML character data; characters that XML 1.0 cannot carry become U+FFFD.
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\t' | '\n' | '\r' => out.push(' '),
            '\u{0}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

/// Where a text is anchored on its point.
#[derive(Clone, Copy)]
pub enum Anchor {
    Start,
    Middle,
    End,
}

/// A line of text at (x, y) on the baseline; `style` is further attributes.
pub fn push(out: &mut String, at: [f64; 2], anchor: Anchor, style: &str, content: &str) {
    let anchor = match anchor {
        Anchor::Start => "",
        Anchor::Middle => " text-anchor=\"middle\"",
        Anchor::End => " text-anchor=\"end\"",
    };
    let (x, y) = (pixels(at[0]), pixels(at[1]));
    let _ = writeln!(out, "<text x=\"{x}\" y=\"{y}\"{anchor}{style}>{}</text>", escape(content));
}

/// `content` cut so that it fits `width` pixels at `size`, with an ellipsis.
pub fn fitted(content: &str, width: f64, size: f64) -> String {
    // DejaVu Sans, wider than what browsers will choose, averages 0.6 em a character.
    let room = ((width / (0.6 * size)) as usize).max(4);
    if content.chars().count() <= room {
        return content.to_owned();
    }
    let mut cut: String = content.chars().take(room - 1).collect();
    cut.push('\u{2026}');
    cut
}

/// A length in pixels with at most two decimals and no trailing zeros.
pub fn pixels(value: f64) -> String {
    trimmed(format!("{value:.2}"))
}

fn trimmed(mut s: String) -> String {
    if s.contains('.') {
        let keep = s.trim_end_matches('0').trim_end_matches('.').len();
        s.truncate(keep);
    }
    if s == "-0" { "0".to_owned() } else { s }
}

/// A value to about four significant digits, plain where that is short, else with an exponent.
pub fn short(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".to_owned()
    } else if !value.is_finite() {
        if value.is_nan() {
            "no value"
        } else if value > 0.0 {
            "\u{221e}"
        } else {
            "-\u{221e}"
        }
        .to_owned()
    } else if (1e-3..1e5).contains(&size) {
        let decimals = if size >= 1000.0 {
            0
        } else if size >= 100.0 {
            1
        } else if size >= 10.0 {
            2
        } else if size >= 1.0 {
            3
        } else {
            4
        };
        trimmed(format!("{value:.decimals$}"))
    } else {
        let text = format!("{value:.3e}");
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        format!("{}e{exponent}", trimmed(mantissa.to_owned()))
    }
}

/// A count with commas between groups of three digits.
pub fn count(n: usize) -> String {
    let digits = n.to_string();
    let mut out = String::new();
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(c);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escaped_text_survives_an_xml_parser() {
        let nasty = "a<b> & \"c\" 'd' \u{1} \u{ffff} é 網 ]]>";
        let xml = format!("<t a=\"{0}\">{0}</t>", escape(nasty));
        let document = roxmltree::Document::parse(&xml).expect("well-formed");
        let expected = "a<b> & \"c\" 'd' \u{fffd} \u{fffd} é 網 ]]>";
        assert_eq!(document.root_element().text(), Some(expected));
        assert_eq!(document.root_element().attribute("a"), Some(expected));
    }

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (1.23456, "1.235"),
            (12.5, "12.5"),
            (123.456, "123.5"),
            (99_999.4, "99999"),
            (1e5, "1e5"),
            (-2.5e-7, "-2.5e-7"),
            (1e300, "1e300"),
            (f64::INFINITY, "\u{221e}"),
            (f64::NAN, "no value"),
        ] {
            assert_eq!(short(value), text);
        }
        assert_eq!(pixels(-0.001), "0");
        assert_eq!(pixels(12.50), "12.5");
        assert_eq!(pixels(100.0), "100");
    }

    #[test]
    fn counts_have_groups() {
        assert_eq!(count(0), "0");
        assert_eq!(count(999), "999");
        assert_eq!(count(1000), "1,000");
        assert_eq!(count(12_345_678), "12,345,678");
    }

    #[test]
    fn long_text_is_cut_to_the_room_it_has() {
        assert_eq!(fitted("short", 200.0, 10.0), "short");
        assert_eq!(fitted("a very long caption", 60.0, 10.0).chars().count(), 10);
    }
}
