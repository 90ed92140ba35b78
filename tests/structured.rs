//! Structured grids of plane domains and of surface models: transfinite and elliptic.

use std::fs;
use std::path::Path;
use trigrade::check::surface::{SurfaceLimits, against_model};
use trigrade::check::{CheckOptions, Dimension, Metric, check};
use trigrade::curve::discretize::Rule;
use trigrade::domain::{Domain, Loop, LoopRole, Region, Segment};
use trigrade::format::model_json;
use trigrade::mesh::{Mesh, MeshData};
use trigrade::mesher::{GridError, MeshError, Meshed, Method, Options, Unobserved, mesh_domain};
use trigrade::model::{Model, ModelCurve, Patch};
use trigrade::point::Point2;
use trigrade::structured::{GridMethod, GridStats};
use trigrade::surface::{Side as Side4, Surface, Tensor};
use trigrade::surface_mesher::{
    PatchGridError, SurfaceMeshError, SurfaceMeshed, SurfaceMethod, SurfaceOptions, mesh_model,
};

type Side = dyn Fn(f64) -> [f64; 2];

/// The polygon through points of south, east, north and west, each as a function of [0, 1] in the
/// direction of rising coordinates, with `columns` and `rows` edges.
fn four_sided([south, east, north, west]: [&Side; 4], columns: u32, rows: u32) -> Domain {
    let part = |side: &Side, count: u32, reversed: bool| -> Vec<Point2> {
        let at = |k: u32| f64::from(if reversed { count - k } else { k }) / f64::from(count);
        (0..count).map(|k| side(at(k)).into()).collect()
    };
    let points: Vec<Point2> = [
        part(south, columns, false),
        part(east, rows, false),
        part(north, columns, true),
        part(west, rows, true),
    ]
    .concat();
    let around: Vec<u32> = (0..points.len() as u32).collect();
    let mut domain = Domain::new(points);
    let mut ring = Loop::new(around, 0, LoopRole::Any);
    for (i, marker) in ring.markers.iter_mut().enumerate() {
        let (i, c, r) = (i as u32, columns, rows);
        *marker = 1 + i32::from(i >= c) + i32::from(i >= c + r) + i32::from(i >= 2 * c + r);
    }
    domain.loops.push(ring);
    domain
}

/// The swan of Knupp and Steinberg: its east and north sides are drawn in.
fn swan(columns: u32, rows: u32) -> Domain {
    let south = |s: f64| [s, 0.0];
    let east = |t: f64| [1.0 + 2.0 * t - 2.0 * t * t, t];
    let north = |s: f64| [s, 1.0 - 3.0 * s + 3.0 * s * s];
    let west = |t: f64| [0.0, t];
    four_sided([&south, &east, &north, &west], columns, rows)
}

fn square(columns: u32, rows: u32) -> Domain {
    let sides: [&Side; 4] = [&|s| [s, 0.0], &|t| [1.0, t], &|s| [s, 1.0], &|t| [0.0, t]];
    four_sided(sides, columns, rows)
}

fn corners(columns: u32, rows: u32) -> Option<[u32; 4]> {
    Some([0, columns, columns + rows, 2 * columns + rows])
}

fn grid(domain: &Domain, method: Method, corners: Option<[u32; 4]>) -> Result<Meshed, MeshError> {
    let options = Options { method, corners, ..Options::default() };
    mesh_domain(domain, &options, &mut Unobserved)
}

fn grid_error(domain: &Domain, method: Method, corners: Option<[u32; 4]>) -> GridError {
    match grid(domain, method, corners) {
        Err(MeshError::Grid(error)) => error,
        other => panic!("no grid error: {other:?}"),
    }
}

fn assert_sound(mesh: &Mesh, domain: &Domain) {
    let report = check(&MeshData::from(mesh), Some(domain), &CheckOptions::default());
    assert!(report.passed(), "{:?}", report.findings.first());
}

// spec: W2 W8
#[test]
fn a_square_becomes_a_lattice_with_the_markers_of_its_sides() {
    let domain = square(6, 4);
    for method in [Method::Transfinite, Method::Elliptic] {
        let meshed = grid(&domain, method, None).expect("a grid");
        assert_eq!(meshed.mesh.triangles.len(), 48);
        assert_eq!(meshed.prediction.triangles, 48.0);
        assert_sound(&meshed.mesh, &domain);
        let count = |m| meshed.mesh.edges.iter().filter(|e| e.marker == m).count();
        assert_eq!([1, 2, 3, 4].map(count), [6, 4, 6, 4]);
        for p in &meshed.mesh.points {
            let near = |x: f64, n: f64| (x * n - (x * n).round()).abs() < 1e-8;
            assert!(near(p.x, 6.0) && near(p.y, 4.0), "{p}");
        }
    }
}

