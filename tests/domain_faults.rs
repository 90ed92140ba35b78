//! Every fault of a domain by a minimal case that has exactly that fault, beside its nearest
//! neighbours that have none.

use trigrade::domain::validate::{Fault, Plc, validate};
use trigrade::domain::{Domain, Inside, Loop, LoopRole, Place, Region, Segment};
use trigrade::format::domain_json;
use trigrade::point::Point2;

const SQUARE: &str = "[[0,0],[4,0],[4,4],[0,4]]";

fn read(json: &str) -> Domain {
    domain_json::read(json.as_bytes()).unwrap_or_else(|e| panic!("{json}: {e}"))
}

fn faults(json: &str) -> Vec<Fault> {
    validate(&read(json)).err().unwrap_or_default()
}

fn sound(json: &str) -> Plc {
    validate(&read(json)).unwrap_or_else(|f| panic!("{json}: {}", messages(&f)))
}

fn messages(faults: &[Fault]) -> String {
    faults.iter().map(|f| format!("{} {f}", f.id())).collect::<Vec<_>>().join("\n")
}

/// The only fault of a domain; it says where.
fn only(json: &str) -> Fault {
    let mut found = faults(json);
    assert_eq!(found.len(), 1, "{json}: {}", messages(&found));
    let fault = found.remove(0);
    assert!(fault.places().iter().all(|p| matches!(p, Place::Path(_))), "{fault}");
    fault
}

fn ring(points: &str) -> String {
    format!("{{\"outer\": {points}}}")
}

fn with_hole(hole: &str) -> String {
    format!("{{\"outer\": {SQUARE}, \"holes\": [{hole}]}}")
}

fn segments(list: &str) -> String {
    format!("{{\"outer\": [[-9,-9],[9,-9],[9,9],[-9,9]], \"segments\": {list}}}")
}

fn square() -> Domain {
    read(&ring(SQUARE))
}

// spec: D1
#[test]
fn an_index_must_name_a_point() {
    let json = r#"{"points": [[0,0],[1,0],[0,1]], "loops": [{"vertices": [0,1,3]}]}"#;
    let fault = only(json);
    assert!(matches!(fault, Fault::NoSuchPoint { value: 3, count: 3, .. }), "{fault}");
    assert_eq!(
        fault.to_string(),
        "edge 2 of loop 0 [$.loops[0]] names point 3, but there are 3 points, numbered from 0"
    );
    sound(&json.replace("[0,1,3]", "[0,1,2]"));
    let segment =
        r#"{"points": [[0,0],[1,0],[0,1]], "loops": [{"vertices": [0,1,2]}], "segments": [[0,7]]}"#;
    assert!(matches!(only(segment), Fault::NoSuchPoint { value: 7, .. }));
}

// spec: D1
#[test]
fn markers_must_match_what_they_mark() {
    let mut domain = square();
    domain.loops[0].markers.pop();
    let found = validate(&domain).unwrap_err();
    assert!(matches!(found[..], [Fault::MarkerCount { found: 3, expected: 4, .. }]));
    let mut domain = square();
    domain.point_markers = vec![1; 5];
    let found = validate(&domain).unwrap_err();
    assert!(matches!(found[..], [Fault::MarkerCount { of: None, found: 5, expected: 4 }]));
    domain.point_markers.pop();
    assert_eq!(validate(&domain).unwrap().point_markers, [1; 4]);
}

// spec: D2
#[test]
fn coordinates_must_be_finite() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut domain = square();
        domain.points[2].y = value;
        let found = validate(&domain).unwrap_err();
        assert!(
            matches!(&found[..], [Fault::NotFinite { vertex }] if vertex.index == 2),
            "{}",
            messages(&found)
        );
        let mut domain = square();
        domain.regions = vec![Region { seed: Point2::new(value, 1.0), marker: 1, area_max: None }];
        let found = validate(&domain).unwrap_err();
        assert!(matches!(found[..], [Fault::SeedNotFinite { .. }]), "{}", messages(&found));
    }
}

