//! The chart of a patch: how the front measures on a surface while it runs in (u, v).
//!
//! Parameters are scaled by a power of two in each direction, so that a unit of either is about a
//! unit of length: an exact change of coordinates, so what is valid in one is valid in the other.

use super::distances::Distances;
use super::growth::SpaceField;
use super::sizing::Curvature;
use crate::front::chart::{Chart, Site};
use crate::metric::FirstForm;
use crate::point::Point2;
use crate::size::{Base, Hint};
use crate::surface::{Surface, Tangents};
use crate::vector::{self, Vector, along, cross, dot, norm_sq, scale, sub};

/// What lies above a point of the parameter plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lift {
    pub(super) point: Vector,
    /// Derivatives by the scaled parameters.
    pub(super) u: Vector,
    pub(super) v: Vector,
    /// The unit normal; 0 where there is none.
    pub(super) normal: Vector,
}

impl Lift {
    /// First fundamental form in scaled parameters.
    pub(super) fn form(&self) -> FirstForm {
        let Self { point, u, v, .. } = *self;
        FirstForm::new(&Tangents { point, u, v })
    }

    /// Whether the map is singular there.
    pub(super) fn is_pole(&self) -> bool {
        self.normal == [0.0; 3]
    }
}

/// A patch with its scaled parameters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sheet<'a> {
    pub(super) surface: &'a Surface,
    scale: [f64; 2],
    low: Point2,
    high: Point2,
}

/// Samples in each direction for the mean lengths of the tangents.
const SAMPLES: u32 = 8;

impl<'a> Sheet<'a> {
    pub(super) fn new(surface: &'a Surface) -> Self {
        let [[u0, u1], [v0, v1]] = surface.domain();
        let mut sums = [0.0; 2];
        for k in 0..SAMPLES * SAMPLES {
            let step = |i: u32| (f64::from(i) + 0.5) / f64::from(SAMPLES);
            let (u, v) = (step(k % SAMPLES), step(k / SAMPLES));
            let tangents = surface.tangents(u0 + u * (u1 - u0), v0 + v * (v1 - v0));
            sums[0] += vector::norm(tangents.u);
            sums[1] += vector::norm(tangents.v);
        }
        let scale = sums.map(|sum| power_of_two(sum / f64::from(SAMPLES * SAMPLES)));
        let low = Point2::new(u0 * scale[0], v0 * scale[1]);
        let high = Point2::new(u1 * scale[0], v1 * scale[1]);
        Self { surface, scale, low, high }
    }

    /// Scaled parameters.
    pub(super) fn scaled(&self, u: f64, v: f64) -> Point2 {
        Point2::new(u * self.scale[0], v * self.scale[1])
    }

    /// The parameters that the surface knows.
    pub(super) fn parameters(&self, p: Point2) -> [f64; 2] {
        [p.x / self.scale[0], p.y / self.scale[1]]
    }

    /// Point and tangents, by scaled parameters.
    pub(super) fn tangents(&self, p: Point2) -> Tangents {
        let [u, v] = self.parameters(p);
        let Tangents { point, u, v } = self.surface.tangents(u, v);
        Tangents { point, u: scale(1.0 / self.scale[0], u), v: scale(1.0 / self.scale[1], v) }
    }

    pub(super) fn lift(&self, p: Point2) -> Lift {
        lift(&self.tangents(p))
    }

    pub(super) fn clamped(&self, p: Point2) -> Point2 {
        Point2::new(p.x.clamp(self.low.x, self.high.x), p.y.clamp(self.low.y, self.high.y))
    }
}

pub(super) fn lift(tangents: &Tangents) -> Lift {
    let normal = vector::unit(cross(tangents.u, tangents.v)).unwrap_or_default();
    let Tangents { point, u, v } = *tangents;
    Lift { point, u, v, normal }
}

/// The power of two nearest to `x`; 1 when `x` is no length.
fn power_of_two(x: f64) -> f64 {
    if x > 0.0 && x.is_finite() { libm::exp2(libm::rint(libm::log2(x))) } else { 1.0 }
}

/// A sheet with the spacings wanted on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurfaceChart<'a> {
    pub(super) sheet: Sheet<'a>,
    pub(super) field: &'a SpaceField,
    pub(super) curvature: &'a Curvature,
}