// spec: W3 W5 W8
#[test]
fn where_the_transfinite_grid_folds_the_elliptic_one_does_not() {
    for (columns, rows) in [(10, 10), (24, 30)] {
        let domain = swan(columns, rows);
        let corners = corners(columns, rows);
        let error = grid_error(&domain, Method::Transfinite, corners);
        let GridError::Folded { count, column, row, at, advice } = &error else {
            panic!("{error}");
        };
        assert!(*count > 0 && *column < columns as usize && *row < rows as usize);
        assert!(at.is_finite() && advice.contains("elliptic"), "{error}");
        assert!(error.to_string().contains("column"), "{error}");
        let meshed = grid(&domain, Method::Elliptic, corners).expect("a grid without folds");
        assert_sound(&meshed.mesh, &domain);
        let stats = meshed.grid.expect("told");
        assert_eq!((stats.columns, stats.rows), (columns as usize, rows as usize));
        let relaxed = stats.relaxed.expect("smoothed");
        assert!(relaxed.residual <= 1e-10 && relaxed.sweeps < 500, "{relaxed:?}");
    }
}

// spec: W5
#[test]
fn a_fold_that_no_smoothing_mends_is_told_with_its_place() {
    // A spike of one node that leans over its neighbour: no node of so coarse a grid gets below it.
    let spike = |s: f64| if (s - 0.5).abs() < 1e-9 { [0.9, 0.5] } else { [s, 0.0] };
    let sides: [&Side; 4] = [&spike, &|t| [1.0, t], &|s| [s, 1.0], &|t| [0.0, t]];
    let domain = four_sided(sides, 4, 2);
    let error = grid_error(&domain, Method::Elliptic, corners(4, 2));
    assert!(matches!(error, GridError::Folded { .. }), "{error}");
    assert!(error.to_string().contains("another method"), "{error}");
}

// spec: W1 W8
#[test]
fn the_boundary_is_kept_to_the_bit_at_any_scale() {
    for exponent in [-1060, -400, 0, 400, 1000] {
        let mut domain = swan(8, 8);
        for p in &mut domain.points {
            let by = |x: f64| libm::scalbn(x, exponent);
            *p = Point2::new(by(p.x), by(p.y));
        }
        let meshed = grid(&domain, Method::Elliptic, corners(8, 8)).expect("a grid");
        assert_sound(&meshed.mesh, &domain);
        for p in &domain.points {
            assert!(meshed.mesh.points.iter().any(|q| q.key() == p.key()), "{p} is kept");
        }
    }
}

// spec: W2
#[test]
fn opposite_sides_of_different_length_are_told_with_their_counts() {
    let mut points = square(6, 4).points;
    // One vertex less in the north.
    points.remove(12);
    let mut domain = Domain::new(points);
    domain.loops.push(Loop::new((0..19).collect(), 1, LoopRole::Any));
    let error = grid_error(&domain, Method::Transfinite, Some([0, 6, 10, 15]));
    assert_eq!(
        error,
        GridError::Counts {
            corners: [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
            counts: [6, 4, 5, 4]
        }
    );
    assert!(error.to_string().contains("6 and 5 segments"), "{error}");
}

// spec: W2
#[test]
fn corners_are_given_in_any_order_or_found_or_asked_for() {
    let domain = square(6, 4);
    let found = grid(&domain, Method::Transfinite, None).expect("a grid").mesh;
    let given = grid(&domain, Method::Transfinite, Some([0, 16, 6, 10])).expect("a grid").mesh;
    assert_eq!(found, given);
    let error = |corners| grid_error(&domain, Method::Transfinite, Some(corners));
    assert_eq!(error([0, 6, 10, 99]), GridError::Corner { index: 99 });
    assert_eq!(error([0, 6, 10, 6]), GridError::Repeated { index: 6 });
    let round = |k: u32| {
        let angle = std::f64::consts::TAU * f64::from(k) / 24.0;
        Point2::new(libm::cos(angle), libm::sin(angle))
    };
    let mut circle = Domain::new((0..24).map(round).collect());
    circle.loops.push(Loop::new((0..24).collect(), 1, LoopRole::Any));
    let ambiguous = grid_error(&circle, Method::Elliptic, None);
    assert!(matches!(ambiguous, GridError::Ambiguous { .. }), "{ambiguous}");
    assert!(ambiguous.to_string().contains("--corners"), "{ambiguous}");
    let meshed = grid(&circle, Method::Elliptic, Some([0, 6, 12, 18])).expect("a grid");
    assert_sound(&meshed.mesh, &circle);
}

// spec: W2
#[test]
fn holes_constraints_and_points_inside_have_no_grid() {
    let mut holed = square(6, 6);
    let at = |x, y| Point2::new(x, y);
    let first = holed.points.len() as u32;
    holed.points.extend([at(0.4, 0.4), at(0.6, 0.4), at(0.5, 0.6)]);
    let mut cut = holed.clone();
    let mut dotted = holed.clone();
    holed.loops.push(Loop::new((first..first + 3).collect(), 9, LoopRole::Any));
    cut.segments.push(Segment { vertices: [first, first + 1], marker: 3 });
    dotted.points.truncate(first as usize + 1);
    let error = |domain: &Domain| grid_error(domain, Method::Transfinite, None);
    assert!(matches!(error(&holed), GridError::Loops { .. }));
    assert_eq!(error(&cut), GridError::Constraint { at: at(0.4, 0.4) });
    assert_eq!(error(&dotted), GridError::Constraint { at: at(0.4, 0.4) });
    let mut triangle = Domain::new(vec![at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0)]);
    triangle.loops.push(Loop::new(vec![0, 1, 2], 1, LoopRole::Any));
    assert!(matches!(error(&triangle), GridError::Loops { .. }));
}

