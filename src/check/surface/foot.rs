//! The nearest points of a model's surfaces.
//!
//! Triangles are measured one after the other in runs of fixed length: a foot is searched for from
//! the foot of a neighbour, which is a step or two away, and from a lattice of points on every patch
//! only where there is none or where the foot found is too far to be believed.

use super::super::tree3::Tree;
use crate::mesh::MeshData;
use crate::metric::{FirstForm, normal};
use crate::model::Model;
use crate::surface::{Surface, Tangents};
use crate::vector::{Vector, add, along, cross, distance, dot, norm_sq, scale, sub, unit};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Points in each direction of the lattice on a patch.
const LATTICE: u32 = 25;
/// Most steps to the foot of a sample; two or three are the rule.
const FOOT_STEPS: usize = 30;
/// Most times that a step is halved.
const HALVINGS: u32 = 8;
/// Lattice points that the foot is searched from.
const SEEDS: usize = 3;
/// As many for a vertex that those few do not show to lie on the surface: where patches cross or
/// touch, the nearest lattice points may all be on the wrong one.
const SEEDS_OF_VERTEX: usize = 60;
/// Of those, one in this many steps of the lattice in either direction.
const PART: f64 = 5.5;
/// As many for a vertex that those do not show to lie on the surface either, and how many vertices of a
/// run may be searched for so in vain: a mesh that is off the surface is so in most of its vertices.
const SEEDS_OF_LOST: usize = 400;
const LOST: u32 = 8;
/// A vertex on the surface may be off by this fraction of the model's size: rounding.
pub(super) const ROUNDING: f64 = 1e-9;
/// Triangles in a run.
const RUN: usize = 8192;
/// A determinant below this fraction of the largest there can be counts as 0: as at poles.
const FLAT: f64 = 1e-24;
/// The tangents of no place.
const NOWHERE: Tangents = Tangents { point: [0.0; 3], u: [0.0; 3], v: [0.0; 3] };
/// Slots of the two memories of a run.
const SLOTS: usize = 4096;
/// A sample farther from the foot found than this fraction of the longest side is searched for anew.
const BELIEVED: f64 = 0.25;
/// Steps shorter than this fraction of the distance change it by half the square of it: less than a
/// part in ten thousand.
const STEP_OF_DISTANCE: f64 = 1e-2;
/// Steps shorter than this fraction of the model's size are rounding.
const STEP_OF_SIZE: f64 = 1e-13;

/// A triangle against its surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measured {
    pub(super) triangle: u32,
    pub(super) chord_error: f64,
    pub(super) vertex_error: f64,
    /// Piece of the model that the centre's foot lies on.
    pub(super) piece: usize,
    /// Cosine between the normals; `None` where one of them has no direction.
    pub(super) cosine: Option<f64>,
}

impl Measured {
    /// Angle between the lines of the normals.
    pub(super) fn turn_deg(&self) -> f64 {
        libm::acos(self.cosine.unwrap_or(1.0).abs().clamp(0.0, 1.0)).to_degrees()
    }
}

/// The smooth pieces of a model, each with its marker, and lattices on them.
pub(super) struct Sheets {
    pieces: Vec<(Surface, i32)>,
    /// The rectangle of parameters of each.
    domains: Vec<[[f64; 2]; 2]>,
    /// A tree of lattice points for each marker.
    trees: BTreeMap<i32, Tree<Seed>>,
    /// One for all, where the mesh has triangles without a marker of the model.
    all: Option<Tree<Seed>>,
    /// Largest chord error allowed, if any.
    limit: Option<f64>,
    pub(super) size: f64,
}

/// A place on a piece.
#[derive(Clone, Copy, Debug)]
struct Seed {
    piece: usize,
    at: [f64; 2],
}

/// The nearest point of a surface.
#[derive(Clone, Copy, Debug)]
struct Foot {
    seed: Seed,
    distance: f64,
    tangents: Tangents,
}

