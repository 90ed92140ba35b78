//! What a check answers: findings with places and measured values, counts, statistics, verdict.

mod github;
mod gitlab;
mod json;
mod junit;
mod render;
mod sarif;
mod tap;
mod text;

pub use render::{Form, Subject, UnknownForm, render};

use super::gate::GateResult;
use super::id::Id;
use super::quality::Quality;
use crate::mesh::{MeshData, OtherCells};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The schema of a serialised [`Report`]; it changes when a field changes its meaning or goes.
pub const SCHEMA: &str = "trigrade-report/1";

/// The answer in one word; the exit codes are 0, 1 and 2.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Every check asked for ran, and none has a finding that is not allowed.
    Passed,
    /// There are findings.
    Failed,
    /// Something asked for could not be checked; that is never a pass.
    CouldNotRun,
}

/// A triangle of the mesh, as the file has it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TrianglePlace {
    /// Index into [`MeshData::triangles`].
    pub index: u32,
    /// The file's own number.
    pub number: i64,
    /// Line of the file, if it is a text file.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub line: Option<u64>,
}

/// A point of the mesh, as the file has it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VertexPlace {
    /// Index into [`MeshData::points`].
    pub index: u32,
    /// The file's own number.
    pub number: i64,
    /// Coordinates; `None` where one is not finite, for JSON has no such numbers.
    pub coordinates: [Option<f64>; 3],
    /// Line of the file, if it is a text file.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub line: Option<u64>,
}

/// A thing of the domain that a finding speaks of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DomainPlace {
    /// Indices into the domain's points: one for a point, two for a segment.
    pub points: Vec<u32>,
    /// Their coordinates.
    pub coordinates: Vec<[f64; 2]>,
    /// Where the first of them stands in the file: a line or a JSON path.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub source: Option<String>,
}

/// One defect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// The rule it breaks.
    pub id: Id,
    /// One sentence in the user's terms.
    pub message: String,
    /// Whether the caller allowed findings of this id.
    pub allowed: bool,
    /// The triangles concerned.
    pub triangles: Vec<TrianglePlace>,
    /// The vertices concerned.
    pub vertices: Vec<VertexPlace>,
    /// The part of the domain concerned.
    pub domain: Vec<DomainPlace>,
    /// Measured values by name.
    pub measured: BTreeMap<String, f64>,
}

/// How often an id was found.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct IdCount {
    /// The id.
    pub id: Id,
    /// Exact number of findings.
    pub count: u64,
    /// How many of them [`Report::findings`] lists.
    pub listed: u64,
    /// Whether the caller allowed them.
    pub allowed: bool,
}

/// A check that did not run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct NotChecked {
    /// The id.
    pub id: Id,
    /// Why, in half a sentence.
    pub why: String,
}

/// An exact number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ExactNumber {
    /// `"N"` or `"N/2^k"` with decimal N: the number itself.
    pub exact: String,
    /// The same rounded; `None` where it exceeds every float.
    pub rounded: Option<f64>,
}

/// How far the nodes of subdivided domain segments lie from them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DeviationStatistics {
    /// Segments that the mesh subdivides.
    pub subdivided_segments: u64,
    /// Nodes on them.
    pub nodes: u64,
    /// Largest distance of a node from its segment, in the unit of the mesh.
    pub length_max: f64,
    /// The same in units in the last place of the largest coordinate of the segment's ends.
    pub ulps_max: f64,
}

