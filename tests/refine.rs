//! Delaunay refinement and the splitting of the boundary as a whole: what SPEC chapter 18 says.

#[cfg(feature = "cli")]
#[path = "common/program.rs"]
mod program;

use num_rational::BigRational;
use std::collections::BTreeMap;
use std::path::Path;
use trigrade::check::{CheckOptions, check};
use trigrade::domain::{Domain, Loop, LoopRole, Region, Segment};
use trigrade::format::domain_file::{DomainForm, ReadOptions, read_domain};
use trigrade::mesh::MeshData;
use trigrade::mesher::{AreaMax, MeshError, Meshed, Method, Options, Unobserved, mesh_domain};
use trigrade::point::Point2;
use trigrade::refine::{RefineError, RefineStats};
use trigrade::torture::generate::{Claim, case};

fn add_loop(domain: &mut Domain, points: &[[f64; 2]], marker: i32) {
    let first = domain.points.len() as u32;
    domain.points.extend(points.iter().map(|&p| Point2::from(p)));
    let vertices = (first..domain.points.len() as u32).collect();
    domain.loops.push(Loop::new(vertices, marker, LoopRole::Any));
}

fn polygon(points: &[[f64; 2]]) -> Domain {
    let mut domain = Domain::new(Vec::new());
    add_loop(&mut domain, points, 1);
    domain
}

fn circle(count: u32, [x, y]: [f64; 2], radius: f64) -> Vec<[f64; 2]> {
    let angle = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(count);
    (0..count)
        .map(|i| [x + radius * libm::cos(angle(i)), y + radius * libm::sin(angle(i))])
        .collect()
}

const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

/// Domains whose corners are all 60 degrees or more.
fn blunt() -> Vec<(&'static str, Domain)> {
    let mut holes = polygon(&[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]);
    add_loop(&mut holes, &circle(24, [1.0, 1.0], 0.5), 2);
    add_loop(&mut holes, &circle(7, [3.0, 1.6], 0.3), 3);
    let mut constraints = polygon(&SQUARE.map(|[x, y]| [8.0 * x, 8.0 * y]));
    let first = constraints.points.len() as u32;
    let more = [[2.0, 2.0], [6.0, 2.0], [6.0, 6.0], [2.0, 5.0], [4.0, 4.1]];
    constraints.points.extend(more.map(Point2::from));
    for (a, b, marker) in [(0, 1, 7), (1, 2, 8), (2, 3, 9)] {
        constraints.segments.push(Segment { vertices: [first + a, first + b], marker });
    }
    let l = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
    vec![
        ("square", polygon(&SQUARE)),
        ("long rectangle", polygon(&[[0.0, 0.0], [30.0, 0.0], [30.0, 1.0], [0.0, 1.0]])),
        ("circle", polygon(&circle(50, [0.3, 0.7], 1.1))),
        ("l shape", polygon(&l)),
        ("holes", holes),
        ("constraints", constraints),
        ("jump", jump()),
    ]
}

/// A square whose lower side has one edge a thousand times shorter than the others.
fn jump() -> Domain {
    polygon(&[[0.0, 0.0], [0.5, 0.0], [0.501, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
}

/// Domains with small corners of their own.
fn sharp() -> Vec<(&'static str, Domain)> {
    let star: Vec<[f64; 2]> =
        (0..24).map(|i| circle(24, [0.0; 2], if i % 2 == 0 { 1.0 } else { 0.2 })[i]).collect();
    let mut fan = polygon(&circle(6, [0.0; 2], 10.0));
    let first = fan.points.len() as u32;
    fan.points.push(Point2::new(0.0, 0.0));
    for (i, p) in circle(40, [0.0; 2], 5.0).into_iter().enumerate() {
        let length = 1.0 + 0.37 * (i % 5) as f64;
        fan.points.push(Point2::new(p[0] * length / 3.0, p[1] * length / 3.0));
        fan.segments.push(Segment { vertices: [first, first + 1 + i as u32], marker: 5 });
    }
    vec![
        ("wedge", polygon(&[[0.0, 0.0], [10.0, 0.0], [10.0, 0.5]])),
        ("needle", polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1e-6]])),
        ("star", polygon(&star)),
        ("fan of constraints", fan),
        ("dart", polygon(&[[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [1.8, 1.0]])),
    ]
}

fn options(area_max: AreaMax, angle_min_deg: f64, split_boundary: bool) -> Options {
    Options {
        method: Method::Delaunay,
        area_max,
        angle_min_deg,
        split_boundary,
        triangles_max: 300_000,
        ..Options::default()
    }
}

fn mesh(domain: &Domain, options: &Options) -> Meshed {
    mesh_domain(domain, options, &mut Unobserved).expect("a sound domain is meshed")
}

fn stats(meshed: &Meshed) -> RefineStats {
    meshed.refine.expect("the method delaunay refines")
}

/// What `check` demands, and that every edge is constrained Delaunay.
fn assert_sound(name: &str, domain: &Domain, meshed: &Meshed) {
    let options = CheckOptions::new().constrained_delaunay(true);
    let report = check(&MeshData::from(&meshed.mesh), Some(domain), &options);
    assert!(report.passed(), "{name}: {:?} {:?}", report.findings, report.could_not_run);
}

fn corners(meshed: &Meshed) -> impl Iterator<Item = [Point2; 3]> + '_ {
    let points = &meshed.mesh.points;
    meshed.mesh.triangles.iter().map(|t| t.map(|v| points[v as usize]))
}

