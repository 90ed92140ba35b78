//! The curves of a model: each is cut into edges once, for all patches that share it, so that the
//! mesh is watertight by construction.

use super::SurfaceMeshError;
use super::trim::{Cut, Loops, holds, turn};
use crate::curve::Curve;
use crate::curve::discretize::{self, Track, nodes};
use crate::model::{Model, Patch, Trim, TrimCurve};
use crate::predicates::Sign;
use crate::surface::{Line, Side, Surface, Trace};
use crate::vector::{Vector, distance, key};
use std::collections::{BTreeMap, BTreeSet};

/// A smooth curve of the model, which may be the side of any number of patches.
#[derive(Clone, Debug)]
pub(super) struct Shared {
    pub(super) curve: Line,
    /// As messages call it.
    pub(super) name: String,
    /// Parameters of its nodes.
    pub(super) nodes: Vec<f64>,
    /// Vertices of the model at the nodes.
    pub(super) vertices: Vec<u32>,
    pub(super) marker: Option<i32>,
    /// Whether the model says how it is cut.
    pub(super) has_rule: bool,
    /// How many sides it is.
    pub(super) uses: u32,
}

/// A smooth patch and the curves around it.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    /// Index of the model's patch it is part of.
    pub(super) patch: usize,
    pub(super) surface: Surface,
    /// By [`Side::ALL`]: the curves along each, in the direction of the rising parameter; none for a
    /// pole.
    pub(super) sides: [Vec<Along>; 4],
    /// Whether the first loop takes the place of the sides.
    pub(super) has_outline: bool,
    /// The loops that trim it.
    pub(super) loops: Vec<Vec<Cut>>,
}

/// The nodes around a piece: those of the sides or the outline, counterclockwise, then those of the
/// holes.
#[derive(Clone, Debug, Default)]
pub(super) struct Rim {
    pub(super) nodes: Vec<Node>,
    /// Where each loop starts in the list of nodes.
    pub(super) starts: Vec<usize>,
    /// Of each trimming loop, whether it runs with the patch on its left.
    pub(super) forward: Vec<bool>,
}

impl Rim {
    fn add(&mut self, nodes: &[Node]) {
        self.starts.push(self.nodes.len());
        self.nodes.extend(nodes);
    }

    /// Puts nodes in the place of node `k` of the first loop and the one after it.
    pub(super) fn replace_pair(&mut self, k: usize, new: Vec<Node>) {
        let sides = self.loops().next().map_or(0, |range| range.len());
        let (count, longer) = (new.len(), new.len() as isize - 2);
        match k + 1 < sides {
            true => drop(self.nodes.splice(k..k + 2, new)),
            // The pair is the last node and the first.
            false => {
                self.nodes.splice(k..=k, new);
                self.nodes.remove(0);
            }
        }
        debug_assert!(count >= 2, "a ring has more nodes than a pole");
        self.starts
            .iter_mut()
            .skip(1)
            .for_each(|start| *start = start.saturating_add_signed(longer));
    }

    /// Nodes of the loops.
    pub(super) fn loops(&self) -> impl Iterator<Item = std::ops::Range<usize>> + '_ {
        let ends = self.starts.iter().skip(1).copied().chain([self.nodes.len()]);
        self.starts.iter().zip(ends).map(|(&start, end)| start..end)
    }
}

/// How far off is rounding, as a fraction of the model's diagonal.
pub(super) const ROUNDING: f64 = 1e-9;

/// A shared curve as a part of a side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Along {
    pub(super) curve: usize,
    /// Whether the side runs against the curve.
    pub(super) reversed: bool,
    /// Parameters of the side where it starts and ends.
    range: [f64; 2],
}

/// A node of the outline of a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Node {
    pub(super) u: f64,
    pub(super) v: f64,
    pub(super) vertex: u32,
}

/// All curves and pieces of a model, and the points of the nodes.
#[derive(Clone, Debug, Default)]
pub(super) struct Outline {
    pub(super) curves: Vec<Shared>,
    pub(super) pieces: Vec<Piece>,
    pub(super) points: Vec<Vector>,
    by_ends: BTreeMap<[[u64; 3]; 2], Vec<usize>>,
    /// Whether curves of (u, v) only say near which place those in space lie.
    are_hints: bool,
}

