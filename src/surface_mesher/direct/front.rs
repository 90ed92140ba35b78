//! The front that advances in space over a patch.

use super::foot::nearest;
use super::near::Near;
use super::tangent::{Beside, Tangent, Trial};
use crate::skin::{Foot, shape};
use crate::surface::Surface;
use crate::vector::{Vector, add, along, distance, dot, scale, segment_distance_sq, sub, unit};
use std::collections::{BTreeMap, BTreeSet};

/// What the front needs to know of its patch.
pub(super) struct Over<'a> {
    pub(super) surface: &'a Surface,
    /// Wanted edge length at a place.
    pub(super) spacing: &'a dyn Fn(Vector, [f64; 2]) -> f64,
}

/// A triangle of the front: vertices of the whole model.
pub(super) type Laid = [u32; 3];

/// The front ended before its loops were closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stuck {
    /// Middle of an edge that found no triangle.
    pub(super) at: Vector,
    /// Front edges left.
    pub(super) edges: usize,
}

/// A front edge; the open region is on its left, as seen against the normal.
#[derive(Clone, Copy, Debug)]
struct Edge {
    vertices: [u32; 2],
    /// Parameters of its ends on this side of seams.
    places: [[f64; 2]; 2],
    normal: Vector,
    /// Layers between it and the boundary.
    depth: u32,
}

/// What is known of the front.
pub(super) struct SpaceFront<'a> {
    over: Over<'a>,
    points: &'a mut Vec<Vector>,
    places: &'a mut BTreeMap<u32, [f64; 2]>,
    edges: Vec<Option<Edge>>,
    /// Front edges by their ends.
    index: BTreeMap<[u32; 2], u32>,
    near: Near,
    /// Order: patience spent, depth, length, number.
    queue: BTreeSet<(u32, u32, u64, u32)>,
    /// Directed sides of triangles.
    used: BTreeSet<[u32; 2]>,
    triangles: Vec<Laid>,
}

/// New vertices and existing ones nearer to each other than this fraction of the spacing are one.
const MERGE: f64 = 0.55;
/// A new vertex is at least this far from front edges.
const CLEARANCE: f64 = 0.45;
/// Side of a triangle over its base edge, at least and at most.
const CLAMP: f64 = 1.5;
/// How often an edge is put back before the front is stuck; each time it looks further.
const PATIENCE: u32 = 6;
/// Steps of the trial point towards sides of the wanted length.
const TRIAL_STEPS: u32 = 3;

/// A trial point over a base edge.
struct Apex {
    foot: Foot<[f64; 2]>,
    spacing: f64,
}

impl<'a> SpaceFront<'a> {
    /// A front of the outline's edges; `nodes` are vertices with their parameters, counterclockwise.
    pub(super) fn new(
        over: Over<'a>,
        points: &'a mut Vec<Vector>,
        places: &'a mut BTreeMap<u32, [f64; 2]>,
        nodes: &[(u32, [f64; 2])],
    ) -> Self {
        let mut front = Self {
            over,
            points,
            places,
            edges: Vec::new(),
            index: BTreeMap::new(),
            near: Near::default(),
            queue: BTreeSet::new(),
            used: BTreeSet::new(),
            triangles: Vec::new(),
        };
        for (i, &(a, from)) in nodes.iter().enumerate() {
            let (b, to) = nodes[(i + 1) % nodes.len()];
            if a != b {
                front.add([a, b], [from, to], 0);
            }
        }
        front
    }

    /// Lays triangles until the front is closed; `progress` hears of their number.
    pub(super) fn advance(
        mut self,
        triangles_max: usize,
        progress: &mut dyn FnMut(usize) -> bool,
    ) -> Result<Vec<Laid>, Stuck> {
        while let Some(entry) = self.queue.pop_first() {
            let (spent, .., id) = entry;
            let Some(base) = self.edges[id as usize] else { continue };
            let is_over = self.triangles.len() >= triangles_max || !progress(self.triangles.len());
            if is_over || !self.try_step(&base, spent) {
                if is_over || spent >= PATIENCE {
                    let [a, b] = base.vertices.map(|v| self.points[v as usize]);
                    return Err(Stuck { at: scale(0.5, add(a, b)), edges: self.index.len() });
                }
                self.enqueue(id, spent + 1);
            }
        }
        Ok(self.triangles)
    }

    fn ends(&self, edge: &Edge) -> [Vector; 2] {
        edge.vertices.map(|v| self.points[v as usize])
    }

