//! Surfaces that fight back: degenerate, touching, cusped, folded and overlapping patches. Each gets a
//! right mesh, which both checks confirm, or findings and errors that name what is wrong.

use std::collections::{BTreeMap, BTreeSet};
use trigrade::check::surface::{SurfaceLimits, against_model};
use trigrade::check::{CheckOptions, Dimension, Id, Metric, Report, check};
use trigrade::curve::{Curve, clamped_knots};
use trigrade::mesh::MeshData;
use trigrade::mesher::Unobserved;
use trigrade::model::{Model, Patch, Trim, TrimCurve};
use trigrade::surface::{Coons, Revolution, Surface, Tensor};
use trigrade::surface_mesher::{SurfaceMeshError, SurfaceOptions, mesh_model};
use trigrade::vector::{Vector, cross, distance, dot, norm_sq, sub};

fn model(surface: Surface, spacing: f64) -> Model {
    let patch = Patch { name: "hard".to_owned(), surface, marker: 1, reversed: false };
    Model { patches: vec![patch], spacing: Some(spacing), ..Model::default() }
}

fn bezier(rows: &[Vec<Vector>]) -> Surface {
    Surface::Tensor(Tensor::bezier(rows).expect("a Bezier patch"))
}

/// The surface that a curve sweeps along z from 0 to 1.
fn swept(curve: &[[f64; 2]]) -> Surface {
    let row = |&[x, y]: &[f64; 2]| vec![[x, y, 0.0], [x, y, 1.0]];
    bezier(&curve.iter().map(row).collect::<Vec<_>>())
}

fn run(model: &Model) -> Result<MeshData, SurfaceMeshError> {
    mesh_model(model, &SurfaceOptions::default(), &mut Unobserved).map(|meshed| meshed.mesh)
}

fn in_space(mesh: &MeshData) -> Report {
    check(mesh, None, &CheckOptions::new().dimension(Dimension::Space))
}

/// The ids that the two checks of a mesh find.
fn findings(model: &Model, mesh: &MeshData) -> Vec<Id> {
    let against = against_model(mesh, model, &SurfaceLimits::default());
    let mut ids = in_space(mesh).ids();
    ids.extend(against.counts.iter().map(|count| count.id));
    ids
}

fn worst_ratio(mesh: &MeshData) -> f64 {
    let quality = in_space(mesh).quality.expect("measured");
    quality.summary(Metric::RadiusRatio).expect("measured").max.expect("finite")
}

// spec: S28
#[test]
fn opposite_edges_that_touch_are_named_by_the_check() {
    // South and north meet in (1, 0, 0), where the whole line between them is one point.
    let pinched = model(
        bezier(&[
            vec![[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]],
            vec![[1.0, 1.0, 0.0], [1.0, -1.0, 0.0]],
            vec![[2.0, -1.0, 0.0], [2.0, 1.0, 0.0]],
        ]),
        0.1,
    );
    match run(&pinched) {
        Ok(mesh) => {
            let ids = findings(&pinched, &mesh);
            assert!(!ids.is_empty(), "a surface with a pinch is no manifold");
        }
        Err(error) => assert!(error.to_string().contains("hard"), "{error}"),
    }
}

// spec: S28
#[test]
fn a_patch_whose_sides_touch_in_its_corners_hangs_together_by_two_vertices() {
    let belly = |x: f64, y: f64, out: f64| vec![[x, y, 0.0], [x + out, y, 1.0], [x, y, 2.0]];
    let rolled = model(
        bezier(&[
            belly(0.0, 0.0, 0.3),
            belly(2.0, 0.0, 0.0),
            belly(2.0, 2.0, 0.0),
            belly(-2.0, 2.0, 0.0),
            belly(-2.0, 0.0, 0.0),
            belly(0.0, 0.0, -0.3),
        ]),
        0.1,
    );
    let mesh = run(&rolled).expect("a mesh");
    let ids = findings(&rolled, &mesh);
    assert!(ids.contains(&Id::BowTie), "{ids:?}");
    assert!(!ids.contains(&Id::SelfIntersection) && !ids.contains(&Id::SurfaceFold), "{ids:?}");
}

