//! B-spline basis functions with two derivatives, by the recurrence of Cox and de Boor.
//!
//! N(i,0) is 1 between the knots i and i + 1, and
//! N(i,k) = a(i) N(i,k-1) + (1 - a(i+1)) N(i+1,k-1) with a(i) = (t - U(i)) / (U(i+k) - U(i)).
//! A derivative of degree k is k times the difference quotient of two functions of degree k - 1
//! (de Boor, "A practical guide to splines", 1978; Piegl and Tiller, "The NURBS book", 1997, 2.3).

/// Largest degree: the basis functions then fit an array on the stack.
pub const DEGREE_MAX: usize = 15;

/// Most basis functions that are not zero at a parameter.
const WIDTH: usize = DEGREE_MAX + 1;

/// The degree + 1 basis functions that are not zero at a parameter, and their derivatives of all
/// orders below N.
#[derive(Clone, Copy, Debug)]
pub struct Basis<const N: usize> {
    /// Index of the first of them, and so of the first control point with a part in the value.
    pub first: usize,
    /// By order of derivative: values, whose sum is 1, then slopes, then second derivatives.
    pub rows: [[f64; WIDTH]; N],
}

/// The knot interval of a parameter: i with U(i) <= t < U(i + 1), or the last one that is not empty
/// for t at the end. `count` is the number of control points.
#[must_use]
pub fn span(knots: &[f64], degree: usize, count: usize, t: f64) -> usize {
    let inner = &knots[degree..=count];
    let after = inner.partition_point(|&knot| knot <= t);
    let mut i = (degree + after).saturating_sub(1).clamp(degree, count - 1);
    while i > degree && knots[i] == knots[i + 1] {
        i -= 1;
    }
    i
}

impl<const N: usize> Basis<N> {
    /// The basis at `t`.
    #[must_use]
    #[inline]
    pub fn at(knots: &[f64], degree: usize, count: usize, t: f64) -> Self {
        let span = span(knots, degree, count, t);
        let mut basis = Self { first: span - degree, rows: [[0.0; WIDTH]; N] };
        let rows = &mut basis.rows;
        rows[0][0] = 1.0;
        for k in 1..=degree {
            for order in (1..N).rev() {
                // The derivative of this order comes from the functions so many degrees below.
                if k + order == degree + 1 {
                    let (values, above) = rows.split_at_mut(order);
                    above[0][..k].copy_from_slice(&values[0][..k]);
                }
                if k + order > degree {
                    differentiate(knots, span, k, &mut rows[order]);
                }
            }
            raise(knots, span, k, t, &mut rows[0]);
        }
        basis
    }
}

/// From the k functions of degree k - 1 to the k + 1 of degree k.
///
/// At an end of clamped knots one of the weights is exactly 0 and the other exactly 1, so a curve
/// starts and ends exactly in its control points.
#[inline]
fn raise(knots: &[f64], span: usize, k: usize, t: f64, n: &mut [f64; WIDTH]) {
    let below = &knots[span + 1 - k..=span];
    let above = &knots[span + 1..=span + k];
    let mut saved = 0.0;
    for ((value, below), above) in n.iter_mut().zip(below).zip(above) {
        let (left, right) = (t - below, above - t);
        let weight = left / (left + right);
        let old = *value;
        *value = saved + (1.0 - weight) * old;
        saved = weight * old;
    }
    n[k] = saved;
}

/// From k functions of degree k - 1 to the derivatives of the k + 1 of degree k; applied to
/// derivatives, to derivatives one order higher.
#[inline]
fn differentiate(knots: &[f64], span: usize, k: usize, n: &mut [f64; WIDTH]) {
    let below = &knots[span + 1 - k..=span];
    let above = &knots[span + 1..=span + k];
    let mut before = 0.0;
    for ((value, below), above) in n.iter_mut().zip(below).zip(above) {
        let quotient = k as f64 * *value / (above - below);
        *value = before - quotient;
        before = quotient;
    }
    n[k] = before;
}

#[cfg(test)]
mod tests {
    use super::*;

    const KNOTS: [f64; 11] = [0.0, 0.0, 0.0, 0.0, 0.3, 0.3, 0.8, 1.0, 1.0, 1.0, 1.0];

    // spec: S1
    #[test]
    fn the_functions_sum_to_one_and_their_derivatives_to_zero() {
        for i in 0..=100 {
            let t = f64::from(i) / 100.0;
            let [values, slopes, bends] =
                Basis::<3>::at(&KNOTS, 3, 7, t).rows.map(|n| n.iter().sum::<f64>());
            assert!((values - 1.0).abs() < 1e-15, "{t}");
            assert!(slopes.abs() < 1e-12 && bends.abs() < 1e-10, "{t}");
        }
    }

    // spec: S1
    #[test]
    fn the_ends_of_clamped_knots_are_exact() {
        let [start, end] = [0.0, 1.0].map(|t| Basis::<1>::at(&KNOTS, 3, 7, t));
        assert_eq!((start.first, start.rows[0][..4].to_vec()), (0, vec![1.0, 0.0, 0.0, 0.0]));
        assert_eq!((end.first, end.rows[0][..4].to_vec()), (3, vec![0.0, 0.0, 0.0, 1.0]));
    }

    // spec: S1
    #[test]
    fn derivatives_are_those_of_differences() {
        let h = 1e-6;
        for t in [0.1, 0.29, 0.5, 0.9] {
            let [low, mid, high] = [t - h, t, t + h].map(|t| Basis::<3>::at(&KNOTS, 3, 7, t));
            assert_eq!(low.first, high.first, "within one interval");
            for r in 0..4 {
                let slope = (high.rows[0][r] - low.rows[0][r]) / (2.0 * h);
                let bend = (high.rows[1][r] - low.rows[1][r]) / (2.0 * h);
                assert!((slope - mid.rows[1][r]).abs() < 1e-7, "{t} {r}");
                assert!((bend - mid.rows[2][r]).abs() < 1e-6, "{t} {r}");
            }
        }
    }

    // spec: S1
    #[test]
    fn fewer_derivatives_are_the_same_and_those_above_the_degree_are_zero() {
        for t in [0.0, 0.2, 0.3, 0.77, 1.0] {
            let all = Basis::<3>::at(&KNOTS, 3, 7, t).rows;
            assert_eq!(Basis::<2>::at(&KNOTS, 3, 7, t).rows[..], all[..2]);
            assert_eq!(Basis::<1>::at(&KNOTS, 3, 7, t).rows[..], all[..1]);
        }
        let line = Basis::<3>::at(&[0.0, 0.0, 2.0, 2.0], 1, 2, 0.5).rows;
        assert_eq!(line.map(|row| [row[0], row[1]]), [[0.75, 0.25], [-0.5, 0.5], [0.0, 0.0]]);
    }

    #[test]
    fn spans_of_repeated_knots_are_never_empty() {
        for (t, expected) in
            [(0.0, 3), (0.29, 3), (0.3, 5), (0.8, 6), (1.0, 6), (-1.0, 3), (2.0, 6)]
        {
            assert_eq!(span(&KNOTS, 3, 7, t), expected, "{t}");
        }
    }
}
