//! The checker's answer, told to people: a sentence, or the findings as a compiler tells errors.

use super::failure::Diagnostic;
use super::words::count;
use crate::check::{CheckOptions, Finding, GateOutcome, Metric, Report, Verdict, check};
use crate::domain::Domain;
use crate::mesh::MeshData;
use serde_json::{Value, json};
use std::fmt;

/// Checks a mesh with the default options, against its domain when there is one.
#[must_use]
pub fn check_mesh(mesh: &MeshData, domain: Option<&Domain>) -> Report {
    check(mesh, domain, &CheckOptions::default())
}

/// The verdict in a word.
#[must_use]
pub fn word(report: &Report) -> &'static str {
    match report.verdict {
        Verdict::Passed => "passed",
        Verdict::Failed => "failed",
        Verdict::CouldNotRun => "could-not-run",
    }
}

/// The verdict in a sentence.
#[must_use]
pub fn sentence(report: &Report, name: &str) -> String {
    match report.verdict {
        Verdict::Passed => {
            format!("passed: {name} was read back and keeps {} rules", report.checked.len())
        }
        Verdict::Failed => {
            format!("FAILED: {name} has {}", findings_in_words(report))
        }
        Verdict::CouldNotRun => {
            format!("could not run on {name}: {}", report.could_not_run.join("; "))
        }
    }
}

/// The findings of a report, each as a complaint with its places; counts are exact.
#[must_use]
pub fn findings(report: &Report, name: &str) -> String {
    let mut texts: Vec<String> = Vec::new();
    for finding in report.findings.iter().filter(|finding| !finding.allowed) {
        texts.push(complaint(finding, name).to_string());
    }
    for entry in report.counts.iter().filter(|entry| entry.count > entry.listed) {
        let rest = count(entry.count - entry.listed);
        texts.push(format!("... and {rest} more findings of {}", entry.id));
    }
    texts.join("\n")
}

fn complaint(finding: &Finding, name: &str) -> Diagnostic {
    let mut diagnostic = Diagnostic::new(finding.message.clone()).rule(finding.id.code());
    for triangle in &finding.triangles {
        diagnostic = match triangle.line {
            Some(line) => diagnostic.at(format!("{name}:{line} triangle {}", triangle.number)),
            None => diagnostic.at(format!("{name} triangle {}", triangle.number)),
        };
    }
    // Where triangles are named, their corners would only repeat the places.
    for vertex in finding.vertices.iter().filter(|_| finding.triangles.is_empty()) {
        diagnostic = match vertex.line {
            Some(line) => diagnostic.at(format!("{name}:{line} point {}", vertex.number)),
            None => diagnostic.at(format!("{name} point {}", vertex.number)),
        };
    }
    for place in finding.domain.iter().filter_map(|place| place.source.as_deref()) {
        diagnostic = diagnostic.at(format!("the domain, {place}"));
    }
    diagnostic
}

/// The whole answer for people.
#[must_use]
pub fn text(report: &Report, name: &str) -> String {
    let mut lines = Vec::new();
    let complaints = findings(report, name);
    lines.extend((!complaints.is_empty()).then_some(complaints));
    let facts = &report.statistics;
    let [triangles, points] = [facts.triangles, facts.points].map(count);
    lines.push(format!("{name}: {triangles} triangles, {points} points"));
    let mut line = |label: &str, text: String| lines.push(format!("  {label:<11}{text}"));
    if let Some(figures) = Figures::of(report) {
        line("quality", figures.to_string());
    }
    line(
        "boundary",
        format!("{} edges, {} loops", count(facts.boundary_edges), facts.boundary_loops),
    );
    if let Some(area) = &facts.area
        && let Some(rounded) = area.rounded
    {
        line("area", format!("{rounded}"));
    }
    for other in &facts.other_cells {
        line("not checked", format!("{} {}", count(other.count), other.kind));
    }
    for gate in &report.gates {
        let outcome = match gate.outcome {
            GateOutcome::Held => "holds",
            GateOutcome::Missed => "MISSED",
            GateOutcome::CouldNotRun => "could not be evaluated",
        };
        line("gate", format!("{}: {outcome}", gate.gate));
    }
    line("verdict", verdict_line(report));
    lines.join("\n")
}

