//! Target: the readers of meshes. Any bytes give a mesh or an error with a place; what was read can
//! be written, and reads back the same.

use trigrade::format::{
    MeshForm, MeshView, READERS, ReadOptions, WriteOptions, read_mesh, write_mesh,
};
use trigrade::mesh::MeshData;

/// One input: the first byte chooses the form, the rest is the file (for Triangle's pair of files,
/// the two halves of the rest).
pub fn run(bytes: &[u8]) {
    let Some((&choice, file)) = bytes.split_first() else { return };
    let form = READERS[usize::from(choice) % READERS.len()].0;
    let (file, nodes) = match form {
        MeshForm::NodeEle => file.split_at(file.len() / 2),
        _ => (file, &[][..]),
    };
    let options = ReadOptions {
        nodes: (!nodes.is_empty()).then_some(nodes),
        split_quads: choice & 64 != 0,
        ..ReadOptions::default()
    };
    match read_mesh(file, form, &options) {
        Ok(mesh) => {
            let size = mesh.points.len() + mesh.triangles.len();
            // What VTU compresses may expand to 16 MiB and 256 times the file (SPEC X29); a triangle
            // or a point takes at least 3 bytes of it.
            let most = match form {
                MeshForm::Vtu => (16 << 20) + 256 * bytes.len(),
                _ => 2 * bytes.len(),
            };
            assert!(size <= most, "{size} items from {} bytes", bytes.len());
            assert_survives_off(&mesh);
        }
        Err(error) => assert!(!error.to_string().is_empty() && !error.rule().is_empty()),
    }
}

fn assert_survives_off(mesh: &MeshData) {
    let mut off = Vec::new();
    let written =
        write_mesh(MeshView::from(mesh), MeshForm::Off, WriteOptions::default(), &mut off);
    // A mesh that names points it does not have is refused.
    if written.is_err() {
        return;
    }
    let again = read_mesh(&off, MeshForm::Off, &ReadOptions::default())
        .unwrap_or_else(|e| panic!("{e}: {}", String::from_utf8_lossy(&off)));
    assert_eq!(again.triangles, mesh.triangles);
    let bits = |mesh: &MeshData| -> Vec<[u64; 3]> {
        // NaNs are one in text.
        let bits = |c: f64| if c.is_nan() { f64::NAN.to_bits() } else { c.to_bits() };
        mesh.points.iter().map(|p| p.map(bits)).collect()
    };
    assert_eq!(bits(&again), bits(mesh));
}
