//! A mesh against the surface model it should be a mesh of (SPEC 12.5).
//!
//! Uses the plain data of the model (points, tangents, sides) and nothing of the mesher: the foot
//! of each sample is searched for from a lattice of points on every patch, without the parameters
//! that the mesher knew. Distances are floats and are measured, not decided.

use super::tree3::Tree;
use crate::curve::Curve;
use crate::mesh::MeshData;
use crate::metric::{FirstForm, normal};
use crate::model::Model;
use crate::surface::{Side, Surface, Tangents};
use crate::vector::{
    Vector, add, cross, distance, dot, key, scale, segment_distance_sq, sub, unit,
};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// What is demanded of a mesh of a model.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfaceLimits {
    /// Largest distance of a sample of a triangle from the surface.
    pub chord_error: Option<f64>,
    /// Largest angle between the normals of triangle and surface, in degrees.
    pub normal_deviation_deg: Option<f64>,
}

/// What is wrong with a mesh as a mesh of its model.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceFinding {
    /// SPEC id.
    pub id: &'static str,
    /// A sentence with the measured values and places.
    pub message: String,
}

/// A mesh measured against its model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceReport {
    /// Largest distance from the surface: at centres and middles of sides.
    pub chord_error: f64,
    /// Largest distance of a vertex from the surface.
    pub vertex_error: f64,
    /// Largest angle between the normals of triangle and surface at the foot of its centre.
    pub normal_deviation_deg: f64,
    /// Vertices minus edges plus triangles.
    pub euler: i64,
    /// The same number of the model's own vertices, curves and patches.
    pub euler_of_model: i64,
    /// Edges of one triangle only.
    pub boundary_edges: usize,
    /// All findings; at most one a rule and patch.
    pub findings: Vec<SurfaceFinding>,
}

/// Points in each direction of the lattice on a patch.
const LATTICE: u32 = 25;
/// Most steps to the foot of a sample; three or four are the rule.
const FOOT_STEPS: usize = 30;
/// Most times that a step is halved.
const HALVINGS: u32 = 8;
/// Lattice points that the foot is searched from.
const SEEDS: usize = 3;
/// A vertex on the surface may be off by this fraction of the model's size: rounding.
const ROUNDING: f64 = 1e-9;

/// Measures a mesh against its model.
///
/// A triangle is measured against the patches with its region's marker; against all where the mesh
/// has no regions.
///
/// # Complexity
/// `n log m` for n triangles and m lattice points.
#[must_use]
pub fn against_model(mesh: &MeshData, model: &Model, limits: &SurfaceLimits) -> SurfaceReport {
    let sheets = Sheets::new(model);
    let measured: Vec<Option<Measured>> =
        (0..mesh.triangles.len()).into_par_iter().map(|t| sheets.measure(mesh, t)).collect();
    let mut report = SurfaceReport::default();
    for found in measured.iter().flatten() {
        report.chord_error = report.chord_error.max(found.chord_error);
        report.vertex_error = report.vertex_error.max(found.vertex_error);
        report.normal_deviation_deg = report.normal_deviation_deg.max(found.turn_deg());
    }
    report.describe_topology(mesh, model);
    report.find_deviations(&measured, limits, sheets.size);
    report.find_folds(&measured);
    report.find_boundary(mesh, model, sheets.size);
    report
}

/// A triangle against its surface.
#[derive(Clone, Copy, Debug)]
struct Measured {
    triangle: usize,
    chord_error: f64,
    vertex_error: f64,
    /// Piece of the model that the centre's foot lies on.
    piece: usize,
    /// Cosine between the normals; `None` where one of them has no direction.
    cosine: Option<f64>,
}

impl Measured {
    /// Angle between the lines of the normals.
    fn turn_deg(&self) -> f64 {
        libm::acos(self.cosine.unwrap_or(1.0).abs().clamp(0.0, 1.0)).to_degrees()
    }
}

/// The smooth pieces of a model, each with its marker, and lattices on them.
struct Sheets {
    pieces: Vec<(Surface, i32)>,
    /// A tree of lattice points for each marker, and one for all.
    trees: BTreeMap<i32, Tree<Seed>>,
    all: Tree<Seed>,
    size: f64,
}

/// A lattice point on a piece.
#[derive(Clone, Copy, Debug)]
struct Seed {
    piece: usize,
    at: [f64; 2],
}

/// The nearest point of a surface.
#[derive(Clone, Copy, Debug)]
struct Foot {
    piece: usize,
    distance: f64,
    normal: Option<Vector>,
}

