//! Surfaces against closed forms, differences, and reference samples where those are present.

use serde_json::Value;
use std::f64::consts::{PI, TAU};
use std::path::Path;
use trigrade::curve::{Curve, CurveError};
use trigrade::format::nurbs_json;
use trigrade::metric::{FirstForm, normal, principal_curvatures};
use trigrade::surface::{Coons, Revolution, Side, Surface, SurfaceError, Tensor};
use trigrade::vector::{Vector, distance, norm, scale, sub};

fn wavy_net() -> Vec<Vec<Vector>> {
    let row = |i: u32| {
        (0..5).map(move |j| {
            let (x, y) = (f64::from(i), f64::from(j));
            [x, y + 0.2 * x, libm::sin(1.3 * x) * libm::cos(0.9 * y)]
        })
    };
    (0..6).map(|i| row(i).collect()).collect()
}

fn bspline() -> Surface {
    Surface::Tensor(Tensor::clamped([3, 2], &wavy_net()).expect("a surface"))
}

fn nurbs() -> Surface {
    let weights: Vec<Vec<f64>> =
        (0..6).map(|i| (0..5).map(|j| 1.0 + 0.3 * f64::from((i * j) % 4)).collect()).collect();
    let knots = [
        vec![0.0, 0.0, 0.0, 0.0, 0.2, 0.7, 1.0, 1.0, 1.0, 1.0],
        vec![0.0, 0.0, 0.0, 0.5, 0.5, 2.0, 2.0, 2.0],
    ];
    Surface::Tensor(Tensor::new([3, 2], knots, &wavy_net(), &weights).expect("a surface"))
}

fn coons() -> Surface {
    let curve = |points: [Vector; 4]| Curve::clamped(3, points.to_vec()).expect("a curve");
    let south = curve([[0.0; 3], [1.0, 0.5, 1.0], [2.0, -0.5, 0.0], [3.0, 0.0, 0.5]]);
    let north = curve([[0.0, 2.0, 0.0], [1.0, 2.2, -1.0], [2.0, 1.8, 1.0], [3.2, 2.0, 0.0]]);
    let west = curve([[0.0; 3], [-0.3, 0.6, 0.4], [0.3, 1.2, 0.0], [0.0, 2.0, 0.0]]);
    let east = curve([[3.0, 0.0, 0.5], [3.3, 0.7, 0.0], [2.9, 1.4, 0.2], [3.2, 2.0, 0.0]]);
    Surface::Coons(Box::new(
        Coons::new([south, east, north, west], None).expect("the corners meet"),
    ))
}

fn torus() -> Surface {
    let circle = Curve::circle([2.0, 0.0, 0.0], [0.0, -1.0, 0.0], [2.5, 0.0, 0.0]).expect("ok");
    Surface::Revolution(
        Revolution::new(circle, [0.0; 3], [0.0, 0.0, 1.0], [0.0, 360.0]).expect("ok"),
    )
}

fn sphere(angles: [f64; 2]) -> Surface {
    let arc = Curve::arc([0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]).expect("an arc");
    Surface::Revolution(Revolution::new(arc, [0.0; 3], [0.0, 0.0, 3.0], angles).expect("ok"))
}

fn samples(surface: &Surface) -> impl Iterator<Item = (f64, f64)> {
    let [[u0, u1], [v0, v1]] = surface.domain();
    (0..81).map(move |k| {
        let (i, j) = (f64::from(k % 9), f64::from(k / 9));
        (u0 + (u1 - u0) * (i + 0.37) / 9.7, v0 + (v1 - v0) * (j + 0.41) / 9.9)
    })
}

fn assert_near(a: Vector, b: Vector, tolerance: f64) {
    assert!(distance(a, b) <= tolerance, "{a:?} against {b:?}");
}