// spec: D2
#[test]
fn the_largest_and_smallest_numbers_are_finite() {
    let square = |a: &str| ring("[[-A,-A],[A,-A],[A,A],[-A,A]]").replace('A', a);
    for size in ["1.7976931348623157e308", "1e300", "1e-310", "4.9e-324"] {
        sound(&square(size));
        let bow = ring("[[-A,-A],[A,A],[A,-A],[-A,A]]").replace('A', size);
        assert!(matches!(only(&bow), Fault::Crossing { .. }));
        let corners = "[0,0],[A,-A]".replace('A', size);
        let split = square(size).replace('}', &format!(", \"segments\": [[{corners}]]}}"));
        assert_eq!(sound(&split).segments.len(), 5);
    }
    // All exponents at once: a needle from the least number to the greatest.
    let needle = ring("[[0,0],[1e308,4.9e-324],[1e308,1e308],[0,4.9e-324]]");
    assert_eq!(sound(&needle).segments.len(), 4);
    let pierced = needle.replace('}', r#", "segments": [[[1,-1],[1,1]]]}"#);
    assert_eq!(faults(&pierced).len(), 1);
}

// spec: D3
#[test]
fn a_loop_has_three_points() {
    for points in ["[]", "[[0,0]]", "[[0,0],[1,0]]", "[[0,0],[1,0],[0,0]]"] {
        let fault = faults(&format!("{{\"outer\": {SQUARE}, \"holes\": [{points}]}}"));
        assert!(
            matches!(fault[..], [Fault::TooFewPoints { .. }]),
            "{points}: {}",
            messages(&fault)
        );
    }
    let fault = only(&with_hole("[[1,1],[1,1],[2,1]]"));
    assert!(matches!(fault, Fault::TooFewPoints { distinct: 2, .. }), "{fault}");
    sound(&ring("[[0,0],[1,0],[0,1]]"));
}

// spec: D4
#[test]
fn neighbours_differ() {
    let fault = only(&ring("[[0,0],[4,0],[4,0],[4,4]]"));
    assert!(
        matches!(&fault, Fault::EqualNeighbours { edge } if edge.ends[0].index == 1),
        "{fault}"
    );
    assert_eq!(fault.places(), [&Place::Path("$.outer[1]".to_owned())]);
    let fault = only(&segments("[[[1,1],[1,1]]]"));
    assert!(matches!(fault, Fault::EqualNeighbours { .. }), "{fault}");
    let twice = ring("[[0,0],[0,0],[4,0],[4,0],[4,4],[4,4]]");
    assert_eq!(faults(&twice).len(), 3);
}

// spec: D4
#[test]
fn negative_zero_equals_zero() {
    assert!(matches!(only(&ring("[[0,0],[-0.0,0],[4,0],[4,4]]")), Fault::EqualNeighbours { .. }));
    let plc = sound(&format!("{{\"outer\": {SQUARE}, \"holes\": [[[-0.0,0],[2,1],[1,2]]]}}"));
    assert_eq!(plc.points.len(), 6);
    assert_eq!(plc.vertex_of, [0, 1, 2, 3, 0, 4, 5]);
}

// spec: D5
#[test]
fn isolated_points_differ_from_all_others() {
    let with = |points: &str| format!("{{\"outer\": {SQUARE}, \"points\": {points}}}");
    let fault = only(&with("[[4,0]]"));
    assert!(
        matches!(&fault, Fault::DuplicatePoint { vertices } if vertices[1].index == 4),
        "{fault}"
    );
    assert!(matches!(only(&with("[[1,1],[1,1]]")), Fault::DuplicatePoint { .. }));
    assert_eq!(sound(&with("[[1,1],[1,2]]")).points.len(), 6);
}

// spec: D5
#[test]
fn vertices_of_segments_differ() {
    let json = r#"{"points": [[0,0],[9,0],[0,9],[1,1],[2,1],[2,1],[2,2]],
        "loops": [{"vertices": [0,1,2]}], "segments": [[3,4],[5,6]]}"#;
    assert!(matches!(only(json), Fault::DuplicatePoint { .. }));
    sound(&json.replace("[5,6]", "[4,6]").replace("[2,1],[2,1]", "[2,1],[3,1]"));
}

// spec: D6
#[test]
fn a_loop_does_not_turn_back() {
    let fault = only(&ring("[[0,0],[4,0],[6,0],[4,0],[4,4],[0,4]]"));
    assert!(matches!(&fault, Fault::Spike { tip, .. } if tip.index == 2), "{fault}");
    // The way back is shorter, and longer, than the way there.
    let short = ring("[[0,0],[6,0],[4,0],[4,4],[0,4]]");
    assert!(matches!(only(&short), Fault::Spike { .. }));
    let long = ring("[[0,0],[4,0],[4,5],[4,-1],[2,4],[0,4]]");
    assert!(faults(&long).iter().any(|f| matches!(f, Fault::Spike { tip, .. } if tip.index == 2)));
    // Straight on is no spike, nor is a needle one ulp wide.
    sound(&ring("[[0,0],[2,0],[4,0],[4,4],[0,4]]"));
    sound(&ring("[[0,0],[4,0],[6,0],[4,4.9e-324],[4,4],[0,4]]"));
}