fn exact(x: f64) -> BigRational {
    BigRational::from_float(x).expect("finite")
}

/// Twice the area, without rounding.
fn doubled_area([a, b, c]: [Point2; 3]) -> BigRational {
    let difference = |p: f64, q: f64| exact(p) - exact(q);
    difference(b.x, a.x) * difference(c.y, a.y) - difference(b.y, a.y) * difference(c.x, a.x)
}

fn smallest_angle([a, b, c]: [Point2; 3]) -> f64 {
    let angle = |p: Point2, q: Point2, r: Point2| {
        let (ux, uy, vx, vy) = (q.x - p.x, q.y - p.y, r.x - p.x, r.y - p.y);
        libm::atan2(ux * vy - uy * vx, ux * vx + uy * vy).to_degrees()
    };
    angle(a, b, c).min(angle(b, c, a)).min(angle(c, a, b))
}

// spec: E1 E2 E6
#[test]
fn refined_meshes_are_sound_and_constrained_delaunay() {
    for (name, domain) in blunt().into_iter().chain(sharp()) {
        for split in [false, true] {
            for (area, angle) in
                [(AreaMax::Field, 0.0), (AreaMax::Unbounded, 25.0), (AreaMax::Constant(0.01), 20.0)]
            {
                let meshed = mesh(&domain, &options(area, angle, split));
                assert_sound(&format!("{name} {area:?} {angle} {split}"), &domain, &meshed);
            }
        }
    }
}

// spec: E3
#[test]
fn no_area_is_above_the_bound_in_exact_arithmetic() {
    for (name, domain) in blunt().into_iter().chain(sharp()) {
        for split in [false, true] {
            for area in [0.3, 0.011] {
                let meshed = mesh(&domain, &options(AreaMax::Constant(area), 0.0, split));
                assert_eq!(stats(&meshed).too_large, 0, "{name}");
                let bound = exact(area) + exact(area);
                let worst = corners(&meshed).find(|&t| doubled_area(t) > bound);
                assert_eq!(worst, None, "{name} {area}");
            }
        }
    }
}

// spec: E3 E8
#[test]
fn regions_bound_their_own_areas() {
    let mut domain = polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]);
    let first = domain.points.len() as u32;
    domain.points.extend([[1.0, 0.0], [1.0, 1.0]].map(Point2::from));
    domain.segments.push(Segment { vertices: [first, first + 1], marker: 3 });
    let region = |x, marker, area_max| Region { seed: Point2::new(x, 0.5), marker, area_max };
    domain.regions = vec![region(0.5, 1, Some(0.001)), region(1.5, 2, None)];
    let meshed = mesh(&domain, &options(AreaMax::Constant(0.05), 0.0, false));
    assert_sound("regions", &domain, &meshed);
    let count = |marker| meshed.mesh.regions.iter().filter(|&&m| m == marker).count();
    assert!(count(1) > 1000 && count(2) < 400, "{} and {}", count(1), count(2));
    for (t, &marker) in corners(&meshed).zip(&meshed.mesh.regions) {
        let bound = if marker == 1 { 0.001 } else { 0.05 };
        assert!(doubled_area(t) <= exact(2.0 * bound));
        let x = (t[0].x + t[1].x + t[2].x) / 3.0;
        assert_eq!(marker, if x < 1.0 { 1 } else { 2 });
    }
}