// spec: S28 S33
#[test]
fn a_cusp_across_a_patch_is_named_with_its_place() {
    // At the middle of this cubic the first derivative vanishes, and its direction turns round.
    let cusp = swept(&[[0.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.0, 0.0]]);
    let error = run(&model(cusp, 0.05)).expect_err("no normal");
    let SurfaceMeshError::Cusp { parameter: 'u', value, at, .. } = error else {
        panic!("{error}");
    };
    assert!((value - 0.5).abs() < 1e-6 && distance(at, [0.5, 0.75, at[2]]) < 1e-9, "{error}");
    let text = error.to_string();
    assert!(text.contains("hard") && text.contains("S33") && text.contains("0.75"), "{text}");
    // Its two halves meet in the cusp and are a right mesh.
    let left = swept(&[[0.0, 0.0], [0.5, 0.5], [0.5, 0.75], [0.5, 0.75]]);
    let right = swept(&[[0.5, 0.75], [0.5, 0.75], [0.5, 0.5], [1.0, 0.0]]);
    let patch = |i, surface| Patch { name: format!("half {i}"), ..Patch::plain(i, surface) };
    let patches = vec![patch(0, left), patch(1, right)];
    let halves = Model { patches, spacing: Some(0.05), ..Model::default() };
    let mesh = run(&halves).expect("a mesh");
    assert_eq!(findings(&halves, &mesh), []);
}

// spec: S28 S34
#[test]
fn curves_that_meet_at_no_angle_give_a_right_mesh() {
    let spline = |points: [Vector; 4]| Curve::clamped(3, points.to_vec()).expect("a curve");
    let line = |a, b| Curve::polyline(vec![a, b]).expect("a line");
    let (far, east, north) = ([1.6, 1.1, 0.3], [1.5, 0.0, 0.0], [0.7, 1.2, 0.0]);
    let south = spline([[0.0; 3], [0.5, 0.0, 0.0], [1.0, -0.2, 0.0], east]);
    let west = spline([[0.0; 3], [0.5, 0.0, 0.0], [0.8, 0.5, 0.0], north]);
    let sides = [south, line(east, far), line(north, far), west];
    let coons = Surface::Coons(Box::new(Coons::new(sides, None).expect("four sides")));
    // A corner where both tangents vanish.
    let corner = bezier(&[
        vec![[0.0; 3], [0.0; 3], [0.0, 1.0, 0.0]],
        vec![[0.0; 3], [0.5, 0.5, 0.2], [0.5, 1.0, 0.0]],
        vec![[1.0, 0.0, 0.0], [1.0, 0.5, 0.0], [1.0, 1.0, 0.1]],
    ]);
    for surface in [coons, corner] {
        for spacing in [0.05, 0.1, 0.2] {
            let cusped = model(surface.clone(), spacing);
            let mesh = run(&cusped).expect("a mesh");
            assert_eq!(findings(&cusped, &mesh), [], "{spacing}");
        }
    }
}

