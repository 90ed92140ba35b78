//! Properties of validation, and its agreement with brute force in exact integers.

use proptest::prelude::*;
use std::collections::BTreeSet;
use trigrade::domain::validate::{Fault, Owner, Plc, validate};
use trigrade::domain::{Domain, Inside, Loop, LoopRole, Region, Segment};
use trigrade::point::Point2;

fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() }
}

type Lattice = [i64; 2];

fn cross(a: Lattice, b: Lattice, c: Lattice) -> i64 {
    ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).signum()
}

fn point(p: Lattice) -> Point2 {
    Point2::new(p[0] as f64, p[1] as f64)
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Meeting {
    Crossing,
    Overlap,
}

/// How two segments meet that may not, from the definition.
fn meeting([a, b]: [Lattice; 2], [c, d]: [Lattice; 2]) -> Option<Meeting> {
    let (ab, cd) = ([cross(a, b, c), cross(a, b, d)], [cross(c, d, a), cross(c, d, b)]);
    if ab == [0, 0] {
        let (s, t) = ([a.min(b), a.max(b)], [c.min(d), c.max(d)]);
        return (s[0].max(t[0]) < s[1].min(t[1])).then_some(Meeting::Overlap);
    }
    (ab[0] * ab[1] < 0 && cd[0] * cd[1] < 0).then_some(Meeting::Crossing)
}

/// Points of a small lattice, each listed once, and segments between them.
fn pslg(size: i64, segments: usize) -> impl Strategy<Value = Vec<[Lattice; 2]>> {
    let vertex = move || prop::array::uniform2(0..size);
    let segment = prop::array::uniform2(vertex());
    prop::collection::vec(segment, 0..segments)
        .prop_map(|list| list.into_iter().filter(|[a, b]| a != b).collect())
}

fn carve(segments: &[[Lattice; 2]]) -> Domain {
    let listed: BTreeSet<Lattice> = segments.iter().flatten().copied().collect();
    let listed: Vec<Lattice> = listed.into_iter().collect();
    let mut domain = Domain::new(listed.iter().copied().map(point).collect());
    let index = |p: &Lattice| listed.binary_search(p).expect("listed") as u32;
    domain.segments = segments
        .iter()
        .map(|[a, b]| Segment { vertices: [index(a), index(b)], marker: 1 })
        .collect();
    domain.inside = Inside::Carve(Vec::new());
    domain
}

fn segment_index(owner: Owner) -> usize {
    match owner {
        Owner::Segment(index) => index,
        Owner::Loop { .. } => panic!("there are no loops"),
    }
}

/// The pairs of segments that the validator says cross or overlap.
fn named(found: &Result<Plc, Vec<Fault>>) -> BTreeSet<(usize, usize, Meeting)> {
    let faults = found.as_ref().err().into_iter().flatten();
    faults
        .filter_map(|fault| {
            let (edges, meeting) = match fault {
                Fault::Crossing { edges, .. } => (edges, Meeting::Crossing),
                Fault::Overlap { edges, .. } => (edges, Meeting::Overlap),
                _ => return None,
            };
            let [i, j] = [&edges[0], &edges[1]].map(|edge| segment_index(edge.owner));
            Some((i, j, meeting))
        })
        .collect()
}

fn expected(segments: &[[Lattice; 2]]) -> BTreeSet<(usize, usize, Meeting)> {
    let pairs = (0..segments.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
    pairs.filter_map(|(i, j)| Some((i, j, meeting(segments[i], segments[j])?))).collect()
}

/// Checks the promise of [`Plc`] from its definition.
fn check_complex(plc: &Plc) {
    let at = |v: u32| plc.points[v as usize];
    let lattice = |p: Point2| [p.x as i64, p.y as i64];
    let ends: Vec<[Lattice; 2]> =
        plc.segments.iter().map(|s| s.vertices.map(|v| lattice(at(v)))).collect();
    for (j, s) in ends.iter().enumerate() {
        for t in &ends[..j] {
            assert_eq!(meeting(*s, *t), None, "{s:?} {t:?}");
        }
        for p in plc.points.iter().map(|&p| lattice(p)) {
            let [a, b] = [s[0].min(s[1]), s[0].max(s[1])];
            assert!(!(cross(a, b, p) == 0 && a < p && p < b), "{p:?} lies on {s:?}");
        }
    }
    let distinct: BTreeSet<[u64; 2]> = plc.points.iter().map(|p| p.key()).collect();
    assert_eq!(distinct.len(), plc.points.len());
}

/// Twice the x of a point is odd here, so that no lattice point shares it: the parity of the
/// segments below decides on which side of the loops it lies.
fn winds_around(seed2: Lattice, edges: &[[Lattice; 2]]) -> bool {
    let below = |[a, b]: [Lattice; 2]| {
        let [a, b] = [a.min(b), a.max(b)].map(|p| [2 * p[0], 2 * p[1]]);
        a[0] < seed2[0] && seed2[0] < b[0] && cross(a, b, seed2) > 0
    };
    edges.iter().filter(|&&edge| below(edge)).count() % 2 == 1
}

fn on_any(seed2: Lattice, edges: &[[Lattice; 2]]) -> bool {
    edges.iter().any(|&edge| {
        let [a, b] = edge.map(|p| [2 * p[0], 2 * p[1]]);
        cross(a, b, seed2) == 0 && a.min(b) <= seed2 && seed2 <= a.max(b)
    })
}

proptest! {
    #![proptest_config(cases(2000))]

    // spec: D8 D9 D16 D18
    #[test]
    fn crossings_and_overlaps_are_those_of_brute_force(segments in pslg(6, 14)) {
        let found = validate(&carve(&segments));
        prop_assert_eq!(named(&found), expected(&segments));
        if let Ok(plc) = found {
            check_complex(&plc);
        }
    }

    // spec: D8 D9 D16 D18
    #[test]
    fn crossings_on_a_wider_lattice(segments in pslg(40, 40)) {
        let found = validate(&carve(&segments));
        prop_assert_eq!(named(&found), expected(&segments));
        if let Ok(plc) = found {
            check_complex(&plc);
        }
    }

    // spec: D17 D18
    #[test]
    fn segments_without_conflicts_are_sound(segments in pslg(7, 60)) {
        let mut kept: Vec<[Lattice; 2]> = Vec::new();
        for s in segments {
            if kept.iter().all(|t| meeting(s, *t).is_none()) {
                kept.push(s);
            }
        }
        match validate(&carve(&kept)) {
            Ok(plc) => check_complex(&plc),
            Err(faults) => prop_assert!(faults.iter().all(|f| f.id() == "D15"), "{}", faults[0]),
        }
    }

    // spec: D14 D17
    #[test]
    fn seeds_lie_inside_as_parity_says(
        triangles in prop::collection::vec(prop::array::uniform3(prop::array::uniform2(0_i64..9)), 1..9),
        seed in prop::array::uniform2(0_i64..9),
    ) {
        let mut edges: Vec<[Lattice; 2]> = Vec::new();
        let mut domain = Domain::new(Vec::new());
        for [a, b, c] in triangles {
            let sides = [[a, b], [b, c], [c, a]];
            let free = |s: &[Lattice; 2]| edges.iter().all(|t| meeting(*s, *t).is_none());
            if cross(a, b, c) == 0 || !sides.iter().all(free) {
                continue;
            }
            let first = domain.points.len() as u32;
            domain.points.extend([a, b, c].map(point));
            domain.loops.push(Loop::new(vec![first, first + 1, first + 2], 1, LoopRole::Any));
            edges.extend(sides);
        }
        let seed2 = [2 * seed[0] + 1, 2 * seed[1]];
        let seed = Point2::new(seed2[0] as f64 / 2.0, seed2[1] as f64 / 2.0);
        domain.regions = vec![Region { seed, marker: 1, area_max: None }];
        let found = validate(&domain).err().unwrap_or_default();
        if found.iter().any(|f| f.id() == "D8") {
            // Triangles that cross at vertices only; brute force here does not know of that.
            return Ok(());
        }
        let expected = if edges.is_empty() {
            "D14"
        } else if on_any(seed2, &edges) {
            "D14 on"
        } else if winds_around(seed2, &edges) {
            ""
        } else {
            "D14"
        };
        let says: Vec<&str> = found
            .iter()
            .map(|f| if matches!(f, Fault::SeedOnBoundary { .. }) { "D14 on" } else { f.id() })
            .collect();
        prop_assert_eq!(says.join(" "), expected);
    }
}

/// A star-shaped polygon around the origin on a fine lattice: sound by construction.
fn star() -> impl Strategy<Value = Vec<Point2>> {
    prop::collection::vec(1_u32..1000, 3..200).prop_map(|radii| {
        let count = radii.len() as f64;
        let corner = |(i, r): (usize, u32)| {
            let angle = std::f64::consts::TAU * i as f64 / count;
            let r = 0.001 + f64::from(r);
            Point2::new(r * libm::cos(angle), r * libm::sin(angle))
        };
        radii.into_iter().enumerate().map(corner).collect()
    })
}

fn ring(points: &[Point2]) -> Domain {
    let mut domain = Domain::new(points.to_vec());
    let vertices = (0..points.len() as u32).collect();
    domain.loops = vec![Loop::new(vertices, 1, LoopRole::Outer)];
    domain
}

/// Segments as unordered pairs of points: what a relabelling does not change.
fn unlabelled(plc: &Plc) -> BTreeSet<([[u64; 2]; 2], i32, bool)> {
    let ends = |vertices: [u32; 2]| {
        let mut ends = vertices.map(|v| plc.points[v as usize].key());
        ends.sort_unstable();
        ends
    };
    plc.segments.iter().map(|s| (ends(s.vertices), s.marker, s.in_loop)).collect()
}

proptest! {
    #![proptest_config(cases(300))]

    // spec: D17 D19
    #[test]
    fn start_and_direction_of_a_loop_do_not_matter(points in star(), shift in 0_usize..1000) {
        let plc = validate(&ring(&points)).map_err(|f| TestCaseError::fail(f[0].to_string()))?;
        prop_assert_eq!(plc.segments.len(), points.len());
        let mut turned = points.clone();
        turned.rotate_left(shift % points.len());
        prop_assert_eq!(unlabelled(&validate(&ring(&turned)).unwrap()), unlabelled(&plc));
        turned.reverse();
        prop_assert_eq!(unlabelled(&validate(&ring(&turned)).unwrap()), unlabelled(&plc));
    }

    // spec: D8 D16
    #[test]
    fn any_two_swapped_corners_of_a_star_give_the_same_answer_in_any_order(
        points in star(), i in 0_usize..1000, j in 0_usize..1000, shift in 0_usize..1000,
    ) {
        let mut points = points;
        let count = points.len();
        points.swap(i % count, j % count);
        let ids = |points: &[Point2]| -> Vec<&str> {
            let found = validate(&ring(points)).err().unwrap_or_default();
            found.iter().map(Fault::id).collect()
        };
        let first = ids(&points);
        points.rotate_left(shift % count);
        prop_assert_eq!(&ids(&points), &first);
        points.reverse();
        prop_assert_eq!(&ids(&points), &first);
    }
}