// spec: W8
#[test]
fn a_region_marks_all_triangles_and_the_limit_holds() {
    let mut domain = square(5, 5);
    let seed = Point2::new(0.51, 0.52);
    domain.regions.push(Region { seed, marker: 7, area_max: None });
    let meshed = grid(&domain, Method::Transfinite, None).expect("a grid");
    assert_eq!(meshed.mesh.regions, vec![7; 50]);
    let options = Options { method: Method::Transfinite, triangles_max: 49, ..Options::default() };
    let error = mesh_domain(&domain, &options, &mut Unobserved).expect_err("too many");
    assert!(matches!(error, MeshError::TooMany { limit: 49, .. }), "{error}");
}

// spec: W6
#[test]
fn the_same_domain_gives_the_same_bits() {
    let run = || grid(&swan(17, 13), Method::Elliptic, corners(17, 13)).expect("a grid").mesh;
    assert_eq!(run(), run());
}

fn example(name: &str) -> Model {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/models");
    model_json::read(&fs::read(folder.join(name)).expect("readable")).expect("a model")
}

fn surface_grid(model: &Model, method: GridMethod) -> Result<SurfaceMeshed, SurfaceMeshError> {
    let options =
        SurfaceOptions { method: SurfaceMethod::Grid(method), ..SurfaceOptions::default() };
    mesh_model(model, &options, &mut Unobserved)
}

/// The model with `count` edges on every side of its smooth patches.
fn counted(mut model: Model, count: usize) -> Model {
    for surface in model.patches.iter().flat_map(|patch| patch.surface.pieces()) {
        for side in Side4::ALL {
            model.curves.push(ModelCurve {
                name: side.name().to_owned(),
                curve: surface.side(side),
                rule: Some(Rule::Count(count)),
                marker: None,
            });
        }
    }
    model
}

// spec: W7 W8
#[test]
fn models_of_four_sided_patches_become_watertight_grids() {
    for (name, euler) in [("wave.json", 1), ("torus.json", 0), ("two_coons.json", 1)] {
        let model = counted(example(name), 24);
        for method in [GridMethod::Transfinite, GridMethod::Elliptic] {
            let meshed = surface_grid(&model, method).unwrap_or_else(|e| panic!("{name}: {e}"));
            assert_eq!(meshed.mesh.triangles.len(), 2 * 24 * 24 * meshed.patches);
            let options = CheckOptions::new().dimension(Dimension::Space);
            let report = check(&meshed.mesh, None, &options);
            assert!(report.passed(), "{name}: {:?}", report.findings.first());
            let found = against_model(&meshed.mesh, &model, &SurfaceLimits::default());
            assert_eq!(found.findings, [], "{name}");
            assert_eq!(found.euler, euler, "{name}");
            assert_eq!(meshed.grids.len(), meshed.patches);
            for stats in &meshed.grids {
                assert_eq!(stats.relaxed.is_some(), method == GridMethod::Elliptic);
                assert!(stats.relaxed.is_none_or(|r| r.residual < 1e-8), "{name}: {stats:?}");
            }
            let ratio = report.quality.expect("measured");
            let mean = ratio.summary(Metric::RadiusRatio).and_then(|s| s.mean).expect("a mean");
            // The torus falls into four rings, whose cells are long.
            assert!(mean < 1.5 || name == "torus.json", "{name}: {mean}");
        }
    }
}

// spec: W7
#[test]
fn patches_with_unequal_rules_or_trims_are_named() {
    let mut model = example("two_coons.json");
    for (curve, count) in model.curves.iter_mut().zip([7, 9, 11, 13, 8, 6, 5]) {
        curve.rule = Some(Rule::Count(count));
    }
    let error = surface_grid(&model, GridMethod::Elliptic).expect_err("unequal sides");
    assert!(matches!(error, SurfaceMeshError::Grid(PatchGridError::Counts { .. })), "{error}");
    assert!(error.to_string().contains("count"), "{error}");
    let error = surface_grid(&example("trimmed.json"), GridMethod::Transfinite).expect_err("holes");
    assert!(matches!(error, SurfaceMeshError::Grid(PatchGridError::Trimmed { .. })), "{error}");
    assert!(error.to_string().contains("trimmed") && error.to_string().contains("W7"), "{error}");
}

