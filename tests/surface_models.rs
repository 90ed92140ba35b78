//! Surface models through the mesher and both checks: the examples, and surfaces that fight back.

#[path = "common/models.rs"]
mod models;

use trigrade::check::surface::{SurfaceLimits, SurfaceReport, against_model};
use trigrade::check::{CheckOptions, Dimension, Id, Metric, Report, check};
use trigrade::curve::Curve;
use trigrade::curve::discretize::Rule;
use trigrade::format::{
    Encoding, MeshForm, MeshView, ReadOptions, WriteOptions, model_json, read_mesh, write_mesh,
};
use trigrade::mesh::MeshData;
use trigrade::mesher::{Options, Unobserved};
use trigrade::model::{Model, ModelCurve, Patch};
use trigrade::surface::{Coons, Revolution, Surface, Tensor};
use trigrade::surface_mesher::{SurfaceMeshError, SurfaceMeshed, SurfaceOptions, mesh_model};
use trigrade::vector::{Vector, norm};

fn examples() -> Vec<(String, Model)> {
    let read = |(name, bytes): (String, Vec<u8>)| {
        assert!(model_json::is_model(&bytes), "{name}");
        let model = model_json::read(&bytes).unwrap_or_else(|e| panic!("{name}: {e}"));
        (name, model)
    };
    models::examples().into_iter().map(read).collect()
}

fn patch(surface: Surface) -> Patch {
    Patch { name: "p".to_owned(), surface, marker: 1, reversed: false }
}

fn model(surfaces: Vec<Surface>, spacing: f64) -> Model {
    let patches = surfaces.into_iter().map(patch).collect();
    Model { patches, spacing: Some(spacing), ..Model::default() }
}

fn bezier(rows: &[Vec<Vector>]) -> Surface {
    Surface::Tensor(Tensor::bezier(rows).expect("a Bezier patch"))
}

fn turned(profile: Curve) -> Surface {
    let of = Revolution::new(profile, [0.0; 3], [0.0, 0.0, 1.0], [0.0, 360.0]);
    Surface::Revolution(of.expect("a surface of revolution"))
}

fn sphere() -> Surface {
    turned(Curve::arc([0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]).expect("an arc"))
}

fn spaced(spacing: f64) -> SurfaceOptions {
    let common = Options { spacing: Some(spacing), ..Options::default() };
    SurfaceOptions { common, ..SurfaceOptions::default() }
}

fn run(model: &Model, options: &SurfaceOptions) -> Result<SurfaceMeshed, SurfaceMeshError> {
    mesh_model(model, options, &mut Unobserved)
}

fn in_space(mesh: &MeshData, model: &Model) -> Report {
    let options = CheckOptions::new().dimension(Dimension::Space);
    check(mesh, None, &options.crossing_parts(model.parts_may_cross))
}

/// Both checks pass; R/2r mean and largest are within the bounds.
fn assert_sound(name: &str, model: &Model, mesh: &MeshData, bounds: [f64; 2]) -> SurfaceReport {
    let report = in_space(mesh, model);
    assert!(report.passed(), "{name}: {:?}", report.findings.first());
    let surface = against_model(mesh, model, &SurfaceLimits::default());
    assert_eq!(surface.findings, [], "{name}");
    let quality = report.quality.expect("measured");
    let ratio = quality.summary(Metric::RadiusRatio).expect("measured");
    let (mean, max) = (ratio.mean.expect("finite"), ratio.max.expect("finite"));
    assert!(mean <= bounds[0] && max <= bounds[1], "{name}: mean {mean}, max {max}");
    surface
}

// spec: S5 S6 S7 S8 S10
#[test]
fn the_examples_are_meshed_watertight_and_well_shaped() {
    let mut names = Vec::new();
    for (name, model) in examples() {
        let meshed = run(&model, &SurfaceOptions::default()).expect("a mesh");
        let bounds = match name.as_str() {
            "two_coons" | "teapot" => [1.06, 2.2],
            _ => [1.03, 1.9],
        };
        let surface = assert_sound(&name, &model, &meshed.mesh, bounds);
        let closed = ["pot", "sphere", "torus"].contains(&name.as_str());
        assert_eq!(surface.boundary_edges == 0, closed, "{name}");
        names.push((name, surface.euler));
    }
    let expected = [
        ("pot", 2),
        ("roof", 1),
        ("sphere", 2),
        ("teapot", 1),
        ("torus", 0),
        ("trimmed", 0),
        ("two_coons", 1),
        ("vase", 1),
        ("wave", 1),
    ];
    assert_eq!(names, expected.map(|(name, euler)| (name.to_owned(), euler)));
}

