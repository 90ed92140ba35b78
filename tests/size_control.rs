//! Sizes and counts as a whole: what SPEC chapters 6 and 8 say of expressions, sources, regions,
//! targets and levels of improvement, on domains made here.

use trigrade::check::{CheckOptions, check};
use trigrade::domain::{Domain, Loop, LoopRole, Region, Segment};
use trigrade::improve::ImproveOptions;
use trigrade::mesh::{Mesh, MeshData};
use trigrade::mesher::{
    Count, Gradation, MeshError, Meshed, Method, Options, Unobserved, mesh_domain,
};
use trigrade::point::Point2;
use trigrade::size::{Density, Expression, SizeSource, SpacingTable};

/// The unit square with `n` segments a side, markers 1 to 4.
fn square(n: u32) -> Domain {
    let at = |i: u32| f64::from(i) / f64::from(n);
    let side = |f: fn(f64) -> Point2| (0..n).map(move |i| f(at(i)));
    let points = side(|t| Point2::new(t, 0.0))
        .chain(side(|t| Point2::new(1.0, t)))
        .chain(side(|t| Point2::new(1.0 - t, 1.0)))
        .chain(side(|t| Point2::new(0.0, 1.0 - t)));
    let mut domain = Domain::new(points.collect());
    let mut ring = Loop::new((0..4 * n).collect(), 0, LoopRole::Any);
    ring.markers = (0..4 * n).map(|i| 1 + (i / n) as i32).collect();
    domain.loops.push(ring);
    domain
}

fn circle(domain: &mut Domain, x: f64, y: f64, radius: f64, n: u32) {
    let first = domain.points.len() as u32;
    domain.points.extend((0..n).map(|i| {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(n);
        Point2::new(x + radius * libm::cos(angle), y + radius * libm::sin(angle))
    }));
    domain.loops.push(Loop::new((first..first + n).collect(), 9, LoopRole::Any));
}

fn ring() -> Domain {
    let mut domain = Domain::new(Vec::new());
    circle(&mut domain, 0.0, 0.0, 8.0, 60);
    circle(&mut domain, 1.0, 0.5, 1.0, 100);
    domain
}

/// Meshes and checks.
fn mesh(domain: &Domain, options: &Options) -> Meshed {
    let meshed = mesh_domain(domain, options, &mut Unobserved).expect("a sound domain is meshed");
    let data = MeshData::from(&meshed.mesh);
    let report = check(&data, Some(domain), &CheckOptions::default());
    assert!(report.passed(), "{:?}", report.findings);
    meshed
}

fn expression(text: &str) -> Gradation {
    Gradation::Expression(Expression::parse(text).expect("a good expression"))
}

/// Mean length of the sides of triangles whose centre is within `radius` of a point.
fn mean_side(mesh: &Mesh, x: f64, y: f64, radius: f64) -> f64 {
    let near = mesh.triangles.iter().filter_map(|t| {
        let [a, b, c] = t.map(|v| mesh.points[v as usize]);
        let centre = Point2::new((a.x + b.x + c.x) / 3.0, (a.y + b.y + c.y) / 3.0);
        let sides = (a.distance(b) + b.distance(c) + c.distance(a)) / 3.0;
        (centre.distance(Point2::new(x, y)) <= radius).then_some(sides)
    });
    let sides: Vec<f64> = near.collect();
    sides.iter().sum::<f64>() / sides.len() as f64
}

// spec: H7
#[test]
fn the_presets_written_out_give_meshes_of_the_same_size() {
    let base = Options { density: Density::AllEdges, ..Options::default() };
    let pairs = [
        (Method::Graded, Gradation::Mean, "a*L1 + b*L2 + c*L3"),
        (Method::Graded, Gradation::Third, "(a*L1 + b*L2 + c*L3)/3"),
        (Method::Direct, Gradation::Growth, "(D1*L2 + D2*L1)/(D1 + D2 + 1e-300)"),
    ];
    for (method, preset, text) in pairs {
        let named = Options { method, gradation: preset, ..base.clone() };
        let written = Options { method, gradation: expression(text), ..base.clone() };
        let [n, m] = [named, written].map(|o| mesh(&ring(), &o).mesh.triangles.len() as f64);
        assert!((m / n - 1.0).abs() < 0.05, "{text}: {m} for {n}");
    }
}