/// The foot of a corner, and what it says of the feet of points near it.
#[derive(Clone, Copy, Debug)]
struct Corner {
    seed: Seed,
    distance: f64,
    /// The vectors whose products with a step in space are the steps in u and v; 0 at poles.
    dual: [Vector; 2],
}

impl Corner {
    fn new(foot: &Foot) -> Self {
        let Tangents { u, v, .. } = foot.tangents;
        let FirstForm { e, f, g } = FirstForm::new(&foot.tangents);
        let determinant = e * g - f * f;
        let dual = match determinant > FLAT * e * g {
            true => [along(scale(g, u), -f, v), along(scale(e, v), -f, u)]
                .map(|w| scale(1.0 / determinant, w)),
            false => [[0.0; 3]; 2],
        };
        Self { seed: foot.seed, distance: foot.distance, dual }
    }

    /// How the parameters change along a step in space.
    fn step(&self, step: Vector) -> [f64; 2] {
        self.dual.map(|w| dot(w, step))
    }
}

impl Sheets {
    pub(super) fn new(model: &Model, mesh: &MeshData, limit: Option<f64>) -> Self {
        let mut pieces = Vec::new();
        for patch in &model.patches {
            pieces.extend(patch.surface.pieces().into_iter().map(|piece| (piece, patch.marker)));
        }
        let mut lists: BTreeMap<i32, Vec<(Vector, Seed)>> = BTreeMap::new();
        for (i, (piece, marker)) in pieces.iter().enumerate() {
            lists.entry(*marker).or_default().extend(lattice(i, piece));
        }
        let is_known = |t: usize| mesh.regions.get(t).is_some_and(|m| lists.contains_key(m));
        let needs_all = !(0..mesh.triangles.len()).all(is_known);
        let every = || lists.values().flatten().copied().collect();
        let size = diagonal(lists.values().flatten().map(|(p, _)| *p));
        let all = needs_all.then(|| Tree::new(every()));
        let trees = lists.into_iter().map(|(marker, list)| (marker, Tree::new(list))).collect();
        let domains = pieces.iter().map(|(piece, _)| piece.domain()).collect();
        Self { pieces, domains, trees, all, limit, size }
    }

    /// Measures all triangles, in their order; the same for any number of threads.
    pub(super) fn measure(&self, mesh: &MeshData) -> Vec<Measured> {
        let count = mesh.triangles.len();
        let run = |first: usize| {
            let mut walk = Walk::new(self, mesh);
            (first..(first + RUN).min(count)).filter_map(|t| walk.measure(t)).collect()
        };
        let runs: Vec<Vec<Measured>> =
            (0..count.div_ceil(RUN)).into_par_iter().map(|i| run(i * RUN)).collect();
        runs.concat()
    }

    /// Lattice points for a triangle's marker, and whether a piece is one of theirs.
    fn candidates(&self, marker: Option<i32>) -> Option<(&Tree<Seed>, Option<i32>)> {
        match marker.and_then(|m| Some((self.trees.get(&m)?, m))) {
            Some((tree, marker)) => Some((tree, Some(marker))),
            None => self.all.as_ref().map(|tree| (tree, None)),
        }
    }

    /// The nearest point of the surface, from the nearest lattice points.
    fn foot(&self, tree: &Tree<Seed>, p: Vector, seeds: usize) -> Foot {
        let none = Seed { piece: 0, at: [0.0; 2] };
        let mut best = Foot { seed: none, distance: f64::INFINITY, tangents: NOWHERE };
        let mut tried: Vec<Seed> = Vec::new();
        for (_, seed) in tree.nearest(p, seeds) {
            if seeds > SEEDS && tried.iter().any(|other| self.are_near(other, &seed)) {
                continue;
            }
            tried.push(seed);
            let foot = self.foot_from(seed, p);
            if foot.distance < best.distance {
                best = foot;
            }
        }
        best
    }