// spec: S6 S22
#[test]
fn the_teapot_is_four_parts_that_cross_each_other() {
    let (_, model) = examples().into_iter().find(|(name, _)| name == "teapot").expect("there");
    assert_eq!(model.patches.len(), 32);
    let meshed = run(&model, &SurfaceOptions::default()).expect("a mesh");
    let report = in_space(&meshed.mesh, &model);
    assert!(report.passed(), "{:?}", report.findings.first());
    assert_eq!(report.statistics.components, 4, "body, handle, spout and lid");
    let strict = check(&meshed.mesh, None, &CheckOptions::new());
    assert_eq!(
        strict.ids(),
        [Id::BowTie, Id::SelfIntersection],
        "handle and spout run into the body"
    );
}

// spec: S23
#[test]
fn points_know_their_parameters_and_vtk_files_carry_them() {
    let model = model(vec![sphere()], 0.4);
    let meshed = run(&model, &SurfaceOptions::default()).expect("a mesh");
    assert_eq!(meshed.parameters.len(), meshed.mesh.points.len());
    let pieces = model.patches[0].surface.pieces();
    for (&[u, v], &p) in meshed.parameters.iter().zip(&meshed.mesh.points) {
        let off = |piece: &Surface| trigrade::vector::distance(piece.at(u, v), p);
        assert!(pieces.iter().any(|piece| off(piece) < 1e-12), "({u}, {v}) for {p:?}");
    }
    let plain = MeshView::from(&meshed.mesh);
    let view = plain.with_parameters(&meshed.parameters);
    for (form, encoding) in [
        (MeshForm::Vtu, Encoding::Ascii),
        (MeshForm::Vtu, Encoding::Compressed),
        (MeshForm::VtkLegacy, Encoding::Ascii),
        (MeshForm::VtkLegacy, Encoding::Binary),
    ] {
        let mut bytes = Vec::new();
        let options = WriteOptions { encoding, ..WriteOptions::default() };
        write_mesh(view, form, options, &mut bytes).expect("written");
        let mut without = Vec::new();
        write_mesh(plain, form, options, &mut without).expect("written");
        let named = bytes.windows(2).any(|word| word == b"uv");
        assert!(named && bytes.len() > without.len(), "{form:?} {encoding:?}");
        let back = read_mesh(&bytes, form, &ReadOptions::default()).expect("read back");
        assert_eq!((&back.points, &back.triangles), (&meshed.mesh.points, &meshed.mesh.triangles));
    }
    assert!(
        plain.with_parameters(&meshed.parameters[1..]).parameters().is_empty(),
        "one each, or none"
    );
}

// spec: S6
#[test]
fn the_same_model_gives_the_same_bytes() {
    for (name, model) in examples() {
        let [a, b] = [0, 1].map(|_| run(&model, &SurfaceOptions::default()).expect("a mesh"));
        assert_eq!(a.mesh, b.mesh, "{name}");
    }
}

// spec: S5
#[test]
fn patches_that_share_a_curve_share_its_vertices() {
    let (_, model) = examples().into_iter().find(|(name, _)| name == "two_coons").expect("there");
    let meshed = run(&model, &SurfaceOptions::default()).expect("a mesh");
    assert_eq!((meshed.patches, meshed.curves), (2, 7));
    let count = |marker| meshed.mesh.edges.iter().filter(|e| e.marker == marker).count();
    assert_eq!((count(1), count(2)), (20, 20), "the counts of the file are kept");
    let report = in_space(&meshed.mesh, &model);
    assert_eq!(report.statistics.boundary_edges, 40 + 4 * 16);
}

// spec: S6
#[test]
fn a_closed_model_faces_outwards() {
    let meshed = run(&model(vec![sphere()], 0.3), &SurfaceOptions::default()).expect("a mesh");
    for t in &meshed.mesh.triangles {
        let [a, b, c] = t.map(|v| meshed.mesh.points[v as usize]);
        let normal =
            trigrade::vector::cross(trigrade::vector::sub(b, a), trigrade::vector::sub(c, a));
        assert!(trigrade::vector::dot(normal, a) > 0.0);
    }
}

