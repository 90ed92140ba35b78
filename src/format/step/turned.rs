//! Cylinders, cones, spheres and tori as surfaces of revolution, with the places of their loops.
//!
//! The profile starts at a seam of the face where it has one, else in the gap that the loops leave, so
//! that no loop crosses where the surface comes round. u runs along the profile, v is the angle.

use super::boundary::{Ring, Use};
use super::path::{Path, Places, SAME, beginning, outline, snapped};
use super::record::{Entity, Frame};
use super::surface::{Cut, line};
use super::{RIMS, Read, Reader};
use crate::curve::Curve;
use crate::model::{Trim, TrimCurve};
use crate::surface::{Revolution, Surface};
use crate::vector::{Vector, along, dot, scale, sub};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Points on each edge whose places are found.
const SAMPLES: u32 = 64;

#[derive(Clone, Copy)]
enum Shape {
    /// Radius at the origin, and how much it grows for each unit along the axis.
    Straight { radius: f64, slope: f64 },
    /// Radius of the ring, 0 for a sphere, and of the tube.
    Round { ring: f64, tube: f64 },
}

#[derive(Clone, Copy)]
struct Turned {
    frame: Frame,
    shape: Shape,
}

impl Turned {
    /// The place of a point; its second number is not finite on the axis.
    fn place(&self, p: Vector) -> [f64; 2] {
        let Frame { origin, axes: [x, y, z] } = self.frame;
        let arm = sub(p, origin);
        let (a, b, height) = (dot(arm, x), dot(arm, y), dot(arm, z));
        let out = libm::hypot(a, b);
        match self.shape {
            Shape::Straight { radius, .. } => {
                let is_pole = out <= SAME * radius.max(height.abs());
                [height, if is_pole { f64::NAN } else { libm::atan2(b, a) }]
            }
            Shape::Round { ring, tube } => {
                let is_pole = out <= SAME * tube;
                let angle = libm::atan2(height, out - ring);
                [angle, if is_pole { f64::NAN } else { libm::atan2(b, a) }]
            }
        }
    }

    /// The height of a cone's apex.
    fn apex(&self) -> Option<f64> {
        match self.shape {
            Shape::Straight { radius, slope } if slope != 0.0 => Some(-radius / slope),
            _ => None,
        }
    }

    /// Whether a pole at a height or an angle of the tube is where the profile ends.
    fn ends_at(&self, h: f64) -> bool {
        match self.shape {
            Shape::Straight { slope, .. } => slope < 0.0,
            Shape::Round { .. } => h > 0.0,
        }
    }

    /// Where the loops of a face run; `None` if a pole lies inside an edge, or a loop does not come
    /// back to where it starts.
    fn paths(
        &self,
        reader: &Reader,
        loops: &[Ring],
    ) -> Result<(Vec<Path>, Option<usize>), &'static str> {
        let round = self.is_tube().then_some(TAU);
        let places = Places {
            of: &|p| self.place(p),
            periods: [round, Some(TAU)],
            is_end: &|h| self.ends_at(h),
            is_mirrored: true,
        };
        reader.paths(&places, loops)
    }

    fn is_tube(&self) -> bool {
        matches!(self.shape, Shape::Round { ring, .. } if ring > 0.0)
    }

    /// The point of a place.
    fn at(&self, [h, v]: [f64; 2]) -> Vector {
        let Frame { origin, axes: [x, y, z] } = self.frame;
        let (out, height) = match self.shape {
            Shape::Straight { radius, slope } => (radius + slope * h, h),
            Shape::Round { ring, tube } => (ring + tube * libm::cos(h), tube * libm::sin(h)),
        };
        let (sine, cosine) = libm::sincos(v);
        along(along(along(origin, height, z), out * cosine, x), out * sine, y)
    }

    /// The profile at an angle, over a range of heights or of angles of the tube.
    fn profile(&self, [low, high]: [f64; 2], v: f64) -> Result<Curve, crate::curve::CurveError> {
        let (from, to) = (self.at([low, v]), self.at([high, v]));
        match self.shape {
            Shape::Straight { .. } => {
                let tip = |h: f64, p: Vector| match self.apex() == Some(h) {
                    true => along(self.frame.origin, h, self.frame.axes[2]),
                    false => p,
                };
                line(tip(low, from), tip(high, to))
            }
            Shape::Round { ring, .. } if high - low >= TAU - SAME => {
                let Frame { origin, axes: [x, y, _] } = self.frame;
                let (sine, cosine) = libm::sincos(v);
                let out = along(scale(cosine, x), sine, y);
                let ahead = along(scale(-sine, x), cosine, y);
                Curve::circle(along(origin, ring, out), scale(-1.0, ahead), from)
            }
            Shape::Round { ring, tube } => {
                let pole = |h: f64, p: Vector| match ring == 0.0 && h.abs() == FRAC_PI_2 {
                    true => along(self.frame.origin, tube * h.signum(), self.frame.axes[2]),
                    false => p,
                };
                Curve::arc(pole(low, from), self.at([0.5 * (low + high), v]), pole(high, to))
            }
        }
    }

    /// The profile's parameter, from 0 to 1, at a height or an angle of the tube.
    fn along(&self, [low, high]: [f64; 2], h: f64) -> f64 {
        let part = (h - low) / (high - low);
        if matches!(self.shape, Shape::Straight { .. }) {
            return part;
        }
        // Arcs are rational quadratics, one for each quarter turn or less.
        let pieces = libm::ceil((high - low) / FRAC_PI_2 - 1e-9).max(1.0);
        let each = (high - low) / pieces;
        let piece = libm::floor(part * pieces).clamp(0.0, pieces - 1.0);
        let angle = h - low - piece * each;
        let (a, b) = (libm::sin(0.5 * angle), libm::sin(0.5 * (each - angle)));
        (piece + a / (a + b)) / pieces
    }
}

