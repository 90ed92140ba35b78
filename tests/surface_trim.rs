//! Trimmed patches: holes and outlines by curves of space and of (u, v), shared and not.

use trigrade::check::surface::{SurfaceLimits, check_on_model};
use trigrade::check::{CheckOptions, Metric};
use trigrade::format::model_json;
use trigrade::mesh::MeshData;
use trigrade::mesher::Unobserved;
use trigrade::model::Model;
use trigrade::surface_mesher::{SurfaceMeshError, SurfaceMeshed, SurfaceOptions, mesh_model};
use trigrade::vector::{cross, norm, sub};

fn read(text: &str) -> Model {
    model_json::read(text.as_bytes()).unwrap_or_else(|e| panic!("{e}: {text}"))
}

fn run(model: &Model) -> Result<SurfaceMeshed, SurfaceMeshError> {
    mesh_model(model, &SurfaceOptions::default(), &mut Unobserved)
}

fn area(mesh: &MeshData) -> f64 {
    let of = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| mesh.points[v as usize]);
        0.5 * norm(cross(sub(b, a), sub(c, a)))
    };
    mesh.triangles.iter().map(of).sum()
}

/// Meshes a model; the check against it passes and shapes are good. Gives the mesh, its Euler number
/// and its number of boundary edges.
fn sound(text: &str) -> (MeshData, i64, usize) {
    let model = read(text);
    let meshed = run(&model).unwrap_or_else(|e| panic!("{e}: {text}"));
    let limits = SurfaceLimits::default();
    let (report, surface) =
        check_on_model(&meshed.mesh, (&model, &limits), None, &CheckOptions::new());
    assert!(report.passed(), "{:?}: {text}", report.findings.first());
    let quality = report.quality.expect("measured");
    let ratio = quality.summary(Metric::RadiusRatio).expect("measured");
    let (mean, max) = (ratio.mean.expect("finite"), ratio.max.expect("finite"));
    assert!(mean < 1.08 && max < 2.5, "mean {mean}, max {max}: {text}");
    (meshed.mesh, surface.euler, surface.boundary_edges)
}

const PLATE: &str = r#""kind": "plane", "corner": [0, 0, 0], "u": [4, 0, 0], "v": [0, 4, 0]"#;

