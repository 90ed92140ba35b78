//! Points as lines of numbers separated by blanks: x, y, and whatever follows. `#` starts a comment.

use super::{PointSet, THIRD, not_finite};
use crate::format::error::{At, ReadError};
use crate::format::scan::Scanner;
use crate::point::Point2;

/// Reads the points of a file, one a line.
///
/// # Errors
/// The first line that does not begin with two finite numbers.
pub(super) fn read(bytes: &[u8]) -> Result<PointSet, ReadError> {
    let mut scanner = Scanner::new(bytes).with_comments(b'#');
    let mut set = PointSet::default();
    let mut columns = 2;
    while !scanner.is_at_end() {
        let line = scanner.line().unwrap_or(0);
        let x = scanner.float("the x coordinate of a point")?;
        if scanner.is_at_line_end() {
            return Err(scanner.malformed("two coordinates in a line", b"one"));
        }
        let y = scanner.float("the y coordinate of a point")?;
        if !(x.is_finite() && y.is_finite()) {
            return Err(not_finite([x, y], At::Line(line)));
        }
        let more = std::iter::from_fn(|| scanner.token_on_line()).count();
        columns = columns.max(2 + more);
        set.lines.push(set.points.len() as u32, line);
        set.points.push(Point2::new(x, y));
    }
    set.left_out.extend((columns > 2).then(|| THIRD.to_owned()));
    set.left_out.extend((columns > 3).then(|| "columns beyond the third".to_owned()));
    Ok(set)
}
