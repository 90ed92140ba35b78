//! Refinement beside spade's, in one run on one core: processor time, best of three.
//!
//!     cargo bench --bench refine                    a unit square to a million triangles
//!     cargo bench --bench refine -- square 100000   to as many
//!     cargo bench --bench refine -- angles 30       squares and coasts by their smallest angle
//!     cargo bench --bench refine -- once 1000000    ours alone, once, for instruction counts

#[path = "../tests/delaunay/clouds.rs"]
#[allow(dead_code)]
mod clouds;

use clouds::Random;
use spade::Triangulation as _;
use std::hint::black_box;
use std::time::Instant;
use trigrade::background::Background;
use trigrade::domain::validate::{Plc, validate};
use trigrade::domain::{Domain, Loop, LoopRole};
use trigrade::point::Point2;
use trigrade::refine::{AreaBound, RefineOptions, Refined, refine};

type SpadeCdt = spade::ConstrainedDelaunayTriangulation<spade::Point2<f64>>;

/// Nanoseconds of processor time that this process has used (Linux), else of time on the wall.
fn clock(origin: Instant) -> f64 {
    let text = std::fs::read_to_string("/proc/self/schedstat").ok();
    let used = text.and_then(|t| t.split_whitespace().next()?.parse::<f64>().ok());
    used.unwrap_or_else(|| origin.elapsed().as_secs_f64() * 1e9)
}

/// Best of three, in seconds, and the last answer; `prepare` is not timed.
fn time<S, T>(prepare: impl Fn() -> S, run: impl Fn(S) -> T) -> (f64, T) {
    let origin = Instant::now();
    let mut best = f64::INFINITY;
    let mut answer = None;
    for _ in 0..3 {
        let start = prepare();
        let before = clock(origin);
        answer = Some(black_box(run(start)));
        best = best.min((clock(origin) - before) / 1e9);
    }
    (best, answer.expect("three runs"))
}

fn ring(domain: &mut Domain, points: impl Iterator<Item = Point2>) {
    let first = domain.points.len() as u32;
    domain.points.extend(points);
    let vertices = (first..domain.points.len() as u32).collect();
    domain.loops.push(Loop::new(vertices, 1, LoopRole::Any));
}

fn square() -> Domain {
    let mut domain = Domain::new(Vec::new());
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    ring(&mut domain, corners.into_iter().map(Point2::from));
    domain
}

/// A Koch curve flattened to 0.25, so that no two bumps touch: corners of 65 degrees and more.
fn koch(depth: u32) -> Domain {
    let corner = |i: u32| {
        let angle = -f64::from(i) * std::f64::consts::TAU / 3.0;
        Point2::new(libm::cos(angle), libm::sin(angle))
    };
    let bump = |a: Point2, b: Point2| {
        let (dx, dy) = (b.x - a.x, b.y - a.y);
        let along =
            move |t: f64, up: f64| Point2::new(a.x + t * dx - up * dy, a.y + t * dy + up * dx);
        [a, along(0.34, 0.0), along(0.5, 0.25), along(0.66, 0.0)]
    };
    let mut points: Vec<Point2> = (0..3).map(corner).collect();
    for _ in 0..depth {
        let next = points.iter().cycle().skip(1);
        points = points.iter().zip(next).flat_map(|(&a, &b)| bump(a, b)).collect();
    }
    let mut domain = Domain::new(Vec::new());
    ring(&mut domain, points.into_iter());
    domain
}

/// A shore all of needles, with a hundred islands, none crossing itself or another.
fn needles(vertices: usize) -> Domain {
    let mut domain = Domain::new(Vec::new());
    let mut random = Random::new(6);
    let mut shore = |centre: Point2, radius: f64, n: usize| {
        let mut rough = 0.0;
        let points: Vec<Point2> = (0..n)
            .map(|i| {
                rough = 0.98 * rough + 0.02 * (random.unit() - 0.5);
                let r = radius * (1.0 + rough + 0.001 * random.unit());
                let angle = std::f64::consts::TAU * i as f64 / n as f64;
                let (x, y) = (libm::cos(angle), libm::sin(angle));
                Point2::new(centre.x + r * x, centre.y + r * y)
            })
            .collect();
        ring(&mut domain, points.into_iter());
    };
    shore(Point2::new(0.0, 0.0), 2.0, vertices / 2);
    for i in 0..100 {
        let centre = Point2::new(f64::from(i % 10 - 5) / 5.0, f64::from(i / 10 - 5) / 5.0);
        shore(centre, 0.07, vertices / 200);
    }
    domain
}

