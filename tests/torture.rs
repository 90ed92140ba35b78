//! Torture of this crate's own mesher, and of mutants of it that must be caught.

use std::collections::{BTreeMap, BTreeSet};
use std::panic::catch_unwind;
use trigrade::check::{CheckOptions, check};
use trigrade::domain::Domain;
use trigrade::mesh::MeshData;
use trigrade::mesher::{MeshError, Options, Unobserved, mesh_domain};
use trigrade::point::Point2;
use trigrade::torture::export::{BoundaryForm, export};
use trigrade::torture::generate::{Case, Claim, Selection, case};
use trigrade::torture::judge::{Answer, Class, Demands, Judgement, judge};

/// The mesher as a torturer sees it.
fn answer(domain: &Domain) -> Answer {
    let outcome = catch_unwind(|| mesh_domain(domain, &Options::default(), &mut Unobserved));
    match outcome {
        Ok(Ok(meshed)) => Answer::Mesh(Box::new(MeshData::from(&meshed.mesh))),
        Ok(Err(MeshError::Invalid(faults))) => Answer::Refused(faults[0].to_string()),
        Ok(Err(error @ MeshError::TooMany { .. })) => Answer::Limit(error.to_string()),
        Ok(Err(error)) => Answer::Refused(error.to_string()),
        Err(_) => Answer::Crash("it panicked".into()),
    }
}

fn verdict(case: &Case) -> Judgement {
    judge(&case.domain, case.claim, &answer(&case.domain), &Demands::default())
}

/// The cases of a selection that fail, each in a line; counts by verdict are printed.
fn torture(selection: &Selection, cases: std::ops::Range<u64>) -> Vec<String> {
    let mut counts: BTreeMap<Class, u64> = BTreeMap::new();
    let mut failures = Vec::new();
    for index in cases {
        let case = selection.case(index).expect("a family");
        let judgement = verdict(&case);
        *counts.entry(judgement.class).or_default() += 1;
        if judgement.class.is_failure() {
            let Judgement { class, reason, .. } = judgement;
            failures.push(format!("{class}: {} {index} ({}): {reason}", case.family, case.dress));
        }
    }
    println!("{counts:?}");
    failures
}

// spec: R10
#[test]
fn our_own_mesher_passes_some_hundred_cases() {
    let selection = Selection { size_max: 60, ..Selection::new(2024) };
    let failures = torture(&selection, 0..400);
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
}

// spec: R10
#[test]
fn what_a_long_run_found_stays_mended() {
    // 4380: a new vertex in the middle of an edge that subnormal numbers cannot hold. 5451: fine
    // spacing that spread from the ends of long edges until the front passed its budget.
    for number in [4380, 5451] {
        let case = case(12, number);
        let judgement = verdict(&case);
        assert!(!judgement.class.is_failure(), "{} {}", case.family, judgement.reason);
    }
}

/// The long run: `cargo test --release --test torture -- --ignored --nocapture`. The environment
/// variables TRIGRADE_TORTURE_CASES and TRIGRADE_TORTURE_SEED change its size and seed.
#[test]
#[ignore = "20,000 cases take many minutes"]
fn our_own_mesher_passes_twenty_thousand_cases() {
    let number = |name: &str, default: u64| {
        std::env::var(name).map_or(default, |text| text.parse().expect("a whole number"))
    };
    let selection = Selection::new(number("TRIGRADE_TORTURE_SEED", 1));
    let failures = torture(&selection, 0..number("TRIGRADE_TORTURE_CASES", 20_000));
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
}

/// A deliberate fault: what it does to a right mesh; `false` when it cannot do it to this one.
type Mutation = fn(&mut MeshData) -> bool;

/// Edges of one triangle.
fn border(mesh: &MeshData) -> Vec<[u32; 2]> {
    let mut seen: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    for &[a, b, c] in &mesh.triangles {
        for [u, v] in [[a, b], [b, c], [c, a]] {
            *seen.entry([u.min(v), u.max(v)]).or_default() += 1;
        }
    }
    seen.into_iter().filter(|entry| entry.1 == 1).map(|entry| entry.0).collect()
}

fn drop_a_triangle(mesh: &mut MeshData) -> bool {
    mesh.triangles.len() > 1 && mesh.triangles.pop().is_some()
}

fn turn_one_over(mesh: &mut MeshData) -> bool {
    mesh.triangles[0].swap(0, 1);
    mesh.triangles.len() > 1
}

