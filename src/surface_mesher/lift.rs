//! From (u, v) to space: the patches' triangles over the model's vertices, seams and shared curves
//! welded by index, poles collapsed, all facing the same way.

use super::SurfaceMeshError;
use super::outline::{Outline, Piece, Rim, is_forward};
use super::patch::PatchMesh;
use crate::mesh::{MarkedEdge, MeshData};
use crate::model::Model;
use crate::surface::Side;
use crate::vector::{cross, dot, sub};
use std::collections::VecDeque;

/// Parameters of a point that no patch has used yet.
const UNKNOWN: [f64; 2] = [f64::NAN; 2];

/// A surface mesh in the making.
pub(super) struct Weld {
    pub(super) mesh: MeshData,
    /// Parameters of each point: those on the first patch that has it.
    pub(super) parameters: Vec<[f64; 2]>,
    /// Index of the piece of each triangle.
    pieces: Vec<u32>,
}

impl Weld {
    pub(super) fn new(outline: &Outline) -> Self {
        let mesh = MeshData { points: outline.points.clone(), ..MeshData::default() };
        let parameters = vec![UNKNOWN; mesh.points.len()];
        Self { mesh, parameters, pieces: Vec::new() }
    }

    /// Adds a patch whose first points are the nodes of its outline.
    pub(super) fn add(
        &mut self,
        piece: u32,
        (marker, name): (i32, &str),
        rim: &Rim,
        patch: &PatchMesh,
    ) -> Result<(), SurfaceMeshError> {
        let nodes = &rim.nodes;
        let mut number: Vec<u32> = nodes.iter().map(|node| node.vertex).collect();
        for (node, &uv) in nodes.iter().zip(&patch.parameters) {
            self.place(node.vertex, uv);
        }
        for (lift, &uv) in patch.lifts.iter().zip(&patch.parameters).skip(nodes.len()) {
            number.push(self.mesh.points.len() as u32);
            self.mesh.points.push(lift.point);
            self.parameters.push(uv);
        }
        let sides = rim.loops().next().map_or(0, |range| range.len());
        for t in patch.mesh.triangles() {
            let local = patch.mesh.corners(t);
            let corners = local.map(|v| number[v.index()]);
            let [a, b, c] = corners;
            if a != b && b != c && c != a {
                self.mesh.triangles.push(corners);
                self.mesh.regions.push(marker);
                self.pieces.push(piece);
            } else if !is_pole(local.map(|v| v.index()), corners, sides) {
                let at = self.mesh.points[if a == b { a } else { c } as usize];
                return Err(SurfaceMeshError::Coarse { name: name.to_owned(), at });
            }
        }
        Ok(())
    }

    /// Adds a triangle of a patch, by vertices of the whole mesh.
    pub(super) fn push(&mut self, piece: u32, marker: i32, corners: [u32; 3]) {
        self.mesh.triangles.push(corners);
        self.mesh.regions.push(marker);
        self.pieces.push(piece);
    }

    /// Notes the parameters of a point that no patch has used yet.
    pub(super) fn place(&mut self, vertex: u32, uv: [f64; 2]) {
        self.parameters.resize(self.mesh.points.len(), UNKNOWN);
        let known = &mut self.parameters[vertex as usize];
        if known[0].is_nan() {
            *known = uv;
        }
    }

    /// The mesh, with marked edges, all patches facing alike, without points that nothing uses.
    pub(super) fn finish(
        mut self,
        model: &Model,
        outline: &Outline,
        rims: &[Rim],
    ) -> (MeshData, Vec<[f64; 2]>) {
        let mut facing = Facing::of(model, outline, rims);
        facing.turn_closed_outwards(&self.mesh, &self.pieces);
        for (triangle, &piece) in self.mesh.triangles.iter_mut().zip(&self.pieces) {
            if facing.turned[piece as usize] {
                triangle.swap(1, 2);
            }
        }
        for (i, shared) in outline.curves.iter().enumerate().filter(|(_, s)| s.uses > 0) {
            let at_the_end = (shared.uses == 1).then_some(i as i32 + 1);
            let Some(marker) = shared.marker.or(at_the_end) else { continue };
            let edge = |pair: &[u32]| MarkedEdge { vertices: [pair[0], pair[1]], marker };
            self.mesh.edges.extend(shared.vertices.windows(2).map(edge));
        }
        drop_unused(&mut self.mesh, &mut self.parameters);
        (self.mesh, self.parameters)
    }
}

/// Whether a triangle that is none in space stands on the side of a pole: two of its corners are
/// neighbours on the outline.
fn is_pole(local: [usize; 3], corners: [u32; 3], nodes: usize) -> bool {
    (0..3).any(|i| {
        let j = (i + 1) % 3;
        let (a, b) = (local[i], local[j]);
        corners[i] == corners[j] && a < nodes && b < nodes && (a + 1) % nodes == b
    })
}

