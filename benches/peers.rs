//! Delaunay triangulation beside spade and delaunator: nanoseconds a point, in one run.
//!
//! `cargo bench --bench peers [-- POINTS [NAME]]`

#[path = "../tests/delaunay/clouds.rs"]
#[allow(dead_code)]
mod clouds;

use spade::Triangulation as _;
use std::hint::black_box;
use std::time::Instant;
use trigrade::delaunay::{Engine, Options, delaunay};
use trigrade::point::Point2;

/// Nanoseconds this thread has had a processor, where the system tells (Linux): on a machine that
/// does other work too, the clock on the wall would measure that.
fn on_processor() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    text.split_whitespace().next()?.parse().ok()
}

fn best<T>(points: usize, now: impl Fn() -> f64, mut run: impl FnMut() -> T) -> f64 {
    let repeats = (3_000_000 / points.max(1)).clamp(2, 10);
    let once = |_| {
        let start = now();
        black_box(run());
        now() - start
    };
    (0..repeats).map(once).fold(f64::INFINITY, f64::min) / points as f64
}

/// Nanoseconds a point on one processor, best of a few runs.
fn time<T>(points: usize, run: impl FnMut() -> T) -> f64 {
    if on_processor().is_some() {
        best(points, || on_processor().unwrap(), run)
    } else {
        time_on_wall(points, run)
    }
}

fn time_on_wall<T>(points: usize, run: impl FnMut() -> T) -> f64 {
    let origin = Instant::now();
    best(points, || origin.elapsed().as_secs_f64() * 1e9, run)
}

fn spade(points: &[Point2]) -> usize {
    let points = points.iter().map(|p| spade::Point2::new(p.x, p.y)).collect();
    spade::DelaunayTriangulation::<spade::Point2<f64>>::bulk_load(points).unwrap().num_inner_faces()
}

fn delaunator(points: &[delaunator::Point]) -> usize {
    delaunator::triangulate(points).triangles.len()
}

fn main() {
    let mut arguments = std::env::args().skip(1).filter(|a| a != "--bench");
    let count = arguments.next().and_then(|a| a.parse().ok()).unwrap_or(100_000);
    let only = arguments.next();
    let engines = arguments.next().unwrap_or("all".into());
    println!(
        "{:<16} {:>9} {:>8} {:>8} {:>8} {:>8} {:>10}",
        "ns/point", "points", "fast", "fast 2", "lawson", "spade", "delaunator"
    );
    for (name, points) in clouds::all(count) {
        if only.as_ref().is_some_and(|o| o != name) {
            continue;
        }
        let n = points.len();
        let fast = time(n, || delaunay(&points, Options::default()));
        let two =
            time_on_wall(n, || delaunay(&points, Options { parallel: true, ..Options::default() }));
        let full = engines == "all";
        let lawson = if full {
            time(n, || delaunay(&points, Options { engine: Engine::Lawson, parallel: false }))
        } else {
            0.0
        };
        let slow =
            matches!(name, "axis cross" | "parabola" | "two circles" | "extremes" | "circle")
                && n > 20_000;
        let theirs = if slow || name == "extremes" { f64::NAN } else { time(n, || spade(&points)) };
        let copied: Vec<_> = points.iter().map(|p| delaunator::Point { x: p.x, y: p.y }).collect();
        let last = if full && !slow { time(n, || delaunator(&copied)) } else { f64::NAN };
        println!(
            "{name:<16} {n:>9} {fast:>8.0} {two:>8.0} {lawson:>8.0} {theirs:>8.0} {last:>10.0}"
        );
    }
}
