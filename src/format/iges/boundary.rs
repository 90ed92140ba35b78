//! Boundaries of faces: curves on surfaces (142), boundaries (141), and what they cut out.

use super::super::domain_file::Problem;
use super::surface::Base;
use super::{Affine, Read, Reader};
use crate::curve::Curve;
use crate::model::{Trim, TrimCurve};
use crate::surface::{Side, Surface};
use crate::vector::{Vector, distance};
use std::f64::consts::TAU;

/// A loop: its curves in space, and in (u, v); either list may be empty.
#[derive(Default)]
pub(super) struct Ring {
    pub(super) space: Vec<Curve>,
    pub(super) flat: Vec<Curve>,
    /// Line of the file.
    line: u64,
}

/// Ends of curves of (u, v) that lie farther from their curves in space than this fraction of the
/// loop's size say nothing.
const NEAR: f64 = 1e-2;
/// A curve of (u, v) runs along a side within this fraction of the range.
const ON_SIDE: f64 = 1e-6;

impl Reader<'_> {
    /// The loop that a pointer names.
    pub(super) fn ring(&mut self, pointer: i64, outer: &Affine) -> Read<Ring> {
        let entity = self.entities[self.index(pointer, "a pointer to a boundary")?];
        match entity.kind {
            141 => self.boundary(pointer, outer),
            142 => self.curve_on_surface(pointer, outer),
            // The boundary of a bounded plane is a curve.
            _ => {
                let space = self.curves(pointer, outer)?.into_iter().map(|piece| piece.curve);
                Ok(Ring { space: space.collect(), flat: Vec::new(), line: entity.line })
            }
        }
    }

    fn curve_on_surface(&mut self, pointer: i64, outer: &Affine) -> Read<Ring> {
        let what = "a curve on a surface";
        let ([flat, space], line, map) = self.enter(pointer, what, outer, |_, fields, map| {
            fields.int("how the curve was made")?;
            fields.int("a pointer to the surface")?;
            let pointers =
                [fields.int("a pointer to a curve")?, fields.int("a pointer to a curve")?];
            if pointers == [0, 0] {
                let text = "a curve on a surface has neither a curve of (u, v) nor one in space";
                return Err(fields.fail(Problem::Entity(text.to_owned())));
            }
            Ok((pointers, fields.line(), *map))
        })?;
        self.within(pointer, |reader| {
            let mut of = |pointer: i64, map: &Affine| -> Read<Vec<Curve>> {
                if pointer == 0 {
                    return Ok(Vec::new());
                }
                Ok(reader.curves(pointer, map)?.into_iter().map(|piece| piece.curve).collect())
            };
            Ok(Ring { flat: of(flat, &Affine::IDENTITY)?, space: of(space, &map)?, line })
        })
    }

    fn boundary(&mut self, pointer: i64, outer: &Affine) -> Read<Ring> {
        let (list, line, map) = self.enter(pointer, "a boundary", outer, |_, fields, map| {
            fields.int("the type of the boundary")?;
            fields.int("the preferred curves")?;
            fields.int("a pointer to the surface")?;
            let count = fields.count("the number of curves", 1, 3)?;
            let mut list = Vec::new();
            for _ in 0..count {
                let (curve, sense) = (fields.int("a pointer to a curve")?, fields.int("a sense")?);
                let flats = fields.count("the number of curves of (u, v)", 0, 1)?;
                let flats: Read<Vec<i64>> = (0..flats).map(|_| fields.int("a pointer")).collect();
                list.push((curve, sense == 2, flats?));
            }
            Ok((list, fields.line(), *map))
        })?;
        self.within(pointer, |reader| {
            let mut ring = Ring { line, ..Ring::default() };
            for (curve, is_reversed, flats) in list {
                let mut curves = reader.curves(curve, &map)?;
                if is_reversed {
                    curves.reverse();
                    curves.iter_mut().for_each(|piece| piece.curve = piece.curve.reversed());
                }
                ring.space.extend(curves.into_iter().map(|piece| piece.curve));
                for flat in flats {
                    let curves = reader.curves(flat, &Affine::IDENTITY)?;
                    ring.flat.extend(curves.into_iter().map(|piece| piece.curve));
                }
            }
            Ok(ring)
        })
    }
}

impl Ring {
    /// Whether each curve in space has its curve of (u, v).
    fn is_paired(&self) -> bool {
        !self.flat.is_empty() && self.flat.len() == self.space.len()
    }

    /// Diagonal of the box around the control points in space.
    pub(super) fn size(&self) -> f64 {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in self.space.iter().flat_map(Curve::points) {
            for i in 0..3 {
                (low[i], high[i]) = (low[i].min(p[i]), high[i].max(p[i]));
            }
        }
        let size = distance(low, high);
        if size.is_finite() { size } else { 0.0 }
    }
}

/// How a curve of (u, v) of the file is one of the surface's parameters.
#[derive(Clone, Copy)]
struct Reading {
    is_swapped: bool,
    turn: f64,
}

impl Reading {
    fn apply(self, base: &Base, curve: &Curve) -> Curve {
        let domain = base.surface.domain();
        curve.mapped(|[a, b, _]| {
            let [u, v] = if self.is_swapped { [b, a] } else { [a, b] };
            let place = [u + self.turn, v];
            let [u, v] = [0, 1].map(|i| {
                let ([from, to], [low, high]) = (base.ranges[i], domain[i]);
                low + (place[i] - from) / (to - from) * (high - low)
            });
            [u, v, 0.0]
        })
    }
}