impl Sheets {
    fn new(model: &Model) -> Self {
        let mut pieces = Vec::new();
        for patch in &model.patches {
            pieces.extend(patch.surface.pieces().into_iter().map(|piece| (piece, patch.marker)));
        }
        let mut lists: BTreeMap<i32, Vec<(Vector, Seed)>> = BTreeMap::new();
        for (i, (piece, marker)) in pieces.iter().enumerate() {
            lists.entry(*marker).or_default().extend(lattice(i, piece));
        }
        let all = Tree::new(lists.values().flatten().copied().collect());
        let size = all.diagonal();
        let trees = lists.into_iter().map(|(marker, list)| (marker, Tree::new(list))).collect();
        Self { pieces, trees, all, size }
    }

    fn measure(&self, mesh: &MeshData, t: usize) -> Option<Measured> {
        let corners = mesh.triangles[t].map(|v| mesh.points.get(v as usize).copied());
        let [a, b, c] = [corners[0]?, corners[1]?, corners[2]?];
        let tree = mesh.regions.get(t).and_then(|marker| self.trees.get(marker));
        let tree = tree.unwrap_or(&self.all);
        let middle = |p: Vector, q: Vector| scale(0.5, add(p, q));
        let centre = self.foot(tree, scale(1.0 / 3.0, add(a, add(b, c))));
        let sides = [middle(a, b), middle(b, c), middle(c, a)];
        let worst = |points: [Vector; 3]| {
            points.map(|p| self.foot(tree, p).distance).into_iter().fold(0.0, f64::max)
        };
        let up = unit(cross(sub(b, a), sub(c, a)));
        let cosine = up.zip(centre.normal).map(|(up, normal)| dot(up, normal));
        Some(Measured {
            triangle: t,
            chord_error: worst(sides).max(centre.distance),
            vertex_error: worst([a, b, c]),
            piece: centre.piece,
            cosine,
        })
    }

    /// The nearest point of the surface, from the nearest lattice points.
    fn foot(&self, tree: &Tree<Seed>, p: Vector) -> Foot {
        let mut best = Foot { piece: 0, distance: f64::INFINITY, normal: None };
        for (_, seed) in tree.nearest(p, SEEDS) {
            let foot = self.foot_from(seed, p);
            if foot.distance < best.distance {
                best = foot;
            }
        }
        best
    }

    /// Gauss and Newton's steps, kept in the rectangle of parameters; a step that leads farther away
    /// is halved.
    fn foot_from(&self, seed: Seed, p: Vector) -> Foot {
        let surface = &self.pieces[seed.piece].0;
        let mut at = seed.at;
        let mut tangents = surface.tangents(at[0], at[1]);
        let mut nearest = distance(p, tangents.point);
        for _ in 0..FOOT_STEPS {
            let step = foot_step(&tangents, sub(p, tangents.point), at, surface.domain());
            let closer = (0..HALVINGS).find_map(|halvings| {
                let part = 1.0 / f64::from(1_u32 << halvings);
                let place = clamped([at[0] + part * step[0], at[1] + part * step[1]], surface);
                let there = surface.tangents(place[0], place[1]);
                // A pole has no way on: all directions but one are the same point.
                (distance(p, there.point) < nearest && normal(&there).is_some())
                    .then_some((place, there))
            });
            let Some((place, there)) = closer else { break };
            let gain = nearest - distance(p, there.point);
            (at, tangents, nearest) = (place, there, nearest - gain);
            if gain <= 1e-14 * self.size {
                break;
            }
        }
        Foot { piece: seed.piece, distance: nearest, normal: normal(&tangents) }
    }
}

fn clamped([u, v]: [f64; 2], surface: &Surface) -> [f64; 2] {
    let [[u0, u1], [v0, v1]] = surface.domain();
    [u.clamp(u0, u1), v.clamp(v0, v1)]
}

/// Newton's step towards the foot in the tangent plane. On a side of the rectangle that the step
/// would leave, and where the map is singular, the step is the best one along the other parameter.
fn foot_step(tangents: &Tangents, gap: Vector, at: [f64; 2], domain: [[f64; 2]; 2]) -> [f64; 2] {
    let FirstForm { e, f, g } = FirstForm::new(tangents);
    let (du, dv) = (dot(gap, tangents.u), dot(gap, tangents.v));
    let determinant = e * g - f * f;
    let step = [(g * du - f * dv) / determinant, (e * dv - f * du) / determinant];
    let alone = |d: f64, length_sq: f64| if length_sq > 0.0 { d / length_sq } else { 0.0 };
    if determinant <= 1e-24 * e * g || !step.iter().all(|x| x.is_finite()) {
        return [alone(du, e), alone(dv, g)];
    }
    let leaves = |i: usize| {
        (at[i] <= domain[i][0] && step[i] < 0.0) || (at[i] >= domain[i][1] && step[i] > 0.0)
    };
    match (leaves(0), leaves(1)) {
        (false, false) => step,
        (true, false) => [0.0, alone(dv, g)],
        (false, true) => [alone(du, e), 0.0],
        (true, true) => [alone(du, e), alone(dv, g)],
    }
}