fn repeat_one(mesh: &mut MeshData) -> bool {
    let first = mesh.triangles[0];
    mesh.triangles.push(first);
    true
}

fn move_a_border_vertex_by_an_ulp(mesh: &mut MeshData) -> bool {
    let vertex = border(mesh)[0][0] as usize;
    mesh.points[vertex][0] = mesh.points[vertex][0].next_up();
    true
}

/// Far enough to turn a triangle over.
fn move_an_inner_vertex_away(mesh: &mut MeshData) -> bool {
    let rim: BTreeSet<u32> = border(mesh).into_iter().flatten().collect();
    let inner = (0..mesh.points.len() as u32).find(|v| !rim.contains(v));
    let Some(inner) = inner else { return false };
    let [x, y, _] = mesh.points[border(mesh)[0][0] as usize];
    let at = &mut mesh.points[inner as usize];
    // Mirrored at a border vertex: outside, or on the far side of it.
    *at = [2.0 * x - at[0], 2.0 * y - at[1], 0.0];
    at[0].is_finite() && at[1].is_finite()
}

/// Collapses a border edge: one of its ends is gone from the boundary.
fn lose_a_border_edge(mesh: &mut MeshData) -> bool {
    let [a, b] = border(mesh)[0];
    merge(mesh, a, b)
}

fn merge_two_vertices(mesh: &mut MeshData) -> bool {
    let last = mesh.points.len() as u32 - 1;
    let far =
        (0..last).find(|v| mesh.triangles.iter().all(|t| !(t.contains(v) && t.contains(&last))));
    far.is_some_and(|far| merge(mesh, far, last))
}

fn merge(mesh: &mut MeshData, kept: u32, gone: u32) -> bool {
    for corner in mesh.triangles.iter_mut().flatten().filter(|corner| **corner == gone) {
        *corner = kept;
    }
    mesh.triangles.retain(|&[a, b, c]| a != b && b != c && c != a);
    !mesh.triangles.is_empty()
}

/// Two copies of one vertex: the mesh is torn there.
fn tear(mesh: &mut MeshData) -> bool {
    let vertex = mesh.triangles[0][0];
    mesh.points.push(mesh.points[vertex as usize]);
    mesh.triangles[0][0] = mesh.points.len() as u32 - 1;
    true
}

/// Splits an edge for one of its two triangles only.
fn hang_a_node(mesh: &mut MeshData) -> bool {
    let rim = border(mesh);
    let of_edge = |t: &[u32; 3], i: usize| [t[i], t[(i + 1) % 3]];
    let found = (0..mesh.triangles.len()).find_map(|k| {
        let t = mesh.triangles[k];
        let inner = |&i: &usize| {
            let [a, b] = of_edge(&t, i);
            !rim.contains(&[a.min(b), a.max(b)])
        };
        (0..3).find(inner).map(|i| (k, i))
    });
    let Some((k, i)) = found else { return false };
    let t = mesh.triangles[k];
    let [a, b, c] = [t[i], t[(i + 1) % 3], t[(i + 2) % 3]];
    let (p, q) = (mesh.points[a as usize], mesh.points[b as usize]);
    let middle = [p[0] / 2.0 + q[0] / 2.0, p[1] / 2.0 + q[1] / 2.0, 0.0];
    mesh.points.push(middle);
    let m = mesh.points.len() as u32 - 1;
    mesh.triangles[k] = [a, m, c];
    mesh.triangles.push([m, b, c]);
    true
}

/// The convex hull's view: a further triangle over a concave corner of the boundary.
fn fill_a_notch(mesh: &mut MeshData) -> bool {
    let outline: BTreeSet<[u32; 2]> = border(mesh).into_iter().collect();
    let rim: Vec<[u32; 2]> = mesh
        .triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .filter(|[a, b]| outline.contains(&[*a.min(b), *a.max(b)]))
        .collect();
    let next = |v: u32| rim.iter().find(|edge| edge[0] == v).map(|edge| edge[1]);
    let notch = rim.iter().find_map(|&[a, b]| {
        let c = next(b)?;
        let [p, q, r] = [a, b, c].map(|v| mesh.points[v as usize]);
        let area = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        (area < 0.0).then_some([a, c, b])
    });
    notch.is_some_and(|triangle| {
        mesh.triangles.push(triangle);
        true
    })
}

