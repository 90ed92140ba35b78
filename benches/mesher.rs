//! The pipeline's stages beside spade where it does the same job, and the check of the result.
//!
//!     cargo bench --bench mesher
//!     cargo bench --bench mesher -- quality [LEVEL [GROWTH]]  quality over fourteen domains
//!     cargo bench --bench mesher -- worst               the worst cases, each checked
//!     cargo bench --bench mesher -- growth [SIDE]       time and memory over size, squares up to SIDE
//!                                                       segments a side, beside spade

#[path = "domains/mod.rs"]
mod domains;
#[path = "tables/mod.rs"]
mod tables;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group};
use spade::Triangulation as _;
use std::hint::black_box;
use trigrade::background::Background;
use trigrade::check::{CheckOptions, check};
use trigrade::domain::Domain;
use trigrade::domain::validate::{Plc, validate};
use trigrade::improve::ImproveOptions;
use trigrade::mesh::MeshData;
use trigrade::mesher::{Gradation, Options, Unobserved, mesh_plc};
use trigrade::point::Point2;

/// A Koch curve around a triangle: 3 * 4^depth segments, a coast to triangulate.
fn coast(depth: u32) -> Domain {
    let corner = |i: u32| {
        let angle = -f64::from(i) * std::f64::consts::TAU / 3.0;
        Point2::new(libm::cos(angle), libm::sin(angle))
    };
    let mut points: Vec<Point2> = (0..3).map(corner).collect();
    for _ in 0..depth {
        let next = points.iter().cycle().skip(1);
        points = points.iter().zip(next).flat_map(|(&a, &b)| bump(a, b)).collect();
    }
    ring(points)
}

/// A Koch step flattened to 0.25, so that no two bumps touch.
fn bump(a: Point2, b: Point2) -> [Point2; 4] {
    let (dx, dy) = (b.x - a.x, b.y - a.y);
    let along = |t: f64, up: f64| Point2::new(a.x + t * dx - up * dy, a.y + t * dy + up * dx);
    [a, along(0.34, 0.0), along(0.5, 0.25), along(0.66, 0.0)]
}

fn ring(points: Vec<Point2>) -> Domain {
    Domain::of_rings(&[points])
}

fn sound(domain: &Domain) -> Plc {
    validate(domain).expect("the bench's domains are sound")
}

fn options(sweeps: u32) -> Options {
    Options {
        gradation: Gradation::Uniform,
        improve: ImproveOptions { sweeps, ..ImproveOptions::level(u8::from(sweeps > 0)) },
        ..Options::default()
    }
}

fn uniform_square(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("uniform square");
    group.sample_size(10);
    for n in [50, 200] {
        let domain = domains::square(n);
        let plc = sound(&domain);
        let run = |sweeps| mesh_plc(plc.clone(), &options(sweeps), &mut Unobserved);
        let mesh = run(4).expect("a square is meshed").mesh;
        group.throughput(Throughput::Elements(mesh.triangles.len() as u64));
        group.bench_function(BenchmarkId::new("front", n), |b| b.iter(|| black_box(run(0))));
        group.bench_function(BenchmarkId::new("front and improvement", n), |b| {
            b.iter(|| black_box(run(4)));
        });
        group.bench_function(BenchmarkId::new("spade refinement", n), |b| {
            b.iter(|| black_box(spade_refinement(&plc, mesh.triangles.len())));
        });
        let data = MeshData::from(&mesh);
        let one = CheckOptions::new().threads(1);
        group.bench_function(BenchmarkId::new("check", n), |b| {
            b.iter(|| black_box(check(&data, Some(&domain), &one)));
        });
    }
    group.finish();
}

/// Delaunay refinement to about as many triangles; it knows an area but no size field.
fn spade_refinement(plc: &Plc, triangles: usize) -> usize {
    let mut cdt = spade_cdt(plc);
    let area = 1.5 / triangles as f64;
    let parameters = spade::RefinementParameters::<f64>::new()
        .with_max_allowed_area(area)
        .with_max_additional_vertices(triangles)
        .exclude_outer_faces(true);
    cdt.refine(parameters);
    cdt.num_inner_faces()
}

fn spade_cdt(plc: &Plc) -> spade::ConstrainedDelaunayTriangulation<spade::Point2<f64>> {
    let points = plc.points.iter().map(|p| spade::Point2::new(p.x, p.y)).collect();
    let edges = plc.segments.iter().map(|s| s.vertices.map(|v| v as usize)).collect();
    spade::ConstrainedDelaunayTriangulation::bulk_load_cdt(points, edges).expect("finite points")
}

fn background(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("constrained Delaunay");
    group.sample_size(10);
    for depth in [5, 7] {
        let plc = sound(&coast(depth));
        group.throughput(Throughput::Elements(plc.points.len() as u64));
        let size = plc.points.len();
        group.bench_function(BenchmarkId::new("background", size), |b| {
            b.iter(|| black_box(Background::new(&plc)));
        });
        group.bench_function(BenchmarkId::new("spade", size), |b| {
            b.iter(|| black_box(spade_cdt(&plc)));
        });
    }
    group.finish();
}

fn validation(criterion: &mut Criterion) {
    let domain = coast(7);
    let mut group = criterion.benchmark_group("validate");
    group.throughput(Throughput::Elements(domain.points.len() as u64));
    group.sample_size(10);
    group.bench_function("coast", |b| b.iter(|| black_box(validate(&domain))));
    group.finish();
}

criterion_group!(benches, background, uniform_square, validation);

fn main() {
    let arguments: Vec<String> =
        std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let number = |default: u32| arguments.get(1).and_then(|n| n.parse().ok()).unwrap_or(default);
    let growth =
        || arguments.get(2).and_then(|g| g.parse().ok()).unwrap_or(Options::default().growth);
    match arguments.first().map(String::as_str) {
        Some("quality") => tables::quality(number(1).min(3) as u8, growth()),
        Some("worst") => tables::worst(),
        Some("growth") => tables::growth(number(2080), spade_refinement),
        _ => {
            benches();
            Criterion::default().configure_from_args().final_summary();
        }
    }
}
