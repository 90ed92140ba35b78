//! The energy of a vertex: how far the triangles around it are from equilateral, and the step that
//! lowers it.
//!
//! The energy is the sum over the triangles of f^2, where f = (sum of squared sides) /
//! (4 sqrt(3) area) is the inverse mean ratio (Knupp, "Algebraic mesh quality metrics", 2001): 1 for
//! an equilateral triangle, infinite for a flat one, smooth between, and free of square roots. Near
//! 1 it is R/(2r) up to a factor: R/(2r) - 1 = 9/8 (f - 1) to second order. Of bad triangles they think
//! differently: f takes a flat one with an angle near 180 degrees for far better than R/(2r) does, so
//! among these R/(2r) must not rise either.

use crate::point::Point2;
use crate::predicates::{Sign, orient2d};

const TWO_SQRT_3: f64 = 3.464_101_615_137_754_6;

/// The inverse mean ratio of a triangle, at least 1; infinite for one that is not counterclockwise.
#[inline]
pub(super) fn inverse_mean_ratio(a: Point2, b: Point2, c: Point2) -> f64 {
    let double_area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    let squares = a.distance_sq(b) + b.distance_sq(c) + c.distance_sq(a);
    if double_area > 0.0 { squares / (TWO_SQRT_3 * double_area) } else { f64::INFINITY }
}

/// Triangles with a larger inverse mean ratio are measured by R/(2r), too.
pub(super) const POOR: f64 = 1.3;

/// R/(2r) of a triangle whose inverse mean ratio f calls for it; 1 for others.
pub(super) fn aspect_of_poor(f: f64, [a, b, c]: [Point2; 3]) -> f64 {
    if f <= POOR {
        return 1.0;
    }
    let [a, b, c] = [b.distance(c), c.distance(a), a.distance(b)];
    let denominator = (b + c - a) * (c + a - b) * (a + b - c);
    if denominator > 0.0 { a * b * c / denominator } else { f64::INFINITY }
}

/// The worst R/(2r) of the poor triangles around `v`, at least 1.
fn poor_aspect(v: Point2, link: &[Point2]) -> f64 {
    let before = link.iter().skip(link.len() - 1).chain(link);
    let corners = before.zip(link).map(|(&u, &w)| [v, u, w]);
    let aspect = |[v, u, w]: [Point2; 3]| aspect_of_poor(inverse_mean_ratio(v, u, w), [v, u, w]);
    corners.map(aspect).fold(1.0, f64::max)
}

/// Whether a move leaves the worst poor triangle of the star as it is or better.
fn is_no_poorer(from: Point2, to: Point2, link: &[Point2], now: &Energy) -> bool {
    now.worst <= POOR * TWO_SQRT_3 || poor_aspect(to, link) <= poor_aspect(from, link)
}

/// An edge out of the vertex, and its squared length.
#[derive(Clone, Copy)]
struct Spoke {
    x: f64,
    y: f64,
    square: f64,
}

impl Spoke {
    #[inline]
    fn new(from: Point2, to: Point2) -> Self {
        let (x, y) = (to.x - from.x, to.y - from.y);
        Self { x, y, square: x * x + y * y }
    }
}

/// Energy, its gradient and Hessian, and the worst inverse mean ratio (unscaled) of a star.
struct Energy {
    value: f64,
    worst: f64,
    gradient: [f64; 2],
    hessian: [f64; 3],
}

impl Energy {
    fn of(v: Point2, link: &[Point2]) -> Self {
        let mut sum = Self { value: 0.0, worst: 0.0, gradient: [0.0; 2], hessian: [0.0; 3] };
        let mut before = Spoke::new(v, link[link.len() - 1]);
        for &u in link {
            let spoke = Spoke::new(v, u);
            sum.add(before, spoke);
            before = spoke;
        }
        sum
    }

    /// Adds the triangle of two spokes: f = q / a with q the squared sides and a twice the area.
    #[inline]
    fn add(&mut self, u: Spoke, w: Spoke) {
        let (ex, ey) = (w.x - u.x, w.y - u.y);
        let a = u.x * w.y - u.y * w.x;
        let per_a = 1.0 / a;
        let f = (u.square + w.square + (ex * ex + ey * ey)) * per_a;
        // d(2 area)/dv is the edge u -> w turned a quarter: (-ey, ex); dq/dv = -2 (u + w - 2 v).
        let gx = (f * ey - 2.0 * (u.x + w.x)) * per_a;
        let gy = (-f * ex - 2.0 * (u.y + w.y)) * per_a;
        let (along, across) = (gx * ex, gy * ey);
        let scale = f * per_a;
        self.value += f * f;
        self.worst = if a > 0.0 { self.worst.max(f) } else { f64::INFINITY };
        self.gradient[0] += f * gx;
        self.gradient[1] += f * gy;
        self.hessian[0] += gx * gx + scale * (4.0 + 2.0 * gx * ey);
        self.hessian[1] += gx * gy + scale * (across - along);
        self.hessian[2] += gy * gy + scale * (4.0 - 2.0 * gy * ex);
    }

    /// The Newton step, or `None` where the energy is not convex.
    fn step(&self) -> Option<[f64; 2]> {
        let [xx, xy, yy] = self.hessian;
        let [gx, gy] = self.gradient;
        let determinant = xx * yy - xy * xy;
        (determinant > 0.0 && xx > 0.0)
            .then(|| [(xy * gy - yy * gx) / determinant, (xy * gx - xx * gy) / determinant])
    }
}

/// Whether the star of `v` has less energy than `now` and no triangle worse than its worst.
fn is_better(v: Point2, link: &[Point2], now: &Energy) -> bool {
    let mut value = 0.0;
    let mut worst = 0.0_f64;
    let mut u = Spoke::new(v, link[link.len() - 1]);
    for &end in link {
        let w = Spoke::new(v, end);
        let (ex, ey) = (w.x - u.x, w.y - u.y);
        let a = u.x * w.y - u.y * w.x;
        let f = (u.square + w.square + (ex * ex + ey * ey)) / a;
        value += f * f;
        worst = if a > 0.0 { worst.max(f) } else { f64::INFINITY };
        u = w;
    }
    value < now.value && worst <= now.worst
}

/// Newton's step, then halves of it.
const TRIES: u32 = 3;

/// A place for the vertex `v` in its link that is better and valid, if a step finds one.
pub(super) fn better_place(
    v: Point2,
    link: &[Point2],
    quantum: Option<f64>,
    step_min: f64,
) -> Option<Point2> {
    let now = Energy::of(v, link);
    let [mut dx, mut dy] = now.step()?;
    let least_sq = step_min * step_min * v.distance_sq(link[0]);
    for _ in 0..TRIES {
        if dx * dx + dy * dy < least_sq {
            return None;
        }
        let place = Point2::new(v.x + dx, v.y + dy);
        let place = quantum.map_or(place, |q| place.rounded_to(q));
        if is_better(place, link, &now)
            && is_no_poorer(v, place, link, &now)
            && is_valid(place, link)
        {
            return Some(place);
        }
        (dx, dy) = (0.5 * dx, 0.5 * dy);
    }
    None
}

/// Whether all triangles of the star are strictly counterclockwise, exactly.
pub(super) fn is_valid(v: Point2, link: &[Point2]) -> bool {
    let mut u = link[link.len() - 1];
    v.is_finite()
        && link.iter().all(|&w| {
            let is_left = orient2d(v, u, w) == Sign::Positive;
            u = w;
            is_left
        })
}
