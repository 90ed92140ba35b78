//! The background mesh of a domain and the open region of the front.

use trigrade::background::{Background, BackgroundError, INSIDE, OUTSIDE, SeedKind};
use trigrade::domain::Region;
use trigrade::domain::validate::{Plc, PlcInside, PlcSegment, validate};
use trigrade::format::domain_file::{DomainForm, ReadOptions, read_domain};
use trigrade::point::Point2;
use trigrade::triangulation::Across;

fn p(x: f64, y: f64) -> Point2 {
    Point2::new(x, y)
}

/// An axis-parallel square of the given half width as a loop.
fn add_square(plc: &mut Plc, centre: Point2, half: f64, marker: i32) {
    let base = plc.points.len() as u32;
    for (sx, sy) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        plc.points.push(p(centre.x + sx * half, centre.y + sy * half));
    }
    for i in 0..4 {
        let vertices = [base + i, base + (i + 1) % 4];
        plc.segments.push(PlcSegment { vertices, marker, in_loop: true });
    }
}

fn empty(inside: PlcInside) -> Plc {
    Plc {
        points: Vec::new(),
        point_markers: Vec::new(),
        segments: Vec::new(),
        inside,
        regions: Vec::new(),
        vertex_of: Vec::new(),
    }
}

/// A square with a square hole and a square island in the hole, and a second square far away.
fn nested(inside: PlcInside) -> Plc {
    let mut plc = empty(inside);
    for (half, marker) in [(8.0, 1), (4.0, 2), (2.0, 3)] {
        add_square(&mut plc, p(0.0, 0.0), half, marker);
    }
    add_square(&mut plc, p(20.0, 1.0), 1.0, 4);
    plc
}

/// Twice the area of the triangles with tags that `wanted` accepts.
fn area(background: &Background, wanted: impl Fn(u32) -> bool) -> f64 {
    let t = &background.triangulation;
    let finite = t.triangles().filter(|&u| !t.is_ghost(u) && wanted(t.tag(u)));
    finite
        .map(|u| {
            let [a, b, c] = t.corners(u).map(|v| background.points[v.index()]);
            (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)
        })
        .sum()
}

/// The open region is what it should be: sound, inside only, every border owned by its edge.
fn check_open(background: &Background) {
    let (open, edges) = background.open_region();
    open.verify_geometry(&background.points).unwrap();
    let inside = background.triangulation.triangles().filter(|&t| background.is_inside(t));
    assert_eq!(open.live_count(), inside.count());
    let mut borders = 0;
    for e in open.triangles().flat_map(|t| t.half_edges()) {
        if let Across::Border(owner) = open.across(e) {
            assert_eq!(edges[owner as usize].half_edge, e);
            borders += 1;
        }
    }
    assert_eq!(borders, edges.len());
    for (edge, whole) in edges.iter().zip(&background.edges) {
        assert_eq!(edge.vertices, [open.origin(edge.half_edge), open.dest(edge.half_edge)]);
        assert_eq!(edge.vertices, whole.vertices);
        assert!(background.is_inside(whole.half_edge.triangle()));
    }
    assert!(edges[..background.boundary_count].iter().all(|e| !e.interior));
    assert!(edges[background.boundary_count..].iter().all(|e| e.interior));
}

// spec: T6 T7
#[test]
fn even_odd_makes_islands_in_holes_and_several_components() {
    let background = Background::new(&nested(PlcInside::EvenOdd)).unwrap();
    let inside = 2.0 * (16.0 * 16.0 - 8.0 * 8.0 + 4.0 * 4.0 + 2.0 * 2.0);
    assert_eq!(area(&background, |tag| tag != OUTSIDE), inside);
    assert_eq!(background.boundary_count, 16);
    assert_eq!(background.edges.len(), 16);
    check_open(&background);
}

// spec: T6 T7
#[test]
fn even_odd_constraints_do_not_switch() {
    let mut plc = empty(PlcInside::EvenOdd);
    add_square(&mut plc, p(0.0, 0.0), 4.0, 1);
    plc.points.extend([p(-1.0, 0.0), p(1.0, 0.5)]);
    plc.segments.push(PlcSegment { vertices: [4, 5], marker: 9, in_loop: false });
    plc.segments.push(PlcSegment { vertices: [0, 4], marker: 8, in_loop: false });
    let background = Background::new(&plc).unwrap();
    assert_eq!(area(&background, |tag| tag != OUTSIDE), 128.0);
    assert_eq!((background.boundary_count, background.edges.len()), (4, 8));
    let markers: Vec<i32> = background.edges.iter().map(|e| e.marker).collect();
    assert_eq!(markers, [1, 1, 1, 1, 9, 9, 8, 8]);
    check_open(&background);
}

// spec: T6
#[test]
fn boundary_keeps_the_domain_on_its_left() {
    for reversed in [false, true] {
        let mut plc = nested(PlcInside::EvenOdd);
        if reversed {
            plc.segments.iter_mut().for_each(|s| s.vertices.reverse());
        }
        let background = Background::new(&plc).unwrap();
        let twice: f64 = background.edges[..background.boundary_count]
            .iter()
            .map(|e| e.vertices.map(|v| background.points[v.index()]))
            .map(|[a, b]| a.x * b.y - b.x * a.y)
            .sum();
        assert_eq!(twice, area(&background, |tag| tag != OUTSIDE));
    }
}

