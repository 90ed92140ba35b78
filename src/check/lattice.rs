//! The coordinates of a whole mesh as 64-bit integers, where they fit.
//!
//! Along each axis the coordinates are divided by their smallest common power of two and shifted to
//! the middle of their range. They fit when they then stay below 2^62: differences fit 63 bits and
//! the orientation determinant 127. Most meshes fit; the others are decided triangle by triangle.

use super::exact::{self, P2, Scaled, mantissa_exponent};
use crate::mesh::MeshData;
use rayon::prelude::*;
use std::cmp::Ordering;

/// Widest range of the integers along an axis: differences must fit an i64 with room for its sign.
const RANGE_MAX: i128 = (1 << 63) - 2;

/// Points per piece of parallel work; fixed, so that the result cannot depend on threads.
const CHUNK: usize = 1 << 14;

/// Coordinates along one axis: `integer = x / 2^exponent - middle`.
#[derive(Clone, Copy)]
struct Axis {
    exponent: i32,
    middle: i128,
}

/// What must be known of an axis before it can be scaled.
#[derive(Clone, Copy)]
struct Extent {
    exponent: i32,
    low: f64,
    high: f64,
}

impl Extent {
    const EMPTY: Self = Self { exponent: i32::MAX, low: f64::INFINITY, high: f64::NEG_INFINITY };

    fn with(self, x: f64) -> Self {
        if !x.is_finite() {
            return self;
        }
        Self {
            exponent: self.exponent.min(mantissa_exponent(x).1),
            low: self.low.min(x),
            high: self.high.max(x),
        }
    }

    fn and(self, other: Self) -> Self {
        Self {
            exponent: self.exponent.min(other.exponent),
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    fn axis(self) -> Option<Axis> {
        if self.low > self.high || self.exponent == i32::MAX {
            return Some(Axis { exponent: 0, middle: 0 });
        }
        let (low, high) = (integer(self.low, self.exponent)?, integer(self.high, self.exponent)?);
        (high - low <= RANGE_MAX)
            .then(|| Axis { exponent: self.exponent, middle: low.midpoint(high) })
    }
}

/// `x / 2^exponent` if it has at most 120 bits; `exponent` is not above that of x.
fn integer(x: f64, exponent: i32) -> Option<i128> {
    let (m, e) = mantissa_exponent(x);
    if m == 0 {
        return Some(0);
    }
    let shift = (e - exponent).cast_unsigned();
    (shift <= 66).then(|| i128::from(m) << shift)
}

impl Axis {
    fn scaled(self, x: f64) -> i64 {
        let value = if x.is_finite() { integer(x, self.exponent) } else { None };
        i64::try_from(value.unwrap_or(self.middle) - self.middle).unwrap_or(0)
    }
}

/// Points on an integer lattice, `D` axes.
pub(super) struct Lattice<const D: usize> {
    axes: [Axis; D],
    points: Vec<[i64; D]>,
}

impl<const D: usize> Lattice<D> {
    /// The lattice of the finite points of a mesh; `None` when it needs more than 64 bits. Points
    /// that are not finite stand at the middle: no triangle uses them any more.
    pub(super) fn of(points: &[[f64; 3]]) -> Option<Self> {
        let extents = |chunk: &[[f64; 3]]| {
            let mut extents = [Extent::EMPTY; D];
            for point in chunk {
                for (extent, &x) in extents.iter_mut().zip(point) {
                    *extent = extent.with(x);
                }
            }
            extents
        };
        let join = |a: [Extent; D], b: [Extent; D]| std::array::from_fn(|k| a[k].and(b[k]));
        let extents = points.par_chunks(CHUNK).map(extents).reduce(|| [Extent::EMPTY; D], join);
        let axes = extents.map(Extent::axis);
        if axes.iter().any(Option::is_none) {
            return None;
        }
        let axes = axes.map(|axis| axis.unwrap_or(Axis { exponent: 0, middle: 0 }));
        let place = |point: &[f64; 3]| std::array::from_fn(|k| axes[k].scaled(point[k]));
        Some(Self { axes, points: points.par_iter().with_min_len(CHUNK).map(place).collect() })
    }

    pub(super) fn point(&self, index: u32) -> [i64; D] {
        self.points[index as usize]
    }
}

/// Coordinates of a plane mesh, and the exact predicates on its points by index.
pub(super) struct Plane<'a> {
    pub(super) mesh: &'a MeshData,
    lattice: Option<Lattice<2>>,
}

impl<'a> Plane<'a> {
    pub(super) fn new(mesh: &'a MeshData) -> Self {
        Self { mesh, lattice: Lattice::of(&mesh.points) }
    }

    /// The coordinates of a point.
    pub(super) fn point(&self, index: u32) -> P2 {
        let [x, y, _] = self.mesh.points[index as usize];
        [x, y]
    }

    /// Twice the signed area of a triangle, exactly.
    #[inline]
    pub(super) fn doubled_area(&self, triangle: [u32; 3]) -> Scaled {
        match &self.lattice {
            Some(lattice) => {
                let exponent = lattice.axes[0].exponent + lattice.axes[1].exponent;
                let [a, b, c] = triangle.map(|v| lattice.point(v));
                let value = exact::determinant([a[0], b[0], c[0]], [a[1], b[1], c[1]]);
                Scaled::Narrow(value, exponent)
            }
            None => {
                let [a, b, c] = triangle.map(|v| self.point(v));
                exact::doubled_area(a, b, c)
            }
        }
    }

    /// Whether `d` lies inside (`Greater`), on or outside the circle of the counterclockwise a, b, c.
    pub(super) fn incircle(&self, corners: [u32; 4]) -> Ordering {
        let [a, b, c, d] = corners.map(|v| self.point(v));
        exact::incircle(a, b, c, d)
    }
}
