//! Where a point of a B-spline surface lies in its parameters, for loops that follow a seam or meet a
//! pole: Gauss and Newton's steps from the place before, else from the nearest of a lattice.

use super::boundary::Ring;
use super::path::{Places, SAME, snapped};
use super::record::Entity;
use super::surface::Cut;
use super::{Read, Reader};
use crate::metric::FirstForm;
use crate::surface::{Side, Surface};
use crate::vector::{Vector, distance, dot, sub};
use std::cell::Cell;

/// Lattice points in each direction.
const LATTICE: u32 = 32;
const STEPS: usize = 30;

struct Feet<'s> {
    surface: &'s Surface,
    /// Which of the four sides are points.
    poles: [bool; 4],
    size: f64,
    before: Cell<[f64; 2]>,
}

impl<'s> Feet<'s> {
    fn new(surface: &'s Surface) -> Self {
        let [[u0, u1], [v0, v1]] = surface.domain();
        let poles = Side::ALL.map(|side| surface.side(side).is_point());
        let size = distance(surface.at(u0, v0), surface.at(0.5 * (u0 + u1), 0.5 * (v0 + v1)));
        Self { surface, poles, size, before: Cell::new([u0, v0]) }
    }

    fn away(&self, at: [f64; 2], p: Vector) -> f64 {
        distance(self.surface.at(at[0], at[1]), p)
    }

    /// The place of a point; its second number is not finite at a pole in the west or east.
    fn place(&self, p: Vector) -> [f64; 2] {
        let [[u0, u1], [v0, v1]] = self.surface.domain();
        for (side, u) in [(Side::West, u0), (Side::East, u1)] {
            if self.poles[side as usize] && self.away([u, v0], p) <= SAME * self.size {
                return [u, f64::NAN];
            }
        }
        let near = self.descend(self.before.get(), p);
        let found = match self.away(near, p) <= SAME * self.size {
            true => near,
            false => {
                let step = |i: u32| f64::from(i) / f64::from(LATTICE);
                let place = |k: u32| {
                    let (i, j) = (k % (LATTICE + 1), k / (LATTICE + 1));
                    [u0 + step(i) * (u1 - u0), v0 + step(j) * (v1 - v0)]
                };
                let all = (0..(LATTICE + 1).pow(2)).map(place);
                let best = all.min_by(|&a, &b| self.away(a, p).total_cmp(&self.away(b, p)));
                let other = self.descend(best.unwrap_or(near), p);
                if self.away(other, p) < self.away(near, p) { other } else { near }
            }
        };
        self.before.set(found);
        found
    }

    fn descend(&self, from: [f64; 2], p: Vector) -> [f64; 2] {
        let [[u0, u1], [v0, v1]] = self.surface.domain();
        let mut at = from;
        for _ in 0..STEPS {
            let tangents = self.surface.tangents(at[0], at[1]);
            let gap = sub(p, tangents.point);
            let FirstForm { e, f, g } = FirstForm::new(&tangents);
            let (du, dv) = (dot(gap, tangents.u), dot(gap, tangents.v));
            let whole = e * g - f * f;
            let step = [(g * du - f * dv) / whole, (e * dv - f * du) / whole];
            let alone = [if e > 0.0 { du / e } else { 0.0 }, if g > 0.0 { dv / g } else { 0.0 }];
            let step = if step.iter().all(|x| x.is_finite()) { step } else { alone };
            let here = distance(p, tangents.point);
            let closer = (0..8).find_map(|halvings| {
                let part = 1.0 / f64::from(1_u32 << halvings);
                let place = [
                    (at[0] + part * step[0]).clamp(u0, u1),
                    (at[1] + part * step[1]).clamp(v0, v1),
                ];
                (self.away(place, p) < here).then_some(place)
            });
            let Some(better) = closer else { break };
            at = better;
        }
        at
    }
}

impl Reader<'_> {
    /// A face of a B-spline surface that comes round, or has a pole.
    pub(super) fn around(
        &self,
        surface: Surface,
        is_closed: [bool; 2],
        (base, face): (&Entity, &Entity),
        loops: &[Ring],
    ) -> Read<Cut> {
        let feet = Feet::new(&surface);
        let domain = surface.domain();
        let length = |i: usize| domain[i][1] - domain[i][0];
        let middle = 0.5 * (domain[0][0] + domain[0][1]);
        // At a pole the second parameter comes back to where it was, by less than all of its range.
        let has_pole = feet.poles[Side::West as usize] || feet.poles[Side::East as usize];
        let round = |i: usize| (is_closed[i] || (i == 1 && has_pole)).then_some(length(i));
        let places = Places {
            of: &|p| feet.place(p),
            periods: [round(0), round(1)],
            is_end: &|u| u > middle,
            is_mirrored: false,
        };
        let edges: usize = loops.iter().map(|ring| ring.edges.len()).sum();
        self.records.spend(edges.saturating_mul(LATTICE as usize), base)?;
        let (mut paths, outer) = self.paths(&places, loops).map_err(|text| face.fail(text))?;
        if outer.is_none() {
            return Err(face.fail("no loop bounds the surface"));
        }
        for path in &mut paths {
            let shift = [0, 1].map(|i| {
                let [low, high] = path.range(i);
                let turns = libm::floor((0.5 * (low + high) - domain[i][0]) / length(i));
                if is_closed[i] { turns * length(i) } else { 0.0 }
            });
            for place in path.edges.iter_mut().flatten() {
                *place = [0, 1].map(|i| {
                    let part = (place[i] - shift[i] - domain[i][0]) / length(i);
                    domain[i][0] + snapped(part, 1.0) * length(i)
                });
            }
        }
        let trim = self.placed(face, (loops, paths, outer))?;
        Ok(Cut { surface: surface.joined(), trim: Some(trim) })
    }
}
