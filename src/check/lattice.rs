//! The coordinates of a whole mesh as 64-bit integers, where they fit.
//!
//! One power of two divides all coordinates so that the largest stays below 2^61. Most points of
//! most meshes are then integers: differences stay below 2^62 and the orientation determinant below
//! 2^125. A point with bits further down (near the origin of a mesh that is a million times as wide,
//! or noise of 1e-30 beside 1) is off the lattice, and what touches it is decided from its floats.

use super::exact::{self, P2, Scaled};
use crate::mesh::MeshData;
use rayon::prelude::*;
use std::cmp::Ordering;

/// Bits of the largest integer.
const BITS: i32 = 61;

/// Points per piece of parallel work; fixed, so that the result cannot depend on threads.
const CHUNK: usize = 1 << 14;

/// The first coordinate of a point that is no point of the lattice; integers stay far from it.
const OFF: i64 = i64::MIN;

/// Multiplication by a power of two, in two exact steps where one factor would overflow.
#[derive(Clone, Copy)]
struct Scale([f64; 2]);

impl Scale {
    fn new(exponent: i32) -> Self {
        let half = exponent / 2;
        Self([half, exponent - half].map(|e| libm::scalbn(1.0, e)))
    }

    /// The integer `x` times the scale, or `None` when it is none.
    fn integer(self, x: f64) -> Option<i64> {
        // A product with a power of two is exact unless it underflows; one that does is below 1, so
        // it truncates to 0 and only a zero may do that. Infinities and NaN fail the comparison.
        let scaled = x * self.0[0] * self.0[1];
        #[expect(clippy::cast_possible_truncation, reason = "compared right below")]
        let integer = scaled as i64;
        let exact = integer as f64 == scaled && (integer != 0 || x == 0.0);
        exact.then_some(integer)
    }
}

/// The largest magnitude of a finite coordinate among the first `D` axes.
fn largest<const D: usize>(points: &[[f64; 3]]) -> f64 {
    let of_chunk = |chunk: &[[f64; 3]]| {
        let mut most = [0.0f64; D];
        for point in chunk {
            for (most, x) in most.iter_mut().zip(point) {
                let x = x.abs();
                if x > *most && x < f64::INFINITY {
                    *most = x;
                }
            }
        }
        most.into_iter().fold(0.0, f64::max)
    };
    points.par_chunks(CHUNK).map(of_chunk).reduce(|| 0.0, f64::max)
}

/// Points on an integer lattice, `D` axes: `integer = x / 2^exponent` on each.
pub(super) struct Lattice<const D: usize> {
    pub(super) exponent: i32,
    points: Vec<[i64; D]>,
}

impl<const D: usize> Lattice<D> {
    /// The lattice of a mesh. O(n), `8 D` bytes a point.
    pub(super) fn of(points: &[[f64; 3]]) -> Self {
        let most = largest::<D>(points);
        let exponent = if most > 0.0 { libm::ilogb(most) + 1 - BITS } else { 0 };
        // Every float is a multiple of 2^-1074.
        let exponent = exponent.max(-1074);
        let scale = Scale::new(-exponent);
        let place = |point: &[f64; 3]| {
            let integers: [Option<i64>; D] = std::array::from_fn(|k| scale.integer(point[k]));
            if integers.iter().all(Option::is_some) {
                integers.map(|i| i.unwrap_or(0))
            } else {
                [OFF; D]
            }
        };
        Self { exponent, points: points.par_iter().with_min_len(CHUNK).map(place).collect() }
    }

