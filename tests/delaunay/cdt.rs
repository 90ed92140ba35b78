//! Constrained Delaunay triangulation and point location.

use crate::clouds::{self, Random};
use crate::naive::{self, finite_triangles};
use spade::Triangulation as _;
use std::collections::BTreeSet;
use trigrade::delaunay::{Cdt, CdtError, Engine, Options, PointsError, cdt, cdt_with};
use trigrade::point::Point2;
use trigrade::predicates::{Sign, orient2d};
use trigrade::triangulation::locate::Location;
use trigrade::triangulation::{GHOST, Triangulation, VertexId};

fn p(x: f64, y: f64) -> Point2 {
    Point2::new(x, y)
}

/// By divide and conquer.
fn halved(points: &[Point2], segments: &[[u32; 2]]) -> Result<Cdt, CdtError> {
    let options = Options { engine: Engine::DivideConquer, ..Options::default() };
    cdt_with(points, segments, options)
}

/// What both ways to a constrained triangulation agree on.
fn sound(points: &[Point2], segments: &[[u32; 2]]) -> Cdt {
    let result = cdt(points, segments).expect("a sound input");
    verified(points, segments, &result);
    let other = halved(points, segments).expect("a sound input");
    verified(points, segments, &other);
    let [one, two] = [&result, &other].map(|cdt| finite_triangles(&cdt.triangulation));
    assert_eq!(one, two, "{points:?} {segments:?}");
    result
}

fn verified(points: &[Point2], segments: &[[u32; 2]], result: &Cdt) {
    result.triangulation.verify_geometry(points).expect("a constrained Delaunay triangulation");
    for (&[a, b], &e) in segments.iter().zip(&result.segments) {
        let ends = [result.triangulation.origin(e), result.triangulation.dest(e)];
        assert_eq!(ends, [VertexId(a), VertexId(b)]);
        assert!(result.triangulation.is_constrained(e));
    }
    for (v, e) in result.outgoing.iter().enumerate() {
        assert!(points.len() < 2 || result.triangulation.origin(e.unwrap()).index() == v);
    }
}

fn edges(triangulation: &Triangulation) -> BTreeSet<[u32; 2]> {
    let half_edges = triangulation.triangles().flat_map(|t| t.half_edges());
    let ends = half_edges.map(|e| [triangulation.origin(e), triangulation.dest(e)]);
    ends.filter(|[a, b]| a < b && *b != GHOST).map(|[a, b]| [a.0, b.0]).collect()
}

fn lattice(side: u32, subset: u32) -> Vec<Point2> {
    let cells = (0..side * side).filter(|i| subset >> i & 1 == 1);
    cells.map(|i| p(f64::from(i % side), f64::from(i / side))).collect()
}

// spec: T1 L5
#[test]
fn every_subset_of_the_four_by_four_lattice() {
    for subset in 0..1 << 16 {
        sound(&lattice(4, subset), &[]);
    }
}

// spec: T1
#[test]
fn hard_clouds_are_delaunay() {
    for (name, points) in clouds::all(400) {
        let result = cdt(&points, &[]).expect(name);
        result.triangulation.verify_geometry(&points).expect(name);
    }
}

/// How two different lattice segments meet, by integer arithmetic.
fn meet(points: &[Point2], [a, b]: [u32; 2], [c, d]: [u32; 2]) -> bool {
    let at = |i: u32| points[i as usize];
    let side = |a, b, c| orient2d(at(a), at(b), at(c));
    let (p, q, r, s) = (side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b));
    p != q && r != s && ![p, q, r, s].contains(&Sign::Zero)
}

fn through(points: &[Point2], [a, b]: [u32; 2]) -> bool {
    let at = |i: u32| points[i as usize];
    (0..points.len() as u32).any(|v| {
        let (lo, hi) = (at(a), at(b));
        let order = lo.lexicographic(at(v));
        orient2d(lo, hi, at(v)) == Sign::Zero && order.is_ne() && order == at(v).lexicographic(hi)
    })
}