impl Outline {
    /// Finds the curves that patches share; none has nodes yet, but for those with a rule.
    pub(super) fn new(model: &Model) -> Result<Self, SurfaceMeshError> {
        let mut outline = Self { are_hints: model.tolerance.is_some(), ..Self::default() };
        for named in &model.curves {
            let failed = |error| SurfaceMeshError::Curve { name: named.name.clone(), error };
            let all = named.rule.map(|rule| nodes(&named.curve, rule)).transpose();
            let all = all.map_err(failed)?.unwrap_or_default();
            for piece in named.curve.pieces().into_iter().filter(|piece| !piece.is_point()) {
                let [start, end] = piece.domain();
                let inside = |t: &f64| *t >= start && *t <= end;
                let nodes = all.iter().copied().filter(inside).collect();
                let (i, _) = outline.find_or_add(piece, &named.name);
                outline.curves[i].nodes = nodes;
                outline.curves[i].marker = named.marker;
            }
        }
        for (index, patch) in model.patches.iter().enumerate() {
            for surface in patch.surface.pieces() {
                let trim = model.trims.get(&index);
                let has_outline = trim.is_some_and(|trim| trim.outline.is_some());
                let sides = Side::ALL.map(|side| match has_outline {
                    true => Vec::new(),
                    false => outline.along(&surface.side(side), &patch.name, side),
                });
                let loops = match trim {
                    Some(trim) => outline.trim(trim, patch, &surface)?,
                    None => Vec::new(),
                };
                outline.pieces.push(Piece { patch: index, surface, sides, has_outline, loops });
            }
        }
        Ok(outline)
    }

    fn along(&mut self, side: &Curve, patch: &str, which: Side) -> Vec<Along> {
        if side.is_point() {
            return Vec::new();
        }
        let name = format!("the {} side of patch {patch}", which.name());
        let pieces = side.pieces().into_iter();
        pieces
            .map(|piece| {
                let range = piece.domain();
                let (curve, reversed) = self.find_or_add(piece, &name);
                self.curves[curve].uses += 1;
                Along { curve, reversed, range }
            })
            .collect()
    }

    /// The curves of the loops of a trimmed patch.
    fn trim(
        &mut self,
        trim: &Trim,
        patch: &Patch,
        surface: &Surface,
    ) -> Result<Vec<Vec<Cut>>, SurfaceMeshError> {
        if patch.surface.pieces().len() > 1 {
            let (name, reason) = (patch.name.clone(), "it has creases".to_owned());
            return Err(SurfaceMeshError::Trim { name, reason });
        }
        let mut loops = Vec::new();
        for ring in trim.loops() {
            let mut cuts = Vec::new();
            for curve in ring {
                cuts.extend(self.cuts(curve, patch, surface)?);
            }
            loops.push(cuts);
        }
        Ok(loops)
    }

