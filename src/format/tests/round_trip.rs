//! Writing and reading back gives the same bits, as far as the form carries them.

use super::*;
use proptest::collection::vec;
use proptest::prelude::*;

/// Any finite f64, with zeros, subnormals and the ends of the range often.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |c| c.is_finite()),
        2 => -1000.0..1000.0_f64,
        1 => prop::sample::select(vec![
            0.0, -0.0, 0.1, 1.0, -1.0, 5e-324, -5e-324, f64::MIN_POSITIVE, f64::MAX, f64::MIN,
            1e300, 1e-310, 123_456_789.0, 1.0 + f64::EPSILON, 9_007_199_254_740_993.0,
        ]),
    ]
}

fn mesh(in_space: bool) -> impl Strategy<Value = MeshData> {
    let z = if in_space { coordinate().boxed() } else { Just(0.0).boxed() };
    vec((coordinate(), coordinate(), z), 3..40).prop_flat_map(|points| {
        let points: Vec<[f64; 3]> = points.into_iter().map(|(x, y, z)| [x, y, z]).collect();
        let count = points.len() as u32;
        let triangle = [0..count, 0..count, 0..count];
        let edges = ([0..count, 0..count], 1..5_i32);
        (Just(points), vec((triangle, 1..4_i32), 1..30), vec(edges, 0..10), any::<bool>()).prop_map(
            |(points, triangles, edges, has_regions)| MeshData {
                points,
                triangles: triangles.iter().map(|&(triangle, _)| triangle).collect(),
                edges: edges.into_iter().map(|(ends, marker)| edge(ends, marker)).collect(),
                regions: triangles.iter().map(|t| t.1).filter(|_| has_regions).collect(),
                ..MeshData::default()
            },
        )
    })
}

fn bits(points: &[[f64; 3]]) -> Vec<[u64; 3]> {
    points.iter().map(|point| point.map(f64::to_bits)).collect()
}

/// What `form` gives back of `mesh`: a mesh without regions gets region 1 in MSH.
fn expected_regions(mesh: &MeshData, form: MeshForm) -> Vec<i32> {
    match form {
        MeshForm::Msh if mesh.regions.is_empty() => vec![1; mesh.triangles.len()],
        _ if form.carries_regions() => mesh.regions.clone(),
        _ => Vec::new(),
    }
}

/// What `form` gives back of the marked edges: SU2 keeps those of a marker together.
fn expected_edges(mesh: &MeshData, form: MeshForm) -> Vec<MarkedEdge> {
    let mut edges = mesh.edges.clone();
    if form == MeshForm::Su2 {
        let first = |edge: &MarkedEdge| mesh.edges.iter().position(|e| e.marker == edge.marker);
        edges.sort_by_key(first);
    }
    edges
}

fn assert_round_trip(mesh: &MeshData, form: MeshForm, options: WriteOptions) {
    if form == MeshForm::Stl {
        return assert_stl_round_trip(mesh, options);
    }
    let files = Files::write(mesh, form, options);
    let read = files.read(form).unwrap_or_else(|error| panic!("{form} {options:?}: {error}"));
    assert_eq!(bits(&read.points), bits(&mesh.points), "{form} {options:?}: points");
    assert_eq!(read.triangles, mesh.triangles, "{form} {options:?}: triangles");
    if form.carries_edges() {
        assert_eq!(read.edges, expected_edges(mesh, form), "{form} {options:?}: edges");
    }
    assert_eq!(read.regions, expected_regions(mesh, form), "{form} {options:?}: regions");
    assert!(
        read.bad_references.is_empty() && read.bad_edges.is_empty() && read.other_cells.is_empty()
    );
    assert_eq!(Files::write(&read, form, options).main, files.main, "{form}: the second writing");
}

/// STL keeps the corners of the triangles, and one point for those with equal bits.
fn assert_stl_round_trip(mesh: &MeshData, options: WriteOptions) {
    let is_single = |c: &f64| f64::from(*c as f32).to_bits() == c.to_bits();
    if options.encoding == Encoding::Binary && !mesh.points.iter().flatten().all(is_single) {
        let error = write_mesh(mesh.into(), MeshForm::Stl, options, &mut Vec::new()).unwrap_err();
        assert!(matches!(error, WriteError::Carry { .. }), "{error}");
        return;
    }
    let read = Files::write(mesh, MeshForm::Stl, options).read(MeshForm::Stl).unwrap();
    let corners = |mesh: &MeshData| -> Vec<[u64; 3]> {
        let corners = mesh.triangles.iter().flatten();
        corners.map(|&corner| mesh.points[corner as usize].map(f64::to_bits)).collect()
    };
    assert_eq!(corners(&read), corners(mesh), "{options:?}");
    let distinct: std::collections::BTreeSet<_> = corners(mesh).into_iter().collect();
    assert_eq!(read.points.len(), distinct.len(), "{options:?}");
}

