//! Cells of structured grids as quadrilaterals, written and read back.

use trigrade::format::{
    Encoding, MeshForm, MeshView, MshVersion, ReadOptions, WriteError, WriteOptions, read_mesh,
    write_mesh,
};
use trigrade::mesh::{MarkedEdge, MeshData};
use trigrade::structured::pair_up;

/// Three by two cells in two regions, the diagonals alternating, two marked edges.
fn grid() -> MeshData {
    let point = |k: u32| [f64::from(k % 4), f64::from(k / 4) + 0.1 * f64::from(k % 3), 0.25];
    let mut triangles = Vec::new();
    let mut regions = Vec::new();
    for k in 0..6_u32 {
        let a = k % 3 + 4 * (k / 3);
        let [b, c, d] = [a + 1, a + 5, a + 4];
        triangles.extend(match k % 2 {
            0 => [[a, b, c], [a, c, d]],
            _ => [[a, b, d], [b, c, d]],
        });
        regions.extend([1 + k as i32 / 4; 2]);
    }
    let edges = [([0, 1], 7), ([3, 7], 9)];
    let edges = edges.map(|(vertices, marker)| MarkedEdge { vertices, marker }).to_vec();
    MeshData {
        points: (0..12).map(point).collect(),
        triangles,
        regions,
        edges,
        ..MeshData::default()
    }
}

const FORMS: [MeshForm; 6] = [
    MeshForm::Msh,
    MeshForm::Vtu,
    MeshForm::VtkLegacy,
    MeshForm::Off,
    MeshForm::Obj,
    MeshForm::Su2,
];

fn written(mesh: &MeshData, form: MeshForm, options: WriteOptions) -> Result<Vec<u8>, WriteError> {
    let view = MeshView::from(mesh).with_quads().expect("pairs");
    let mut bytes = Vec::new();
    write_mesh(view, form, options, &mut bytes)?;
    Ok(bytes)
}

fn read(bytes: &[u8], form: MeshForm, split_quads: bool) -> MeshData {
    read_mesh(bytes, form, &ReadOptions { split_quads, ..ReadOptions::default() }).expect("a mesh")
}

// spec: W9
#[test]
fn every_form_version_and_encoding_gives_the_triangles_back() {
    let mut mesh = grid();
    let before = mesh.clone();
    pair_up(&mut mesh.triangles).expect("cells");
    let turned = |t: [u32; 3]| (0..3).map(move |k| [t[k], t[(k + 1) % 3], t[(k + 2) % 3]]);
    for pair in before.triangles.chunks(2).zip(mesh.triangles.chunks(2)) {
        assert!(pair.0.iter().all(|&t| turned(t).any(|t| pair.1.contains(&t))), "{pair:?}");
    }
    let mut ways = 0;
    for form in FORMS {
        for encoding in [Encoding::Ascii, Encoding::Binary, Encoding::Compressed] {
            for msh_version in [MshVersion::V41, MshVersion::V22] {
                let options = WriteOptions { encoding, msh_version };
                let bytes = match written(&mesh, form, options) {
                    Ok(bytes) => bytes,
                    Err(WriteError::Encoding { .. }) => continue,
                    Err(error) => panic!("{form}: {error}"),
                };
                ways += 1;
                let whole = read(&bytes, form, false);
                assert!(whole.triangles.is_empty(), "{form}");
                assert_eq!(whole.other_cells.iter().map(|c| c.count).sum::<u64>(), 6, "{form}");
                let split = read(&bytes, form, true);
                assert_eq!(split.triangles, mesh.triangles, "{form} {encoding:?} {msh_version:?}");
                assert_eq!(split.points, mesh.points, "{form}");
                if form.carries_regions() {
                    assert_eq!(split.regions, mesh.regions, "{form}");
                }
                if form.carries_edges() {
                    assert_eq!(split.edges, mesh.edges, "{form}");
                }
            }
        }
    }
    assert!(ways >= 14, "{ways}");
}

// spec: W9
#[test]
fn forms_without_quadrilaterals_and_meshes_without_cells_are_refused() {
    let mut mesh = grid();
    assert!(MeshView::from(&mesh).with_quads().is_none(), "not paired up yet");
    pair_up(&mut mesh.triangles).expect("cells");
    for form in MeshForm::ALL.into_iter().filter(|form| form.is_written() && !FORMS.contains(form))
    {
        let refused = written(&mesh, form, WriteOptions::default());
        assert!(matches!(refused, Err(WriteError::Carry { .. })), "{form}");
    }
    let mut odd = mesh.clone();
    odd.triangles.pop();
    odd.regions.pop();
    assert!(MeshView::from(&odd).with_quads().is_none());
    let mut torn = mesh.clone();
    torn.regions[1] = 5;
    assert!(MeshView::from(&torn).with_quads().is_none(), "a cell lies in one region");
}

// spec: W9 W11
#[test]
fn quadrilaterals_and_triangles_stand_in_one_file() {
    let mut mesh = grid();
    pair_up(&mut mesh.triangles).expect("cells");
    // Two cells stay four triangles: those at a pole of a grid.
    for form in FORMS {
        for encoding in [Encoding::Ascii, Encoding::Binary, Encoding::Compressed] {
            for msh_version in [MshVersion::V41, MshVersion::V22] {
                let view = MeshView::from(&mesh).with_first_quads(4).expect("pairs");
                let options = WriteOptions { encoding, msh_version };
                let mut bytes = Vec::new();
                match write_mesh(view, form, options, &mut bytes) {
                    Ok(()) => {}
                    Err(WriteError::Encoding { .. }) => continue,
                    Err(error) => panic!("{form}: {error}"),
                }
                let whole = read(&bytes, form, false);
                assert_eq!(whole.triangles, mesh.triangles[8..], "{form} {encoding:?}");
                assert_eq!(whole.other_cells.iter().map(|c| c.count).sum::<u64>(), 4, "{form}");
                let split = read(&bytes, form, true);
                assert_eq!(split.triangles, mesh.triangles, "{form} {encoding:?} {msh_version:?}");
                if form.carries_regions() {
                    assert_eq!(split.regions, mesh.regions, "{form}");
                }
                if form.carries_edges() {
                    assert_eq!(split.edges, mesh.edges, "{form}");
                }
            }
        }
    }
    assert!(MeshView::from(&mesh).with_first_quads(7).is_none(), "there are but six");
    assert!(MeshView::from(&mesh).with_first_quads(usize::MAX).is_none());
}
