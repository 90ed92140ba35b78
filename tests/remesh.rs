//! Remeshing of triangulated surfaces: spheres, tori, cylinders and cubes, whole, cut open and broken.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use trigrade::check::{CheckOptions, Dimension, Metric, Report, check};
use trigrade::mesh::{MarkedEdge, MeshData};
use trigrade::remesh::{RemeshError, RemeshOptions, Remeshed, euler_number, remesh};
use trigrade::vector::{Vector, add, cross, distance, dot, norm, scale, sub, unit};

fn mesh(points: Vec<Vector>, triangles: Vec<[u32; 3]>) -> MeshData {
    MeshData { points, triangles, ..MeshData::default() }
}

/// The unit sphere: an icosahedron whose triangles are cut in four `levels` times.
fn icosphere(levels: u32) -> MeshData {
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let mut points: Vec<Vector> = Vec::new();
    for (s, t) in [(-1.0, -golden), (-1.0, golden), (1.0, -golden), (1.0, golden)] {
        points.extend([[0.0, s, t], [s, t, 0.0], [t, 0.0, s]]);
    }
    let near = |a: usize, b: usize| distance(points[a], points[b]) < 2.01;
    let mut triangles = Vec::new();
    for k in 0..12 * 12 * 12_usize {
        let (a, b, c) = (k / 144, k / 12 % 12, k % 12);
        if a < b && b < c && near(a, b) && near(b, c) && near(c, a) {
            let normal = cross(sub(points[b], points[a]), sub(points[c], points[a]));
            let [a, b, c] = [a, b, c].map(|v| v as u32);
            triangles.push(if dot(normal, points[a as usize]) > 0.0 {
                [a, b, c]
            } else {
                [a, c, b]
            });
        }
    }
    points.iter_mut().for_each(|p| *p = unit(*p).expect("a direction"));
    for _ in 0..levels {
        triangles = quartered(&mut points, &triangles);
    }
    mesh(points, triangles)
}

fn quartered(points: &mut Vec<Vector>, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut middles = BTreeMap::new();
    let mut new = Vec::new();
    for &[a, b, c] in triangles {
        let mut middle = |a: u32, b: u32| {
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                let sum = add(points[a as usize], points[b as usize]);
                points.push(unit(sum).expect("a direction"));
                points.len() as u32 - 1
            })
        };
        let (x, y, z) = (middle(a, b), middle(b, c), middle(c, a));
        new.extend([[a, x, z], [x, b, y], [z, y, c], [x, y, z]]);
    }
    new
}

/// A torus of `n` times `m` cells.
fn torus(n: u32, m: u32) -> MeshData {
    let mut torus = MeshData::default();
    for (i, j) in (0..n * m).map(|k| (k / m, k % m)) {
        let (u, v) = (TAU * f64::from(i) / f64::from(n), TAU * f64::from(j) / f64::from(m));
        let radius = 1.0 + 0.4 * libm::cos(v);
        torus.points.push([radius * libm::cos(u), radius * libm::sin(u), 0.4 * libm::sin(v)]);
        let at = |i: u32, j: u32| (i % n) * m + j % m;
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        torus.triangles.extend([[a, b, c], [a, c, d]]);
    }
    torus
}

/// A cylinder of `n` sides with caps: long triangles with sharp rims.
fn cylinder(n: u32) -> MeshData {
    let mut points = Vec::new();
    for k in 0..2 * n {
        let angle = TAU * f64::from(k % n) / f64::from(n);
        points.push([libm::cos(angle), libm::sin(angle), f64::from(k / n) * 2.0]);
    }
    points.extend([[0.0, 0.0, 0.0], [0.0, 0.0, 2.0]]);
    let cell = |i: u32| {
        let j = (i + 1) % n;
        [[i, j, n + j], [i, n + j, n + i], [2 * n, j, i], [2 * n + 1, n + i, n + j]]
    };
    mesh(points, (0..n).flat_map(cell).collect())
}