    fn add(&mut self, vertices: [u32; 2], places: [[f64; 2]; 2], depth: u32) {
        let [a, b] = vertices.map(|v| self.points[v as usize]);
        let middle = scale(0.5, add(a, b));
        let foot = nearest(self.over.surface, middle, starts(places));
        let normal = foot.map_or([0.0; 3], |foot| foot.normal);
        let id = self.edges.len() as u32;
        self.edges.push(Some(Edge { vertices, places, normal, depth }));
        self.index.insert(vertices, id);
        self.near.insert(id, [a, b]);
        self.enqueue(id, 0);
    }

    fn enqueue(&mut self, id: u32, spent: u32) {
        let Some(edge) = self.edges[id as usize] else { return };
        let [a, b] = self.ends(&edge);
        self.queue.insert((spent, edge.depth, distance(a, b).to_bits(), id));
    }

    fn remove(&mut self, vertices: [u32; 2]) -> bool {
        let Some(id) = self.index.remove(&vertices) else { return false };
        let ends = vertices.map(|v| self.points[v as usize]);
        self.near.remove(id, ends);
        self.edges[id as usize] = None;
        true
    }

    /// Lays a triangle on a base edge, if one is valid.
    fn try_step(&mut self, base: &Edge, spent: u32) -> bool {
        let [a, b] = self.ends(base);
        let Some(plane) = Tangent::new(a, b, base.normal) else { return false };
        let Some(apex) = self.apex(base, &plane) else {
            return self.try_existing(base, &plane, None, spent);
        };
        if self.try_existing(base, &plane, Some((&apex, MERGE)), spent) {
            return true;
        }
        if spent == 0 && self.try_new(base, &plane, &apex) {
            return true;
        }
        self.try_existing(base, &plane, Some((&apex, f64::INFINITY)), spent)
            || (spent > 0 && self.try_new(base, &plane, &apex))
    }

    /// The point over the base edge whose distance from both ends is the wanted spacing.
    fn apex(&self, base: &Edge, plane: &Tangent) -> Option<Apex> {
        let [a, b] = self.ends(base);
        let (middle, length) = (scale(0.5, add(a, b)), distance(a, b));
        let mut direction = plane.left();
        let mut spacing = length;
        let mut foot = None;
        for _ in 0..TRIAL_STEPS {
            let side = spacing.clamp(length / CLAMP, CLAMP * length);
            let height = (side * side - 0.25 * length * length).max(0.0).sqrt();
            let trial = along(middle, height, direction);
            let found = nearest(self.over.surface, trial, starts(base.places))?;
            if distance(found.point, trial) > 0.7 * side {
                return foot.map(|foot| Apex { foot, spacing });
            }
            // The next trial leans as the surface does.
            direction = unit(sub(found.point, middle)).unwrap_or(direction);
            let edge = unit(sub(b, a))?;
            direction = unit(along(direction, -dot(direction, edge), edge)).unwrap_or(direction);
            spacing = (self.over.spacing)(found.point, found.place);
            foot = Some(found);
        }
        foot.map(|foot| Apex { foot, spacing: spacing.clamp(length / CLAMP, CLAMP * length) })
    }

    /// The front edges around a base edge that face the same side.
    fn beside(&self, base: &Edge, plane: &Tangent, radius: f64) -> Vec<Beside> {
        let [a, b] = self.ends(base);
        let middle = scale(0.5, add(a, b));
        let near = self.near.around(middle, radius);
        let edges = near.iter().filter_map(|&id| self.edges[id as usize]);
        let faces = |edge: &Edge| dot(edge.normal, base.normal) > 0.0;
        edges
            .filter(|edge| faces(edge) && edge.vertices != base.vertices)
            .map(|edge| {
                let flat = self.ends(&edge).map(|p| plane.flat(p));
                Beside { vertices: edge.vertices, flat }
            })
            .collect()
    }

