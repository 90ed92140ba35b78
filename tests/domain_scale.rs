//! Large domains: validation must stay near-linear, whatever the lengths and directions of edges.
//! Times are printed (`cargo test --release --test domain_scale -- --nocapture`), not judged.

use std::time::Instant;
use trigrade::domain::validate::{Fault, Plc, validate};
use trigrade::domain::{Domain, Inside, Loop, LoopRole, Segment};
use trigrade::point::Point2;

/// Koch's curve over the sides of a square: 4^(depth + 1) vertices, no two edges near each other
/// but neighbours.
fn koch(depth: u32) -> Vec<Point2> {
    let corners = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]];
    let mut curve: Vec<Point2> = corners.map(Point2::from).to_vec();
    for _ in 0..depth {
        let next = curve.iter().skip(1).chain(curve.first());
        curve = curve.iter().zip(next).flat_map(|(&a, &b)| bump(a, b)).collect();
    }
    curve
}

/// The first four points of a side with a triangular bump on its left.
fn bump(a: Point2, b: Point2) -> [Point2; 4] {
    let (dx, dy) = ((b.x - a.x) / 3.0, (b.y - a.y) / 3.0);
    let height = 0.75_f64.sqrt();
    let tip = Point2::new(a.x + 1.5 * dx - height * dy, a.y + 1.5 * dy + height * dx);
    [a, Point2::new(a.x + dx, a.y + dy), tip, Point2::new(a.x + 2.0 * dx, a.y + 2.0 * dy)]
}

fn ring(points: Vec<Point2>) -> Domain {
    let vertices = (0..points.len() as u32).collect();
    let mut domain = Domain::new(points);
    domain.loops = vec![Loop::new(vertices, 1, LoopRole::Outer)];
    domain
}

fn segments(ends: impl Iterator<Item = [[f64; 2]; 2]>) -> Domain {
    let frame = [[-2.0, -2.0], [3.0, -2.0], [3.0, 3.0], [-2.0, 3.0]];
    let mut domain = ring(frame.map(Point2::from).to_vec());
    for [a, b] in ends {
        let first = domain.points.len() as u32;
        domain.points.extend([a, b].map(Point2::from));
        domain.segments.push(Segment { vertices: [first, first + 1], marker: 1 });
    }
    domain
}

fn timed(name: &str, domain: &Domain) -> Result<Plc, Vec<Fault>> {
    let start = Instant::now();
    let found = validate(domain);
    let count = domain.edges().count();
    println!("{name}: {count} edges in {:.1} ms", start.elapsed().as_secs_f64() * 1e3);
    found
}

/// Numbers in [0, 1) by a linear congruence: any would do.
fn numbers() -> impl FnMut() -> f64 {
    let mut state = 1_u64;
    move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

// spec: D20
#[test]
fn a_fractal_coast() {
    let domain = ring(koch(8));
    let plc = timed("Koch coast", &domain).unwrap_or_else(|f| panic!("{}", f[0]));
    assert_eq!(plc.segments.len(), 262_144);
}

// spec: D20
#[test]
fn a_coast_with_a_crossing_names_it() {
    let mut points = koch(7);
    points.swap(1001, 1009);
    let Err(found) = timed("Koch coast with two points swapped", &ring(points)) else {
        panic!("no fault")
    };
    assert!(
        found.iter().all(|f| f.id() == "D8") && (1..30).contains(&found.len()),
        "{}",
        found.len()
    );
}

// spec: D20
#[test]
fn short_segments_in_random_directions() {
    let mut number = numbers();
    let side = 316;
    let cell = |i: usize| {
        let (x, y) = ((i % side) as f64, (i / side) as f64);
        let mut end = || [(x + number()) / side as f64, (y + number()) / side as f64];
        [end(), end()]
    };
    let domain = segments((0..side * side).map(cell));
    assert!(timed("a random segment in each cell of a grid", &domain).is_ok());
}

// spec: D20
#[test]
fn long_parallel_segments() {
    let count = 100_000;
    let diagonal = |i: usize| {
        let t = i as f64 / count as f64;
        [[-t, t], [1.0 - t, 1.0 + t]]
    };
    let domain = segments((0..count).map(diagonal));
    assert!(timed("long diagonals side by side", &domain).is_ok());
    // One segment across all of them.
    let across = segments((0..count).map(diagonal).chain([[[1.5, -0.5], [-1.0, 2.0]]]));
    let found = timed("and one across", &across).unwrap_err();
    assert_eq!(found.len(), count, "{}", found[found.len() - 1]);
}

// spec: D20
#[test]
fn long_segments_of_random_length_that_do_not_cross() {
    let mut number = numbers();
    let count = 100_000;
    let spoke = |i: usize| {
        let angle = std::f64::consts::TAU * i as f64 / count as f64;
        let (cos, sin) = (libm::cos(angle), libm::sin(angle));
        let (r, s) = (0.1 + 0.4 * number(), 0.6 + 0.9 * number());
        [[r * cos, r * sin], [s * cos, s * sin]]
    };
    let domain = segments((0..count).map(spoke));
    assert!(timed("spokes", &domain).is_ok());
}

// spec: D16 D20
#[test]
fn many_long_segments_that_all_cross() {
    let mut number = numbers();
    let mut end = || [number(), number()];
    let domain = segments((0..20_000).map(|_| [end(), end()]));
    let found = timed("random long segments", &domain).unwrap_err();
    assert!(found.len() < 100_000, "{}", found.len());
    assert!(matches!(found.last(), Some(Fault::ListStopped { .. })));
}

// spec: D20
#[test]
fn a_fan_around_one_vertex() {
    let count = 50_000_u32;
    let mut points = vec![Point2::new(0.0, 0.0)];
    points.extend((0..count).map(|i| {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(count);
        Point2::new(libm::cos(angle), libm::sin(angle))
    }));
    let mut domain = Domain::new(points);
    domain.inside = Inside::Carve(Vec::new());
    for i in 1..=count {
        domain.segments.push(Segment { vertices: [0, i], marker: 1 });
        domain.segments.push(Segment { vertices: [i, i % count + 1], marker: 2 });
    }
    assert!(timed("fan", &domain).is_ok());
    // As petals of one loop, each from the centre and back.
    let mut petals = ring(domain.points.clone());
    petals.loops[0] =
        Loop::new((1..count).step_by(2).flat_map(|i| [0, i, i + 1]).collect(), 1, LoopRole::Outer);
    assert!(timed("petals", &petals).is_ok());
    // And all of them crossing at the centre.
    let half = count / 2;
    petals.loops[0] =
        Loop::new((1..half).flat_map(|i| [0, i, i + half]).collect(), 1, LoopRole::Outer);
    assert!(timed("petals that cross", &petals).is_err());
}