/// The unit cube, two triangles a face.
fn cube() -> MeshData {
    let points = (0..8_u32).map(|k| [0, 1, 2].map(|i| f64::from(k >> i & 1))).collect();
    let quads =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    mesh(points, quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
}

fn in_space(mesh: &MeshData, closed: bool) -> Report {
    check(mesh, None, &CheckOptions::new().dimension(Dimension::Space).closed(closed))
}

/// Remeshes; the result is sound, has the topology of the input, lies on it, and its R/2r are
/// within bounds of mean, 99 % and largest.
fn sound(name: &str, input: &MeshData, options: &RemeshOptions, bounds: [f64; 3]) -> Remeshed {
    let done = remesh(input, options).unwrap_or_else(|e| panic!("{name}: {e}"));
    let closed = in_space(input, false).statistics.boundary_edges == 0;
    let report = in_space(&done.mesh, closed);
    assert!(report.passed(), "{name}: {:?}", report.findings.first());
    assert_eq!(euler_number(&done.mesh.triangles), euler_number(&input.triangles), "{name}");
    assert!(done.deviation.vertices <= 1e-9 * done.diagonal, "{name}: {:?}", done.deviation);
    let quality = report.quality.expect("measured");
    let ratio = quality.summary(Metric::RadiusRatio).expect("measured");
    let figures = [ratio.mean, ratio.percentile_99, ratio.max].map(|x| x.expect("finite"));
    for (figure, bound) in figures.iter().zip(bounds) {
        assert!(*figure <= bound, "{name}: {figures:?} for {bounds:?}");
    }
    done
}

// spec: U3 U4 U5 U6 U7
#[test]
fn smooth_surfaces_get_equilateral_triangles() {
    let bounds = [1.03, 1.2, 2.0];
    for (name, input, h) in [
        ("fine sphere", icosphere(5), 0.1),
        ("coarse sphere", icosphere(2), 0.08),
        ("torus", torus(120, 50), 0.08),
        ("torus of long triangles", torus(24, 120), 0.08),
    ] {
        let done = sound(name, &input, &RemeshOptions::new(h), bounds);
        assert_eq!((done.curves, done.corners, done.parts), (0, 0, 1), "{name}");
        // A chord of a sphere of radius 1, and twice that for what the input itself leaves.
        assert!(done.deviation.to_input <= 2.0 * h * h, "{name}: {:?}", done.deviation);
        assert!(done.deviation.from_input <= 2.0 * h * h, "{name}: {:?}", done.deviation);
        let area: f64 = area(&input) / (0.25 * 3.0_f64.sqrt() * h * h);
        let count = done.mesh.triangles.len() as f64;
        assert!(count > 0.8 * area && count < 1.6 * area, "{name}: {count} for {area}");
    }
}

fn area(mesh: &MeshData) -> f64 {
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| mesh.points[v as usize]);
        0.5 * norm(cross(sub(b, a), sub(c, a)))
    };
    mesh.triangles.iter().map(area).sum()
}

// spec: U2 U4 U5 U7
#[test]
fn sharp_edges_and_corners_stay() {
    let done = sound("cube", &cube(), &RemeshOptions::new(0.1), [1.04, 1.3, 1.7]);
    assert_eq!((done.curves, done.corners, done.parts), (12, 8, 6));
    for corner in cube().points {
        assert!(done.mesh.points.contains(&corner), "{corner:?} is kept to the bit");
    }
    assert!((area(&done.mesh) - 6.0).abs() < 1e-12, "faces stay planes");
    let done = sound("cylinder", &cylinder(64), &RemeshOptions::new(0.12), [1.04, 1.25, 2.0]);
    assert_eq!((done.curves, done.corners, done.parts), (2, 0, 3));
    let on_rim = |p: &&Vector| (p[2] == 0.0 || p[2] == 2.0) && p[0].hypot(p[1]) > 0.99;
    // The rims are 6.28 long: 52 edges of 0.12 each.
    assert_eq!(done.mesh.points.iter().filter(on_rim).count(), 2 * 52);
    let rough = sound("coarse cylinder", &cylinder(64), &RemeshOptions::new(0.3), [1.05, 1.4, 2.0]);
    assert_eq!(rough.mesh.points.iter().filter(on_rim).count(), 2 * 21);
}

// spec: U7 U8
#[test]
fn open_surfaces_keep_their_border_and_marks_stay() {
    let mut half = torus(120, 50);
    half.triangles.truncate(6000);
    let report = in_space(&half, false);
    let done = sound("half torus", &half, &RemeshOptions::new(0.08), [1.04, 1.25, 2.0]);
    assert_eq!(done.curves, 2);
    assert_eq!(report.statistics.boundary_loops, 2);
    let report = in_space(&done.mesh, false);
    assert_eq!(report.statistics.boundary_loops, 2);
    assert!(report.statistics.boundary_edges < 80, "{}", report.statistics.boundary_edges);
    let mut marked = cube();
    marked.regions = (0..12).map(|t| 10 + t / 4).collect();
    marked.edges = vec![MarkedEdge { vertices: [0, 1], marker: 5 }];
    let done = sound("marked cube", &marked, &RemeshOptions::new(0.2), [1.1, 1.6, 2.0]);
    for region in [10, 11, 12] {
        let of = |mesh: &MeshData| {
            let own = mesh.triangles.iter().zip(&mesh.regions).filter(|(_, r)| **r == region);
            area(&MeshData { triangles: own.map(|(t, _)| *t).collect(), ..mesh.clone() })
        };
        assert!((of(&done.mesh) - of(&marked)).abs() < 1e-12, "region {region}");
    }
    let length: f64 = done
        .mesh
        .edges
        .iter()
        .filter(|e| e.marker == 5)
        .map(|e| {
            distance(
                done.mesh.points[e.vertices[0] as usize],
                done.mesh.points[e.vertices[1] as usize],
            )
        })
        .sum();
    assert!((length - 1.0).abs() < 1e-12, "{length}");
    assert_eq!(done.mesh.edges.len(), 5);
}

