//! SVG path data in as few bytes as its grammar allows.
//!
//! Coordinates are integers (the group's transform scales them) and relative, so that a small
//! triangle costs about twenty bytes. Differences are taken between rounded positions: rounding
//! does not accumulate along a path.

/// Path data under construction.
#[derive(Clone, Debug, Default)]
pub struct PathData {
    data: String,
    /// Where the pen is: the reference of the next relative pair.
    pen: [i64; 2],
    started: bool,
}

impl PathData {
    /// Adds a closed polygon; fewer than three places add nothing.
    pub fn polygon(&mut self, places: &[[i64; 2]]) {
        let [first, _, _, ..] = places else { return };
        self.polyline(places);
        self.data.push('z');
        self.pen = *first;
    }

    /// Adds an open polyline; fewer than two places add nothing.
    pub fn polyline(&mut self, places: &[[i64; 2]]) {
        let [first, rest @ ..] = places else { return };
        if rest.is_empty() {
            return;
        }
        // A leading "m" is absolute; pairs after a move-to are implicit line-tos.
        self.data.push(if self.started { 'm' } else { 'M' });
        self.pair(*first);
        if !self.started {
            self.started = true;
            self.data.push('l');
        }
        for &place in rest {
            self.pair(place);
        }
    }

    fn pair(&mut self, place: [i64; 2]) {
        for (to, from) in place.into_iter().zip(self.pen) {
            self.number(to.saturating_sub(from));
        }
        self.pen = place;
    }

    fn number(&mut self, value: i64) {
        let after_digit = self.data.as_bytes().last().is_some_and(u8::is_ascii_digit);
        if after_digit && value >= 0 {
            self.data.push(' ');
        }
        push_integer(&mut self.data, value);
    }

    /// The finished data, `None` if nothing was added.
    pub fn finish(self) -> Option<String> {
        self.started.then_some(self.data)
    }
}

/// Formats without the machinery of `format!`: a picture has millions of these.
fn push_integer(out: &mut String, value: i64) {
    let mut digits = [0_u8; 20];
    let mut at = digits.len();
    let mut rest = value.unsigned_abs();
    loop {
        at -= 1;
        digits[at] = b'0' + (rest % 10) as u8;
        rest /= 10;
        if rest == 0 {
            break;
        }
    }
    if value < 0 {
        out.push('-');
    }
    out.extend(digits[at..].iter().map(|&d| char::from(d)));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_are_printed_as_the_standard_library_does() {
        for value in [0, 1, -1, 9, 10, -10, 12_345, i64::MAX, i64::MIN] {
            let mut out = String::new();
            push_integer(&mut out, value);
            assert_eq!(out, value.to_string());
        }
    }

    #[test]
    fn polygons_are_relative_and_closed() {
        let mut path = PathData::default();
        path.polygon(&[[10, 20], [15, 20], [10, 12]]);
        path.polygon(&[[10, 20], [5, 20], [10, 12]]);
        assert_eq!(path.finish().as_deref(), Some("M10 20l5 0-5-8zm0 0-5 0 5-8z"));
    }

    #[test]
    fn polylines_go_on_from_their_last_place() {
        let mut path = PathData::default();
        path.polyline(&[[0, 0], [3, -4], [3, -4]]);
        path.polyline(&[[4, -4], [5, -5]]);
        assert_eq!(path.finish().as_deref(), Some("M0 0l3-4 0 0m1 0 1-1"));
    }

    #[test]
    fn too_few_places_draw_nothing() {
        let mut path = PathData::default();
        path.polygon(&[[1, 1], [2, 2]]);
        path.polyline(&[[1, 1]]);
        path.polyline(&[]);
        assert_eq!(path.finish(), None);
    }
}
