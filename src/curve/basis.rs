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

/// The degree + 1 basis functions that are not zero at a parameter, and their derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Basis {
    /// Index of the first of them, and so of the first control point with a part in the value.
    pub first: usize,
    /// Values; the sum is 1.
    pub value: [f64; WIDTH],
    /// First derivatives; zeros unless asked for.
    pub slope: [f64; WIDTH],
    /// Second derivatives; zeros unless asked for.
    pub bend: [f64; WIDTH],
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

impl Basis {
    /// The basis at `t`, with this many derivatives (0, 1 or 2).
    #[must_use]
    pub fn at(knots: &[f64], degree: usize, count: usize, t: f64, derivatives: usize) -> Self {
        let span = span(knots, degree, count, t);
        let mut basis = Self {
            first: span - degree,
            value: [0.0; WIDTH],
            slope: [0.0; WIDTH],
            bend: [0.0; WIDTH],
        };
        basis.value[0] = 1.0;
        for k in 1..=degree {
            if derivatives >= 1 && k == degree {
                basis.slope = differentiate(knots, span, k, &basis.value);
            }
            if derivatives >= 2 && k + 1 == degree {
                // For now the slope of degree k; differentiated once more below.
                basis.bend = differentiate(knots, span, k, &basis.value);
            }
            if derivatives >= 2 && k == degree {
                basis.bend = differentiate(knots, span, k, &basis.bend);
            }
            raise(knots, span, k, t, &mut basis.value);
        }
        basis
    }
}

/// From the k functions of degree k - 1 to the k + 1 of degree k.
///
/// At an end of clamped knots one of the weights is exactly 0 and the other exactly 1, so a curve
/// starts and ends exactly in its control points.
fn raise(knots: &[f64], span: usize, k: usize, t: f64, n: &mut [f64; WIDTH]) {
    let mut saved = 0.0;
    for r in 0..k {
        let (left, right) = (t - knots[span + 1 + r - k], knots[span + 1 + r] - t);
        let weight = left / (left + right);
        let value = n[r];
        n[r] = saved + (1.0 - weight) * value;
        saved = weight * value;
    }
    n[k] = saved;
}

/// From k functions of degree k - 1 to the derivatives of the k + 1 of degree k; applied to
/// derivatives, to derivatives one order higher.
fn differentiate(knots: &[f64], span: usize, k: usize, n: &[f64; WIDTH]) -> [f64; WIDTH] {
    let mut slope = [0.0; WIDTH];
    for r in 0..k {
        let quotient = k as f64 * n[r] / (knots[span + 1 + r] - knots[span + 1 + r - k]);
        slope[r] -= quotient;
        slope[r + 1] += quotient;
    }
    slope
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
            let basis = Basis::at(&KNOTS, 3, 7, t, 2);
            let sum = |n: [f64; WIDTH]| n.iter().sum::<f64>();
            assert!((sum(basis.value) - 1.0).abs() < 1e-15, "{t}");
            assert!(sum(basis.slope).abs() < 1e-12 && sum(basis.bend).abs() < 1e-10, "{t}");
        }
    }

    // spec: S1
    #[test]
    fn the_ends_of_clamped_knots_are_exact() {
        let start = Basis::at(&KNOTS, 3, 7, 0.0, 0);
        let end = Basis::at(&KNOTS, 3, 7, 1.0, 0);
        assert_eq!((start.first, start.value[..4].to_vec()), (0, vec![1.0, 0.0, 0.0, 0.0]));
        assert_eq!((end.first, end.value[..4].to_vec()), (3, vec![0.0, 0.0, 0.0, 1.0]));
    }

    // spec: S1
    #[test]
    fn derivatives_are_those_of_differences() {
        let h = 1e-6;
        for t in [0.1, 0.29, 0.5, 0.9] {
            let [low, mid, high] = [t - h, t, t + h].map(|t| Basis::at(&KNOTS, 3, 7, t, 2));
            assert_eq!(low.first, high.first, "within one interval");
            for r in 0..4 {
                let slope = (high.value[r] - low.value[r]) / (2.0 * h);
                let bend = (high.slope[r] - low.slope[r]) / (2.0 * h);
                assert!((slope - mid.slope[r]).abs() < 1e-7, "{t} {r}");
                assert!((bend - mid.bend[r]).abs() < 1e-6, "{t} {r}");
            }
        }
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