/// A curve along the outline of a piece, counterclockwise.
#[derive(Clone, Copy)]
struct Run {
    curve: usize,
    /// Whether the outline runs against the curve.
    against: bool,
}

fn runs(piece: &Piece, rim: &Rim) -> Vec<Run> {
    let on = |side: Side| {
        let along = piece.sides[side as usize].iter();
        along.map(move |a| Run { curve: a.curve, against: a.reversed == is_forward(side) })
    };
    let sides = Side::ALL.into_iter().flat_map(on);
    let around = piece.loops.iter().zip(&rim.forward).flat_map(|(cuts, &forward)| {
        cuts.iter().map(move |cut| Run { curve: cut.curve, against: cut.reversed == forward })
    });
    sides.chain(around).collect()
}

/// Which pieces face against their normals.
struct Facing {
    turned: Vec<bool>,
    /// Of each piece, the first piece of those it hangs together with.
    part: Vec<usize>,
    /// Of each part, whether it has no boundary.
    closed: Vec<bool>,
}

impl Facing {
    /// Patches along a curve face alike when one runs along it and the other against it.
    fn of(model: &Model, outline: &Outline, rims: &[Rim]) -> Self {
        let count = outline.pieces.len();
        let runs: Vec<Vec<Run>> =
            outline.pieces.iter().zip(rims).map(|(piece, rim)| runs(piece, rim)).collect();
        let mut beside: Vec<Vec<(usize, bool)>> = vec![Vec::new(); outline.curves.len()];
        for (i, run) in runs.iter().enumerate().flat_map(|(i, r)| r.iter().map(move |r| (i, r))) {
            beside[run.curve].push((i, run.against));
        }
        let (turned, part) = (vec![false; count], vec![usize::MAX; count]);
        let mut facing = Self { turned, part, closed: vec![true; count] };
        for first in 0..count {
            if facing.part[first] == usize::MAX {
                facing.turned[first] = model.patches[outline.pieces[first].patch].reversed;
                facing.flood(first, &runs, &beside);
            }
        }
        facing
    }

    /// Turns all pieces that hang together with one as that one is turned.
    fn flood(&mut self, first: usize, runs: &[Vec<Run>], beside: &[Vec<(usize, bool)>]) {
        self.part[first] = first;
        let mut todo = VecDeque::from([first]);
        while let Some(i) = todo.pop_front() {
            for run in &runs[i] {
                let list = &beside[run.curve];
                self.closed[first] &= list.len() >= 2;
                for &(j, against) in list {
                    if self.part[j] == usize::MAX {
                        self.part[j] = first;
                        self.turned[j] = self.turned[i] != (run.against == against);
                        todo.push_back(j);
                    }
                }
            }
        }
    }

    /// Turns the closed parts whose enclosed volume would be negative.
    fn turn_closed_outwards(&mut self, mesh: &MeshData, pieces: &[u32]) {
        let mut volume = vec![0.0; self.part.len()];
        let origin = mesh.points.first().copied().unwrap_or_default();
        for (triangle, &piece) in mesh.triangles.iter().zip(pieces) {
            let [a, b, c] = triangle.map(|v| sub(mesh.points[v as usize], origin));
            let six = dot(a, cross(b, c));
            let sign = if self.turned[piece as usize] { -1.0 } else { 1.0 };
            volume[self.part[piece as usize]] += sign * six;
        }
        for i in 0..self.part.len() {
            let part = self.part[i];
            if self.closed[part] && volume[part] < 0.0 {
                self.turned[i] = !self.turned[i];
            }
        }
    }
}

/// Drops the points that no triangle uses: vertices that a tolerance has made one with others.
fn drop_unused(mesh: &mut MeshData, parameters: &mut Vec<[f64; 2]>) {
    let mut new = vec![u32::MAX; mesh.points.len()];
    for &v in mesh.triangles.iter().flatten() {
        new[v as usize] = 0;
    }
    for (slot, number) in new.iter_mut().filter(|slot| **slot == 0).zip(0..) {
        *slot = number;
    }
    let mut kept = new.iter().map(|&number| number != u32::MAX);
    mesh.points.retain(|_| kept.next() == Some(true));
    let mut kept = new.iter().map(|&number| number != u32::MAX);
    parameters.retain(|_| kept.next() == Some(true));
    for v in mesh.triangles.iter_mut().flatten() {
        *v = new[*v as usize];
    }
    for v in mesh.edges.iter_mut().flat_map(|edge| &mut edge.vertices) {
        *v = new[*v as usize];
    }
}