// spec: S3
#[test]
fn derivatives_agree_with_differences() {
    let h = 1e-5;
    for surface in [bspline(), nurbs(), coons(), torus(), sphere([30.0, 200.0])] {
        for (u, v) in samples(&surface) {
            let jet = surface.jet(u, v);
            let first = jet.tangents;
            assert_near(first.point, surface.at(u, v), 1e-13);
            assert_eq!(first, surface.tangents(u, v));
            let difference = |f: &dyn Fn(f64) -> Vector| scale(0.5 / h, sub(f(h), f(-h)));
            let size = 1e-6 * (1.0 + norm(jet.uu) + norm(jet.uv) + norm(jet.vv));
            assert_near(first.u, difference(&|d| surface.at(u + d, v)), size);
            assert_near(first.v, difference(&|d| surface.at(u, v + d)), size);
            assert_near(jet.uu, difference(&|d| surface.tangents(u + d, v).u), size);
            assert_near(jet.uv, difference(&|d| surface.tangents(u, v + d).u), size);
            assert_near(jet.vv, difference(&|d| surface.tangents(u, v + d).v), size);
        }
    }
}

// spec: S3
#[test]
fn a_surface_ends_in_its_sides() {
    for surface in
        [bspline(), nurbs(), coons(), torus(), sphere([0.0, 90.0]), sphere([30.0, 200.0])]
    {
        let [[u0, u1], [v0, v1]] = surface.domain();
        for side in Side::ALL {
            let curve = surface.side(side);
            let [start, end] = curve.domain();
            for i in 0..=8 {
                let f = f64::from(i) / 8.0;
                let (u, v) = match side {
                    Side::South => (u0 + f * (u1 - u0), v0),
                    Side::North => (u0 + f * (u1 - u0), v1),
                    Side::West => (u0, v0 + f * (v1 - v0)),
                    Side::East => (u1, v0 + f * (v1 - v0)),
                };
                let on_curve = curve.at(start + f * (end - start));
                match (&surface, side) {
                    // A rational arc runs at another speed: the angle says where.
                    (Surface::Revolution(of), Side::West | Side::East) if !curve.is_point() => {
                        let angle = of.angle_of(on_curve);
                        assert_near(surface.at(u, angle), on_curve, 1e-13);
                    }
                    _ => assert_near(surface.at(u, v), on_curve, 1e-13),
                }
            }
        }
    }
}

// spec: S3
#[test]
fn a_coons_patch_meets_its_curves_and_says_where_it_does_not() {
    let line = |a: Vector, b: Vector| Curve::polyline(vec![a, b]).expect("a line");
    let corner = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let off = [1.0, 1.0, 1e-9];
    let sides = |ne: Vector| {
        let [sw, se, _, nw] = corner;
        [line(sw, se), line(se, ne), line(nw, corner[2]), line(sw, nw)]
    };
    assert!(Coons::new(sides(corner[2]), None).is_ok());
    let refused = Coons::new(sides(off), None).unwrap_err();
    let SurfaceError::Gap { first, second, gap, .. } = refused.clone() else { panic!("{refused}") };
    assert_eq!((first, second, gap), ("north", "east", 1e-9));
    assert!(refused.to_string().contains("1e-9"), "{refused}");
    assert!(Coons::new(sides(off), Some(1e-8)).is_ok());
    assert!(Coons::new(sides(off), Some(1e-10)).is_err());
}

// spec: S3
#[test]
fn a_full_turn_has_one_seam_and_poles_are_points() {
    let sphere = sphere([0.0, 360.0]);
    assert_eq!(sphere.side(Side::South).same_as(&sphere.side(Side::North)), Some(false));
    assert!(sphere.side(Side::West).is_point() && sphere.side(Side::East).is_point());
    let torus = torus();
    assert_eq!(torus.side(Side::West).same_as(&torus.side(Side::East)), Some(false));
    assert!(torus.side(Side::West).is_closed() && torus.side(Side::South).is_closed());
}