// spec: T3 T4 L5
#[test]
fn every_two_segments_of_the_four_by_four_lattice() {
    let points = lattice(4, 0xffff);
    let all: Vec<[u32; 2]> =
        (0..16).flat_map(|a| (0..16).map(move |b| [a, b])).filter(|[a, b]| a != b).collect();
    for &first in &all {
        for &second in all.iter().filter(|s| s[0] < s[1]) {
            let expected = through(&points, first) || through(&points, second);
            match cdt(&points, &[first, second]) {
                Ok(_) => {
                    assert!(!expected && !meet(&points, first, second), "{first:?} {second:?}");
                    sound(&points, &[first, second]);
                }
                Err(CdtError::Crossing { first: 0, second: 1 }) => {
                    assert!(meet(&points, first, second), "{first:?} {second:?}");
                    assert!(halved(&points, &[first, second]).is_err());
                }
                Err(CdtError::Through { segment, vertex, point }) => {
                    assert!(halved(&points, &[first, second]).is_err());
                    assert!(through(&points, [first, second][segment as usize]));
                    assert_eq!(points[vertex as usize], point);
                }
                Err(other) => panic!("{other}"),
            }
        }
    }
}

/// Random segments, kept while they cross none kept before.
fn random_segments(points: &[Point2], count: usize, seed: u64) -> Vec<[u32; 2]> {
    let mut random = Random::new(seed);
    let mut kept: Vec<[u32; 2]> = Vec::new();
    for _ in 0..count {
        let s = [0; 2].map(|_| random.below(points.len()) as u32);
        let fresh = !kept.contains(&s) && !kept.contains(&[s[1], s[0]]);
        if s[0] != s[1] && fresh && !through(points, s) && !kept.iter().any(|&k| meet(points, k, s))
        {
            kept.push(s);
        }
    }
    kept
}

// spec: T3
#[test]
fn agrees_with_spade_where_the_answer_is_unique() {
    for seed in 0..60 {
        let points = clouds::uniform(60, seed);
        let segments = random_segments(&points, 200, seed);
        assert!(segments.len() > 15, "the test must have something to force");
        let ours = sound(&points, &segments);
        let vertices = points.iter().map(|p| spade::Point2::new(p.x, p.y)).collect();
        let ends = segments.iter().map(|s| s.map(|v| v as usize)).collect();
        type Theirs = spade::ConstrainedDelaunayTriangulation<spade::Point2<f64>>;
        let theirs = Theirs::bulk_load_cdt(vertices, ends).unwrap();
        let index = |v: spade::handles::FixedVertexHandle| v.index() as u32;
        let expected: BTreeSet<_> = theirs
            .undirected_edges()
            .map(|e| e.vertices().map(|v| index(v.fix())))
            .map(|[a, b]| [a.min(b), a.max(b)])
            .collect();
        assert_eq!(edges(&ours.triangulation), expected, "seed {seed}");
    }
}

// spec: T3
#[test]
fn segments_through_hard_clouds() {
    for (name, points) in clouds::all(150) {
        let segments = random_segments(&points, 300, 7);
        let result = cdt(&points, &segments).expect(name);
        result.triangulation.verify_geometry(&points).expect(name);
    }
}

// spec: T5
#[test]
fn order_of_points_and_segments_does_not_matter() {
    let mut random = Random::new(5);
    for (name, points) in clouds::all(120) {
        let segments = random_segments(&points, 100, 11);
        let first = cdt(&points, &segments).expect(name);
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        random.shuffle(&mut order);
        let shuffled: Vec<_> = order.iter().map(|&i| points[i as usize]).collect();
        let mut place = vec![0; order.len()];
        order.iter().zip(0..).for_each(|(&i, k)| place[i as usize] = k);
        let mut moved: Vec<_> = segments.iter().map(|s| s.map(|v| place[v as usize])).collect();
        random.shuffle(&mut moved);
        let second = cdt(&shuffled, &moved).expect(name);
        let mut back: Vec<_> = finite_triangles(&second.triangulation)
            .into_iter()
            .map(|t| naive::canonical(t.map(|v| order[v as usize])))
            .collect();
        back.sort_unstable();
        assert_eq!(finite_triangles(&first.triangulation), back, "{name}");
    }
}

