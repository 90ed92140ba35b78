//! Surfaces of linear extrusion and of revolution: a curve that is pulled along a line, or turns about
//! one. u is the parameter of the curve, v the length of the way or the angle.

use super::boundary::Ring;
use super::curve::nearest_by;
use super::path::{Path, Places, SAME, beginning, snapped};
use super::record::{Entity, Frame};
use super::surface::Cut;
use super::{Read, Reader};
use crate::curve::Curve;
use crate::surface::{Revolution, Surface, SurfaceError, Tensor};
use crate::vector::{Vector, along, cross, distance, dot, norm, scale, sub, unit};
use std::f64::consts::TAU;

/// How much room there is beside the loops, as a fraction of how far they reach.
const ROOM: f64 = 0.1;

#[derive(Clone, Copy)]
enum Way {
    /// Along a unit vector.
    Pulled(Vector),
    /// About the axis through a point.
    Turned { origin: Vector, axis: Vector },
}

struct Swept {
    curve: Curve,
    way: Way,
    /// How far the curve reaches.
    size: f64,
}

impl Swept {
    fn new(curve: Curve, way: Way) -> Self {
        let middle = curve.points()[0];
        let reach = |from: Vector| {
            let far = curve.points().iter().map(|&p| distance(p, from));
            far.fold(0.0, f64::max)
        };
        let size = match way {
            Way::Pulled(_) => reach(middle),
            Way::Turned { origin, .. } => reach(origin),
        };
        Self { curve, way, size }
    }

    /// The place of a point; its second number is not finite on the axis.
    fn place(&self, p: Vector) -> [f64; 2] {
        match self.way {
            Way::Pulled(way) => {
                let across = |arm: Vector| norm(along(arm, -dot(arm, way), way));
                let u = nearest_by(&self.curve, |q| across(sub(q, p)));
                [u, dot(sub(p, self.curve.at(u)), way)]
            }
            Way::Turned { origin, axis } => {
                let split = |q: Vector| {
                    let arm = sub(q, origin);
                    let height = dot(arm, axis);
                    (height, along(arm, -height, axis))
                };
                let (height, out) = split(p);
                let radius = norm(out);
                let off = |q: Vector| {
                    let (h, o) = split(q);
                    libm::hypot(h - height, norm(o) - radius)
                };
                let u = nearest_by(&self.curve, off);
                let (_, from) = split(self.curve.at(u));
                let angle = libm::atan2(dot(cross(from, out), axis), dot(from, out));
                [u, if radius <= SAME * self.size { f64::NAN } else { angle }]
            }
        }
    }

    fn is_turned(&self) -> bool {
        matches!(self.way, Way::Turned { .. })
    }

    /// The curve turned by an angle, its ends on the axis exactly where they are so near to it that no
    /// angle can be told.
    fn profile(&self, angle: f64) -> Curve {
        let Way::Turned { origin, axis } = self.way else { return self.curve.clone() };
        let (sine, cosine) = libm::sincos(angle);
        let turn = |p: Vector| {
            let arm = sub(p, origin);
            let up = scale(dot(arm, axis), axis);
            let out = sub(arm, up);
            along(along(along(origin, 1.0, up), cosine, out), sine, cross(axis, arm))
        };
        let turned = if angle == 0.0 { self.curve.clone() } else { self.curve.mapped(turn) };
        let tip = |p: Vector| {
            let arm = sub(p, origin);
            let height = dot(arm, axis);
            let is_pole = norm(along(arm, -height, axis)) <= SAME * self.size;
            if is_pole { along(origin, height, axis) } else { p }
        };
        let ends = turned.ends();
        turned.with_ends(ends.map(tip))
    }

    /// The surface over a range of ways or from an angle on.
    fn surface(&self, [low, high]: [f64; 2]) -> Result<Surface, SurfaceError> {
        match self.way {
            Way::Turned { origin, axis } => {
                let profile = self.profile(low);
                let whole = Revolution::new(profile, origin, axis, [0.0, 360.0])?.computed();
                Ok(Surface::Revolution(whole).joined())
            }
            Way::Pulled(way) => {
                let pulled = |&p: &Vector| vec![along(p, low, way), along(p, high, way)];
                let rows: Vec<Vec<Vector>> = self.curve.points().iter().map(pulled).collect();
                let weights: Vec<Vec<f64>> =
                    self.curve.weights().iter().map(|&w| vec![w, w]).collect();
                let knots = [self.curve.knots().to_vec(), vec![0.0, 0.0, 1.0, 1.0]];
                let tensor = Tensor::new([self.curve.degree(), 1], knots, &rows, &weights)?;
                Ok(Surface::Tensor(tensor).joined())
            }
        }
    }
}