// spec: H7
#[test]
fn grading_in_a_direction_follows_the_coordinate() {
    let options = Options { gradation: expression("0.02 + 0.06*x"), ..Options::default() };
    let meshed = mesh(&square(20), &options);
    let (left, right) =
        (mean_side(&meshed.mesh, 0.2, 0.5, 0.1), mean_side(&meshed.mesh, 0.9, 0.5, 0.1));
    assert!(
        (left / 0.032 - 1.0).abs() < 0.25 && (right / 0.074 - 1.0).abs() < 0.25,
        "{left} {right}"
    );
}

// spec: !H7
#[test]
fn a_value_that_is_no_spacing_is_an_error_with_its_point() {
    for (text, word) in [("x - 0.5", "-"), ("0*x", "0"), ("log(x - 9)", "NaN"), ("1/(x*0)", "inf")]
    {
        let options = Options { gradation: expression(text), ..Options::default() };
        let error = mesh_domain(&square(4), &options, &mut Unobserved).expect_err(text);
        assert!(matches!(error, MeshError::BadSpacing { .. }), "{text}: {error}");
        let message = error.to_string();
        assert!(message.contains(word) && message.contains(" at "), "{message}");
    }
    let options = Options { gradation: expression("D1 + 1"), ..Options::default() };
    let error = mesh_domain(&square(4), &options, &mut Unobserved).expect_err("D1 is direct's");
    assert_eq!(error.to_string(), "gradation: column 1: the method graded has no variable `D1`");
}

// spec: H8
#[test]
fn sources_and_markers_make_the_mesh_fine_around_them() {
    let source = SizeSource::point(Point2::new(0.7, 0.5), 0.01, 0.05);
    let options =
        Options { sources: vec![source], spacing_at: vec![(4, 0.02)], ..Options::default() };
    let fine = mesh(&square(20), &options).mesh;
    let plain = mesh(&square(20), &Options::default()).mesh;
    assert!((mean_side(&fine, 0.7, 0.5, 0.05) / 0.01 - 1.0).abs() < 0.25);
    assert!(mean_side(&fine, 0.06, 0.5, 0.04) < 0.7 * mean_side(&plain, 0.06, 0.5, 0.04));
    assert!(mean_side(&fine, 0.3, 0.3, 0.1) > 0.03);
}

// spec: H8 H9
#[test]
fn a_background_mesh_is_obeyed() {
    let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Point2::from).to_vec();
    let spacing = vec![0.02, 0.05, 0.05, 0.02];
    let table = SpacingTable { points, spacing, triangles: vec![[0, 1, 2], [0, 2, 3]] };
    let options = Options { table: Some(table.into()), ..Options::default() };
    let mesh = mesh(&square(20), &options).mesh;
    let [left, right] = [0.2, 0.9].map(|x| mean_side(&mesh, x, 0.5, 0.1));
    assert!(
        (left / 0.026 - 1.0).abs() < 0.25 && (right / 0.047 - 1.0).abs() < 0.25,
        "{left} {right}"
    );
}

// spec: H8 H12
#[test]
fn a_spacing_far_below_the_boundary_s_is_followed_and_predicted() {
    for options in [
        Options { spacing: Some(0.02), ..Options::default() },
        Options { spacing: Some(0.02), gradation: Gradation::Uniform, ..Options::default() },
    ] {
        let meshed = mesh(&square(5), &options);
        let fit = meshed.fit.expect("edges of its own");
        assert!((0.85..1.15).contains(&fit.median) && fit.high < 5.5 && fit.low > 0.5, "{fit:?}");
        let ratio = meshed.prediction.triangles / meshed.mesh.triangles.len() as f64;
        assert!((0.6..1.7).contains(&ratio), "predicted {ratio} of the truth");
    }
}