// spec: T3
#[test]
fn segment_along_a_comb_makes_linear_pieces() {
    // Teeth that end just above and below the segment: the chains have dangling edges.
    let mut points = vec![p(0.0, 0.0), p(101.0, 0.0)];
    for i in 1..=100 {
        points.push(p(f64::from(i), if i % 2 == 0 { 0.001 } else { -0.002 }));
        points.push(p(f64::from(i) + 0.25, if i % 2 == 0 { 7.0 } else { -8.0 }));
    }
    let teeth: Vec<[u32; 2]> = (0..100).map(|i| [2 + 2 * i, 3 + 2 * i]).collect();
    let mut segments = teeth.clone();
    segments.push([0, 1]);
    sound(&points, &segments);
    segments.reverse();
    sound(&points, &segments);
}

// spec: T3
#[test]
fn answers_for_few_points_and_lines() {
    assert_eq!(sound(&[], &[]).triangulation.live_count(), 0);
    assert_eq!(sound(&[p(1.0, 2.0)], &[]).triangulation.live_count(), 0);
    assert_eq!(sound(&[p(1.0, 2.0), p(0.0, 0.0)], &[[0, 1]]).triangulation.live_count(), 2);
    let line = clouds::line(10);
    let segments: Vec<[u32; 2]> = (0..9).map(|i| [i, i + 1]).collect();
    assert_eq!(sound(&line, &segments).triangulation.live_count(), 18);
}

// spec: L5
#[test]
fn both_ways_agree_on_segments_across_hard_clouds() {
    for n in [3, 10, 60, 300] {
        for (name, points) in clouds::all(n) {
            for seed in 0..3 {
                let segments = random_segments(&points, 2 * n, seed);
                assert!(n < 10 || name == "line" || !segments.is_empty(), "{name}");
                sound(&points, &segments);
            }
        }
    }
}

// spec: L5
#[test]
fn both_ways_agree_on_combs_spirals_and_stars() {
    // Teeth that a single long segment passes beside, and a spiral wall.
    let mut points = vec![p(-1.0, 0.5), p(400.0, 0.5 + 1e-9)];
    let mut segments = vec![[0, 1]];
    for i in 0..200 {
        let v = points.len() as u32;
        points.extend([p(f64::from(i), 1.0), p(f64::from(i) + 0.5, 90.0), p(f64::from(i), -1.0)]);
        segments.extend([[v, v + 1], [v + 1, v + 3]]);
    }
    segments.pop();
    sound(&points, &segments);
    let spiral = clouds::spiral(2000);
    let wall: Vec<[u32; 2]> = (1..2000).map(|i| [i - 1, i]).collect();
    sound(&spiral, &wall);
    let mut star = clouds::circle(400);
    star.push(p(0.0, 0.0));
    let rays: Vec<[u32; 2]> = (0..400).step_by(3).map(|i| [i, 400]).collect();
    sound(&clouds::distinct(star), &rays);
}

// spec: L5
#[test]
fn both_ways_refuse_the_same_input() {
    let square = [p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)];
    let crossing = CdtError::Crossing { first: 0, second: 1 };
    assert_eq!(halved(&square, &[[0, 2], [1, 3]]).err(), Some(crossing));
    let line = clouds::line(9);
    for segment in [[0, 2], [8, 0], [3, 5]] {
        let Err(CdtError::Through { segment: 0, vertex, point }) = halved(&line, &[segment]) else {
            panic!("{segment:?} passes through points");
        };
        assert_eq!(line[vertex as usize], point);
    }
    assert!(matches!(halved(&square, &[[0, 4]]), Err(CdtError::BadSegment { .. })));
    let twice = [square[0], square[1], square[0]];
    assert!(matches!(halved(&twice, &[]), Err(CdtError::Duplicate { first: 0, second: 2, .. })));
    let nan = [p(f64::NAN, 0.0)];
    assert!(matches!(halved(&nan, &[]), Err(CdtError::Points(_))));
    for engine in [Engine::Watson, Engine::Lawson, Engine::FangPiegl, Engine::Sweep] {
        let options = Options { engine, ..Options::default() };
        let error = cdt_with(&square, &[], options).err();
        assert_eq!(error, Some(CdtError::Unconstrained(engine.name())));
    }
    for few in [&[][..], &[p(1.0, 1.0)], &square[..2]] {
        assert_eq!(
            halved(few, &[]).unwrap().triangulation.live_count(),
            if few.len() == 2 { 2 } else { 0 }
        );
    }
}