// spec: S27
#[test]
fn the_chord_error_asked_for_is_kept_beside_poles_too() {
    let one = Model { spacing: None, ..model(vec![sphere()], 1.0) };
    for error in [1e-2, 1e-3] {
        let options = SurfaceOptions { chord_error: Some(error), ..SurfaceOptions::default() };
        let meshed = run(&one, &options).expect("a mesh");
        let surface = assert_sound("sphere", &one, &meshed.mesh, [1.05, 1.8]);
        let middles = meshed.mesh.triangles.iter().map(|t| {
            let sum = t.map(|v| meshed.mesh.points[v as usize]);
            let centre = [0, 1, 2].map(|i| (sum[0][i] + sum[1][i] + sum[2][i]) / 3.0);
            1.0 - norm(centre)
        });
        let worst = middles.fold(0.0, f64::max);
        assert!(worst <= surface.chord_error + 1e-12, "{worst} {}", surface.chord_error);
        assert!(surface.chord_error <= error, "{} for {error}", surface.chord_error);
    }
}

// spec: S27
#[test]
fn the_chord_error_asked_for_is_kept_on_torus_vase_and_coons_patches() {
    for (name, mut model) in examples() {
        if !["torus", "vase", "two_coons"].contains(&name.as_str()) {
            continue;
        }
        model.curves.iter_mut().for_each(|curve| curve.rule = None);
        let options = SurfaceOptions { chord_error: Some(5e-3), ..SurfaceOptions::default() };
        let meshed = run(&model, &options).expect("a mesh");
        let surface = assert_sound(&name, &model, &meshed.mesh, [1.03, 1.6]);
        assert!(surface.chord_error <= 5e-3, "{name}: {}", surface.chord_error);
    }
}

// spec: S29
#[test]
fn coons_patches_with_boundaries_of_twenty_and_thirty_points_are_graded_well() {
    let (_, model) = examples().into_iter().find(|(name, _)| name == "two_coons").expect("there");
    for count in [20, 30] {
        let mut model = model.clone();
        for curve in &mut model.curves {
            curve.rule = Some(Rule::Count(count));
        }
        let meshed = run(&model, &SurfaceOptions::default()).expect("a mesh");
        let report = in_space(&meshed.mesh, &model);
        assert!(report.passed(), "{count}: {:?}", report.findings.first());
        let quality = report.quality.expect("measured");
        let ratio = quality.summary(Metric::RadiusRatio).expect("measured");
        let [mean, most] = [ratio.mean, ratio.percentile_99].map(|x| x.expect("finite"));
        assert!(mean <= 1.04 && most <= 1.2, "{count}: mean {mean}, 99 % {most}");
    }
}

// spec: S6
#[test]
fn stretched_and_sheared_parameters_make_no_difference() {
    let sheared = bezier(&[
        vec![[0.0, 0.0, 0.0], [10.0, 0.2, 0.3], [20.0, 0.4, 0.0]],
        vec![[1.0, 0.1, 0.2], [11.0, 0.3, -0.3], [21.0, 0.5, 0.2]],
        vec![[2.0, 0.2, 0.0], [12.0, 0.4, 0.2], [22.0, 0.6, 0.0]],
    ]);
    let cube = |i: u32| f64::from(i * i * i) / 125.0;
    let row = |i: u32| (0..6).map(move |j| [4.0 * cube(i), 4.0 * cube(j), cube(i) * cube(j)]);
    let rows: Vec<Vec<Vector>> = (0..6).map(|i| row(i).collect()).collect();
    let uneven = Surface::Tensor(Tensor::clamped([3, 3], &rows).expect("a surface"));
    for (name, surface, spacing, bounds) in
        [("sheared", sheared, 0.06, [1.05, 4.0]), ("uneven", uneven, 0.05, [1.02, 1.6])]
    {
        let one = model(vec![surface], spacing);
        let meshed = run(&one, &SurfaceOptions::default()).expect("a mesh");
        assert_sound(name, &one, &meshed.mesh, bounds);
    }
}

