//! Meshes a boundary with the spade crate: a peer for `trigrade torture --preset spade`.
//!
//! ```text
//! spade_mesher BOUNDARY.json MESH.off
//! ```
//!
//! Exit code 1 when spade refuses the boundary. Spade knows no domains: loops and segments become
//! constraints, and of its triangles those are kept that an odd number of loops winds around.

use spade::handles::FixedVertexHandle;
use spade::{
    AngleLimit, ConstrainedDelaunayTriangulation, Point2, RefinementParameters, Triangulation,
};
use std::collections::BTreeMap;
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
    let loops = domain.loops.iter().flat_map(|l| l.edges());
    let mut walls = BTreeMap::new();
    for edge in loops {
        for part in constrain(&mut cdt, edge.map(|v| handles[v as usize]))? {
            *walls.entry(part).or_insert(false) ^= true;
        }
    }
    for segment in &domain.segments {
        constrain(&mut cdt, segment.vertices.map(|v| handles[v as usize]))?;
    }
    let parameters = RefinementParameters::<f64>::new()
        .keep_constraint_edges()
        .with_angle_limit(AngleLimit::from_deg(20.0));
    cdt.refine(parameters);
    let is_inside = inside(&cdt, &walls)?;
    let points = cdt.vertices().map(|v| [v.position().x, v.position().y, 0.0]).collect();
    let faces = cdt.inner_faces().filter(|face| is_inside[face.fix().index()]);
    let triangles = faces.map(|face| face.vertices().map(|v| v.fix().index() as u32)).collect();
    Ok(MeshData { points, triangles, ..MeshData::default() })
}

/// An edge by its ends, the smaller number first.
fn ends(a: FixedVertexHandle, b: FixedVertexHandle) -> [usize; 2] {
    [a.index().min(b.index()), a.index().max(b.index())]
}

/// Makes a segment an edge, or a chain of edges where vertices lie on it.
fn constrain(cdt: &mut Cdt, [a, b]: [FixedVertexHandle; 2]) -> Result<Vec<[usize; 2]>, String> {
    let parts = cdt.try_add_constraint(a, b);
    if parts.is_empty() {
        return Err("a segment crosses another one".to_owned());
    }
    let edge = |part| cdt.directed_edge(part);
    Ok(parts.into_iter().map(|part| ends(edge(part).from().fix(), edge(part).to().fix())).collect())
}

/// For each face whether an odd number of loops winds around it; from the outer face on.
fn inside(cdt: &Cdt, walls: &BTreeMap<[usize; 2], bool>) -> Result<Vec<bool>, String> {
    let mut is_inside = vec![None; cdt.num_all_faces()];
    is_inside[cdt.outer_face().fix().index()] = Some(false);
    let mut edges: Vec<_> = cdt.outer_face().adjacent_edge().map_or(Vec::new(), |edge| {
        std::iter::successors(Some(edge), |e| Some(e.next()).filter(|&n| n != edge)).collect()
    });
    while let Some(edge) = edges.pop() {
        let (here, there) = (edge.face().fix().index(), edge.rev().face().fix().index());
        let is_wall = walls.get(&ends(edge.from().fix(), edge.to().fix())) == Some(&true);
        let expected = is_inside[here].map(|inside| inside != is_wall);
        if is_inside[there].is_none() {
            is_inside[there] = expected;
            edges.extend([edge.rev().next(), edge.rev().prev()]);
        } else if is_inside[there] != expected {
            return Err("a loop does not close".to_owned());
        }
    }
    Ok(is_inside.into_iter().map(|inside| inside == Some(true)).collect())
}