    /// The nearest point of the surface from many lattice points, neighbours among them, up to the first
    /// that is near enough: for vertices on surfaces with more waves than the lattice has points.
    fn foot_of_many(&self, tree: &Tree<Seed>, p: Vector, enough: f64) -> Option<Foot> {
        let seeds = tree.nearest(p, SEEDS_OF_LOST).into_iter();
        seeds.map(|(_, seed)| self.foot_from(seed, p)).find(|foot| foot.distance <= enough)
    }

    /// Whether two places are the same part of the same piece, whose foot either of them finds.
    fn are_near(&self, a: &Seed, b: &Seed) -> bool {
        let domain = self.domains[a.piece];
        let reach = |i: usize| PART / f64::from(LATTICE) * (domain[i][1] - domain[i][0]);
        a.piece == b.piece && (0..2).all(|i| (a.at[i] - b.at[i]).abs() <= reach(i))
    }

    /// Gauss and Newton's steps, kept in the rectangle of parameters; a step that leads farther away
    /// is halved.
    fn foot_from(&self, seed: Seed, p: Vector) -> Foot {
        let surface = &self.pieces[seed.piece].0;
        let domain = self.domains[seed.piece];
        let mut at = seed.at;
        let mut tangents = surface.tangents(at[0], at[1]);
        let mut gap = sub(p, tangents.point);
        let mut nearest_sq = norm_sq(gap);
        let rounding_sq = STEP_OF_SIZE * self.size * STEP_OF_SIZE * self.size;
        for _ in 0..FOOT_STEPS {
            // No step is longer than the distance.
            if nearest_sq <= rounding_sq {
                break;
            }
            let step = foot_step(&tangents, gap, at, domain);
            let place = clamped([at[0] + step[0], at[1] + step[1]], domain);
            let (du, dv) = (place[0] - at[0], place[1] - at[1]);
            let moved_sq = norm_sq(along(scale(du, tangents.u), dv, tangents.v));
            if moved_sq <= STEP_OF_DISTANCE * STEP_OF_DISTANCE * nearest_sq
                || moved_sq <= rounding_sq
            {
                break;
            }
            let closer = (0..HALVINGS).find_map(|halvings| {
                let part = 1.0 / f64::from(1_u32 << halvings);
                let place = clamped([at[0] + part * step[0], at[1] + part * step[1]], domain);
                let there = surface.tangents(place[0], place[1]);
                let gap = sub(p, there.point);
                // A pole has no way on: all directions but one are the same point.
                (norm_sq(gap) < nearest_sq && cross(there.u, there.v) != [0.0; 3])
                    .then_some((place, there, gap))
            });
            let Some((place, there, away)) = closer else { break };
            (at, tangents, gap, nearest_sq) = (place, there, away, norm_sq(away));
        }
        let seed = Seed { piece: seed.piece, at };
        Foot { seed, distance: nearest_sq.sqrt(), tangents }
    }
}

/// Triangles one after the other, and what is remembered of those before.
struct Walk<'a> {
    sheets: &'a Sheets,
    mesh: &'a MeshData,
    /// Feet of vertices, at the slots of their numbers.
    feet: Vec<(u32, Corner)>,
    /// Distances of the middles of edges, at the slots of their ends.
    middles: Vec<([u32; 2], Option<i32>, f64)>,
    /// Vertices whose foot has been searched for from many places in vain.
    lost: u32,
}

/// Places to look for the foot of a mean of N points from: one if all are on the same piece.
enum Between<const N: usize> {
    One(Seed),
    Several([Seed; N]),
}

/// What a triangle may be measured against, and how far is too far.
struct Against<'a> {
    tree: &'a Tree<Seed>,
    marker: Option<i32>,
    believed: f64,
}

impl<'a> Walk<'a> {
    fn new(sheets: &'a Sheets, mesh: &'a MeshData) -> Self {
        let nowhere = Seed { piece: 0, at: [0.0; 2] };
        let none = Corner { seed: nowhere, distance: f64::INFINITY, dual: [[0.0; 3]; 2] };
        let feet = vec![(u32::MAX, none); SLOTS];
        Self { sheets, mesh, feet, middles: vec![([u32::MAX; 2], None, 0.0); SLOTS], lost: 0 }
    }

