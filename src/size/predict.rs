//! How many triangles a size field asks for, before any is laid.
//!
//! An equilateral triangle of side h has the area sqrt(3)/4 h^2, so a field asks for
//! N = integral of 4/sqrt(3) / h^2 over the domain; fronts that meet cost some more.

use crate::point::Point2;
use crate::triangulation::TriangleId;

/// A prediction of the number of triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prediction {
    /// Predicted number of triangles.
    pub triangles: f64,
    /// Whether the count stopped because the limit was passed: then it is a lower bound.
    pub stopped: bool,
}

/// 4 / sqrt(3): equilateral triangles of side 1 per unit of area.
const TRIANGLES_PER_AREA: f64 = 2.309_401_076_758_503;
/// Measured excess of real meshes over the integral.
const EXCESS: f64 = 1.08;
/// Within a piece the spacings at the corners differ by at most this ratio, or it is worth less
/// than `PIECE_MIN` triangles.
const PIECE_RATIO: f64 = 1.4;
const PIECE_MIN: f64 = 0.3;
/// Each background triangle is cut at least this often, so that a dip between its corners shows.
const DEPTH_MIN: u32 = 2;
/// Halvings of a piece: 2^-60 of its area is below any spacing that passes the limit.
const DEPTH_MAX: u32 = 60;

/// A corner of a piece and the spacing there.
#[derive(Clone, Copy)]
struct Corner {
    at: Point2,
    spacing: f64,
}

/// Predicts the number of triangles for `field` over the triangles in `cover` (the background mesh),
/// and stops as soon as the sum passes `limit`. The field is told in which of them a point lies.
///
/// The triangles are halved until the field is nearly constant on each piece, so the time depends
/// on how the field varies, not on the prediction. A prediction is never below the number of
/// triangles in the cover.
pub fn predict(
    cover: impl IntoIterator<Item = (TriangleId, [Point2; 3])>,
    field: impl Fn(TriangleId, Point2) -> f64,
    limit: f64,
) -> Prediction {
    let mut sum = 0.0;
    let mut count = 0.0;
    let mut stack: Vec<([Corner; 3], u32)> = Vec::new();
    for (t, triangle) in cover {
        count += 1.0;
        stack.push((triangle.map(|at| Corner { at, spacing: field(t, at) }), 0));
        while let Some((piece, depth)) = stack.pop() {
            let centre = field(t, centroid(&piece));
            let triangles = triangles_in(&piece, centre);
            if depth < DEPTH_MIN || (depth < DEPTH_MAX && !is_fine(&piece, centre, triangles)) {
                let (left, right) = halves(piece, |p| field(t, p));
                stack.extend([(right, depth + 1), (left, depth + 1)]);
                continue;
            }
            sum += triangles;
            if sum > limit {
                return Prediction { triangles: sum, stopped: true };
            }
        }
    }
    Prediction { triangles: f64::max(sum, count), stopped: false }
}

/// Triangles in a piece, by the mean of 1 / h^2: the centre counts nine times as much as a corner, as
/// in the quadrature rule of degree two.
fn triangles_in(piece: &[Corner; 3], centre: f64) -> f64 {
    let corners = piece.iter().map(|c| c.spacing.powi(-2)).sum::<f64>();
    let mean = (corners + 9.0 * centre.powi(-2)) / 12.0;
    EXCESS * TRIANGLES_PER_AREA * area(piece.map(|c| c.at)) * mean
}

/// Without the centre, a large piece whose corners all happen to lie beside a fine boundary would
/// pass for fine.
fn is_fine(piece: &[Corner; 3], centre: f64, triangles: f64) -> bool {
    let spacings = piece.map(|c| c.spacing);
    let low = spacings.into_iter().fold(centre, f64::min);
    let high = spacings.into_iter().fold(centre, f64::max);
    triangles < PIECE_MIN || high <= PIECE_RATIO * low
}

fn centroid(piece: &[Corner; 3]) -> Point2 {
    let mean = |c: fn(Point2) -> f64| piece.iter().map(|corner| c(corner.at) / 3.0).sum();
    Point2::new(mean(|p| p.x), mean(|p| p.y))
}

/// Cuts a triangle through the middle of its longest side.
fn halves(piece: [Corner; 3], field: impl Fn(Point2) -> f64) -> ([Corner; 3], [Corner; 3]) {
    let side = |i: usize| piece[i].at.distance_sq(piece[(i + 1) % 3].at);
    let longest = if side(0) >= side(1) && side(0) >= side(2) {
        0
    } else if side(1) >= side(2) {
        1
    } else {
        2
    };
    let [a, b, c] = [0, 1, 2].map(|i| piece[(longest + i) % 3]);
    let at = Point2::new(0.5 * a.at.x + 0.5 * b.at.x, 0.5 * a.at.y + 0.5 * b.at.y);
    let middle = Corner { at, spacing: field(at) };
    ([a, middle, c], [middle, b, c])
}

fn area([a, b, c]: [Point2; 3]) -> f64 {
    (0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x))).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> [(TriangleId, [Point2; 3]); 2] {
        let [a, b, c, d] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Point2::from);
        [(TriangleId(0), [a, b, c]), (TriangleId(1), [a, c, d])]
    }

    // spec: H5
    #[test]
    fn a_uniform_field_asks_for_its_area() {
        let prediction = predict(square(), |_, _| 0.01, f64::INFINITY);
        let ideal = EXCESS * TRIANGLES_PER_AREA * 1e4;
        assert!((prediction.triangles - ideal).abs() < 1e-6 * ideal, "{prediction:?}");
        assert!(!prediction.stopped);
    }

    // spec: H5
    #[test]
    fn a_field_too_fine_stops_at_the_limit() {
        let prediction = predict(square(), |_, _| 1e-9, 1e5);
        assert!(prediction.stopped && prediction.triangles > 1e5, "{prediction:?}");
    }

    // spec: H5
    #[test]
    fn a_linear_field_is_integrated_within_a_few_percent() {
        // integral of 1/h^2 over the square, h = 0.01 + 0.1 x: (1/0.01 - 1/0.11) / 0.1.
        let prediction = predict(square(), |_, p| 0.01 + 0.1 * p.x, f64::INFINITY);
        let ideal = EXCESS * TRIANGLES_PER_AREA * (100.0 - 1.0 / 0.11) / 0.1;
        assert!((prediction.triangles / ideal - 1.0).abs() < 0.05, "{prediction:?} for {ideal}");
    }

    #[test]
    fn a_field_coarser_than_the_domain_still_needs_the_background() {
        assert_eq!(predict(square(), |_, _| 100.0, 1e9).triangles, 2.0);
    }
}
