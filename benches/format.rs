//! Mesh files, written and read in memory: `cargo bench --bench format -- 1080`, where the number is
//! that of squares a side (1080: 2.3 million triangles).
//!
//! Processor time of this thread where the system tells it, best of three, and megabytes of file a
//! second.

use std::hint::black_box;
use std::time::Instant;
use trigrade::format::{
    Companion, Encoding, MeshForm, MshVersion, ReadOptions, WriteOptions, read_mesh,
    write_companion, write_mesh,
};
use trigrade::mesh::{MarkedEdge, MeshData};

/// Seconds this thread has had a processor, or else seconds on the clock.
fn now(start: Instant) -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = text.and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| start.elapsed().as_secs_f64(), |time| time * 1e-9)
}

fn best<T>(mut run: impl FnMut() -> T) -> f64 {
    let start = Instant::now();
    let once = |_| {
        let before = now(start);
        black_box(run());
        now(start) - before
    };
    (0..3).map(once).fold(f64::INFINITY, f64::min)
}

/// A square of `side` by `side` squares of two triangles, with coordinates of 16 and 17 digits.
fn grid(side: u32) -> MeshData {
    let across = side + 1;
    let coordinate = |i: u32, j: u32| {
        f64::from(i) / f64::from(side) + 1e-4 * f64::from((7 * i + 13 * j) % 11) / f64::from(side)
    };
    let mut mesh = MeshData::default();
    for j in 0..across {
        mesh.points.extend((0..across).map(|i| [coordinate(i, j), coordinate(j, i), 0.0]));
    }
    for corner in (0..side).flat_map(|j| (0..side).map(move |i| j * across + i)) {
        mesh.triangles.push([corner, corner + 1, corner + across + 1]);
        mesh.triangles.push([corner, corner + across + 1, corner + across]);
    }
    mesh.edges = (0..side).map(|i| MarkedEdge { vertices: [i, i + 1], marker: 1 }).collect();
    mesh
}

fn main() {
    let side = std::env::args().find_map(|argument| argument.parse().ok()).unwrap_or(400);
    let mesh = grid(side);
    println!("{} triangles; seconds, then MB/s", mesh.triangles.len());
    println!("{:<28} {:>8} {:>16} {:>16}", "form", "MB", "write", "read");
    for form in MeshForm::ALL {
        for encoding in [Encoding::Ascii, Encoding::Binary, Encoding::Compressed] {
            for msh_version in [MshVersion::V41, MshVersion::V22] {
                let is_repeated = form != MeshForm::Msh && msh_version == MshVersion::V22;
                // Binary STL holds 32-bit floats only.
                let is_rounded = form == MeshForm::Stl && encoding == Encoding::Binary;
                if form.has_encoding(encoding) && !is_repeated && !is_rounded {
                    measure(&mesh, form, WriteOptions { encoding, msh_version });
                }
            }
        }
    }
}

fn measure(mesh: &MeshData, form: MeshForm, options: WriteOptions) {
    let write = || {
        let (mut main, mut nodes) = (Vec::new(), Vec::new());
        write_mesh(mesh.into(), form, options, &mut main).expect("memory takes every byte");
        if form == MeshForm::NodeEle {
            write_companion(mesh.into(), Companion::Nodes, &mut nodes).expect("as above");
        }
        (main, nodes)
    };
    let (main, nodes) = write();
    let read_options = ReadOptions { nodes: Some(&nodes), ..ReadOptions::default() };
    let megabytes = (main.len() + nodes.len()) as f64 * 1e-6;
    let writing = best(write);
    let reading = best(|| read_mesh(&main, form, &read_options).expect("it was written above"));
    let version =
        if form == MeshForm::Msh { format!("{:?}", options.msh_version) } else { String::new() };
    println!(
        "{:<28} {megabytes:>8.1} {writing:>7.3} {:>8.0} {reading:>7.3} {:>8.0}",
        format!("{form} {version} {:?}", options.encoding),
        megabytes / writing,
        megabytes / reading
    );
}
