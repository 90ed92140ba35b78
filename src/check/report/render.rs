//! Reports in the forms that people, scripts and CI services read.
//!
//! Every form is made from the same [`Report`] and nothing else, so they cannot disagree about the
//! verdict (SPEC C40). None contains a time, a host or a random number: the same report gives the
//! same bytes.

use super::{Finding, IdCount, Report};
use crate::check::Id;

/// What was checked, as the user named it; reports point into these files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Subject<'a> {
    /// The mesh file.
    pub mesh: &'a str,
    /// The domain file, if one was given.
    pub domain: Option<&'a str>,
}

/// The forms a report comes in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Form {
    /// For people, as a compiler tells errors.
    Text,
    /// All that is known, by the schema [`SCHEMA`](super::SCHEMA).
    Json,
    /// JUnit XML: a test case for each id and each gate.
    Junit,
    /// SARIF 2.1.0, for code scanning.
    Sarif,
    /// Workflow commands that GitHub shows beside the files.
    Github,
    /// Markdown for the summary page of a GitHub job.
    GithubSummary,
    /// Code quality JSON of GitLab.
    Gitlab,
    /// Test Anything Protocol, version 13: a test for each id and each gate.
    Tap,
}

impl Form {
    /// Every form.
    pub const ALL: [Self; 8] = [
        Self::Text,
        Self::Json,
        Self::Junit,
        Self::Sarif,
        Self::Github,
        Self::GithubSummary,
        Self::Gitlab,
        Self::Tap,
    ];

    /// The name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Text => "text",
            Self::Json => "json",
            Self::Junit => "junit",
            Self::Sarif => "sarif",
            Self::Github => "github",
            Self::GithubSummary => "github-summary",
            Self::Gitlab => "gitlab",
            Self::Tap => "tap",
        }
    }
}

impl std::fmt::Display for Form {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}

/// Text that names no form.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("'{0}' is no form of report; the forms are {forms}", forms = form_names())]
pub struct UnknownForm(pub String);

fn form_names() -> String {
    Form::ALL.map(Form::name).join(", ")
}

impl std::str::FromStr for Form {
    type Err = UnknownForm;

    fn from_str(text: &str) -> Result<Self, UnknownForm> {
        let named = |form: &Form| form.name() == text;
        Form::ALL.into_iter().find(named).ok_or_else(|| UnknownForm(text.to_owned()))
    }
}

/// The report in a form, with a line end at its end.
///
/// ```
/// use trigrade::check::report::{Form, Subject, render};
/// use trigrade::check::{CheckOptions, check};
/// use trigrade::mesh::MeshData;
///
/// let report = check(&MeshData::default(), None, &CheckOptions::new());
/// let subject = Subject { mesh: "empty.msh", domain: None };
/// assert!(render(&report, Form::Tap, &subject).starts_with("TAP version 13\n"));
/// ```
#[must_use]
pub fn render(report: &Report, form: Form, subject: &Subject<'_>) -> String {
    match form {
        Form::Text => super::text::text(report, subject),
        Form::Json => super::json::json(report, subject),
        Form::Junit => super::junit::junit(report, subject),
        Form::Sarif => super::sarif::sarif(report, subject),
        Form::Github => super::github::annotations(report, subject),
        Form::GithubSummary => super::github::summary(report, subject),
        Form::Gitlab => super::gitlab::gitlab(report, subject),
        Form::Tap => super::tap::tap(report, subject),
    }
}

/// A place that a finding points at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Place<'a> {
    pub(super) file: &'a str,
    /// Line, where the file is text.
    pub(super) line: Option<u64>,
    /// What stands there, e.g. `triangle 12`; empty for the file as a whole.
    pub(super) what: String,
}

impl std::fmt::Display for Place<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.file)?;
        self.line.map_or(Ok(()), |line| write!(f, ":{line}"))?;
        if self.what.is_empty() { Ok(()) } else { write!(f, ": {}", self.what) }
    }
}