// spec: U10
#[test]
fn a_chord_error_asks_for_shorter_edges_where_the_surface_bends() {
    let free = RemeshOptions::new(0.3);
    let bound = RemeshOptions { chord_error: Some(0.003), ..free };
    let input = icosphere(5);
    let coarse = sound("free", &input, &free, [1.06, 1.3, 2.0]);
    let fine = sound("bound", &input, &bound, [1.03, 1.2, 2.0]);
    assert!(fine.mesh.triangles.len() > 2 * coarse.mesh.triangles.len());
    assert!(fine.deviation.from_input <= 2.0 * 0.003, "{:?}", fine.deviation);
    assert!(coarse.deviation.from_input > 0.006, "{:?}", coarse.deviation);
}

// spec: U9
#[test]
fn the_same_surface_gives_the_same_bits_for_any_number_of_threads() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| remesh(&cylinder(40), &RemeshOptions::new(0.15)).expect("remeshed"))
    };
    assert_eq!(run(1), run(3));
}

// spec: U7
#[test]
fn thin_sheets_and_surfaces_smaller_than_the_spacing_survive() {
    // A plate a twentieth as thick as the spacing: the two faces must not be mixed up.
    let mut plate = cube();
    plate.points.iter_mut().for_each(|p| p[2] *= 0.005);
    let done = remesh(&plate, &RemeshOptions::new(0.1)).expect("remeshed");
    assert!(in_space(&done.mesh, true).passed());
    assert_eq!(euler_number(&done.mesh.triangles), 2);
    // A shell: a sphere in a sphere, near together.
    let outer = icosphere(4);
    let inner: Vec<Vector> = outer.points.iter().map(|p| scale(0.97, *p)).collect();
    let shift = outer.points.len() as u32;
    let turned = outer.triangles.iter().map(|&[a, b, c]| [a, c, b].map(|v| v + shift));
    let triangles = outer.triangles.iter().copied().chain(turned).collect();
    let shell = mesh([outer.points.clone(), inner].concat(), triangles);
    let done = sound("shell", &shell, &RemeshOptions::new(0.15), [1.03, 1.2, 2.0]);
    assert_eq!(done.parts, 2);
    let tiny = sound("tiny", &icosphere(2), &RemeshOptions::new(50.0), [2.0, 4.0, 4.0]);
    assert!(tiny.mesh.triangles.len() >= 4, "a closed surface is never less than a tetrahedron");
}

// spec: U10
#[test]
fn senseless_options_and_too_many_triangles_are_refused() {
    let error = |options: RemeshOptions| remesh(&cube(), &options).expect_err("refused");
    for (options, name) in [
        (RemeshOptions::new(0.0), "spacing"),
        (RemeshOptions::new(f64::NAN), "spacing"),
        (RemeshOptions { feature_angle_deg: 190.0, ..RemeshOptions::new(1.0) }, "feature-angle"),
        (RemeshOptions { growth: -1.0, ..RemeshOptions::new(1.0) }, "growth"),
        (RemeshOptions { chord_error: Some(0.0), ..RemeshOptions::new(1.0) }, "chord-error"),
    ] {
        let found = error(options);
        assert!(matches!(found, RemeshError::Option { name: n, .. } if n == name), "{found}");
    }
    let many = error(RemeshOptions { triangles_max: 1000, ..RemeshOptions::new(0.01) });
    assert!(matches!(many, RemeshError::TooMany { limit: 1000, .. }), "{many}");
    assert!(many.to_string().contains("--spacing"), "{many}");
    let tiny = error(RemeshOptions::new(1e-200));
    assert!(matches!(tiny, RemeshError::TooMany { .. }), "{tiny}");
}

// spec: !U1
#[test]
fn what_is_no_surface_is_refused() {
    let mut open = cube();
    open.triangles.push([0, 1, 6]);
    let error = remesh(&open, &RemeshOptions::new(0.2)).expect_err("refused");
    assert!(error.to_string().contains("share the edge"), "{error}");
    let mut turned = cube();
    turned.triangles[3].swap(0, 1);
    let error = remesh(&turned, &RemeshOptions::new(0.2)).expect_err("refused");
    assert!(error.to_string().contains("different sides"), "{error}");
    assert_eq!(remesh(&MeshData::default(), &RemeshOptions::new(0.2)), Err(RemeshError::Empty));
}