// spec: D6
#[test]
fn a_long_spike_is_one_fault() {
    let fault = only(&ring("[[0,0],[4,0],[5,1],[6,1],[7,0],[6,1],[5,1],[4,0],[4,4],[0,4]]"));
    assert!(matches!(&fault, Fault::Spike { tip, .. } if tip.index == 4), "{fault}");
}

// spec: D7
#[test]
fn a_loop_has_area() {
    for line in ["[[0,0],[1,1],[2,2]]", "[[0,0],[3,3],[1,1],[2,2]]", "[[1,0],[1,5],[1,2],[1,3]]"] {
        assert!(matches!(only(&ring(line)), Fault::ZeroArea { .. }));
    }
    sound(&ring("[[0,0],[1,1],[2,2.0000000000000004]]"));
}

// spec: D8
#[test]
fn edges_do_not_cross() {
    let fault = only(&ring("[[0,0],[2,2],[2,0],[0,2]]"));
    let Fault::Crossing { near, edges } = &fault else { panic!("{fault}") };
    assert_eq!(*near, Point2::new(1.0, 1.0));
    assert_eq!(edges[0].ends[1].at, Point2::new(2.0, 2.0));
    assert_eq!(
        fault.to_string(),
        "edge 0 of loop 0 from (0.0, 0.0) to (2.0, 2.0) [$.outer[0]] crosses \
         edge 2 of loop 0 from (2.0, 0.0) to (0.0, 2.0) [$.outer[2]] near (1.0, 1.0)"
    );
    assert!(matches!(only(&segments("[[[0,0],[2,2]],[[0,2],[2,0]]]")), Fault::Crossing { .. }));
    sound(&segments("[[[0,0],[2,2]],[[0,2],[1,1.0000000000000002]]]"));
    // Two crossings of the hole with the outer ring: both are named.
    assert_eq!(faults(&with_hole("[[1,1],[5,1],[5,2],[1,2]]")).len(), 2);
}

// spec: D8
#[test]
fn loops_do_not_cross_at_a_vertex() {
    // A hole that leaves the outer ring through its corner (4, 4), and one through its edge.
    let through_corner = with_hole("[[1,1],[4,4],[6,4],[6,6],[4,6],[4,4],[1,3]]");
    assert!(faults(&through_corner).iter().all(|f| f.id() == "D8" || f.id() == "D10"));
    let fault = only(&ring("[[0,0],[2,2],[4,4],[4,0],[2,2],[0,4]]"));
    assert!(
        matches!(&fault, Fault::CrossingAtVertex { vertex, .. } if vertex.at == Point2::new(2.0, 2.0)),
        "{fault}"
    );
    // The same points in an order in which the ring touches itself.
    sound(&ring("[[0,0],[2,2],[4,0],[4,4],[2,2],[0,4]]"));
}

// spec: D8
#[test]
fn a_loop_does_not_cross_an_edge_at_its_vertex() {
    // The hole's vertices (4, 1) and (4, 3) lie on the outer ring's edge; one path leads outside.
    let out = with_hole("[[1,1],[4,1],[5,2],[4,3],[1,3]]");
    let found = faults(&out);
    assert_eq!(found.len(), 2, "{}", messages(&found));
    assert!(found.iter().all(|f| matches!(f, Fault::CrossingAtVertex { .. })));
    sound(&with_hole("[[1,1],[4,1],[3,2],[4,3],[1,3]]"));
}

// spec: D9
#[test]
fn edges_do_not_overlap() {
    let fault = only(&with_hole("[[4,1],[4,3],[3,2]]"));
    let Fault::Overlap { shared, .. } = fault else { panic!("{fault}") };
    assert_eq!(shared, [Point2::new(4.0, 1.0), Point2::new(4.0, 3.0)]);
    assert!(matches!(only(&segments("[[[0,0],[2,2]],[[1,1],[3,3]]]")), Fault::Overlap { .. }));
    sound(&segments("[[[0,0],[2,2]],[[2,2],[3,3]]]"));
    sound(&with_hole("[[4,1],[3,3],[3,2]]"));
}