// spec: E9
#[test]
fn the_field_grades_the_areas() {
    let fine = circle(60, [0.0; 2], 0.1);
    let mut domain = polygon(&circle(12, [0.0; 2], 3.0));
    add_loop(&mut domain, &fine, 2);
    let meshed = mesh(&domain, &options(AreaMax::Field, 0.0, false));
    assert_sound("graded", &domain, &meshed);
    let spacing = |v: u32| meshed.spacing[v as usize];
    for (t, corners) in meshed.mesh.triangles.iter().zip(corners(&meshed)) {
        let side = t.iter().map(|&v| spacing(v)).sum::<f64>() / 3.0;
        let bound = 3.0_f64.sqrt() / 2.0 * side * side;
        assert!(doubled_area(corners) <= exact(bound * (1.0 + 1e-12)), "{corners:?}");
    }
    let areas: Vec<f64> = corners(&meshed)
        .map(|[a, b, c]| (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x))
        .collect();
    let (least, most) = areas.iter().fold((f64::MAX, 0.0_f64), |(l, m), &a| (l.min(a), m.max(a)));
    assert!(most > 500.0 * least, "{least} to {most}");
    let predicted = meshed.prediction.triangles / meshed.mesh.triangles.len() as f64;
    assert!((0.6..1.6).contains(&predicted), "{predicted}");
}

// spec: E4
#[test]
fn the_angle_is_reached_where_the_domain_allows_it() {
    for (name, domain) in blunt() {
        for angle in [10.0, 20.7, 26.0, 30.0, 33.0] {
            let meshed = mesh(&domain, &options(AreaMax::Unbounded, angle, true));
            let found = stats(&meshed);
            assert_eq!((found.small_angles, found.too_large), (0, 0), "{name} {angle}");
            let smallest = corners(&meshed).map(smallest_angle).fold(f64::MAX, f64::min);
            assert!(smallest >= angle - 1e-9, "{name} {angle}: {smallest}");
            assert!((found.smallest_angle_deg - smallest).abs() < 1e-6, "{name}");
            assert_sound(name, &domain, &meshed);
        }
    }
}

// spec: E4 E6
#[test]
fn small_corners_are_met_without_end_only_where_they_are() {
    for (name, domain) in sharp() {
        let meshed = mesh(&domain, &options(AreaMax::Unbounded, 25.0, true));
        let found = stats(&meshed);
        assert!(meshed.mesh.triangles.len() < 20_000, "{name}: {}", meshed.mesh.triangles.len());
        let small = corners(&meshed).filter(|&t| smallest_angle(t) < 25.0 - 1e-9).count();
        assert_eq!(found.small_angles, small as u64, "{name}");
        assert_sound(name, &domain, &meshed);
    }
    // Every triangle that is too narrow touches one of the two shells of the corner.
    let wedge = &sharp()[0].1;
    let meshed = mesh(wedge, &options(AreaMax::Unbounded, 20.0, true));
    let far = corners(&meshed).filter(|t| smallest_angle(*t) < 20.0 - 1e-9);
    for t in far {
        let radius = |p: &Point2| p.distance(Point2::new(0.0, 0.0));
        let [a, b, c] = t;
        let mut radii = [radius(&a), radius(&b), radius(&c)];
        radii.sort_by(f64::total_cmp);
        let is_on_shell = (radii[0] - radii[1]).abs() < 1e-3 * radii[1]
            || (radii[1] - radii[2]).abs() < 1e-3 * radii[1];
        assert!(is_on_shell, "{t:?}");
    }
}

// spec: E4 E6
#[test]
fn points_that_nearly_coincide_do_not_keep_refinement_going() {
    for gap in [1.0, 2.0, 1e3, 1e6] {
        let mut domain = polygon(&SQUARE);
        let next = 0.6 + gap * f64::EPSILON / 2.0;
        domain.points.extend([[0.6, 0.6], [next, 0.6]].map(Point2::from));
        for split in [false, true] {
            let meshed = mesh(&domain, &options(AreaMax::Unbounded, 25.0, split));
            assert_sound("close points", &domain, &meshed);
            let count = meshed.mesh.triangles.len();
            assert!(count < 3000, "{gap} units apart: {count} triangles");
        }
    }
}