// spec: S4
#[test]
fn curvatures_of_sphere_and_torus_are_known() {
    for (u, v) in samples(&sphere([0.0, 360.0])) {
        let [k1, k2] = principal_curvatures(&sphere([0.0, 360.0]).jet(u, v)).expect("regular");
        assert!((k1.abs() - 1.0).abs() < 1e-7 && (k1 - k2).abs() < 1e-7, "{k1} {k2}");
    }
    let torus = torus();
    for (u, v) in samples(&torus) {
        let jet = torus.jet(u, v);
        let ring = jet.tangents.point[0].hypot(jet.tangents.point[1]);
        let [k1, k2] = principal_curvatures(&jet).expect("regular");
        assert!((k1.abs() - 2.0).abs() < 1e-8, "{k1}");
        let other = (ring - 2.0) / 0.5 / ring;
        assert!((k1.signum() * k2 - other).abs() < 1e-8, "{k2} for {other}");
    }
}

// spec: S4
#[test]
fn a_pole_has_no_normal_and_no_curvature() {
    let sphere = sphere([0.0, 360.0]);
    let pole = sphere.jet(sphere.domain()[0][0], 1.0);
    assert!(norm(pole.tangents.v) == 0.0);
    assert_eq!(normal(&pole.tangents), None);
    assert_eq!(principal_curvatures(&pole), None);
    assert_eq!(FirstForm::new(&pole.tangents).stretch(), f64::INFINITY);
}

// spec: S4
#[test]
fn the_first_form_measures_lengths_and_areas() {
    assert!((area(&torus(), 64) - 4.0 * PI * PI * 2.0 * 0.5).abs() < 1e-8);
    assert!((area(&sphere([0.0, 90.0]), 64) - PI).abs() < 1e-8);
    let form = FirstForm { e: 4.0, f: 0.0, g: 1.0 };
    assert_eq!((form.area(), form.stretch(), form.length_sq(1.0, 2.0)), (2.0, 2.0, 8.0));
}

/// Area by the product of Gauss's rule of three points on `cuts` intervals each way, between knots
/// that are multiples of those.
fn area(surface: &Surface, cuts: u32) -> f64 {
    let [[u0, u1], [v0, v1]] = surface.domain();
    let (du, dv) = ((u1 - u0) / f64::from(cuts), (v1 - v0) / f64::from(cuts));
    let rule = [(-0.6_f64.sqrt(), 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.6_f64.sqrt(), 5.0 / 9.0)];
    let mut sum = 0.0;
    for i in 0..cuts {
        for j in 0..cuts {
            for (x, wx) in rule {
                for (y, wy) in rule {
                    let u = u0 + du * (f64::from(i) + 0.5 + 0.5 * x);
                    let v = v0 + dv * (f64::from(j) + 0.5 + 0.5 * y);
                    let form = FirstForm::new(&surface.tangents(u, v));
                    sum += 0.25 * wx * wy * du * dv * form.area();
                }
            }
        }
    }
    sum
}

// spec: S3
#[test]
fn pieces_are_the_surface_between_its_creases() {
    let net = wavy_net();
    let bilinear = Surface::Tensor(Tensor::clamped([1, 1], &net).expect("ok"));
    let pieces = bilinear.pieces();
    assert_eq!(pieces.len(), 20);
    for piece in &pieces {
        let [[u0, u1], [v0, v1]] = piece.domain();
        assert_eq!((u1 - u0, v1 - v0), (1.0, 1.0));
        for (u, v) in [(u0, v0), (u1, v1), (u0 + 0.3, v0 + 0.8)] {
            assert_near(piece.at(u, v), bilinear.at(u, v), 1e-15);
        }
    }
    assert_eq!(nurbs().pieces().len(), 2, "v has the knot 0.5 twice");
    let [west, east] = [&nurbs().pieces()[0], &nurbs().pieces()[1]].map(Clone::clone);
    assert_eq!(west.side(Side::North).same_as(&east.side(Side::South)), Some(false));
}

