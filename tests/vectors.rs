//! Meshes as data with known findings: `tests/vectors/*.json`, schema in its README.

use serde::Deserialize;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use trigrade::check::{CheckOptions, Dimension, Gate, Id, Report, Verdict, check};
use trigrade::domain::{Domain, Inside, Loop, LoopRole, Places, Segment};
use trigrade::mesh::{MarkedEdge, MeshData, NO_POINT};
use trigrade::point::Point2;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    schema: String,
    cases: Vec<Case>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Case {
    name: String,
    comment: String,
    mesh: RawMesh,
    domain: Option<RawDomain>,
    #[serde(default)]
    options: RawOptions,
    expected: Vec<String>,
    count: Option<u64>,
    verdict: Option<String>,
}

/// A coordinate: a number, or text for what JSON cannot say (`"nan"`, `"-inf"`) or rounds (`"-0"`).
#[derive(Clone, Deserialize)]
#[serde(untagged)]
enum Number {
    Value(f64),
    Text(String),
}

impl Number {
    fn value(&self) -> f64 {
        match self {
            Self::Value(value) => *value,
            Self::Text(text) => text.parse().expect("a number"),
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawMesh {
    points: Vec<Vec<Number>>,
    triangles: Vec<[i64; 3]>,
    #[serde(default)]
    edges: Vec<[u32; 2]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawDomain {
    points: Vec<[Number; 2]>,
    #[serde(default)]
    loops: Vec<Vec<u32>>,
    #[serde(default)]
    segments: Vec<[u32; 2]>,
    /// Hole points: given means Triangle's rule, absent the even-odd rule.
    carve: Option<Vec<[f64; 2]>>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct RawOptions {
    delaunay: bool,
    constrained_delaunay: bool,
    closed: bool,
    space: bool,
    gates: Vec<String>,
    allow: Vec<String>,
}

impl RawMesh {
    fn build(&self) -> MeshData {
        let point = |p: &Vec<Number>| {
            assert!(p.len() == 2 || p.len() == 3, "two or three coordinates");
            [p[0].value(), p[1].value(), p.get(2).map_or(0.0, Number::value)]
        };
        MeshData {
            points: self.points.iter().map(point).collect(),
            triangles: self
                .triangles
                .iter()
                .map(|t| t.map(|v| u32::try_from(v).unwrap_or(NO_POINT)))
                .collect(),
            edges: self.edges.iter().map(|&vertices| MarkedEdge { vertices, marker: 1 }).collect(),
            ..MeshData::default()
        }
    }
}

impl RawDomain {
    fn build(&self) -> Domain {
        let ring = |vertices: &Vec<u32>| Loop {
            vertices: vertices.clone(),
            markers: vec![1; vertices.len()],
            role: LoopRole::Any,
        };
        Domain {
            points: self.points.iter().map(|[x, y]| Point2::new(x.value(), y.value())).collect(),
            point_markers: Vec::new(),
            loops: self.loops.iter().map(ring).collect(),
            segments: self
                .segments
                .iter()
                .map(|&vertices| Segment { vertices, marker: 2 })
                .collect(),
            inside: match &self.carve {
                None => Inside::EvenOdd,
                Some(seeds) => {
                    Inside::Carve(seeds.iter().map(|&[x, y]| Point2::new(x, y)).collect())
                }
            },
            regions: Vec::new(),
            places: Places::default(),
        }
    }
}

impl RawOptions {
    fn build(&self) -> CheckOptions {
        let mut options = CheckOptions::new()
            .delaunay(self.delaunay)
            .constrained_delaunay(self.constrained_delaunay)
            .closed(self.closed);
        if self.space {
            options = options.dimension(Dimension::Space);
        }
        for gate in &self.gates {
            options = options.gate(Gate::parse(gate).expect("a gate"));
        }
        self.allow.iter().fold(options, |o, id| o.allow(id.parse().expect("an id")))
    }
}

fn cases() -> Vec<(String, Case)> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/vectors");
    let mut files: Vec<PathBuf> = fs::read_dir(&folder)
        .expect("the folder of vectors")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "json"))
        .collect();
    files.sort();
    files.iter().flat_map(|path| load(path)).collect()
}

fn load(path: &Path) -> Vec<(String, Case)> {
    let text = fs::read_to_string(path).expect("a vector file");
    let file: File =
        serde_json::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    assert_eq!(file.schema, "trigrade-vectors/1", "{}", path.display());
    let stem = path.file_stem().expect("a name").to_string_lossy().into_owned();
    file.cases.into_iter().map(|case| (format!("{stem}/{}", case.name), case)).collect()
}

fn run(case: &Case, threads: usize) -> Report {
    let domain = case.domain.as_ref().map(RawDomain::build);
    check(&case.mesh.build(), domain.as_ref(), &case.options.build().threads(threads))
}

fn show(report: &Report) -> String {
    let lines = report.findings.iter().map(|f| format!("  {} {}", f.id, f.message));
    lines.chain(report.could_not_run.clone()).collect::<Vec<_>>().join("\n")
}

// spec: C4 C5 C9
// spec: M1 M2 M3 M4 M5 M6 M7 M8 M9 M10 M11 M12 M13 M14 M15 M16 M17 M18 M19 M20 M21
// spec: M22 M23 M24 M25 M26 M27 Q1
#[test]
fn every_vector_has_exactly_its_findings() {
    let mut failures = Vec::new();
    for (name, case) in cases() {
        let report = run(&case, 1);
        let ids: Vec<&str> = report.ids().into_iter().map(Id::code).collect();
        let total: u64 = report.counts.iter().map(|entry| entry.count).sum();
        let verdict = match report.verdict {
            Verdict::Passed => "passed",
            Verdict::Failed => "failed",
            Verdict::CouldNotRun => "could-not-run",
        };
        let usual = if case.expected.is_empty() { "passed" } else { "failed" };
        let wanted = case.verdict.as_deref().unwrap_or(usual);
        let counted = case.count.is_none_or(|count| count == total);
        if ids != case.expected || verdict != wanted || !counted {
            failures.push(format!(
                "{name} ({}): expected {:?} x {:?} {wanted}, got {ids:?} x {total} {verdict}\n{}",
                case.comment,
                case.expected,
                case.count,
                show(&report)
            ));
        }
    }
    assert!(failures.is_empty(), "{} vectors fail:\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn there_are_enough_vectors_and_their_names_are_unique() {
    let all = cases();
    let broken = all.iter().filter(|(_, case)| !case.expected.is_empty()).count();
    assert!(broken >= 60, "{broken} broken meshes");
    assert!(all.len() - broken >= 25, "{} valid meshes", all.len() - broken);
    let names: BTreeSet<&String> = all.iter().map(|(name, _)| name).collect();
    assert_eq!(names.len(), all.len());
    let single = |(name, case): &(String, Case)| {
        assert!(case.expected.len() <= 1, "{name} has more than one defect");
    };
    all.iter().for_each(single);
}

// spec: C7
#[test]
fn reports_serialise_and_read_back() {
    for (name, case) in cases() {
        let report = run(&case, 1);
        let text = serde_json::to_string(&report).expect("a report serialises");
        let again: Report = serde_json::from_str(&text).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(again == report, "{name}");
    }
}

/// Each finding names a place, and says something that no other finding of the case says.
#[test]
fn findings_have_places() {
    for (name, case) in cases() {
        let report = run(&case, 1);
        let mut messages = BTreeSet::new();
        for finding in &report.findings {
            let placed = !finding.triangles.is_empty()
                || !finding.vertices.is_empty()
                || !finding.domain.is_empty();
            let global = finding.id == Id::Empty || finding.message.contains("marked edge");
            assert!(placed || global, "{name}: {}", finding.message);
            assert!(messages.insert(finding.message.clone()), "{name}: {}", finding.message);
        }
    }
}

/// A quarter turn and scaling by a power of two are exact and change no verdict.
#[test]
fn a_turned_and_scaled_mesh_has_the_same_findings() {
    let turn = |[x, y]: [f64; 2]| [-y * 4.0, x * 4.0];
    for (name, case) in cases() {
        let mut mesh = case.mesh.build();
        let largest = mesh.points.iter().flatten().fold(0.0f64, |m, c| m.max(c.abs()));
        let in_space = mesh.points.iter().any(|p| p[2] != 0.0);
        if largest > 1e300 || in_space || !case.options.gates.is_empty() {
            continue;
        }
        for point in &mut mesh.points {
            let [x, y] = turn([point[0], point[1]]);
            *point = [x, y, 0.0];
        }
        let mut domain = case.domain.as_ref().map(RawDomain::build);
        if let Some(domain) = &mut domain {
            for p in &mut domain.points {
                let [x, y] = turn([p.x, p.y]);
                *p = Point2::new(x, y);
            }
            if let Inside::Carve(seeds) = &mut domain.inside {
                for p in seeds {
                    let [x, y] = turn([p.x, p.y]);
                    *p = Point2::new(x, y);
                }
            }
        }
        let report = check(&mesh, domain.as_ref(), &case.options.build());
        let ids: Vec<&str> = report.ids().into_iter().map(Id::code).collect();
        assert_eq!(ids, case.expected, "{name}, turned:\n{}", show(&report));
    }
}

/// Renumbered points, rotated corners and reordered triangles change no verdict.
#[test]
fn a_renumbered_mesh_has_the_same_findings() {
    for (name, case) in cases() {
        let mut mesh = case.mesh.build();
        let count = mesh.points.len() as u32;
        let moved = |v: u32| if v < count { count - 1 - v } else { v };
        mesh.points.reverse();
        mesh.triangles.reverse();
        for t in &mut mesh.triangles {
            *t = t.map(moved);
            t.rotate_left(1);
        }
        for e in &mut mesh.edges {
            e.vertices = e.vertices.map(moved);
        }
        let domain = case.domain.as_ref().map(RawDomain::build);
        let report = check(&mesh, domain.as_ref(), &case.options.build());
        let ids: Vec<&str> = report.ids().into_iter().map(Id::code).collect();
        assert_eq!(ids, case.expected, "{name}, renumbered:\n{}", show(&report));
        let total: u64 = report.counts.iter().map(|entry| entry.count).sum();
        assert!(case.count.is_none_or(|c| c == total), "{name}, renumbered: {total}");
    }
}

// spec: C6
#[test]
fn threads_do_not_change_a_byte() {
    for (name, case) in cases() {
        let bytes = |threads| serde_json::to_vec(&run(&case, threads)).expect("serialises");
        assert_eq!(bytes(1), bytes(2), "{name}");
        assert_eq!(bytes(1), bytes(7), "{name}");
    }
}