impl Reader<'_> {
    pub(super) fn turned(&mut self, base: &Entity, face: &Entity, loops: &[Ring]) -> Read<Cut> {
        let turned = self.shape(base)?;
        if let Some(cut) = self.whole(turned, base, face, loops)? {
            return Ok(cut);
        }
        let averted = self.averted(turned, loops);
        let (turned, found) = match averted.paths(self, loops) {
            Ok(found) => (averted, found),
            // A loop through both poles of a sphere may be all around the other ones.
            Err(_) => (turned, turned.paths(self, loops).map_err(|text| face.fail(text))?),
        };
        let (paths, outer) = found;
        if outer.is_none() && !matches!(turned.shape, Shape::Round { .. }) {
            return Err(face.fail("no loop bounds the surface"));
        }
        self.cut(turned, (base, face), (loops, paths, outer))
    }

    /// Where loops run, and which of them is the outline.
    pub(super) fn paths(
        &self,
        places: &Places,
        loops: &[Ring],
    ) -> Result<(Vec<Path>, Option<usize>), &'static str> {
        let mut paths: Vec<Path> = Vec::new();
        for ring in loops {
            let trail = |&edge: &Use| (edge.id, self.samples(edge, SAMPLES));
            let trails: Vec<_> = ring.edges.iter().map(trail).collect();
            let path = Path::along(places, ring, &trails);
            let path =
                path.ok_or("an edge runs through a pole between its vertices, which is not read")?;
            if !path.is_closed() {
                return Err("a loop goes around the surface without a seam, which is not read");
            }
            paths.push(path);
        }
        let outer = outline(places, &paths, loops);
        Ok((paths, outer))
    }

    fn shape(&self, base: &Entity) -> Read<Turned> {
        let fields = base.fields(None)?;
        let frame = self.records.frame(fields.reference(1, "the frame")?)?;
        let shape = match base.kind() {
            "CYLINDRICAL_SURFACE" => {
                Shape::Straight { radius: fields.length(2, "the radius")?, slope: 0.0 }
            }
            "CONICAL_SURFACE" => {
                let radius = fields.real(2, "the radius")?;
                let angle = fields.real(3, "the half angle")? * self.degrees;
                if radius < 0.0 || !(angle.abs() > 0.0 && angle.abs() < FRAC_PI_2) {
                    return Err(base.fail("a cone has a radius of at least 0 and a half angle between 0 and 90 degrees"));
                }
                Shape::Straight { radius, slope: libm::tan(angle) }
            }
            "SPHERICAL_SURFACE" => {
                Shape::Round { ring: 0.0, tube: fields.length(2, "the radius")? }
            }
            _ => {
                let (ring, tube) =
                    (fields.length(2, "the radius")?, fields.length(3, "the radius of the tube")?);
                if ring <= tube {
                    return Err(base.fail("a torus whose tube reaches its axis is not read"));
                }
                Shape::Round { ring, tube }
            }
        };
        Ok(Turned { frame, shape })
    }

    /// A face that is all of its surface, or all between circles where one end is a pole.
    fn whole(
        &mut self,
        turned: Turned,
        base: &Entity,
        face: &Entity,
        loops: &[Ring],
    ) -> Read<Option<Cut>> {
        let uses: Vec<Use> = loops.iter().flat_map(|ring| ring.edges.iter().copied()).collect();
        let times = |id: u64| uses.iter().filter(|edge| edge.id == id).count();
        let rims: Vec<Use> = uses.iter().copied().filter(|edge| times(edge.id) == 1).collect();
        let round = matches!(turned.shape, Shape::Round { .. });
        let full = if turned.is_tube() { [0.0, TAU] } else { [-FRAC_PI_2, FRAC_PI_2] };
        if rims.is_empty() && round {
            let cut = self.revolved(turned, full, 0.0).map_err(|error| base.at(error))?;
            return Ok(Some(Cut { surface: cut, trim: None }));
        }
        // From pole to circle: one seam, used twice, and one closed edge.
        let seam = uses.iter().find(|edge| times(edge.id) == 2);
        let (Some(&seam), [rim], false) = (seam, rims.as_slice(), turned.is_tube()) else {
            return Ok(None);
        };
        let profile = self.edges[&seam.id].clone();
        let ends = profile.ends().map(|p| turned.place(p));
        let is_fit = uses.len() == 3 && self.edges[&rim.id].is_closed();
        let Some(pole) = (0..2).find(|&i| ends[i][1].is_nan()).filter(|_| is_fit) else {
            return Ok(None);
        };
        let Frame { origin, axes: [.., z] } = turned.frame;
        let mut tips = profile.ends();
        tips[pole] = along(origin, dot(sub(tips[pole], origin), z), z);
        let surface = Revolution::new(profile.with_ends(tips), origin, z, [0.0, 360.0]);
        let surface = surface.map_err(|error| base.at(error.into()))?;
        let surface = Surface::Revolution(surface.computed());
        self.rim(*rim, surface.side(RIMS[1 - pole]), face)?;
        Ok(Some(Cut { surface, trim: None }))
    }

    fn revolved(
        &self,
        turned: Turned,
        range: [f64; 2],
        start: f64,
    ) -> Result<Surface, super::Problem> {
        let profile = turned.profile(range, start)?;
        let Frame { origin, axes: [.., z] } = turned.frame;
        Ok(Surface::Revolution(Revolution::new(profile, origin, z, [0.0, 360.0])?.computed()))
    }

    /// A sphere turned so that its poles are far from the loops, where no seam says how it lies.
    fn averted(&self, turned: Turned, loops: &[Ring]) -> Turned {
        if !matches!(turned.shape, Shape::Round { ring, .. } if ring == 0.0) {
            return turned;
        }
        let uses: Vec<u64> =
            loops.iter().flat_map(|r| r.edges.iter().map(|edge| edge.id)).collect();
        let has_seam = uses.iter().any(|id| uses.iter().filter(|other| *other == id).count() > 1);
        let Some(first) = loops.first().filter(|_| !has_seam) else { return turned };
        let origin = turned.frame.origin;
        let points = first.edges.iter().flat_map(|&edge| self.samples(edge, SAMPLES));
        let sum = points.fold([0.0; 3], |sum, p| along(sum, 1.0, sub(p, origin)));
        let Some(x) = crate::vector::unit(sum) else { return turned };
        let least = (0..3).min_by(|&a, &b| x[a].abs().total_cmp(&x[b].abs())).unwrap_or(0);
        let mut aside = [0.0; 3];
        aside[least] = 1.0;
        let Some(z) = crate::vector::unit(crate::vector::cross(x, aside)) else { return turned };
        Turned { frame: Frame { origin, axes: [x, crate::vector::cross(z, x), z] }, ..turned }
    }

    fn cut(
        &self,
        turned: Turned,
        (base, face): (&Entity, &Entity),
        (loops, mut paths, outer): (&[Ring], Vec<Path>, Option<usize>),
    ) -> Read<Cut> {
        let whole = outer.is_none();
        let first = &paths[outer.unwrap_or(0)];
        let start = beginning(first.range(1), whole);
        let [low, high] = first.range(0);
        let range = match turned.shape {
            Shape::Straight { radius, slope } => {
                let room = 0.05 * (high - low);
                let wide = [low - room, high + room];
                // Not beyond the apex.
                let end = |h: f64, wide: f64| match turned.apex() {
                    Some(apex) if (h - apex).abs() <= SAME * (high - low) => apex,
                    _ if radius + slope * wide <= 0.0 => h,
                    _ => wide,
                };
                [end(low, wide[0]), end(high, wide[1])]
            }
            Shape::Round { ring: 0.0, .. } => [-FRAC_PI_2, FRAC_PI_2],
            Shape::Round { .. } => {
                let from = beginning([low, high], whole);
                [from, from + TAU]
            }
        };
        let surface = self.revolved(turned, range, start).map_err(|error| base.at(error))?;
        for path in &mut paths {
            let shift = |i: usize, from: f64| {
                let [low, high] = path.range(i);
                TAU * libm::floor((0.5 * (low + high) - from) / TAU)
            };
            let shifts = [if turned.is_tube() { shift(0, range[0]) } else { 0.0 }, shift(1, start)];
            for place in path.edges.iter_mut().flatten() {
                let v = place[1] - shifts[1] - start;
                let u = turned.along(range, place[0] - shifts[0]);
                *place = [snapped(u, 1.0), snapped(v, TAU)];
            }
        }
        let trim = self.placed(face, (loops, paths, outer))?;
        Ok(Cut { surface: surface.joined(), trim: Some(trim) })
    }

    /// The curves of loops with their places.
    pub(super) fn placed(
        &self,
        face: &Entity,
        (loops, paths, outer): (&[Ring], Vec<Path>, Option<usize>),
    ) -> Read<Trim> {
        let mut rings = Vec::new();
        for (ring, path) in loops.iter().zip(paths) {
            let mut curves = Vec::new();
            for (&edge, places) in ring.edges.iter().zip(path.edges) {
                let points = places.into_iter().map(|[u, v]| [u, v, 0.0]).collect();
                let flat = Curve::polyline(points).map_err(|error| face.at(error.into()))?;
                curves
                    .push(TrimCurve::Space { curve: self.oriented(edge), parameters: Some(flat) });
            }
            rings.push(curves);
        }
        let outline = outer.map(|i| rings.remove(i));
        Ok(Trim { outline, holes: rings })
    }
}
