//! Surfaces of IGES: B-splines (128), of revolution (120), tabulated cylinders (122) and planes (108).

use super::super::domain_file::Problem;
use super::curve::{Piece, uniform, used};
use super::fields::Fields;
use super::{Affine, Read, Reader};
use crate::curve::Curve;
use crate::surface::{Revolution, Surface, SurfaceError, Tensor};
use crate::vector::{Vector, add, along, cross, dot, norm, scale, sub, unit};
use std::f64::consts::TAU;

/// A surface, and the ranges of the parameters that IGES gives it.
pub(super) struct Base {
    pub(super) surface: Surface,
    pub(super) ranges: [[f64; 2]; 2],
    /// Whether u is an angle.
    pub(super) u_turns: bool,
}

/// Types of surfaces that are read without a boundary of their own.
pub(super) const KINDS: [i64; 3] = [120, 122, 128];

/// A full turn in a file of ten digits.
const FULL: f64 = 1e-7;

impl Reader<'_> {
    /// The surface that a pointer names. A plane is large enough to hold `points`.
    pub(super) fn surface(
        &mut self,
        pointer: i64,
        outer: &Affine,
        points: &[Vector],
    ) -> Read<Base> {
        let entity = self.entities[self.index(pointer, "a pointer to a surface")?];
        match entity.kind {
            108 => {
                self.enter(pointer, "a plane", outer, |_, fields, map| plane(fields, map, points))
            }
            120 => self.revolution(pointer, outer),
            122 => self.cylinder(pointer, outer),
            128 => self
                .enter(pointer, "a B-spline surface", outer, |_, fields, map| spline(fields, map)),
            kind => {
                let text = format!(
                    "a surface of type {kind} is not read: B-splines (128), surfaces of revolution (120), tabulated cylinders (122) and planes (108) are"
                );
                Err(Problem::Entity(text).at(entity.place()))
            }
        }
    }

    fn revolution(&mut self, pointer: i64, outer: &Affine) -> Read<Base> {
        let what = "a surface of revolution";
        let ([axis, profile], angles, map) =
            self.enter(pointer, what, outer, |_, fields, map| {
                let pointers = [fields.int("a pointer to the axis")?, fields.int("a pointer")?];
                let angle = "an angle of revolution";
                Ok((pointers, [fields.real(angle)?, fields.real(angle)?], *map))
            })?;
        let place = self.entities[self.index(pointer, what)?].place();
        let (axis, Piece { curve: profile, range, turns: u_turns }) = self
            .within(pointer, |reader| {
                Ok((reader.single(axis, &map)?, reader.single(profile, &map)?))
            })?;
        if !map.is_rigid() {
            let text = "a surface of revolution is stretched by its matrix".to_owned();
            return Err(Problem::Entity(text).at(place));
        }
        let [from, to] = axis.curve.ends();
        let direction = scale(if map.determinant() < 0.0 { -1.0 } else { 1.0 }, sub(to, from));
        let full = (angles[1] - angles[0] - TAU).abs() <= FULL;
        let degrees = angles.map(f64::to_degrees);
        let degrees = if full { [degrees[0], degrees[0] + 360.0] } else { degrees };
        let profile = on_axis(profile, from, direction, self.global.resolution.unwrap_or(0.0));
        let surface = Revolution::new(profile, from, direction, degrees)
            .map_err(|error| Problem::from(error).at(place))?;
        let surface = Surface::Revolution(surface.computed());
        Ok(Base { surface, ranges: [range, angles], u_turns })
    }

    fn cylinder(&mut self, pointer: i64, outer: &Affine) -> Read<Base> {
        let what = "a tabulated cylinder";
        let (directrix, to, map) = self.enter(pointer, what, outer, |_, fields, map| {
            let directrix = fields.int("a pointer to the directrix")?;
            Ok((directrix, fields.vector("the end of the generatrix")?, *map))
        })?;
        let place = self.entities[self.index(pointer, what)?].place();
        let Piece { curve, range, .. } =
            self.within(pointer, |reader| reader.single(directrix, &map))?;
        let way = sub(map.point(to), curve.ends()[0]);
        let tensor = swept(&curve, way).map_err(|error| Problem::from(error).at(place))?;
        let ranges = [range, [0.0, 1.0]];
        Ok(Base { surface: Surface::Tensor(tensor), ranges, u_turns: false })
    }
}

/// The surface that a curve sweeps along a vector.
fn swept(curve: &Curve, way: Vector) -> Result<Tensor, SurfaceError> {
    let rows: Vec<Vec<Vector>> = curve.points().iter().map(|&p| vec![p, add(p, way)]).collect();
    let weights: Vec<Vec<f64>> = curve.weights().iter().map(|&w| vec![w, w]).collect();
    let knots = [curve.knots().to_vec(), vec![0.0, 0.0, 1.0, 1.0]];
    clamped(Tensor::new([curve.degree(), 1], knots, &rows, &weights)?)
}