// spec: S28 S34
#[test]
fn a_leaf_between_two_trimming_curves_is_meshed_to_its_tips() {
    let plane = bezier(&[
        vec![[-1.0, -1.0, 0.0], [-1.0, 2.0, 0.0]],
        vec![[2.0, -1.0, 0.0], [2.0, 2.0, 0.0]],
    ]);
    let curve = |points: [[f64; 2]; 4]| {
        let place = |[x, y]: [f64; 2]| [(x + 1.0) / 3.0, (y + 1.0) / 3.0, 0.0];
        let curve = Curve::clamped(3, points.map(place).to_vec()).expect("a curve");
        TrimCurve::Parameters { curve, rule: None, marker: None }
    };
    let outline = vec![
        curve([[0.2, 0.3], [0.4, 0.3], [0.6, 0.35], [0.8, 0.5]]),
        curve([[0.8, 0.5], [0.5, 0.6], [0.4, 0.3], [0.2, 0.3]]),
    ];
    let trim = Trim { outline: Some(outline), holes: Vec::new() };
    for spacing in [0.02, 0.05, 0.1] {
        let leaf = Model { trims: [(0, trim.clone())].into(), ..model(plane.clone(), spacing) };
        let mesh = run(&leaf).expect("a mesh");
        assert_eq!(findings(&leaf, &mesh), [], "{spacing}");
    }
}

/// A surface of revolution about the z axis whose profile goes through points (radius, height).
fn turned(profile: &[[f64; 2]]) -> Surface {
    let profile = profile.iter().map(|&[r, z]| [r, 0.0, z]).collect();
    let profile = Curve::polyline(profile).expect("a profile");
    let turned = Revolution::new(profile, [0.0; 3], [0.0, 0.0, 1.0], [0.0, 360.0]);
    Surface::Revolution(turned.expect("a surface"))
}

/// A cone of this slope about the z axis, with its tip at height 1.
fn cone(slope: f64) -> Surface {
    turned(&[[0.0, 1.0], [slope, 0.0]])
}

// spec: S35
#[test]
fn the_tip_of_a_cone_is_a_fan_of_five() {
    for (slope, spacing) in [(1.0, 0.1), (1.0, 0.3), (0.5, 0.05), (0.5, 0.2), (0.4, 0.1)] {
        let cone = model(cone(slope), spacing);
        let mesh = run(&cone).expect("a mesh");
        assert_eq!(findings(&cone, &mesh), [], "{slope} {spacing}");
        let tip = mesh.points.iter().position(|p| *p == [0.0, 0.0, 1.0]).expect("a tip") as u32;
        let fan = mesh.triangles.iter().filter(|t| t.contains(&tip)).count();
        assert!(fan == 5 || slope > 0.9, "{fan} at slope {slope}");
        assert!(worst_ratio(&mesh) < 1.6, "{}", worst_ratio(&mesh));
    }
}

// spec: S35 S38
#[test]
fn tips_however_sharp_have_right_meshes() {
    for radius in [1.0, 0.4, 0.1, 0.02] {
        for spacing in [0.4, 0.1, 0.05] {
            let cone = model(turned(&[[0.0, 0.0], [radius, 1.0]]), spacing);
            let mesh = run(&cone).expect("a mesh");
            assert_eq!(findings(&cone, &mesh), [], "{radius} {spacing}");
        }
        let spindle = model(turned(&[[0.0, 0.0], [radius, 1.0], [0.0, 2.0]]), 0.2);
        assert_eq!(findings(&spindle, &run(&spindle).expect("a mesh")), [], "{radius}");
    }
}

// spec: S38
#[test]
fn tubes_narrower_than_the_spacing_are_graded_to_it() {
    for (radius, spacing) in [(0.02, 0.4), (0.02, 0.05), (0.005, 0.1), (0.1, 0.3)] {
        let tube = model(turned(&[[radius, 0.0], [radius, 1.0]]), spacing);
        let mesh = run(&tube).expect("a mesh");
        assert_eq!(findings(&tube, &mesh), [], "{radius} {spacing}");
        assert!(worst_ratio(&mesh) < 1.5, "{radius} {spacing}: {}", worst_ratio(&mesh));
    }
}