    /// The smooth pieces of a curve of a loop.
    fn cuts(
        &mut self,
        curve: &TrimCurve,
        patch: &Patch,
        surface: &Surface,
    ) -> Result<Vec<Cut>, SurfaceMeshError> {
        let name = format!("a loop of patch {}", patch.name);
        match curve {
            TrimCurve::Space { curve, parameters } => {
                let pieces: Vec<Curve> =
                    curve.pieces().into_iter().filter(|piece| !piece.is_point()).collect();
                let parameters_of = parameters.as_ref();
                let given = parameters_of.map(Curve::pieces);
                let is_matched = given.as_ref().is_none_or(|given| given.len() == pieces.len());
                if !is_matched && !self.are_hints {
                    let reason = "a curve has other corners in (u, v) than in space".to_owned();
                    return Err(SurfaceMeshError::Trim { name: patch.name.clone(), reason });
                }
                let [from, to] = curve.domain();
                let cut = |(i, piece): (usize, Curve)| {
                    let range = match is_matched {
                        true => [0.0, 1.0],
                        false => piece.domain().map(|t| (t - from) / (to - from)),
                    };
                    let (curve, reversed) = self.find_or_add(piece, &name);
                    self.curves[curve].uses += 1;
                    let turned = |p: &Curve| if reversed { p.reversed() } else { p.clone() };
                    let of = |given: &Vec<Curve>| is_matched.then(|| turned(&given[i]));
                    let parameters = given.as_ref().and_then(of);
                    let parameters = parameters.or_else(|| parameters_of.map(turned));
                    let [low, high] = range;
                    let range = if reversed { [1.0 - high, 1.0 - low] } else { range };
                    Cut { curve, reversed, parameters, range }
                };
                Ok(pieces.into_iter().enumerate().map(cut).collect())
            }
            TrimCurve::Parameters { curve, rule, marker } => {
                let trace = |parameters: &Curve| {
                    let (surface, parameters) = (surface.clone(), parameters.clone());
                    Line::Trace(Box::new(Trace { surface, parameters }))
                };
                let failed = |error| SurfaceMeshError::Curve { name: name.clone(), error };
                let all = rule.map(|rule| nodes(&trace(curve), rule)).transpose();
                let all = all.map_err(failed)?.unwrap_or_default();
                let mut cuts = Vec::new();
                for parameters in curve.pieces() {
                    let [start, end] = parameters.domain();
                    let inside = all.iter().filter(|t| **t >= start && **t <= end);
                    let mut shared = Shared::new(trace(&parameters), &name);
                    shared.nodes = inside.copied().collect();
                    (shared.marker, shared.uses) = (*marker, 1);
                    let curve = self.curves.len();
                    self.curves.push(shared);
                    let (parameters, range) = (Some(parameters), [0.0, 1.0]);
                    cuts.push(Cut { curve, reversed: false, parameters, range });
                }
                Ok(cuts)
            }
        }
    }

    /// The curve that equals this one, and whether it runs the other way.
    fn find_or_add(&mut self, curve: Curve, name: &str) -> (usize, bool) {
        let mut ends = curve.ends().map(key);
        ends.sort_unstable();
        let known = self.by_ends.entry(ends).or_default();
        for &i in known.iter() {
            if let Some(reversed) = self.curves[i].curve.same_as(&curve) {
                return (i, reversed);
            }
        }
        known.push(self.curves.len());
        self.curves.push(Shared::new(Line::Curve(curve), name));
        (self.curves.len() - 1, false)
    }

    /// Whether some curve that a patch uses has no rule.
    pub(super) fn needs_default(&self) -> bool {
        self.curves.iter().any(|shared| shared.uses > 0 && shared.nodes.is_empty())
    }

    /// Gives nodes to the curves that have none yet, by the spacing at a point of them.
    pub(super) fn cut(
        &mut self,
        spacing: &impl Fn(&crate::curve::CurveJet) -> f64,
    ) -> Result<(), SurfaceMeshError> {
        for shared in &mut self.curves {
            shared.has_rule = !shared.nodes.is_empty();
        }
        for shared in self.curves.iter_mut().filter(|s| s.uses > 0 && s.nodes.is_empty()) {
            shared.nodes = discretize::by_spacing(&shared.curve, |jet, _| spacing(jet))
                .map_err(|error| SurfaceMeshError::Curve { name: shared.name.clone(), error })?;
        }
        Ok(())
    }

    /// Numbers the nodes: ends at equal places are one vertex.
    pub(super) fn number(&mut self, tolerance: f64) {
        let mut at_end: BTreeMap<[u64; 3], u32> = BTreeMap::new();
        let points = &mut self.points;
        for shared in self.curves.iter_mut().filter(|shared| shared.uses > 0) {
            let last = shared.nodes.len() - 1;
            let vertex = |(i, &t): (usize, &f64)| {
                let point = shared.curve.at(t);
                let mut new = || {
                    points.push(point);
                    points.len() as u32 - 1
                };
                let is_end = i == 0 || i == last;
                if is_end { *at_end.entry(key(point)).or_insert_with(new) } else { new() }
            };
            shared.vertices = shared.nodes.iter().enumerate().map(vertex).collect();
        }
        self.join_corners(tolerance);
    }

