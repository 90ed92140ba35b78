//! From points or a domain to a triangulation as plain data, with `check` as judge.

use crate::clouds::{self, Random};
use trigrade::check::{CheckOptions, check};
use trigrade::delaunay::{CdtError, Engine};
use trigrade::domain::{Domain, Inside, Loop, LoopRole, Region, Segment};
use trigrade::mesh::MeshData;
use trigrade::point::Point2;
use trigrade::triangulate::{
    HULL_MARKER, Options, TriangulateError, Triangulated, triangulate_domain, triangulate_points,
};

fn p(x: f64, y: f64) -> Point2 {
    Point2::new(x, y)
}

/// With an outline for the checker.
fn wanted() -> Options {
    Options { outline: true, ..Options::default() }
}

/// Lets the checker judge, and checks the map.
fn judged(given: &[Point2], result: &Triangulated, constrained: bool) {
    assert_eq!(result.map.len(), given.len());
    for (point, new) in given.iter().zip(&result.map) {
        if let Some(new) = new {
            assert_eq!(result.mesh.points[*new as usize], *point);
        }
    }
    for &[dropped, kept] in &result.repeated {
        assert!(kept < dropped && result.map[dropped as usize] == result.map[kept as usize]);
    }
    if result.mesh.triangles.is_empty() {
        return;
    }
    let options = CheckOptions::default();
    let options = match constrained {
        true => options.constrained_delaunay(true),
        false => options.delaunay(true),
    };
    let report = check(&MeshData::from(&result.mesh), result.outline.as_ref(), &options);
    assert!(report.passed(), "{:?} {:?}", report.findings, report.could_not_run);
}

// spec: L6
#[test]
fn points_with_repetitions_give_a_mesh_that_passes_its_check() {
    let mut random = Random::new(5);
    for (name, points) in clouds::all(120) {
        let mut given: Vec<Point2> = points.iter().flat_map(|&q| [q, q]).collect();
        random.shuffle(&mut given);
        for engine in Engine::ALL {
            let options = Options { engine, ..wanted() };
            let result = triangulate_points(&given, options).expect(name);
            judged(&given, &result, false);
            assert_eq!(result.mesh.points.len(), points.len(), "{name}");
            assert_eq!(result.repeated.len(), points.len(), "{name}");
            assert!(result.map.iter().all(Option::is_some));
            assert!(result.mesh.edges.iter().all(|edge| edge.marker == HULL_MARKER));
        }
    }
}

// spec: L3 L6
#[test]
fn without_a_triangle_the_points_are_there() {
    for points in [vec![], vec![p(1.0, 2.0)], vec![p(0.0, 0.0), p(1.0, 1.0)], clouds::line(9)] {
        let result = triangulate_points(&points, wanted()).unwrap();
        assert_eq!((result.mesh.points.len(), result.mesh.triangles.len()), (points.len(), 0));
        assert!(result.outline.is_none() && result.mesh.edges.is_empty());
        judged(&points, &result, false);
    }
}

/// A square with a square hole, a wall, a point inside and one outside.
fn plate() -> Domain {
    let corners = [
        [0.0, 0.0],
        [4.0, 0.0],
        [4.0, 4.0],
        [0.0, 4.0],
        [1.0, 1.0],
        [2.0, 1.0],
        [2.0, 2.0],
        [1.0, 2.0],
        [3.0, 1.0],
        [3.0, 3.0],
        [0.5, 3.5],
        [9.0, 9.0],
    ];
    let mut domain = Domain::new(corners.map(Point2::from).to_vec());
    domain.loops = vec![
        Loop::new(vec![0, 1, 2, 3], 5, LoopRole::Any),
        Loop::new(vec![4, 5, 6, 7], 6, LoopRole::Any),
    ];
    domain.segments = vec![Segment { vertices: [8, 9], marker: 7 }];
    domain.regions = vec![Region { seed: p(0.5, 0.5), marker: 42, area_max: None }];
    domain
}

fn markers(result: &Triangulated) -> Vec<(i32, usize)> {
    let mut markers: Vec<i32> = result.mesh.edges.iter().map(|edge| edge.marker).collect();
    markers.sort_unstable();
    markers.chunk_by(|a, b| a == b).map(|group| (group[0], group.len())).collect()
}

// spec: L7
#[test]
fn a_domain_is_carved_by_its_rule_or_keeps_its_hull() {
    let plate = plate();
    for engine in [Engine::Auto, Engine::DivideConquer] {
        let carved = triangulate_domain(&plate, Options { engine, ..wanted() }).unwrap();
        judged(&plate.points, &carved, true);
        assert_eq!(carved.map[11], None, "outside");
        assert_eq!(carved.mesh.points.len(), 11);
        assert!(carved.mesh.regions.iter().all(|&region| region == 42));
        assert_eq!(markers(&carved), [(5, 4), (6, 4), (7, 1)]);
        let hull = Options { engine, hull: true, ..wanted() };
        let hull = triangulate_domain(&plate, hull).unwrap();
        judged(&plate.points, &hull, true);
        assert!(hull.map.iter().all(Option::is_some));
        assert!(hull.mesh.triangles.len() > carved.mesh.triangles.len());
        assert_eq!(markers(&hull), [(HULL_MARKER, 2), (5, 4), (6, 4), (7, 1)]);
    }
}

