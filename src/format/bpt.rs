//! Bezier patch files (`.bpt`), as the teapot is handed around.
//!
//! The number of patches; then for each its two degrees m and n, and (m + 1)(n + 1) control points,
//! a line each: m + 1 rows of n + 1 points, a row has u constant.

use super::domain_file::{DomainReadError, Problem, TextLines, excerpt, number};
use crate::curve::basis::DEGREE_MAX;
use crate::domain::Place;
use crate::model::{Model, Patch};
use crate::surface::{Surface, Tensor};
use crate::vector::Vector;

/// Reads a Bezier patch file; patches are named and marked by their number from 1.
///
/// # Errors
/// What keeps the file from being understood, with its line.
pub fn read(bytes: &[u8]) -> Result<Model, DomainReadError> {
    let mut reader = Reader { lines: TextLines::new(bytes) };
    let [stated] = reader.counts("the number of patches", 0, i64::from(i32::MAX))?;
    let mut model = Model::default();
    for found in 0..stated {
        let Some(patch) = reader.patch(model.patches.len())? else {
            let (what, stated, found) = ("patches", stated as u64, found as u64);
            return Err(reader.fail(Problem::Truncated { what, stated, found }));
        };
        model.patches.push(patch);
    }
    match reader.lines.next() {
        None => Ok(model),
        Some((_, text)) => {
            let (what, found) = ("the end of the file", format!("'{}'", excerpt(&text)));
            Err(reader.fail(Problem::Expected { what, found }))
        }
    }
}

struct Reader<'a> {
    lines: TextLines<'a>,
}

impl Reader<'_> {
    fn fail(&self, problem: Problem) -> DomainReadError {
        problem.at(Place::Line(self.lines.number()))
    }

    /// The integers of the next line, each within a range.
    fn counts<const N: usize>(
        &mut self,
        what: &'static str,
        low: i64,
        high: i64,
    ) -> Result<[i64; N], DomainReadError> {
        let text = self.lines.next().map(|(_, text)| text.into_owned()).unwrap_or_default();
        let unexpected =
            || self.fail(Problem::Expected { what, found: format!("'{}'", excerpt(&text)) });
        let list: Result<Vec<i64>, _> = text.split_whitespace().map(str::parse).collect();
        let list: [i64; N] =
            list.map_err(|_| unexpected())?.try_into().map_err(|_| unexpected())?;
        match list.iter().find(|value| !(low..=high).contains(*value)) {
            None => Ok(list),
            Some(value) => {
                let found = value.to_string();
                Err(self.fail(Problem::OutOfRange { what, found, low, high }))
            }
        }
    }

    /// The next patch; `None` at the end of the file.
    fn patch(&mut self, index: usize) -> Result<Option<Patch>, DomainReadError> {
        if self.lines.clone().next().is_none() {
            return Ok(None);
        }
        let [m, n] = self.counts("two degrees", 1, DEGREE_MAX as i64)?;
        let mut rows = Vec::new();
        for _ in 0..=m {
            let row: Result<Vec<Vector>, _> = (0..=n).map(|_| self.point()).collect();
            rows.push(row?);
        }
        let tensor = Tensor::bezier(&rows).map_err(|error| self.fail(error.into()))?;
        Ok(Some(Patch::plain(index, Surface::Tensor(tensor))))
    }

    fn point(&mut self) -> Result<Vector, DomainReadError> {
        const WHAT: &str = "a control point x y z";
        let Some((line, text)) = self.lines.next() else {
            let found = "the end of the file".to_owned();
            return Err(self.fail(Problem::Expected { what: WHAT, found }));
        };
        let numbers: Result<Vec<f64>, _> =
            text.split_whitespace().map(|token| number(token, WHAT)).collect();
        let list = numbers.map_err(|problem| problem.at(Place::Line(line)))?;
        <Vector>::try_from(list).map_err(|_| {
            let found = format!("'{}'", excerpt(&text));
            self.fail(Problem::Expected { what: WHAT, found })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::Side;

    const TWO: &str =
        "2\n1 1\n0 0 0\n0 1 0\n1 0 0\n1 1 1\n1 2\n0 0 0\n0 0 1\n0 0 2\n1 0 0\n1 0 1\n1 0 2\n";

    // spec: X60
    #[test]
    fn patches_are_read_row_by_row() {
        let model = read(TWO.as_bytes()).expect("two patches");
        assert_eq!(model.patches.len(), 2);
        let [bilinear, second] = [&model.patches[0], &model.patches[1]];
        assert_eq!((second.name.as_str(), second.marker), ("2", 2));
        assert_eq!(bilinear.surface.at(1.0, 1.0), [1.0; 3]);
        assert_eq!(bilinear.surface.at(0.0, 1.0), [0.0, 1.0, 0.0], "v runs along a row");
        assert_eq!(second.surface.side(Side::West).degree(), 2, "1 x 2: two rows of three");
        let windows = TWO.replace('\n', "\r\n");
        assert_eq!(read(windows.as_bytes()), Ok(model));
        assert_eq!(read(b"0\n").expect("none").patches.len(), 0);
    }

    // spec: X60
    #[test]
    fn what_is_no_patch_file_is_refused_with_its_line() {
        let cases = [
            ("", "number of patches"),
            ("x\n", "number of patches"),
            ("-1\n", "must be between"),
            ("1\n", "announces 1 patches, but ends after 0"),
            ("1099511627776\n1 1\n", "must be between"),
            ("2000000000\n1 1\n0 0 0\n", "end of the file"),
            ("1\n1\n", "line 2: expected two degrees"),
            ("1\n0 3\n", "must be between 1 and 15"),
            ("1\n3 1000000\n", "must be between 1 and 15"),
            ("1\n1 1\n0 0 0\n0 1\n", "line 4: expected a control point"),
            ("1\n1 1\n0 0 0\n0 1 nan\n", "finite"),
            ("1\n1 1\n0 0 0\n0 1,5 0\n", "comma"),
            ("1\n1 1\n0 0 0\n0 1 0\n1 0 0\n1 1 1\n7\n", "line 7: expected the end"),
        ];
        for (text, expected) in cases {
            let error = read(text.as_bytes()).expect_err(text).to_string();
            assert!(error.contains(expected), "{text:?}: {error}");
        }
    }
}
