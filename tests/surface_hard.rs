//! Surfaces that fight back: degenerate, touching, cusped, folded and overlapping patches. Each gets a
//! right mesh, which both checks confirm, or findings and errors that name what is wrong.

use trigrade::check::surface::{SurfaceLimits, against_model};
use trigrade::check::{CheckOptions, Dimension, Id, Metric, Report, check};
use trigrade::curve::clamped_knots;
use trigrade::mesh::MeshData;
use trigrade::mesher::Unobserved;
use trigrade::model::{Model, Patch};
use trigrade::surface::{Surface, Tensor};
use trigrade::surface_mesher::{SurfaceMeshError, SurfaceOptions, mesh_model};
use trigrade::vector::Vector;

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

// spec: S28
#[test]
fn a_cusp_is_meshed_in_one_piece_or_found() {
    // At the middle of this cubic the first derivative vanishes, and its direction turns round.
    let cusp = model(swept(&[[0.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.0, 0.0]]), 0.05);
    let mesh = run(&cusp).expect("a mesh");
    let ids = findings(&cusp, &mesh);
    // Normals turn round at the cusp: triangles across it face against one half or the other.
    let expected = [Id::SurfaceFold, Id::SelfIntersection];
    assert!(ids.iter().all(|id| expected.contains(id)), "{ids:?}");
}

// spec: S28
#[test]
fn a_map_that_folds_or_overlaps_is_found() {
    let row = |x: f64| vec![[x, 0.0, 0.0], [x, 1.0, 0.0], [x, 2.0, 0.0]];
    let folded = model(bezier(&[row(0.0), row(3.0), row(-1.0), row(2.0)]), 0.1);
    let ids = findings(&folded, &run(&folded).expect("a mesh"));
    assert!(ids.contains(&Id::SelfIntersection), "{ids:?}");
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