// spec: S3
#[test]
fn broken_surfaces_are_refused_with_the_reason() {
    let mut ragged = wavy_net();
    ragged[3].pop();
    assert_eq!(
        Tensor::clamped([3, 2], &ragged),
        Err(SurfaceError::Net { row: 3, found: 4, expected: 5 })
    );
    let few = CurveError::TooFewPoints { points: 5, degree: 5 };
    let refused = Tensor::clamped([3, 5], &wavy_net());
    assert_eq!(refused, Err(SurfaceError::Spline { direction: 'v', error: few }));
    assert!(Tensor::bezier(&[]).is_err());
    let knots = [vec![0.0; 10], vec![0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 3.0, 3.0]];
    let refused = Tensor::new([3, 2], knots, &wavy_net(), &[]).unwrap_err();
    assert_eq!(refused, SurfaceError::Spline { direction: 'u', error: CurveError::NoRange });
    let line = Curve::polyline(vec![[1.0, 0.0, 0.0], [1.0, 0.0, 1.0]]).expect("a line");
    let turn = |axis, angles| Revolution::new(line.clone(), [0.0; 3], axis, angles).unwrap_err();
    assert_eq!(turn([0.0; 3], [0.0, 90.0]), SurfaceError::NoAxis);
    assert_eq!(turn([0.0, 0.0, 1.0], [90.0, 0.0]), SurfaceError::Angle(-90.0));
    assert_eq!(turn([0.0, 0.0, 1.0], [0.0, 361.0]), SurfaceError::Angle(361.0));
    assert!(matches!(turn([0.0, 0.0, 1.0], [0.0, f64::NAN]), SurfaceError::Angle(_)));
}

/// The reference surfaces beside a checkout, where they are present.
fn references() -> Vec<(String, Value)> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data/surfaces"));
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    paths
        .into_iter()
        .filter(|path| path.extension().is_some_and(|e| e == "json"))
        .filter_map(|path| {
            let text = std::fs::read_to_string(&path).ok()?;
            let value: Value = serde_json::from_str(&text).ok()?;
            value.get("control_points")?;
            Some((path.display().to_string(), value))
        })
        .collect()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("an array").iter().map(|x| x.as_f64().expect("a number")).collect()
}

fn surface_of(value: &Value) -> Surface {
    let model = nurbs_json::read(value.to_string().as_bytes()).expect("a sound surface");
    model.patches[0].surface.clone()
}

// spec: S3 X61
#[test]
fn the_reference_samples_and_areas_are_met() {
    for (name, value) in references() {
        let surface = surface_of(&value);
        let points = value["control_points"].as_array().expect("rows");
        let size = points.iter().flat_map(|row| row.as_array().expect("a row"));
        let size = size.flat_map(numbers).fold(1.0, |a: f64, x| a.max(x.abs()));
        for sample in value["reference"]["samples_u_v_x_y_z"].as_array().expect("samples") {
            let s = numbers(sample);
            assert!(distance(surface.at(s[0], s[1]), [s[2], s[3], s[4]]) < 1e-9 * size, "{name}");
        }
        let wanted = value["reference"]["area_gauss"].as_f64().expect("an area");
        let found: f64 = surface.pieces().iter().map(|piece| area(piece, 96)).sum();
        // The rule is not made for collapsed edges.
        assert!((found / wanted - 1.0).abs() < 1e-5, "{name}: {found} for {wanted}");
    }
}

// spec: S3
#[test]
fn any_angle_and_any_axis_will_do() {
    let line = Curve::polyline(vec![[2.0, 0.0, 0.0], [2.0, 0.0, 3.0]]).expect("a line");
    let tilted =
        Revolution::new(line, [1.0, 1.0, 0.0], [0.0, 0.0, -1.0], [10.0, 250.0]).expect("ok");
    let surface = Surface::Revolution(tilted);
    for (u, v) in samples(&surface) {
        let p = surface.at(u, v);
        assert!(((p[0] - 1.0).hypot(p[1] - 1.0) - 2.0_f64.sqrt()).abs() < 1e-14);
    }
    let turn = surface.domain()[1];
    assert!((turn[1] - turn[0] - TAU * 240.0 / 360.0).abs() < 1e-15);
}