impl SurfaceChart<'_> {
    /// The spacing at a place on the surface.
    pub(super) fn spacing_at(&self, p: Point2, point: Vector) -> f64 {
        let h = self.field.at(point);
        if self.curvature.is_on() {
            let [u, v] = self.sheet.parameters(self.sheet.clamped(p));
            return h.min(self.curvature.spacing(&self.sheet.surface.jet(u, v)));
        }
        h
    }

    /// The plane that touches the surface at a point, with coordinates from there; `length` is that of
    /// an edge near by. `None` where the map is singular.
    pub(super) fn frame_at(&self, at: Point2, length: f64) -> Option<Frame> {
        let tangents = self.sheet.tangents(at);
        let x = vector::unit(tangents.u)?;
        let y = vector::unit(cross(cross(tangents.u, tangents.v), x))?;
        let mut frame = Frame {
            origin: tangents.point,
            x,
            y,
            length_sq: length * length,
            middle: at,
            middle_local: Point2::new(0.0, 0.0),
            inverse: Matrix([0.0; 4]),
            form: FirstForm::new(&tangents),
        };
        frame.inverse = frame.jacobian(&tangents).inverse()?;
        Some(frame)
    }

    /// The place with these coordinates in a frame, by Newton's method from scaled parameters near it.
    pub(super) fn place_from(
        &self,
        frame: &Frame,
        local: Point2,
        start: Point2,
    ) -> Option<Site<Lift>> {
        let mut at = self.sheet.clamped(start);
        for _ in 0..NEWTON_STEPS {
            let tangents = self.sheet.tangents(at);
            let there = frame.local_of(tangents.point);
            if there.distance_sq(local) <= NEWTON_ENOUGH_SQ * frame.length_sq {
                return Some(Site { at, lift: lift(&tangents) });
            }
            let inverse = frame.jacobian(&tangents).inverse()?;
            let [du, dv] = inverse.times(local.x - there.x, local.y - there.y);
            at = self.sheet.clamped(Point2::new(at.x + du, at.y + dv));
        }
        let tangents = self.sheet.tangents(at);
        let missed_sq = frame.local_of(tangents.point).distance_sq(local);
        (missed_sq <= NEWTON_FAILED_SQ * frame.length_sq)
            .then(|| Site { at, lift: lift(&tangents) })
    }

    /// The place as far from the ends of the base edge as the one with these coordinates.
    fn place_by_distances(&self, frame: &Frame, local: Point2) -> Option<Site<Lift>> {
        let length = frame.length_sq.sqrt();
        let ends = [frame.origin, along(frame.origin, length, frame.x)];
        let wanted =
            [local.distance(Point2::new(0.0, 0.0)), local.distance(Point2::new(length, 0.0))];
        let Sheet { low, high, .. } = self.sheet;
        let turn = Point2::new(TURN * (high.x - low.x), TURN * (high.y - low.y));
        let window = [
            Point2::new(low.x.max(frame.middle.x - turn.x), low.y.max(frame.middle.y - turn.y)),
            Point2::new(high.x.min(frame.middle.x + turn.x), high.y.min(frame.middle.y + turn.y)),
        ];
        let start = frame.guess(Point2::new(local.x, START * local.y));
        let at = Distances { ends, wanted, window }.place(&self.sheet, start);
        let site = Site { at, lift: self.sheet.lift(at) };
        (!site.lift.is_pole()).then_some(site)
    }
}

/// A place by distances is at most this part of the parameters away from the middle of the edge: around
/// a tip there are at least three.
const TURN: f64 = 1.0 / 3.0;
/// The search for it starts at this part of its height.
const START: f64 = 0.25;

/// Flat coordinates near a base edge: its origin is 0, the edge runs along x, and the plane is
/// tangent to the surface near the middle of the edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    origin: Vector,
    x: Vector,
    y: Vector,
    length_sq: f64,
    /// Scaled parameters of the middle, and what it looks like in the frame.
    middle: Point2,
    middle_local: Point2,
    inverse: Matrix,
    form: FirstForm,
}

/// A 2 x 2 matrix by rows.
#[derive(Clone, Copy, Debug)]
struct Matrix([f64; 4]);

impl Matrix {
    fn inverse(self) -> Option<Self> {
        let [a, b, c, d] = self.0;
        let determinant = a * d - b * c;
        let inverse = [d, -b, -c, a].map(|x| x / determinant);
        inverse.iter().all(|x| x.is_finite()).then_some(Self(inverse))
    }

    fn times(self, x: f64, y: f64) -> [f64; 2] {
        let [a, b, c, d] = self.0;
        [a * x + b * y, c * x + d * y]
    }
}

impl Frame {
    pub(super) fn local_of(&self, point: Vector) -> Point2 {
        let arm = sub(point, self.origin);
        Point2::new(dot(self.x, arm), dot(self.y, arm))
    }

    fn jacobian(&self, tangents: &Tangents) -> Matrix {
        let Tangents { u, v, .. } = *tangents;
        Matrix([dot(self.x, u), dot(self.x, v), dot(self.y, u), dot(self.y, v)])
    }

