//! The same boundary for formats in which edges meet at common vertices only: points with equal
//! coordinates become one, and edges are cut at the vertices that lie on them.

use crate::domain::validate::validate;
use crate::domain::{Domain, Places, Segment};
use crate::point::Point2;
use crate::predicates::point_on_segment;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// The boundary with all its meetings at common vertices. One that is not valid is left as it is:
/// its fault is the point of it.
///
/// # Complexity
/// O(n m) for n points and m edges.
pub fn conforming(domain: &Domain) -> Cow<'_, Domain> {
    if validate(domain).is_err() {
        return Cow::Borrowed(domain);
    }
    let mut new = merged(domain);
    let points = new.points.clone();
    for of in &mut new.loops {
        let edges: Vec<[u32; 2]> = of.edges().collect();
        let markers = std::mem::take(&mut of.markers);
        of.vertices.clear();
        for (edge, marker) in edges.into_iter().zip(markers) {
            let chain = chain(&points, edge);
            // The end of an edge is the start of the next.
            of.vertices.extend(&chain[..chain.len() - 1]);
            of.markers.resize(of.vertices.len(), marker);
        }
    }
    let cut = |s: &Segment| {
        let marker = s.marker;
        let chain = chain(&points, s.vertices);
        (1..chain.len())
            .map(move |i| Segment { vertices: [chain[i - 1], chain[i]], marker })
            .collect()
    };
    new.segments = new.segments.iter().flat_map::<Vec<Segment>, _>(cut).collect();
    Cow::Owned(new)
}

/// With one point for all that have its coordinates.
fn merged(domain: &Domain) -> Domain {
    let mut number = BTreeMap::new();
    let (mut points, mut markers) = (Vec::new(), Vec::new());
    for (i, p) in domain.points.iter().enumerate() {
        number.entry(p.key()).or_insert_with(|| {
            points.push(*p);
            markers.extend(domain.point_markers.get(i));
            points.len() as u32 - 1
        });
    }
    let mut new = domain.clone();
    let renumber = |v: &mut u32| *v = number[&domain.points[*v as usize].key()];
    new.loops.iter_mut().flat_map(|l| l.vertices.iter_mut()).for_each(renumber);
    new.segments.iter_mut().flat_map(|s| s.vertices.iter_mut()).for_each(renumber);
    (new.points, new.point_markers, new.places) = (points, markers, Places::default());
    new
}

/// An edge as a chain over all points that lie on it, both ends included.
fn chain(points: &[Point2], [a, b]: [u32; 2]) -> Vec<u32> {
    let [p, q] = [a, b].map(|v| points[v as usize]);
    let is_between = |&v: &u32| v != a && v != b && point_on_segment(points[v as usize], p, q);
    let mut inner: Vec<u32> = (0..points.len() as u32).filter(is_between).collect();
    // Along the edge each coordinate rises, falls or stays: comparing them is exact.
    inner.sort_by(|&v, &w| {
        let along = points[v as usize].lexicographic(points[w as usize]);
        if p.lexicographic(q).is_lt() { along } else { along.reverse() }
    });
    std::iter::once(a).chain(inner).chain([b]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::{Loop, LoopRole};
    use crate::torture::generate::{Claim, case};

    /// A square, and a hole that touches its left side at (0, 1) and its corner at (2, 2), whose
    /// vertices are points of their own.
    fn touching() -> Domain {
        let square = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
        let hole = [(-0.0, 1.0), (1.0, 1.0), (2.0, 2.0)];
        let points = square.iter().chain(&hole).map(|&(x, y)| Point2::new(x, y)).collect();
        let mut domain = Domain::new(points);
        domain.loops.push(Loop::new(vec![0, 1, 2, 3], 1, LoopRole::Any));
        domain.loops.push(Loop::new(vec![4, 5, 6], 2, LoopRole::Any));
        domain
    }

    // spec: R5
    #[test]
    fn touching_loops_share_their_points() {
        let domain = touching();
        let new = conforming(&domain);
        assert_eq!(new.points.len(), 6);
        assert_eq!(new.loops[0].vertices, [0, 1, 2, 3, 4], "cut at the vertex on its left side");
        assert_eq!(new.loops[0].markers, [1; 5]);
        assert_eq!(new.loops[1].vertices, [4, 5, 2]);
        assert!(validate(&new).is_ok());
    }

    // spec: R5
    #[test]
    fn segments_are_cut_in_the_order_along_them() {
        let mut domain = touching();
        domain.points.extend([(0.5, 0.25), (0.25, 0.125)].map(|(x, y)| Point2::new(x, y)));
        domain.points.push(Point2::new(1.0, 0.5));
        domain.segments.push(Segment { vertices: [9, 0], marker: 7 });
        let new = conforming(&domain);
        let parts: Vec<[u32; 2]> = new.segments.iter().map(|s| s.vertices).collect();
        assert_eq!(parts, [[8, 6], [6, 7], [7, 0]]);
        assert!(new.segments.iter().all(|s| s.marker == 7));
    }

    // spec: R5
    #[test]
    fn nothing_is_left_to_cut_and_faults_are_kept() {
        for index in 0..200 {
            let case = case(4, index);
            let new = conforming(&case.domain).into_owned();
            if case.claim != Claim::Valid {
                assert_eq!(new, case.domain, "{}", case.family);
                continue;
            }
            assert!(validate(&new).is_ok(), "{} {index}", case.family);
            assert_eq!(conforming(&new).into_owned(), new, "{} {index}", case.family);
        }
    }
}