// spec: L7 T4
#[test]
fn segments_that_cross_are_refused_or_cut() {
    let mut plate = plate();
    plate.points.extend([p(0.5, 1.25), p(3.5, 2.0)]);
    plate.segments.push(Segment { vertices: [12, 13], marker: 8 });
    let invalid = triangulate_domain(&plate, wanted());
    let Err(TriangulateError::Invalid(faults)) = invalid else { panic!("{invalid:?}") };
    assert!(faults.iter().all(|fault| fault.id() == "D8"));
    let hull = Options { hull: true, ..wanted() };
    let crossing = triangulate_domain(&plate, hull);
    assert!(
        matches!(crossing, Err(TriangulateError::Segments(CdtError::Crossing { .. }))),
        "{crossing:?}"
    );
    let split = Options { split_crossings: true, ..wanted() };
    for options in [split, Options { hull: true, ..split }] {
        let cut = triangulate_domain(&plate, options).unwrap();
        judged(&plate.points, &cut, true);
        // Two sides of the hole, and the wall, are crossed.
        assert_eq!(cut.crossings, 3, "{options:?}");
        let of_the_cut = cut.mesh.edges.iter().filter(|edge| edge.marker == 8).count();
        // The piece in the hole goes with it.
        assert_eq!(of_the_cut, if options.hull { 4 } else { 3 }, "{options:?}");
    }
}

// spec: L7
#[test]
fn loops_that_cross_themselves_have_an_inside_by_parity() {
    let mut bow =
        Domain::new([[0.0, 0.0], [4.0, 4.0], [4.0, 0.0], [0.0, 4.0]].map(Point2::from).to_vec());
    bow.loops = vec![Loop::new(vec![0, 1, 2, 3], 1, LoopRole::Any)];
    assert!(triangulate_domain(&bow, wanted()).is_err());
    let split = Options { split_crossings: true, ..wanted() };
    let result = triangulate_domain(&bow, split).unwrap();
    judged(&bow.points, &result, true);
    assert_eq!((result.crossings, result.mesh.triangles.len()), (1, 2));
    // The same loop twice encloses nothing.
    bow.loops.push(bow.loops[0].clone());
    let nothing = triangulate_domain(&bow, split);
    assert!(matches!(nothing, Err(TriangulateError::Inside(_))), "{nothing:?}");
}

// spec: L7
#[test]
fn breaklines_through_points_and_over_each_other_keep_the_hull() {
    let mut terrain = Domain::new(clouds::grid(12, 1.0));
    let line = |a, b, marker| Segment { vertices: [a, b], marker };
    // Rows and a diagonal through points, and an overlap.
    terrain.segments = vec![line(0, 11, 2), line(14, 20, 3), line(16, 23, 4), line(0, 143, 5)];
    terrain.inside = Inside::Carve(Vec::new());
    assert!(triangulate_domain(&terrain, wanted()).is_err());
    for engine in [Engine::Auto, Engine::DivideConquer] {
        let options = Options { engine, hull: true, ..wanted() };
        let result = triangulate_domain(&terrain, options).unwrap();
        judged(&terrain.points, &result, true);
        assert_eq!((result.crossings, result.mesh.triangles.len()), (0, 242));
        let marked = |marker| result.mesh.edges.iter().filter(|e| e.marker == marker).count();
        // Pieces under two segments have the first one's marker.
        assert_eq!([2, 3, 4, 5].map(marked), [11, 6, 3, 11]);
    }
}

// spec: L7 !L7
#[test]
fn unsound_segments_are_named() {
    let hull = Options { hull: true, ..wanted() };
    let mut plate = plate();
    plate.segments[0].vertices = [8, 99];
    let bad = triangulate_domain(&plate, hull);
    assert!(matches!(
        bad,
        Err(TriangulateError::Segments(CdtError::BadSegment { segment: 8, .. }))
    ));
    plate.points.push(plate.points[8]);
    plate.segments[0].vertices = [8, 12];
    let bad = triangulate_domain(&plate, hull).unwrap_err();
    assert_eq!(bad.to_string(), "segment 8 joins points 8 and 12, which are equal");
    plate.segments.clear();
    plate.points[0].x = f64::NAN;
    assert!(matches!(triangulate_domain(&plate, hull), Err(TriangulateError::Points(_))));
    let sweep = Options { engine: Engine::Sweep, ..wanted() };
    let unconstrained = triangulate_domain(&self::plate(), sweep);
    let expected = TriangulateError::Segments(CdtError::Unconstrained("sweep"));
    assert_eq!(unconstrained, Err(expected));
}
