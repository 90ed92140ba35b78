//! The perturbation against its definition, and the uniqueness it is for.

use proptest::prelude::*;
use trigrade::point::Point2;
use trigrade::predicates::{Sign, incircle_perturbed, orient2d};

use crate::oracle;
use crate::samples::{Random, every_class};

// spec: P6
#[test]
fn the_perturbation_is_what_its_definition_says() {
    let mut random = Random::new(3);
    let mut ties = 0;
    for _ in 0..25 {
        for (class, quad) in every_class(&mut random) {
            let [a, b, c, d] = quad;
            ties += usize::from(oracle::incircle(a, b, c, d) == Sign::Zero);
            let expected = oracle::incircle_perturbed(quad);
            assert_eq!(incircle_perturbed(a, b, c, d), expected, "{class}: {quad:?}");
        }
    }
    assert!(ties > 25, "{ties} ties");
}

// spec: P6
#[test]
fn equal_points_are_one_point_and_collinear_ones_stay_tied() {
    let points = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [0.0, 1.0]].map(Point2::from);
    let [a, b, c, d, e] = points;
    assert_eq!(incircle_perturbed(a, b, c, d), Sign::Zero, "four points of a line");
    for [p, q, r, s] in
        [[a, a, b, e], [a, b, a, e], [e, b, c, e], [a, b, e, Point2::new(-0.0, 1.0)]]
    {
        assert_eq!(incircle_perturbed(p, q, r, s), Sign::Zero, "{p} {q} {r} {s}");
    }
    // Three of a line and a fourth are on no circle, but not on a line either.
    assert_ne!(incircle_perturbed(a, b, c, e), Sign::Zero);
}

/// The triangles, by index and counterclockwise, that no point lies inside the circle of.
fn delaunay(points: &[Point2]) -> Vec<[usize; 3]> {
    let n = points.len();
    let is_empty = |[i, j, k]: [usize; 3]| {
        (0..n).filter(|l| ![i, j, k].contains(l)).all(|l| {
            incircle_perturbed(points[i], points[j], points[k], points[l]) == Sign::Negative
        })
    };
    let mut found = Vec::new();
    for (i, j, k) in (0..n).flat_map(|i| (i..n).flat_map(move |j| (j..n).map(move |k| (i, j, k)))) {
        let triangle = match orient2d(points[i], points[j], points[k]) {
            Sign::Positive => [i, j, k],
            Sign::Negative => [i, k, j],
            Sign::Zero => continue,
        };
        found.extend(is_empty(triangle).then_some(triangle));
    }
    found
}

fn twice_area(points: &[Point2], [i, j, k]: [usize; 3]) -> f64 {
    let [a, b, c] = [points[i], points[j], points[k]];
    (a.x - c.x) * (b.y - c.y) - (a.y - c.y) * (b.x - c.x)
}

// spec: P8
#[test]
fn a_grid_is_triangulated_by_its_empty_circles_alone() {
    let points: Vec<_> = (0..25).map(|i| Point2::new(f64::from(i / 5), f64::from(i % 5))).collect();
    let triangles = delaunay(&points);
    assert_eq!(triangles.len(), 32, "two for each cell");
    let total: f64 = triangles.iter().map(|&t| twice_area(&points, t)).sum();
    assert_eq!(total, 32.0, "the square's area, so none overlap");
    for [i, j, k] in triangles {
        let cut = [(i, j), (j, k), (k, i)]
            .into_iter()
            .find(|&(p, q)| points[p].x != points[q].x && points[p].y != points[q].y);
        let (p, q) = cut.expect("half a cell has a slope");
        let [p, q] = [points[p], points[q]];
        assert!((p.x - q.x) * (p.y - q.y) < 0.0, "the largest corner is cut off: {p} {q}");
    }
}

proptest! {
    // spec: P8
    #[test]
    fn lattice_points_have_exactly_one_delaunay_triangulation(
        cells in proptest::collection::btree_set((0..5_u8, 0..5_u8), 3..12),
    ) {
        let points: Vec<_> =
            cells.iter().map(|&(x, y)| Point2::new(f64::from(x), f64::from(y))).collect();
        let triangles = delaunay(&points);
        let total: f64 = triangles.iter().map(|&t| twice_area(&points, t)).sum();
        prop_assert_eq!(total, twice_hull_area(&points));
        // A point of the hull's boundary or inside it is a corner: nothing is left out.
        let all_collinear = triangles.is_empty();
        prop_assert!(all_collinear || (0..points.len()).all(|i| triangles.iter().any(|t| t.contains(&i))));
    }
}

/// Twice the area of the convex hull, by Andrew's monotone chain.
fn twice_hull_area(sorted: &[Point2]) -> f64 {
    let chain = |points: &mut dyn Iterator<Item = Point2>| {
        let mut hull: Vec<Point2> = Vec::new();
        for p in points {
            while let [.., a, b] = hull[..] {
                if orient2d(a, b, p) == Sign::Positive {
                    break;
                }
                hull.pop();
            }
            hull.push(p);
        }
        hull
    };
    let mut hull = chain(&mut sorted.iter().copied());
    hull.extend(chain(&mut sorted.iter().rev().copied()));
    hull.windows(2).map(|e| e[0].x * e[1].y - e[0].y * e[1].x).sum()
}
