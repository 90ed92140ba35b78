//! B-spline basis functions with two derivatives, by the recurrence of Cox and de Boor.
//!
//! N(i,0) is 1 between the knots i and i + 1, and
//! N(i,k) = a(i) N(i,k-1) + (1 - a(i+1)) N(i+1,k-1) with a(i) = (t - U(i)) / (U(i+k) - U(i)).
//! A derivative of degree k is k times the difference quotient of two functions of degree k - 1
//! (de Boor, "A practical guide to splines", 1978; Piegl and Tiller, "The NURBS book", 1997, 2.3).

/// Largest degree: the basis functions then fit an array on the stack.
pub const DEGREE_MAX: usize = 15;

/// Most basis functions that are not zero at a parameter.
pub const WIDTH: usize = DEGREE_MAX + 1;

/// The degree + 1 basis functions that are not zero at a parameter, and their derivatives of all
/// orders below N; there is room for W functions.
#[derive(Clone, Copy, Debug)]
pub struct Basis<const N: usize, const W: usize = WIDTH> {
    /// Index of the first of them, and so of the first control point with a part in the value.
    pub first: usize,
    /// By order of derivative: values, whose sum is 1, then slopes, then second derivatives.
    pub rows: [[f64; W]; N],
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

impl<const N: usize, const W: usize> Basis<N, W> {
    /// The basis at `t`; the degree is below W.
    #[must_use]
    #[inline]
    pub fn at(knots: &[f64], degree: usize, count: usize, t: f64) -> Self {
        let span = span(knots, degree, count, t);
        let mut basis = Self { first: span - degree, rows: [[0.0; W]; N] };
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
fn raise<const W: usize>(knots: &[f64], span: usize, k: usize, t: f64, n: &mut [f64; W]) {
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
fn differentiate<const W: usize>(knots: &[f64], span: usize, k: usize, n: &mut [f64; W]) {
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

/// Most functions of a [`Table`], and the room for those of degrees that low.
pub const NARROW: usize = 4;

/// Powers of the place in an interval, with their coefficients in each basis function.
type Powers = [[f64; NARROW]; NARROW];

/// The basis functions of degree 2 or 3 as polynomials, interval by interval: they are evaluated
/// without the divisions of the recurrence, four at once. Of other degrees it is empty.
///
/// # Shapes and units
/// `intervals: [count - degree]`, those between `knots[degree]` and `knots[count]`, empty ones too.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    intervals: Vec<Interval>,
    start: f64,
    end: f64,
    /// Intervals per unit of the parameter, were they all as long.
    density: f64,
}

/// Basis functions as polynomials in s = (t - start) / width, from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Interval {
    start: f64,
    end: f64,
    per_width: f64,
    powers: Powers,
}

impl Table {
    /// For knots that obey the rules of curves.
    #[must_use]
    pub fn new(knots: &[f64], degree: usize, count: usize) -> Self {
        if !(2..NARROW).contains(&degree) {
            return Self::default();
        }
        let interval = |span: usize| {
            let (start, end) = (knots[span], knots[span + 1]);
            let is_empty = start >= end;
            let per_width = if is_empty { 0.0 } else { 1.0 / (end - start) };
            let powers =
                if is_empty { [[0.0; NARROW]; NARROW] } else { powers(knots, degree, span) };
            Interval { start, end, per_width, powers }
        };
        let (start, end) = (knots[degree], knots[count]);
        let density = (count - degree) as f64 / (end - start);
        Self { intervals: (degree..count).map(interval).collect(), start, end, density }
    }

    /// The basis at `t`, if it is the table's: `t` is not before the start, before the end, and the
    /// degree is one of its own.
    ///
    /// At the start of an interval values are those of the recurrence; the end is left to that.
    #[must_use]
    #[inline]
    pub fn at<const N: usize>(&self, t: f64) -> Option<Basis<N, NARROW>> {
        if !(t >= self.start && t < self.end) {
            return None;
        }
        // Equal intervals are the rule: then the first guess is right but for rounding.
        let guess = ((t - self.start) * self.density) as usize;
        let holds = |i: &Interval| i.start <= t && t < i.end;
        let first = match self.intervals.get(guess) {
            Some(interval) if holds(interval) => guess,
            _ => self.intervals.partition_point(|i| i.start <= t).saturating_sub(1),
        };
        let interval = self.intervals.get(first)?;
        let s = (t - interval.start) * interval.per_width;
        let mut basis = Basis { first, rows: [[0.0; NARROW]; N] };
        for (order, row) in basis.rows.iter_mut().enumerate() {
            *row = interval.derivative(order, s);
        }
        Some(basis)
    }
}

impl Interval {
    /// All functions' derivative of this order: below 3.
    #[inline]
    fn derivative(&self, order: usize, s: f64) -> [f64; NARROW] {
        let [a, b, c, d] = &self.powers;
        let w = self.per_width;
        match order {
            0 => std::array::from_fn(|r| a[r] + s * (b[r] + s * (c[r] + s * d[r]))),
            1 => std::array::from_fn(|r| w * (b[r] + s * (2.0 * c[r] + s * (3.0 * d[r])))),
            _ => std::array::from_fn(|r| w * w * (2.0 * c[r] + s * (6.0 * d[r]))),
        }
    }
}

/// The recurrence of [`raise`], for polynomials.
fn powers(knots: &[f64], degree: usize, span: usize) -> Powers {
    let (start, width) = (knots[span], knots[span + 1] - knots[span]);
    // By function, then by power.
    let mut functions = [[0.0; NARROW]; NARROW];
    functions[0][0] = 1.0;
    for k in 1..=degree {
        let mut saved = [0.0; NARROW];
        for j in 0..k {
            let (below, above) = (knots[span + 1 - k + j], knots[span + 1 + j]);
            let [left, right, slope] =
                [start - below, above - start, width].map(|x| x / (above - below));
            let old = functions[j];
            let falling = times(old, right, -slope);
            functions[j] = std::array::from_fn(|i| saved[i] + falling[i]);
            saved = times(old, left, slope);
        }
        functions[k] = saved;
    }
    std::array::from_fn(|power| std::array::from_fn(|function| functions[function][power]))
}

/// A polynomial times a + b s, which is of degree 3 at most.
fn times(p: [f64; NARROW], a: f64, b: f64) -> [f64; NARROW] {
    std::array::from_fn(|i| a * p[i] + if i > 0 { b * p[i - 1] } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    // spec: S1
    #[test]
    fn the_table_says_what_the_recurrence_says() {
        let uneven = [-2.0, -1.0, 0.0, 0.5, 0.75, 4.0, 4.0, 5.0, 5.5, 8.0];
        for (knots, degree, count) in [(&KNOTS[..], 3, 7), (&uneven[..], 3, 6), (&uneven[..], 2, 7)]
        {
            let table = Table::new(knots, degree, count);
            let [start, end] = [knots[degree], knots[count]];
            for i in 0..1000 {
                let t = start + (end - start) * f64::from(i) / 1000.0;
                let slow = Basis::<3, NARROW>::at(knots, degree, count, t);
                let fast = table.at::<3>(t).expect("a parameter of the domain");
                assert_eq!(fast.first, slow.first, "{t}");
                for (a, b) in fast.rows.as_flattened().iter().zip(slow.rows.as_flattened()) {
                    assert!((a - b).abs() <= 1e-13 * (1.0 + b.abs()), "{t}: {a} and {b}");
                }
            }
        }
    }

    // spec: S1
    #[test]
    fn the_table_begins_exactly_and_leaves_the_rest_to_the_recurrence() {
        let table = Table::new(&KNOTS, 3, 7);
        assert_eq!(table.at::<1>(0.0).expect("the start").rows, [[1.0, 0.0, 0.0, 0.0]]);
        for t in [-0.1, 1.0, 1.1, f64::NAN] {
            assert!(table.at::<1>(t).is_none(), "{t}");
        }
        let line = Table::new(&[0.0, 0.0, 2.0, 2.0], 1, 2);
        assert!(line.at::<1>(0.5).is_none());
    }

    const KNOTS: [f64; 11] = [0.0, 0.0, 0.0, 0.0, 0.3, 0.3, 0.8, 1.0, 1.0, 1.0, 1.0];

    // spec: S1
    #[test]
    fn the_functions_sum_to_one_and_their_derivatives_to_zero() {
        for i in 0..=100 {
            let t = f64::from(i) / 100.0;
            let [values, slopes, bends] =
                Basis::<3, WIDTH>::at(&KNOTS, 3, 7, t).rows.map(|n| n.iter().sum::<f64>());
            assert!((values - 1.0).abs() < 1e-15, "{t}");
            assert!(slopes.abs() < 1e-12 && bends.abs() < 1e-10, "{t}");
        }
    }

    // spec: S1
    #[test]
    fn the_ends_of_clamped_knots_are_exact() {
        let [start, end] = [0.0, 1.0].map(|t| Basis::<1, WIDTH>::at(&KNOTS, 3, 7, t));
        assert_eq!((start.first, start.rows[0][..4].to_vec()), (0, vec![1.0, 0.0, 0.0, 0.0]));
        assert_eq!((end.first, end.rows[0][..4].to_vec()), (3, vec![0.0, 0.0, 0.0, 1.0]));
    }

    // spec: S1
    #[test]
    fn derivatives_are_those_of_differences() {
        let h = 1e-6;
        for t in [0.1, 0.29, 0.5, 0.9] {
            let [low, mid, high] =
                [t - h, t, t + h].map(|t| Basis::<3, WIDTH>::at(&KNOTS, 3, 7, t));
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
            let all = Basis::<3, WIDTH>::at(&KNOTS, 3, 7, t).rows;
            assert_eq!(Basis::<2, WIDTH>::at(&KNOTS, 3, 7, t).rows[..], all[..2]);
            assert_eq!(Basis::<1, WIDTH>::at(&KNOTS, 3, 7, t).rows[..], all[..1]);
        }
        let line = Basis::<3, WIDTH>::at(&[0.0, 0.0, 2.0, 2.0], 1, 2, 0.5).rows;
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
