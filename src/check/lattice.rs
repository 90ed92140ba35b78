//! The coordinates of a whole mesh as 64-bit integers.
//!
//! Along each axis the unit is the power of two that spreads the mesh over 62 bits, and integers are
//! counted from the middle of the range, so differences fit 63 bits and orient2d 125. A point that
//! is no multiple of the unit (noise of 1e-17 beside 1, say) is off the lattice: triangles that use
//! it are decided on their own, with whatever width they need.

use super::exact::{self, P2, P3, Scaled, mantissa_exponent};
use crate::mesh::MeshData;
use rayon::prelude::*;
use std::cmp::Ordering;

/// Bits over which the larger side of a mesh is spread along an axis.
const RANGE_BITS: i32 = 62;
/// Bits of the integers before the middle is subtracted; those must fit an i128.
const WIDE_BITS: u32 = 120;
/// The first coordinate of a point off the lattice.
const OFF: i64 = i64::MIN;
/// Points per piece of parallel work; fixed, so that the result cannot depend on threads.
const CHUNK: usize = 1 << 14;

/// Coordinates along one axis: `integer = x / 2^exponent - middle`.
#[derive(Clone, Copy)]
struct Axis {
    exponent: i32,
    middle: i128,
}

/// The smallest and the largest finite coordinate along an axis.
#[derive(Clone, Copy)]
struct Extent {
    low: f64,
    high: f64,
}

impl Extent {
    const EMPTY: Self = Self { low: f64::INFINITY, high: f64::NEG_INFINITY };

    fn with(self, x: f64) -> Self {
        if x.is_finite() { self.and(Self { low: x, high: x }) } else { self }
    }

    fn and(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// The axis that spreads the extent over at most [`RANGE_BITS`].
    fn axis(self) -> Axis {
        let largest = self.low.abs().max(self.high.abs());
        if self.low > self.high || largest == 0.0 {
            return Axis { exponent: 0, middle: 0 };
        }
        // Half of a difference cannot overflow; its exponent is one below that of the whole, and
        // rounding may have raised the whole to the next power of two, never lowered it below one.
        let half = self.high / 2.0 - self.low / 2.0;
        let whole = if half > 0.0 { libm::ilogb(half) + 2 } else { -1074 };
        // The extent's ends must not need more than WIDE_BITS either.
        let coarsest = libm::ilogb(largest) + 1 - WIDE_BITS.cast_signed();
        let exponent = (whole - RANGE_BITS).max(coarsest);
        // Floor division: the middle need not be a coordinate.
        let floor = |x: f64| {
            let (m, e) = mantissa_exponent(x);
            match e.saturating_sub(exponent) {
                _ if m == 0 => 0,
                up @ 0.. => i128::from(m) << up,
                down => i128::from(m) >> down.unsigned_abs().min(127),
            }
        };
        Axis { exponent, middle: floor(self.low).midpoint(floor(self.high)) }
    }
}

impl Axis {
    /// The integer of a coordinate, if it is a multiple of the unit.
    #[inline]
    fn integer(self, x: f64) -> Option<i64> {
        let (m, e) = if x.is_finite() { mantissa_exponent(x) } else { return None };
        if m == 0 {
            return i64::try_from(-self.middle).ok();
        }
        let shift = u32::try_from(e.checked_sub(self.exponent)?).ok()?;
        let bits = 64 - m.unsigned_abs().leading_zeros();
        if bits.saturating_add(shift) > WIDE_BITS {
            return None;
        }
        i64::try_from((i128::from(m) << shift) - self.middle).ok()
    }
}

/// Points on an integer lattice, `D` axes.
pub(super) struct Lattice<const D: usize> {
    axes: [Axis; D],
    points: Vec<[i64; D]>,
}

impl<const D: usize> Lattice<D> {
    /// The lattice of the finite points of a mesh.
    pub(super) fn of(points: &[P3]) -> Self {
        let extents = |chunk: &[P3]| {
            let mut extents = [Extent::EMPTY; D];
            for point in chunk {
                for (extent, &x) in extents.iter_mut().zip(point) {
                    *extent = extent.with(x);
                }
            }
            extents
        };
        let join = |a: [Extent; D], b: [Extent; D]| std::array::from_fn(|k| a[k].and(b[k]));
        let axes = points
            .par_chunks(CHUNK)
            .map(extents)
            .reduce(|| [Extent::EMPTY; D], join)
            .map(Extent::axis);
        let place = |point: &P3| {
            let mut integers = [0; D];
            for k in 0..D {
                match axes[k].integer(point[k]) {
                    Some(integer) => integers[k] = integer,
                    None => return [OFF; D],
                }
            }
            integers
        };
        Self { axes, points: points.par_iter().with_min_len(CHUNK).map(place).collect() }
    }

    /// The integers of some points, if all are on the lattice.
    #[inline]
    pub(super) fn points<const N: usize>(&self, indices: [u32; N]) -> Option<[[i64; D]; N]> {
        let points = indices.map(|v| self.points[v as usize]);
        points.iter().all(|p| p[0] != OFF).then_some(points)
    }
}

/// Coordinates of a plane mesh, and the exact predicates on its points by index.
pub(super) struct Plane<'a> {
    pub(super) mesh: &'a MeshData,
    lattice: Lattice<2>,
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
        if let Some([a, b, c]) = self.lattice.points(triangle) {
            let exponent = self.lattice.axes[0].exponent + self.lattice.axes[1].exponent;
            let value = exact::determinant([a[0], b[0], c[0]], [a[1], b[1], c[1]]);
            return Scaled::Narrow(value, exponent);
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

    fn plane_of(points: &[P2]) -> MeshData {
        let points = points.iter().map(|&[x, y]| [x, y, 0.0]).collect();
        MeshData { points, ..MeshData::default() }
    }

    /// On the lattice or off it, areas are those of the predicates on coordinates.
    #[test]
    fn areas_are_the_same_on_and_off_the_lattice() {
        for (small, off) in
            [(0.5, 0), (1e-17, 2), (1e-300, 2), (5e-324, 2), (1e300, 3), (f64::MAX, 3)]
        {
            let mesh = plane_of(&[
                [0.0, 0.0],
                [1.0, 0.0],
                [0.0, 1.0],
                [1.0, 1.0 + f64::EPSILON],
                [small, small / 2.0],
                [-small, small],
            ]);
            let plane = Plane::new(&mesh);
            let count = (0..6).filter(|&v| plane.lattice.points([v]).is_none()).count();
            assert_eq!(count, off, "{small}");
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
    fn a_mesh_far_from_the_origin_is_on_its_lattice() {
        let x = 1e9f64;
        let mesh = plane_of(&[[x, x], [x.next_up(), x], [x, x.next_up()], [x + 1.0, x - 1.0]]);
        let plane = Plane::new(&mesh);
        assert!(plane.lattice.points([0, 1, 2, 3]).is_some());
        assert!(plane.doubled_area([0, 1, 2]).sign().is_gt());
    }

    #[test]
    fn points_that_are_not_finite_are_off_the_lattice() {
        let mesh = plane_of(&[[f64::NAN, 0.0], [0.0, f64::INFINITY], [3.0, 4.0]]);
        let plane = Plane::new(&mesh);
        assert!(plane.lattice.points([0]).is_none() && plane.lattice.points([1]).is_none());
        assert!(plane.lattice.points([2]).is_some());
    }
}
