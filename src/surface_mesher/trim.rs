//! Trimmed patches: loops of curves in (u, v) in place of the sides, and around holes.
//!
//! The points of a loop are those of curves in space, which other patches may share; where they lie
//! in (u, v) is given, or found as the nearest point of the surface.

use super::outline::{Node, Shared};
use crate::curve::Curve;
use crate::curve::discretize::Track;
use crate::domain::validate::loop_orientation;
use crate::metric::FirstForm;
use crate::point::Point2;
use crate::predicates::{Sign, orient2d};
use crate::surface::{Side, Surface, Tangents};
use crate::vector::{Vector, distance, dot, sub};

/// A shared curve as a part of a loop.
#[derive(Clone, Debug)]
pub(super) struct Cut {
    pub(super) curve: usize,
    /// Whether the loop runs against the curve.
    pub(super) reversed: bool,
    /// The curve in (u, v), in the direction of the curve in space; none where it is to be found.
    pub(super) parameters: Option<Curve>,
    /// The part of that curve which belongs to this one, as fractions of its range.
    pub(super) range: [f64; 2],
}

/// What loops are made of.
pub(super) struct Loops<'a> {
    pub(super) surface: &'a Surface,
    pub(super) curves: &'a [Shared],
    pub(super) points: &'a [Vector],
    /// How far off is rounding, or what the model says is the same.
    pub(super) tolerance: f64,
    /// A point that is farther from the surface than this does not lie on it.
    pub(super) off: f64,
    /// Whether curves of (u, v) only say near which place those in space lie.
    pub(super) are_hints: bool,
}

/// A point of a curve that is farther from the surface than this fraction of the model's diagonal
/// does not lie on it, where the model has no tolerance of its own.
pub(super) const OFF: f64 = 1e-6;
/// A place that a curve of (u, v) gives is taken when its point is this much nearer than what is the
/// same.
const SETTLED: f64 = 1e-3;
/// Parameters of one point found twice agree to this fraction of the domain.
const PARAMETERS: f64 = 1e-6;

impl Loops<'_> {
    /// The nodes of a loop in its order.
    pub(super) fn nodes(&self, cuts: &[Cut]) -> Result<Vec<Node>, String> {
        let mut nodes: Vec<Node> = Vec::new();
        let mut ends: Vec<[Node; 2]> = Vec::new();
        for cut in cuts {
            let list = self.along(cut, nodes.last())?;
            ends.push([list[0], list[list.len() - 1]]);
            nodes.extend(&list[..list.len() - 1]);
        }
        let mut at = 0;
        for (i, (cut, [_, last])) in cuts.iter().zip(&ends).enumerate() {
            let [first, _] = ends[(i + 1) % ends.len()];
            at += self.curves[cut.curve].nodes.len() - 1;
            if let Some(pole) = self.demand_joint(last, &first)? {
                nodes.insert(at, pole);
                at += 1;
            }
        }
        if nodes.len() < 3 {
            let count = nodes.len();
            return Err(format!(
                "a loop needs three nodes, but has {count}: take a smaller spacing"
            ));
        }
        Ok(nodes)
    }

    /// Whether one curve of a loop goes on where another ends: in one place, or in two of a side that
    /// is a pole. Then the node where the first ends is one more of the loop.
    fn demand_joint(&self, last: &Node, first: &Node) -> Result<Option<Node>, String> {
        let [from, to] = [last, first].map(|node| self.points[node.vertex as usize]);
        if last.vertex != first.vertex {
            let gap = distance(from, to);
            return Err(format!("the loop has a gap of {gap:e}: {from:?} against {to:?}"));
        }
        let [[u0, u1], [v0, v1]] = self.surface.domain();
        let far = (last.u - first.u).abs() > PARAMETERS * (u1 - u0)
            || (last.v - first.v).abs() > PARAMETERS * (v1 - v0);
        match far {
            true if self.along_pole(last, first) => Ok(Some(*last)),
            true => Err(format!(
                "the loop is not closed in (u, v): it comes to ({}, {}) and goes on from ({}, {}), which are one point of space",
                last.u, last.v, first.u, first.v
            )),
            false => Ok(None),
        }
    }

    /// Whether two places lie on a side that is a pole.
    fn along_pole(&self, a: &Node, b: &Node) -> bool {
        let [[u0, u1], [v0, v1]] = self.surface.domain();
        let is_on = |side: Side| match side {
            Side::South => a.v == v0 && b.v == v0,
            Side::East => a.u == u1 && b.u == u1,
            Side::North => a.v == v1 && b.v == v1,
            Side::West => a.u == u0 && b.u == u0,
        };
        Side::ALL.into_iter().any(|side| is_on(side) && self.surface.side(side).is_point())
    }

    /// The nodes along a curve of a loop, both ends included.
    fn along(&self, cut: &Cut, before: Option<&Node>) -> Result<Vec<Node>, String> {
        let shared = &self.curves[cut.curve];
        let count = shared.nodes.len();
        let mut list: Vec<Node> = Vec::new();
        for k in 0..count {
            let i = if cut.reversed { count - 1 - k } else { k };
            let vertex = shared.vertices[i];
            let [u, v] = match &cut.parameters {
                Some(parameters) => {
                    let [low, high] = shared.curve.domain();
                    let [start, end] = parameters.domain();
                    let part = (shared.nodes[i] - low) / (high - low);
                    let part = cut.range[0] + part * (cut.range[1] - cut.range[0]);
                    let [u, v, _] = parameters.at(start + part * (end - start));
                    self.settled([u, v], self.points[vertex as usize])
                }
                None => {
                    let near = list.last().or(before).map(|node| [node.u, node.v]);
                    foot(self.surface, near, self.points[vertex as usize], self.tolerance)
                }
            };
            list.push(self.inside(Node { u, v, vertex })?);
        }
        Ok(list)
    }

    /// The place of a point near one that a curve of (u, v) gives.
    fn settled(&self, near: [f64; 2], p: Vector) -> [f64; 2] {
        if !self.are_hints {
            return near;
        }
        let domain = self.surface.domain();
        let near = [0, 1].map(|i| near[i].clamp(domain[i][0], domain[i][1]));
        let is_there = distance(self.surface.at(near[0], near[1]), p) <= SETTLED * self.tolerance;
        if is_there { near } else { descend(self.surface, near, p) }
    }

    /// A node that lies in the rectangle of parameters, and whose point is that of the surface.
    fn inside(&self, node: Node) -> Result<Node, String> {
        let domain = self.surface.domain();
        let Node { u, v, vertex } = node;
        let within = |x: f64, [low, high]: [f64; 2]| {
            let slack = PARAMETERS * (high - low);
            x >= low - slack && x <= high + slack
        };
        if !(within(u, domain[0]) && within(v, domain[1])) {
            return Err(format!("a loop leaves the rectangle of parameters at ({u}, {v})"));
        }
        let (u, v) = (u.clamp(domain[0][0], domain[0][1]), v.clamp(domain[1][0], domain[1][1]));
        let point = self.points[vertex as usize];
        let off = distance(self.surface.at(u, v), point);
        if off > self.off {
            let help = if self.are_hints { "; a larger --weld allows for it" } else { "" };
            return Err(format!("a loop is {off:e} off the surface at {point:?}{help}"));
        }
        Ok(Node { u, v, vertex })
    }
}