// spec: D9
#[test]
fn a_repeated_segment_overlaps() {
    for list in ["[[[0,0],[2,2]],[[0,0],[2,2]]]", "[[[0,0],[2,2]],[[2,2],[0,0]]]"] {
        assert!(matches!(only(&segments(list)), Fault::Overlap { .. }));
    }
    let thrice = faults(&segments("[[[0,0],[2,2]],[[0,0],[2,2]],[[0,0],[2,2]]]"));
    assert_eq!(thrice.len(), 3, "{}", messages(&thrice));
}

// spec: D10
#[test]
fn a_hole_lies_inside_its_outer_loop() {
    let fault = only(&with_hole("[[5,1],[6,1],[6,2]]"));
    let Fault::HoleOutside { hole, outer } = &fault else { panic!("{fault}") };
    assert_eq!((hole.index, outer.index), (1, 0));
    assert_eq!(fault.coordinates(), [Point2::new(5.0, 1.0)]);
    // It touches with all its vertices, once from outside and once from inside.
    assert!(matches!(only(&with_hole("[[4,1],[5,2],[4,3],[4.5,2]]")), Fault::HoleOutside { .. }));
    sound(&with_hole("[[4,2],[2,4],[0,2],[2,0]]"));
    // The hole surrounds the outer ring.
    assert!(matches!(only(&with_hole("[[-1,-1],[9,-1],[9,9],[-1,9]]")), Fault::HoleOutside { .. }));
}

// spec: D10
#[test]
fn a_hole_in_the_bay_of_its_outer_loop_lies_outside() {
    let bay = r#"{"outer": [[0,0],[6,0],[6,6],[3,1],[0,6]], "holes": [HOLE]}"#;
    let hole = |hole| bay.replace("HOLE", hole);
    assert!(matches!(only(&hole("[[3,1],[3.5,3],[2.5,3]]")), Fault::HoleOutside { .. }));
    sound(&hole("[[3,1],[3.5,0.5],[2.5,0.5]]"));
}

// spec: D11
#[test]
fn a_hole_does_not_lie_in_a_hole() {
    let json = r#"{"outer": [[0,0],[9,0],[9,9],[0,9]],
        "holes": [[[1,1],[8,1],[8,8],[1,8]], [[2,2],[3,2],[3,3]]]}"#;
    let fault = only(json);
    let Fault::HoleInsideOther { hole, outer, around } = &fault else { panic!("{fault}") };
    assert_eq!((hole.index, outer.index, around.index), (2, 0, 1));
    sound(&json.replace("[[2,2],[3,2],[3,3]]", "[[0.5,0.5],[0.7,0.5],[0.7,0.7]]"));
}

// spec: D12
#[test]
fn an_outer_loop_lies_in_none_or_in_a_hole() {
    let json = r#"{"polygons": [{"outer": [[0,0],[9,0],[9,9],[0,9]], "holes": [HOLE]},
        {"outer": [[3,3],[5,3],[5,5],[3,5]]}]}"#;
    let inside = json.replace("HOLE", "");
    let fault = only(&inside);
    assert!(matches!(fault, Fault::OuterInsideOuter { .. }), "{fault}");
    let island = json.replace("HOLE", "[[2,2],[6,2],[6,6],[2,6]]");
    assert_eq!(sound(&island).segments.len(), 12);
    sound(&json.replace("HOLE", "").replace("[[3,3],[5,3],[5,5],[3,5]]", "[[9,9],[10,9],[10,10]]"));
}

// spec: D13
#[test]
fn only_outer_loops_have_holes() {
    let json = |role: &str| {
        format!(
            r#"{{"points": [[0,0],[9,0],[0,9],[1,1],[2,1],[1,2]],
            "loops": [{{"vertices": [0,1,2], "role": "outer"}}, {{"vertices": [3,4,5], "role": {role}}}]}}"#
        )
    };
    for claimed in [1, 2, 4_000_000_000_u64] {
        let fault = only(&json(&format!("{{\"hole_of\": {claimed}}}")));
        assert!(matches!(fault, Fault::NotAnOuterLoop { .. }), "{fault}");
    }
    sound(&json("{\"hole_of\": 0}"));
    sound(&json("\"any\""));
}

