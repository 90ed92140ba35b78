//! Eleven domains, dense at the boundary and sparse away from it.

use crate::domain::Domain;
use crate::domain::naca::{circle, symmetric_section};
use crate::draw::View;
use crate::point::Point2;
use std::f64::consts::TAU;

/// How many boundary points a domain has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// About a quarter, for a quick look.
    Small,
    /// All.
    Full,
}

impl Detail {
    /// A number of points: even, and at least 4.
    fn count(self, full: u32) -> u32 {
        match self {
            Self::Full => full,
            Self::Small => (full / 8 * 2).max(4),
        }
    }

    /// A ratio of neighbouring edges that spans as much with fewer edges.
    fn ratio(self, full: f64) -> f64 {
        match self {
            Self::Full => full,
            Self::Small => libm::pow(full, 4.0).clamp(0.5, 2.0),
        }
    }
}

/// A domain of the study.
#[derive(Clone, Copy, Debug)]
pub struct StudyDomain {
    /// Name in tables and files.
    pub name: &'static str,
    /// A heading.
    pub title: &'static str,
    /// What it is and what it is hard for.
    pub about: &'static str,
    /// The part that close-ups show.
    pub close_up: View,
    /// Makes it.
    pub make: fn(Detail) -> Domain,
}

/// All domains, the airfoil first.
pub const DOMAINS: [StudyDomain; 11] = [
    StudyDomain {
        name: "airfoil",
        title: "Airfoil",
        about: "NACA 0012 in a circle of 15 chords: edge lengths from a thousandth of a chord to \
                one and a half chords.",
        close_up: view(-0.25, -0.45, 1.25, 0.45),
        make: airfoil,
    },
    StudyDomain {
        name: "clashing-fronts",
        title: "Clashing fronts",
        about: "A rectangle with a fine wall below and a coarse one above: fronts of triangles of \
                different sizes meet.",
        close_up: view(0.55, 0.0, 1.45, 0.54),
        make: clashing_fronts,
    },
    StudyDomain {
        name: "slivers",
        title: "Eccentric ring",
        about: "A fine circle close to a coarse one: where the gap is narrow the coarse edges see \
                fine ones, which is where slivers come from.",
        close_up: view(0.6, -0.23, 1.02, 0.03),
        make: eccentric_ring,
    },
    StudyDomain {
        name: "cylinder",
        title: "Cylinder in a channel",
        about: "The flow benchmark's channel, 2.2 long and 0.41 high, with a fine cylinder near \
                the inlet.",
        close_up: view(0.08, 0.08, 0.48, 0.32),
        make: cylinder,
    },
    StudyDomain {
        name: "holes",
        title: "Plate with holes",
        about: "Fifteen holes of different radii and densities in a coarse plate.",
        close_up: view(0.2, 0.1, 1.8, 1.06),
        make: plate_with_holes,
    },
    StudyDomain {
        name: "three-element",
        title: "Three-element airfoil",
        about: "Slat, main element and flap with narrow slots between them.",
        close_up: view(-0.2, -0.35, 1.1, 0.43),
        make: three_element,
    },
    StudyDomain {
        name: "narrow-passage",
        title: "Narrow passage",
        about: "Two chambers joined by a channel a fiftieth as wide.",
        close_up: view(0.9, 0.34, 1.43, 0.66),
        make: narrow_passage,
    },
    StudyDomain {
        name: "star",
        title: "Star",
        about: "Nine sharp outward and nine reflex corners, fine at the tips.",
        close_up: view(0.3, -0.2, 1.0, 0.22),
        make: star,
    },
    StudyDomain {
        name: "nozzle",
        title: "Nozzle",
        about: "A convergent-divergent channel whose walls are fine at the throat.",
        close_up: view(-0.25, -0.15, 0.25, 0.15),
        make: nozzle,
    },
    StudyDomain {
        name: "lake",
        title: "Lake with islands",
        about: "A fractal coast and three fractal islands: corners everywhere, open water between.",
        close_up: view(-0.1, -0.02, 0.5, 0.34),
        make: lake,
    },
    StudyDomain {
        name: "crack",
        title: "Crack",
        about: "A square with a thin wedge cut out; edges shrink towards its tip by two orders of \
                magnitude.",
        close_up: view(-0.12, -0.072, 0.12, 0.072),
        make: crack,
    },
];

const fn view(x0: f64, y0: f64, x1: f64, y1: f64) -> View {
    View { x0, y0, x1, y1 }
}

/// From `a` to `b`, without `b`, in `n` edges each `ratio` times as long as the one before.
fn side(a: Point2, b: Point2, n: u32, ratio: f64) -> Vec<Point2> {
    let power = |k: u32| libm::pow(ratio, f64::from(k));
    let whole: f64 = (0..n).map(power).sum();
    let mut along = 0.0;
    let mut points = Vec::new();
    for k in 0..n {
        let t = along / whole;
        points.push(Point2::new(a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)));
        along += power(k);
    }
    points
}