fn clamped(tensor: Tensor) -> Result<Tensor, SurfaceError> {
    let domain = Surface::Tensor(tensor.clone()).domain();
    if tensor.is_clamped() { Ok(tensor) } else { tensor.part(domain) }
}

/// A profile whose ends lie on the axis where they are as near as the file can tell.
fn on_axis(profile: Curve, origin: Vector, axis: Vector, resolution: f64) -> Curve {
    let Some(axis) = unit(axis) else { return profile };
    let ends = profile.ends().map(|p| {
        let arm = sub(p, origin);
        let near = norm(cross(axis, arm)) <= resolution;
        if near { along(origin, dot(arm, axis), axis) } else { p }
    });
    profile.with_ends(ends)
}

fn spline(fields: &mut Fields, map: &Affine) -> Read<Base> {
    let counts = [
        fields.count("the number of control points along u, less one", 1, 4)? + 1,
        fields.count("the number of control points along v, less one", 1, 4)? + 1,
    ];
    let degrees =
        [fields.count("the degree along u", 1, 1)?, fields.count("the degree along v", 1, 1)?];
    for _ in 0..5 {
        fields.int("a property of a B-spline")?;
    }
    let total = fields.product(counts, "the number of control points", 4)?;
    let knots = [
        fields.reals("a knot", counts[0] + degrees[0] + 1)?,
        fields.reals("a knot", counts[1] + degrees[1] + 1)?,
    ];
    let weights = uniform(fields.reals("a weight", total)?);
    let mut net = Vec::new();
    for _ in 0..total {
        net.push(map.point(fields.vector("a coordinate of a control point")?));
    }
    let what = "a parameter where the surface starts or ends";
    let mut range = || -> Read<[f64; 2]> { Ok([fields.real(what)?, fields.real(what)?]) };
    let ranges = [range()?, range()?];
    // In the file u runs faster.
    let [rows, columns] = counts;
    let of_row = |i: usize| (0..columns).map(move |j| j * rows + i);
    let points: Vec<Vec<Vector>> = (0..rows).map(|i| of_row(i).map(|k| net[k]).collect()).collect();
    let weights: Vec<Vec<f64>> = match weights.is_empty() {
        true => Vec::new(),
        false => (0..rows).map(|i| of_row(i).map(|k| weights[k]).collect()).collect(),
    };
    let tensor = Tensor::new(degrees, knots, &points, &weights);
    let tensor = tensor.and_then(|tensor| {
        let domain = Surface::Tensor(tensor.clone()).domain();
        let parts = [0, 1].map(|i| used(ranges[i], domain[i]).unwrap_or(domain[i]));
        if parts == domain { clamped(tensor) } else { tensor.part(parts) }
    });
    let surface = Surface::Tensor(tensor.map_err(|error| fields.fail(error.into()))?);
    let ranges = surface.domain();
    Ok(Base { surface, ranges, u_turns: false })
}

/// A piece of the plane a x + b y + c z = d that holds some points of it with room around.
fn plane(fields: &mut Fields, map: &Affine, points: &[Vector]) -> Read<Base> {
    let normal = fields.vector("a coefficient of a plane")?;
    let distance = fields.real("a coefficient of a plane")?;
    let length_sq = dot(normal, normal);
    let foot = map.point(scale(distance / length_sq, normal));
    // The least component of the normal gives a direction well across it.
    let least = (0..3).min_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs())).unwrap_or(0);
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let first = unit(cross(axis, normal));
    let second = first.and_then(|first| unit(cross(normal, first)));
    let frame = first.zip(second).filter(|_| length_sq.is_finite() && !points.is_empty());
    let Some((first, second)) = frame else {
        let text = "a plane needs a normal, and a curve around it".to_owned();
        return Err(fields.fail(Problem::Entity(text)));
    };
    let frame = [first, second].map(|way| map.vector(way));
    let frame = frame.map(|way| unit(way).unwrap_or(way));
    let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for &p in points {
        for (range, &way) in ranges.iter_mut().zip(&frame) {
            let along = dot(sub(p, foot), way);
            *range = [range[0].min(along), range[1].max(along)];
        }
    }
    let room = 0.05 * ranges.iter().map(|[low, high]| high - low).fold(0.0, f64::max);
    let [[s0, s1], [t0, t1]] = ranges.map(|[low, high]| [low - room, high + room]);
    let at = |s: f64, t: f64| along(along(foot, s, frame[0]), t, frame[1]);
    let rows = [vec![at(s0, t0), at(s0, t1)], vec![at(s1, t0), at(s1, t1)]];
    let tensor = Tensor::bezier(&rows).map_err(|error| fields.fail(error.into()))?;
    Ok(Base { surface: Surface::Tensor(tensor), ranges: [[0.0, 1.0]; 2], u_turns: false })
}
