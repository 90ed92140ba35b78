//! What a boundary forces: a number that the worst triangle of no mesh with these boundary edges
//! is below.
//!
//! The triangles at a corner of the boundary are a fan: their angles there add up to the corner's, and
//! the ratios of their sides multiply to that of the corner's two edges. A triangle of which R/(2r) is at
//! most q has bounds on both. With its angle A at the corner, its others B and C, and D = B - C,
//!
//! ```text
//! R/(2r) = 1 / (8 sin(A/2) sin(B/2) sin(C/2)) = 1 / (4 sin(A/2) (cos(D/2) - sin(A/2)))
//! ```
//!
//! so cos(D/2) >= sin(A/2) + 1 / (4 q sin(A/2)), and by the law of tangents the ratio of the two sides is
//! (1 + t) / (1 - t) with t = tan(A/2) tan(D/2). What angles A that add up to the corner's can reach at most
//! is found by dynamic programming over cells of angle with an upper bound of log((1 + t) / (1 - t)) in
//! each. If that is less than the logarithm of the corner's ratio, no fan has R/(2r) <= q throughout, and
//! no matter where its other vertices lie or how many there are.

use crate::mesh::Mesh;
use crate::point::Point2;
use std::collections::{HashMap, HashSet}; // lookups only
use std::f64::consts::{PI, TAU};

/// Cells that a corner's angle is cut into; the bound is low by about a part in this many, times the
/// number of triangles of the fan.
const CELLS: usize = 1024;
/// Steps of bisection.
const STEPS: u32 = 40;
/// Far more than what rounding makes of a logarithm, or of a sum of them.
const ROUNDING: f64 = 1e-9;
/// Triangles of the fans that are taken for an estimate.
const SIMILAR_MAX: u32 = 64;

/// A corner of a boundary and what it forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forced {
    /// Index of the corner's vertex.
    pub vertex: u32,
    /// R/(2r) that a triangle at the vertex has at least, in any mesh with the same boundary edges.
    pub aspect: f64,
}

/// Two edges of the boundary at a vertex with nothing but triangles between them.
#[derive(Clone, Copy, Debug)]
struct Corner {
    vertex: u32,
    angle: f64,
    /// Logarithm of the ratio of the longer edge to the shorter one.
    reach: f64,
}

/// What the boundary edges and constraints of `mesh` force: no triangulation that keeps them, whatever
/// vertices it has inside, has a worst triangle with R/(2r) below this. `None` for a mesh without a
/// corner between two of its edges.
///
/// Only the corner that promises most is examined, so another one may force a little more. Linear in
/// the mesh, and a fixed effort for that corner. Rounding in f64 is allowed for, not ruled out.
#[must_use]
pub fn forced_aspect(mesh: &Mesh) -> Option<Forced> {
    let promising = corners(mesh).into_iter().map(|corner| (corner.estimate(), corner));
    let (estimate, corner) = promising.reduce(|s, t| if t.0 > s.0 { t } else { s })?;
    Some(Forced { vertex: corner.vertex, aspect: corner.least_aspect(estimate) })
}

/// All corners of a mesh, in the order of its edges.
fn corners(mesh: &Mesh) -> Vec<Corner> {
    let mut apexes = HashMap::new();
    for &[a, b, c] in &mesh.triangles {
        apexes.extend([([a, b], c), ([b, c], a), ([c, a], b)]);
    }
    let ends = |[a, b]: [u32; 2]| [[a, b], [b, a]];
    let kept: HashSet<[u32; 2]> = mesh.edges.iter().flat_map(|e| ends(e.vertices)).collect();
    let sides = mesh.edges.iter().flat_map(|e| ends(e.vertices));
    let corner = |[v, u]: [u32; 2]| {
        let mut end = *apexes.get(&[v, u])?;
        // As many steps as a vertex can have triangles: a mesh from elsewhere may be none.
        let mut steps = mesh.triangles.len();
        while !kept.contains(&[v, end]) && steps > 0 {
            end = *apexes.get(&[v, end])?;
            steps -= 1;
        }
        let [v_at, u_at, end_at] = [v, u, end].map(|i| mesh.points.get(i as usize).copied());
        Corner::between(v, v_at?, [u_at?, end_at?])
    };
    sides.filter_map(corner).collect()
}