    /// Makes one vertex of the ends of curves that meet in a corner of a patch within a tolerance.
    fn join_corners(&mut self, tolerance: f64) {
        let mut same: Vec<u32> = (0..self.points.len() as u32).collect();
        for piece in &self.pieces {
            let ends: Vec<[u32; 2]> =
                Side::ALL.iter().filter_map(|&side| self.ends_ccw(piece, side)).collect();
            for (i, &[_, last]) in ends.iter().enumerate() {
                let [first, _] = ends[(i + 1) % ends.len()];
                let (a, b) = (root(&same, last), root(&same, first));
                same[a.max(b) as usize] = a.min(b);
            }
        }
        for cuts in self.pieces.iter().flat_map(|piece| &piece.loops) {
            for (i, cut) in cuts.iter().enumerate() {
                let next = &cuts[(i + 1) % cuts.len()];
                let (a, b) = (self.cut_end(cut, false), self.cut_end(next, true));
                let gap = distance(self.points[a as usize], self.points[b as usize]);
                if gap <= tolerance {
                    let (a, b) = (root(&same, a), root(&same, b));
                    same[a.max(b) as usize] = a.min(b);
                }
            }
        }
        for vertex in self.curves.iter_mut().flat_map(|shared| &mut shared.vertices) {
            *vertex = root(&same, *vertex);
        }
    }

    /// First and last vertex of a side, counterclockwise; `None` for a pole.
    fn ends_ccw(&self, piece: &Piece, side: Side) -> Option<[u32; 2]> {
        let along = &piece.sides[side as usize];
        let end = |along: &Along, at_start: bool| {
            let vertices = &self.curves[along.curve].vertices;
            if at_start != along.reversed { vertices[0] } else { vertices[vertices.len() - 1] }
        };
        let (first, last) = (end(along.first()?, true), end(along.last()?, false));
        Some(if is_forward(side) { [first, last] } else { [last, first] })
    }

    /// Vertices of curves that are cut as the model says.
    pub(super) fn ruled_vertices(&self) -> BTreeSet<u32> {
        let ruled = self.curves.iter().filter(|shared| shared.has_rule);
        ruled.flat_map(|shared| shared.vertices.iter().copied()).collect()
    }

    fn cut_end(&self, cut: &Cut, at_start: bool) -> u32 {
        let vertices = &self.curves[cut.curve].vertices;
        if at_start != cut.reversed { vertices[0] } else { vertices[vertices.len() - 1] }
    }

    /// The nodes around a piece and its holes.
    ///
    /// # Errors
    /// What is wrong with a loop.
    pub(super) fn rim(&self, piece: &Piece, [tolerance, off]: [f64; 2]) -> Result<Rim, String> {
        let mut rim = Rim::default();
        if !piece.has_outline {
            rim.add(&self.around(piece));
        }
        let Piece { surface, loops, .. } = piece;
        let (curves, points, are_hints) = (&self.curves, &self.points, self.are_hints);
        let all = Loops { surface, curves, points, tolerance, off, are_hints };
        for (i, cuts) in loops.iter().enumerate() {
            let mut nodes = all.nodes(cuts)?;
            let is_hole = i > 0 || !piece.has_outline;
            let forward = (turn(&nodes) == Sign::Positive) != is_hole;
            if !forward {
                nodes.reverse();
            }
            if is_hole {
                let mut before = rim.loops().map(|range| &rim.nodes[range]);
                let outline = before.next().is_some_and(|outline| holds(outline, &nodes[0]));
                if !outline || before.any(|hole| holds(hole, &nodes[0]) || holds(&nodes, &hole[0]))
                {
                    let Node { u, v, .. } = nodes[0];
                    return Err(format!("the hole at ({u}, {v}) lies outside, or in another hole"));
                }
            }
            rim.add(&nodes);
            rim.forward.push(forward);
        }
        Ok(rim)
    }

    /// The nodes around a piece, counterclockwise; a pole has but its two corners.
    fn around(&self, piece: &Piece) -> Vec<Node> {
        let mut nodes: Vec<Node> = Vec::new();
        for side in Side::ALL {
            let mut list = self.on_side(piece, side);
            if !is_forward(side) {
                list.reverse();
            }
            match list.pop() {
                Some(_) => nodes.extend(list),
                None => nodes.push(self.pole(piece, side)),
            }
        }
        nodes
    }

