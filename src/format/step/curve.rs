//! Edges of STEP: the curves that they lie on, from vertex to vertex.

use super::record::{Entity, Frame};
use super::{Read, Reader};
use crate::curve::Curve;
use crate::vector::{Vector, along, distance, dot, sub};
use std::f64::consts::TAU;

/// References from a curve to the curve that it stands for are at most this deep.
const DEEPEST: usize = 8;
/// Places from which the nearest point of a B-spline curve is searched, for each knot.
const SAMPLES: usize = 16;
/// Ends nearer to each other than this fraction of the curve's size are one.
const SAME: f64 = 1e-6;

impl Reader<'_> {
    /// Reads the curve of an edge, from its first vertex to its second.
    pub(super) fn edge(&mut self, id: u64) -> Read<()> {
        if self.edges.contains_key(&id) {
            return Ok(());
        }
        let edge = self.records.entity(id)?;
        if edge.kind() != "EDGE_CURVE" {
            return Err(edge.fail("an EDGE_CURVE should be here"));
        }
        let fields = edge.fields(None)?;
        let vertices =
            [fields.reference(1, "the first vertex")?, fields.reference(2, "the second vertex")?];
        let mut ends = [self.records.vertex(vertices[0])?, self.records.vertex(vertices[1])?];
        let is_forward = fields.flag(4, "the sense")?;
        if !is_forward {
            ends.reverse();
        }
        let curve = self.records.entity(fields.reference(3, "the curve")?)?;
        let part = Part { ends, is_whole: vertices[0] == vertices[1] };
        let curve = self.between(curve, part, 0)?.with_ends(ends);
        self.edges.insert(id, if is_forward { curve } else { curve.reversed() });
        Ok(())
    }

    /// The part of a curve between two points, in its own direction.
    fn between(&self, curve: Entity, part: Part, depth: usize) -> Read<Curve> {
        let Part { ends, is_whole } = part;
        if depth > DEEPEST {
            return Err(curve.fail("the references go too deep"));
        }
        let made = match curve.kind() {
            "SURFACE_CURVE" | "SEAM_CURVE" | "INTERSECTION_CURVE" | "TRIMMED_CURVE" => {
                let base = curve.fields(None)?.reference(1, "the curve")?;
                return self.between(self.records.entity(base)?, part, depth + 1);
            }
            "LINE" if is_whole => {
                return Err(curve.fail("an edge from a vertex to itself cannot lie on a line"));
            }
            "LINE" => Curve::polyline(ends.to_vec()),
            "CIRCLE" | "ELLIPSE" => return self.conic(&curve, part),
            "POLYLINE" => {
                let ids = curve.fields(None)?.references(1, "the points")?;
                let points: Read<Vec<Vector>> =
                    ids.into_iter().map(|id| self.records.point(id)).collect();
                Curve::polyline(points?)
            }
            "B_SPLINE_CURVE_WITH_KNOTS" | "B_SPLINE_CURVE" => return self.spline(&curve, ends),
            _ => {
                let known = "lines, circles, ellipses, polylines and B-splines with knots are";
                return Err(curve.fail(&format!("a curve of this kind is not read: {known}")));
            }
        };
        made.map_err(|error| curve.at(error.into()))
    }

    /// An arc of a circle or an ellipse; the whole of it where its edge has one vertex, however near
    /// the two of another may be.
    fn conic(&self, curve: &Entity, Part { ends, is_whole }: Part) -> Read<Curve> {
        let conic = Conic::of(self, curve)?;
        let [from, to] = ends.map(|p| conic.angle(p));
        let arc = match is_whole {
            true => Curve::circle([0.0; 3], [0.0, 0.0, 1.0], round(from)),
            false => {
                let to = if to > from { to } else { to + TAU };
                Curve::arc(round(from), round(0.5 * (from + to)), round(to))
            }
        };
        let arc = arc.map_err(|error| curve.at(error.into()))?;
        Ok(conic.image(&arc))
    }

    /// A curve that a surface is swept from: all of it; `None` for a line, which has no ends.
    pub(super) fn basis(&self, id: u64, depth: usize) -> Read<(Entity, Option<Curve>)> {
        let curve = self.records.entity(id)?;
        if depth > DEEPEST {
            return Err(curve.fail("the references go too deep"));
        }
        let whole = match curve.kind() {
            "SURFACE_CURVE" | "SEAM_CURVE" | "INTERSECTION_CURVE" | "TRIMMED_CURVE" => {
                return self.basis(curve.fields(None)?.reference(1, "the curve")?, depth + 1);
            }
            "LINE" => None,
            "CIRCLE" | "ELLIPSE" => {
                let arc = Curve::circle([0.0; 3], [0.0, 0.0, 1.0], round(0.0));
                let arc = arc.map_err(|error| curve.at(error.into()))?;
                Some(Conic::of(self, &curve)?.image(&arc))
            }
            "POLYLINE" => {
                let ends = [[0.0; 3]; 2];
                Some(self.between(self.records.entity(id)?, Part { ends, is_whole: false }, 0)?)
            }
            "B_SPLINE_CURVE_WITH_KNOTS" | "B_SPLINE_CURVE" => {
                let whole = self.whole_spline(&curve)?;
                let domain = whole.domain();
                let part = match whole.knots()[0] == domain[0] {
                    true => Ok(whole),
                    false => whole.part(domain),
                };
                let part = part.map_err(|error| curve.at(error.into()))?;
                let is_closed = match curve.is_complex() {
                    true => curve.fields(Some("B_SPLINE_CURVE"))?.says(3),
                    false => curve.fields(None)?.says(4),
                };
                // What is said to be closed is closed, though rounding has kept the ends apart.
                Some(if is_closed { part.with_ends([part.ends()[0]; 2]) } else { part })
            }
            _ => {
                let known = "lines, circles, ellipses, polylines and B-splines with knots are";
                return Err(curve.fail(&format!("a curve of this kind is not read: {known}")));
            }
        };
        Ok((curve, whole))
    }

    fn spline(&self, curve: &Entity, ends: [Vector; 2]) -> Read<Curve> {
        let whole = self.whole_spline(curve)?;
        let size = sub_size(&whole);
        let is_at = |p: Vector, q: Vector| distance(p, q) <= SAME * size;
        let [start, end] = whole.domain();
        let found = whole.ends();
        let from = if is_at(found[0], ends[0]) { start } else { nearest(&whole, ends[0]) };
        let to = if is_at(found[1], ends[1]) { end } else { nearest(&whole, ends[1]) };
        if !is_at(whole.at(from), ends[0]) || !is_at(whole.at(to), ends[1]) || from >= to {
            return Err(
                curve.fail("the vertices of its edge do not lie on the curve, one after the other")
            );
        }
        let part = if [from, to] == [start, end] && whole.knots()[0] == start {
            Ok(whole)
        } else {
            whole.part([from, to])
        };
        part.map_err(|error| curve.at(error.into()))
    }

    fn whole_spline(&self, curve: &Entity) -> Read<Curve> {
        let (degree, ids, knots) = match curve.is_complex() {
            true => {
                let shape = curve.fields(Some("B_SPLINE_CURVE"))?;
                let (degree, ids) =
                    (shape.count(0, "the degree")?, shape.references(1, "the points")?);
                let knots = curve.fields(Some("B_SPLINE_CURVE_WITH_KNOTS"))?;
                let knots = knots.knots([0, 1], ids.len() + degree.min(ids.len()) + 1)?;
                (degree, ids, knots)
            }
            false => {
                let fields = curve.fields(Some("B_SPLINE_CURVE_WITH_KNOTS"))?;
                let (degree, ids) =
                    (fields.count(1, "the degree")?, fields.references(2, "the points")?);
                let knots = fields.knots([6, 7], ids.len() + degree.min(ids.len()) + 1)?;
                (degree, ids, knots)
            }
        };
        let points: Read<Vec<Vector>> = ids.into_iter().map(|id| self.records.point(id)).collect();
        let weights = match curve.part("RATIONAL_B_SPLINE_CURVE") {
            Some(part) => part.reals(0, "the weights")?,
            None => Vec::new(),
        };
        Curve::new(degree, knots, points?, weights).map_err(|error| curve.at(error.into()))
    }
}