const MUTATIONS: [(&str, Mutation); 10] = [
    ("drops a triangle", drop_a_triangle),
    ("turns a triangle over", turn_one_over),
    ("repeats a triangle", repeat_one),
    ("moves a border vertex by an ulp", move_a_border_vertex_by_an_ulp),
    ("moves an inner vertex away", move_an_inner_vertex_away),
    ("loses a border edge", lose_a_border_edge),
    ("merges two vertices", merge_two_vertices),
    ("tears the mesh at a vertex", tear),
    ("hangs a node", hang_a_node),
    ("fills a notch", fill_a_notch),
];

/// A mutant errs only now and then: in one case of thirteen.
fn mutated(case: &Case, mutate: Mutation) -> Option<Judgement> {
    if case.index % 13 != 3 {
        return None;
    }
    let Answer::Mesh(mut mesh) = answer(&case.domain) else { return None };
    mutate(&mut mesh)
        .then(|| judge(&case.domain, case.claim, &Answer::Mesh(mesh), &Demands::default()))
}

// spec: R11
#[test]
fn every_mutant_is_caught_within_500_cases() {
    let selection = Selection { size_max: 20, ..Selection::new(77) };
    for (name, mutate) in MUTATIONS {
        let verdicts = (0..500).filter_map(|index| {
            let case = selection.case(index)?;
            mutated(&case, mutate).map(|judgement| (index, judgement))
        });
        let caught = verdicts.into_iter().find(|(_, judgement)| judgement.class.is_failure());
        let (index, judgement) = caught.unwrap_or_else(|| panic!("nothing catches that it {name}"));
        println!("{name}: {} at case {index}: {}", judgement.class, judgement.reason);
        assert!(matches!(judgement.class, Class::WrongMesh | Class::BoundaryAltered), "{name}");
    }
}

// spec: R11
#[test]
fn no_right_mesh_is_mistaken_for_a_mutant() {
    let selection = Selection { size_max: 20, ..Selection::new(77) };
    let untouched: Mutation = |_| true;
    for index in (0..500).filter(|index| index % 13 == 3) {
        let case = selection.case(index).expect("a family");
        if let Some(judgement) = mutated(&case, untouched) {
            let Judgement { class, reason, .. } = judgement;
            assert_eq!(class, Class::Passed, "{} {index}: {reason}", case.family);
        }
    }
}

/// Area of a boundary by its constrained Delaunay triangulation, exactly.
fn area(domain: &Domain) -> Option<String> {
    use trigrade::mesher::Method;
    let options = Options { method: Method::DelaunayInitial, ..Options::default() };
    let meshed = mesh_domain(domain, &options, &mut Unobserved).ok()?;
    let report = check(&MeshData::from(&meshed.mesh), None, &CheckOptions::new());
    report.statistics.area.map(|area| area.exact)
}

// spec: R5
#[test]
fn hole_points_carve_what_the_even_odd_rule_leaves_out() {
    use trigrade::format::domain_file::{DomainForm, ReadOptions, read_domain};
    let (mut compared, mut differ) = (0, Vec::new());
    let selection = Selection { size_max: 40, ..Selection::new(5) };
    for index in 0..400 {
        let case = selection.case(index).expect("a family");
        if case.claim != Claim::Valid {
            continue;
        }
        let Ok(bytes) = export(&case.domain, BoundaryForm::Poly) else { continue };
        let carved = read_domain(&bytes, DomainForm::Poly, &ReadOptions::default());
        compared += 1;
        if area(&carved.expect("readable")) != area(&case.domain) {
            differ.push(format!("{} {index}", case.family));
        }
    }
    assert!(compared > 100, "{compared}");
    assert!(differ.is_empty(), "{} of {compared}: {differ:?}", differ.len());
}

/// What the documentation promises to other crates: cases as proptest strategies.
#[test]
fn cases_work_as_a_proptest_strategy() {
    use proptest::prelude::*;
    let cases = (any::<u64>(), 0..40u64).prop_map(|(seed, index)| case(seed, index));
    proptest!(ProptestConfig::with_cases(64), |(case in cases)| {
        let is_accepted = trigrade::domain::validate::validate(&case.domain).is_ok();
        prop_assert_eq!(is_accepted, case.claim == Claim::Valid);
    });
}

/// And from the bytes of a fuzzer.
#[test]
fn cases_work_from_the_bytes_of_a_fuzzer() {
    let bytes: Vec<u8> = (0..64).collect();
    let mut input = arbitrary::Unstructured::new(&bytes);
    let (seed, index): (u64, u64) = input.arbitrary().expect("enough bytes");
    let case = case(seed, index);
    assert!(case.domain.points.iter().all(|p: &Point2| p.is_finite()));
}