// spec: S28
#[test]
fn a_map_that_folds_or_overlaps_is_found() {
    let row = |x: f64| vec![[x, 0.0, 0.0], [x, 1.0, 0.0], [x, 2.0, 0.0]];
    let folded = model(bezier(&[row(0.0), row(3.0), row(-1.0), row(2.0)]), 0.1);
    let error = run(&folded).expect_err("a map that turns back");
    assert!(matches!(error, SurfaceMeshError::Cusp { parameter: 'u', .. }), "{error}");
    assert!(error.to_string().contains("hard"), "{error}");
    let looped = model(swept(&[[0.0, 0.0], [3.0, 2.0], [-2.0, 2.0], [1.0, 0.0]]), 0.1);
    let ids = findings(&looped, &run(&looped).expect("a mesh"));
    assert_eq!(ids, [Id::SelfIntersection]);
}

/// A wavy net of so many rows and four columns.
fn net(rows: u32) -> Vec<Vec<Vector>> {
    let height = |i: u32, j: u32| 0.3 * f64::from(i * j % 3);
    (0..rows)
        .map(|i| (0..4).map(|j| [f64::from(i), f64::from(j), height(i, j)]).collect())
        .collect()
}

/// A surface of six rows of seven waves, whose first row is one point.
fn choppy(seed: u32) -> Surface {
    let mut state = seed;
    let mut noise = || {
        state = state.wrapping_mul(1_103_515_245).wrapping_add(12_345) % (1 << 31);
        f64::from(state) / f64::from(1_u32 << 31) * 2.0 - 1.0
    };
    let mut row = |i: u32| -> Vec<Vector> {
        (0..7).map(|j| [0.4 * f64::from(i), 0.33 * f64::from(j), 1.2 * noise()]).collect()
    };
    let mut net: Vec<Vec<Vector>> = (0..6).map(&mut row).collect();
    net[0] = vec![net[0][0]; 7];
    let knots = [clamped_knots(3, 6), clamped_knots(1, 7)];
    Surface::Tensor(Tensor::new([3, 1], knots, &net, &[]).expect("a surface"))
}

// spec: S8 S28
#[test]
fn vertices_on_a_choppy_surface_are_found_on_it() {
    for seed in [0, 6, 7, 9, 16, 20] {
        let mut choppy = model(choppy(seed * 7919 + 12_345), 0.2);
        choppy.chord_error = Some(0.003);
        let mesh = run(&choppy).expect("a mesh");
        assert_eq!(findings(&choppy, &mesh), [], "{seed}");
    }
}

// spec: S28
#[test]
fn knots_of_full_multiplicity_are_creases_and_one_more_is_refused() {
    let knots = |inner: usize| {
        let mut knots = vec![0.0; 4];
        knots.extend(vec![1.0; inner]);
        knots.extend([2.0; 4]);
        knots
    };
    let creased = Tensor::new([3, 3], [knots(3), clamped_knots(3, 4)], &net(7), &[]).expect("ok");
    let creased = model(Surface::Tensor(creased), 0.2);
    let mesh = run(&creased).expect("a mesh");
    assert_eq!(findings(&creased, &mesh), []);
    assert!(worst_ratio(&mesh) < 1.5);
    let on_crease = mesh.points.iter().filter(|p| (p[0] - 3.0).abs() < 1e-9).count();
    assert!(on_crease > 10, "the crease is a chain of edges");
    let apart = Tensor::new([3, 3], [knots(4), clamped_knots(3, 4)], &net(8), &[]);
    let text = apart.expect_err("it comes apart").to_string();
    assert!(text.contains("repeated 4 times"), "{text}");
}

// spec: S28
#[test]
fn a_triangle_with_two_collapsed_edges_is_refused_and_with_one_is_meshed() {
    let tip = [0.0, 0.0, 1.0];
    let (a, b) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    let one = model(bezier(&[vec![tip, tip], vec![a, b]]), 0.1);
    let mesh = run(&one).expect("a mesh");
    assert_eq!(findings(&one, &mesh), []);
    assert!(worst_ratio(&mesh) < 2.0);
    let two = model(bezier(&[vec![tip, tip], vec![tip, b]]), 0.1);
    let text = run(&two).expect_err("a line").to_string();
    assert!(text.contains("hard"), "{text}");
}

