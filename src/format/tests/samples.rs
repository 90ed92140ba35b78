//! One small mesh, written by hand in every form and encoding, reads the same from all of them.
//!
//! `tests/format/square*`: two triangles in regions 3 and 4, a quadrilateral in region 5, edges with
//! markers 7 and 2. Forms that cannot carry all of it have less.

use super::hostile::{assert_sound, read_by_all};
use super::*;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/format")
}

fn sample(name: &str) -> Vec<u8> {
    std::fs::read(folder().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The names of all samples, in order.
fn names() -> Vec<String> {
    let entries = std::fs::read_dir(folder()).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn read_sample(name: &str, split_quads: bool) -> MeshData {
    let (nodes, edges) = (sample("square.node"), sample("square.edge"));
    let options = ReadOptions { split_quads, nodes: Some(&nodes), edges: Some(&edges) };
    let form = MeshForm::from_path(Path::new(name)).unwrap();
    read_mesh(&sample(name), form, &options).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The samples that are the main file of a mesh.
fn meshes() -> Vec<(String, MeshForm)> {
    let form = |name: String| MeshForm::from_path(Path::new(&name)).map(|form| (name, form));
    names().into_iter().filter_map(form).collect()
}

/// Whether the samples of a form say regions.
fn has_regions(form: MeshForm) -> bool {
    use MeshForm::{Abaqus, Fort14, Obj, Off, Stl, Su2};
    !matches!(form, Abaqus | Fort14 | Obj | Off | Stl | Su2)
}

const TRIANGLES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

// spec: X20 X25
#[test]
fn every_sample_is_the_same_mesh() {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [2.0, 0.0], [2.0, 1.0]];
    let points = corners.map(|[x, y]| [x, y, 0.0]);
    assert!(meshes().len() >= 35, "{:?}", meshes());
    for (name, form) in meshes() {
        let mesh = read_sample(&name, false);
        // STL has no points of its own, and Triangle no quadrilaterals.
        let count = if form == MeshForm::Stl { 4 } else { 6 };
        assert_eq!(mesh.points, points[..count], "{name}");
        assert_eq!(mesh.triangles, TRIANGLES, "{name}");
        assert!(mesh.bad_references.is_empty() && mesh.bad_edges.is_empty(), "{name}");
        assert_eq!(mesh.decimal_digits, None, "{name}");
        let regions: &[i32] = if has_regions(form) { &[3, 4] } else { &[] };
        assert_eq!(mesh.regions, regions, "{name}");
        let edges: &[MarkedEdge] = match form {
            MeshForm::Off | MeshForm::Stl => &[],
            // Markers are what the form can say: none, or types of boundaries.
            MeshForm::Obj | MeshForm::Abaqus => &[edge([0, 1], 0), edge([3, 0], 0)],
            MeshForm::Fort14 => &[edge([0, 1], -1), edge([3, 0], 20)],
            _ => &[edge([0, 1], 7), edge([3, 0], 2)],
        };
        assert_eq!(mesh.edges, edges, "{name}");
    }
}

// spec: X25
#[test]
fn a_quadrilateral_is_counted_and_said() {
    for (name, form) in meshes() {
        let mesh = read_sample(&name, false);
        let quads = mesh.other_cells.iter().filter(|other| other.kind.contains("uad"));
        let count: u64 = quads.map(|other| other.count).sum();
        let has_quad = !matches!(form, MeshForm::Stl | MeshForm::NodeEle);
        assert_eq!(count, u64::from(has_quad), "{name}: {:?}", mesh.other_cells);
    }
}

// spec: X25
#[test]
fn a_quadrilateral_is_split_on_request() {
    for (name, form) in meshes() {
        let mesh = read_sample(&name, true);
        if matches!(form, MeshForm::Stl | MeshForm::NodeEle) {
            assert_eq!(mesh.triangles, TRIANGLES, "{name}");
            continue;
        }
        assert_eq!(mesh.triangles[..2], TRIANGLES, "{name}");
        assert_eq!(mesh.triangles[2..], [[1, 4, 5], [1, 5, 2]], "{name}");
        if has_regions(form) {
            assert_eq!(mesh.regions, [3, 4, 5, 5], "{name}");
        }
        assert!(mesh.other_cells.iter().all(|other| !other.kind.contains("uad")), "{name}");
    }
}

// spec: X20
#[test]
fn the_first_bytes_tell_most_forms() {
    for (name, form) in meshes() {
        let sniffed = MeshForm::sniff(&sample(&name));
        let is_binary_medit = name.ends_with(".meshb");
        let untold = matches!(form, MeshForm::NodeEle | MeshForm::Fort14 | MeshForm::Obj);
        if untold || is_binary_medit {
            assert_eq!(sniffed, None, "{name}");
        } else {
            assert_eq!(sniffed, Some(form), "{name}");
        }
    }
    assert_eq!(MeshForm::sniff(b""), None);
    assert_eq!(MeshForm::sniff(b"# only a comment"), None);
    assert_eq!(MeshForm::sniff(b"\xef\xbb\xbf\r\n# comment\nOFF"), Some(MeshForm::Off));
}

// spec: X20 X21
#[test]
fn every_sample_cut_anywhere_is_an_error_or_a_sound_mesh() {
    let nodes = sample("square.node");
    for (name, form) in meshes() {
        let bytes = sample(&name);
        let whole = read_sample(&name, false);
        for length in 0..bytes.len() {
            let options = ReadOptions { nodes: Some(&nodes), ..ReadOptions::default() };
            let result = read_mesh(&bytes[..length], form, &options);
            // Forms that count their lists notice a lost triangle or point; the last number of a
            // file may lose digits where nothing ends it.
            let counted = !matches!(form, MeshForm::Obj | MeshForm::Sms2dm | MeshForm::Abaqus);
            // Polygonal data may end after any of its lists.
            let counted = counted && !name.contains("polydata");
            if let (Ok(mesh), true) = (&result, counted) {
                assert_eq!(mesh.triangles.len(), whole.triangles.len(), "{name} at {length}");
                assert_eq!(mesh.points.len(), whole.points.len(), "{name} at {length}");
            }
            assert_sound(form, bytes.len() + nodes.len(), result);
        }
    }
}

// spec: X20 X32
#[test]
fn every_sample_with_one_byte_changed_does_no_harm() {
    for name in names() {
        let bytes = sample(&name);
        // A byte apart is enough for the long ones: all their sections are met.
        let step = 1 + bytes.len() / 400;
        for position in (0..bytes.len()).step_by(step) {
            for byte in [b'-', b'9', b'\n', 0xff, bytes[position] ^ 1, bytes[position] ^ 0x80] {
                let mut changed = bytes.clone();
                changed[position] = byte;
                if let Some(form) = MeshForm::from_path(Path::new(&name)) {
                    let nodes = sample("square.node");
                    let options = ReadOptions { nodes: Some(&nodes), ..ReadOptions::default() };
                    let size = 16 * changed.len() + nodes.len();
                    assert_sound(form, size, read_mesh(&changed, form, &options));
                } else {
                    let options = ReadOptions { nodes: Some(&changed), ..ReadOptions::default() };
                    let size = changed.len() + 1000;
                    let ele = sample("square.ele");
                    assert_sound(
                        MeshForm::NodeEle,
                        size,
                        read_mesh(&ele, MeshForm::NodeEle, &options),
                    );
                }
            }
        }
    }
}

// spec: X20 X32
#[test]
fn every_sample_through_every_reader_does_no_harm() {
    for name in names() {
        read_by_all(&sample(&name));
    }
}

// spec: X20
#[test]
fn segments_of_a_poly_are_the_edges_when_no_edge_file_is_given() {
    let nodes = sample("square.poly");
    let options = ReadOptions { nodes: Some(&nodes), ..ReadOptions::default() };
    let mesh = read_mesh(&sample("square.ele"), MeshForm::NodeEle, &options).unwrap();
    assert_eq!(mesh.edges, [edge([0, 1], 7), edge([3, 0], 2)]);
}

// spec: X20
#[test]
fn the_numbers_of_a_file_are_kept() {
    let mesh = read_sample("square-41.msh", false);
    assert_eq!(mesh.point_numbers, [10, 20, 30, 40, 50, 60]);
    assert_eq!(mesh.triangle_numbers, [4, 5]);
    let mesh = read_sample("square.off", false);
    assert!(mesh.point_numbers.is_empty() && mesh.triangle_numbers.is_empty());
}

/// Meshes that other programs wrote, with facts found independently; only where they lie beside
/// the checkout.
// spec: X20 X25
#[test]
fn meshes_of_other_programs_have_the_facts_of_their_manifest() {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data/meshes"));
    let Ok(manifest) = std::fs::read(folder.join("MANIFEST.json")) else { return };
    let manifest: serde_json::Value = serde_json::from_slice(&manifest).unwrap();
    for case in manifest["cases"].as_array().unwrap() {
        for name in case["files"].as_array().unwrap().iter().filter_map(|name| name.as_str()) {
            let form = MeshForm::from_path(Path::new(name)).unwrap();
            let bytes = std::fs::read(folder.join(name)).unwrap();
            let mesh = match read_mesh(&bytes, form, &ReadOptions::default()) {
                Ok(mesh) => mesh,
                // MFEM's own form, and VTK's regular grids, are refused by name.
                Err(error) => {
                    assert_eq!(error.rule(), "X26", "{name}: {error}");
                    assert!(bytes.starts_with(b"MFEM") || name.contains("matrix"), "{name}");
                    continue;
                }
            };
            let other = |kind: &str| -> u64 {
                let others = mesh.other_cells.iter().filter(|other| other.kind.contains(kind));
                others.map(|other| other.count).sum()
            };
            assert_eq!(mesh.triangles.len() as u64, case["n_tri"].as_u64().unwrap(), "{name}");
            assert_eq!(other("quad"), case["n_quad"].as_u64().unwrap(), "{name}");
            assert_eq!(other("polygon"), case["n_poly"].as_u64().unwrap(), "{name}");
            assert!(mesh.points.len() as u64 >= case["n_nodes"].as_u64().unwrap(), "{name}");
            assert!(mesh.bad_references.is_empty(), "{name}");
        }
    }
}