    /// The lattice points, if all of them are on the lattice.
    #[inline]
    pub(super) fn points<const N: usize>(&self, indices: [u32; N]) -> Option<[[i64; D]; N]> {
        let found = indices.map(|v| self.points[v as usize]);
        found.iter().all(|p| p[0] != OFF).then_some(found)
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

    /// Twice the signed area of a triangle on the lattice in units of its squared spacing, or `None`
    /// when a corner is off the lattice.
    #[inline]
    pub(super) fn lattice_area(&self, triangle: [u32; 3]) -> Option<i128> {
        let [a, b, c] = self.lattice.points(triangle)?;
        Some(exact::determinant([a[0], b[0], c[0]], [a[1], b[1], c[1]]))
    }

    /// The exponent of the unit of [`Plane::lattice_area`].
    pub(super) fn area_exponent(&self) -> i32 {
        2 * self.lattice.exponent
    }

    /// Twice the signed area of a triangle, exactly.
    #[inline]
    pub(super) fn doubled_area(&self, triangle: [u32; 3]) -> Scaled {
        match self.lattice_area(triangle) {
            Some(value) => Scaled::Narrow(value, self.area_exponent()),
            None => {
                let [a, b, c] = triangle.map(|v| self.point(v));
                exact::doubled_area(a, b, c)
            }
        }
    }

    /// Whether `d` lies inside (`Greater`), on or outside the circle of the counterclockwise a, b, c.
    pub(super) fn incircle(&self, corners: [u32; 4]) -> Ordering {
        match self.lattice.points(corners) {
            Some(points) => exact::incircle_narrow(points.map(|p| p[0]), points.map(|p| p[1])),
            None => {
                let [a, b, c, d] = corners.map(|v| self.point(v));
                exact::incircle(a, b, c, d)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(points: &[[f64; 2]]) -> MeshData {
        let points = points.iter().map(|&[x, y]| [x, y, 0.0]).collect();
        MeshData { points, ..MeshData::default() }
    }

    /// On the lattice or off it, areas and circles are those of the predicates on coordinates.
    #[test]
    fn the_lattice_decides_as_the_floats_do() {
        let corner = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0 + f64::EPSILON]];
        for (smallest, on) in [(0.5, true), (1e-17, false), (1e-300, false), (5e-324, false)] {
            let mut points = corner.to_vec();
            points.extend([[smallest, smallest * 3.0], [-smallest, smallest * 7.0]]);
            let mesh = mesh(&points);
            let plane = Plane::new(&mesh);
            assert!(plane.lattice.points([0, 1, 2, 3]).is_some());
            assert_eq!(plane.lattice.points([4]).is_some(), on, "{smallest}");
            for i in 0..6 * 6 * 6 {
                let [a, b, c] = [i % 6, i / 6 % 6, i / 36];
                let [p, q, r] = [a, b, c].map(|v| plane.point(v));
                let mut difference = exact::ExactSum::default();
                difference.add_scaled(&plane.doubled_area([a, b, c]));
                difference.add_scaled(&exact::doubled_area(q, p, r));
                assert!(difference.value().0.sign().is_eq(), "{a} {b} {c}");
                for d in 0..6 {
                    let wanted = exact::incircle(p, q, r, plane.point(d));
                    assert_eq!(plane.incircle([a, b, c, d]), wanted, "{a} {b} {c} {d}");
                }
            }
        }
    }

    #[test]
    fn the_lattice_is_as_fine_as_its_largest_coordinate_allows() {
        let on = |x: f64, of: f64| {
            Lattice::<2>::of(&[[of, of, 0.0], [x, 0.0, 0.0]]).points([1]).is_some()
        };
        for of in [1.0, 3.0, -7.5, 1e300, -1.7e308, 1e-300] {
            let finest = libm::scalbn(1.0, (libm::ilogb(of) + 1 - BITS).max(-1074));
            assert!(on(finest, of) && on(-finest, of), "{of}");
            assert!(finest < 1e-320 || !on(finest / 2.0, of), "{of}");
        }
        assert!(on(5e-324, 1e-310) && on(5e-324, 5e-324) && on(-0.0, 5e-324));
        assert!(!on(5e-324, 1.7e308) && !on(f64::NAN, 1.0) && !on(f64::INFINITY, 1.0));
    }

    #[test]
    fn the_largest_integers_fit_the_predicates() {
        let most = 1.0 - f64::EPSILON / 2.0;
        let points = [[-most, -most], [most, -most], [most, most], [-most, most]];
        let mesh = mesh(&points);
        let plane = Plane::new(&mesh);
        assert!(plane.lattice.points([0, 1, 2, 3]).is_some());
        assert_eq!(plane.doubled_area([0, 1, 2]).sign(), Ordering::Greater);
        assert_eq!(plane.incircle([0, 1, 2, 3]), Ordering::Equal);
        let all = |i: usize| points[i];
        assert_eq!(exact::incircle(all(0), all(1), all(2), all(3)), Ordering::Equal);
    }
}