/// The closed polygon through `corners`; side i is cut into `cuts[i]` edges that grow by
/// `ratios[i]`, both taken in turn.
fn polygon(corners: &[[f64; 2]], cuts: &[u32], ratios: &[f64]) -> Vec<Point2> {
    let corner = |i: usize| Point2::from(corners[i % corners.len()]);
    (0..corners.len())
        .flat_map(|i| {
            side(corner(i), corner(i + 1), cuts[i % cuts.len()], ratios[i % ratios.len()])
        })
        .collect()
}

fn airfoil(detail: Detail) -> Domain {
    let far = circle(Point2::new(0.5, 0.0), 15.0, detail.count(60));
    Domain::of_rings(&[far, symmetric_section(0.12, detail.count(200))])
}

fn clashing_fronts(detail: Detail) -> Domain {
    let up = detail.ratio(1.4);
    let (bottom, wall) = (detail.count(96), if detail == Detail::Full { 9 } else { 4 });
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
    Domain::of_rings(&[polygon(&corners, &[bottom, wall, 5, wall], &[1.0, up, 1.0, 1.0 / up])])
}

fn eccentric_ring(detail: Detail) -> Domain {
    let outer = circle(Point2::new(0.0, 0.0), 1.0, detail.count(64));
    Domain::of_rings(&[outer, circle(Point2::new(0.5, 0.0), 0.35, detail.count(120))])
}

fn cylinder(detail: Detail) -> Domain {
    let corners = [[0.0, 0.0], [2.2, 0.0], [2.2, 0.41], [0.0, 0.41]];
    let (long, high) = (detail.count(44), detail.count(8));
    let channel = polygon(&corners, &[long, high], &[1.0]);
    Domain::of_rings(&[channel, circle(Point2::new(0.2, 0.2), 0.05, detail.count(80))])
}

fn plate_with_holes(detail: Detail) -> Domain {
    let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.4], [0.0, 2.4]];
    let mut all = vec![polygon(&corners, &[detail.count(20), detail.count(12)], &[1.0])];
    for i in 0..15 {
        let centre = Point2::new(0.4 + 0.8 * f64::from(i % 5), 0.4 + 0.8 * f64::from(i / 5));
        let radius = 0.06 + 0.03 * f64::from((i * 7) % 8);
        all.push(circle(centre, radius, detail.count(24 + 12 * ((i * 5) % 4))));
    }
    Domain::of_rings(&all)
}

/// A NACA 0012 section of the given chord, turned by `down` degrees clockwise about its nose.
fn element(nose: [f64; 2], chord: f64, down: f64, points: u32) -> Vec<Point2> {
    let (sin, cos) = libm::sincos(-down.to_radians());
    let place = |p: &Point2| {
        let (x, y) = (chord * p.x, chord * p.y);
        Point2::new(nose[0] + cos * x - sin * y, nose[1] + sin * x + cos * y)
    };
    symmetric_section(0.12, points).iter().map(place).collect()
}

fn three_element(detail: Detail) -> Domain {
    Domain::of_rings(&[
        circle(Point2::new(0.5, 0.0), 12.0, detail.count(48)),
        element([-0.12, -0.06], 0.15, -35.0, detail.count(80)),
        element([0.04, 0.0], 0.7, 0.0, detail.count(160)),
        element([0.72, -0.06], 0.3, 30.0, detail.count(100)),
    ])
}

fn narrow_passage(detail: Detail) -> Domain {
    let (low, high) = (0.49, 0.51);
    let right = [[1.0, 0.0], [1.0, low], [1.5, low], [1.5, 0.0], [2.5, 0.0], [2.5, 1.0]];
    let left = [[1.5, 1.0], [1.5, high], [1.0, high], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]];
    let corners: Vec<[f64; 2]> = right.into_iter().chain(left).collect();
    // Walls beside the mouths shrink towards them, from a tenth to the channel's edges.
    let (wall, channel) = (10, if detail == Detail::Full { 50 } else { 26 });
    let (to, from) = (0.78, 1.0 / 0.78);
    let cuts = [wall, channel, wall, 10, 10, 10, wall, channel, wall, 10, 10, 10];
    let ratios = [to, 1.0, from, 1.0, 1.0, 1.0, to, 1.0, from, 1.0, 1.0, 1.0];
    Domain::of_rings(&[polygon(&corners, &cuts, &ratios)])
}

fn star(detail: Detail) -> Domain {
    let spikes = 9;
    let corner = |i: u32| {
        let radius = if i.is_multiple_of(2) { 1.0 } else { 0.35 };
        let angle = TAU * f64::from(i) / f64::from(2 * spikes);
        [radius * libm::cos(angle), radius * libm::sin(angle)]
    };
    let corners: Vec<[f64; 2]> = (0..2 * spikes).map(corner).collect();
    let from_tip = detail.ratio(1.12);
    Domain::of_rings(&[polygon(&corners, &[detail.count(16)], &[from_tip, 1.0 / from_tip])])
}

