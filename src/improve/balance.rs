//! Balance: last small moves, after which neighbours are nearer to each other in area and the worst
//! triangles less bad.
//!
//! Newton's steps on the sum of squared inverse mean ratios f stop where that sum is least. There it is
//! flat: a little away from it costs next to nothing, and what the sum does not see can be had for it.
//! So the vertex goes to where the sum over its star of
//!
//! ```text
//! f^2 + AREA (2 (A - A') / (A + A'))^2 + WORST max(0, max f - BAD)
//! ```
//!
//! is less, where A and A' are the areas of neighbours, one of which at least is in the star. The second
//! term is nearly the square of log(A / A') for neighbours of about the same area, and bounded for others.
//! The maximum has no derivative: a pattern search finds the place (Hooke and Jeeves, 1961).
//!
//! Stars with poor triangles are left alone: what is so bad after the search for topologies is the
//! boundary's doing, and makes its neighbours worse where it is to be made a little better.

use super::energy::{POOR, inverse_mean_ratio, is_valid};
use super::smooth::{Sheet, Smoother};
use crate::point::Point2;
use crate::triangulation::{HalfEdgeId, Triangulation};

/// What neighbours of different area cost.
const AREA: f64 = 0.3;
/// What the worst triangle of the star costs.
const WORST: f64 = 10.0;
/// Triangles with a larger inverse mean ratio are bad: R/(2r) is then about 1.07.
const BAD: f64 = 1.065;
/// Only where a triangle has a larger inverse mean ratio there is something to be had.
const UNEVEN: f64 = 1.03;
/// Steps over the distance to a neighbour.
const STEPS: [f64; 3] = [0.06, 0.03, 0.015];
/// Directions of the steps, a sixth of a turn apart.
const DIRECTIONS: [[f64; 2]; 6] = [
    [1.0, 0.0],
    [-1.0, 0.0],
    [0.5, 0.866_025_403_784_438_6],
    [-0.5, -0.866_025_403_784_438_6],
    [-0.5, 0.866_025_403_784_438_6],
    [0.5, -0.866_025_403_784_438_6],
];

/// A vertex and what is around it.
#[derive(Default)]
struct Star {
    link: Vec<Point2>,
    /// Twice the area of the triangle across each edge of the link, from one point to the next; 0
    /// where there is none.
    outer: Vec<f64>,
}

/// What a star costs, and the largest inverse mean ratio in it.
#[derive(Clone, Copy)]
struct Cost {
    sum: f64,
    worst: f64,
}

/// Moves vertices of a sheet a little, in index order, in some rounds each followed by flips: first those
/// with uneven triangles, then those around which something has moved. Returns the numbers of moves and
/// flips.
///
/// No move makes the worst triangle of its star worse, and validity is exact, as in smoothing.
pub(super) fn balance(smoother: &mut Smoother, sheet: &mut Sheet<'_>, rounds: u32) -> [u64; 2] {
    let (mut moves, mut flips) = (0, 0);
    let mut star = Star::default();
    let uneven = |corners: [Point2; 3]| {
        let [a, b, c] = corners;
        inverse_mean_ratio(a, b, c) > UNEVEN
    };
    smoother.wake_where(sheet, uneven);
    for _ in 0..rounds {
        let before = moves;
        for v in sheet.fixed..sheet.points.len() {
            let Some(start) = smoother.take_active(v) else { continue };
            if !star.gather(sheet.mesh, sheet.points, start) {
                continue;
            }
            if let Some(place) = star.better_place(sheet.points[v], sheet.quantum) {
                sheet.points[v] = place;
                smoother.wake_star(sheet.mesh, start);
                moves += 1;
            }
        }
        flips += smoother.flip(sheet);
        if moves == before {
            break;
        }
    }
    [moves, flips]
}

fn double_area([a, b, c]: [Point2; 3]) -> f64 {
    (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)
}

/// The square of twice the difference of two areas over their sum.
fn difference(a: f64, b: f64) -> f64 {
    let share = 2.0 * (a - b) / (a + b);
    share * share
}