/// What an edge leaves of its curve: the part between two points, or, closed, the whole.
#[derive(Clone, Copy)]
struct Part {
    ends: [Vector; 2],
    is_whole: bool,
}

/// A circle or an ellipse: the image of the circle of radius 1.
struct Conic {
    frame: Frame,
    radii: [f64; 2],
}

impl Conic {
    fn of(reader: &Reader, curve: &Entity) -> Read<Self> {
        let fields = curve.fields(None)?;
        let frame = reader.records.frame(fields.reference(1, "the frame")?)?;
        let first = fields.length(2, "the radius")?;
        let second = match curve.kind() {
            "CIRCLE" => first,
            _ => fields.length(3, "the second radius")?,
        };
        Ok(Self { frame, radii: [first, second] })
    }

    fn angle(&self, p: Vector) -> f64 {
        let Frame { origin, axes: [x, y, _] } = self.frame;
        let arm = sub(p, origin);
        libm::atan2(dot(arm, y) / self.radii[1], dot(arm, x) / self.radii[0])
    }

    fn image(&self, arc: &Curve) -> Curve {
        let Frame { origin, axes: [x, y, _] } = self.frame;
        let [first, second] = self.radii;
        arc.mapped(|[a, b, _]| along(along(origin, first * a, x), second * b, y))
    }
}

fn round(angle: f64) -> Vector {
    [libm::cos(angle), libm::sin(angle), 0.0]
}

/// Diagonal of the box around the control points.
fn sub_size(curve: &Curve) -> f64 {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for p in curve.points() {
        for i in 0..3 {
            (low[i], high[i]) = (low[i].min(p[i]), high[i].max(p[i]));
        }
    }
    distance(low, high)
}

/// The parameter of a near point: the nearest of many, then a search around it by thirds.
fn nearest(curve: &Curve, p: Vector) -> f64 {
    nearest_by(curve, |q| distance(q, p))
}

/// The parameter where a distance of the curve's points is least.
pub(super) fn nearest_by(curve: &Curve, off: impl Fn(Vector) -> f64) -> f64 {
    let [start, end] = curve.domain();
    let count = SAMPLES * curve.points().len();
    let at = |i: usize| start + i as f64 / count as f64 * (end - start);
    let off = |t: f64| off(curve.at(t));
    let best = (0..=count).min_by(|&a, &b| off(at(a)).total_cmp(&off(at(b)))).unwrap_or(0);
    let (mut low, mut high) = (at(best.saturating_sub(1)), at((best + 1).min(count)));
    for _ in 0..90 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if off(a) <= off(b) { high = b } else { low = a }
    }
    0.5 * (low + high)
}