// spec: S6
#[test]
fn a_boundary_graded_a_thousand_to_one_is_graded_inside() {
    let line = |a: Vector, b: Vector| Curve::polyline(vec![a, b]).expect("a line");
    let corner = [[0.0; 3], [3.0, 0.0, 0.0], [3.0, 3.0, 1.0], [0.0, 3.0, 0.0]];
    let [sw, se, ne, nw] = corner;
    let sides = [line(sw, se), line(se, ne), line(nw, ne), line(sw, nw)];
    let rules = [
        Rule::Graded(0.0005, 0.47),
        Rule::Graded(0.47, 0.47),
        Rule::Graded(0.47, 0.47),
        Rule::Graded(0.0005, 0.47),
    ];
    let named = |(curve, rule): (&Curve, Rule)| ModelCurve {
        name: "c".to_owned(),
        curve: curve.clone(),
        rule: Some(rule),
        marker: None,
    };
    let one = Model {
        curves: sides.iter().zip(rules).map(named).collect(),
        patches: vec![patch(Surface::Coons(Box::new(
            Coons::new(sides.clone(), None).expect("ok"),
        )))],
        ..Model::default()
    };
    let meshed = run(&one, &SurfaceOptions::default()).expect("a mesh");
    assert_sound("graded", &one, &meshed.mesh, [1.05, 2.0]);
}

// spec: S6
#[test]
fn a_collapsed_edge_becomes_one_vertex() {
    let tip = [0.0, 0.0, 2.0];
    let cone = bezier(&[
        vec![tip, tip, tip],
        vec![[1.0, 0.0, 1.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]],
        vec![[2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]],
    ]);
    let one = model(vec![cone], 0.1);
    let meshed = run(&one, &SurfaceOptions::default()).expect("a mesh");
    let surface = assert_sound("cone", &one, &meshed.mesh, [1.05, 2.5]);
    assert_eq!(surface.euler, 1);
    assert_eq!(meshed.mesh.points.iter().filter(|&&p| p == tip).count(), 1);
}

// spec: S6
#[test]
fn a_model_a_million_times_as_large_is_the_same() {
    let rows = |s: f64| {
        vec![
            vec![[0.0, 0.0, 0.0], [0.0, s, 0.5 * s], [0.0, 2.0 * s, 0.0]],
            vec![[s, 0.0, s], [s, s, 0.0], [s, 2.0 * s, 0.3 * s]],
            vec![[2.0 * s, 0.0, 0.0], [2.0 * s, s, 0.5 * s], [2.0 * s, 2.0 * s, 0.0]],
        ]
    };
    let counts = [1.0, 1_048_576.0, 1.0 / 1_048_576.0].map(|scale| {
        let one = model(vec![bezier(&rows(scale))], 0.1 * scale);
        let meshed = run(&one, &SurfaceOptions::default()).expect("a mesh");
        assert_sound("scaled", &one, &meshed.mesh, [1.03, 1.9]);
        meshed.mesh.triangles.len()
    });
    assert!(counts.iter().all(|&count| count == counts[0]), "{counts:?}");
}

// spec: S6
#[test]
fn what_cannot_be_meshed_is_told() {
    assert_eq!(
        run(&Model::default(), &SurfaceOptions::default()).unwrap_err(),
        SurfaceMeshError::Empty
    );
    let fine = run(&model(vec![sphere()], 1e-4), &SurfaceOptions::default()).unwrap_err();
    assert!(matches!(fine, SurfaceMeshError::TooMany { .. }), "{fine}");
    let mut options = spaced(0.1);
    options.angle_per_edge_deg = Some(f64::NAN);
    assert!(matches!(
        run(&model(vec![sphere()], 0.1), &options),
        Err(SurfaceMeshError::Options(_))
    ));
    let point = bezier(&[vec![[1.0; 3]; 3], vec![[1.0; 3]; 3]]);
    let flat = run(&model(vec![point], 0.1), &SurfaceOptions::default()).unwrap_err();
    assert!(matches!(flat, SurfaceMeshError::Flat { .. }), "{flat}");
}

