//! All engines give the same triangles, and those of the definition.

use crate::clouds::{self, Random};
use crate::naive::{self, canonical};
use proptest::prelude::*;
use spade::Triangulation as _;
use trigrade::delaunay::{Delaunay, Engine, Options, PointsError, delaunay};
use trigrade::point::Point2;

fn with(engine: Engine, points: &[Point2]) -> Delaunay {
    delaunay(points, Options { engine, parallel: false }).expect("finite points")
}

/// Triangulates with every engine and returns what they agree on.
fn agreed(name: &str, points: &[Point2]) -> Delaunay {
    let first = with(Engine::Auto, points);
    first.triangulation.verify_geometry(points).expect(name);
    for engine in Engine::ALL {
        let other = with(engine, points);
        assert_eq!(other.triangulation.verify(), Ok(()), "{name} {}", engine.name());
        assert_eq!(other.triangles(), first.triangles(), "{name} {}", engine.name());
        assert_eq!(other.repeated, first.repeated, "{name} {}", engine.name());
    }
    first
}

// spec: L1 L2
#[test]
fn engines_agree_on_hard_clouds() {
    for n in [2, 3, 4, 5, 20, 100, 1000] {
        for (name, points) in clouds::all(n) {
            agreed(name, &points);
        }
    }
}

// spec: L2
#[test]
fn engines_agree_on_the_cocircular_3600() {
    agreed("circle of 3,600", &clouds::distinct(clouds::circle(3600)));
}

/// Every engine on 100,000 points of each cloud and on grids of a million, but on 20,000 of the axis
/// cross, where each point inserted along a curve sees all before it; Fang and Piegl's, which is
/// quadratic where the grid does not spread the points, where it does. With spade on the clouds
/// that have no ties and no extreme coordinates. Some minutes: `-- --ignored large`.
// spec: L1 L2
#[test]
#[ignore = "minutes"]
fn engines_agree_on_large_clouds() {
    let mut large = clouds::all(100_000);
    large.push(("grid of a million", clouds::grid(1000, 1.0)));
    large.push(("grid of a million times 0.1", clouds::grid(1000, 0.1)));
    for (name, mut points) in large {
        if name == "axis cross" {
            points.truncate(20_000);
        }
        let first = with(Engine::Auto, &points);
        first.triangulation.verify_geometry(&points).expect(name);
        let triangles = first.triangles();
        let is_spread = name == "uniform" || name.contains("grid");
        let engines = Engine::ALL.into_iter().skip(1);
        for engine in engines.filter(|&e| e != Engine::FangPiegl || is_spread) {
            assert!(with(engine, &points).triangles() == triangles, "{name} {}", engine.name());
        }
        if ["uniform", "clusters"].contains(&name) {
            assert!(by_spade(&points) == triangles, "{name} by spade");
        }
        println!("{name}: {} points, {} triangles", points.len(), triangles.len());
    }
}

/// Integer points on one circle: exactly cocircular, in number theory's gift.
fn lattice_circle(r: i64) -> Vec<Point2> {
    let on = |&(x, y): &(i64, i64)| x * x + y * y == r * r;
    let all = (-r..=r).flat_map(|x| (-r..=r).map(move |y| (x, y)));
    all.filter(on).map(|(x, y)| Point2::new(x as f64, y as f64)).collect()
}

// spec: L1 L2
#[test]
fn exact_circles_have_one_answer() {
    for r in [5, 25, 65, 325] {
        let points = lattice_circle(r);
        assert!(points.len() >= 12);
        let result = agreed("lattice circle", &points);
        assert_eq!(result.triangles().len(), points.len() - 2);
        if points.len() < 30 {
            assert_eq!(result.triangles(), naive::delaunay(&points));
        }
    }
}

// spec: L1
#[test]
fn every_engine_gives_the_triangles_of_the_definition() {
    for (name, points) in clouds::all(30) {
        let points = &points[..points.len().min(30)];
        assert_eq!(agreed(name, points).triangles(), naive::delaunay(points), "{name}");
    }
}

// spec: L1
#[test]
fn every_subset_of_the_three_by_three_lattice() {
    for subset in 0..1 << 9 {
        let cells = (0..9).filter(|i| subset >> i & 1 == 1);
        let points: Vec<_> =
            cells.map(|i| Point2::new(f64::from(i % 3), f64::from(i / 3))).collect();
        assert_eq!(agreed("lattice", &points).triangles(), naive::delaunay(&points), "{subset:b}");
    }
}

// spec: L2
#[test]
fn the_order_of_the_points_does_not_matter() {
    let mut random = Random::new(9);
    for (name, points) in clouds::all(300) {
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        random.shuffle(&mut order);
        let shuffled: Vec<_> = order.iter().map(|&i| points[i as usize]).collect();
        let mut back: Vec<_> = with(Engine::Auto, &shuffled)
            .triangles()
            .into_iter()
            .map(|t| canonical(t.map(|v| order[v as usize])))
            .collect();
        back.sort_unstable();
        assert_eq!(back, with(Engine::Auto, &points).triangles(), "{name}");
    }
}