    /// Takes a vertex of the front as apex: the nearest to the trial point within `reach` spacings, or
    /// the one with the best shape when it reaches as far as one likes.
    fn try_existing(
        &mut self,
        base: &Edge,
        plane: &Tangent,
        wanted: Option<(&Apex, f64)>,
        spent: u32,
    ) -> bool {
        let [a, b] = self.ends(base);
        let length = distance(a, b);
        let spacing = wanted.map_or(length, |(apex, _)| apex.spacing).max(length);
        let radius = spacing * (2.0 + 2.0 * f64::from(spent));
        let beside = self.beside(base, plane, radius);
        let vertices: BTreeSet<u32> = beside.iter().flat_map(|edge| edge.vertices).collect();
        let mut ranked: Vec<(f64, u32)> = Vec::new();
        for v in vertices.into_iter().filter(|v| !base.vertices.contains(v)) {
            let p = self.points[v as usize];
            let rank = match wanted {
                Some((apex, reach)) if reach.is_finite() => {
                    let away = distance(p, apex.foot.point);
                    let is_front_side = self.is_side(base, v);
                    // A vertex next along the front is worth a longer way.
                    let reach = if is_front_side { 1.4 * reach } else { reach };
                    if away > reach * apex.spacing {
                        continue;
                    }
                    away
                }
                _ => 1.0 / shape([a, b, p]).max(1e-12),
            };
            ranked.push((rank, v));
        }
        ranked.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        let found =
            ranked.into_iter().map(|(_, v)| v).find(|&v| self.is_valid(base, plane, v, &beside));
        found.map(|v| self.accept(base, v)).is_some()
    }

    /// Whether `v` is the other end of a front edge at the base edge.
    fn is_side(&self, base: &Edge, v: u32) -> bool {
        let [a, b] = base.vertices;
        self.index.contains_key(&[b, v]) || self.index.contains_key(&[v, a])
    }

    fn is_valid(&self, base: &Edge, plane: &Tangent, v: u32, beside: &[Beside]) -> bool {
        let [a, b] = base.vertices;
        let sides = [[a, b], [b, v], [v, a]];
        if sides.iter().any(|side| self.used.contains(side)) {
            return false;
        }
        // A side that is no front edge is the first of its two: its reverse is free as well.
        let is_free = |from: u32, to: u32| {
            let reverse = [to, from];
            self.index.contains_key(&[from, to])
                || !(self.index.contains_key(&reverse) || self.used.contains(&reverse))
        };
        let flat = [a, b, v].map(|w| plane.flat(self.points[w as usize]));
        is_free(b, v) && is_free(v, a) && Trial { vertices: [a, b, v], flat }.is_clear(beside)
    }

    /// Adds the trial point as a vertex, if it is far enough from everything.
    fn try_new(&mut self, base: &Edge, plane: &Tangent, apex: &Apex) -> bool {
        let [a, b] = base.vertices;
        let Apex { foot, spacing } = apex;
        let [from, to] = self.ends(base);
        let beside = self.beside(base, plane, 2.5 * spacing.max(distance(from, to)));
        let is_far = beside.iter().all(|edge| {
            let [p, q] = edge.vertices.map(|v| self.points[v as usize]);
            let limit = CLEARANCE * spacing;
            segment_distance_sq(p, q, foot.point) >= limit * limit
        });
        let flat = [from, to, foot.point].map(|p| plane.flat(p));
        let trial = Trial { vertices: [a, b, u32::MAX], flat };
        if !is_far || dot(foot.normal, base.normal) <= 0.0 || !trial.is_clear(&beside) {
            return false;
        }
        let v = self.points.len() as u32;
        self.points.push(foot.point);
        self.places.insert(v, foot.place);
        self.accept(base, v);
        true
    }

    /// Makes the triangle of a base edge and an apex.
    fn accept(&mut self, base: &Edge, v: u32) {
        let [a, b] = base.vertices;
        self.remove([a, b]);
        self.triangles.push([a, b, v]);
        self.used.extend([[a, b], [b, v], [v, a]]);
        let place = self.place_of(base, v);
        if !self.remove([b, v]) {
            self.add([v, b], [place, base.places[1]], base.depth + 1);
        }
        if !self.remove([v, a]) {
            self.add([a, v], [base.places[0], place], base.depth + 1);
        }
    }

    /// Parameters of an apex on the base edge's side of seams.
    fn place_of(&self, base: &Edge, v: u32) -> [f64; 2] {
        if let Some(&place) = self.places.get(&v) {
            return place;
        }
        let p = self.points[v as usize];
        let found = nearest(self.over.surface, p, starts(base.places));
        found.map_or(base.places[0], |foot| foot.place)
    }
}

/// Where the search for a foot beside an edge starts: in the middle, and at its ends, which may lie on
/// poles.
fn starts([a, b]: [[f64; 2]; 2]) -> [[f64; 2]; 3] {
    [[0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])], a, b]
}