// spec: E5 E8
#[test]
fn the_boundary_is_kept_unless_splitting_is_allowed() {
    for (name, domain) in blunt().into_iter().chain(sharp()) {
        let meshed = mesh(&domain, &options(AreaMax::Unbounded, 30.0, false));
        assert_eq!(meshed.splits, 0, "{name}");
        let given =
            domain.loops.iter().map(|l| l.vertices.len()).sum::<usize>() + domain.segments.len();
        assert_eq!(meshed.mesh.edges.len(), given, "{name}: pieces");
        let small = corners(&meshed).filter(|&t| smallest_angle(t) < 30.0 - 1e-9).count() as u64;
        assert_eq!(stats(&meshed).small_angles, small, "{name}");
    }
    let jump = mesh(&jump(), &options(AreaMax::Unbounded, 30.0, false));
    assert!(stats(&jump).small_angles > 0 && stats(&jump).smallest_angle_deg < 30.0);
}

/// The length of the marked edges by marker.
fn lengths(meshed: &Meshed) -> BTreeMap<i32, f64> {
    let mut lengths = BTreeMap::new();
    for edge in &meshed.mesh.edges {
        let [a, b] = edge.vertices.map(|v| meshed.mesh.points[v as usize]);
        *lengths.entry(edge.marker).or_insert(0.0) += a.distance(b);
    }
    lengths
}

// spec: E8 E12
#[test]
fn pieces_keep_the_markers_of_their_segments() {
    for (name, domain) in blunt().into_iter().chain(sharp()) {
        let whole = lengths(&mesh(&domain, &options(AreaMax::Unbounded, 0.0, false)));
        let refined = mesh(&domain, &options(AreaMax::Unbounded, 28.0, true));
        let graded = Options { split_boundary: true, ..Options::default() };
        for split in [refined, mesh(&domain, &graded)] {
            let parts = lengths(&split);
            assert_eq!(whole.len(), parts.len(), "{name}");
            for (marker, length) in &whole {
                let difference = (parts[marker] - length).abs();
                assert!(difference < 1e-9 * length, "{name} {marker}: {difference}");
            }
        }
    }
}

// spec: E7
#[test]
fn the_same_input_gives_the_same_mesh_at_any_scale() {
    for (name, domain) in blunt().into_iter().chain(sharp()) {
        let angle = options(AreaMax::Constant(0.02), 27.0, true);
        let once = mesh(&domain, &angle);
        assert_eq!(once.mesh, mesh(&domain, &angle).mesh, "{name}");
        for exponent in [-300, -7, 300] {
            let factor = libm::ldexp(1.0, exponent);
            let mut scaled = domain.clone();
            for p in &mut scaled.points {
                *p = Point2::new(p.x * factor, p.y * factor);
            }
            let area = AreaMax::Constant(0.02 * factor * factor);
            let other = mesh(&scaled, &Options { area_max: area, ..angle.clone() });
            assert_eq!(once.mesh.triangles, other.mesh.triangles, "{name} {exponent}");
            let back = |p: &Point2| Point2::new(p.x / factor, p.y / factor);
            let points: Vec<Point2> = other.mesh.points.iter().map(back).collect();
            assert_eq!(once.mesh.points, points, "{name} {exponent}");
        }
    }
}

// spec: E6 !E10
#[test]
fn limits_and_senseless_bounds_are_errors() {
    let square = polygon(&SQUARE);
    let refuse = |options: Options| mesh_domain(&square, &options, &mut Unobserved).unwrap_err();
    // Predicted before any work.
    let fine = options(AreaMax::Constant(1e-9), 0.0, false);
    assert!(matches!(refuse(fine), MeshError::TooMany { .. }));
    // Angles are not predicted: the count stops them.
    let mut gap = polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1e-4], [0.0, 1e-4]]);
    gap.loops[0].markers.fill(4);
    let limited = Options { triangles_max: 500, ..options(AreaMax::Unbounded, 25.0, true) };
    let stopped = mesh_domain(&gap, &limited, &mut Unobserved).unwrap_err();
    assert!(matches!(stopped, MeshError::Refine(RefineError::Budget(500))), "{stopped}");
    let broken = [
        options(AreaMax::Constant(0.0), 0.0, false),
        options(AreaMax::Constant(-1.0), 0.0, false),
        options(AreaMax::Constant(f64::NAN), 0.0, false),
        options(AreaMax::Field, -0.1, false),
        options(AreaMax::Field, 34.1, false),
        options(AreaMax::Field, f64::NAN, false),
    ];
    for options in broken {
        assert!(matches!(refuse(options.clone()), MeshError::Options(_)), "{options:?}");
    }
}

