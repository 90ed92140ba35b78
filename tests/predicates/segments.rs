//! Segments that meet, points on segments and in triangles, and the rounded crossing.

use std::collections::BTreeSet;

use proptest::prelude::*;
use trigrade::point::Point2;
use trigrade::predicates::SegmentEnd::{End, Start};
use trigrade::predicates::SegmentIntersection::{
    CollinearOverlap, Disjoint, EndpointInInterior, Identical, ProperCrossing, SharedEndpoint,
};
use trigrade::predicates::{
    PointInTriangle, SegmentIntersection, Sign, WhichSegment, classify, on_collinear_segment,
    orient2d, point_in_triangle, point_on_segment, rounded_crossing,
};

use crate::oracle;
use crate::samples::{Random, every_class, scaled};

type Node = (i64, i64);

fn point((x, y): Node) -> Point2 {
    Point2::new(x as f64, y as f64)
}

fn classified(nodes: [Node; 4]) -> SegmentIntersection {
    let [a, b, c, d] = nodes.map(point);
    classify(a, b, c, d)
}

// spec: P9
#[test]
fn each_way_to_meet_has_its_name() {
    let cases = [
        ([(0, 0), (2, 2), (0, 2), (2, 0)], ProperCrossing),
        ([(0, 0), (2, 2), (3, 0), (2, 1)], Disjoint),
        (
            [(0, 0), (2, 2), (1, 1), (2, 0)],
            EndpointInInterior { segment: WhichSegment::Second, end: Start },
        ),
        (
            [(0, 0), (2, 2), (2, 0), (1, 1)],
            EndpointInInterior { segment: WhichSegment::Second, end: End },
        ),
        (
            [(1, 1), (2, 0), (0, 0), (2, 2)],
            EndpointInInterior { segment: WhichSegment::First, end: Start },
        ),
        (
            [(2, 0), (1, 1), (0, 0), (2, 2)],
            EndpointInInterior { segment: WhichSegment::First, end: End },
        ),
        ([(0, 0), (2, 2), (2, 2), (3, 0)], SharedEndpoint { first: End, second: Start }),
        ([(0, 0), (2, 2), (3, 0), (0, 0)], SharedEndpoint { first: Start, second: End }),
        ([(0, 0), (1, 0), (1, 0), (3, 0)], SharedEndpoint { first: End, second: Start }),
        ([(0, 0), (1, 0), (2, 0), (3, 0)], Disjoint),
        ([(0, 0), (1, 0), (0, 1), (1, 1)], Disjoint),
        ([(0, 0), (2, 2), (2, 2), (0, 0)], Identical),
        ([(1, 1), (1, 1), (1, 1), (1, 1)], Identical),
        ([(1, 1), (1, 1), (1, 2), (1, 2)], Disjoint),
        (
            [(1, 1), (1, 1), (0, 0), (2, 2)],
            EndpointInInterior { segment: WhichSegment::First, end: Start },
        ),
        ([(0, 0), (2, 2), (2, 2), (2, 2)], SharedEndpoint { first: End, second: Start }),
        ([(1, 0), (1, 0), (0, 0), (2, 2)], Disjoint),
    ];
    for (nodes, expected) in cases {
        assert_eq!(classified(nodes), expected, "{nodes:?}");
    }
}

// spec: P9
#[test]
fn an_overlap_names_the_piece_in_common() {
    let overlap = |from, to| CollinearOverlap { from: point(from), to: point(to) };
    for (nodes, expected) in [
        ([(0, 0), (2, 2), (1, 1), (3, 3)], overlap((1, 1), (2, 2))),
        ([(0, 0), (3, 0), (2, 0), (1, 0)], overlap((1, 0), (2, 0))),
        ([(0, 5), (0, 1), (0, 0), (0, 5)], overlap((0, 1), (0, 5))),
    ] {
        assert_eq!(classified(nodes), expected, "{nodes:?}");
    }
}