fn plate(more: &str) -> String {
    format!(r#"{{"spacing": 0.2, "patches": [{{{PLATE}, {more}}}]}}"#)
}

const ROUND: &str = r#"{"kind": "circle", "centre": [0.5, 0.5], "from": [0.75, 0.5], "count": 40}"#;

// spec: S20
#[test]
fn a_hole_by_a_curve_of_the_parameters() {
    let (mesh, euler, boundary) = sound(&plate(&format!(r#""holes": [[{ROUND}]]"#)));
    assert_eq!((euler, boundary), (0, 80 + 40));
    let polygon = 20.0 * libm::sin(std::f64::consts::TAU / 40.0);
    assert!((area(&mesh) - (16.0 - polygon)).abs() < 1e-9, "{}", area(&mesh));
    let open = ROUND.replace(r#", "count": 40"#, r#", "marker": 9"#);
    let (mesh, ..) = sound(&plate(&format!(r#""holes": [[{open}]]"#)));
    assert_eq!(mesh.edges.iter().filter(|e| e.marker == 9).count(), 32, "the model's spacing");
}

// spec: S20
#[test]
fn an_outline_takes_the_place_of_the_sides_and_may_have_holes() {
    let corners = "[[0.1, 0.1], [0.9, 0.2], [0.5, 0.9], [0.1, 0.1]]";
    for points in [corners, "[[0.1, 0.1], [0.5, 0.9], [0.9, 0.2], [0.1, 0.1]]"] {
        let outline = format!(r#"{{"kind": "polyline", "points": {points}}}"#);
        let small = ROUND.replace("0.75, 0.5", "0.58, 0.5").replace("40", "12");
        let (mesh, euler, _) = sound(&plate(&format!(r#""outline": [{outline}]"#)));
        assert_eq!(euler, 1);
        assert!((area(&mesh) - 16.0 * 0.3).abs() < 1e-9, "either way round: {}", area(&mesh));
        let with_hole = format!(r#""outline": [{outline}], "holes": [[{small}]]"#);
        assert_eq!(sound(&plate(&with_hole)).1, 0);
    }
}

/// A plate with a hole and a tube on it.
fn tube(foot: &str) -> String {
    format!(
        r#"{{"spacing": 0.2, "curves": [{{"name": "foot", "kind": "circle", "centre": [2, 2, 0], "from": [3, 2, 0], "marker": 5}}],
            "patches": [{{{PLATE}, "holes": [[{foot}]]}}, {{"kind": "revolution", "origin": [2, 2, 0],
            "profile": {{"kind": "polyline", "points": [[3, 2, 0], [3, 2, 1]]}}}}]}}"#
    )
}

// spec: S20 S21
#[test]
fn patches_that_share_a_trimming_curve_are_watertight_along_it() {
    let by_projection = tube(r#""foot""#);
    let (mesh, euler, boundary) = sound(&by_projection);
    assert_eq!(euler, 0, "an annulus and a tube");
    let foot: Vec<_> = mesh.edges.iter().filter(|edge| edge.marker == 5).collect();
    assert!(foot.len() >= 30);
    let uses = |[a, b]: [u32; 2]| {
        mesh.triangles.iter().filter(|t| t.contains(&a) && t.contains(&b)).count()
    };
    assert!(foot.iter().all(|edge| uses(edge.vertices) == 2), "one triangle on either side");
    assert_eq!(boundary, 80 + foot.len(), "the plate's sides and the tube's head");
    let given = tube(
        r#"{"curve": "foot", "uv": {"kind": "circle", "centre": [0.5, 0.5], "from": [0.75, 0.5]}}"#,
    );
    let (other, ..) = sound(&given);
    assert_eq!(
        mesh.triangles.len(),
        other.triangles.len(),
        "the same nodes in (u, v) up to rounding"
    );
    assert_eq!(sound(&tube(r#""-foot""#)).0.triangles.len(), mesh.triangles.len());
}

// spec: S21
#[test]
fn the_preimage_on_a_curved_patch_is_found() {
    let circle = |z: f64| {
        let r = (1.0 - z * z).sqrt();
        format!(r#"{{"kind": "circle", "centre": [0, 0, {z:?}], "from": [{r:?}, 0, {z:?}]}}"#)
    };
    // The tilted circle does not go around the axis, so its preimage is closed in (u, v).
    let tilted = r#"{"kind": "circle", "centre": [-0.8, 0, 0], "normal": [1, 0, 0], "from": [-0.8, 0.6, 0]}"#;
    let sphere = r#""kind": "revolution", "profile": {"kind": "arc", "points": [[0, 0, -1], [1, 0, 0], [0, 0, 1]]}"#;
    let text = format!(
        r#"{{"spacing": 0.15, "patches": [{{{sphere}, "holes": [[{{"curve": {tilted}}}]]}}]}}"#
    );
    let model = read(&text);
    let error = run(&model).expect_err("the arc has a corner at the equator");
    assert!(error.to_string().contains("creases"), "{error}");
    let bowl = r#""kind": "revolution", "profile": {"kind": "bspline", "degree": 2, "points": [[0, 0, -1], [1.2, 0, -1], [1, 0, 0.5]]}"#;
    let spot = r#"{"kind": "circle", "centre": [0.5, 0.25], "from": [0.6, 0.25]}"#;
    let text = format!(
        r#"{{"spacing": 0.1, "patches": [{{{bowl}, "holes": [[{}]]}}]}}"#,
        spot.replace("0.25]", "3.0]")
    );
    let (_, euler, _) = sound(&text);
    assert_eq!(euler, 0, "a bowl with a hole");
    // A circle about the axis crosses the seam.
    let text = format!(
        r#"{{"spacing": 0.1, "patches": [{{{bowl}, "holes": [[{{"curve": {}}}]]}}]}}"#,
        circle(0.2)
    );
    let error = run(&read(&text)).expect_err("off the surface, and across the seam").to_string();
    assert!(error.contains("patch 1 cannot be trimmed"), "{error}");
}

// spec: !S20 !S22
#[test]
fn loops_that_are_none_are_refused_with_the_patch_and_the_place() {
    let line = |points: &str| format!(r#"{{"kind": "polyline", "points": {points}}}"#);
    let square = line("[[0.4, 0.4], [0.6, 0.4], [0.6, 0.6], [0.4, 0.6], [0.4, 0.4]]");
    let cases = [
        (line("[[0.4, 0.4], [0.6, 0.4], [0.6, 0.6]]"), "the loop has a gap"),
        (line("[[0.3, 0.3], [0.7, 0.7], [0.7, 0.3], [0.3, 0.7], [0.3, 0.3]]"), "patch 1"),
        (line("[[0.5, 0.5], [1.2, 0.5], [0.5, 0.9], [0.5, 0.5]]"), "leaves the rectangle"),
        (line("[[0.5, 0.5], [0.7, 0.5], [0.5, 0.5]]"), "patch 1"),
        (
            format!("{square}], [{}", square.replace("0.4", "0.45").replace("0.6", "0.55")),
            "another hole",
        ),
        (format!("{square}], [{square}"), "patch 1"),
        (
            format!("{square}], [{}", line("[[0.5, 0.5], [0.8, 0.5], [0.5, 0.8], [0.5, 0.5]]")),
            "patch 1",
        ),
        (
            r#"{"curve": {"kind": "circle", "centre": [2, 2, 1], "from": [3, 2, 1]}}"#.to_owned(),
            "off the surface",
        ),
    ];
    for (curves, expected) in cases {
        let text = plate(&format!(r#""holes": [[{curves}]]"#));
        let error = run(&read(&text)).expect_err(&curves).to_string();
        assert!(error.contains(expected) && error.contains("patch 1"), "{curves}: {error}");
    }
    let outside = format!(
        r#""outline": [{square}], "holes": [[{}]]"#,
        square.replace("0.4", "0.1").replace("0.6", "0.2")
    );
    let error = run(&read(&plate(&outside))).expect_err("outside").to_string();
    assert!(error.contains("lies outside"), "{error}");
}

// spec: !S7 !S20
#[test]
fn loops_that_are_not_understood_are_refused_with_the_path() {
    let refused =
        |more: &str| model_json::read(plate(more).as_bytes()).expect_err(more).to_string();
    for (more, expected) in [
        (r#""holes": [["nobody"]]"#, "no curve named 'nobody'"),
        (r#""holes": [[]]"#, "$.patches[0].holes[0]"),
        (r#""holes": [{}]"#, "$.patches[0].holes[0]"),
        (
            r#""outline": [{"kind": "polyline", "points": [[0, 0], [1, 0, 1], [0, 1], [0, 0]]}]"#,
            "third coordinate",
        ),
        (r#""outline": [{"curve": "a", "why": 1}]"#, "unknown key 'why'"),
        (
            r#""outline": [{"curve": {"kind": "circle", "centre": [2, 2, 0], "from": [3, 2, 0]}, "uv": {"kind": "polyline", "points": [[0, 0], [1, 1]], "count": 4}}]"#,
            "without a rule",
        ),
        (r#""hole": []"#, "unknown key 'hole'"),
    ] {
        let error = refused(more);
        assert!(error.contains(expected), "{more}: {error}");
    }
}

// spec: S6
#[test]
fn any_number_of_threads_gives_the_same_mesh() {
    let model = read(&tube(r#""foot""#));
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| run(&model).expect("a mesh").mesh)
    };
    let one = on(1);
    assert!([2, 3, 7].into_iter().all(|threads| on(threads) == one));
}