// spec: T6 T7
#[test]
fn carving_keeps_what_no_seed_reaches() {
    let background = Background::new(&nested(PlcInside::Carve(vec![p(3.0, 0.0)]))).unwrap();
    assert_eq!(area(&background, |tag| tag != OUTSIDE), 2.0 * (256.0 - 64.0 + 16.0 + 4.0));
    check_open(&background);
    let whole = Background::new(&nested(PlcInside::Carve(Vec::new()))).unwrap();
    assert_eq!(area(&whole, |tag| tag != OUTSIDE), 2.0 * (256.0 + 4.0));
    assert_eq!((whole.boundary_count, whole.edges.len()), (8, 8 + 2 * 8));
    check_open(&whole);
}

// spec: T6
#[test]
fn regions_are_tagged() {
    let mut plc = nested(PlcInside::Carve(Vec::new()));
    let region = |seed, marker| Region { seed, marker, area_max: None };
    plc.regions = vec![region(p(0.0, 0.0), 70), region(p(3.0, 0.0), 80), region(p(0.5, 0.5), 70)];
    let background = Background::new(&plc).unwrap();
    assert_eq!(area(&background, |tag| tag == INSIDE + 1), 2.0 * 16.0);
    assert_eq!(area(&background, |tag| tag == INSIDE + 2), 2.0 * (64.0 - 16.0));
    assert_eq!(area(&background, |tag| tag == INSIDE), 2.0 * (256.0 - 64.0 + 4.0));
    let t = background.triangulation.triangles().find(|&t| background.triangulation.tag(t) == 3);
    assert_eq!(background.region(t.unwrap()).unwrap().marker, 80);
}

// spec: T8
#[test]
fn seeds_in_bad_places_are_named() {
    let region = |seed, marker| Region { seed, marker, area_max: None };
    let with = |seeds: &[Point2]| {
        let mut plc = nested(PlcInside::EvenOdd);
        plc.regions = seeds.iter().map(|&s| region(s, s.x as i32)).collect();
        Background::new(&plc).map(|_| ()).unwrap_err()
    };
    for seed in [p(3.0, 0.0), p(100.0, 0.0), p(f64::NAN, 0.0)] {
        let found = with(&[p(0.0, 0.0), seed]);
        assert!(matches!(
            found,
            BackgroundError::SeedOutside { kind: SeedKind::Region, index: 1, .. }
        ));
    }
    let on_edge = with(&[p(0.0, 8.0)]);
    assert!(matches!(on_edge, BackgroundError::SeedOnSegment { index: 0, segment: 2, .. }));
    let on_vertex = with(&[p(-2.0, -2.0)]);
    assert!(matches!(on_vertex, BackgroundError::SeedOnSegment { segment: 8 | 11, .. }));
    let twice = with(&[p(0.0, 0.0), p(1.0, 1.0)]);
    assert!(matches!(twice, BackgroundError::RegionTwice { first: 0, second: 1, .. }));
    let hole = Background::new(&nested(PlcInside::Carve(vec![p(50.0, 0.0)]))).map(|_| ());
    let expected = "hole seed 0 at (50.0, 0.0) lies outside the domain";
    assert_eq!(hole.unwrap_err().to_string(), expected);
}

// spec: T8
#[test]
fn a_domain_with_nothing_inside_is_an_error() {
    let mut open = empty(PlcInside::Carve(Vec::new()));
    add_square(&mut open, p(0.0, 0.0), 1.0, 1);
    open.segments.pop();
    assert_eq!(Background::new(&open).map(|_| ()), Err(BackgroundError::Empty));
    assert_eq!(
        Background::new(&empty(PlcInside::EvenOdd)).map(|_| ()),
        Err(BackgroundError::Empty)
    );
}

// spec: T7
#[test]
fn an_isolated_point_is_a_vertex_of_the_open_region() {
    let mut plc = empty(PlcInside::EvenOdd);
    add_square(&mut plc, p(0.0, 0.0), 1.0, 1);
    plc.points.push(p(0.25, 0.125));
    let (open, _) = Background::new(&plc).unwrap().open_region();
    assert_eq!(open.live_count(), 4);
    assert!(open.outgoing(5)[4].is_some());
}

// spec: T1 T6 T7
#[test]
fn real_boundaries_have_a_background() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data/polygons");
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let mut sound = 0;
    for path in paths.into_iter().filter(|p| p.extension().is_some_and(|e| e == "poly")) {
        let bytes = std::fs::read(&path).unwrap();
        let Ok(domain) = read_domain(&bytes, DomainForm::Poly, &ReadOptions::default()) else {
            continue;
        };
        let Ok(plc) = validate(&domain) else { continue };
        let background = Background::new(&plc).unwrap_or_else(|e| panic!("{path:?}: {e}"));
        background.triangulation.verify_geometry(&plc.points).expect("constrained Delaunay");
        check_open(&background);
        sound += 1;
    }
    assert!(sound > 100, "the data has hundreds of sound domains, found {sound}");
}
