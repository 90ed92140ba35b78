//! Surfaces of STEP: planes and B-splines, and the choice among all kinds.

use super::boundary::Ring;
use super::record::{Entity, Frame};
use super::{Read, Reader};
use crate::curve::Curve;
use crate::model::Trim;
use crate::surface::{Side, Surface, Tensor};
use crate::vector::{Vector, along, distance, dot, sub};

/// A surface, and what its loops leave of it; all where there is no trim.
pub(super) struct Cut {
    pub(super) surface: Surface,
    pub(super) trim: Option<Trim>,
}

/// Points on each edge that tell how far a loop reaches.
const SAMPLES: u32 = 16;

impl Reader<'_> {
    pub(super) fn surface(&mut self, base: &Entity, face: &Entity, loops: &[Ring]) -> Read<Cut> {
        match base.kind() {
            "PLANE" => self.plane(base, face, loops),
            "CYLINDRICAL_SURFACE"
            | "CONICAL_SURFACE"
            | "SPHERICAL_SURFACE"
            | "TOROIDAL_SURFACE" => self.turned(base, face, loops),
            "SURFACE_OF_LINEAR_EXTRUSION" | "SURFACE_OF_REVOLUTION" => {
                self.swept(base, face, loops)
            }
            "B_SPLINE_SURFACE_WITH_KNOTS" | "B_SPLINE_SURFACE" => {
                let surface = self.tensor(base)?;
                let surface = surface.map_err(|error| base.at(error.into()))?;
                let (surface, is_closed) = (Surface::Tensor(surface), closed(base)?);
                let has_pole = Side::ALL.iter().any(|&side| surface.side(side).is_point());
                if !loops.is_empty() && (has_pole || is_closed.contains(&true)) {
                    return self.around(surface, is_closed, (base, face), loops);
                }
                let trim = (!loops.is_empty()).then(|| self.trim(loops));
                Ok(Cut { surface: surface.joined(), trim })
            }
            _ => {
                let known = "planes, cylinders, cones, spheres, tori, \
                             surfaces of extrusion and of revolution, and B-splines with knots are";
                Err(base.fail(&format!("a surface of this kind is not read: {known}")))
            }
        }
    }

    /// The largest loop, or the one said to be the outer, is the outline.
    fn trim(&self, loops: &[Ring]) -> Trim {
        let size = |ring: &Ring| {
            let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
            for p in self.points(ring) {
                for i in 0..3 {
                    (low[i], high[i]) = (low[i].min(p[i]), high[i].max(p[i]));
                }
            }
            (ring.is_outer, distance(low, high))
        };
        let sizes: Vec<(bool, f64)> = loops.iter().map(size).collect();
        let rank = |&i: &usize, &j: &usize| {
            sizes[i].0.cmp(&sizes[j].0).then(sizes[i].1.total_cmp(&sizes[j].1))
        };
        let outer = (0..loops.len()).max_by(rank);
        let holes = (0..loops.len()).filter(|&i| Some(i) != outer);
        Trim {
            outline: outer.map(|i| self.plain(&loops[i])),
            holes: holes.map(|i| self.plain(&loops[i])).collect(),
        }
    }

    /// Points along a loop.
    fn points(&self, ring: &Ring) -> Vec<Vector> {
        ring.edges.iter().flat_map(|&edge| self.samples(edge, SAMPLES)).collect()
    }

    /// A piece of a plane that holds the loops with room around.
    fn plane(&self, base: &Entity, face: &Entity, loops: &[Ring]) -> Read<Cut> {
        let frame = base.fields(None)?.reference(1, "the frame")?;
        self.flat(self.records.frame(frame)?, (base, face), loops)
    }

    /// The same in a frame.
    pub(super) fn flat(
        &self,
        Frame { origin, axes: [x, y, _] }: Frame,
        (base, face): (&Entity, &Entity),
        loops: &[Ring],
    ) -> Read<Cut> {
        if loops.is_empty() {
            return Err(face.fail("a plane needs a loop around it"));
        }
        let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for p in loops.iter().flat_map(|ring| self.points(ring)) {
            for (range, way) in ranges.iter_mut().zip([x, y]) {
                let at = dot(sub(p, origin), way);
                *range = [range[0].min(at), range[1].max(at)];
            }
        }
        // Curves bulge beyond their samples by less than the room.
        let room = 0.1 * ranges.iter().map(|[low, high]| high - low).fold(0.0, f64::max);
        let [[s0, s1], [t0, t1]] = ranges.map(|[low, high]| [low - room, high + room]);
        let at = |s: f64, t: f64| along(along(origin, s, x), t, y);
        let rows = [vec![at(s0, t0), at(s0, t1)], vec![at(s1, t0), at(s1, t1)]];
        let tensor = Tensor::bezier(&rows).map_err(|error| base.at(error.into()))?;
        Ok(Cut { surface: Surface::Tensor(tensor), trim: Some(self.trim(loops)) })
    }

    fn tensor(&self, base: &Entity) -> Read<Result<Tensor, crate::surface::SurfaceError>> {
        // The parts of a complex record begin with their own parameters, a simple one with a name.
        let (shape, first) = match base.is_complex() {
            true => (base.fields(Some("B_SPLINE_SURFACE"))?, 0),
            false => (base.fields(Some("B_SPLINE_SURFACE_WITH_KNOTS"))?, 1),
        };
        let knots = base.fields(Some("B_SPLINE_SURFACE_WITH_KNOTS"))?;
        let degrees = [
            shape.count(first, "the degree along u")?,
            shape.count(first + 1, "the degree along v")?,
        ];
        let ids = shape.grid(first + 2, "the control points")?;
        let columns = ids.first().map_or(0, Vec::len);
        let most = |points: usize, degree: usize| points + degree.min(points) + 1;
        let place = if base.is_complex() { 0 } else { 8 };
        let knots = [
            knots.knots([place, place + 2], most(ids.len(), degrees[0]))?,
            knots.knots([place + 1, place + 3], most(columns, degrees[1]))?,
        ];
        let row = |row: &Vec<u64>| row.iter().map(|&id| self.records.point(id)).collect();
        let rows: Read<Vec<Vec<Vector>>> = ids.iter().map(row).collect();
        let weights = match base.part("RATIONAL_B_SPLINE_SURFACE") {
            Some(part) => part.real_grid(0, "the weights")?,
            None => Vec::new(),
        };
        let tensor = Tensor::new(degrees, knots, &rows?, &weights);
        Ok(tensor.and_then(|tensor| match tensor.is_clamped() {
            true => Ok(tensor),
            false => {
                let domain = Surface::Tensor(tensor.clone()).domain();
                tensor.part(domain)
            }
        }))
    }
}

/// Whether a B-spline surface is said to come round along u, and along v.
fn closed(base: &Entity) -> Read<[bool; 2]> {
    let (fields, first) = match base.is_complex() {
        true => (base.fields(Some("B_SPLINE_SURFACE"))?, 4),
        false => (base.fields(Some("B_SPLINE_SURFACE_WITH_KNOTS"))?, 5),
    };
    Ok([fields.says(first), fields.says(first + 1)])
}

/// A straight curve between two points.
pub(super) fn line(from: Vector, to: Vector) -> Result<Curve, crate::curve::CurveError> {
    Curve::polyline(vec![from, to])
}