/// What the loops leave of a surface, the first taking the place of the sides if `has_outline`:
/// `None` for all of it.
pub(super) fn cut(base: &mut Base, mut rings: Vec<Ring>, has_outline: bool) -> Read<Option<Trim>> {
    let reading = best_reading(base, &rings);
    for ring in &mut rings {
        if ring.space.is_empty() {
            let line = ring.line;
            // Curves of (u, v) alone are taken at their word.
            let plain = Reading { is_swapped: false, turn: 0.0 };
            let is_exact = !base.u_turns || base.ranges == base.surface.domain();
            if !is_exact {
                let text =
                    "a boundary of a surface of revolution of an arc needs its curves in space";
                let place = crate::domain::Place::Line(line);
                return Err(Problem::Entity(text.to_owned()).at(place));
            }
            ring.flat.iter_mut().for_each(|curve| *curve = plain.apply(base, curve));
        } else if let (Some(reading), true) = (reading, ring.is_paired()) {
            for (flat, curve) in ring.flat.iter_mut().zip(&ring.space) {
                *flat = reading.apply(base, flat);
                if gap(&base.surface, &flat.reversed(), curve) < gap(&base.surface, flat, curve) {
                    *flat = flat.reversed();
                }
            }
        } else {
            ring.flat.clear();
        }
    }
    let is_whole =
        has_outline && rings.first().is_some_and(|ring| goes_around(&base.surface, &ring.flat));
    let mut loops = rings.into_iter().map(curves);
    let outline = if has_outline { loops.next().filter(|_| !is_whole) } else { None };
    let trim = Trim { outline, holes: loops.collect() };
    if trim == Trim::default() {
        return Ok(None);
    }
    base.surface = base.surface.clone().joined();
    Ok(Some(trim))
}

/// The reading of the curves of (u, v) that brings them nearest to their curves in space.
fn best_reading(base: &Base, rings: &[Ring]) -> Option<Reading> {
    let pairs =
        || rings.iter().filter(|ring| ring.is_paired()).flat_map(|r| r.flat.iter().zip(&r.space));
    let turns: &[f64] = if base.u_turns { &[0.0, -TAU, TAU] } else { &[0.0] };
    let all =
        turns.iter().flat_map(|&turn| [false, true].map(|is_swapped| Reading { is_swapped, turn }));
    let off = |reading: Reading| -> f64 {
        let of = |(flat, space): (&Curve, &Curve)| {
            let flat = reading.apply(base, flat);
            if !is_inside(&base.surface, &flat) {
                return f64::INFINITY;
            }
            gap(&base.surface, &flat, space).min(gap(&base.surface, &flat.reversed(), space))
        };
        pairs().map(of).fold(0.0, f64::max)
    };
    let size = rings.iter().map(Ring::size).fold(0.0, f64::max);
    pairs().next()?;
    let judged = all.map(|reading| (off(reading), reading));
    let best = judged.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (best.0 <= NEAR * size).then_some(best.1)
}

/// Whether all control points lie in the rectangle of parameters, up to the digits of a file.
fn is_inside(surface: &Surface, flat: &Curve) -> bool {
    let domain = surface.domain();
    let slack = |i: usize| ON_SIDE * (domain[i][1] - domain[i][0]);
    let holds =
        |p: &Vector, i: usize| p[i] >= domain[i][0] - slack(i) && p[i] <= domain[i][1] + slack(i);
    flat.points().iter().all(|p| holds(p, 0) && holds(p, 1))
}

/// The larger distance of the two ends of a curve of (u, v) from those of its curve in space.
fn gap(surface: &Surface, flat: &Curve, space: &Curve) -> f64 {
    let at = |[u, v, _]: Vector| surface.at(u, v);
    let (a, b) = (flat.ends(), space.ends());
    distance(at(a[0]), b[0]).max(distance(at(a[1]), b[1]))
}

fn curves(ring: Ring) -> Vec<TrimCurve> {
    let Ring { space, flat, .. } = ring;
    if space.is_empty() {
        let alone = |curve| TrimCurve::Parameters { curve, rule: None, marker: None };
        return flat.into_iter().map(alone).collect();
    }
    let mut flat = flat.into_iter();
    let both = |curve| TrimCurve::Space { curve, parameters: flat.next() };
    space.into_iter().map(both).collect()
}

/// Whether curves of (u, v) run once along all sides but poles, of a surface with a pole or a seam:
/// such a surface is whole, and needs no loop.
fn goes_around(surface: &Surface, flat: &[Curve]) -> bool {
    let domain = surface.domain();
    let sides = Side::ALL.map(|side| surface.side(side));
    let [south, east, north, west] = &sides;
    let has_pole = sides.iter().any(Curve::is_point);
    if !has_pole && south.same_as(north).is_none() && east.same_as(west).is_none() {
        return false;
    }
    let length = |i: usize| domain[i][1] - domain[i][0];
    let mut covered = [0.0; 4];
    for curve in flat {
        // South and north have v constant, east and west u.
        let along = |k: usize| {
            let i = 1 - k % 2;
            let level = if k == 1 || k == 2 { domain[i][1] } else { domain[i][0] };
            curve.points().iter().all(|p| (p[i] - level).abs() <= ON_SIDE * length(i))
        };
        let Some(k) = (0..4).find(|&k| along(k)) else { return false };
        let i = k % 2;
        let [from, to] = curve.ends();
        covered[k] += (to[i] - from[i]).abs() / length(i);
    }
    (0..4).all(|k| {
        let is_full = (covered[k] - 1.0).abs() <= 4.0 * ON_SIDE;
        is_full || (sides[k].is_point() && covered[k] <= 1.0 + 4.0 * ON_SIDE)
    })
}