// spec: T4
#[test]
fn bad_input_is_named() {
    let square = [p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)];
    let crossing = cdt(&square, &[[0, 2], [1, 3]]).err();
    assert_eq!(crossing, Some(CdtError::Crossing { first: 0, second: 1 }));
    let line = clouds::line(3);
    let through = cdt(&line, &[[0, 2]]).err();
    assert_eq!(through, Some(CdtError::Through { segment: 0, vertex: 1, point: line[1] }));
    let bad =
        |segment| matches!(cdt(&square, &[segment]), Err(CdtError::BadSegment { segment: 0, .. }));
    assert!(bad([0, 4]) && bad([2, 2]) && bad([u32::MAX, 0]));
    let nan = cdt(&[p(0.0, 0.0), p(f64::NAN, 1.0)], &[]).err();
    assert!(matches!(nan, Some(CdtError::Points(PointsError::NotFinite { index: 1, .. }))));
    let twice = cdt(&[p(0.0, 1.0), p(1.0, 1.0), p(-0.0, 1.0)], &[]).err();
    assert!(matches!(twice, Some(CdtError::Duplicate { first: 0, second: 2, .. })));
    assert_eq!(crossing.unwrap().to_string(), "segments 0 and 1 cross");
}

fn contains(points: &[Point2], corners: [VertexId; 3], q: Point2) -> [Sign; 3] {
    let [a, b, c] = corners.map(|v| points[v.index()]);
    [orient2d(a, b, q), orient2d(b, c, q), orient2d(c, a, q)]
}

fn assert_located(points: &[Point2], t: &Triangulation, q: Point2, found: Location) {
    let at = |v: VertexId| points[v.index()];
    match found {
        Location::Inside(triangle) => {
            assert_eq!(contains(points, t.corners(triangle), q), [Sign::Positive; 3]);
        }
        Location::OnVertex(e) => assert_eq!(at(t.origin(e)), q),
        Location::OnEdge(e) => {
            let (a, b) = (at(t.origin(e)), at(t.dest(e)));
            assert_eq!(orient2d(a, b, q), Sign::Zero);
            assert_eq!(a.lexicographic(q), q.lexicographic(b));
        }
        Location::Outside(e) => {
            let ghost = t.twin(e).is_none_or(|f| t.is_ghost(f.triangle()));
            assert!(ghost, "the edge is on the hull");
            let finite = !t.is_ghost(e.triangle());
            assert!(!finite || orient2d(at(t.origin(e)), at(t.dest(e)), q) == Sign::Negative);
        }
    }
}

// spec: T2
#[test]
fn locate_finds_every_kind_of_place() {
    let mut random = Random::new(3);
    for (name, points) in clouds::all(100) {
        let segments = random_segments(&points, 60, 2);
        let t = cdt(&points, &segments).expect(name).triangulation;
        let all: Vec<_> = t.triangles().collect();
        for _ in 0..400 {
            let [a, b] = [0; 2].map(|_| points[random.below(points.len())]);
            let middle = p(a.x / 2.0 + b.x / 2.0, a.y / 2.0 + b.y / 2.0);
            for q in [a, middle, p(a.y, b.x), p(2.0 * a.x - b.x, 2.0 * a.y - b.y)] {
                if q.is_finite() {
                    let hint = all[random.below(all.len())];
                    assert_located(&points, &t, q, t.locate(&points, q, hint));
                }
            }
        }
    }
}
