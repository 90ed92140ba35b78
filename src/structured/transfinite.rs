//! Transfinite interpolation of four sides (W. J. Gordon, C. A. Hall, Int. J. Numer. Meth. Eng. 7,
//! 1973), with the blending parameters of B. K. Soni (AIAA 85-1526): where the two lines meet that
//! join equal fractions of arc length of opposite sides.

use super::{Grid, Sides};
use crate::point::Point2;

/// The fractions of arc length at the points of a side: 0 at the first, 1 at the last.
///
/// `length` is the distance of two neighbours. A side without length is divided evenly.
#[must_use]
pub fn fractions<T: Copy>(side: &[T], length: impl Fn(T, T) -> f64) -> Vec<f64> {
    let mut sums = vec![0.0];
    for pair in side.windows(2) {
        sums.push(sums[sums.len() - 1] + length(pair[0], pair[1]));
    }
    let count = sums.len() - 1;
    let total = sums[count];
    let is_usable = total > 0.0 && total.is_finite();
    let at = |(k, &sum): (usize, &f64)| match is_usable {
        true => sum / total,
        false => k as f64 / count.max(1) as f64,
    };
    sums.iter().enumerate().map(at).collect()
}

/// The grid between four sides; `along` are their fractions of arc length. The points of the sides
/// are kept to the bit.
///
/// # Panics
/// When opposite sides have different numbers of points, or a side has fewer than two.
#[must_use]
pub fn transfinite(sides: &Sides<Point2>, along: &Sides<f64>) -> Grid {
    let (columns, rows) = (sides.south.len() - 1, sides.west.len() - 1);
    assert_eq!(sides.counts(), [columns, rows, columns, rows], "opposite sides must match");
    assert!(columns > 0 && rows > 0, "a side has at least one edge");
    let mut points = Vec::with_capacity((columns + 1) * (rows + 1));
    for j in 0..=rows {
        for i in 0..=columns {
            let [xi, eta] = blend([along.south[i], along.north[i]], [along.west[j], along.east[j]]);
            points.push(interpolate(sides, [i, j], [xi, eta]));
        }
    }
    let grid = Grid { columns, rows, points };
    let points = grid.with_sides(sides, &grid.points);
    Grid { points, ..grid }
}

/// Where the line from `south` to `north` meets the one from `west` to `east` in the unit square.
fn blend([south, north]: [f64; 2], [west, east]: [f64; 2]) -> [f64; 2] {
    let (dx, dy) = (north - south, east - west);
    let xi = (south + west * dx) / (1.0 - dx * dy);
    [xi, west + xi * dy]
}

/// Both linear interpolations, less the bilinear one of the corners.
fn interpolate(sides: &Sides<Point2>, [i, j]: [usize; 2], [xi, eta]: [f64; 2]) -> Point2 {
    let of = |part: fn(Point2) -> f64| {
        let Sides { south, east, north, west } = sides;
        let (columns, rows) = (south.len() - 1, west.len() - 1);
        let mix = |t: f64, a: f64, b: f64| (1.0 - t) * a + t * b;
        let across = mix(eta, part(south[i]), part(north[i]));
        let along = mix(xi, part(west[j]), part(east[j]));
        let corners = mix(
            eta,
            mix(xi, part(south[0]), part(south[columns])),
            mix(xi, part(north[0]), part(north[columns])),
        );
        debug_assert_eq!(part(west[rows]), part(north[0]));
        across + along - corners
    };
    Point2::new(of(|p| p.x), of(|p| p.y))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(count: usize, of: impl Fn(f64) -> [f64; 2]) -> Vec<Point2> {
        (0..=count).map(|k| of(k as f64 / count as f64).into()).collect()
    }

    fn along(sides: &Sides<Point2>) -> Sides<f64> {
        let of = |side: &[Point2]| fractions(side, Point2::distance);
        Sides {
            south: of(&sides.south),
            east: of(&sides.east),
            north: of(&sides.north),
            west: of(&sides.west),
        }
    }

    // spec: W1
    #[test]
    fn a_rectangle_becomes_a_lattice_also_with_graded_sides() {
        let sides = Sides {
            south: line(4, |t| [t * t, 0.0]),
            east: line(3, |t| [1.0, 2.0 * t]),
            north: line(4, |t| [t * t, 2.0]),
            west: line(3, |t| [0.0, 2.0 * t]),
        };
        let grid = transfinite(&sides, &along(&sides));
        for j in 0..=3_usize {
            for i in 0..=4_usize {
                let (x, y) = ((i as f64 / 4.0).powi(2), 2.0 * (j as f64 / 3.0));
                assert!(grid.at(i, j).distance(Point2::new(x, y)) < 1e-14, "{i} {j}");
            }
        }
    }

    // spec: W1
    #[test]
    fn a_bilinear_map_is_reproduced_where_opposite_sides_are_cut_alike() {
        let map = |s: f64, t: f64| [3.0 * s + 0.5 * t - 0.3 * s * t, 2.0 * t + 0.2 * s + s * t];
        let sides = Sides {
            south: line(5, |s| map(s, 0.0)),
            east: line(5, |t| map(1.0, t)),
            north: line(5, |s| map(s, 1.0)),
            west: line(5, |t| map(0.0, t)),
        };
        let grid = transfinite(&sides, &along(&sides));
        for k in 0..36_usize {
            let (i, j) = (k % 6, k / 6);
            let expected = map(i as f64 / 5.0, j as f64 / 5.0).into();
            assert!(grid.at(i, j).distance(expected) < 1e-14, "{i} {j}");
        }
    }

    // spec: W1
    #[test]
    fn the_sides_are_kept_to_the_bit() {
        let bend = |t: f64| 0.1 * libm::sin(7.0 * t);
        let sides = Sides {
            south: line(7, |s| [s, bend(s) - bend(1.0) * s]),
            east: line(5, |t| [1.0 + t * (1.0 - t), t]),
            north: line(7, |s| [s, 1.0 + s * (1.0 - s)]),
            west: line(5, |t| [0.3 * t * (1.0 - t), t]),
        };
        let grid = transfinite(&sides, &along(&sides));
        for i in 0..=7 {
            assert_eq!(grid.at(i, 0), sides.south[i]);
            assert_eq!(grid.at(i, 5), sides.north[i]);
        }
        for j in 0..=5 {
            assert_eq!(grid.at(0, j), sides.west[j]);
            assert_eq!(grid.at(7, j), sides.east[j]);
        }
    }

    // spec: W1
    #[test]
    fn fractions_rise_from_zero_to_one_and_a_point_is_divided_evenly() {
        let length = |a: f64, b: f64| (b - a).abs();
        assert_eq!(fractions(&[0.0, 1.0, 4.0], length), [0.0, 0.25, 1.0]);
        assert_eq!(fractions(&[2.0, 2.0, 2.0], length), [0.0, 0.5, 1.0]);
        assert_eq!(fractions(&[2.0], length), [0.0]);
    }

    // spec: W1
    #[test]
    #[should_panic(expected = "opposite sides must match")]
    fn sides_that_do_not_match_are_no_grid() {
        let side = |n| line(n, |t| [t, 0.0]);
        let sides = Sides { south: side(2), east: side(2), north: side(3), west: side(2) };
        let _ = transfinite(&sides, &along(&sides));
    }
}
