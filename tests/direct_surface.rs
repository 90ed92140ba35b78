//! The front in space on the example models, beside the front in (u, v).

#[path = "common/models.rs"]
mod models;

use trigrade::check::surface::{SurfaceLimits, against_model};
use trigrade::check::{CheckOptions, Dimension, Metric, check};
use trigrade::format::model_json;
use trigrade::mesh::MeshData;
use trigrade::mesher::{Observer, Options, Unobserved};
use trigrade::model::Model;
use trigrade::surface_mesher::{
    SurfaceMeshError, SurfaceMeshed, SurfaceMethod, SurfaceOptions, mesh_model,
};

fn examples() -> Vec<(String, Model)> {
    let read =
        |(name, bytes): (String, Vec<u8>)| (name, model_json::read(&bytes).expect("a model"));
    models::examples().into_iter().map(read).collect()
}

fn example(name: &str) -> Model {
    examples().into_iter().find(|(other, _)| other == name).expect("there").1
}

fn options(method: SurfaceMethod, spacing: Option<f64>) -> SurfaceOptions {
    let common = Options { spacing, ..Options::default() };
    SurfaceOptions { common, method, ..SurfaceOptions::default() }
}

fn run(model: &Model, method: SurfaceMethod) -> Result<SurfaceMeshed, SurfaceMeshError> {
    mesh_model(model, &options(method, None), &mut Unobserved)
}

/// R/2r: mean, 99 %, largest; both checks pass.
fn sound(name: &str, model: &Model, mesh: &MeshData) -> [f64; 3] {
    let options = CheckOptions::new().dimension(Dimension::Space);
    let report = check(mesh, None, &options.crossing_parts(model.parts_may_cross));
    assert!(report.passed(), "{name}: {:?}", report.findings.first());
    let found = against_model(mesh, model, &SurfaceLimits::default());
    assert_eq!(found.findings, [], "{name}");
    let quality = report.quality.expect("measured");
    let ratio = quality.summary(Metric::RadiusRatio).expect("measured");
    [ratio.mean, ratio.percentile_99, ratio.max].map(|x| x.expect("finite"))
}

// spec: U13
#[test]
fn what_it_cannot_mesh_is_refused_by_name() {
    let refused = run(&example("trimmed"), SurfaceMethod::Direct).map(|_| ());
    let told = refused.expect_err("trimmed").to_string();
    assert!(told.contains("the front in space takes whole patches only"));
}

// spec: U11 U12 U13 U14
#[test]
fn the_examples_close_and_are_as_good_as_by_parameters() {
    for (name, model) in examples().into_iter().filter(|(name, _)| name != "trimmed") {
        let space = run(&model, SurfaceMethod::Direct).unwrap_or_else(|e| panic!("{name}: {e}"));
        let flat = run(&model, SurfaceMethod::Front).expect("a mesh");
        let [direct, usual] = [&space, &flat].map(|m| sound(&name, &model, &m.mesh));
        let [n, m] = [&space, &flat].map(|m| m.mesh.triangles.len());
        println!("{name}: {n} triangles {direct:.3?} in space, {m} {usual:.3?} in (u, v)");
        let ratio = n as f64 / m as f64;
        assert!(ratio > 0.6 && ratio < 1.2, "{name}: {n} for {m}");
        assert!(direct[0] < usual[0] + 0.06 && direct[2] < 3.0, "{name}: {direct:?} {usual:?}");
        assert_eq!(space.front.inserted as usize > 0, n > 100, "{name}");
    }
}

// spec: U13
#[test]
fn spheres_close_at_any_spacing() {
    let model = example("sphere");
    for i in 0..12 {
        let spacing = 0.6 * 0.8_f64.powi(i);
        let asked = options(SurfaceMethod::Direct, Some(spacing));
        let meshed = mesh_model(&model, &asked, &mut Unobserved);
        let meshed = meshed.unwrap_or_else(|e| panic!("{spacing}: {e}"));
        let ratios = sound("sphere", &model, &meshed.mesh);
        // A dozen triangles around each pole cannot all be equilateral.
        let bound = if spacing > 0.3 { 1.15 } else { 1.06 };
        assert!(ratios[0] < bound, "{spacing}: {ratios:?}");
    }
}

// spec: U11
#[test]
fn curvature_makes_spacings_vary_and_the_same_model_gives_the_same_bits() {
    let model = example("torus");
    let curved =
        SurfaceOptions { chord_error: Some(0.004), ..options(SurfaceMethod::Direct, None) };
    let run = || mesh_model(&model, &curved, &mut Unobserved).expect("a mesh").mesh;
    let (first, second) = (run(), run());
    assert_eq!(first, second);
    let ratios = sound("torus", &model, &first);
    assert!(ratios[0] < 1.06, "{ratios:?}");
}

struct Impatient(usize);

impl Observer for Impatient {
    fn progress(&mut self, triangles: usize) -> bool {
        triangles < self.0
    }
}

// spec: U13
#[test]
fn limits_and_observers_stop_the_front() {
    let model = example("sphere");
    let mut few = options(SurfaceMethod::Direct, None);
    few.common.triangles_max = 100;
    let error = mesh_model(&model, &few, &mut Unobserved).expect_err("too many");
    assert!(matches!(error, SurfaceMeshError::TooMany { limit: 100, .. }), "{error}");
    let asked = options(SurfaceMethod::Direct, None);
    let error = mesh_model(&model, &asked, &mut Impatient(50)).expect_err("stopped");
    assert!(matches!(error, SurfaceMeshError::Front(_)), "{error}");
}

// spec: !U13
#[test]
fn a_front_that_does_not_close_names_the_patch_and_the_place() {
    let error = SurfaceMeshError::Stuck { name: "hull".into(), at: [1.0, 2.0, 3.0], edges: 4 };
    let text = error.to_string();
    assert!(text.contains("patch hull") && text.contains("[1.0, 2.0, 3.0]"), "{text}");
    assert!(text.contains("--spacing"), "{text}");
}
