//! What is wrong with a mesher's answer: exactly, by [`check`], in one word and one sentence.

use super::generate::Claim;
use crate::check::{CheckOptions, Finding, Gate, Id, Metric, Report, Verdict, check};
use crate::domain::Domain;
use crate::mesh::MeshData;
use serde::{Deserialize, Serialize};

/// What a mesher did with a boundary.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// It handed out a mesh.
    Mesh(Box<MeshData>),
    /// It said no, in these words.
    Refused(String),
    /// It said yes, but its answer cannot be read.
    Unreadable(String),
    /// It ended by a signal, a panic or an abort.
    Crash(String),
    /// It was still running when its time was up.
    Hang(String),
    /// It ran into the memory limit.
    OutOfMemory(String),
    /// It named a limit that its documentation announces, and stopped before any work.
    Limit(String),
    /// The boundary cannot be told in the mesher's input format, so it was not asked.
    NotAsked(String),
}

/// The verdict on an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Class {
    /// A valid boundary and a correct mesh, or an invalid boundary refused.
    Passed,
    /// The mesher died.
    Crash,
    /// It did not end in time.
    Hang,
    /// It needed more memory than allowed.
    OutOfMemory,
    /// It refused a valid boundary.
    RefusedValid,
    /// It meshed an invalid boundary.
    AcceptedInvalid,
    /// Its answer cannot be read.
    Unreadable,
    /// Its mesh is wrong.
    WrongMesh,
    /// Its mesh is sound, but not of this boundary, these constraints or these points.
    BoundaryAltered,
    /// Its mesh is right, but misses a quality gate.
    BelowGate,
    /// It stopped at a limit that its documentation announces.
    Limit,
    /// It was not asked.
    NotAsked,
}

impl Class {
    /// All classes, in the order of tables.
    pub const ALL: [Self; 12] = [
        Self::Passed,
        Self::Crash,
        Self::Hang,
        Self::OutOfMemory,
        Self::RefusedValid,
        Self::AcceptedInvalid,
        Self::Unreadable,
        Self::WrongMesh,
        Self::BoundaryAltered,
        Self::BelowGate,
        Self::Limit,
        Self::NotAsked,
    ];

    /// Its name in tables, files and JSON.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Passed => "passed",
            Self::Crash => "crash",
            Self::Hang => "hang",
            Self::OutOfMemory => "out-of-memory",
            Self::RefusedValid => "refused-valid",
            Self::AcceptedInvalid => "accepted-invalid",
            Self::Unreadable => "unreadable",
            Self::WrongMesh => "wrong-mesh",
            Self::BoundaryAltered => "boundary-altered",
            Self::BelowGate => "below-gate",
            Self::Limit => "limit",
            Self::NotAsked => "not-asked",
        }
    }

    /// Whether it counts against the mesher.
    #[must_use]
    pub const fn is_failure(self) -> bool {
        !matches!(self, Self::Passed | Self::Limit | Self::NotAsked)
    }
}

impl std::fmt::Display for Class {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}

/// The verdict on an answer, with its reason.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Judgement {
    /// In one word.
    pub class: Class,
    /// Ids of what `check` found, in order; empty where no mesh was checked.
    pub findings: Vec<Id>,
    /// In one sentence; empty for what passed.
    pub reason: String,
    /// Triangles of the mesh, if there is one.
    pub triangles: u64,
    /// Largest R/(2r) of its triangles, if it was measured and is finite.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub radius_ratio_max: Option<f64>,
}

impl Judgement {
    fn new(class: Class, reason: impl Into<String>) -> Self {
        let reason = reason.into();
        Self { class, findings: Vec::new(), reason, triangles: 0, radius_ratio_max: None }
    }

    /// Whether two verdicts tell of the same defect: one class, and a finding in common if any.
    #[must_use]
    pub fn is_like(&self, other: &Self) -> bool {
        let shared = self.findings.iter().any(|id| other.findings.contains(id));
        self.class == other.class
            && (shared || (self.findings.is_empty() && other.findings.is_empty()))
    }
}

/// What is demanded of meshes.
#[derive(Clone, Debug, Default)]
pub struct Demands {
    /// No triangle's R/(2r) may be above this.
    pub aspect_max: Option<f64>,
    /// Findings of these ids do not count.
    pub allow: Vec<Id>,
}

impl Demands {
    /// The same in the checker's terms; statistics are measured in any case.
    #[must_use]
    pub fn options(&self) -> CheckOptions {
        let gate = self.aspect_max.map(|bound| Gate::at_most(Metric::RadiusRatio, bound));
        let options = CheckOptions::new().list_limit(3);
        let options = gate.into_iter().fold(options, CheckOptions::gate);
        self.allow.iter().fold(options, |options, &id| options.allow(id))
    }
}

