//! The coordinates of a whole mesh as 64-bit integers, where they fit.
//!
//! Along each axis the coordinates are divided by their smallest common power of two and shifted to
//! the middle of their range. They fit when they then stay below 2^62: differences fit 63 bits and
//! the orientation determinant 127. Most meshes fit; the others are decided triangle by triangle.

use super::exact::{self, P2, Scaled, mantissa_exponent};
use super::wide::Int256;
use crate::mesh::MeshData;
use rayon::prelude::*;
use std::cmp::Ordering;

/// Widest range of 64-bit integers along an axis: differences must fit an i64 with room for its sign.
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

    /// The axis, if its integers have at most 120 bits; and their range.
    fn axis(self) -> Option<(Axis, i128)> {
        if self.low > self.high || self.exponent == i32::MAX {
            return Some((Axis { exponent: 0, middle: 0 }, 0));
        }
        let (low, high) = (integer(self.low, self.exponent)?, integer(self.high, self.exponent)?);
        Some((Axis { exponent: self.exponent, middle: low.midpoint(high) }, high - low))
    }
}

/// `x / 2^exponent` if it has at most 120 bits; `exponent` is not above that of x.
fn integer(x: f64, exponent: i32) -> Option<i128> {
    let (m, e) = mantissa_exponent(x);
    if m == 0 {
        return Some(0);
    }
    let shift = (e - exponent).cast_unsigned();
    let bits = 64 - m.unsigned_abs().leading_zeros();
    (bits.saturating_add(shift) <= 120).then(|| i128::from(m) << shift)
}

impl Axis {
    fn scaled(self, x: f64) -> i128 {
        let value = if x.is_finite() { integer(x, self.exponent) } else { None };
        value.unwrap_or(self.middle) - self.middle
    }
}

/// The axes on which all finite coordinates are integers of at most 120 bits, and the largest range.
fn axes<const D: usize>(points: &[[f64; 3]]) -> Option<([Axis; D], i128)> {
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
    let mut axes = [Axis { exponent: 0, middle: 0 }; D];
    let mut range = 0;
    for (axis, extent) in axes.iter_mut().zip(extents) {
        let (found, width) = extent.axis()?;
        *axis = found;
        range = range.max(width);
    }
    Some((axes, range))
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
        let (axes, range) = axes::<D>(points)?;
        if range > RANGE_MAX {
            return None;
        }
        let place = |point: &[f64; 3]| {
            std::array::from_fn(|k| i64::try_from(axes[k].scaled(point[k])).unwrap_or(0))
        };
        Some(Self { axes, points: points.par_iter().with_min_len(CHUNK).map(place).collect() })
    }

    pub(super) fn point(&self, index: u32) -> [i64; D] {
        self.points[index as usize]
    }
}

/// Points of the plane on a lattice of 120 bits: for meshes whose smallest and largest coordinates
/// are too far apart for 64 bits, as noise of 1e-17 beside 1 is. Differences within a triangle
/// mostly fit 64 bits all the same.
struct FineLattice {
    exponent: i32,
    points: Vec<[i128; 2]>,
}

impl FineLattice {
    fn of(points: &[[f64; 3]]) -> Option<Self> {
        let (axes, _) = axes::<2>(points)?;
        let place = |point: &[f64; 3]| [axes[0].scaled(point[0]), axes[1].scaled(point[1])];
        let points = points.par_iter().with_min_len(CHUNK).map(place).collect();
        Some(Self { exponent: axes[0].exponent + axes[1].exponent, points })
    }

    fn doubled_area(&self, triangle: [u32; 3]) -> Scaled {
        let [a, b, c] = triangle.map(|v| self.points[v as usize]);
        let differences = [b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]];
        let narrow = |d: i128| i64::try_from(d).is_ok_and(|d| d.unsigned_abs() < 1 << 63);
        let [bx, by, cx, cy] = differences;
        if differences.iter().all(|&d| narrow(d)) {
            return Scaled::Narrow(bx * cy - by * cx, self.exponent);
        }
        let value = Int256::product(bx, cy).minus(Int256::product(by, cx));
        Scaled::Wide(value.widen(), self.exponent)
    }
}

/// Coordinates of a plane mesh, and the exact predicates on its points by index.
pub(super) struct Plane<'a> {
    pub(super) mesh: &'a MeshData,
    lattice: Option<Lattice<2>>,
    /// Built only where the other lattice is too narrow.
    fine: Option<FineLattice>,
}

impl<'a> Plane<'a> {
    pub(super) fn new(mesh: &'a MeshData) -> Self {
        let lattice = Lattice::of(&mesh.points);
        let fine = if lattice.is_some() { None } else { FineLattice::of(&mesh.points) };
        Self { mesh, lattice, fine }
    }

    /// The coordinates of a point.
    pub(super) fn point(&self, index: u32) -> P2 {
        let [x, y, _] = self.mesh.points[index as usize];
        [x, y]
    }

    /// Twice the signed area of a triangle, exactly.
    #[inline]
    pub(super) fn doubled_area(&self, triangle: [u32; 3]) -> Scaled {
        if let Some(lattice) = &self.lattice {
            let exponent = lattice.axes[0].exponent + lattice.axes[1].exponent;
            let [a, b, c] = triangle.map(|v| lattice.point(v));
            let value = exact::determinant([a[0], b[0], c[0]], [a[1], b[1], c[1]]);
            return Scaled::Narrow(value, exponent);
        }
        if let Some(fine) = &self.fine {
            return fine.doubled_area(triangle);
        }
        let [a, b, c] = triangle.map(|v| self.point(v));
        exact::doubled_area(a, b, c)
    }

    /// Whether `d` lies inside (`Greater`), on or outside the circle of the counterclockwise a, b, c.
    pub(super) fn incircle(&self, corners: [u32; 4]) -> Ordering {
        let [a, b, c, d] = corners.map(|v| self.point(v));
        exact::incircle(a, b, c, d)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever lattice carries the points, areas are those of the predicates on coordinates.
    #[test]
    fn every_lattice_gives_the_same_areas() {
        let corner = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0 + f64::EPSILON]];
        for (smallest, rungs) in
            [(0.5, (true, false)), (1e-17, (false, true)), (1e-300, (false, false))]
        {
            let mut points: Vec<[f64; 3]> = corner.map(|[x, y]| [x, y, 0.0]).to_vec();
            points.extend([[smallest, smallest * 3.0, 0.0], [-smallest, smallest * 7.0, 0.0]]);
            let mesh = MeshData { points, ..MeshData::default() };
            let plane = Plane::new(&mesh);
            assert_eq!((plane.lattice.is_some(), plane.fine.is_some()), rungs, "{smallest}");
            for a in 0..6 {
                for b in 0..6 {
                    for c in 0..6 {
                        let [p, q, r] = [a, b, c].map(|v| plane.point(v));
                        let mut difference = exact::ExactSum::default();
                        difference.add_scaled(&plane.doubled_area([a, b, c]));
                        difference.add_scaled(&exact::doubled_area(q, p, r));
                        assert!(difference.value().0.sign().is_eq(), "{a} {b} {c}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_range_of_a_lattice_is_used_to_the_last_bit() {
        let widest = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [libm::scalbn(1.0, 62), 1.0, 0.0]];
        assert!(Lattice::<2>::of(&widest).is_some());
        let wider = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [libm::scalbn(1.0, 63), 1.0, 0.0]];
        assert!(Lattice::<2>::of(&wider).is_none());
    }
}
