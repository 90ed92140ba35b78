//! How the front measures. In the plane lengths and angles are those of the coordinates; on a
//! surface they are those of space, while validity is decided in the plane of (u, v) all the same.
//!
//! A step works in a *frame*: coordinates near the base edge in which the surface looks flat, so
//! that trial points and scores are the same code for both.

use crate::point::Point2;
use crate::predicates::{Sign, incircle_perturbed};
use crate::size::{Base, Hint, SizeField};

/// A vertex as the front sees it: its coordinates, and what the chart needs to know of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site<L> {
    /// Where it is in the plane in which the front runs.
    pub at: Point2,
    /// What lies above it.
    pub lift: L,
}

/// The geometry that a front advances in. All answers rank or place; none decides validity.
pub trait Chart {
    /// What a vertex carries beside its coordinates.
    type Lift: Copy;
    /// Flat coordinates near a base edge.
    type Frame: Copy;
    /// How circles look near a point.
    type Circle: Copy;
    /// Whether lengths differ from those of the coordinates.
    const CURVED: bool;

    /// The frame of a base edge; `None` where there is none: then no point is tried on it.
    fn frame(&self, base: [Site<Self::Lift>; 2]) -> Option<Self::Frame>;
    /// Coordinates of a vertex in the frame.
    fn local(&self, frame: &Self::Frame, site: Site<Self::Lift>) -> Point2;
    /// The place with these coordinates in the frame, if it can be found.
    fn place(&self, frame: &Self::Frame, local: Point2) -> Option<Site<Self::Lift>>;
    /// The spacing wanted there.
    fn spacing(&self, frame: &Self::Frame, local: Point2, base: Base, hint: &mut Hint) -> f64;
    /// Squared distance.
    fn distance_sq(&self, a: Site<Self::Lift>, b: Site<Self::Lift>) -> f64;
    /// Squared distance of `p` from the segment from `a` to `b`.
    fn segment_distance_sq(&self, ends: [Site<Self::Lift>; 2], p: Site<Self::Lift>) -> f64;
    /// How circles look near `p`.
    fn circle(&self, p: Site<Self::Lift>) -> Self::Circle;
    /// How circles look near the base edge of a frame.
    fn circle_at(&self, frame: &Self::Frame) -> Self::Circle;
    /// Whether `p` lies inside the circle through the corners of a counterclockwise triangle.
    fn in_circle(&self, circle: &Self::Circle, corners: [Point2; 3], p: Point2) -> bool;
}

/// The plane: everything is what it seems, and circles are exact.
#[derive(Clone, Copy, Debug)]
pub struct Plane<'a> {
    /// The size field.
    pub field: &'a SizeField,
}

impl Chart for Plane<'_> {
    type Lift = ();
    type Frame = ();
    type Circle = ();
    const CURVED: bool = false;

    #[inline]
    fn frame(&self, _: [Site<()>; 2]) -> Option<()> {
        Some(())
    }

    #[inline]
    fn local(&self, (): &(), site: Site<()>) -> Point2 {
        site.at
    }

    #[inline]
    fn place(&self, (): &(), local: Point2) -> Option<Site<()>> {
        Some(Site { at: local, lift: () })
    }

    #[inline]
    fn spacing(&self, (): &(), local: Point2, base: Base, hint: &mut Hint) -> f64 {
        self.field.at(local, base, hint)
    }

    #[inline]
    fn distance_sq(&self, a: Site<()>, b: Site<()>) -> f64 {
        a.at.distance_sq(b.at)
    }

    #[inline]
    fn segment_distance_sq(&self, [a, b]: [Site<()>; 2], p: Site<()>) -> f64 {
        let (a, b, p) = (a.at, b.at, p.at);
        let (ux, uy) = (b.x - a.x, b.y - a.y);
        let (wx, wy) = (p.x - a.x, p.y - a.y);
        let along = ((wx * ux + wy * uy) / (ux * ux + uy * uy)).clamp(0.0, 1.0);
        Point2::new(a.x + along * ux, a.y + along * uy).distance_sq(p)
    }

    #[inline]
    fn circle(&self, _: Site<()>) {}

    #[inline]
    fn circle_at(&self, (): &()) {}

    #[inline]
    fn in_circle(&self, (): &(), [a, b, c]: [Point2; 3], p: Point2) -> bool {
        incircle_perturbed(a, b, c, p) == Sign::Positive
    }
}