/// Judges an answer to a boundary with a known verdict.
///
/// A mesh without triangles, and an answer that cannot be read, are as good as a refusal when
/// the boundary is invalid.
///
/// ```
/// use trigrade::torture::generate::{Claim, case};
/// use trigrade::torture::judge::{Answer, Class, Demands, judge};
///
/// let case = case(1, 0);
/// let verdict = judge(&case.domain, case.claim, &Answer::Refused("no".into()), &Demands::default());
/// assert_eq!(verdict.class, Class::RefusedValid);
/// ```
///
/// # Complexity
/// That of [`check`].
#[must_use]
pub fn judge(domain: &Domain, claim: Claim, answer: &Answer, demands: &Demands) -> Judgement {
    match (answer, claim) {
        (Answer::Crash(how), _) => Judgement::new(Class::Crash, how),
        (Answer::Hang(how), _) => Judgement::new(Class::Hang, how),
        (Answer::OutOfMemory(how), _) => Judgement::new(Class::OutOfMemory, how),
        (Answer::Limit(why), _) => Judgement::new(Class::Limit, why),
        (Answer::NotAsked(why), _) => Judgement::new(Class::NotAsked, why),
        (Answer::Refused(why), Claim::Valid) => Judgement::new(Class::RefusedValid, why),
        (Answer::Unreadable(why), Claim::Valid) => Judgement::new(Class::Unreadable, why),
        (Answer::Mesh(mesh), Claim::Valid) => judge_mesh(domain, mesh, demands),
        (Answer::Mesh(mesh), Claim::Invalid(fault)) if !mesh.triangles.is_empty() => {
            let triangles = mesh.triangles.len() as u64;
            let reason = format!("meshed into {triangles} triangles in spite of rule {fault}");
            Judgement { triangles, ..Judgement::new(Class::AcceptedInvalid, reason) }
        }
        (Answer::Mesh(_) | Answer::Refused(_) | Answer::Unreadable(_), Claim::Invalid(_)) => {
            Judgement::new(Class::Passed, "")
        }
    }
}

fn judge_mesh(domain: &Domain, mesh: &MeshData, demands: &Demands) -> Judgement {
    let report = check(mesh, Some(domain), &demands.options());
    let failing = |count: &&crate::check::report::IdCount| !count.allowed;
    let findings: Vec<Id> = report.counts.iter().filter(failing).map(|count| count.id).collect();
    Judgement {
        class: class_of(&report, &findings),
        reason: reason_of(&report),
        findings,
        triangles: mesh.triangles.len() as u64,
        radius_ratio_max: report
            .quality
            .as_ref()
            .and_then(|quality| quality.summary(Metric::RadiusRatio))
            .and_then(|summary| summary.max)
            .filter(|ratio| ratio.is_finite()),
    }
}

/// The worst thing that was found decides.
fn class_of(report: &Report, findings: &[Id]) -> Class {
    let is_altered = |id: &Id| {
        matches!(id, Id::BoundaryLost | Id::Deviation | Id::ConstraintLost | Id::PointLost)
    };
    let is_gate = |id: &Id| matches!(id, Id::GateMissed | Id::BaselineMissed);
    match report.verdict {
        Verdict::CouldNotRun if report.statistics.triangles == 0 => Class::WrongMesh,
        Verdict::CouldNotRun => Class::Unreadable,
        Verdict::Passed => Class::Passed,
        Verdict::Failed if findings.iter().all(is_gate) => Class::BelowGate,
        Verdict::Failed if findings.iter().all(|id| is_gate(id) || is_altered(id)) => {
            Class::BoundaryAltered
        }
        Verdict::Failed => Class::WrongMesh,
    }
}

