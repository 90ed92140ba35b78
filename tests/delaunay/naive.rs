//! The definition, taken literally: slow, and shares nothing with the engines but the predicates.

use trigrade::point::Point2;
use trigrade::predicates::{Sign, incircle_perturbed, orient2d};
use trigrade::triangulation::{GHOST, Triangulation};

/// Finite triangles, each starting at its smallest index, sorted.
pub type Triangles = Vec<[u32; 3]>;

pub fn canonical(corners: [u32; 3]) -> [u32; 3] {
    let least = (0..3).min_by_key(|&i| corners[i]).unwrap();
    [corners[least], corners[(least + 1) % 3], corners[(least + 2) % 3]]
}

pub fn finite_triangles(triangulation: &Triangulation) -> Triangles {
    let finite = triangulation.triangles().map(|t| triangulation.corners(t));
    let mut list: Triangles =
        finite.filter(|c| !c.contains(&GHOST)).map(|c| canonical(c.map(|v| v.0))).collect();
    list.sort_unstable();
    list
}

/// All counterclockwise triples with no point in their perturbed circle: O(n^4).
pub fn delaunay(points: &[Point2]) -> Triangles {
    let n = points.len() as u32;
    let at = |i: u32| points[i as usize];
    let empty = |[a, b, c]: [u32; 3]| {
        let others = (0..n).filter(|d| ![a, b, c].contains(d));
        others.into_iter().all(|d| incircle_perturbed(at(a), at(b), at(c), at(d)) == Sign::Negative)
    };
    let mut list = Vec::new();
    for a in 0..n {
        for b in a + 1..n {
            for c in b + 1..n {
                let t = match orient2d(at(a), at(b), at(c)) {
                    Sign::Positive => [a, b, c],
                    Sign::Negative => [a, c, b],
                    Sign::Zero => continue,
                };
                if empty(t) {
                    list.push(t);
                }
            }
        }
    }
    list.sort_unstable();
    list
}
