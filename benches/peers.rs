//! Delaunay triangulation beside spade and delaunator, in one run.
//!
//!     cargo bench --bench peers -- points 1000000            every cloud
//!     cargo bench --bench peers -- points 1000000 uniform    one of them
//!     cargo bench --bench peers -- engines 10000             the engines beside each other
//!     cargo bench --bench peers -- growth 10000000           10^4, 10^5, ... uniform points
//!     cargo bench --bench peers -- segments                  constrained, beside spade
//!
//! Nanoseconds a point on one processor, best of a few runs; `auto 2` is wall time with all threads.

#[path = "../tests/delaunay/clouds.rs"]
#[allow(dead_code)]
mod clouds;

use clouds::Random;
use spade::Triangulation as _;
use std::hint::black_box;
use std::time::Instant;
use trigrade::delaunay::{Engine, Options, cdt, cdt_with, delaunay};
use trigrade::point::Point2;

/// Nanoseconds this thread has had a processor, where the system tells (Linux): on a machine that
/// does other work too, the clock on the wall would measure that.
fn on_processor() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    text.split_whitespace().next()?.parse().ok()
}

/// Best of a few samples, each of runs over about a million points: the system counts processor
/// time in ticks of milliseconds.
fn best<T>(points: usize, now: impl Fn() -> f64, mut run: impl FnMut() -> T) -> f64 {
    let runs = (1_000_000 / points.max(1)).max(1);
    let samples = if points < 5_000_000 { 3 } else { 1 };
    let sample = |_| {
        let start = now();
        (0..runs).for_each(|_| drop(black_box(run())));
        now() - start
    };
    (0..samples).map(sample).fold(f64::INFINITY, f64::min) / (points * runs) as f64
}

fn time<T>(points: usize, run: impl FnMut() -> T) -> f64 {
    if on_processor().is_some() {
        best(points, || on_processor().unwrap_or_default(), run)
    } else {
        time_on_wall(points, run)
    }
}

fn time_on_wall<T>(points: usize, run: impl FnMut() -> T) -> f64 {
    let origin = Instant::now();
    best(points, || origin.elapsed().as_secs_f64() * 1e9, run)
}

/// A field of /proc/self/status in bytes (Linux).
fn status(field: &str) -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find(|line| line.starts_with(field))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? * 1024.0)
}

/// Bytes a point that a run needs at its peak beyond what is there before.
fn memory<T>(points: usize, run: impl FnOnce() -> T) -> f64 {
    // Resets the high-water mark.
    if std::fs::write("/proc/self/clear_refs", "5").is_err() {
        return f64::NAN;
    }
    let before = status("VmRSS").unwrap_or(f64::NAN);
    black_box(run());
    (status("VmHWM").unwrap_or(f64::NAN) - before) / points as f64
}

fn spade(points: &[Point2]) -> usize {
    let points = points.iter().map(|p| spade::Point2::new(p.x, p.y)).collect();
    let result = spade::DelaunayTriangulation::<spade::Point2<f64>>::bulk_load(points);
    result.map_or(0, |t| t.num_inner_faces())
}

fn spade_cdt(points: &[Point2], segments: &[[u32; 2]]) -> usize {
    let points = points.iter().map(|p| spade::Point2::new(p.x, p.y)).collect();
    let segments = segments.iter().map(|s| s.map(|v| v as usize)).collect();
    let result = spade::ConstrainedDelaunayTriangulation::<spade::Point2<f64>>::bulk_load_cdt(
        points, segments,
    );
    result.map_or(0, |t| t.num_inner_faces())
}

fn delaunator(points: &[Point2]) -> f64 {
    let points: Vec<_> = points.iter().map(|p| delaunator::Point { x: p.x, y: p.y }).collect();
    time(points.len(), || delaunator::triangulate(&points))
}

fn auto(points: &[Point2], parallel: bool) -> f64 {
    let options = Options { parallel, ..Options::default() };
    if parallel {
        time_on_wall(points.len(), || delaunay(points, options))
    } else {
        time(points.len(), || delaunay(points, options))
    }
}

/// Peers take seconds to minutes on these.
fn slow_for_peers(name: &str, n: usize) -> bool {
    let slow = ["axis cross", "parabola", "two circles", "circle", "line and one", "line"];
    let out_of_range = ["extremes", "ulps at 0.5", "ulps at 1"];
    out_of_range.contains(&name) || (n > 20_000 && slow.contains(&name))
}