impl Star {
    /// Becomes what is around the origin of `start`; `false` on the border.
    fn gather(&mut self, mesh: &Triangulation, points: &[Point2], start: HalfEdgeId) -> bool {
        self.link.clear();
        self.outer.clear();
        let at = |e: HalfEdgeId| mesh.corners(e.triangle()).map(|v| points[v.index()]);
        let mut e = start;
        loop {
            self.link.push(points[mesh.dest(e).index()]);
            self.outer.push(mesh.twin(e.next()).map_or(0.0, |twin| double_area(at(twin))));
            match mesh.rotate_ccw(e) {
                None => return false,
                Some(next) if next == start => return true,
                Some(next) => e = next,
            }
        }
    }

    fn cost(&self, v: Point2) -> Cost {
        let mut cost = Cost { sum: 0.0, worst: 0.0 };
        let last = self.link.len() - 1;
        let mut from = self.link[last];
        let mut before = double_area([v, self.link[last - 1], from]);
        let outer = self.outer[last..].iter().chain(&self.outer);
        for (&to, &outer) in self.link.iter().zip(outer) {
            let area = double_area([v, from, to]);
            let f = inverse_mean_ratio(v, from, to);
            cost.worst = cost.worst.max(f);
            cost.sum += f * f + AREA * difference(before, area);
            if outer > 0.0 {
                cost.sum += AREA * difference(area, outer);
            }
            (from, before) = (to, area);
        }
        cost.sum += WORST * (cost.worst - BAD).max(0.0);
        cost
    }