// spec: E3
#[test]
fn counts_are_near_those_of_the_equilateral_tiling() {
    let meshed = mesh(&polygon(&SQUARE), &options(AreaMax::Constant(1e-4), 20.0, true));
    let count = meshed.mesh.triangles.len();
    // Triangle 1.6 makes about 1.7 triangles per bound.
    assert!((13_000..19_500).contains(&count), "{count}");
    let predicted = meshed.prediction.triangles / count as f64;
    assert!((0.8..1.25).contains(&predicted), "{predicted}");
}

// spec: E1 E6
#[test]
fn golden_domains_are_refined() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
    let mut seen = 0;
    for entry in std::fs::read_dir(folder).expect("the golden domains") {
        let path = entry.expect("an entry").path();
        let is_domain = path.extension().is_some_and(|e| e == "poly" || e == "json");
        let Some(form) = DomainForm::from_path(&path).filter(|_| is_domain) else { continue };
        let bytes = std::fs::read(&path).expect("readable");
        let domain = read_domain(&bytes, form, &ReadOptions::default()).expect("a domain");
        for (split, angle) in [(false, 20.0), (true, 25.0), (true, 33.0)] {
            let meshed = mesh(&domain, &options(AreaMax::Field, angle, split));
            assert_sound(&format!("{} {split}", path.display()), &domain, &meshed);
        }
        seen += 1;
    }
    assert!(seen > 10, "{seen} golden domains");
}

// spec: E1 E2 E6
#[test]
fn tortured_boundaries_are_refined_or_stopped_by_the_limit() {
    let mut tally = [0; 3];
    for index in 0..500 {
        let case = case(17, index);
        let wanted = match index % 3 {
            0 => options(AreaMax::Unbounded, 25.0, true),
            1 => options(AreaMax::Field, 20.0, false),
            _ => Options { split_boundary: true, ..Options::default() },
        };
        let wanted = Options { triangles_max: 20_000, ..wanted };
        let name = format!("{} {index}", case.family);
        match (case.claim, mesh_domain(&case.domain, &wanted, &mut Unobserved)) {
            (Claim::Valid, Ok(meshed)) => {
                let report = check(
                    &MeshData::from(&meshed.mesh),
                    Some(&case.domain),
                    &CheckOptions::default(),
                );
                let ids: Vec<_> = report.findings.iter().map(|f| f.id).collect();
                assert!(report.passed(), "{name}: {ids:?}");
                tally[0] += 1;
            }
            (
                Claim::Valid,
                Err(
                    MeshError::TooMany { .. }
                    | MeshError::Refine(RefineError::Budget(_))
                    | MeshError::Split(_),
                ),
            ) => tally[1] += 1,
            (Claim::Invalid(_), Err(MeshError::Invalid(_))) => tally[2] += 1,
            (claim, answer) => panic!("{name}: {claim} but {:?}", answer.map(|m| m.refine)),
        }
    }
    assert!(tally[0] > 250 && tally[1] < 100 && tally[2] > 50, "{tally:?}");
}

// spec: E11
#[test]
fn neighbours_on_a_split_boundary_differ_by_a_factor_of_two_at_most() {
    let split = Options { split_boundary: true, ..Options::default() };
    for (name, domain) in blunt().into_iter().chain(sharp()) {
        let meshed = mesh(&domain, &split);
        assert_sound_but_for_delaunay(name, &domain, &meshed);
        let mut at: BTreeMap<u32, Vec<f64>> = BTreeMap::new();
        for edge in &meshed.mesh.edges {
            let [a, b] = edge.vertices.map(|v| meshed.mesh.points[v as usize]);
            for v in edge.vertices {
                at.entry(v).or_default().push(a.distance(b));
            }
        }
        for (v, lengths) in at {
            let low = lengths.iter().copied().fold(f64::MAX, f64::min);
            let high = lengths.iter().copied().fold(0.0, f64::max);
            assert!(high <= 2.0 * low * (1.0 + 1e-6), "{name}, vertex {v}: {lengths:?}");
        }
    }
}

fn assert_sound_but_for_delaunay(name: &str, domain: &Domain, meshed: &Meshed) {
    let report = check(&MeshData::from(&meshed.mesh), Some(domain), &CheckOptions::default());
    assert!(report.passed(), "{name}: {:?} {:?}", report.findings, report.could_not_run);
}

fn worst_radius_ratio(meshed: &Meshed) -> f64 {
    let ratio = |[a, b, c]: [Point2; 3]| {
        let (u, v, w) = (a.distance(b), b.distance(c), c.distance(a));
        u * v * w / ((v + w - u) * (w + u - v) * (u + v - w))
    };
    corners(meshed).map(ratio).fold(0.0, f64::max)
}

