//! Meshes a boundary with the spade crate: a peer for `trigrade torture --preset spade`.
//!
//! ```text
//! spade_mesher BOUNDARY.json MESH.off
//! ```
//!
//! Exit code 1 when spade refuses the boundary. Spade knows no domains: all loops become
//! constraints, and what an odd number of them winds around is kept.

use spade::{
    AngleLimit, ConstrainedDelaunayTriangulation, Point2, RefinementParameters, Triangulation,
};
use std::process::ExitCode;
use trigrade::domain::Domain;
use trigrade::format::{MeshForm, MeshView, WriteOptions, domain_json, write_mesh};
use trigrade::mesh::MeshData;

type Cdt = ConstrainedDelaunayTriangulation<Point2<f64>>;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [input, output] = &arguments[..] else {
        eprintln!("usage: spade_mesher BOUNDARY.json MESH.off");
        return ExitCode::from(2);
    };
    match run(input, output) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}

fn run(input: &str, output: &str) -> Result<(), String> {
    let bytes = std::fs::read(input).map_err(|error| error.to_string())?;
    let domain = domain_json::read(&bytes).map_err(|error| error.to_string())?;
    let mesh = mesh(&domain)?;
    let mut file = std::fs::File::create(output).map_err(|error| error.to_string())?;
    write_mesh(MeshView::from(&mesh), MeshForm::Off, WriteOptions::default(), &mut file)
        .map_err(|error| error.to_string())
}

fn mesh(domain: &Domain) -> Result<MeshData, String> {
    let mut cdt = Cdt::new();
    let mut handles = Vec::new();
    for p in &domain.points {
        handles.push(cdt.insert(Point2::new(p.x, p.y)).map_err(|error| error.to_string())?);
    }
    for [a, b] in domain.edges() {
        let [a, b] = [handles[a as usize], handles[b as usize]];
        if !cdt.can_add_constraint(a, b) {
            return Err("a segment crosses another one".to_owned());
        }
        cdt.add_constraint(a, b);
    }
    let parameters = RefinementParameters::<f64>::new()
        .exclude_outer_faces(true)
        .keep_constraint_edges()
        .with_angle_limit(AngleLimit::from_deg(20.0));
    let result = cdt.refine(parameters);
    let outside: std::collections::BTreeSet<usize> =
        result.excluded_faces.iter().map(|face| face.index()).collect();
    let points = cdt.vertices().map(|v| [v.position().x, v.position().y, 0.0]).collect();
    let faces = cdt.inner_faces().filter(|face| !outside.contains(&face.fix().index()));
    let triangles = faces.map(|face| face.vertices().map(|v| v.fix().index() as u32)).collect();
    Ok(MeshData { points, triangles, ..MeshData::default() })
}
