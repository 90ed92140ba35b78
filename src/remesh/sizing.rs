//! Wanted edge lengths on a triangulated surface: one number, or less where it bends.

use super::input::Input;
use crate::curve::discretize::spacing_for_chord;
use crate::surface_mesher::growth::{Source, SpaceField};
use crate::triangulation::{HalfEdgeId, TriangleId};
use crate::vector::{Vector, add, cross, dot, norm, norm_sq, scale, sub, unit};

/// Edges come out up to this much longer than wanted, so that much less is wanted.
const SAFETY: f64 = 0.85;
/// No spacing by curvature is below this fraction of the largest.
const FLOOR: f64 = 1e-3;

/// The field of wanted edge lengths: at most `spacing`, of slope at most `growth`, and small enough
/// for the chord error at the curvature of each input vertex.
pub(super) fn field(
    input: &Input,
    spacing: f64,
    growth: f64,
    chord_error: Option<f64>,
) -> SpaceField {
    let Some(error) = chord_error else { return SpaceField::new(&[], growth, spacing) };
    let source = |(&at, curvature): (&Vector, f64)| {
        let wanted = spacing_for_chord(curvature, error, f64::INFINITY);
        Source { at, spacing: (SAFETY * wanted).max(FLOOR * spacing) }
    };
    let sources: Vec<Source> = input.points.iter().zip(curvatures(input)).map(source).collect();
    SpaceField::new(&sources, growth, spacing)
}

/// For each vertex k1 + k2 / 3, the curvature whose chord a triangle there leaves, estimated from
/// the edges around it: the largest normal curvature of an edge within a smooth part, four thirds of
/// it, since the other one is at most that; and the curvature of the feature curve through it.
fn curvatures(input: &Input) -> Vec<f64> {
    let mesh = &input.mesh;
    let outgoing = mesh.outgoing(input.points.len());
    let of = |out: &Option<HalfEdgeId>| {
        let Some(out) = *out else { return 0.0 };
        let star: Vec<HalfEdgeId> = mesh.star(out).collect();
        let is_feature =
            star.iter().any(|&e| mesh.is_constrained(e) || mesh.is_constrained(e.prev()));
        if is_feature { along_feature(input, &star) } else { bending(input, &star) }
    };
    outgoing.iter().map(of).collect()
}

/// Four thirds of the largest normal curvature of the edges around a smooth vertex.
fn bending(input: &Input, star: &[HalfEdgeId]) -> f64 {
    let area = |t: TriangleId| {
        let [a, b, c] = input.triangles[t.index()].map(|v| input.points[v as usize]);
        norm(cross(sub(b, a), sub(c, a)))
    };
    let sum = star
        .iter()
        .map(|e| e.triangle())
        .fold([0.0; 3], |sum, t| add(sum, scale(area(t), input.normals[t.index()])));
    let Some(normal) = unit(sum) else { return 0.0 };
    let curvature = |e: &HalfEdgeId| {
        let [a, b] = [input.mesh.origin(*e), input.mesh.dest(*e)].map(|v| input.points[v.index()]);
        let edge = sub(b, a);
        2.0 * dot(normal, edge).abs() / norm_sq(edge)
    };
    4.0 / 3.0 * star.iter().map(curvature).fold(0.0, f64::max)
}

/// The curvature of the curve through a vertex with two feature edges; 0 at corners.
fn along_feature(input: &Input, star: &[HalfEdgeId]) -> f64 {
    let mesh = &input.mesh;
    let mut ends: Vec<u32> = Vec::new();
    for &e in star {
        ends.extend(mesh.is_constrained(e).then(|| mesh.dest(e).0));
        let is_last = mesh.twin(e.prev()).is_none();
        ends.extend(is_last.then(|| mesh.apex(e).0));
    }
    let &[a, b] = &ends[..] else { return 0.0 };
    let here = input.points[mesh.origin(star[0]).index()];
    let (to, from) = (sub(input.points[b as usize], here), sub(here, input.points[a as usize]));
    match (unit(from), unit(to)) {
        (Some(p), Some(q)) => 2.0 * norm(sub(q, p)) / (norm(from) + norm(to)),
        _ => 0.0,
    }
}