fn point_clouds(clouds: &[(&str, Vec<Point2>)]) {
    println!("ns/point               points     auto   auto 2    spade  delaunator  bytes/point");
    for (name, points) in clouds {
        let n = points.len();
        let bytes = memory(n, || delaunay(points, Options::default()));
        let (one, two) = (auto(points, false), auto(points, true));
        let slow = slow_for_peers(name, n);
        let spade = if slow { f64::NAN } else { time(n, || spade(points)) };
        let delaunator = if slow { f64::NAN } else { delaunator(points) };
        println!(
            "{name:<18} {n:>10} {one:>8.0} {two:>8.0} {spade:>8.0} {delaunator:>11.0} {bytes:>12.0}"
        );
    }
}

fn engines(count: usize) {
    print!("{:<18}", "ns/point");
    Engine::ALL.iter().for_each(|e| print!(" {:>14}", e.name()));
    println!();
    for (name, points) in clouds::all(count) {
        print!("{name:<18}");
        for engine in Engine::ALL {
            print!(
                " {:>14.0}",
                time(points.len(), || delaunay(&points, Options { engine, parallel: false }))
            );
        }
        println!();
    }
}

/// A closed ragged coast around each centre, none crossing itself or another.
fn coast(vertices: usize) -> (Vec<Point2>, Vec<[u32; 2]>) {
    let (mut points, mut segments) = (Vec::new(), Vec::new());
    let mut random = Random::new(6);
    let mut ring = |centre: Point2, radius: f64, n: usize| {
        let first = points.len() as u32;
        let mut rough = 0.0;
        for i in 0..n {
            rough = 0.98 * rough + 0.02 * (random.unit() - 0.5);
            let r = radius * (1.0 + rough + 0.001 * random.unit());
            let angle = std::f64::consts::TAU * i as f64 / n as f64;
            points.push(Point2::new(
                centre.x + r * libm::cos(angle),
                centre.y + r * libm::sin(angle),
            ));
            segments.push([first + i as u32, first + (i as u32 + 1) % n as u32]);
        }
    };
    ring(Point2::new(0.0, 0.0), 2.0, vertices / 2);
    for i in 0..100 {
        let centre = Point2::new(f64::from(i % 10 - 5) / 5.0, f64::from(i / 10 - 5) / 5.0);
        ring(centre, 0.07, vertices / 200);
    }
    (points, segments)
}

/// Random points and `count` long segments side by side that cross none of each other.
fn long_segments(points: usize, count: usize) -> (Vec<Point2>, Vec<[u32; 2]>) {
    let mut cloud = clouds::uniform(points, 8);
    let mut segments = Vec::new();
    for i in 0..count {
        let y = (i as f64 + 0.5) / count as f64;
        segments.push([cloud.len() as u32, cloud.len() as u32 + 1]);
        cloud.extend([Point2::new(0.01, y), Point2::new(0.99, y + 0.2 / count as f64)]);
    }
    (cloud, segments)
}

fn constrained() {
    println!("ms                     points segments    cdt  by halves  delaunay    spade");
    let inputs = [("coast", coast(243_000)), ("long segments", long_segments(100_000, 300))];
    for (name, (points, segments)) in inputs {
        let n = points.len();
        let ms = |ns: f64| ns * n as f64 / 1e6;
        let ours = ms(time(n, || cdt(&points, &segments).expect("sound")));
        let halves = Options { engine: Engine::DivideConquer, ..Options::default() };
        let halves = ms(time(n, || cdt_with(&points, &segments, halves).expect("sound")));
        let plain = ms(time(n, || delaunay(&points, Options::default())));
        let theirs = ms(time(n, || spade_cdt(&points, &segments)));
        println!(
            "{name:<18} {n:>10} {:>8} {ours:>6.0} {halves:>10.0} {plain:>9.0} {theirs:>8.0}",
            segments.len()
        );
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let argument = |i: usize| arguments.get(i).map(String::as_str);
    let count = argument(1).and_then(|a| a.parse().ok()).unwrap_or(100_000);
    match argument(0).unwrap_or("points") {
        "engines" => engines(count),
        "segments" => constrained(),
        "growth" => {
            let sizes = (4..).map(|k| 10_usize.pow(k)).take_while(|&n| n <= count);
            let clouds: Vec<_> = sizes.map(|n| ("uniform", clouds::uniform(n, 1))).collect();
            point_clouds(&clouds);
        }
        _ => {
            let wanted = |name: &str| argument(2).is_none_or(|only| only == name);
            let mut clouds = clouds::all(count);
            let thrice = clouds::uniform(count.div_ceil(3), 3).into_iter().flat_map(|p| [p; 3]);
            clouds.push(("duplicates", thrice.collect()));
            clouds.retain(|(name, _)| wanted(name));
            point_clouds(&clouds);
        }
    }
}