/// The centres of equal rectangles: never on a side, since all parameters of a pole are one point
/// and most of them lead away from the foot.
fn lattice(piece: usize, surface: &Surface) -> impl Iterator<Item = (Vector, Seed)> + '_ {
    let [[u0, u1], [v0, v1]] = surface.domain();
    let step = |i: u32| (f64::from(i) + 0.5) / f64::from(LATTICE);
    (0..LATTICE.pow(2)).map(move |k| {
        let (i, j) = (k % LATTICE, k / LATTICE);
        let at = [u0 + step(i) * (u1 - u0), v0 + step(j) * (v1 - v0)];
        (surface.at(at[0], at[1]), Seed { piece, at })
    })
}

impl SurfaceReport {
    fn find(&mut self, id: &'static str, message: String) {
        self.findings.push(SurfaceFinding { id, message });
    }

    fn describe_topology(&mut self, mesh: &MeshData, model: &Model) {
        let used: BTreeSet<u32> = mesh.triangles.iter().flatten().copied().collect();
        let edges = undirected(mesh);
        self.boundary_edges = edges.iter().filter(|(_, count)| *count == 1).count();
        self.euler = used.len() as i64 - edges.len() as i64 + mesh.triangles.len() as i64;
        let complex = Complex::of(model);
        self.euler_of_model = complex.euler();
        if self.euler != self.euler_of_model {
            let (found, wanted) = (self.euler, self.euler_of_model);
            self.find("S10", format!("the mesh has the Euler number {found}, the model {wanted}"));
        }
    }

    fn find_deviations(
        &mut self,
        measured: &[Option<Measured>],
        limits: &SurfaceLimits,
        size: f64,
    ) {
        let off: Vec<&Measured> =
            measured.iter().flatten().filter(|m| m.vertex_error > ROUNDING * size).collect();
        if let Some(worst) = off.first() {
            let (count, triangle, by) = (off.len(), worst.triangle, self.vertex_error);
            self.find("S8", format!("{count} triangles have a corner that is not on the surface, by up to {by:e}; the first is triangle {triangle}"));
        }
        if let Some(limit) = limits.chord_error
            && let Some(first) = measured.iter().flatten().find(|m| m.chord_error > limit)
        {
            let (triangle, worst) = (first.triangle, self.chord_error);
            self.find("S8", format!("the chord error is {worst:e}, above the limit of {limit:e}; triangle {triangle} is the first above it"));
        }
        if let Some(limit) = limits.normal_deviation_deg
            && let Some(first) = measured.iter().flatten().find(|m| m.turn_deg() > limit)
        {
            let (triangle, worst) = (first.triangle, self.normal_deviation_deg);
            self.find("S8", format!("a triangle's normal is {worst:.2} degrees off the surface's, above the limit of {limit}; triangle {triangle} is the first above it"));
        }
    }

    /// Triangles that face against most others of their piece.
    fn find_folds(&mut self, measured: &[Option<Measured>]) {
        let facing = || measured.iter().flatten().filter_map(|m| m.cosine.map(|c| (m, c < 0.0)));
        let mut votes: BTreeMap<usize, [u64; 2]> = BTreeMap::new();
        for (m, is_against) in facing() {
            votes.entry(m.piece).or_default()[usize::from(is_against)] += 1;
        }
        let mut folded = facing().filter_map(|(m, is_against)| {
            let [with, against] = votes[&m.piece];
            (is_against != (against > with)).then_some(m)
        });
        if let Some(first) = folded.next() {
            let (count, triangle) = (1 + folded.count(), first.triangle);
            self.find("S9", format!("{count} triangles face against the others of their patch; the first is triangle {triangle}"));
        }
    }

