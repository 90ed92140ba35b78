//! Valid meshes pass, however they came about; one change that breaks a mesh is found, whatever it
//! is. And meshers that are wrong on purpose are caught.

use proptest::prelude::*;
use std::collections::BTreeMap;
use trigrade::check::{CheckOptions, Id, Report, Verdict, check};
use trigrade::domain::{Domain, Inside, Loop, LoopRole, Places};
use trigrade::mesh::{MeshData, NO_POINT};
use trigrade::point::Point2;

/// A small generator of numbers, so that a case is one seed.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, bound: usize) -> usize {
        (self.next() % bound as u64) as usize
    }

    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn orient(points: &[[f64; 3]], [a, b, c]: [u32; 3]) -> f64 {
    let at = |v: u32| robust::Coord { x: points[v as usize][0], y: points[v as usize][1] };
    robust::orient2d(at(a), at(b), at(c))
}

/// The regular polygon as a fan, refined at random: points inserted into triangles, edges flipped.
fn valid_mesh(random: &mut Random, corners: u32, steps: usize) -> MeshData {
    let angle = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(corners);
    let mut points: Vec<[f64; 3]> =
        (0..corners).map(|i| [libm::cos(angle(i)), libm::sin(angle(i)), 0.0]).collect();
    let mut triangles: Vec<[u32; 3]> = (1..corners - 1).map(|i| [0, i, i + 1]).collect();
    for _ in 0..steps {
        if random.below(3) == 0 {
            flip_somewhere(random, &points, &mut triangles);
        } else {
            insert_somewhere(random, &mut points, &mut triangles);
        }
    }
    MeshData { points, triangles, ..MeshData::default() }
}

fn insert_somewhere(
    random: &mut Random,
    points: &mut Vec<[f64; 3]>,
    triangles: &mut Vec<[u32; 3]>,
) {
    let t = random.below(triangles.len());
    let [a, b, c] = triangles[t];
    let (u, v) = (random.unit(), random.unit());
    let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
    let [p, q, r] = [a, b, c].map(|w| points[w as usize]);
    let new = points.len() as u32;
    points.push([0, 1, 2].map(|k| p[k] + u * (q[k] - p[k]) + v * (r[k] - p[k])));
    let parts = [[a, b, new], [b, c, new], [c, a, new]];
    if parts.iter().all(|&part| orient(points, part) > 0.0) {
        triangles[t] = parts[0];
        triangles.extend(&parts[1..]);
    } else {
        points.pop();
    }
}

fn flip_somewhere(random: &mut Random, points: &[[f64; 3]], triangles: &mut [[u32; 3]]) {
    let t = random.below(triangles.len());
    let i = random.below(3);
    let [a, b, c] = [0, 1, 2].map(|k| triangles[t][(i + k) % 3]);
    let across = triangles.iter().position(|u| (0..3).any(|k| u[k] == b && u[(k + 1) % 3] == a));
    let Some(other) = across else { return };
    let d = triangles[other].into_iter().find(|&v| v != a && v != b).expect("an apex");
    let parts = [[c, a, d], [d, b, c]];
    if parts.iter().all(|&part| orient(points, part) > 0.0) {
        triangles[t] = parts[0];
        triangles[other] = parts[1];
    }
}

fn ring(points: &[[f64; 3]], count: u32) -> Domain {
    Domain {
        points: points.iter().take(count as usize).map(|p| Point2::new(p[0], p[1])).collect(),
        point_markers: Vec::new(),
        loops: vec![Loop {
            vertices: (0..count).collect(),
            markers: vec![0; count as usize],
            role: LoopRole::Any,
        }],
        segments: Vec::new(),
        inside: Inside::EvenOdd,
        regions: Vec::new(),
        places: Places::default(),
    }
}

fn run(mesh: &MeshData, domain: Option<&Domain>) -> Report {
    let mut options = CheckOptions::new();
    options.quality = false;
    check(mesh, domain, &options)
}

