//! Flips on a surface: exact in (u, v), ranked in space.

use super::chart::{Lift, Matrix2};
use crate::metric::FirstForm;
use crate::point::Point2;
use crate::predicates::{Sign, orient2d};
use crate::triangulation::{HalfEdgeId, TriangleId, Triangulation};
use crate::vector::{Vector, cross, dot, norm_sq, sub};

/// Makes an open region nearly Delaunay in the metric of the surface: an edge is flipped when the
/// circle of one triangle, as the metric in its middle sees it, holds the other apex.
///
/// The metric differs from edge to edge, so the flips might go round for ever; their number is
/// bounded.
pub(super) fn towards_circles(mesh: &mut Triangulation, points: &[Point2], lifts: &[Lift]) {
    let mut budget = 16 * mesh.slot_count();
    let mut suspects = all_edges(mesh);
    while let Some(e) = suspects.pop() {
        let Some(vertices) = around(mesh, e) else { continue };
        let [a, b] = [vertices[0], vertices[1]].map(|v| lifts[v].form());
        let mean = FirstForm { e: a.e + b.e, f: a.f + b.f, g: a.g + b.g };
        let circle = Matrix2::root(&mean);
        let quad = vertices.map(|v| points[v]);
        let [a, b, c, d] = quad;
        if budget > 0 && circle.in_circle([a, b, c], d) && is_convex(quad) {
            budget -= 1;
            flip(mesh, e, &mut suspects);
        }
    }
}

/// Flips an edge of a triangle at a marked vertex when that makes the worse of its two triangles better
/// in space, until no flip does; returns the number of flips.
///
/// Ends: the shape of a triangle depends on its corners alone, and each flip raises the list of all
/// shapes, sorted upwards, in lexicographic order.
pub(super) fn towards_shape(
    mesh: &mut Triangulation,
    points: &[Point2],
    lifts: &[Lift],
    marked: &[bool],
) -> u64 {
    let mut suspects = edges_of_bad(mesh, lifts, marked);
    let mut flips = 0;
    while let Some(e) = suspects.pop() {
        let Some(vertices) = around(mesh, e) else { continue };
        let [a, b, c, d] = vertices.map(|v| &lifts[v]);
        let now = shape([a, b, c]).min(shape([b, a, d]));
        if now >= ACUTE {
            continue;
        }
        let then = shape([a, d, c]).min(shape([d, b, c]));
        // Shapes are rounded: an equal one must not pass for a better one.
        if then > now + 1e-12 && is_convex(vertices.map(|v| points[v])) {
            flips += 1;
            flip(mesh, e, &mut suspects);
        }
    }
    flips
}

fn all_edges(mesh: &Triangulation) -> Vec<HalfEdgeId> {
    let sides = mesh.triangles().flat_map(TriangleId::half_edges);
    let mut edges: Vec<HalfEdgeId> =
        sides.filter(|&e| mesh.twin(e).is_some_and(|f| e < f)).collect();
    edges.reverse();
    edges
}

/// A triangle with a shape above this has acute angles only: the best right one has sqrt(3) / 2. The
/// flip of an edge between two such triangles of a plane makes one with an obtuse angle.
const ACUTE: f64 = 0.867;

/// The edges of triangles at marked vertices that a flip may make better.
fn edges_of_bad(mesh: &Triangulation, lifts: &[Lift], marked: &[bool]) -> Vec<HalfEdgeId> {
    let is_bad = |t: TriangleId| {
        let corners = mesh.corners(t).map(|v| v.index());
        corners.iter().any(|&v| marked[v]) && !is_acute(corners.map(|v| &lifts[v]))
    };
    let mut edges: Vec<HalfEdgeId> =
        mesh.triangles().filter(|&t| is_bad(t)).flat_map(TriangleId::half_edges).collect();
    edges.reverse();
    edges
}

/// Whether [`shape`] is at least [`ACUTE`], without a root; poles have no acute triangles here.
fn is_acute(corners: [&Lift; 3]) -> bool {
    let [a, b, c] = corners.map(|corner| corner.point);
    let (ab, ac) = (sub(b, a), sub(c, a));
    let normal = cross(ab, ac);
    let length_sq = norm_sq(normal);
    let faces = |n: Vector| {
        let turn = dot(n, normal);
        turn > 0.0 && turn * turn >= TURN * TURN * length_sq
    };
    // The sum of the squared sides.
    let sides = 2.0 * (norm_sq(ab) + norm_sq(ac) - dot(ab, ac));
    TWO_SQRT_3 * TWO_SQRT_3 * length_sq >= ACUTE * ACUTE * sides * sides
        && corners.iter().all(|corner| faces(corner.normal))
}

fn flip(mesh: &mut Triangulation, e: HalfEdgeId, suspects: &mut Vec<HalfEdgeId>) {
    let twin = mesh.twin(e).expect("only edges with two sides are flipped");
    suspects.extend([e.next(), e.prev(), twin.next(), twin.prev()]);
    mesh.flip(e);
}

/// The vertices around an edge a -> b: its ends, and the apexes c on the left and d on the right;
/// `None` for an edge that stays.
fn around(mesh: &Triangulation, e: HalfEdgeId) -> Option<[usize; 4]> {
    if mesh.is_constrained(e) {
        return None;
    }
    let twin = mesh.twin(e)?;
    Some([mesh.origin(e), mesh.dest(e), mesh.apex(e), mesh.apex(twin)].map(|v| v.index()))
}

/// Whether the quadrilateral around an edge is strictly convex in (u, v), exactly: then the edge can
/// be flipped.
fn is_convex([a, b, c, d]: [Point2; 4]) -> bool {
    orient2d(a, d, c) == Sign::Positive && orient2d(d, b, c) == Sign::Positive
}

const TWO_SQRT_3: f64 = 3.464_101_615_137_754_6;
/// A triangle may turn this far (a cosine) from the normals at its corners before it counts as worse.
const TURN: f64 = 0.7;

/// Mean ratio in space: 1 when equilateral, less when the triangle turns away from one of the normals
/// at its corners, negative when it faces away. A triangle at a pole is an edge in space, and no
/// concern.
pub(super) fn shape(corners: [&Lift; 3]) -> f64 {
    let [a, b, c] = corners.map(|corner| corner.point);
    if a == b || b == c || c == a {
        return f64::INFINITY;
    }
    let normal = cross(sub(b, a), sub(c, a));
    let sides = norm_sq(sub(b, a)) + norm_sq(sub(c, b)) + norm_sq(sub(a, c));
    let length = norm_sq(normal).sqrt();
    let normals = corners.iter().map(|corner| corner.normal).filter(|n| *n != [0.0; 3]);
    let turn = normals.map(|n| dot(n, normal)).fold(TURN * length, f64::min) / TURN;
    TWO_SQRT_3 * turn / sides
}