// spec: S8 S9 S10 S11
#[test]
fn the_check_against_a_model_finds_what_is_wrong() {
    let one = model(vec![sphere()], 0.25);
    let sound = run(&one, &SurfaceOptions::default()).expect("a mesh").mesh;
    let ids = |mesh: &MeshData, limits: SurfaceLimits| -> Vec<&'static str> {
        against_model(mesh, &one, &limits).counts.iter().map(|c| c.id.code()).collect()
    };
    let none = SurfaceLimits::default();
    assert_eq!(ids(&sound, none), [""; 0]);
    assert_eq!(ids(&sound, SurfaceLimits { chord_error: Some(1e-4), ..none }), ["S8"]);
    let turn = SurfaceLimits { normal_deviation_deg: Some(0.1), ..none };
    assert_eq!(ids(&sound, turn), ["S8"]);
    let generous = SurfaceLimits { chord_error: Some(0.1), normal_deviation_deg: Some(30.0) };
    assert_eq!(ids(&sound, generous), [""; 0]);
    let mut moved = sound.clone();
    let last = moved.points.len() - 1;
    moved.points[last] = moved.points[last].map(|x| 1.001 * x);
    assert_eq!(ids(&moved, none), ["S8"]);
    let mut folded = sound.clone();
    folded.triangles[5].swap(0, 1);
    assert_eq!(ids(&folded, none), ["S9"]);
    let mut torn = sound.clone();
    torn.triangles.remove(7);
    assert_eq!(ids(&torn, none), ["S10", "S11"]);
    let mut without_pole = sound;
    let pole = without_pole.points.iter().position(|&p| p == [0.0, 0.0, 1.0]).expect("a pole");
    without_pole.points[pole] = [0.0, 1e-12, 1.0];
    assert_eq!(ids(&without_pole, none), ["S11"]);
}

// spec: S7
#[test]
fn broken_model_files_are_refused_with_the_place() {
    let refused = |text: &str| model_json::read(text.as_bytes()).unwrap_err().to_string();
    let cases = [
        ("", "JSON"),
        ("[]", "expected"),
        ("{}", "patches"),
        (r#"{"format": "x", "patches": []}"#, "$.format"),
        (r#"{"patches": [{}]}"#, "kind"),
        (r#"{"patches": [{"kind": "disk"}]}"#, "$.patches[0].kind"),
        (r#"{"patches": [{"kind": "bezier", "net": [[[0, 0, 0]]]}]}"#, "degree"),
        (r#"{"patches": [{"kind": "bezier", "net": [[[0]]]}]}"#, "$.patches[0].net[0][0]"),
        (r#"{"patches": [{"kind": "bezier", "mesh": 1}]}"#, "'mesh'"),
        (r#"{"patches": [{"kind": "coons", "sides": {"south": "a"}}]}"#, "no curve named 'a'"),
        (r#"{"patches": [{"kind": "revolution", "profile": {"kind": "knot"}}]}"#, "profile.kind"),
        (r#"{"spacing": -1, "patches": []}"#, "above 0"),
        (
            r#"{"curves": [{"name": "a", "kind": "polyline", "points": [[0, 0], [1, 0]]},
                {"name": "a", "kind": "polyline", "points": [[0, 0], [1, 0]]}], "patches": []}"#,
            "two curves named 'a'",
        ),
        (
            r#"{"curves": [{"name": "a", "kind": "polyline", "points": [[0, 0], [1, 0]],
                "count": 3, "spacing": 1}], "patches": []}"#,
            "exclude",
        ),
        (
            r#"{"curves": [{"name": "a", "kind": "bspline", "degree": 16, "points": []}],
                "patches": []}"#,
            "degree",
        ),
    ];
    for (text, expected) in cases {
        let message = refused(text);
        assert!(message.contains(expected), "{text}: {message}");
    }
    let line = |a: &str, b: &str| format!(r#"{{"kind": "polyline", "points": [{a}, {b}]}}"#);
    let gap = format!(
        r#"{{"patches": [{{"kind": "coons", "sides": {{"south": {}, "east": {}, "north": {}, "west": {}}}}}]}}"#,
        line("[0, 0]", "[1, 0]"),
        line("[1, 0]", "[1, 1]"),
        line("[0, 1]", "[1, 1]"),
        line("[0, 0.001]", "[0, 1]"),
    );
    let message = refused(&gap);
    assert!(
        message.contains("south") && message.contains("west") && message.contains("1e-3"),
        "{message}"
    );
    let open = gap.replacen('{', r#"{"corner_tolerance": 0.01, "#, 1);
    assert!(model_json::read(open.as_bytes()).is_ok());
}
