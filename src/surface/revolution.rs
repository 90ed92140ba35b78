//! Surfaces of revolution: a profile, any curve of space, turns about an axis. u is the profile's
//! parameter, v the angle in radians.

use super::{Side, SurfaceError, SurfaceJet, Tangents};
use crate::curve::Curve;
use crate::vector::{Vector, add, cross, dot, norm, scale, sub, unit};
use std::f64::consts::TAU;

/// A surface of revolution.
#[derive(Clone, Debug, PartialEq)]
pub struct Revolution {
    profile: Curve,
    origin: Vector,
    axis: Vector,
    angles_deg: [f64; 2],
    /// Whether corners of the profile are none: the surface is one piece.
    is_joined: bool,
    /// Whether points count as on the axis that rounding alone keeps from it.
    is_computed: bool,
}

/// Tangents of a profile that differ by less than this (radians) are those of a smooth curve.
const SMOOTH: f64 = 1e-6;

impl Revolution {
    /// The surface that `profile` sweeps as it turns about the axis through `origin` from the first
    /// to the second angle (degrees, by the right hand).
    ///
    /// # Errors
    /// An axis without direction, an angle that is not above 0 and at most 360 degrees.
    pub fn new(
        profile: Curve,
        origin: Vector,
        axis: Vector,
        angles_deg: [f64; 2],
    ) -> Result<Self, SurfaceError> {
        let axis = unit(axis).ok_or(SurfaceError::NoAxis)?;
        let turn = angles_deg[1] - angles_deg[0];
        if !(turn > 0.0 && turn <= 360.0) {
            return Err(SurfaceError::Angle(turn));
        }
        Ok(Self { profile, origin, axis, angles_deg, is_joined: false, is_computed: false })
    }

    /// The same surface, its profile and axis being computed from a file's rather than given: what
    /// rounding alone keeps from the axis is on it. A surface that is given is taken at its word: there
    /// a point is on the axis exactly, or off it.
    #[must_use]
    pub(crate) fn computed(self) -> Self {
        Self { is_computed: true, ..self }
    }

    pub(super) fn domain(&self) -> [[f64; 2]; 2] {
        [self.profile.domain(), self.angles_deg.map(f64::to_radians)]
    }

    /// Whether it comes round to where it began.
    fn is_full(&self) -> bool {
        self.angles_deg[1] - self.angles_deg[0] == 360.0
    }

    /// The part of `arm` along the axis, the part across it, and that part a quarter turn on.
    fn split(&self, arm: Vector) -> [Vector; 3] {
        let along = scale(dot(arm, self.axis), self.axis);
        [along, sub(arm, along), cross(self.axis, arm)]
    }

    /// As [`jet`](Self::jet), without the second derivatives.
    pub(super) fn tangents(&self, u: f64, v: f64) -> Tangents {
        let [point, first] = self.profile.tangent(u);
        let (sine, cosine) = libm::sincos(v);
        let turn = |[along, across, ahead]: [Vector; 3]| {
            add(along, add(scale(cosine, across), scale(sine, ahead)))
        };
        let arm = self.split(sub(point, self.origin));
        let [_, across, ahead] = arm;
        Tangents {
            point: add(self.origin, turn(arm)),
            u: turn(self.split(first)),
            v: add(scale(-sine, across), scale(cosine, ahead)),
        }
    }

    pub(super) fn jet(&self, u: f64, v: f64) -> SurfaceJet {
        let jet = self.profile.jet(u);
        let (sine, cosine) = libm::sincos(v);
        let turn = |[along, across, ahead]: [Vector; 3]| {
            add(along, add(scale(cosine, across), scale(sine, ahead)))
        };
        let slide =
            |[_, across, ahead]: [Vector; 3]| add(scale(-sine, across), scale(cosine, ahead));
        let arm = self.split(sub(jet.point, self.origin));
        let (first, second) = (self.split(jet.first), self.split(jet.second));
        let [_, across, ahead] = arm;
        SurfaceJet {
            tangents: Tangents {
                point: add(self.origin, turn(arm)),
                u: turn(first),
                v: slide(arm),
            },
            uu: turn(second),
            uv: slide(first),
            vv: add(scale(-cosine, across), scale(-sine, ahead)),
        }
    }