    /// A place for the vertex `v` that costs less and is no worse and valid, if the search finds one.
    fn better_place(&self, v: Point2, quantum: Option<f64>) -> Option<Point2> {
        let first = self.cost(v);
        if first.worst > POOR {
            return None;
        }
        let reach = v.distance(self.link[0]);
        let (mut best, mut least) = (v, first.sum);
        for step in STEPS {
            for [x, y] in DIRECTIONS {
                let place = Point2::new(best.x + step * reach * x, best.y + step * reach * y);
                let place = quantum.map_or(place, |q| place.rounded_to(q));
                let Cost { sum, worst } = self.cost(place);
                if sum < least && worst <= first.worst {
                    (best, least) = (place, sum);
                }
            }
        }
        (least < first.sum && is_valid(best, &self.link)).then_some(best)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::improve::flip_to_delaunay;
    use crate::predicates::{Sign, orient2d};
    use crate::triangulation::VertexId;

    /// A rhombus of a lattice, its inner vertices moved by up to `shift` of an edge; the border's
    /// vertices come first.
    fn lattice(n: u32, shift: f64) -> (Triangulation, Vec<Point2>, usize) {
        let mut state = 1_u64;
        let mut number = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            2.0 * ((state >> 11) as f64 / (1_u64 << 53) as f64) - 1.0
        };
        let is_border = |i: u32, j: u32| i == 0 || j == 0 || i == n || j == n;
        let mut sites: Vec<(u32, u32)> =
            (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j))).collect();
        sites.sort_by_key(|&(i, j)| !is_border(i, j));
        let fixed = sites.iter().filter(|&&(i, j)| is_border(i, j)).count();
        let points: Vec<Point2> = sites
            .iter()
            .map(|&(i, j)| {
                let reach = if is_border(i, j) { 0.0 } else { shift };
                let (x, y) = (f64::from(i) + 0.5 * f64::from(j), 0.75_f64.sqrt() * f64::from(j));
                Point2::new(x + reach * number(), y + reach * number())
            })
            .collect();
        let place = |i: u32, j: u32| sites.iter().position(|&site| site == (i, j)).expect("a site");
        let mut mesh = Triangulation::default();
        let corners = (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).flat_map(|(i, j)| {
            let [a, b, c, d] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            [[a, b, d], [b, c, d]]
        });
        for triangle in corners {
            mesh.add(triangle.map(|(i, j)| VertexId(place(i, j) as u32)));
        }
        let edges: Vec<HalfEdgeId> = mesh.triangles().flat_map(|t| t.half_edges()).collect();
        for &e in &edges {
            let back = |f: &&HalfEdgeId| {
                mesh.origin(**f) == mesh.dest(e) && mesh.dest(**f) == mesh.origin(e)
            };
            if let Some(&f) = edges.iter().find(back).filter(|&&f| e < f) {
                mesh.link(e, f);
            }
        }
        flip_to_delaunay(&mut mesh, &points);
        (mesh, points, fixed)
    }

    /// The largest inverse mean ratio, and the sum of what neighbours of different area cost.
    fn figures(mesh: &Triangulation, points: &[Point2]) -> [f64; 2] {
        let at = |e: HalfEdgeId| mesh.corners(e.triangle()).map(|v| points[v.index()]);
        let edges = mesh.triangles().flat_map(|t| t.half_edges());
        let pairs = edges.filter_map(|e| Some([at(e), at(mesh.twin(e)?)].map(double_area)));
        let areas = pairs.map(|[a, b]| difference(a, b)).sum();
        let ratio = |[a, b, c]: [Point2; 3]| inverse_mean_ratio(a, b, c);
        let worst = mesh.triangles().map(|t| ratio(at(t.half_edges()[0]))).fold(0.0, f64::max);
        [worst, areas]
    }

    // spec: I24 I1 I2
    #[test]
    fn areas_come_nearer_and_the_worst_triangle_gets_no_worse() {
        for shift in [0.1, 0.12, 0.15] {
            let (mut mesh, mut points, fixed) = lattice(9, shift);
            let given = points.clone();
            let [worst, areas] = figures(&mesh, &points);
            assert!(worst < POOR, "{shift}: a lattice without poor triangles, not {worst}");
            let mut smoother = Smoother::new(&mesh, points.len());
            let mut sheet = Sheet { mesh: &mut mesh, points: &mut points, fixed, quantum: None };
            let [moves, _] = balance(&mut smoother, &mut sheet, 3);
            assert!(moves > 0, "{shift}");
            let [worst_then, areas_then] = figures(&mesh, &points);
            assert!(
                worst_then <= worst && areas_then < 0.7 * areas,
                "{shift}: {areas_then} {areas}"
            );
            assert_eq!(points[..fixed], given[..fixed]);
            for t in mesh.triangles() {
                let [a, b, c] = mesh.corners(t).map(|v| points[v.index()]);
                assert_eq!(orient2d(a, b, c), Sign::Positive);
            }
        }
    }

    // spec: I24
    #[test]
    fn new_places_are_multiples_of_the_quantum() {
        let quantum = 1.0 / 64.0;
        let (mut mesh, mut points, fixed) = lattice(7, 0.15);
        let given = points.clone();
        let mut smoother = Smoother::new(&mesh, points.len());
        let mut sheet =
            Sheet { mesh: &mut mesh, points: &mut points, fixed, quantum: Some(quantum) };
        let [moves, _] = balance(&mut smoother, &mut sheet, 2);
        assert!(moves > 0);
        for (p, _) in points.iter().zip(&given).filter(|(p, q)| p != q) {
            assert_eq!(*p, p.rounded_to(quantum));
        }
    }

    // spec: !I24
    #[test]
    fn a_perfect_lattice_and_stars_with_poor_triangles_are_left_alone() {
        let (mut mesh, points, fixed) = lattice(6, 0.0);
        let mut smoother = Smoother::new(&mesh, points.len());
        let mut moved = points.clone();
        let mut sheet = Sheet { mesh: &mut mesh, points: &mut moved, fixed, quantum: None };
        assert_eq!(balance(&mut smoother, &mut sheet, 3), [0, 0]);
        assert_eq!(moved, points);
        // One side of the star is a quarter as long as the others.
        let link = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [-0.9, -0.25], [0.0, -1.0]];
        let star = Star { link: link.map(Point2::from).to_vec(), outer: vec![1.0; 5] };
        let centre = Point2::new(0.0, 0.0);
        assert!(star.cost(centre).worst > POOR);
        assert_eq!(star.better_place(centre, None), None);
    }
}
