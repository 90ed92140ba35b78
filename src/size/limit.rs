//! Growth limiting of any field: the largest field of bounded slope below it and below the
//! spacing at the boundary.
//!
//! The field is sampled on pieces of the background triangles about as wide as its values there;
//! where they are steeper than the slope, the low side becomes a source of its own
//! (Persson 2006 solves the same limit on a grid).

use super::growth::{GrowthField, Source};
use crate::point::Point2;
use crate::triangulation::TriangleId;

/// Pieces are cut until their longest side is at most this many spacings.
const PIECE_WIDTH: f64 = 1.5;
/// A piece is steep when its spacings differ by more than this share of what growth allows.
const STEEP: f64 = 0.5;
/// Halvings of a background triangle.
const DEPTH_MAX: u32 = 44;
/// A field that asks for more samples is finer than any mesh that passes its limit; it is then
/// sampled as far as this goes.
const SAMPLES_MAX: usize = 4_000_000;

/// What limits `field` over the triangles of `cover`: the smaller of the two is the field limited to
/// the slope `growth`. `boundary` are the spacings at the boundary.
///
/// Time is proportional to the number of triangles that a mesh of the field would have.
pub fn growth_limit(
    cover: impl IntoIterator<Item = (TriangleId, [Point2; 3])>,
    field: impl Fn(TriangleId, Point2) -> f64,
    boundary: &[Source],
    growth: f64,
) -> GrowthField {
    let ceiling = GrowthField::new(boundary, growth);
    let mut sources = boundary.to_vec();
    let mut stack = Vec::new();
    for (t, triangle) in cover {
        let sample = |at: Point2| Source { at, spacing: field(t, at) };
        stack.push((triangle.map(sample), 0));
        while let Some((piece, depth)) = stack.pop() {
            let centre = sample(centroid(&piece));
            let (longest, length) = longest_side(&piece);
            // Where the field itself is flat it is its own limit; what spreads is the low side of
            // what is steep.
            let low = piece.iter().fold(centre, |l, s| if s.spacing < l.spacing { *s } else { l });
            let high = piece.iter().fold(centre.spacing, |h, s| h.max(s.spacing));
            if high - low.spacing > STEEP * growth * length && low.spacing < ceiling.at(low.at) {
                sources.push(low);
            }
            // The answer is nowhere above the ceiling: samples as wide as that at least.
            let least = low.spacing.min(ceiling.at(low.at));
            if length > PIECE_WIDTH * least && depth < DEPTH_MAX && sources.len() < SAMPLES_MAX {
                let [a, b, c] = [0, 1, 2].map(|i| piece[(longest + i) % 3]);
                let middle =
                    sample(Point2::new(0.5 * a.at.x + 0.5 * b.at.x, 0.5 * a.at.y + 0.5 * b.at.y));
                stack.extend([([middle, b, c], depth + 1), ([a, middle, c], depth + 1)]);
            }
        }
    }
    sources.sort_by(|s, t| s.at.lexicographic(t.at).then(s.spacing.total_cmp(&t.spacing)));
    sources.dedup_by(|t, s| s.at == t.at);
    GrowthField::new(&sources, growth)
}

fn centroid(piece: &[Source; 3]) -> Point2 {
    let mean = |c: fn(Point2) -> f64| piece.iter().map(|s| c(s.at) / 3.0).sum();
    Point2::new(mean(|p| p.x), mean(|p| p.y))
}

fn longest_side(piece: &[Source; 3]) -> (usize, f64) {
    let side = |i: usize| piece[i].at.distance(piece[(i + 1) % 3].at);
    [1, 2].into_iter().fold((0, side(0)), |best, i| {
        let length = side(i);
        if length > best.1 { (i, length) } else { best }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> [(TriangleId, [Point2; 3]); 2] {
        let [a, b, c, d] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Point2::from);
        [(TriangleId(0), [a, b, c]), (TriangleId(1), [a, c, d])]
    }

    // spec: H10
    #[test]
    fn a_dip_spreads_with_the_slope_and_the_boundary_bounds_all() {
        let centre = Point2::new(0.5, 0.5);
        let dip = |_: TriangleId, p: Point2| if p.distance(centre) < 0.1 { 0.02 } else { 5.0 };
        let boundary = [Source { at: Point2::new(0.0, 0.0), spacing: 0.3 }];
        let limit = growth_limit(square(), dip, &boundary, 0.25);
        // Inside the dip the field itself is the smaller one.
        let limited = |p: Point2| limit.at(p).min(dip(TriangleId(0), p));
        assert_eq!(limited(centre), 0.02);
        for d in [0.15, 0.2, 0.3] {
            let (h, wanted) = (limited(Point2::new(0.5 + d, 0.5)), 0.02 + 0.25 * (d - 0.1));
            assert!(h >= wanted - 1e-12 && h <= wanted + 0.02, "{d}: {h} for {wanted}");
        }
        let corner = limited(Point2::new(0.0, 0.0));
        assert!((0.17..0.2).contains(&corner), "{corner}");
    }
}
