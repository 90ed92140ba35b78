//! Curves of IGES: lines (110), arcs (100), polylines (106), B-splines (126) and those composed of them
//! (102), as NURBS curves.

use super::super::domain_file::Problem;
use super::fields::Fields;
use super::{Affine, Read, Reader};
use crate::curve::Curve;
use crate::vector::{Vector, distance};
use std::f64::consts::TAU;

/// A curve, and the range of the parameter that IGES gives it.
pub(super) struct Piece {
    pub(super) curve: Curve,
    pub(super) range: [f64; 2],
    /// Whether that parameter is an angle, so that it is not proportional to the curve's own.
    pub(super) turns: bool,
}

impl Reader<'_> {
    /// The curve that a pointer names, one after the other where it is composed of several.
    pub(super) fn curves(&mut self, pointer: i64, outer: &Affine) -> Read<Vec<Piece>> {
        let index = self.index(pointer, "a pointer to a curve")?;
        let entity = self.entities[index];
        if entity.kind == 102 {
            return self.composite(pointer, outer);
        }
        let resolution = self.global.resolution.unwrap_or(0.0);
        self.enter(pointer, "a curve", outer, |_, fields, map| {
            let piece = match (entity.kind, entity.form) {
                (100, _) => arc(fields, resolution)?,
                (106, 11..=13 | 63) => polyline(fields)?,
                (110, 0) => line(fields)?,
                (126, _) => spline(fields)?,
                (kind, form) => {
                    let known = "lines (110), arcs (100), polylines (106), B-splines (126) and curves composed of them (102) are";
                    let text = format!("a curve of type {kind}, form {form} is not read: {known}");
                    return Err(Problem::Entity(text).at(entity.place()));
                }
            };
            Ok(vec![Piece { curve: piece.curve.mapped(|p| map.point(p)), ..piece }])
        })
    }

    fn composite(&mut self, pointer: i64, outer: &Affine) -> Read<Vec<Piece>> {
        let (parts, map) = self.enter(pointer, "a composite curve", outer, |_, fields, map| {
            let count = fields.count("the number of curves", 1, 1)?;
            let parts: Read<Vec<i64>> = (0..count).map(|_| fields.int("a pointer")).collect();
            Ok((parts?, *map))
        })?;
        self.within(pointer, |reader| {
            let mut all = Vec::new();
            for part in parts {
                all.extend(reader.curves(part, &map)?);
            }
            Ok(all)
        })
    }

    /// A curve that must not be composed.
    pub(super) fn single(&mut self, pointer: i64, outer: &Affine) -> Read<Piece> {
        let mut pieces = self.curves(pointer, outer)?;
        match (pieces.pop(), pieces.is_empty()) {
            (Some(piece), true) => Ok(piece),
            _ => {
                let place = self.entities[self.index(pointer, "a pointer to a curve")?].place();
                let text = "a curve composed of several cannot generate a surface here".to_owned();
                Err(Problem::Entity(text).at(place))
            }
        }
    }
}

/// An arc in the plane z = z1, counterclockwise.
fn arc(fields: &mut Fields, resolution: f64) -> Read<Piece> {
    let what = "a coordinate of an arc";
    let z = fields.real(what)?;
    let mut point = || -> Read<Vector> { Ok([fields.real(what)?, fields.real(what)?, z]) };
    let (centre, from, to) = (point()?, point()?, point()?);
    let angle = |p: Vector| libm::atan2(p[1] - centre[1], p[0] - centre[0]);
    let start = angle(from);
    let radius = distance(centre, from);
    if distance(from, to) <= resolution.min(1e-3 * radius) {
        let curve =
            Curve::circle(centre, [0.0, 0.0, 1.0], from).map_err(|e| fields.fail(e.into()))?;
        return Ok(Piece { curve, range: [start, start + TAU], turns: true });
    }
    let end = if angle(to) > start { angle(to) } else { angle(to) + TAU };
    let middle = 0.5 * (start + end);
    let via = [centre[0] + radius * libm::cos(middle), centre[1] + radius * libm::sin(middle), z];
    let curve = Curve::arc(from, via, to).map_err(|error| fields.fail(error.into()))?;
    Ok(Piece { curve, range: [start, end], turns: true })
}

fn line(fields: &mut Fields) -> Read<Piece> {
    let what = "a coordinate of a line";
    let points = vec![fields.vector(what)?, fields.vector(what)?];
    let curve = Curve::polyline(points).map_err(|error| fields.fail(error.into()))?;
    Ok(Piece { curve, range: [0.0, 1.0], turns: false })
}

/// Points with a common z, points in space, or points with vectors that are left out.
fn polyline(fields: &mut Fields) -> Read<Piece> {
    let flag = fields.int("the kind of points: 1, 2 or 3")?;
    let each = match flag {
        1 => 2,
        2 => 3,
        3 => 6,
        other => {
            let (what, found) = ("the kind of points: 1, 2 or 3", other.to_string());
            return Err(fields.fail(Problem::Expected { what, found }));
        }
    };
    let count = fields.count("the number of points", 2, each)?;
    let what = "a coordinate of a point";
    let z = if flag == 1 { fields.real(what)? } else { 0.0 };
    let mut points = Vec::new();
    for _ in 0..count {
        let numbers = fields.reals(what, each)?;
        points.push([numbers[0], numbers[1], if flag == 1 { z } else { numbers[2] }]);
    }
    let last = (count - 1) as f64;
    let curve = Curve::polyline(points).map_err(|error| fields.fail(error.into()))?;
    Ok(Piece { curve, range: [0.0, last], turns: false })
}

fn spline(fields: &mut Fields) -> Read<Piece> {
    let points = fields.count("the number of control points, less one", 0, 5)? + 1;
    let degree = fields.count("the degree", 1, 1)?;
    for _ in 0..4 {
        fields.int("a property of a B-spline")?;
    }
    let knots = fields.reals("a knot", points + degree + 1)?;
    let weights = fields.reals("a weight", points)?;
    let mut net = Vec::new();
    for _ in 0..points {
        net.push(fields.vector("a coordinate of a control point")?);
    }
    let range = [fields.real("the first parameter")?, fields.real("the last parameter")?];
    let curve = Curve::new(degree, knots, net, uniform(weights));
    let curve = curve.map_err(|error| fields.fail(error.into()))?;
    let curve = match used(range, curve.domain()) {
        Some(range) => curve.part(range).map_err(|error| fields.fail(error.into()))?,
        None => curve,
    };
    Ok(Piece { range: curve.domain(), curve, turns: false })
}

/// Weights that are all alike are none.
pub(super) fn uniform(weights: Vec<f64>) -> Vec<f64> {
    let alike = weights.iter().all(|&w| w == weights[0] && w > 0.0);
    if alike { Vec::new() } else { weights }
}

/// The range of parameters to be used, unless it is all of them: what lies beyond them says nothing,
/// what lies inside is taken to the bit.
pub(super) fn used(range: [f64; 2], domain: [f64; 2]) -> Option<[f64; 2]> {
    let clipped = [range[0].max(domain[0]), range[1].min(domain[1])];
    (clipped != domain).then_some(clipped)
}