/// Facts about the mesh.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Statistics {
    /// Points of the file.
    pub points: u64,
    /// Triangles of the file.
    pub triangles: u64,
    /// `"plane"` or `"space"`.
    pub dimension: String,
    /// Different vertices that triangles use.
    pub vertices_used: u64,
    /// Different edges.
    pub edges: u64,
    /// Edges of one triangle.
    pub boundary_edges: u64,
    /// Closed chains of boundary edges.
    pub boundary_loops: u64,
    /// Parts connected through edges.
    pub components: u64,
    /// Vertices - edges + triangles.
    pub euler: i64,
    /// Sum of the signed areas (plane), exactly.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub area: Option<ExactNumber>,
    /// Area of the domain inside its boundary, exactly.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub domain_area: Option<ExactNumber>,
    /// Nodes of subdivided domain segments.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub deviation: Option<DeviationStatistics>,
    /// Pairs of triangles whose intersection was decided exactly (space).
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub intersection_tests: Option<u64>,
    /// Fewest significant decimal digits of the file's coordinates.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub decimal_digits: Option<u8>,
    /// Cells that are no triangles: counted, not checked.
    pub other_cells: Vec<OtherCells>,
}

/// The answer of [`check`](super::check).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// [`SCHEMA`].
    pub schema: String,
    /// The answer in one word.
    pub verdict: Verdict,
    /// Why something could not run; empty unless the verdict says so.
    pub could_not_run: Vec<String>,
    /// Findings by id, then by place; at most [`list_limit`](super::CheckOptions::list_limit) each.
    pub findings: Vec<Finding>,
    /// Exact counts of the ids that have findings.
    pub counts: Vec<IdCount>,
    /// Ids whose check ran to its end.
    pub checked: Vec<Id>,
    /// Ids whose check did not run.
    pub not_checked: Vec<NotChecked>,
    /// Facts about the mesh.
    pub statistics: Statistics,
    /// Quality metrics; `None` when not asked for or when there is no sound triangle.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub quality: Option<Quality>,
    /// Results of the gates, in the order given.
    pub gates: Vec<GateResult>,
}

impl Report {
    /// The report of a check that could not begin: nothing was checked.
    #[must_use]
    pub fn not_run(why: &str) -> Self {
        Self {
            schema: SCHEMA.to_owned(),
            verdict: Verdict::CouldNotRun,
            could_not_run: vec![why.to_owned()],
            findings: Vec::new(),
            counts: Vec::new(),
            checked: Vec::new(),
            not_checked: Vec::new(),
            statistics: Statistics::default(),
            quality: None,
            gates: Vec::new(),
        }
    }

    /// Whether everything asked for was checked and holds.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.verdict == Verdict::Passed
    }

    /// Exact number of findings of an id.
    #[must_use]
    pub fn count(&self, id: Id) -> u64 {
        self.counts.iter().find(|entry| entry.id == id).map_or(0, |entry| entry.count)
    }

    /// The ids that have findings, in order.
    #[must_use]
    pub fn ids(&self) -> Vec<Id> {
        self.counts.iter().map(|entry| entry.id).collect()
    }

    /// 0 passed, 1 findings, 2 could not run.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self.verdict {
            Verdict::Passed => 0,
            Verdict::Failed => 1,
            Verdict::CouldNotRun => 2,
        }
    }
}

/// Collects findings while the checks run: counts all, keeps the first few of each id.
pub(super) struct Collector<'a> {
    mesh: &'a MeshData,
    limit: u64,
    counts: BTreeMap<Id, u64>,
    findings: Vec<Finding>,
}

/// A finding before its indices are turned into places.
pub(super) struct Draft {
    pub(super) id: Id,
    pub(super) message: String,
    pub(super) triangles: Vec<u32>,
    pub(super) vertices: Vec<u32>,
    pub(super) domain: Vec<DomainPlace>,
    pub(super) measured: Vec<(&'static str, f64)>,
}

impl Draft {
    pub(super) fn new(id: Id, message: String) -> Self {
        let (triangles, vertices, domain) = (Vec::new(), Vec::new(), Vec::new());
        Self { id, message, triangles, vertices, domain, measured: Vec::new() }
    }

    pub(super) fn triangles(mut self, triangles: impl IntoIterator<Item = u32>) -> Self {
        self.triangles.extend(triangles);
        self
    }