/// Lattice points in each direction that the first foot is searched from.
const LATTICE: u32 = 32;
const STEPS: usize = 30;

/// Parameters of the nearest point of a surface: from a place near it, else from a lattice.
fn foot(surface: &Surface, near: Option<[f64; 2]>, p: Vector, tolerance: f64) -> [f64; 2] {
    let away = |at: [f64; 2]| distance(surface.at(at[0], at[1]), p);
    let found = near.map(|near| descend(surface, near, p));
    if let Some(found) = found.filter(|&found| away(found) <= tolerance) {
        return found;
    }
    let [[u0, u1], [v0, v1]] = surface.domain();
    let step = |i: u32| f64::from(i) / f64::from(LATTICE);
    let lattice = (0..(LATTICE + 1).pow(2)).map(|k| {
        let (i, j) = (k % (LATTICE + 1), k / (LATTICE + 1));
        [u0 + step(i) * (u1 - u0), v0 + step(j) * (v1 - v0)]
    });
    let nearest = lattice.min_by(|&a, &b| away(a).total_cmp(&away(b))).unwrap_or([u0, v0]);
    let other = descend(surface, nearest, p);
    found.filter(|&found| away(found) <= away(other)).unwrap_or(other)
}

/// Gauss and Newton's steps in the rectangle of parameters, halved where they lead away.
pub(super) fn descend(surface: &Surface, from: [f64; 2], p: Vector) -> [f64; 2] {
    let [[u0, u1], [v0, v1]] = surface.domain();
    let mut at = from;
    let mut tangents = surface.tangents(at[0], at[1]);
    for _ in 0..STEPS {
        let here = distance(p, tangents.point);
        let [du, dv] = newton(&tangents, p);
        let closer = (0..8).find_map(|halvings| {
            let part = 1.0 / f64::from(1_u32 << halvings);
            let place = [(at[0] + part * du).clamp(u0, u1), (at[1] + part * dv).clamp(v0, v1)];
            let there = surface.tangents(place[0], place[1]);
            (distance(p, there.point) < here).then_some((place, there))
        });
        let Some(better) = closer else { break };
        (at, tangents) = better;
    }
    at
}

fn newton(tangents: &Tangents, p: Vector) -> [f64; 2] {
    let FirstForm { e, f, g } = FirstForm::new(tangents);
    let gap = sub(p, tangents.point);
    let (du, dv) = (dot(gap, tangents.u), dot(gap, tangents.v));
    let step = [(g * du - f * dv) / (e * g - f * f), (e * dv - f * du) / (e * g - f * f)];
    let alone = |d: f64, length_sq: f64| if length_sq > 0.0 { d / length_sq } else { 0.0 };
    if step.iter().all(|x| x.is_finite()) { step } else { [alone(du, e), alone(dv, g)] }
}

/// Which way a loop without crossings runs in (u, v), exactly.
pub(super) fn turn(nodes: &[Node]) -> Sign {
    let points: Vec<Point2> = nodes.iter().map(|node| Point2::new(node.u, node.v)).collect();
    let all: Vec<u32> = (0..points.len() as u32).collect();
    loop_orientation(&points, &all)
}

/// Whether a point lies strictly inside a loop, exactly.
pub(super) fn holds(nodes: &[Node], p: &Node) -> bool {
    let at = |node: &Node| Point2::new(node.u, node.v);
    let crossings = nodes.iter().enumerate().filter(|(i, a)| {
        let b = &nodes[(i + 1) % nodes.len()];
        let (low, high) = if a.v <= b.v { (*a, b) } else { (b, *a) };
        let spans = low.v <= p.v && p.v < high.v;
        spans && orient2d(at(low), at(high), at(p)) == Sign::Positive
    });
    crossings.count() % 2 == 1
}
