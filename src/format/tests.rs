//! Laws that hold for every form: what is written reads back the same, and no bytes do harm.

mod faults;
mod hostile;
mod numbers;
mod round_trip;
mod samples;

use super::*;
use crate::mesh::MarkedEdge;

/// The bytes of a mesh in one form: main file, points file, edges file.
#[derive(Clone, Debug, Default)]
struct Files {
    main: Vec<u8>,
    nodes: Option<Vec<u8>>,
    edges: Option<Vec<u8>>,
}

impl Files {
    fn write(mesh: &MeshData, form: MeshForm, options: WriteOptions) -> Self {
        let mut files = Self::default();
        write_mesh(mesh.into(), form, options, &mut files.main).unwrap();
        for &companion in form.companions() {
            let mut bytes = Vec::new();
            write_companion(mesh.into(), companion, &mut bytes).unwrap();
            match companion {
                Companion::Nodes => files.nodes = Some(bytes),
                Companion::Edges => files.edges = Some(bytes),
            }
        }
        files
    }

    fn read(&self, form: MeshForm) -> Result<MeshData, ReadError> {
        let options = ReadOptions {
            nodes: self.nodes.as_deref(),
            edges: self.edges.as_deref(),
            ..ReadOptions::default()
        };
        read_mesh(&self.main, form, &options)
    }
}

/// Every way to write a mesh that can be read again.
fn ways() -> Vec<(MeshForm, WriteOptions)> {
    let mut ways = Vec::new();
    for form in MeshForm::ALL.into_iter().filter(|form| form.is_written()) {
        for encoding in [Encoding::Ascii, Encoding::Binary, Encoding::Compressed] {
            for msh_version in [MshVersion::V41, MshVersion::V22] {
                let is_other = form != MeshForm::Msh && msh_version == MshVersion::V22;
                if form.has_encoding(encoding) && !is_other {
                    ways.push((form, WriteOptions { encoding, msh_version }));
                }
            }
        }
    }
    ways
}

/// Two triangles, with coordinates that 32-bit floats hold, in two regions with three marked edges.
fn square() -> MeshData {
    MeshData {
        points: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.125, 0.0], [-0.0, 0.375, 0.0]],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        edges: vec![edge([0, 1], 7), edge([1, 2], 7), edge([2, 0], 2)],
        regions: vec![3, 1],
        ..MeshData::default()
    }
}

fn edge(vertices: [u32; 2], marker: i32) -> MarkedEdge {
    MarkedEdge { vertices, marker }
}
