//! Draws meshes of growing size and prints how long that takes and how large the files are.
//!
//! ```text
//! cargo run --release --example picture_sizes -- OUT_DIR [TRIANGLES...]
//! ```

use spade::{DelaunayTriangulation, Point2, Triangulation};
use std::path::{Path, PathBuf};
use std::time::Instant;
use trigrade::draw::{self, Layer, Options, Panel, Viewer};
use trigrade::mesh::MeshData;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let directory = PathBuf::from(arguments.next().unwrap_or_else(|| "target/pictures".into()));
    std::fs::create_dir_all(&directory)?;
    let sizes: Vec<usize> = arguments.map(|a| a.parse()).collect::<Result<_, _>>()?;
    let sizes = if sizes.is_empty() { vec![10, 1_000, 10_000, 100_000] } else { sizes };
    println!(
        "{:>10} {:>6} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}",
        "triangles", "", "SVG s", "bytes", "PNG s", "bytes", "HTML s", "bytes"
    );
    for &triangles in &sizes {
        for graded in [false, true] {
            let name = if graded { "graded" } else { "even" };
            measure(&delaunay(triangles, graded), name, &directory)?;
        }
    }
    Ok(())
}

fn measure(
    mesh: &MeshData,
    name: &str,
    directory: &Path,
) -> Result<(), Box<dyn std::error::Error>> {
    let n = mesh.triangles.len();
    let layer = Layer::radius_ratio(mesh);
    let panels = [Panel::new(mesh, format!("{name}, Delaunay")).coloured(&layer)];
    let start = Instant::now();
    let svg = draw::svg(&panels, &Options::default())?;
    let svg_seconds = start.elapsed().as_secs_f64();
    std::fs::write(directory.join(format!("{name}-{n}.svg")), &svg)?;
    let start = Instant::now();
    let png = draw::png(&panels, &Options::default())?;
    let png_seconds = start.elapsed().as_secs_f64();
    std::fs::write(directory.join(format!("{name}-{n}.png")), &png)?;
    let start = Instant::now();
    let html = draw::html(&Viewer::new(&format!("{name}-{n}"), mesh))?;
    let html_seconds = start.elapsed().as_secs_f64();
    std::fs::write(directory.join(format!("{name}-{n}.html")), &html)?;
    print!("{n:>10} {name:>6}");
    for (seconds, bytes) in
        [(svg_seconds, svg.len()), (png_seconds, png.len()), (html_seconds, html.len())]
    {
        print!(" {seconds:>9.3} {bytes:>9}");
    }
    println!();
    Ok(())
}

/// The Delaunay triangulation of about half as many points as `triangles`: jittered rows in the
/// unit square, or rings that grow away from a circle.
fn delaunay(triangles: usize, graded: bool) -> MeshData {
    let points = if graded { rings(triangles) } else { rows(triangles) };
    let points = points.into_iter().map(|[x, y]| Point2::new(x, y)).collect();
    let triangulation = DelaunayTriangulation::<Point2<f64>>::bulk_load(points).expect("finite");
    let hole = |corners: [Point2<f64>; 3]| {
        let inner = |p: &Point2<f64>| graded && (p.x * p.x + p.y * p.y) < RADIUS * RADIUS * 1.001;
        corners.iter().all(inner)
    };
    MeshData {
        points: triangulation.vertices().map(|v| [v.position().x, v.position().y, 0.0]).collect(),
        triangles: triangulation
            .inner_faces()
            .filter(|f| !hole(f.positions()))
            .map(|f| f.vertices().map(|v| v.fix().index() as u32))
            .collect(),
        ..MeshData::default()
    }
}

fn rows(triangles: usize) -> Vec<[f64; 2]> {
    let side = ((triangles as f64 / 2.0).sqrt() as usize).max(2);
    let mut noise = Noise(1);
    let mut points = Vec::new();
    for i in 0..=side {
        for j in 0..=side {
            let on_rim = |k: usize| k == 0 || k == side;
            let mut jitter = |rim| if rim { 0.0 } else { 0.6 * (noise.next() - 0.5) };
            let (dx, dy) = (jitter(on_rim(i)), jitter(on_rim(j)));
            points.push([(i as f64 + dx) / side as f64, (j as f64 + dy) / side as f64]);
        }
    }
    points
}

/// Radius of the hole around which the graded mesh is dense.
const RADIUS: f64 = 0.02;

fn rings(triangles: usize) -> Vec<[f64; 2]> {
    // Each ring has as many points, so elements keep their shape while they grow.
    let around = ((triangles as f64 / 2.0 / 0.62).sqrt() as usize).max(5);
    let growth = 1.0 + 5.5 / around as f64;
    let (mut radius, mut points, mut odd) = (RADIUS, Vec::new(), false);
    while radius < 1.0 {
        for k in 0..around {
            let shift = if odd { 0.5 } else { 0.0 };
            let angle = (k as f64 + shift) / around as f64 * std::f64::consts::TAU;
            points.push([radius * angle.cos(), radius * angle.sin()]);
        }
        radius *= growth;
        odd = !odd;
    }
    points
}

/// A fixed sequence in [0, 1) (Knuth's MMIX generator).
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}