    /// Parameters by the linear map at the middle.
    pub(super) fn guess(&self, local: Point2) -> Point2 {
        let d = [local.x - self.middle_local.x, local.y - self.middle_local.y];
        let [du, dv] = self.inverse.times(d[0], d[1]);
        Point2::new(self.middle.x + du, self.middle.y + dv)
    }
}

/// Newton's steps from frame coordinates to parameters; each squares the error.
const NEWTON_STEPS: usize = 6;
/// Good enough: this fraction of the base edge, squared.
const NEWTON_ENOUGH_SQ: f64 = 1e-6;
/// No good: this fraction of the base edge, squared.
const NEWTON_FAILED_SQ: f64 = 1e-2;

impl Chart for SurfaceChart<'_> {
    type Lift = Lift;
    type Frame = Frame;
    type Circle = Matrix2;
    const CURVED: bool = true;

    fn frame(&self, [a, b]: [Site<Lift>; 2]) -> Option<Frame> {
        let edge = sub(b.lift.point, a.lift.point);
        let x = vector::unit(edge)?;
        let middle = Point2::new(0.5 * (a.at.x + b.at.x), 0.5 * (a.at.y + b.at.y));
        let tangents = self.sheet.tangents(middle);
        let normal = cross(tangents.u, tangents.v);
        let normal = along(normal, -dot(normal, x), x);
        let y = vector::unit(cross(normal, x))?;
        let mut frame = Frame {
            origin: a.lift.point,
            x,
            y,
            length_sq: norm_sq(edge),
            middle,
            middle_local: Point2::new(0.0, 0.0),
            inverse: Matrix([0.0; 4]),
            form: FirstForm::new(&tangents),
        };
        frame.middle_local = frame.local_of(tangents.point);
        frame.inverse = frame.jacobian(&tangents).inverse()?;
        Some(frame)
    }

    fn local(&self, frame: &Frame, site: Site<Lift>) -> Point2 {
        frame.local_of(site.lift.point)
    }

    fn place(&self, frame: &Frame, local: Point2) -> Option<Site<Lift>> {
        let found = self.place_from(frame, local, frame.guess(local));
        found.or_else(|| self.place_by_distances(frame, local))
    }

    fn spacing(&self, frame: &Frame, local: Point2, _: Base, _: &mut Hint) -> f64 {
        let point = along(along(frame.origin, local.x, frame.x), local.y, frame.y);
        self.spacing_at(frame.guess(local), point)
    }

    fn distance_sq(&self, a: Site<Lift>, b: Site<Lift>) -> f64 {
        norm_sq(sub(b.lift.point, a.lift.point))
    }

    fn segment_distance_sq(&self, [a, b]: [Site<Lift>; 2], p: Site<Lift>) -> f64 {
        vector::segment_distance_sq(a.lift.point, b.lift.point, p.lift.point)
    }

    fn circle(&self, p: Site<Lift>) -> Matrix2 {
        Matrix2::root(&p.lift.form())
    }

    fn circle_at(&self, frame: &Frame) -> Matrix2 {
        Matrix2::root(&frame.form)
    }

    fn in_circle(&self, circle: &Matrix2, corners: [Point2; 3], p: Point2) -> bool {
        circle.in_circle(corners, p)
    }
}

/// A linear map of parameters under which lengths near a point become those on the surface: the
/// Cholesky factor of the first fundamental form, [a b; 0 c].
#[derive(Clone, Copy, Debug)]
pub(super) struct Matrix2 {
    a: f64,
    b: f64,
    c: f64,
}

impl Matrix2 {
    pub(super) fn root(form: &FirstForm) -> Self {
        let a = form.e.sqrt();
        let b = form.f / a;
        let c = (form.g - b * b).sqrt();
        if a > 0.0 && c > 0.0 { Self { a, b, c } } else { Self { a: 1.0, b: 0.0, c: 1.0 } }
    }

    /// Whether `p` lies inside the circle through the counterclockwise corners, as seen here.
    pub(super) fn in_circle(&self, corners: [Point2; 3], p: Point2) -> bool {
        let [d, e, f] = corners.map(|q| {
            let (u, v) = (q.x - p.x, q.y - p.y);
            let (x, y) = (self.a * u + self.b * v, self.c * v);
            (x, y, x * x + y * y)
        });
        let minor = |q: (f64, f64, f64), r: (f64, f64, f64)| q.0 * r.1 - r.0 * q.1;
        d.2 * minor(e, f) + e.2 * minor(f, d) + f.2 * minor(d, e) > 0.0
    }
}