impl Reader<'_> {
    /// A face on a surface of linear extrusion or of revolution.
    pub(super) fn swept(&mut self, base: &Entity, face: &Entity, loops: &[Ring]) -> Read<Cut> {
        let fields = base.fields(None)?;
        let (id, second) = (fields.reference(1, "the curve")?, fields.reference(2, "the way")?);
        let way = match base.kind() {
            "SURFACE_OF_LINEAR_EXTRUSION" => Way::Pulled(self.records.vector(second)?),
            _ => {
                let [origin, axis] = self.records.axis(second)?;
                Way::Turned { origin, axis }
            }
        };
        match (self.basis(id, 0)?, way) {
            ((_, Some(curve)), _) => self.swept_from(Swept::new(curve, way), (base, face), loops),
            ((line, None), Way::Pulled(way)) => {
                let [point, direction] = self.records.line(&line)?;
                let y = unit(along(way, -dot(way, direction), direction));
                let y = y.ok_or_else(|| base.fail("a line that is pulled along itself is no surface"))?;
                let frame = Frame { origin: point, axes: [direction, y, cross(direction, y)] };
                self.flat(frame, (base, face), loops)
            }
            ((line, None), Way::Turned { .. }) => Err(line.fail(
                "a line that turns is not read as a SURFACE_OF_REVOLUTION: a plane, cylinder or cone is",
            )),
        }
    }

    fn swept_from(
        &self,
        swept: Swept,
        (base, face): (&Entity, &Entity),
        loops: &[Ring],
    ) -> Read<Cut> {
        let [start, end] = swept.curve.domain();
        let middle = 0.5 * (start + end);
        let places = Places {
            of: &|p| swept.place(p),
            periods: [
                swept.curve.is_closed().then_some(end - start),
                swept.is_turned().then_some(TAU),
            ],
            is_end: &|u| u > middle,
            is_mirrored: swept.is_turned(),
        };
        let points: usize = loops.iter().map(|ring| ring.edges.len()).sum();
        self.records.spend(points.saturating_mul(swept.curve.points().len()), base)?;
        let (paths, outer) = self.paths(&places, loops).map_err(|text| face.fail(text))?;
        if outer.is_none() && (!swept.is_turned() || !loops.is_empty() || !swept.curve.is_closed())
        {
            return Err(face.fail("no loop bounds the surface"));
        }
        let range = match (swept.way, outer.map(|i| &paths[i])) {
            (Way::Turned { .. }, Some(outer)) => {
                let from = beginning(outer.range(1), false);
                let from = if from.abs() <= SAME { 0.0 } else { from };
                [from, from + TAU]
            }
            (Way::Turned { .. }, None) => [0.0, TAU],
            (Way::Pulled(_), outer) => {
                let [low, high] = outer.map_or([0.0, 1.0], |path| path.range(1));
                let room = ROOM * (high - low);
                [low - room, high + room]
            }
        };
        let surface = swept.surface(range).map_err(|error| base.at(error.into()))?;
        let paths = paths.into_iter().map(|path| swept.settled(path, range)).collect();
        let trim = self.placed(face, (loops, paths, outer))?;
        Ok(Cut { surface, trim: (!loops.is_empty()).then_some(trim) })
    }
}

impl Swept {
    /// A path in the parameters of the surface.
    fn settled(&self, mut path: Path, [from, to]: [f64; 2]) -> Path {
        let [start, end] = self.curve.domain();
        let turns = |range: [f64; 2], from: f64, period: f64| {
            period * libm::floor((0.5 * (range[0] + range[1]) - from) / period)
        };
        let u_shift =
            if self.curve.is_closed() { turns(path.range(0), start, end - start) } else { 0.0 };
        let v_shift = if self.is_turned() { turns(path.range(1), from, TAU) } else { 0.0 };
        for place in path.edges.iter_mut().flatten() {
            let u = (place[0] - u_shift - start) / (end - start);
            let v = place[1] - v_shift - from;
            let v = if self.is_turned() { snapped(v, TAU) } else { v / (to - from) };
            *place = [start + snapped(u, 1.0) * (end - start), v];
        }
        path
    }
}