fn reason_of(report: &Report) -> String {
    if report.verdict == Verdict::CouldNotRun && !report.could_not_run.is_empty() {
        return report.could_not_run.join("; ");
    }
    let told = |finding: &Finding| format!("{}: {}", finding.id, finding.message);
    let first = report.findings.iter().find(|finding| !finding.allowed).map(told);
    let gate = || {
        let missed = report.gates.iter().find(|g| g.outcome != crate::check::GateOutcome::Held)?;
        Some(format!("the gate {} is met by {} of {}", missed.gate, missed.met, missed.total))
    };
    first.or_else(gate).unwrap_or_else(|| report.could_not_run.join("; "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::{Loop, LoopRole};
    use crate::point::Point2;

    fn square() -> Domain {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let mut domain = Domain::new(corners.map(Point2::from).to_vec());
        domain.loops.push(Loop::new(vec![0, 1, 2, 3], 1, LoopRole::Any));
        domain
    }

    fn mesh(triangles: &[[u32; 3]]) -> Answer {
        let points = square().points.iter().map(|p| [p.x, p.y, 0.0]).collect();
        Answer::Mesh(Box::new(MeshData {
            points,
            triangles: triangles.to_vec(),
            ..MeshData::default()
        }))
    }

    fn class(answer: &Answer, claim: Claim) -> Class {
        judge(&square(), claim, answer, &Demands::default()).class
    }

    // spec: R3
    #[test]
    fn answers_to_a_valid_boundary() {
        let valid = |answer: &Answer| class(answer, Claim::Valid);
        assert_eq!(valid(&mesh(&[[0, 1, 2], [0, 2, 3]])), Class::Passed);
        assert_eq!(valid(&mesh(&[[0, 1, 2], [0, 3, 2]])), Class::WrongMesh);
        assert_eq!(valid(&mesh(&[[0, 1, 2]])), Class::WrongMesh);
        assert_eq!(valid(&mesh(&[])), Class::WrongMesh);
        assert_eq!(valid(&Answer::Refused("no".into())), Class::RefusedValid);
        assert_eq!(valid(&Answer::Unreadable("?".into())), Class::Unreadable);
        assert_eq!(valid(&Answer::Crash("signal 11".into())), Class::Crash);
        assert_eq!(valid(&Answer::Hang("10 s".into())), Class::Hang);
        assert_eq!(valid(&Answer::OutOfMemory("1 GB".into())), Class::OutOfMemory);
        assert_eq!(valid(&Answer::Limit("too many triangles".into())), Class::Limit);
        assert_eq!(valid(&Answer::NotAsked("roles".into())), Class::NotAsked);
    }

    // spec: R3
    #[test]
    fn answers_to_an_invalid_boundary() {
        let invalid = |answer: &Answer| class(answer, Claim::Invalid("D8"));
        assert_eq!(invalid(&mesh(&[[0, 1, 2], [0, 2, 3]])), Class::AcceptedInvalid);
        assert_eq!(invalid(&mesh(&[])), Class::Passed);
        assert_eq!(invalid(&Answer::Refused("no".into())), Class::Passed);
        assert_eq!(invalid(&Answer::Unreadable("?".into())), Class::Passed);
        assert_eq!(invalid(&Answer::Crash("signal 11".into())), Class::Crash);
        assert_eq!(invalid(&Answer::Hang("10 s".into())), Class::Hang);
    }

    // spec: R3
    #[test]
    fn a_missing_interior_point_is_an_altered_boundary_and_a_gate_is_a_gate() {
        let mut domain = square();
        domain.points.push(Point2::new(0.25, 0.5));
        let answer = mesh(&[[0, 1, 2], [0, 2, 3]]);
        let verdict = judge(&domain, Claim::Valid, &answer, &Demands::default());
        assert_eq!(
            (verdict.class, &verdict.findings[..]),
            (Class::BoundaryAltered, &[Id::PointLost][..])
        );
        let strict = Demands { aspect_max: Some(1.01), ..Demands::default() };
        let verdict = judge(&square(), Claim::Valid, &answer, &strict);
        assert_eq!(verdict.class, Class::BelowGate, "{}", verdict.reason);
        let lenient = Demands { allow: vec![Id::PointLost], ..Demands::default() };
        assert_eq!(judge(&domain, Claim::Valid, &answer, &lenient).class, Class::Passed);
    }

    #[test]
    fn alike_are_verdicts_of_one_class_with_a_common_finding() {
        let with = |class, findings: &[Id]| Judgement {
            findings: findings.to_vec(),
            ..Judgement::new(class, "")
        };
        let a = with(Class::WrongMesh, &[Id::Overlap, Id::Inverted]);
        assert!(a.is_like(&with(Class::WrongMesh, &[Id::Overlap])));
        assert!(!a.is_like(&with(Class::WrongMesh, &[Id::Outside])));
        assert!(!a.is_like(&with(Class::Crash, &[])));
        assert!(with(Class::Crash, &[]).is_like(&with(Class::Crash, &[])));
    }

    #[test]
    fn classes_have_one_name_each() {
        for class in Class::ALL {
            assert_eq!(serde_json::to_value(class).expect("a string"), class.name());
        }
    }
}