/// Where a finding is, the most telling place first; at least the mesh file.
pub(super) fn places<'a>(finding: &Finding, subject: &Subject<'a>) -> Vec<Place<'a>> {
    let file = subject.mesh;
    let triangles = finding.triangles.iter().map(|t| {
        let what = format!("triangle {}", t.number);
        Place { file, line: t.line, what }
    });
    let vertices = finding.vertices.iter().map(|v| {
        let what = format!("point {} {}", v.number, coordinates(&v.coordinates));
        Place { file, line: v.line, what }
    });
    let domain = finding.domain.iter().map(|d| {
        let what = d.source.clone().unwrap_or_else(|| domain_points(&d.coordinates));
        let line = what.strip_prefix("line ").and_then(|n| n.parse().ok());
        Place { file: subject.domain.unwrap_or("the domain"), line, what }
    });
    let mut all: Vec<_> = triangles.chain(vertices).chain(domain).collect();
    if all.is_empty() {
        all.push(Place { file, line: None, what: String::new() });
    }
    all
}

fn coordinates(all: &[Option<f64>; 3]) -> String {
    let in_plane = all[2] == Some(0.0);
    let shown = all[..if in_plane { 2 } else { 3 }].iter();
    let texts = shown.map(|c| c.map_or_else(|| "not finite".to_owned(), |c| format!("{c:?}")));
    format!("({})", texts.collect::<Vec<_>>().join(", "))
}

fn domain_points(points: &[[f64; 2]]) -> String {
    let texts = points.iter().map(|[x, y]| format!("({x:?}, {y:?})"));
    texts.collect::<Vec<_>>().join(" to ")
}

/// How an id came out.
pub(super) enum Status<'a> {
    /// No finding.
    Holds,
    /// Findings that the caller allows.
    Allowed(&'a IdCount),
    /// Findings.
    Fails(&'a IdCount),
    /// The check did not run, with the reason.
    Skipped(&'a str),
}

/// The status of an id.
pub(super) fn status(report: &Report, id: Id) -> Status<'_> {
    if let Some(count) = report.counts.iter().find(|entry| entry.id == id) {
        return if count.allowed { Status::Allowed(count) } else { Status::Fails(count) };
    }
    match report.not_checked.iter().find(|entry| entry.id == id) {
        Some(entry) => Status::Skipped(&entry.why),
        None => Status::Holds,
    }
}

/// The ids a list of tests shows one by one: gates are shown by themselves.
pub(super) fn tested_ids(report: &Report) -> impl Iterator<Item = Id> {
    let by_gate = !report.gates.is_empty();
    Id::all().filter(move |&id| !(by_gate && id == Id::GateMissed))
}

/// The listed findings of an id.
pub(super) fn findings_of(report: &Report, id: Id) -> impl Iterator<Item = &Finding> {
    report.findings.iter().filter(move |finding| finding.id == id)
}

/// `1 finding`, `2 findings`.
pub(super) fn findings_count(n: u64) -> String {
    if n == 1 { "1 finding".to_owned() } else { format!("{n} findings") }
}

/// The verdict in a line.
pub(super) fn verdict(report: &Report) -> String {
    use super::Verdict::{CouldNotRun, Failed, Passed};
    let failing = report.counts.iter().filter(|entry| !entry.allowed);
    let (ids, total) = failing.fold((0, 0), |(ids, total), entry| (ids + 1, total + entry.count));
    match report.verdict {
        Passed => format!("passed: {} rules hold", report.checked.len()),
        Failed => format!("FAILED: {} of {ids} kinds", findings_count(total)),
        CouldNotRun => format!("could not run: {}", report.could_not_run.join("; ")),
    }
}

/// A name for a finding that is the same in every run over the same mesh, however lines move:
/// FNV-1a (Fowler, Noll, Vo; 64 bits) over the id, the message and the numbers of its places.
pub(super) fn fingerprint(finding: &Finding) -> u64 {
    let triangles = finding.triangles.iter().map(|t| t.number);
    let vertices = finding.vertices.iter().map(|v| v.number);
    let mut hash = Fnv::new();
    hash.add(finding.id.code().as_bytes());
    hash.add(finding.message.as_bytes());
    for number in triangles.chain(vertices) {
        hash.add(&number.to_le_bytes());
    }
    hash.0
}

struct Fnv(u64);

impl Fnv {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn add(&mut self, bytes: &[u8]) {
        for &byte in bytes.iter().chain(&[0]) {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}