// spec: H12
#[test]
fn a_uniform_mesh_fits_its_spacing() {
    let options = Options { gradation: Gradation::Uniform, ..Options::default() };
    let fit = mesh(&square(40), &options).fit.expect("edges of its own");
    assert!(fit.low > 0.75 && (0.95..1.05).contains(&fit.median) && fit.high < 1.35, "{fit:?}");
}

// spec: H8
#[test]
fn regions_have_their_markers_and_spacings_and_share_their_interface() {
    let mut domain = square(20);
    let first = domain.points.len() as u32;
    // A wall from the middle of the floor to the middle of the ceiling.
    domain.points.extend((1..20).map(|i| Point2::new(0.5, f64::from(i) / 20.0)));
    let wall: Vec<u32> = [10].into_iter().chain(first..first + 19).chain([50]).collect();
    domain
        .segments
        .extend(wall.windows(2).map(|ends| Segment { vertices: [ends[0], ends[1]], marker: 7 }));
    let region = |x: f64, marker, area_max| Region { seed: Point2::new(x, 0.5), marker, area_max };
    let area = 0.433 * 0.02 * 0.02;
    domain.regions = vec![region(0.25, 3, Some(area)), region(0.75, 4, None)];
    let mesh = mesh(&domain, &Options::default()).mesh;
    let centre = |t: &[u32; 3]| t.iter().map(|&v| mesh.points[v as usize].x).sum::<f64>() / 3.0;
    assert_eq!(mesh.regions.len(), mesh.triangles.len());
    for (t, &marker) in mesh.triangles.iter().zip(&mesh.regions) {
        assert_eq!(marker, if centre(t) < 0.5 { 3 } else { 4 });
    }
    let [left, right] = [0.25, 0.75].map(|x| mean_side(&mesh, x, 0.5, 0.12));
    assert!((left / 0.02 - 1.0).abs() < 0.25 && right > 0.04, "{left} {right}");
    assert_eq!(mesh.edges.iter().filter(|edge| edge.marker == 7).count(), 20);
}

// spec: H10
#[test]
fn a_limited_field_grows_no_faster_than_asked() {
    let steep = Options {
        gradation: expression("0.02 + 5*abs(x - 0.5)"),
        limit_growth: true,
        ..Options::default()
    };
    let mesh = mesh(&square(10), &steep).mesh;
    assert!(mean_side(&mesh, 0.5, 0.5, 0.02) < 0.04);
    let away = mean_side(&mesh, 0.7, 0.5, 0.04);
    assert!((0.045..0.1).contains(&away), "{away}: growth 0.25 over 0.2");
}

// spec: H11
#[test]
fn targets_are_hit_within_five_percent() {
    for (domain, target) in [(ring(), 3000), (ring(), 9000), (square(20), 4000)] {
        let options = Options { count: Count::Target(target), ..Options::default() };
        let count = mesh(&domain, &options).mesh.triangles.len() as f64;
        assert!((count / target as f64 - 1.0).abs() <= 0.05, "{count} for {target}");
    }
}

// spec: H11
#[test]
fn coarsening_stays_below_the_limit_and_refusing_is_the_default() {
    let fine = Options { spacing: Some(0.01), triangles_max: 6000, ..Options::default() };
    let error = mesh_domain(&square(40), &fine, &mut Unobserved).expect_err("23,000 are too many");
    assert!(matches!(error, MeshError::TooMany { .. }), "{error}");
    assert!(error.to_string().contains("--coarsen"), "{error}");
    let coarse = Options { count: Count::Coarsen, ..fine };
    let count = mesh(&square(40), &coarse).mesh.triangles.len();
    assert!((3000..=6000).contains(&count), "{count}");
}