/// How many ends, and which other points, two lattice segments have in common: the first segment's
/// points with rational parameter found by brute force over the other's line in integers.
fn expected_on_lattice([a, b, c, d]: [Node; 4]) -> &'static str {
    let area = |p: Node, q: Node, r: Node| (p.0 - r.0) * (q.1 - r.1) - (p.1 - r.1) * (q.0 - r.0);
    let dot = |p: Node, q: Node, r: Node| (p.0 - r.0) * (q.0 - r.0) + (p.1 - r.1) * (q.1 - r.1);
    let on = |p: Node, q: Node, r: Node| area(q, r, p) == 0 && dot(q, r, p) <= 0;
    let touching: BTreeSet<Node> = [(a, c, d), (b, c, d), (c, a, b), (d, a, b)]
        .into_iter()
        .filter_map(|(p, q, r)| on(p, q, r).then_some(p))
        .collect();
    let same = BTreeSet::from([a, b]) == BTreeSet::from([c, d]);
    let opposite = |p: i64, q: i64| p.signum() * q.signum() < 0;
    let crossing = opposite(area(a, b, c), area(a, b, d)) && opposite(area(c, d, a), area(c, d, b));
    let ends_in_common = [a, b].iter().any(|p| [c, d].contains(p));
    match touching.len() {
        _ if same => "identical",
        0 if crossing => "crossing",
        0 => "disjoint",
        1 if ends_in_common => "shared end",
        1 => "end inside",
        _ => "overlap",
    }
}

fn kind(found: SegmentIntersection) -> &'static str {
    match found {
        Disjoint => "disjoint",
        ProperCrossing => "crossing",
        SharedEndpoint { .. } => "shared end",
        EndpointInInterior { .. } => "end inside",
        CollinearOverlap { .. } => "overlap",
        Identical => "identical",
    }
}

// spec: P9
#[test]
fn all_pairs_of_segments_of_a_4x4_lattice_are_classified() {
    for code in 0..65_536 {
        let nodes = [12, 8, 4, 0].map(|shift| ((code >> shift) & 3, (code >> (shift + 2)) & 3));
        assert_eq!(kind(classified(nodes)), expected_on_lattice(nodes), "{nodes:?}");
    }
}

/// The name an answer has after exchanging the segments.
fn exchanged(found: SegmentIntersection) -> SegmentIntersection {
    match found {
        SharedEndpoint { first, second } => SharedEndpoint { first: second, second: first },
        EndpointInInterior { segment: WhichSegment::First, end } => {
            EndpointInInterior { segment: WhichSegment::Second, end }
        }
        EndpointInInterior { segment: WhichSegment::Second, end } => {
            EndpointInInterior { segment: WhichSegment::First, end }
        }
        same => same,
    }
}

// spec: P9 P11
#[test]
fn exchanging_segments_or_ends_changes_names_only() {
    let mut random = Random::new(4);
    for _ in 0..100 {
        for (class, quad) in every_class(&mut random) {
            let [a, b, c, d] = quad;
            let found = classify(a, b, c, d);
            assert_eq!(classify(c, d, a, b), exchanged(found), "{class}: {quad:?}");
            assert_eq!(kind(classify(b, a, c, d)), kind(found), "{class}: {quad:?}");
            let crossing = rounded_crossing(a, b, c, d);
            assert_eq!(crossing.is_some(), found == ProperCrossing, "{class}: {quad:?}");
            assert_eq!(rounded_crossing(d, c, a, b), crossing, "{class}: {quad:?}");
        }
    }
}

// spec: P9
#[test]
fn an_end_one_ulp_off_the_segment_is_seen() {
    let [a, b] = [[0.0, 0.0], [3.0, 3.0]].map(Point2::from);
    let d = Point2::new(2.0, 0.0);
    let on = Point2::new(1.0, 1.0);
    let short = Point2::new(1.0_f64.next_up(), 1.0);
    let beyond = Point2::new(1.0_f64.next_down(), 1.0);
    let touch = EndpointInInterior { segment: WhichSegment::Second, end: Start };
    for (c, expected) in [(on, touch), (short, Disjoint), (beyond, ProperCrossing)] {
        for exponent in [-1020, -300, 0, 300, 1020] {
            let [a, b, c, d] = scaled([a, b, c, d], exponent);
            assert_eq!(classify(a, b, c, d), expected, "2^{exponent}, {c}");
        }
    }
}

// spec: P10
#[test]
fn points_are_on_segments_exactly() {
    let [a, b] = [[1.0, 1.0], [4.0, 2.0]].map(Point2::from);
    for (x, y, expected) in [
        (1.0, 1.0, true),
        (4.0, 2.0, true),
        (2.5, 1.5, true),
        (2.5, 1.5_f64.next_up(), false),
        (7.0, 3.0, false),
        (-2.0, 0.0, false),
        (0.0, 0.0, false),
    ] {
        assert_eq!(point_on_segment(Point2::new(x, y), a, b), expected, "({x}, {y})");
    }
    assert!(point_on_segment(a, a, a));
    assert!(!point_on_segment(b, a, a));
    assert!(on_collinear_segment(Point2::new(2.5, 1.5), b, a));
    assert!(!on_collinear_segment(Point2::new(7.0, 3.0), a, b));
}