fn verdict_line(report: &Report) -> String {
    match report.verdict {
        Verdict::Passed => format!("passed: {} rules hold", report.checked.len()),
        Verdict::Failed => format!("FAILED: {}", findings_in_words(report)),
        Verdict::CouldNotRun => format!("could not run: {}", report.could_not_run.join("; ")),
    }
}

/// How many findings make the check fail, exactly.
fn findings_in_words(report: &Report) -> String {
    match report.counts.iter().filter(|entry| !entry.allowed).map(|entry| entry.count).sum() {
        1 => "1 finding".to_owned(),
        total => format!("{} findings", count(total)),
    }
}

/// The report as JSON.
#[must_use]
pub fn json(report: &Report) -> Value {
    serde_json::to_value(report).unwrap_or_else(|e| json!({ "error": e.to_string() }))
}

/// The few figures of quality that every summary shows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Figures {
    /// Mean of R / 2r.
    pub mean: f64,
    /// R / 2r that 99 % of the triangles do not exceed.
    pub p99: f64,
    /// Largest R / 2r.
    pub max: f64,
    /// Smallest angle in degrees.
    pub angle_min_deg: f64,
}

impl Figures {
    /// From a report that measured quality.
    #[must_use]
    pub fn of(report: &Report) -> Option<Self> {
        let quality = report.quality.as_ref()?;
        let ratio = quality.summary(Metric::RadiusRatio)?;
        Some(Self {
            mean: ratio.mean?,
            p99: ratio.percentile_99?,
            max: ratio.max?,
            angle_min_deg: quality.summary(Metric::MinAngle)?.min?,
        })
    }

    /// As JSON.
    #[must_use]
    pub fn json(&self) -> Value {
        json!({
            "mean": self.mean,
            "p99": self.p99,
            "max": self.max,
            "angle_min_deg": self.angle_min_deg,
        })
    }
}

impl fmt::Display for Figures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "R/2r mean {:.4}, 99 % {:.3}, max {:.3}; smallest angle {:.1}°",
            self.mean, self.p99, self.max, self.angle_min_deg
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A right triangle with legs 4 and 1, and another one on its hypotenuse that is flat.
    fn mesh(triangles: &[[u32; 3]]) -> MeshData {
        let points = [[0.0, 0.0], [4.0, 0.0], [0.0, 1.0], [2.0, 0.5]];
        let points = points.iter().map(|&[x, y]| [x, y, 0.0]).collect();
        MeshData { points, triangles: triangles.to_vec(), ..MeshData::default() }
    }

    #[test]
    fn a_sound_mesh_is_told_in_figures() {
        let mut sound = mesh(&[[0, 1, 2]]);
        sound.points.truncate(3);
        let report = check_mesh(&sound, None);
        assert_eq!((word(&report), findings(&report, "a.off")), ("passed", String::new()));
        let figures = Figures::of(&report).expect("measured");
        // R is half the hypotenuse, r half of what the legs exceed it by.
        let hypotenuse = 17.0_f64.sqrt();
        let ratio = (hypotenuse / 2.0) / (5.0 - hypotenuse);
        assert!((figures.max - ratio).abs() < 1e-12, "{figures:?}");
        assert!((figures.angle_min_deg - 0.25_f64.atan().to_degrees()).abs() < 1e-9);
        assert!(text(&report, "a.off").contains("passed"));
    }

    // spec: K4
    #[test]
    fn findings_are_told_with_rule_and_place() {
        let report = check_mesh(&mesh(&[[0, 1, 2], [1, 2, 3]]), None);
        assert_eq!(word(&report), "failed");
        let told = findings(&report, "a.off");
        assert!(told.starts_with("error[M"), "{told}");
        assert!(told.contains("--> a.off triangle 1"), "{told}");
        assert!(told.contains("trigrade explain M"), "{told}");
        assert!(sentence(&report, "a.off").contains("FAILED"));
    }

    #[test]
    fn an_empty_mesh_is_no_pass() {
        let report = check_mesh(&MeshData::default(), None);
        assert_ne!(word(&report), "passed");
        assert_eq!(Figures::of(&report), None);
    }
}