/// Mean of the inverse mean ratio.
fn mean_shape(mesh: &Mesh) -> f64 {
    let shape = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| mesh.points[v as usize]);
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        (a.distance_sq(b) + b.distance_sq(c) + c.distance_sq(a)) / (12.0_f64.sqrt() * area)
    };
    mesh.triangles.iter().map(shape).sum::<f64>() / mesh.triangles.len() as f64
}

// spec: I5 I6
#[test]
fn each_level_is_better_and_keeps_to_its_budget() {
    let mut before = f64::INFINITY;
    for level in 0..=2 {
        let options = Options { improve: ImproveOptions::level(level), ..Options::default() };
        let meshed = mesh(&ring(), &options);
        let mean = mean_shape(&meshed.mesh);
        assert!(mean < before, "level {level}: {mean} after {before}");
        assert!(meshed.improve.changes <= meshed.improve.tried);
        assert!(level > 0 || meshed.improve.tried == 0);
        before = mean;
    }
    let short = ImproveOptions { tries_max: 10, ..ImproveOptions::level(2) };
    let options = Options { improve: short, ..Options::default() };
    assert!(mesh(&ring(), &options).improve.tried <= 10);
}

// spec: I5 F5
#[test]
fn the_order_of_the_input_does_not_change_the_improved_mesh() {
    let there = ring();
    let mut back = there.clone();
    let last = back.points.len() as u32 - 1;
    back.points.reverse();
    for ring in &mut back.loops {
        ring.vertices.iter_mut().for_each(|v| *v = last - *v);
        ring.vertices.reverse();
    }
    let options = Options { improve: ImproveOptions::level(2), ..Options::default() };
    let key = |meshed: &Meshed| {
        let mut triangles: Vec<[[u64; 2]; 3]> = meshed
            .mesh
            .triangles
            .iter()
            .map(|t| {
                let mut corners = t.map(|v| meshed.mesh.points[v as usize].key());
                corners.sort_unstable();
                corners
            })
            .collect();
        triangles.sort_unstable();
        triangles
    };
    assert!(key(&mesh(&there, &options)) == key(&mesh(&back, &options)), "the meshes differ");
}

// spec: H21
#[test]
fn a_split_boundary_follows_a_uniform_bound() {
    for gradation in [Gradation::Growth, Gradation::Uniform] {
        let options =
            Options { gradation, spacing: Some(0.02), split_boundary: true, ..Options::default() };
        let meshed = mesh(&square(2), &options);
        let points = &meshed.mesh.points;
        for edge in &meshed.mesh.edges {
            let [a, b] = edge.vertices.map(|v| points[v as usize]);
            assert!((0.016..0.0251).contains(&a.distance(b)), "{a} {b}");
        }
        let fit = meshed.fit.expect("edges of its own");
        assert!(fit.low > 0.75 && fit.high < 1.25, "{fit:?}");
        assert!(mean_shape(&meshed.mesh) < 1.01);
    }
}

// spec: H21
#[test]
fn a_kept_boundary_is_left_for_a_uniform_bound_as_fast_as_triangles_can() {
    let options =
        Options { gradation: Gradation::Uniform, spacing: Some(0.005), ..Options::default() };
    let meshed = mesh(&square(2), &options);
    assert_eq!(meshed.mesh.edges.len(), 8, "the boundary is kept");
    let points = &meshed.mesh.points;
    let center = Point2::new(0.5, 0.5);
    let mut near = 0;
    for t in &meshed.mesh.triangles {
        let [a, b, c] = t.map(|v| points[v as usize]);
        if a.distance(center) < 0.03 {
            near += 1;
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            assert!(longest < 3.0 * 0.005, "{longest} at {a}");
        }
    }
    assert!(near > 100, "{near} triangles in the middle");
}
