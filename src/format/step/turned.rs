//! Cylinders, cones, spheres and tori as surfaces of revolution, with the places of their loops.
//!
//! The profile starts at a seam of the face where it has one, else in the gap that the loops leave, so
//! that no loop crosses where the surface comes round. u runs along the profile, v is the angle.

use super::boundary::{Ring, Use};
use super::record::{Entity, Frame};
use super::surface::{Cut, line};
use super::{RIMS, Read, Reader};
use crate::curve::Curve;
use crate::model::{Trim, TrimCurve};
use crate::surface::{Revolution, Surface};
use crate::vector::{Vector, along, dot, scale, sub};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Points on each edge whose places are found.
const SAMPLES: u32 = 64;
/// Angles nearer than this (radians) are one.
const SAME: f64 = 1e-6;

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

/// Where a loop runs: for each edge the places of its samples, in the direction of the loop. The
/// first number is a height along the axis or an angle of the tube, the second the angle about the axis.
struct Path {
    edges: Vec<Vec<[f64; 2]>>,
    /// How far it ends from where it starts.
    winding: [f64; 2],
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
            Shape::Straight { .. } => line(from, to),
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
        let turned = self.averted(turned, loops);
        let mut paths: Vec<Path> = Vec::new();
        for ring in loops {
            let path = self.path(turned, ring);
            let path =
                path.ok_or_else(|| face.fail("a loop runs through a pole, which is not read"))?;
            if path.winding.iter().any(|turn| turn.abs() > SAME) {
                return Err(
                    face.fail("a loop goes around the surface without a seam, which is not read")
                );
            }
            paths.push(path);
        }
        let outer = outline(&paths, loops);
        if outer.is_none() && !matches!(turned.shape, Shape::Round { .. }) {
            return Err(face.fail("no loop bounds the surface"));
        }
        self.cut(turned, (base, face), (loops, paths, outer))
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

    /// Where a loop runs, without jumps; `None` if it meets a pole.
    fn path(&self, turned: Turned, ring: &Ring) -> Option<Path> {
        let mut last: Option<[f64; 2]> = None;
        let mut edges = Vec::new();
        for &edge in &ring.edges {
            let mut places = Vec::new();
            for p in self.samples(edge, SAMPLES) {
                let mut place = turned.place(p);
                if place[1].is_nan() {
                    return None;
                }
                if let Some(last) = last {
                    place[1] = nearby(place[1], last[1]);
                    if turned.is_tube() {
                        place[0] = nearby(place[0], last[0]);
                    }
                }
                last = Some(place);
                places.push(place);
            }
            edges.push(places);
        }
        let (first, last) = (edges.first()?.first()?, last?);
        let winding = [last[0] - first[0], last[1] - first[1]];
        let size = if turned.is_tube() { 1.0 } else { f64::INFINITY };
        Some(Path { edges, winding: [winding[0] / size, winding[1]] })
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
                let is_narrow = |h: f64| radius + slope * h <= 0.0;
                let [w0, w1] = wide;
                [if is_narrow(w0) { low } else { w0 }, if is_narrow(w1) { high } else { w1 }]
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
        Ok(Cut { surface: surface.joined(), trim: Some(Trim { outline, holes: rings }) })
    }
}

impl Path {
    /// From the least to the greatest of one of the numbers.
    fn range(&self, i: usize) -> [f64; 2] {
        let all = self.edges.iter().flatten().map(|place| place[i]);
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    }

    /// Twice the area that it goes around.
    fn area(&self) -> f64 {
        let places: Vec<[f64; 2]> = self.edges.iter().flatten().copied().collect();
        let next = places.iter().cycle().skip(1);
        places.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum()
    }
}

/// The loop that bounds the surface from outside. (u, v) is a mirror image of the surface seen from
/// outside, so that such a loop, which has the surface at its left hand, has a negative area.
fn outline(paths: &[Path], loops: &[Ring]) -> Option<usize> {
    let outer = |i: &usize| (paths[*i].area() < 0.0) == loops[*i].is_left;
    let areas = |&i: &usize, &j: &usize| paths[i].area().abs().total_cmp(&paths[j].area().abs());
    (0..paths.len()).filter(outer).max_by(areas)
}

/// Where the surface should come round: at the loop's first angle if it goes all around, opposite to its
/// middle otherwise, or beside it if it is a hole.
fn beginning([low, high]: [f64; 2], is_hole: bool) -> f64 {
    let middle = 0.5 * (low + high);
    let is_full = high - low >= TAU - SAME;
    if is_full && !is_hole { low } else { middle - PI }
}

/// The angle by full turns nearest to another.
fn nearby(angle: f64, other: f64) -> f64 {
    angle + TAU * libm::round((other - angle) / TAU)
}

/// A place on an end of the range where it is as near as angles are told apart.
fn snapped(x: f64, end: f64) -> f64 {
    if x.abs() <= SAME {
        0.0
    } else if (x - end).abs() <= SAME {
        end
    } else {
        x
    }
}