fn spade_cdt(plc: &Plc) -> SpadeCdt {
    let points = plc.points.iter().map(|p| spade::Point2::new(p.x, p.y)).collect();
    let edges = plc.segments.iter().map(|s| s.vertices.map(|v| v as usize)).collect();
    SpadeCdt::bulk_load_cdt(points, edges).expect("finite points")
}

fn ours(background: &Background, area: AreaBound<'_>, angle_min_deg: f64) -> Refined {
    let options = RefineOptions {
        area,
        angle_min_deg,
        split_boundary: true,
        triangles_max: 50_000_000,
        quantum: None,
    };
    refine(background, &options, &mut |_| true).expect("the limit is high")
}

/// spade's refinement; the number of triangles inside.
fn spade(mut cdt: SpadeCdt, area: Option<f64>, angle_deg: f64) -> (usize, SpadeCdt) {
    let mut parameters = spade::RefinementParameters::<f64>::new()
        .with_angle_limit(spade::AngleLimit::from_deg(angle_deg))
        .with_max_additional_vertices(20_000_000)
        .exclude_outer_faces(true);
    if let Some(area) = area {
        parameters = parameters.with_max_allowed_area(area);
    }
    let result = cdt.refine(parameters);
    (cdt.num_inner_faces() - result.excluded_faces.len(), cdt)
}

/// The largest area that gives about as many triangles.
fn calibrated(count: usize, triangles: impl Fn(f64) -> usize) -> f64 {
    let mut area = 1.7 / count as f64;
    for _ in 0..3 {
        area *= triangles(area) as f64 / count as f64;
    }
    area
}

fn by_area(count: usize) {
    let plc = validate(&square()).expect("sound");
    let background = Background::new(&plc).expect("sound");
    println!("a unit square by area      triangles     s    spade triangles     s   ratio");
    for angle in [0.0, 20.0] {
        let our_area = calibrated(count, |area| {
            ours(&background, AreaBound::Constant(area), angle).mesh.live_count()
        });
        let their_area = calibrated(count, |area| spade(spade_cdt(&plc), Some(area), angle).0);
        let (our_time, refined) =
            time(|| (), |()| ours(&background, AreaBound::Constant(our_area), angle));
        let (their_time, (theirs, _)) =
            time(|| spade_cdt(&plc), |cdt| spade(cdt, Some(their_area), angle));
        println!(
            "angle at least {angle:>4}     {:>10} {our_time:>6.3} {theirs:>14} {their_time:>8.3} {:>6.2}",
            refined.mesh.live_count(),
            our_time / their_time,
        );
    }
}

fn by_angle(angle: f64) {
    println!("angle at least {angle:<4}   vertices  triangles     s    spade triangles     s");
    let coasts = [("koch coast", koch(8)), ("coast of needles", needles(20_000))];
    for (name, domain) in coasts {
        let plc = validate(&domain).expect("sound");
        let background = Background::new(&plc).expect("sound");
        let (our_time, refined) = time(|| (), |()| ours(&background, AreaBound::None, angle));
        let (their_time, (theirs, _)) = time(|| spade_cdt(&plc), |cdt| spade(cdt, None, angle));
        println!(
            "{name:<18}{:>10} {:>10} {our_time:>6.3} {theirs:>14} {their_time:>8.3}",
            plc.points.len(),
            refined.mesh.live_count(),
        );
        println!("                  {:?}", refined.stats);
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let argument = |i: usize| arguments.get(i).map(String::as_str);
    let number = |default: f64| argument(1).and_then(|a| a.parse().ok()).unwrap_or(default);
    match argument(0).unwrap_or("square") {
        "angles" => by_angle(number(30.0)),
        "export" => {
            let domain = if argument(1) == Some("needles") { needles(20_000) } else { koch(8) };
            domain.points.iter().for_each(|p| println!("{:?} {:?}", p.x, p.y));
        }
        "once" => {
            let background = Background::new(&validate(&square()).expect("sound")).expect("sound");
            let area = AreaBound::Constant(1.7 / number(1e6));
            let refined = black_box(ours(&background, area, 0.0));
            println!("{} {:?}", refined.mesh.live_count(), refined.stats);
        }
        _ => by_area(number(1e6) as usize),
    }
}