// spec: P10
#[test]
fn points_are_in_triangles_exactly() {
    use PointInTriangle::{AtCorner, Inside, OnEdge, Outside};
    let corners = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]].map(Point2::from);
    for (x, y, expected) in [
        (1.0, 1.0, Inside),
        (1.0, 5e-324, Inside),
        (1.0, 0.0, OnEdge(0)),
        (1.0, -5e-324, Outside),
        (2.0, 2.0, OnEdge(1)),
        (2.0, 2.0_f64.next_up(), Outside),
        (0.0, 3.0, OnEdge(2)),
        (-0.0, 0.0, AtCorner(0)),
        (4.0, 0.0, AtCorner(1)),
        (0.0, 4.0, AtCorner(2)),
        (8.0, 0.0, Outside),
        (0.0, -1.0, Outside),
        (8.0, -4.0, Outside),
    ] {
        assert_eq!(point_in_triangle(Point2::new(x, y), corners), expected, "({x}, {y})");
    }
}

// spec: P11
#[test]
fn crossings_are_rounded_to_nearest() {
    let mut random = Random::new(5);
    let mut crossings = 0;
    for _ in 0..150 {
        for (class, [a, b, c, d]) in every_class(&mut random) {
            let Some(p) = rounded_crossing(a, b, c, d) else { continue };
            let exact = oracle::crossing(a, b, c, d);
            let context = format!("{class}: {a} {b} {c} {d} gave {p}");
            assert!(oracle::is_nearest(p.x, &exact[0]), "x, {context}");
            assert!(oracle::is_nearest(p.y, &exact[1]), "y, {context}");
            assert!(
                on_collinear_segment(p, a, b) && on_collinear_segment(p, c, d),
                "box, {context}"
            );
            crossings += 1;
        }
    }
    assert!(crossings > 300, "{crossings} crossings");
}

// spec: P11
#[test]
fn crossings_halfway_between_floats_go_to_the_even_one() {
    let tiny = 5e-324;
    let [a, b] = [Point2::new(-1.0, 0.0), Point2::new(1.0, tiny)];
    let [c, d] = [Point2::new(0.0, -1.0), Point2::new(0.0, 1.0)];
    let halfway_up_from_zero = rounded_crossing(a, b, c, d);
    assert_eq!(halfway_up_from_zero, Some(Point2::new(0.0, 0.0)));
    let [a, b] = [Point2::new(-1.0, tiny), Point2::new(1.0, 2.0 * tiny)];
    assert_eq!(rounded_crossing(a, b, c, d), Some(Point2::new(0.0, 2.0 * tiny)));
    let [a, b] = [Point2::new(-1.0, -tiny), Point2::new(1.0, -2.0 * tiny)];
    assert_eq!(rounded_crossing(a, b, c, d), Some(Point2::new(0.0, -2.0 * tiny)));
}

// spec: !P11
#[test]
fn what_does_not_cross_properly_has_no_rounded_crossing() {
    for nodes in [
        [(0, 0), (2, 2), (1, 1), (2, 0)],
        [(0, 0), (2, 2), (2, 2), (2, 0)],
        [(0, 0), (2, 2), (1, 1), (3, 3)],
        [(0, 0), (2, 2), (0, 0), (2, 2)],
        [(0, 0), (1, 1), (3, 0), (2, 9)],
        [(1, 1), (1, 1), (0, 0), (2, 2)],
    ] {
        let [a, b, c, d] = nodes.map(point);
        assert_eq!(rounded_crossing(a, b, c, d), None, "{nodes:?}");
    }
}

proptest! {
    // spec: P10
    #[test]
    fn a_point_is_on_an_edge_of_a_triangle_as_on_the_segment(
        nodes in [(0..6_i64, 0..6_i64), (0..6, 0..6), (0..6, 0..6), (0..6, 0..6)],
    ) {
        let [a, b, c, p] = nodes.map(point);
        prop_assume!(orient2d(a, b, c) == Sign::Positive);
        let corners = [a, b, c];
        let on = |i: usize| point_on_segment(p, corners[i], corners[(i + 1) % 3]);
        match point_in_triangle(p, corners) {
            PointInTriangle::AtCorner(i) => prop_assert_eq!(p, corners[i]),
            PointInTriangle::OnEdge(i) => prop_assert!(on(i) && !corners.contains(&p)),
            PointInTriangle::Inside | PointInTriangle::Outside => {
                prop_assert!(!on(0) && !on(1) && !on(2));
            }
        }
    }
}
