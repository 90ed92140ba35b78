//! Times the checker on a generated mesh: `cargo run --release --example check_speed -- 1000 500 1`
//! checks 1000 x 500 quadrilaterals, a million triangles, on one thread; with a further argument
//! `torus` a closed surface of as many.

use std::time::Instant;
use trigrade::check::{CheckOptions, check};
use trigrade::mesh::MeshData;

/// A grid of `columns` x `rows` cells of two triangles, its inner vertices moved a little.
fn grid(columns: u32, rows: u32) -> MeshData {
    let noise = |i: u32| f64::from(i.wrapping_mul(2_654_435_761) >> 16) / 65536.0 - 0.5;
    let point = |i: u32| {
        let (x, y) = (i % (columns + 1), i / (columns + 1));
        let inner = x > 0 && x < columns && y > 0 && y < rows;
        let amount = if inner { 0.4 } else { 0.0 };
        let scale = 1.0 / f64::from(columns);
        let coordinate = |c: u32, salt: u32| (f64::from(c) + amount * noise(i ^ salt)) * scale;
        [coordinate(x, 0), coordinate(y, 0x5bd1_e995), 0.0]
    };
    let points = (0..(columns + 1) * (rows + 1)).map(point).collect();
    let mut triangles = Vec::new();
    for y in 0..rows {
        for x in 0..columns {
            let a = y * (columns + 1) + x;
            let (b, c, d) = (a + 1, a + columns + 2, a + columns + 1);
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    MeshData { points, triangles, ..MeshData::default() }
}

/// A torus of `columns` x `rows` cells of two triangles.
fn torus(columns: u32, rows: u32) -> MeshData {
    let angle = |i: u32, n: u32| std::f64::consts::TAU * f64::from(i) / f64::from(n);
    let point = |i: u32| {
        let (u, v) = (angle(i % columns, columns), angle(i / columns, rows));
        let r = 3.0 + v.cos();
        [r * u.cos(), r * u.sin(), v.sin()]
    };
    let at = |x: u32, y: u32| (y % rows) * columns + x % columns;
    let mut triangles = Vec::new();
    for y in 0..rows {
        for x in 0..columns {
            let (a, b, c, d) = (at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    MeshData { points: (0..columns * rows).map(point).collect(), triangles, ..MeshData::default() }
}

fn main() {
    let mut arguments = std::env::args().skip(1).filter_map(|a| a.parse::<u32>().ok());
    let (columns, rows) = (arguments.next().unwrap_or(1000), arguments.next().unwrap_or(500));
    let threads = arguments.next().unwrap_or(1) as usize;
    let in_space = std::env::args().any(|a| a == "torus");
    let mesh = if in_space { torus(columns, rows) } else { grid(columns, rows) };
    for quality in [false, true] {
        let mut options = CheckOptions::new().threads(threads);
        options.quality = quality;
        let start = Instant::now();
        let report = check(&mesh, None, &options);
        let seconds = start.elapsed().as_secs_f64();
        let nanoseconds = seconds * 1e9 / mesh.triangles.len() as f64;
        println!(
            "{} triangles, quality {quality}, {threads} threads: {seconds:.3} s, {nanoseconds:.1} ns \
             a triangle, {:?}",
            mesh.triangles.len(),
            report.verdict
        );
    }
}