// spec: E11
#[test]
fn jumps_and_gaps_become_good_where_the_boundary_may_be_split() {
    let split = Options { split_boundary: true, ..Options::default() };
    let kept = mesh(&jump(), &Options::default());
    let better = mesh(&jump(), &split);
    assert_eq!(kept.splits, 0);
    assert!(better.splits > 20, "{}", better.splits);
    assert!(worst_radius_ratio(&kept) > 10.0 && worst_radius_ratio(&better) < 2.5);
    // Two circles with a gap of a hundredth of an edge.
    let mut ring = polygon(&circle(40, [0.0; 2], 1.0));
    add_loop(&mut ring, &circle(40, [0.18, 0.0], 0.81), 2);
    let (kept, better) = (mesh(&ring, &Options::default()), mesh(&ring, &split));
    let (before, after) = (worst_radius_ratio(&kept), worst_radius_ratio(&better));
    assert!(after < 3.0 && after < 0.5 * before, "{before} became {after}");
}

// spec: E11
#[test]
fn an_even_boundary_is_left_alone() {
    let even = polygon(&circle(64, [0.0; 2], 1.0));
    let split = Options { split_boundary: true, ..Options::default() };
    let meshed = mesh(&even, &split);
    assert_eq!(meshed.splits, 0);
    assert_eq!(meshed.mesh, mesh(&even, &Options::default()).mesh);
}

#[cfg(feature = "cli")]
mod command_line {
    use super::program::{assert_exit, program, said};
    use std::path::Path;
    use std::process::Output;

    fn jump() -> String {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/jump.poly");
        path.to_str().expect("UTF-8").to_owned()
    }

    fn run(arguments: &str, more: &[&str]) -> Output {
        program().args(arguments.split_whitespace()).args(more).output().expect("the program runs")
    }

    #[track_caller]
    fn assert_says(output: &Output, code: i32, words: &[&str]) {
        assert_exit(output, code);
        let text = said(output);
        for word in words {
            assert!(text.contains(word), "`{word}` is not in {text}");
        }
    }

    // spec: E4 E5
    #[test]
    fn a_run_says_what_it_reached() {
        let folder = tempfile::tempdir().expect("a temporary directory");
        let mesh = folder.path().join("a.msh").to_str().expect("UTF-8").to_owned();
        let jump = jump();
        let refine = |options: &str| run("mesh --method delaunay -o", &[&mesh, &jump, options]);
        let split =
            run("mesh --method delaunay --min-angle 25 --split-boundary", &["-o", &mesh, &jump]);
        assert_says(&split, 0, &["every angle is at least 25 degrees", "points added", "passed"]);
        assert_says(&run("check --min-angle 25", &[&mesh, "--domain", &jump]), 0, &[]);
        let kept = run("mesh --method delaunay --min-angle 25", &["-o", &mesh, &jump]);
        assert_says(&kept, 0, &["have an angle below 25 degrees", "--split-boundary may split it"]);
        let json = run("mesh --method delaunay --min-angle 25 --json", &["-o", &mesh, &jump]);
        assert_says(&json, 0, &["\"triangles_below_min_angle\": ", "\"min_angle\": 25.0"]);
        assert_says(&refine("--no-check"), 0, &["triangles"]);
        assert_says(&refine("--dry-run"), 0, &["predicted"]);
    }

    // spec: !E10 E6
    #[test]
    fn senseless_bounds_exit_2_and_are_named() {
        let jump = jump();
        let broken = [
            ("--method delaunay --min-angle 35", "min-angle"),
            ("--method delaunay --min-angle=-1", "min-angle"),
            ("--method delaunay --min-angle nan", "min-angle"),
            ("--method delaunay --max-area 0", "max-area"),
            ("--method delaunay --max-area inf", "max-area"),
            ("--method delaunay --max-area large", "max-area"),
            ("--min-angle 20", "--method delaunay"),
            ("--method afm --max-area 1", "--method delaunay"),
            ("--method delaunay --max-area 1e-9", "--max-triangles"),
            ("--method delaunay --min-angle 30 --split-boundary --max-triangles 20", "the limit"),
            ("--split-boundary --max-triangles 20", "--max-triangles"),
        ];
        for (options, word) in broken {
            assert_says(
                &run(&format!("mesh {options} -o -"), &["--form", "off", &jump]),
                2,
                &[word],
            );
        }
    }
}