    /// Whether a point, whose arm turned by a quarter is `ahead`, lies on the axis.
    fn is_on_axis(&self, p: Vector, ahead: Vector) -> bool {
        let rounding = 4.0 * f64::EPSILON * (norm(p) + norm(self.origin));
        ahead == [0.0; 3] || (self.is_computed && norm(ahead) <= rounding)
    }

    /// The profile turned by an angle in degrees; points on the axis stay where they are.
    fn turned(&self, angle_deg: f64) -> Curve {
        if angle_deg == 0.0 || angle_deg == 360.0 {
            return self.profile.clone();
        }
        let (sine, cosine) = quadrant(angle_deg);
        self.profile.mapped(|p| {
            let [along, across, ahead] = self.split(sub(p, self.origin));
            match self.is_on_axis(p, ahead) {
                true => p,
                false => {
                    let arm = add(along, add(scale(cosine, across), scale(sine, ahead)));
                    add(self.origin, arm)
                }
            }
        })
    }

    /// The circle or arc that an end of the profile describes; a point when it lies on the axis.
    fn parallel(&self, end: usize) -> Curve {
        let p = self.profile.ends()[end];
        let [along, across, ahead] = self.split(sub(p, self.origin));
        if self.is_on_axis(p, ahead) {
            return Curve::clamped(1, vec![p, p]).expect("two points");
        }
        let turned = |angle: f64| self.turned(angle).ends()[end];
        let [from, to] = self.angles_deg;
        let start = turned(from);
        let arc = match self.is_full() {
            true => Curve::circle(add(self.origin, along), self.axis, start),
            false => {
                let (sine, cosine) = quadrant(0.5 * (from + to));
                let arm = add(along, add(scale(cosine, across), scale(sine, ahead)));
                Curve::arc(start, add(self.origin, arm), turned(to))
            }
        };
        arc.expect("a point off the axis describes an arc")
    }

    /// West and east are the circles of the profile's ends, south and north the profile itself.
    pub(super) fn side(&self, side: Side) -> Curve {
        match side {
            Side::South => self.turned(self.angles_deg[0]),
            Side::North if self.is_full() => self.turned(self.angles_deg[0]),
            Side::North => self.turned(self.angles_deg[1]),
            Side::West => self.parallel(0),
            Side::East => self.parallel(1),
        }
    }

    /// One piece for each piece of the profile.
    pub(super) fn pieces(&self) -> Vec<Self> {
        if self.is_joined {
            return vec![self.clone()];
        }
        let profiles = self.profile.pieces();
        profiles.into_iter().map(|profile| Self { profile, ..self.clone() }).collect()
    }

    /// The same surface as one piece if the tangent of its profile turns nowhere at once.
    pub(super) fn joined(self) -> Self {
        let pieces = self.profile.pieces();
        let way = |piece: &Curve, end: usize| unit(piece.jet(piece.domain()[end]).first);
        let is_joined = pieces.windows(2).all(|pair| {
            let both = way(&pair[0], 1).zip(way(&pair[1], 0));
            both.is_some_and(|(before, after)| norm(sub(before, after)) <= SMOOTH)
        });
        Self { is_joined, ..self }
    }

    /// The parameter of the arc at the west or east that belongs to the angle at a fraction of the
    /// turn, and back: a rational arc does not run at constant speed.
    #[must_use]
    pub fn angle_of(&self, point: Vector) -> f64 {
        let start = self.side(Side::South).ends();
        let reference = start.map(|p| self.split(sub(p, self.origin)));
        let [_, across, ahead] =
            if self.is_on_axis(start[0], reference[0][2]) { reference[1] } else { reference[0] };
        let [_, arm, _] = self.split(sub(point, self.origin));
        let turn = libm::atan2(dot(arm, ahead), dot(arm, across));
        let turn = if turn < 0.0 { turn + TAU } else { turn };
        self.angles_deg[0].to_radians() + turn
    }
}

/// Sine and cosine of an angle in degrees, exact at quarter turns.
fn quadrant(angle_deg: f64) -> (f64, f64) {
    let quarter = angle_deg / 90.0;
    if quarter == libm::rint(quarter) {
        return match (quarter as i64).rem_euclid(4) {
            0 => (0.0, 1.0),
            1 => (1.0, 0.0),
            2 => (0.0, -1.0),
            _ => (-1.0, 0.0),
        };
    }
    let angle = angle_deg.to_radians();
    (libm::sin(angle), libm::cos(angle))
}