// spec: L4
#[test]
fn threads_do_not_matter() {
    for (name, points) in clouds::all(60_000) {
        let one = delaunay(&points, Options::default()).unwrap().triangulation;
        let parallel = Options { parallel: true, ..Options::default() };
        let two = delaunay(&points, parallel).unwrap().triangulation;
        let slots = |t: &trigrade::triangulation::Triangulation| -> Vec<_> {
            t.triangles().map(|u| (u, t.corners(u), u.half_edges().map(|e| t.across(e)))).collect()
        };
        assert!(slots(&one) == slots(&two), "{name}");
    }
}

// spec: L3
#[test]
fn equal_points_are_merged_into_the_first() {
    let mut random = Random::new(4);
    for (name, points) in clouds::all(80) {
        let mut repeated: Vec<_> = points.iter().flat_map(|&p| [p, p, p]).collect();
        random.shuffle(&mut repeated);
        repeated.push(Point2::new(-repeated[0].x, repeated[0].y));
        let result = agreed(name, &repeated);
        assert!(result.repeated.len() >= 2 * points.len());
        for &[dropped, kept] in &result.repeated {
            assert!(repeated[dropped as usize] == repeated[kept as usize] && kept < dropped);
            let first = repeated.iter().position(|&p| p == repeated[kept as usize]);
            assert_eq!(first, Some(kept as usize));
            assert!(result.triangles().iter().all(|t| !t.contains(&dropped)));
        }
    }
}

// spec: L3
#[test]
fn few_points_and_lines_have_answers() {
    let p = Point2::new;
    for points in [&[][..], &[p(1.0, 2.0)], &[p(0.0, 1.0), p(-0.0, 1.0)]] {
        let result = agreed("few", points);
        assert_eq!(result.triangulation.live_count(), 0);
        assert_eq!(result.repeated.len(), points.len().saturating_sub(1));
    }
    assert_eq!(agreed("two", &[p(1.0, 2.0), p(3.0, 4.0)]).triangulation.live_count(), 2);
    assert_eq!(agreed("line", &clouds::line(50)).triangulation.live_count(), 98);
}

// spec: L3
#[test]
fn points_that_are_not_finite_are_refused() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for engine in Engine::ALL {
            let points = [Point2::new(0.0, 0.0), Point2::new(1.0, bad)];
            let error = delaunay(&points, Options { engine, parallel: false }).unwrap_err();
            assert!(matches!(error, PointsError::NotFinite { index: 1, .. }));
        }
    }
}

#[test]
fn engines_have_names() {
    for engine in Engine::ALL {
        assert_eq!(Engine::named(engine.name()), Some(engine));
    }
    assert_eq!(Engine::named("triangle"), None);
}

// spec: L1
#[test]
fn agrees_with_spade_where_the_answer_is_unique() {
    for seed in 0..20 {
        let points = clouds::uniform(500, seed);
        assert_eq!(with(Engine::Auto, &points).triangles(), by_spade(&points));
    }
}

fn by_spade(points: &[Point2]) -> naive::Triangles {
    let vertices = points.iter().map(|p| spade::Point2::new(p.x, p.y)).collect();
    let theirs = spade::DelaunayTriangulation::<spade::Point2<f64>>::bulk_load_stable(vertices);
    let faces = theirs.expect("points in spade's range");
    let corners = faces.inner_faces().map(|f| f.vertices().map(|v| v.fix().index() as u32));
    let mut triangles: naive::Triangles = corners.map(canonical).collect();
    triangles.sort_unstable();
    triangles
}

/// Coordinates with many coincidences: small integers, powers of two, ulps and extremes.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => (-3_i32..4).prop_map(f64::from),
        2 => (0_u64..4).prop_map(|k| f64::from_bits(1.0_f64.to_bits() + k)),
        1 => (-40_i32..40).prop_map(|k| 2.0_f64.powi(k)),
        1 => -1.0..1.0,
        1 => prop_oneof![Just(1e300), Just(-1e300), Just(1e-310), Just(5e-324)],
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]

    // spec: L1 L2
    #[test]
    fn engines_agree_on_coincidences(
        points in prop::collection::vec((coordinate(), coordinate()), 0..14)
    ) {
        let points: Vec<_> = points.into_iter().map(|(x, y)| Point2::new(x, y)).collect();
        let first = agreed("proptest", &points);
        let distinct = clouds::distinct(points.clone());
        if distinct.len() == points.len() {
            prop_assert_eq!(first.triangles(), naive::delaunay(&points));
        }
    }
}
