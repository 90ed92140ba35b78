//! The checker on generated meshes: `cargo bench --bench check`. Throughput is triangles per second.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use trigrade::check::{CheckOptions, check};
use trigrade::mesh::MeshData;

/// Two triangles for each cell of a grid in which vertices are at `point`; cells wrap around.
fn cells(columns: u32, rows: u32, index: impl Fn(u32, u32) -> u32) -> Vec<[u32; 3]> {
    let cell = |i: u32| {
        let (x, y) = (i % columns, i / columns);
        let [a, b] = [index(x, y), index(x + 1, y)];
        let [c, d] = [index(x + 1, y + 1), index(x, y + 1)];
        [[a, b, c], [a, c, d]]
    };
    (0..columns * rows).flat_map(cell).collect()
}

/// A plane grid, its inner vertices moved a little.
fn grid(columns: u32, rows: u32) -> MeshData {
    let noise = |i: u32| f64::from(i.wrapping_mul(2_654_435_761) >> 16) / 65536.0 - 0.5;
    let point = |i: u32| {
        let (x, y) = (i % (columns + 1), i / (columns + 1));
        let inner = x > 0 && x < columns && y > 0 && y < rows;
        let amount = if inner { 0.4 } else { 0.0 };
        let at = |c: u32, salt: u32| (f64::from(c) + amount * noise(i ^ salt)) / f64::from(columns);
        [at(x, 0), at(y, 0x5bd1_e995), 0.0]
    };
    MeshData {
        points: (0..(columns + 1) * (rows + 1)).map(point).collect(),
        triangles: cells(columns, rows, |x, y| y * (columns + 1) + x),
        ..MeshData::default()
    }
}

/// A torus.
fn torus(columns: u32, rows: u32) -> MeshData {
    let angle = |i: u32, n: u32| std::f64::consts::TAU * f64::from(i) / f64::from(n);
    let point = |i: u32| {
        let (u, v) = (angle(i % columns, columns), angle(i / columns, rows));
        let r = 3.0 + v.cos();
        [r * u.cos(), r * u.sin(), v.sin()]
    };
    MeshData {
        points: (0..columns * rows).map(point).collect(),
        triangles: cells(columns, rows, |x, y| (y % rows) * columns + x % columns),
        ..MeshData::default()
    }
}

fn benchmark(c: &mut Criterion) {
    let mut exact_only = CheckOptions::new();
    exact_only.quality = false;
    let meshes = [("plane", grid(400, 250)), ("torus", torus(400, 250))];
    let mut group = c.benchmark_group("check");
    group.sample_size(10);
    for (name, mesh) in &meshes {
        assert!(check(mesh, None, &exact_only).passed());
        group.throughput(Throughput::Elements(mesh.triangles.len() as u64));
        for threads in [1, 2] {
            for (what, options) in [("exact", exact_only.clone()), ("quality", CheckOptions::new())]
            {
                let options = options.threads(threads);
                let id = BenchmarkId::new(format!("{name}/{what}"), threads);
                group.bench_function(id, |b| b.iter(|| check(black_box(mesh), None, &options)));
            }
        }
    }
    group.finish();
}

criterion_group!(benches, benchmark);
criterion_main!(benches);