/// One change of a mesh that covers its domain; the ids of which one must be found, or none for any.
fn mutate(random: &mut Random, mesh: &mut MeshData, corners: u32) -> (&'static str, Vec<Id>) {
    let t = random.below(mesh.triangles.len());
    let count = mesh.points.len() as u32;
    match random.below(13) {
        0 => {
            mesh.triangles.remove(t);
            ("a triangle removed", vec![Id::Uncovered, Id::Empty])
        }
        1 => {
            mesh.triangles.push(mesh.triangles[t]);
            ("a triangle repeated", vec![Id::DuplicateTriangle])
        }
        2 => {
            mesh.triangles[t].swap(0, 1);
            ("two corners exchanged", vec![Id::MixedOrientation, Id::Clockwise])
        }
        3 => {
            let old = mesh.triangles[t];
            mesh.triangles[t][random.below(3)] = random.below(count as usize) as u32;
            let same = (0..3).any(|k| {
                let mut turned = old;
                turned.rotate_left(k);
                turned == mesh.triangles[t]
            });
            if same {
                mesh.triangles.remove(t);
            }
            ("a corner redirected", Vec::new())
        }
        4 => {
            mesh.triangles[t][random.below(3)] = [NO_POINT, count, count + 7][random.below(3)];
            ("a corner out of range", vec![Id::BadReference])
        }
        5 => {
            mesh.triangles[t][0] = mesh.triangles[t][1];
            ("a corner repeated", vec![Id::RepeatedVertex])
        }
        6 => {
            let v = mesh.triangles[t][random.below(3)];
            mesh.points[v as usize][random.below(2)] = [f64::NAN, f64::INFINITY][random.below(2)];
            ("a coordinate not finite", vec![Id::NotFinite])
        }
        7 => {
            mesh.points.push([random.unit(), random.unit(), 0.0]);
            ("a point added", vec![Id::UnusedVertex])
        }
        8 => {
            let v = mesh.triangles[t][0];
            mesh.points.push(mesh.points[v as usize]);
            mesh.triangles[t][0] = count;
            let alone = !mesh.triangles.iter().flatten().any(|&w| w == v);
            let id = if alone { Id::UnusedVertex } else { Id::DuplicateVertex };
            ("a vertex split in two", vec![id])
        }
        9 => {
            let v = random.below(corners as usize);
            let k = random.below(2);
            mesh.points[v][k] = mesh.points[v][k].next_up();
            ("a boundary vertex moved by one ulp", Vec::new())
        }
        10 => {
            mesh.triangles.push([0, 1, 2].map(|_| random.below(count as usize) as u32));
            ("a random triangle added", Vec::new())
        }
        11 => {
            mesh.triangles.reverse();
            mesh.triangles.iter_mut().for_each(|t| t.reverse());
            ("all triangles reversed", vec![Id::Clockwise])
        }
        _ => {
            let n = mesh.points.len() as u32;
            mesh.points.extend([[5.0, 5.0, 0.0], [6.0, 5.0, 0.0], [5.0, 6.0, 0.0]]);
            mesh.triangles.push([n, n + 1, n + 2]);
            ("a triangle far away", vec![Id::Outside])
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    // spec: C3 C5
    #[test]
    fn valid_meshes_pass(seed: u64, corners in 3u32..12, steps in 0usize..60) {
        let mesh = valid_mesh(&mut Random(seed), corners, steps);
        let domain = ring(&mesh.points, corners);
        let with = run(&mesh, Some(&domain));
        prop_assert!(with.passed(), "{:?} {:?}", with.could_not_run, with.findings);
        prop_assert_eq!(&with.statistics.area, &with.statistics.domain_area);
        let without = run(&mesh, None);
        prop_assert!(without.passed(), "{:?}", without.findings);
    }

    // spec: C4
    #[test]
    fn every_mutation_is_found(seed: u64, corners in 3u32..12, steps in 0usize..60) {
        let mut random = Random(seed);
        let mut mesh = valid_mesh(&mut random, corners, steps);
        let domain = ring(&mesh.points, corners);
        let (what, wanted) = mutate(&mut random, &mut mesh, corners);
        let report = run(&mesh, Some(&domain));
        prop_assert!(!report.passed(), "{what}");
        let ids = report.ids();
        prop_assert!(wanted.is_empty() || ids.len() == 1 && wanted.contains(&ids[0]), "{what}: {ids:?}");
    }

    /// Moving an inner vertex is right or wrong as exact orientation says.
    #[test]
    fn a_moved_vertex_is_judged_by_orientation(seed: u64, steps in 1usize..60, far in -60i32..1) {
        let mut random = Random(seed);
        let mut mesh = valid_mesh(&mut random, 5, steps);
        prop_assume!(mesh.points.len() > 5);
        let v = 5 + random.below(mesh.points.len() - 5);
        for k in 0..2 {
            mesh.points[v][k] += (random.unit() - 0.5) * libm::scalbn(1.0, far);
        }
        let sound = mesh.triangles.iter().all(|&t| orient(&mesh.points, t) > 0.0);
        let domain = ring(&mesh.points, 5);
        let report = run(&mesh, Some(&domain));
        prop_assert_eq!(report.passed(), sound, "{:?}", report.findings);
        let folds = [Id::Inverted, Id::ZeroArea];
        prop_assert!(report.ids().iter().all(|id| folds.contains(id)), "{:?}", report.ids());
    }

    // spec: C7
    #[test]
    fn rubbish_is_judged_without_panic(
        points in prop::collection::vec([rubbish(), rubbish(), rubbish()], 0..12),
        triangles in prop::collection::vec([0u32..14, 0u32..14, 0u32..14], 0..20),
        flat: bool,
        ring in prop::collection::vec(0u32..14, 0..8),
    ) {
        let mut mesh = MeshData { points, triangles, ..MeshData::default() };
        if flat {
            mesh.points.iter_mut().for_each(|p| p[2] = 0.0);
        }
        let domain = Domain {
            points: mesh.points.iter().map(|p| Point2::new(p[0], p[1])).collect(),
            point_markers: Vec::new(),
            loops: vec![Loop { markers: vec![0; ring.len()], vertices: ring, role: LoopRole::Any }],
            segments: Vec::new(),
            inside: Inside::EvenOdd,
            regions: Vec::new(),
            places: Places::default(),
        };
        let options = CheckOptions::new().delaunay(true).constrained_delaunay(true).closed(true);
        for given in [None, Some(&domain)] {
            let report = check(&mesh, given, &options);
            let text = serde_json::to_string(&report).expect("serialises");
            prop_assert!(serde_json::from_str::<Report>(&text).expect("reads back") == report);
        }
    }
}

/// Few values, so that points coincide, line up and cross; and the extremes.
fn rubbish() -> impl Strategy<Value = f64> {
    prop_oneof![
        12 => (0i32..4).prop_map(f64::from),
        2 => prop_oneof![Just(-0.0), Just(0.5), Just(1.0 + f64::EPSILON)],
        1 => prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(f64::MAX), Just(-f64::MAX), Just(5e-324)],
    ]
}

/// Meshers of simple polygons, each wrong in its own way but the first.
mod canary {
    use super::{BTreeMap, MeshData, orient};

    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Fault {
        None,
        /// Does not look whether an ear holds other vertices.
        EarsUnchecked,
        /// Takes the polygon for convex.
        Fan,
        /// Stops one triangle early.
        Unfinished,
        /// Writes its coordinates with four digits.
        Rounded,
        /// Writes the same point for each triangle anew.
        Soup,
        /// Writes corners in whichever order.
        Unordered,
        /// Snaps points that are near each other.
        Snapped,
    }

    pub const FAULTS: [Fault; 7] = [
        Fault::EarsUnchecked,
        Fault::Fan,
        Fault::Unfinished,
        Fault::Rounded,
        Fault::Soup,
        Fault::Unordered,
        Fault::Snapped,
    ];

    /// Triangulates a counterclockwise simple polygon by cutting ears.
    pub fn mesh(polygon: &[[f64; 3]], fault: Fault) -> MeshData {
        let n = polygon.len() as u32;
        let triangles = match fault {
            Fault::Fan => (1..n - 1).map(|i| [0, i, i + 1]).collect(),
            _ => cut_ears(polygon, fault != Fault::EarsUnchecked),
        };
        let mut mesh = MeshData { points: polygon.to_vec(), triangles, ..MeshData::default() };
        spoil(&mut mesh, fault);
        mesh
    }

    fn cut_ears(polygon: &[[f64; 3]], careful: bool) -> Vec<[u32; 3]> {
        let mut rest: Vec<u32> = (0..polygon.len() as u32).collect();
        let mut triangles = Vec::new();
        while rest.len() > 2 {
            let n = rest.len();
            let ear = |i: usize| [rest[(i + n - 1) % n], rest[i], rest[(i + 1) % n]];
            let is_free = |t: [u32; 3]| {
                rest.iter().filter(|v| !t.contains(v)).all(|&v| {
                    let outside = |a, b| orient(polygon, [a, b, v]) < 0.0;
                    outside(t[0], t[1]) || outside(t[1], t[2]) || outside(t[2], t[0])
                })
            };
            let good = |&i: &usize| orient(polygon, ear(i)) > 0.0 && (!careful || is_free(ear(i)));
            let Some(i) = (0..n).find(good) else { break };
            triangles.push(ear(i));
            rest.remove(i);
        }
        triangles
    }

    fn spoil(mesh: &mut MeshData, fault: Fault) {
        match fault {
            Fault::Unfinished => drop(mesh.triangles.pop()),
            Fault::Rounded => {
                mesh.points.iter_mut().flatten().for_each(|c| *c = (*c * 1e4).round() / 1e4);
            }
            Fault::Soup => {
                let corners: Vec<u32> = mesh.triangles.iter().flatten().copied().collect();
                mesh.points = corners.iter().map(|&v| mesh.points[v as usize]).collect();
                mesh.triangles =
                    (0..corners.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
            }
            Fault::Unordered => mesh.triangles.iter_mut().step_by(2).for_each(|t| t.swap(1, 2)),
            Fault::Snapped => {
                let cell =
                    |p: &[f64; 3]| [(p[0] * 2.0).round() as i64, (p[1] * 2.0).round() as i64];
                let mut first: BTreeMap<[i64; 2], u32> = BTreeMap::new();
                let kept: Vec<u32> = (0u32..)
                    .zip(&mesh.points)
                    .map(|(v, p)| *first.entry(cell(p)).or_insert(v))
                    .collect();
                mesh.triangles.iter_mut().flatten().for_each(|v| *v = kept[*v as usize]);
            }
            _ => {}
        }
    }
}

/// A gear: a polygon that is not convex, with vertices close to each other and no round numbers.
fn gear(teeth: u32) -> Vec<[f64; 3]> {
    (0..4 * teeth)
        .map(|i| {
            let angle = std::f64::consts::TAU * f64::from(i) / f64::from(4 * teeth);
            let radius = if i % 4 < 2 { 1.3 } else { 0.7 };
            [radius * libm::cos(angle), radius * libm::sin(angle), 0.0]
        })
        .collect()
}

// spec: C8
#[test]
fn meshers_that_are_wrong_on_purpose_are_caught() {
    for teeth in [3, 5, 8, 13] {
        let polygon = gear(teeth);
        let domain = ring(&polygon, polygon.len() as u32);
        let honest = canary::mesh(&polygon, canary::Fault::None);
        let report = check(&honest, Some(&domain), &CheckOptions::new());
        assert!(report.passed(), "{teeth} teeth: {:?}", report.findings);
        for fault in canary::FAULTS {
            let wrong = canary::mesh(&polygon, fault);
            let report = check(&wrong, Some(&domain), &CheckOptions::new());
            assert_eq!(report.verdict, Verdict::Failed, "{fault:?}, {teeth} teeth");
        }
    }
}