/// The least R/2r of a triangle with this angle: that of the isosceles one. With the angles a, b and b,
/// r/R = 4 sin(a/2) sin(b/2)^2 = 2 sin(a/2) (1 - sin(a/2)).
fn least_ratio(angle: f64) -> f64 {
    let s = (angle / 2.0).sin();
    1.0 / (4.0 * s * (1.0 - s))
}

#[test]
fn no_triangle_with_an_angle_is_better_than_the_isosceles_one() {
    assert!((least_ratio(std::f64::consts::FRAC_PI_3) - 1.0).abs() < 1e-15);
    let ratio = |[a, b]: [f64; 2]| {
        let halves = [a, b, std::f64::consts::PI - a - b].map(|x| (x / 2.0).sin());
        1.0 / (8.0 * halves[0] * halves[1] * halves[2])
    };
    for i in 1..60 {
        let angle = f64::from(i).to_radians();
        let best = (1..1000).map(|k| f64::from(k) / 1000.0 * (std::f64::consts::PI - angle));
        let best = best.map(|b| ratio([angle, b])).fold(f64::INFINITY, f64::min);
        assert!(best >= least_ratio(angle) * (1.0 - 1e-12) && best < 1.001 * least_ratio(angle));
    }
}

/// R/2r of a triangle in space.
fn radius_ratio([a, b, c]: [Vector; 3]) -> f64 {
    let [x, y, z] = [sub(b, a), sub(c, b), sub(a, c)].map(|side| norm_sq(side).sqrt());
    let area_sq = norm_sq(cross(sub(b, a), sub(c, a))) / 4.0;
    x * y * z * (x + y + z) / (16.0 * area_sq)
}

// spec: S30
#[test]
fn the_corner_of_a_sheared_patch_is_all_that_is_bad_and_no_mesh_is_better_there() {
    let row = |u: f64, bulge: f64| {
        vec![
            [u, 0.1 * u, bulge],
            [u + 10.0, 0.1 * u + 0.2, 0.3 - 3.0 * bulge],
            [u + 20.0, 0.1 * u + 0.4, bulge],
        ]
    };
    let sheared = model(bezier(&[row(0.0, 0.0), row(1.0, 0.2), row(2.0, 0.0)]), 0.04);
    let mesh = run(&sheared).expect("a mesh");
    assert_eq!(findings(&sheared, &mesh), []);
    let at = |v: u32| mesh.points[v as usize];
    let mut uses: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    let edges = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)]);
    for edge in mesh.triangles.iter().flat_map(|&t| edges(t)) {
        *uses.entry(edge).or_default() += 1;
    }
    let rim: BTreeSet<u32> = uses.iter().filter(|(_, n)| **n == 1).flat_map(|(e, _)| *e).collect();
    let (mut forced, mut inside) = (1.0_f64, 1.0_f64);
    for t in &mesh.triangles {
        if t.iter().any(|v| !rim.contains(v)) {
            inside = inside.max(radius_ratio(t.map(at)));
        }
        // Both sides of the patch that meet in its corner.
        if edges(*t).iter().filter(|edge| uses[*edge] == 1).count() == 2 {
            let corner = (0..3).map(|i| {
                let [a, b, c] = [t[i], t[(i + 1) % 3], t[(i + 2) % 3]].map(at);
                let (p, q) = (sub(b, a), sub(c, a));
                (dot(p, q) / (norm_sq(p) * norm_sq(q)).sqrt()).acos()
            });
            forced = forced.max(least_ratio(corner.fold(f64::INFINITY, f64::min)));
        }
    }
    let worst = worst_ratio(&mesh);
    assert!(forced > 2.9, "a corner of 10.5 degrees: {forced}");
    assert!(worst < 1.06 * forced, "{worst} where {forced} is forced");
    assert!(inside < 1.2, "{inside}");
}
