//! Vectors of space, as plain arrays.

/// A point or vector of space.
pub type Vector = [f64; 3];

/// a + b
#[inline]
#[must_use]
pub fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// a - b
#[inline]
#[must_use]
pub fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// s a
#[inline]
#[must_use]
pub fn scale(s: f64, a: Vector) -> Vector {
    [s * a[0], s * a[1], s * a[2]]
}

/// a + s b
#[inline]
#[must_use]
pub fn along(a: Vector, s: f64, b: Vector) -> Vector {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// Scalar product.
#[inline]
#[must_use]
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product.
#[inline]
#[must_use]
pub fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Squared length.
#[inline]
#[must_use]
pub fn norm_sq(a: Vector) -> f64 {
    dot(a, a)
}

/// Length.
#[inline]
#[must_use]
pub fn norm(a: Vector) -> f64 {
    norm_sq(a).sqrt()
}

/// Distance of two points.
#[inline]
#[must_use]
pub fn distance(a: Vector, b: Vector) -> f64 {
    norm(sub(a, b))
}

/// The vector of length 1 in this direction; `None` when it has none.
#[inline]
#[must_use]
pub fn unit(a: Vector) -> Option<Vector> {
    let length = norm(a);
    (length > 0.0 && length.is_finite()).then(|| scale(1.0 / length, a))
}

/// Squared distance of `p` from the segment from `a` to `b`.
#[must_use]
pub fn segment_distance_sq(a: Vector, b: Vector, p: Vector) -> f64 {
    let (u, w) = (sub(b, a), sub(p, a));
    let length_sq = norm_sq(u);
    let t = if length_sq > 0.0 { (dot(w, u) / length_sq).clamp(0.0, 1.0) } else { 0.0 };
    norm_sq(sub(w, scale(t, u)))
}

/// By which equal points are equal: the bits, with -0.0 folded into 0.0.
#[must_use]
pub fn key(a: Vector) -> [u64; 3] {
    a.map(|x| (x + 0.0).to_bits())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_follow_the_right_hand() {
        let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert_eq!(cross(x, y), z);
        assert_eq!(cross(y, x), scale(-1.0, z));
        assert_eq!(dot(x, y), 0.0);
        assert_eq!(along(x, 2.0, y), [1.0, 2.0, 0.0]);
    }

    #[test]
    fn a_vector_without_length_has_no_direction() {
        assert_eq!(unit([0.0; 3]), None);
        assert_eq!(unit([f64::NAN, 0.0, 0.0]), None);
        assert_eq!(unit([0.0, 3.0, 4.0]), Some([0.0, 0.6000000000000001, 0.8]));
    }

    #[test]
    fn the_nearest_point_of_a_segment_may_be_an_end() {
        let (a, b) = ([0.0; 3], [2.0, 0.0, 0.0]);
        for (p, expected) in
            [([1.0, 3.0, 0.0], 9.0), ([-3.0, 4.0, 0.0], 25.0), ([4.0, 0.0, 0.0], 4.0)]
        {
            assert_eq!(segment_distance_sq(a, b, p), expected);
        }
        assert_eq!(segment_distance_sq(a, a, b), 4.0, "a segment of one point");
    }

    #[test]
    fn minus_zero_is_zero() {
        assert_eq!(key([-0.0, 0.0, 1.0]), key([0.0, 0.0, 1.0]));
        assert_ne!(key([0.0, 0.0, 1.0]), key([0.0, 0.0, 1.0 + f64::EPSILON]));
    }
}