    /// The mesh ends where the model ends, and the corners of the model are vertices.
    fn find_boundary(&mut self, mesh: &MeshData, model: &Model, size: f64) {
        let complex = Complex::of(model);
        let ends: Vec<&Curve> =
            complex.curves.iter().filter(|(_, uses)| *uses == 1).map(|(curve, _)| curve).collect();
        let polygons: Vec<Vec<Vector>> = ends.iter().map(|curve| polygon(curve)).collect();
        let known: BTreeSet<[u64; 3]> = mesh.points.iter().map(|&p| key(p)).collect();
        let is_there = |p: Vector| {
            let close = |tolerance| mesh.points.iter().any(|&q| distance(p, q) <= tolerance);
            known.contains(&key(p)) || model.corner_tolerance.is_some_and(close)
        };
        let corners = complex.curves.iter().flat_map(|(curve, _)| curve.ends());
        if let Some(p) = corners.into_iter().find(|&p| !is_there(p)) {
            self.find("S11", format!("the corner of the model at {p:?} is no vertex of the mesh"));
        }
        let boundary = undirected(mesh).into_iter().filter(|(_, count)| *count == 1);
        let off = boundary.flat_map(|(edge, _)| edge).find(|&v| {
            let p = mesh.points[v as usize];
            !ends.iter().zip(&polygons).any(|(curve, polygon)| is_on(curve, polygon, p, size))
        });
        if let Some(v) = off {
            let p = mesh.points[v as usize];
            self.find(
                "S11",
                format!("the mesh ends at vertex {v} at {p:?}, where the model does not"),
            );
        }
    }
}

/// Parts of a curve's polygon.
const POLYGON: usize = 64;

fn polygon(curve: &Curve) -> Vec<Vector> {
    let [start, end] = curve.domain();
    (0..=POLYGON).map(|i| curve.at(start + (end - start) * (i as f64 / POLYGON as f64))).collect()
}

/// Whether a point lies on a curve up to rounding: Newton's steps from the nearest parts of its
/// polygon.
fn is_on(curve: &Curve, polygon: &[Vector], p: Vector, size: f64) -> bool {
    let [start, end] = curve.domain();
    let mut order: Vec<usize> = (0..POLYGON).collect();
    let away = |i: usize| segment_distance_sq(polygon[i], polygon[i + 1], p);
    order.sort_by(|&i, &j| away(i).total_cmp(&away(j)));
    order.into_iter().take(3).any(|i| {
        let mut t = start + (end - start) * ((i as f64 + 0.5) / POLYGON as f64);
        for _ in 0..20 {
            let jet = curve.jet(t);
            let step = dot(sub(p, jet.point), jet.first) / dot(jet.first, jet.first);
            t = if step.is_finite() { (t + step).clamp(start, end) } else { t };
        }
        distance(curve.at(t), p) <= ROUNDING * size
    })
}

/// Edges with the number of triangles at each.
fn undirected(mesh: &MeshData) -> Vec<([u32; 2], usize)> {
    let mut all: Vec<[u32; 2]> = mesh
        .triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    all.par_sort_unstable();
    all.chunk_by(|a, b| a == b).map(|run| (run[0], run.len())).collect()
}

/// The model as a complex of vertices, curves and patches.
struct Complex {
    /// Each curve once, with the number of sides that it is.
    curves: Vec<(Curve, u32)>,
    poles: BTreeSet<[u64; 3]>,
    faces: usize,
}

impl Complex {
    fn of(model: &Model) -> Self {
        let mut complex = Self { curves: Vec::new(), poles: BTreeSet::new(), faces: 0 };
        let mut by_ends: BTreeMap<[[u64; 3]; 2], Vec<usize>> = BTreeMap::new();
        for piece in model.patches.iter().flat_map(|patch| patch.surface.pieces()) {
            complex.faces += 1;
            for side in Side::ALL.map(|side| piece.side(side)) {
                if side.is_point() {
                    complex.poles.insert(key(side.ends()[0]));
                    continue;
                }
                for curve in side.pieces() {
                    let mut ends = curve.ends().map(key);
                    ends.sort_unstable();
                    let known = by_ends.entry(ends).or_default();
                    let same = |&&i: &&usize| complex.curves[i].0.same_as(&curve).is_some();
                    match known.iter().find(same) {
                        Some(&i) => complex.curves[i].1 += 1,
                        None => {
                            known.push(complex.curves.len());
                            complex.curves.push((curve, 1));
                        }
                    }
                }
            }
        }
        complex
    }

    fn euler(&self) -> i64 {
        let ends = self.curves.iter().flat_map(|(curve, _)| curve.ends().map(key));
        let vertices: BTreeSet<[u64; 3]> = ends.chain(self.poles.iter().copied()).collect();
        vertices.len() as i64 - self.curves.len() as i64 + self.faces as i64
    }
}