/// Walls y = ±(0.1 + 0.25 x²), x from -1 to 1.5, with points the denser the nearer to the throat.
fn nozzle(detail: Detail) -> Domain {
    let half = |x: f64| 0.1 + 0.25 * x * x;
    let count = detail.count(96);
    let wall = |side: f64| {
        (0..=count).map(move |k| {
            let t = 2.0 * f64::from(k) / f64::from(count) - 1.0;
            let x = libm::copysign(libm::pow(t.abs(), 1.5), t) * if t > 0.0 { 1.5 } else { 1.0 };
            Point2::new(x, side * half(x))
        })
    };
    let end = |x: f64, side: f64, n: u32| {
        let (a, b) = (Point2::new(x, -side * half(x)), Point2::new(x, side * half(x)));
        side_inner(a, b, n)
    };
    let mut ring: Vec<Point2> = wall(-1.0).collect();
    ring.extend(end(1.5, 1.0, detail.count(24)));
    ring.extend(wall(1.0).collect::<Vec<_>>().into_iter().rev());
    ring.extend(end(-1.0, -1.0, detail.count(20)));
    Domain::of_rings(&[ring])
}

/// Between `a` and `b`, without either, in `n` equal edges.
fn side_inner(a: Point2, b: Point2, n: u32) -> Vec<Point2> {
    side(a, b, n, 1.0).split_off(1)
}

fn lake(detail: Detail) -> Domain {
    let depth = if detail == Detail::Full { 4 } else { 3 };
    let mut all = vec![koch([0.0, 0.0], 1.0, depth)];
    for i in 0..3 {
        let angle = TAU * (f64::from(i) / 3.0 + 0.08);
        let centre = [0.27 * libm::cos(angle), 0.27 * libm::sin(angle)];
        all.push(koch(centre, 0.11, depth - 1));
    }
    Domain::of_rings(&all)
}

/// A Koch curve around a triangle of the given circumradius: 3 * 4^depth edges.
fn koch([x, y]: [f64; 2], radius: f64, depth: u32) -> Vec<Point2> {
    let corner = |i: u32| {
        let angle = -TAU * f64::from(i) / 3.0;
        Point2::new(x + radius * libm::cos(angle), y + radius * libm::sin(angle))
    };
    let mut points: Vec<Point2> = (0..3).map(corner).collect();
    for _ in 0..depth {
        let next = points.iter().cycle().skip(1);
        points = points.iter().zip(next).flat_map(|(&a, &b)| bump(a, b)).collect();
    }
    points
}

/// A Koch step flattened to a quarter of the length, so that no two bumps touch.
fn bump(a: Point2, b: Point2) -> [Point2; 4] {
    let (dx, dy) = (b.x - a.x, b.y - a.y);
    let along = |t: f64, up: f64| Point2::new(a.x + t * dx - up * dy, a.y + t * dy + up * dx);
    [a, along(0.34, 0.0), along(0.5, 0.25), along(0.66, 0.0)]
}

fn crack(detail: Detail) -> Domain {
    let (shrink, lip) = (detail.ratio(0.82), if detail == Detail::Full { 26 } else { 9 });
    let corners = [
        [-1.0, -0.01],
        [-1.0, -1.0],
        [1.0, -1.0],
        [1.0, 1.0],
        [-1.0, 1.0],
        [-1.0, 0.01],
        [0.0, 0.0],
    ];
    let cuts = [5, 10, 10, 10, 5, lip, lip];
    Domain::of_rings(&[polygon(&corners, &cuts, &[1.0, 1.0, 1.0, 1.0, 1.0, shrink, 1.0 / shrink])])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::validate::validate;
    use std::collections::BTreeSet;

    // spec: K31
    #[test]
    fn every_domain_is_sound_in_both_sizes_and_names_differ() {
        let names: BTreeSet<&str> = DOMAINS.iter().map(|d| d.name).collect();
        assert_eq!(names.len(), 11);
        assert_eq!(DOMAINS[0].name, "airfoil");
        for study in &DOMAINS {
            let [small, full] = [Detail::Small, Detail::Full].map(|d| (study.make)(d));
            for domain in [&small, &full] {
                assert!(validate(domain).is_ok(), "{}: {:?}", study.name, validate(domain));
            }
            assert!(small.points.len() < full.points.len(), "{}", study.name);
        }
    }

    // spec: K31
    #[test]
    fn every_close_up_shows_some_of_the_boundary() {
        for study in &DOMAINS {
            let View { x0, y0, x1, y1 } = study.close_up;
            assert!(study.close_up.is_proper());
            let domain = (study.make)(Detail::Full);
            let is_shown = |p: &&Point2| (x0..x1).contains(&p.x) && (y0..y1).contains(&p.y);
            assert!(domain.points.iter().filter(is_shown).count() >= 5, "{}", study.name);
        }
    }

    #[test]
    fn sides_grow_by_their_ratio_and_leave_out_their_end() {
        let points = side(Point2::new(0.0, 0.0), Point2::new(7.0, 0.0), 3, 2.0);
        let x: Vec<f64> = points.iter().map(|p| p.x).collect();
        assert_eq!(x, [0.0, 1.0, 3.0]);
        assert_eq!(side_inner(Point2::new(0.0, 0.0), Point2::new(4.0, 0.0), 4).len(), 3);
    }
}