// spec: X31
#[test]
fn stl_vertices_are_merged_only_when_their_bits_are_equal() {
    let mut mesh = square();
    mesh.points = vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    mesh.points.extend([
        [-0.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [f64::from(f32::MIN_POSITIVE), 1.0, 0.0],
    ]);
    mesh.triangles = vec![[0, 1, 2], [4, 5, 3], [0, 6, 2]];
    mesh.regions.clear();
    for encoding in [Encoding::Ascii, Encoding::Binary] {
        let options = WriteOptions { encoding, ..WriteOptions::default() };
        assert_stl_round_trip(&mesh, options);
        let read = Files::write(&mesh, MeshForm::Stl, options).read(MeshForm::Stl).unwrap();
        assert_eq!(read.triangles, [[0, 1, 2], [3, 2, 4], [0, 5, 2]], "-0.0 stays another point");
    }
}

proptest! {
    // spec: X27
    #[test]
    fn plane_meshes_read_back_to_the_same_bits(mesh in mesh(false)) {
        for (form, options) in ways() {
            assert_round_trip(&mesh, form, options);
        }
    }

    // spec: X27
    #[test]
    fn meshes_in_space_read_back_to_the_same_bits(mesh in mesh(true)) {
        for (form, options) in ways() {
            assert_round_trip(&mesh, form, options);
        }
    }
}

// spec: X27
#[test]
fn a_mesh_without_triangles_reads_back() {
    let mesh = MeshData { points: vec![[0.5, -0.0, 0.0]], ..MeshData::default() };
    for (form, options) in ways() {
        assert_round_trip(&mesh, form, options);
    }
}

// spec: X27
#[test]
fn markers_of_any_sign_read_back() {
    let mut mesh = square();
    mesh.edges[0].marker = 0;
    mesh.edges[1].marker = -4;
    mesh.edges[2].marker = i32::MIN;
    mesh.regions = vec![i32::MAX, -1];
    // An inner edge without a marker is not written to `.edge` files' readers: 0 means none.
    for (form, options) in ways().into_iter().filter(|way| way.0 != MeshForm::NodeEle) {
        assert_round_trip(&mesh, form, options);
    }
}

// spec: X28
#[test]
fn what_a_form_drops_is_said() {
    let mesh = square();
    let view = MeshView::from(&mesh);
    for form in MeshForm::ALL.into_iter().filter(|form| form.is_written()) {
        let expected: &[&str] = match form {
            MeshForm::Off | MeshForm::Obj | MeshForm::Ply | MeshForm::Stl => {
                &["marked edges", "regions"]
            }
            MeshForm::Su2 => &["regions"],
            _ => &[],
        };
        assert_eq!(view.dropped_by(form), expected, "{form}");
    }
}

// spec: X28
#[test]
fn a_mesh_with_a_bad_reference_is_not_written() {
    let mut mesh = square();
    mesh.triangles[1][2] = crate::mesh::NO_POINT;
    for (form, options) in ways() {
        let error = write_mesh((&mesh).into(), form, options, &mut Vec::new()).unwrap_err();
        assert!(matches!(error, WriteError::BadReference { item: "triangle", index: 1 }), "{form}");
    }
    let mut mesh = square();
    mesh.edges[2].vertices[0] = 4;
    let error = write_companion((&mesh).into(), Companion::Edges, &mut Vec::new()).unwrap_err();
    assert!(matches!(error, WriteError::BadReference { item: "edge", index: 2 }));
    let mut mesh = square();
    mesh.regions.pop();
    let error = write_companion((&mesh).into(), Companion::Nodes, &mut Vec::new()).unwrap_err();
    assert_eq!(error.to_string(), "the mesh has 1 region markers for 2 triangles");
}

// spec: X28
#[test]
fn an_encoding_that_a_form_lacks_is_refused() {
    let options = WriteOptions { encoding: Encoding::Compressed, ..WriteOptions::default() };
    let error = write_mesh((&square()).into(), MeshForm::Off, options, &mut Vec::new());
    assert_eq!(error.unwrap_err().to_string(), "OFF files have no compressed encoding here");
}

/// A disk that is full.
struct Full;

impl Write for Full {
    fn write(&mut self, _: &[u8]) -> std::io::Result<usize> {
        Err(std::io::Error::other("disk full"))
    }
    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

// spec: X28
#[test]
fn a_full_disk_is_an_error() {
    for (form, options) in ways() {
        let error = write_mesh((&square()).into(), form, options, &mut Full).unwrap_err();
        assert_eq!(error.to_string(), "cannot write the mesh: disk full", "{form}");
    }
}

// spec: X30
#[test]
fn lines_of_points_and_triangles_are_those_of_the_file() {
    for (form, options) in ways().into_iter().filter(|way| way.0 != MeshForm::Stl) {
        let files = Files::write(&square(), form, options);
        let mesh = files.read(form).unwrap();
        if options.encoding != Encoding::Ascii
            || matches!(form, MeshForm::Vtu | MeshForm::VtkLegacy)
        {
            assert_eq!(mesh.triangle_lines.line(0), None, "{form} {options:?}");
            continue;
        }
        let line_of = |bytes: &[u8], line: Option<u64>| {
            let text = String::from_utf8(bytes.to_vec()).unwrap();
            text.lines().nth(line.unwrap() as usize - 1).unwrap().to_owned()
        };
        let point = line_of(files.nodes.as_ref().unwrap_or(&files.main), mesh.point_lines.line(2));
        assert!(point.contains("1 0.125"), "{form}: {point}");
        let triangle = line_of(&files.main, mesh.triangle_lines.line(1));
        assert!(triangle.contains("1 3 4") || triangle.contains("0 2 3"), "{form}: {triangle}");
    }
}

// spec: X23
#[test]
fn the_digits_of_inexact_decimals_are_counted() {
    let digits = |coordinate: &str| {
        let text = format!("OFF 3 1 0\n0 0 0\n1 0 0\n0 {coordinate} 0\n3 0 1 2\n");
        read_mesh(text.as_bytes(), MeshForm::Off, &ReadOptions::default()).unwrap().decimal_digits
    };
    assert_eq!(digits("0.5"), None);
    assert_eq!(digits("0.15625"), None);
    assert_eq!(digits("1024"), None);
    assert_eq!(digits("0.333333"), Some(6));
    assert_eq!(digits("-0.00333333"), Some(6));
    assert_eq!(digits("3.33e-1"), Some(3));
    assert_eq!(digits("0.30000000000000004"), Some(17));
    assert_eq!(digits("0.500000000000000000000000001"), Some(27));
}