    /// The first corner, counterclockwise, of a side that is a pole.
    fn pole(&self, piece: &Piece, side: Side) -> Node {
        let before = Side::ALL[(side as usize + 3) % 4];
        let [u, v] = corner(&piece.surface, side);
        let vertex = match self.ends_ccw(piece, before) {
            Some([_, last]) => last,
            None => u32::MAX,
        };
        Node { u, v, vertex }
    }

    /// The nodes of a side in the direction of the rising parameter, both corners included.
    fn on_side(&self, piece: &Piece, side: Side) -> Vec<Node> {
        let mut list = Vec::new();
        let curve = piece.surface.side(side);
        for (k, along) in piece.sides[side as usize].iter().enumerate() {
            let shared = &self.curves[along.curve];
            let count = shared.nodes.len();
            let order = |i: usize| if along.reversed { count - 1 - i } else { i };
            for i in usize::from(k > 0)..count {
                let fraction = along.fraction(shared, order(i), curve.domain());
                let vertex = shared.vertices[order(i)];
                list.push(node(piece, side, fraction, self.points[vertex as usize], vertex));
            }
        }
        if let [first, .., last] = &mut list[..] {
            let [low, high] = ends_of(&piece.surface, side);
            [first.u, first.v] = low;
            [last.u, last.v] = high;
        }
        list
    }
}

impl Shared {
    fn new(curve: Line, name: &str) -> Self {
        let (nodes, vertices) = (Vec::new(), Vec::new());
        Self {
            curve,
            name: name.to_owned(),
            nodes,
            vertices,
            marker: None,
            has_rule: false,
            uses: 0,
        }
    }
}

pub(super) fn root(same: &[u32], mut v: u32) -> u32 {
    while same[v as usize] != v {
        v = same[v as usize];
    }
    v
}

impl Along {
    /// Where node `i` of the curve lies on the side, as a fraction of the side's parameters.
    fn fraction(&self, shared: &Shared, i: usize, [start, end]: [f64; 2]) -> f64 {
        let [low, high] = shared.curve.domain();
        let part = (shared.nodes[i] - low) / (high - low);
        let part = if self.reversed { 1.0 - part } else { part };
        let t = self.range[0] + part * (self.range[1] - self.range[0]);
        (t - start) / (end - start)
    }
}

/// Whether the rising parameter runs counterclockwise around the patch.
pub(super) fn is_forward(side: Side) -> bool {
    matches!(side, Side::South | Side::East)
}

/// Parameters of a side's corners, in the direction of the rising parameter.
fn ends_of(surface: &Surface, side: Side) -> [[f64; 2]; 2] {
    let [[u0, u1], [v0, v1]] = surface.domain();
    match side {
        Side::South => [[u0, v0], [u1, v0]],
        Side::East => [[u1, v0], [u1, v1]],
        Side::North => [[u0, v1], [u1, v1]],
        Side::West => [[u0, v0], [u0, v1]],
    }
}

/// Parameters of a side's first corner, counterclockwise.
fn corner(surface: &Surface, side: Side) -> [f64; 2] {
    let [low, high] = ends_of(surface, side);
    if is_forward(side) { low } else { high }
}

fn node(piece: &Piece, side: Side, fraction: f64, point: Vector, vertex: u32) -> Node {
    let [[u0, u1], [v0, v1]] = piece.surface.domain();
    let mix = |low: f64, high: f64| low + fraction * (high - low);
    let (u, v) = match (side, &piece.surface) {
        // A rational arc does not run at constant angular speed: its points know their angles.
        (Side::East, Surface::Revolution(of)) => (u1, of.angle_of(point)),
        (Side::West, Surface::Revolution(of)) => (u0, of.angle_of(point)),
        (Side::South, _) => (mix(u0, u1), v0),
        (Side::North, _) => (mix(u0, u1), v1),
        (Side::East, _) => (u1, mix(v0, v1)),
        (Side::West, _) => (u0, mix(v0, v1)),
    };
    Node { u, v, vertex }
}
