//! Spacings on surfaces by the user's own function.

use trigrade::curve::Curve;
use trigrade::curve::discretize::Rule;
use trigrade::mesher::{Gradation, Unobserved};
use trigrade::model::{Model, ModelCurve, Patch};
use trigrade::size::Expression;
use trigrade::surface::{Revolution, Side, Surface, Tensor};
use trigrade::surface_mesher::{SurfaceMeshError, SurfaceMeshed, SurfaceOptions, mesh_model};
use trigrade::vector::distance;

fn model(surface: Surface) -> Model {
    Model { patches: vec![Patch::plain(0, surface)], ..Model::default() }
}

fn turned(profile: Curve) -> Model {
    let turned = Revolution::new(profile, [0.0; 3], [0.0, 0.0, 1.0], [0.0, 360.0]);
    model(Surface::Revolution(turned.expect("a surface")))
}

fn sphere(r: f64) -> Model {
    turned(Curve::arc([0.0, 0.0, -r], [r, 0.0, 0.0], [0.0, 0.0, r]).expect("an arc"))
}

fn torus() -> Model {
    turned(Curve::circle([2.0, 0.0, 0.0], [0.0, -1.0, 0.0], [2.5, 0.0, 0.0]).expect("a circle"))
}

fn mesh(model: &Model, expression: &str) -> Result<SurfaceMeshed, SurfaceMeshError> {
    let mut options = SurfaceOptions::default();
    options.common.spacing = Some(1.0);
    options.common.growth = 0.5;
    options.common.gradation =
        Gradation::Expression(Expression::parse(expression).expect("an expression"));
    mesh_model(model, &options, &mut Unobserved)
}

/// Mean of edge length over the spacing wanted at its middle.
fn fit(meshed: &SurfaceMeshed, wanted: impl Fn([f64; 3]) -> f64) -> f64 {
    let points = &meshed.mesh.points;
    let edges = meshed.mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let ratios = edges.map(|ends| {
        let [p, q] = ends.map(|v| points[v as usize]);
        let middle = std::array::from_fn(|i| 0.5 * (p[i] + q[i]));
        distance(p, q) / wanted(middle)
    });
    let ratios: Vec<f64> = ratios.collect();
    ratios.iter().sum::<f64>() / ratios.len() as f64
}

// spec: S24
#[test]
fn a_spacing_by_curvature_is_that_of_the_sphere() {
    for r in [0.5, 1.0] {
        let meshed = mesh(&sphere(r), "0.25/abs(k1)").expect("a mesh");
        let fit = fit(&meshed, |_| 0.25 * r);
        assert!((0.9..1.1).contains(&fit), "{r}: {fit}");
        let both = mesh(&sphere(r), "0.25/sqrt(k1*k2)").expect("a mesh");
        let [a, b] = [&both, &meshed].map(|meshed| meshed.mesh.points.len() as f64);
        assert!((a / b - 1.0).abs() < 0.02, "k1 = k2, up to rounding: {a} {b}");
    }
}

// spec: S24
#[test]
fn the_inside_of_a_torus_is_told_from_its_outside() {
    // k2 is cos / (2 + cos / 2) up to its sign: 0.4 outside, -2/3 inside, where k1 k2 < 0.
    let meshed = mesh(&torus(), "0.2 - 0.04*k1*k2").expect("a mesh");
    let gauss = |p: [f64; 3]| {
        let cosine = (f64::hypot(p[0], p[1]) - 2.0) / 0.5;
        cosine / (2.0 + 0.5 * cosine) / 0.5
    };
    let fit = fit(&meshed, |p| 0.2 - 0.04 * gauss(p));
    assert!((0.9..1.1).contains(&fit), "{fit}");
}

// spec: S24
#[test]
fn the_area_element_and_the_place_in_space_are_known() {
    let rows = [vec![[0.0, 0.0, 1.0], [0.0, 4.0, 1.0]], vec![[4.0, 0.0, 1.0], [4.0, 4.0, 1.0]]];
    let plate = model(Surface::Tensor(Tensor::bezier(&rows).expect("a plate")));
    let by_area = mesh(&plate, "0.02*J").expect("a mesh");
    let plain = mesh(&plate, "0.32*z").expect("a mesh");
    assert_eq!(by_area.mesh, plain.mesh, "J = 16 and z = 1");
    let fit = fit(&plain, |_| 0.32);
    assert!((0.9..1.1).contains(&fit), "{fit}");
    let bound = mesh(&plate, "7*H").expect("a mesh");
    assert_eq!(
        bound.mesh,
        mesh(&plate, "1").expect("a mesh").mesh,
        "at most the spacing, which is H"
    );
}

// spec: S24
#[test]
fn what_is_no_spacing_or_no_variable_of_surfaces_is_refused() {
    let told = |expression: &str| mesh(&sphere(1.0), expression).expect_err(expression).to_string();
    assert!(told("z - 0.5").contains("a spacing must be positive"), "{}", told("z - 0.5"));
    assert!(told("1/(x - x)").contains("inf at"));
    assert!(told("0.1 + L1").contains("column 7: `L1` has a meaning in plane domains only"));
}

// spec: S36
#[test]
fn uniform_takes_the_spacing_inside_whatever_the_edges_of_the_curves() {
    let square = [vec![[0.0; 3], [0.0, 1.0, 0.0]], vec![[1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]];
    let mut model = model(Surface::Tensor(Tensor::bezier(&square).expect("a square")));
    model.curves.push(ModelCurve {
        name: "south".to_owned(),
        curve: model.patches[0].surface.side(Side::South),
        rule: Some(Rule::Spacing(0.02)),
        marker: None,
    });
    let count = |gradation: Gradation| {
        let mut options = SurfaceOptions::default();
        options.common.spacing = Some(0.1);
        options.common.gradation = gradation;
        mesh_model(&model, &options, &mut Unobserved).map(|meshed| meshed.mesh.triangles.len())
    };
    let (grown, uniform) = (count(Gradation::Growth), count(Gradation::Uniform));
    let (grown, uniform) = (grown.expect("a mesh"), uniform.expect("a mesh"));
    assert!(3 * uniform < 2 * grown, "{uniform} against {grown}");
    for (gradation, name) in [(Gradation::Mean, "mean"), (Gradation::Third, "third")] {
        let error = count(gradation).expect_err("of the plane");
        assert_eq!(error, SurfaceMeshError::PlaneGradation(name));
        assert!(
            error.to_string().contains(name) && error.to_string().contains("growth"),
            "{error}"
        );
    }
}