/// Both checks of a closed or open mesh of a model, with its Euler number.
fn assert_right(name: &str, model: &Model, meshed: &SurfaceMeshed) {
    let report = check(&meshed.mesh, None, &CheckOptions::new().dimension(Dimension::Space));
    let crossings = model.parts_may_cross;
    assert!(report.passed() || crossings, "{name}: {:?}", report.findings.first());
    let found = against_model(&meshed.mesh, model, &SurfaceLimits::default());
    assert_eq!(found.findings, [], "{name}");
    assert_eq!(found.euler, found.euler_of_model, "{name}");
}

// spec: W11
#[test]
fn at_poles_the_cells_are_triangles_around_one_vertex() {
    for name in ["sphere.json", "vase.json", "pot.json", "teapot.json"] {
        let mut model = Model { angle_per_edge_deg: None, ..example(name) };
        model.spacing = Some(if name == "teapot.json" { 0.1 } else { 0.3 });
        let is_pole = |patch: &Patch| Side4::ALL.iter().any(|&s| patch.surface.side(s).is_point());
        if name == "teapot.json" {
            // Of its 32 patches the eight of knob and bottom.
            model.patches.retain(is_pole);
            assert_eq!(model.patches.len(), 8);
        }
        for method in [GridMethod::Transfinite, GridMethod::Elliptic] {
            let meshed = surface_grid(&model, method).unwrap_or_else(|e| panic!("{name}: {e}"));
            assert_right(name, &model, &meshed);
            let fans = &meshed.mesh.triangles[2 * meshed.cells..];
            assert!(!fans.is_empty(), "{name}");
            let mut at = std::collections::BTreeMap::new();
            for &v in fans.iter().flatten() {
                *at.entry(v).or_insert(0) += 1;
            }
            // Every fan triangle has one pole, and two corners that only its neighbour shares.
            let poles = at.values().filter(|&&n| n > 2).map(|&n| n as usize).sum::<usize>();
            assert_eq!(poles, fans.len(), "{name}");
            assert_eq!(meshed.prediction.triangles, meshed.mesh.triangles.len() as f64, "{name}");
        }
    }
}

// spec: W11
#[test]
fn a_patch_between_two_poles_takes_its_columns_from_the_spacing() {
    // One Bezier patch, a lens: its west and east sides are points.
    let row = |x: f64, half: f64| vec![[x, -half, 0.0], [x, 0.0, half], [x, half, 0.0]];
    let rows = [row(0.0, 0.0), row(1.0, 1.0), row(2.0, 1.0), row(3.0, 0.0)];
    let surface = Surface::Tensor(Tensor::bezier(&rows).expect("a patch"));
    let model =
        Model { patches: vec![Patch::plain(0, surface)], spacing: Some(0.1), ..Model::default() };
    for method in [GridMethod::Transfinite, GridMethod::Elliptic] {
        let meshed = surface_grid(&model, method).expect("a grid");
        assert_right("lens", &model, &meshed);
        let GridStats { columns, rows, .. } = meshed.grids[0];
        assert_eq!(meshed.mesh.triangles.len(), 2 * columns * rows - 2 * rows);
        assert!((12..=20).contains(&rows), "{rows} rows of about 0.1 across 1.5");
    }
}

// spec: W12
#[test]
fn curves_that_face_each_other_get_the_number_of_edges_of_the_finest() {
    let model = example("torus.json");
    let meshed = surface_grid(&model, GridMethod::Transfinite).expect("a grid");
    assert_right("torus", &model, &meshed);
    let rows: Vec<usize> = meshed.grids.iter().map(|stats| stats.rows).collect();
    assert_eq!(rows, vec![rows[0]; 4], "the outer circle decides for all rings");
    assert!(rows[0] as f64 > 0.9 * std::f64::consts::TAU * 2.5 / 0.12, "{rows:?}");
    // A rule of the model's own decides for the curves that face it.
    let mut model = example("two_coons.json");
    model.curves[0].rule = Some(Rule::Count(7));
    model.curves[1..].iter_mut().for_each(|curve| curve.rule = None);
    let meshed = surface_grid(&model, GridMethod::Transfinite).expect("a grid");
    assert_right("two_coons", &model, &meshed);
    let stats = meshed.grids;
    assert!(stats.iter().any(|s| s.columns == 7 || s.rows == 7), "{stats:?}");
}