impl Corner {
    /// The corner at a vertex from one end counterclockwise to another; `None` where lengths are none.
    fn between(vertex: u32, at: Point2, ends: [Point2; 2]) -> Option<Self> {
        let [from, to] = ends.map(|p| libm::atan2(p.y - at.y, p.x - at.x));
        let [long, short] = ends.map(|p| libm::log(at.distance(p)));
        let turn = to - from;
        let angle = if turn <= 0.0 { turn + TAU } else { turn };
        let reach = (long - short).abs();
        reach.is_finite().then_some(Self { vertex, angle, reach })
    }

    /// The worst R/(2r) of the best fan of similar triangles: near the bound, and not below it.
    fn estimate(&self) -> f64 {
        let aspect = |k: u32| {
            let (angle, ratio) = (self.angle / f64::from(k), libm::exp(self.reach / f64::from(k)));
            aspect_of_two_sides(angle, ratio)
        };
        (1..=SIMILAR_MAX).map(aspect).fold(f64::INFINITY, f64::min)
    }

    /// A number that the worst R/(2r) of no fan here is below, no more than `most`.
    fn least_aspect(&self, most: f64) -> f64 {
        let (mut low, mut high) = (1.0, most.min(f64::MAX));
        for _ in 0..STEPS {
            let middle = 0.5 * low + 0.5 * high;
            if self.is_out_of_reach(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }

    /// Whether no fan of triangles with R/(2r) up to `aspect` leads from one edge to the other.
    fn is_out_of_reach(&self, aspect: f64) -> bool {
        let width = self.angle / CELLS as f64;
        let cell = |k: usize| reach_in(k as f64 * width, (k + 1) as f64 * width, aspect);
        let reaches: Vec<(usize, f64)> =
            (0..=CELLS).filter_map(|k| cell(k).map(|reach| (k, reach))).collect();
        let Some(&(least, _)) = reaches.first() else { return true };
        if least == 0 {
            return false;
        }
        // For each number of cells the farthest reach of triangles that take as many, each rounded down.
        let mut farthest = vec![f64::NEG_INFINITY; CELLS + 1];
        farthest[0] = 0.0;
        for used in least..=CELLS {
            let ways = reaches.iter().take_while(|(k, _)| *k <= used);
            farthest[used] = ways
                .map(|&(k, reach)| reach + farthest[used - k])
                .fold(f64::NEG_INFINITY, f64::max);
        }
        // All triangles together are rounded down by less than their number.
        let triangles_max = CELLS / least;
        let farthest = farthest[CELLS - triangles_max.min(CELLS)..].iter().copied();
        let most = farthest.fold(f64::NEG_INFINITY, f64::max);
        most + ROUNDING < self.reach
    }
}

/// The largest logarithm of the ratio of two sides with an angle between `low` and `high`, or more, in a
/// triangle with R/(2r) up to `aspect`; `None` when there is no such triangle.
fn reach_in(low: f64, high: f64, aspect: f64) -> Option<f64> {
    if low >= PI {
        return None;
    }
    let high = high.min(PI);
    let [from, to] = [low, high].map(|angle| libm::sin(0.5 * angle));
    // s + 1 / (4 q s) is least at s = 1 / (2 sqrt(q)).
    let sine = (0.5 / aspect.sqrt()).clamp(from, to);
    let cosine = sine + 0.25 / (aspect * sine);
    if cosine > 1.0 + ROUNDING {
        return None;
    }
    let cosine = cosine.min(1.0);
    let t = libm::tan(0.5 * high) * (1.0 - cosine * cosine).max(0.0).sqrt() / cosine;
    Some(if (0.0..1.0).contains(&t) { 2.0 * libm::atanh(t) } else { f64::INFINITY })
}

/// R/(2r) of a triangle with an angle between sides of a ratio; infinite when there is none.
fn aspect_of_two_sides(angle: f64, ratio: f64) -> f64 {
    if angle >= PI {
        return f64::INFINITY;
    }
    let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
    let opposite = (1.0 + ratio * ratio - 2.0 * ratio * cosine).max(0.0).sqrt();
    let double_area = ratio * sine;
    let aspect = ratio * opposite * (1.0 + ratio + opposite) / (4.0 * double_area * double_area);
    if aspect.is_nan() { f64::INFINITY } else { aspect }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::MarkedEdge;

    fn corner(degrees: f64, ratio: f64) -> Corner {
        Corner { vertex: 0, angle: degrees.to_radians(), reach: libm::log(ratio) }
    }

    /// Angles and ratios of corners, from needles to reflex ones.
    const CORNERS: [(f64, f64); 8] = [
        (12.0, 1.5),
        (60.0, 4.0),
        (81.0, 11.7),
        (90.0, 1000.0),
        (100.0, 5.6),
        (180.0, 1000.0),
        (270.0, 30.0),
        (350.0, 1e4),
    ];

    /// Pseudo-random numbers between 0 and 1.
    fn numbers() -> impl FnMut() -> f64 {
        let mut state = 12_345_u64;
        move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        }
    }

    // spec: I23
    #[test]
    fn no_fan_is_better_than_what_its_corner_forces() {
        let mut number = numbers();
        for (degrees, ratio) in CORNERS {
            let corner = corner(degrees, ratio);
            let bound = corner.least_aspect(corner.estimate());
            for _ in 0..4000 {
                let count = 1 + (number() * 9.0) as usize;
                let mut shares = || {
                    let parts: Vec<f64> = (0..count).map(|_| 0.3 + number()).collect();
                    let whole: f64 = parts.iter().sum();
                    parts.into_iter().map(move |part| part / whole).collect::<Vec<f64>>()
                };
                let (angles, logs) = (shares(), shares());
                let aspects = angles.iter().zip(&logs).map(|(angle, log)| {
                    aspect_of_two_sides(angle * corner.angle, libm::exp(log * corner.reach))
                });
                let worst = aspects.fold(1.0, f64::max);
                assert!(worst >= bound, "{degrees} degrees, {ratio}: {worst} < {bound}");
            }
        }
    }

    // spec: I23
    #[test]
    fn fans_of_similar_triangles_come_near_what_is_forced() {
        for (degrees, ratio) in CORNERS {
            let corner = corner(degrees, ratio);
            let (bound, fan) = (corner.least_aspect(corner.estimate()), corner.estimate());
            assert!(bound <= fan && bound > 0.97 * fan, "{degrees}, {ratio}: {bound} of {fan}");
        }
    }

    // spec: I23
    #[test]
    fn a_corner_that_fits_equilateral_triangles_forces_nothing() {
        for degrees in [60.0, 120.0, 180.0, 300.0, 360.0] {
            let bound = corner(degrees, 1.0).least_aspect(2.0);
            assert!(bound < 1.001, "{degrees}: {bound}");
        }
    }

    /// The unit square with a vertex at (x, 0) on its lower side, in three triangles.
    fn square(x: f64) -> Mesh {
        let points = [[0.0, 0.0], [x, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let edges = (0..5).map(|i| MarkedEdge { vertices: [i, (i + 1) % 5], marker: 1 });
        Mesh {
            points: points.map(Point2::from).to_vec(),
            triangles: vec![[0, 1, 4], [1, 3, 4], [1, 2, 3]],
            edges: edges.collect(),
            regions: Vec::new(),
        }
    }

    // spec: I23
    #[test]
    fn the_corner_with_the_largest_jump_is_the_one() {
        let forced = forced_aspect(&square(1e-3)).expect("a corner");
        // 1000 : 1 at a right angle; a fan of equal triangles has 16.1.
        assert_eq!(forced.vertex, 0);
        assert!((15.6..=16.1).contains(&forced.aspect), "{forced:?}");
        let forced = forced_aspect(&square(0.5)).expect("a corner");
        assert!(forced.aspect < 1.3, "{forced:?}");
    }

    // spec: I23
    #[test]
    fn a_constraint_parts_a_corner_in_two() {
        let mut mesh = square(0.5);
        let whole = forced_aspect(&mesh).expect("a corner").aspect;
        // The edge to (0, 1) leaves angles of 63 and 117 degrees on either side.
        mesh.edges.push(MarkedEdge { vertices: [1, 4], marker: 2 });
        let parted: Vec<Corner> = corners(&mesh).into_iter().filter(|c| c.vertex == 1).collect();
        assert_eq!(parted.len(), 2);
        assert!((parted[0].angle + parted[1].angle - PI).abs() < 1e-12);
        assert!(forced_aspect(&mesh).expect("corners").aspect >= whole - 1e-9);
    }

    // spec: !I23
    #[test]
    fn a_mesh_without_corners_forces_nothing() {
        assert_eq!(forced_aspect(&Mesh::default()), None);
        let mut mesh = square(0.5);
        mesh.edges.clear();
        assert_eq!(forced_aspect(&mesh), None);
        // Edges and triangles that name no points, and an edge of no triangle.
        let mut mesh = square(0.5);
        mesh.points.truncate(1);
        mesh.edges.push(MarkedEdge { vertices: [7, 9], marker: 0 });
        assert_eq!(forced_aspect(&mesh), None);
        // Equal points have no logarithm of their distance.
        let mut mesh = square(0.5);
        mesh.points.fill(Point2::new(1.0, 1.0));
        assert_eq!(forced_aspect(&mesh), None);
    }
}