    pub(super) fn vertices(mut self, vertices: impl IntoIterator<Item = u32>) -> Self {
        self.vertices.extend(vertices);
        self
    }

    pub(super) fn domain(mut self, places: impl IntoIterator<Item = DomainPlace>) -> Self {
        self.domain.extend(places);
        self
    }

    pub(super) fn measured(mut self, name: &'static str, value: f64) -> Self {
        self.measured.push((name, value));
        self
    }
}

impl<'a> Collector<'a> {
    pub(super) fn new(mesh: &'a MeshData, limit: u64) -> Self {
        Self { mesh, limit, counts: BTreeMap::new(), findings: Vec::new() }
    }

    /// Counts a finding; `draft` is called only while the id's list has room.
    pub(super) fn add(&mut self, id: Id, draft: impl FnOnce() -> Draft) {
        let count = self.counts.entry(id).or_insert(0);
        *count += 1;
        if *count <= self.limit {
            let finding = self.finding(draft());
            self.findings.push(finding);
        }
    }

    /// Whether any finding of the id was counted.
    pub(super) fn has(&self, id: Id) -> bool {
        self.counts.contains_key(&id)
    }

    fn finding(&self, draft: Draft) -> Finding {
        let measured = draft.measured.into_iter().filter(|pair| pair.1.is_finite());
        Finding {
            id: draft.id,
            message: draft.message,
            allowed: false,
            triangles: draft.triangles.iter().map(|&t| triangle_place(self.mesh, t)).collect(),
            vertices: draft.vertices.iter().filter_map(|&v| vertex_place(self.mesh, v)).collect(),
            domain: draft.domain,
            measured: measured.map(|(name, value)| (name.to_owned(), value)).collect(),
        }
    }

    /// Findings in the order of ids, then of discovery; and the exact counts.
    pub(super) fn finish(mut self, allowed: impl Fn(Id) -> bool) -> (Vec<Finding>, Vec<IdCount>) {
        self.findings.sort_by_key(|finding| finding.id);
        for finding in &mut self.findings {
            finding.allowed = allowed(finding.id);
        }
        let limit = self.limit;
        let count = |(id, count): (Id, u64)| IdCount {
            id,
            count,
            listed: count.min(limit),
            allowed: allowed(id),
        };
        (self.findings, self.counts.into_iter().map(count).collect())
    }
}

/// The file's own number of a triangle: its index counted from 0 unless the file numbers otherwise.
#[must_use]
pub fn triangle_place(mesh: &MeshData, index: u32) -> TrianglePlace {
    let number = mesh.triangle_numbers.get(index as usize).copied();
    TrianglePlace {
        index,
        number: number.unwrap_or(i64::from(index)),
        line: mesh.triangle_lines.line(index),
    }
}

/// The place of a point; `None` when there is no such point.
#[must_use]
pub fn vertex_place(mesh: &MeshData, index: u32) -> Option<VertexPlace> {
    let coordinates = mesh.points.get(index as usize)?;
    let number = mesh.point_numbers.get(index as usize).copied();
    Some(VertexPlace {
        index,
        number: number.unwrap_or(i64::from(index)),
        coordinates: coordinates.map(|c| c.is_finite().then_some(c)),
        line: mesh.point_lines.line(index),
    })
}

/// A point as messages show it.
pub(super) fn show_vertex(mesh: &MeshData, index: u32) -> String {
    let number = mesh.point_numbers.get(index as usize).copied().unwrap_or(i64::from(index));
    match mesh.points.get(index as usize) {
        Some([x, y, z]) if *z == 0.0 => format!("{number} ({x:?}, {y:?})"),
        Some([x, y, z]) => format!("{number} ({x:?}, {y:?}, {z:?})"),
        None => number.to_string(),
    }
}

/// A triangle as messages show it: its number.
pub(super) fn show_triangle(mesh: &MeshData, index: u32) -> i64 {
    mesh.triangle_numbers.get(index as usize).copied().unwrap_or(i64::from(index))
}
