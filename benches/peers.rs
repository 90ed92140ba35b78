//! Delaunay triangulation beside spade and delaunator: nanoseconds a point, in one run.
//!
//! `cargo bench --bench peers [-- POINTS [NAME]]`

#[path = "../tests/delaunay/clouds.rs"]
#[allow(dead_code)]
mod clouds;

use spade::Triangulation as _;
use std::hint::black_box;
use std::time::Instant;
use trigrade::point::Point2;

fn time<T>(points: usize, mut run: impl FnMut() -> T) -> f64 {
    let mut best = f64::INFINITY;
    let repeats = (2_000_000 / points.max(1)).clamp(1, 10);
    for _ in 0..repeats {
        let start = Instant::now();
        black_box(run());
        best = best.min(start.elapsed().as_secs_f64());
    }
    best * 1e9 / points as f64
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
    println!("{:<16} {:>9} {:>8} {:>8} {:>8} {:>8} {:>10}", "ns/point", "points", "fast", "fast 2", "lawson", "spade", "delaunator");
    for (name, points) in clouds::all(count) {
        if only.as_ref().is_some_and(|o| o != name) {
            continue;
        }
        let n = points.len();
        let fast = time(n, || trigrade::delaunay::fast_for_now(&points, false));
        let two = time(n, || trigrade::delaunay::fast_for_now(&points, true));
        let full = engines == "all";
        let lawson = if full { time(n, || trigrade::delaunay::lawson_for_now(&points)) } else { 0.0 };
        let slow = matches!(name, "axis cross" | "parabola" | "two circles" | "extremes" | "circle") && n > 20_000;
        let theirs = if slow || name == "extremes" { f64::NAN } else { time(n, || spade(&points)) };
        let copied: Vec<_> = points.iter().map(|p| delaunator::Point { x: p.x, y: p.y }).collect();
        let last = if full && !slow { time(n, || delaunator(&copied)) } else { f64::NAN };
        println!("{name:<16} {n:>9} {fast:>8.0} {two:>8.0} {lawson:>8.0} {theirs:>8.0} {last:>10.0}");
    }
}