// spec: D14
#[test]
fn seeds_lie_where_they_name_something() {
    let region = |x: f64, y: f64| {
        let mut domain = read(&with_hole("[[1,1],[2,1],[1,2]]"));
        domain.regions = vec![Region { seed: Point2::new(x, y), marker: 3, area_max: None }];
        validate(&domain).err().unwrap_or_default()
    };
    assert!(region(3.0, 3.0).is_empty());
    for (x, y) in [(5.0, 1.0), (-1.0, 0.0), (1.25, 1.25), (9.0, 9.0)] {
        assert!(matches!(region(x, y)[..], [Fault::SeedOutside { .. }]), "{x} {y}");
    }
    for (x, y) in [(0.0, 0.0), (4.0, 4.0), (2.0, 0.0), (0.0, 3.0), (1.5, 1.5), (1.0, 1.5)] {
        assert!(matches!(region(x, y)[..], [Fault::SeedOnBoundary { .. }]), "{x} {y}");
    }
}

/// The unit square and a smaller one in it, by segments, carved from the given points.
fn carved(holes: &[[f64; 2]]) -> Domain {
    let points = [[0., 0.], [4., 0.], [4., 4.], [0., 4.], [1., 1.], [2., 1.], [2., 2.], [1., 2.]];
    let mut domain = Domain::new(points.map(Point2::from).to_vec());
    for i in 0..8 {
        let next = if i % 4 == 3 { i - 3 } else { i + 1 };
        domain.segments.push(Segment { vertices: [i, next], marker: 5 });
    }
    domain.inside = Inside::Carve(holes.iter().map(|&p| p.into()).collect());
    domain
}

// spec: D14 D15
#[test]
fn hole_points_carve_faces() {
    let ids = |holes: &[[f64; 2]]| -> Vec<&str> {
        let found = validate(&carved(holes)).err().unwrap_or_default();
        found.iter().map(Fault::id).collect()
    };
    assert!(ids(&[]).is_empty());
    assert!(ids(&[[1.5, 1.5]]).is_empty());
    assert!(ids(&[[3.0, 3.0], [3.5, 3.5]]).is_empty());
    assert_eq!(ids(&[[5.0, 5.0]]), ["D14"]);
    assert_eq!(ids(&[[2.0, 1.5]]), ["D14"]);
    assert_eq!(ids(&[[3.0, 3.0], [1.5, 1.5]]), ["D15"]);
}