    fn measure(&mut self, t: usize) -> Option<Measured> {
        let vertices = self.mesh.triangles[t];
        let corners = vertices.map(|v| self.mesh.points.get(v as usize).copied());
        let [a, b, c] = [corners[0]?, corners[1]?, corners[2]?];
        let (tree, marker) = self.sheets.candidates(self.mesh.regions.get(t).copied())?;
        let longest_sq =
            [sub(b, a), sub(c, b), sub(a, c)].map(norm_sq).into_iter().fold(0.0, f64::max);
        let believed = BELIEVED * longest_sq.sqrt();
        let against =
            Against { tree, marker, believed: believed.min(self.sheets.limit.unwrap_or(believed)) };
        let feet = self.corners(&against, vertices, [a, b, c]);
        let arms = [sub(b, a), sub(c, b), sub(a, c)];
        // A quadratic map has at the centre its mean at the corners less an eighteenth of its second
        // differences along the sides, in the middle of a side the mean at the ends less an eighth.
        let bends = [0, 1, 2].map(|i| bend(&feet[i], &feet[(i + 1) % 3], arms[i]));
        let more = [0, 1].map(|k| bends.iter().map(|bend| bend[k]).sum::<f64>() / 18.0);
        let near = self.between(feet, more);
        let centre = self.sample(&against, &near, scale(1.0 / 3.0, add(a, add(b, c))));
        let mut chord_error = centre.distance;
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let middle = scale(0.5, add([a, b, c][i], [a, b, c][j]));
            let ends = [vertices[i].min(vertices[j]), vertices[i].max(vertices[j])];
            let near = || self.between([feet[i], feet[j]], bends[i].map(|x| 0.125 * x));
            let off = self.middle(&against, ends, near(), middle);
            chord_error = chord_error.max(off);
        }
        let up = unit(cross(sub(b, a), sub(c, a)));
        Some(Measured {
            triangle: t as u32,
            chord_error,
            vertex_error: feet.iter().map(|foot| foot.distance).fold(0.0, f64::max),
            piece: centre.seed.piece,
            cosine: up.zip(normal(&centre.tangents)).map(|(up, normal)| dot(up, normal)),
        })
    }

    /// The feet of a triangle's corners: those known, then the others from one of them.
    fn corners(
        &mut self,
        against: &Against<'_>,
        vertices: [u32; 3],
        at: [Vector; 3],
    ) -> [Corner; 3] {
        let known = vertices.map(|v| self.known(against, v));
        let near = known.into_iter().zip(at).find_map(|(corner, at)| Some((corner?, at)));
        std::array::from_fn(|i| {
            known[i].unwrap_or_else(|| {
                let rounding = ROUNDING * self.sheets.size;
                let found = near.map(|(near, from)| {
                    let seed = self.moved(near.seed, near.step(sub(at[i], from)));
                    self.sheets.foot_from(seed, at[i])
                });
                let is_on = |foot: &Foot| foot.distance <= rounding;
                let search = |seeds| self.sheets.foot(against.tree, at[i], seeds);
                let few = || Some(search(SEEDS)).filter(is_on);
                let foot = found.filter(is_on).or_else(few);
                let mut foot = foot.unwrap_or_else(|| nearer(found, search(SEEDS_OF_VERTEX)));
                if !is_on(&foot) && self.lost < LOST {
                    let on = self.sheets.foot_of_many(against.tree, at[i], rounding);
                    self.lost += u32::from(on.is_none());
                    foot = on.unwrap_or(foot);
                }
                let corner = Corner::new(&foot);
                self.feet[vertices[i] as usize % SLOTS] = (vertices[i], corner);
                corner
            })
        })
    }

    /// A place moved within its piece.
    fn moved(&self, Seed { piece, at }: Seed, by: [f64; 2]) -> Seed {
        let domain = self.sheets.domains[piece];
        Seed { piece, at: clamped([at[0] + by[0], at[1] + by[1]], domain) }
    }

    fn known(&self, against: &Against<'_>, v: u32) -> Option<Corner> {
        let (vertex, foot) = self.feet[v as usize % SLOTS];
        let fits = |marker| self.sheets.pieces[foot.seed.piece].1 == marker;
        (vertex == v && against.marker.is_none_or(fits)).then_some(foot)
    }

    /// The mean of places on one piece and a correction; of places on several pieces, all: one of them
    /// is on the piece that the triangle belongs to.
    fn between<const N: usize>(&self, feet: [Corner; N], more: [f64; 2]) -> Between<N> {
        let piece = feet[0].seed.piece;
        let mean = |i: usize| feet.iter().map(|foot| foot.seed.at[i]).sum::<f64>() / N as f64;
        match feet.iter().all(|foot| foot.seed.piece == piece) {
            true => Between::One(self.moved(Seed { piece, at: [mean(0), mean(1)] }, more)),
            false => Between::Several(feet.map(|foot| foot.seed)),
        }
    }

    /// The foot of a sample from places near it, and from the lattice where that is not believed.
    fn sample<const N: usize>(&self, against: &Against<'_>, near: &Between<N>, p: Vector) -> Foot {
        let near = match near {
            Between::One(seed) => std::slice::from_ref(seed),
            Between::Several(seeds) => seeds,
        };
        let feet = near.iter().map(|&near| self.sheets.foot_from(near, p));
        let found =
            feet.reduce(|best, foot| if foot.distance < best.distance { foot } else { best });
        match found {
            Some(foot) if foot.distance <= against.believed && self.is_inside(&foot) => foot,
            found => nearer(found, self.sheets.foot(against.tree, p, SEEDS)),
        }
    }

    /// Whether a foot lies inside its piece: on a side the search may have stopped short of a nearer
    /// one on the next piece.
    fn is_inside(&self, foot: &Foot) -> bool {
        let domain = self.sheets.domains[foot.seed.piece];
        (0..2).all(|i| foot.seed.at[i] > domain[i][0] && foot.seed.at[i] < domain[i][1])
    }

    /// Distance of the middle of an edge, which two triangles ask for.
    fn middle(
        &mut self,
        against: &Against<'_>,
        ends: [u32; 2],
        near: Between<2>,
        at: Vector,
    ) -> f64 {
        let slot = (ends[0].wrapping_mul(0x9E37_79B1) ^ ends[1]) as usize % SLOTS;
        let (known, marker, distance) = self.middles[slot];
        if known == ends && marker == against.marker {
            return distance;
        }
        let distance = self.sample(against, &near, at).distance;
        self.middles[slot] = (ends, against.marker, distance);
        distance
    }
}

/// The parameters' second difference along a side of a triangle, with the other sign: what they change
/// by per length at its start, less what they do at its end.
fn bend(start: &Corner, end: &Corner, arm: Vector) -> [f64; 2] {
    let (s, e) = (start.step(arm), end.step(arm));
    [s[0] - e[0], s[1] - e[1]]
}

fn nearer(found: Option<Foot>, other: Foot) -> Foot {
    found.filter(|found| found.distance <= other.distance).unwrap_or(other)
}

fn clamped([u, v]: [f64; 2], [[u0, u1], [v0, v1]]: [[f64; 2]; 2]) -> [f64; 2] {
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
    if determinant <= FLAT * e * g || !step.iter().all(|x| x.is_finite()) {
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

/// Diagonal of the box around points.
fn diagonal(points: impl Iterator<Item = Vector>) -> f64 {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for p in points {
        for i in 0..3 {
            (low[i], high[i]) = (low[i].min(p[i]), high[i].max(p[i]));
        }
    }
    let diagonal = distance(low, high);
    if diagonal.is_finite() { diagonal } else { 0.0 }
}