// spec: D15
#[test]
fn something_is_inside() {
    let empty = Domain::new(Vec::new());
    assert!(matches!(validate(&empty).unwrap_err()[..], [Fault::Empty { .. }]));
    let fault = only(r#"{"segments": [[[0,0],[1,0]],[[1,0],[1,1]]]}"#);
    assert!(matches!(fault, Fault::Empty { .. }), "{fault}");
    sound(r#"{"segments": [[[0,0],[1,0]],[[1,0],[1,1]],[[1,1],[0,0]]]}"#);
    assert!(matches!(only(r#"{"points": [[0,0],[1,0],[0,1]]}"#), Fault::Empty { .. }));
}

// spec: D16
#[test]
fn all_faults_are_named_at_once_and_none_twice() {
    let json = r#"{"outer": [[0,0],[90,0],[90,90],[0,90]],
        "holes": [
            [[1,1],[2,2],[3,3]],
            [[10,10],[20,20],[20,10],[10,20]],
            [[91,1],[92,1],[92,2]],
            [[30,30],[31,30],[31,30],[31,31]],
            [[40,40],[45,40],[50,40],[45,40],[45,45]],
            [[60,60],[61,60]]
        ],
        "segments": [[[70,70],[80,80]], [[75,75],[85,85]]],
        "points": [[90,90]]}"#;
    let found = faults(json);
    let ids: Vec<&str> = found.iter().map(Fault::id).collect();
    assert_eq!(ids, ["D3", "D4", "D5", "D6", "D7", "D8", "D9", "D10"], "{}", messages(&found));
}

// spec: D16
#[test]
fn the_list_of_crossings_is_bounded_and_says_so() {
    let count = 700;
    let mut domain = Domain::new(Vec::new());
    for i in 0..count {
        let t = f64::from(i);
        let ends = [[t, 0.0], [f64::from(count) - t, 1000.0 + t * t]];
        domain.points.extend(ends.map(Point2::from));
        domain.segments.push(Segment { vertices: [2 * i as u32, 2 * i as u32 + 1], marker: 0 });
    }
    let found = validate(&domain).unwrap_err();
    assert!((10_000..13_000).contains(&found.len()), "{}", found.len());
    let Some(Fault::ListStopped { listed }) = found.last() else { panic!("not said") };
    assert_eq!(*listed, found.len() - 1);
}

// spec: D17
#[test]
fn what_only_touches_is_sound() {
    let touching = [
        // A hole's vertex in the outer ring's corner, on its edge, and both.
        with_hole("[[0,0],[2,1],[1,2]]"),
        with_hole("[[2,0],[3,1],[1,1]]"),
        with_hole("[[0,0],[4,1],[1,4]]"),
        // Holes that share a vertex, and that touch an edge of another.
        with_hole("[[1,1],[2,2],[1,2]],[[2,2],[3,3],[2,3]]"),
        with_hole("[[1,1],[3,1],[2,2]],[[2,1],[1.5,0.5],[2.5,0.5]]"),
        // A ring of holes that cuts the domain in two.
        with_hole("[[0,2],[1,1],[2,2],[1,3]],[[2,2],[3,1],[4,2],[3,3]]"),
        // A ring that touches itself at a vertex, and with a vertex on its own edge.
        ring("[[0,0],[4,0],[4,4],[2,2],[3,4],[1,4],[2,2],[0,4]]"),
        ring("[[0,0],[4,0],[4,4],[2,0],[0,4]]"),
        // Polygons that share a corner.
        r#"{"polygons": [{"outer": [[0,0],[1,0],[1,1]]}, {"outer": [[1,1],[2,1],[2,2]]}]}"#
            .to_owned(),
        // Segments that share ends, end on edges and segments, and pass through vertices.
        segments("[[[0,0],[2,2]],[[2,2],[3,0]],[[1,1],[1,5]],[[-9,-9],[0,0]],[[9,1],[5,1]]]"),
        segments("[[[0,0],[4,4]],[[2,2],[3,0]],[[2,2],[0,5]]]"),
    ];
    for json in touching {
        sound(&json);
    }
}

// spec: D18
#[test]
fn edges_are_split_at_vertices_on_them() {
    let plc = sound(&with_hole("[[2,0],[3,1],[1,1]]"));
    let of_bottom: Vec<[u32; 2]> = plc.segments[..2].iter().map(|s| s.vertices).collect();
    assert_eq!(of_bottom, [[0, 4], [4, 1]]);
    assert_eq!(plc.segments.len(), 8);
    let markers: Vec<i32> = plc.segments.iter().map(|s| s.marker).collect();
    assert_eq!(markers, [1, 1, 1, 1, 1, 2, 2, 2]);
    // Backwards, and by an isolated point.
    let plc = sound(r#"{"outer": [[0,4],[4,4],[4,0],[0,0]], "points": [[1,0],[3,0]]}"#);
    let bottom: Vec<[u32; 2]> = plc.segments[2..5].iter().map(|s| s.vertices).collect();
    assert_eq!(bottom, [[2, 5], [5, 4], [4, 3]]);
}

// spec: D18
#[test]
fn the_complex_keeps_what_the_domain_says() {
    let mut domain = carved(&[[1.5, 1.5]]);
    domain.point_markers = (10..18).collect();
    domain.regions = vec![Region { seed: Point2::new(3.0, 3.0), marker: 2, area_max: Some(0.5) }];
    let plc = validate(&domain).unwrap();
    assert_eq!(plc.points, domain.points);
    assert_eq!(plc.point_markers, domain.point_markers);
    assert_eq!(plc.regions, domain.regions);
    assert!(plc.segments.iter().all(|s| s.marker == 5 && !s.in_loop));
    assert_eq!(plc.vertex_of, (0..8).collect::<Vec<_>>());
}

// spec: D10
#[test]
fn islands_in_holes_to_any_depth() {
    let mut domain = Domain::new(Vec::new());
    for depth in 0..60_u32 {
        let (low, high) = (f64::from(depth), f64::from(200 - depth));
        let corners = [[low, low], [high, low], [high, high], [low, high]];
        domain.points.extend(corners.map(Point2::from));
        let role =
            if depth % 2 == 0 { LoopRole::Outer } else { LoopRole::HoleOf(depth as usize - 1) };
        domain.loops.push(Loop::new((4 * depth..4 * depth + 4).collect(), 1, role));
    }
    assert!(validate(&domain).is_ok());
    domain.loops[31].role = LoopRole::HoleOf(28);
    let found = validate(&domain).unwrap_err();
    assert!(
        matches!(&found[..], [Fault::HoleInsideOther { around, .. }] if around.index == 30),
        "{}",
        messages(&found)
    );
}

#[test]
fn measures_of_a_domain() {
    let domain = square();
    let bounds = domain.bounding_box().unwrap();
    assert_eq!((bounds.min, bounds.max), (Point2::new(0.0, 0.0), Point2::new(4.0, 4.0)));
    assert_eq!(Domain::new(Vec::new()).bounding_box(), None);
}
