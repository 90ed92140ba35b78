//! GitLab code quality: a JSON array of issues, as its merge requests show them.

use super::render::{Subject, fingerprint, places};
use super::{Finding, Report};
use serde::Serialize;
use std::collections::BTreeMap;

/// The fields that GitLab asks for.
#[derive(Serialize)]
struct Issue<'a> {
    description: String,
    check_name: String,
    fingerprint: String,
    severity: &'static str,
    location: Location<'a>,
}

#[derive(Serialize)]
struct Location<'a> {
    path: &'a str,
    lines: Lines,
}

#[derive(Serialize)]
struct Lines {
    begin: u64,
}

pub(super) fn gitlab(report: &Report, subject: &Subject<'_>) -> String {
    let mut seen = BTreeMap::new();
    let failures = report.could_not_run.iter().enumerate().map(|(i, why)| Issue {
        description: format!("could not run: {why}"),
        check_name: "could-not-run".to_owned(),
        fingerprint: format!("could-not-run-{i}"),
        severity: "blocker",
        location: Location { path: subject.mesh, lines: Lines { begin: 1 } },
    });
    let issues: Vec<Issue<'_>> =
        failures.chain(report.findings.iter().map(|f| issue(f, subject, &mut seen))).collect();
    // Plain data always serialises; an invalid document would fail the job, as it should.
    serde_json::to_string_pretty(&issues).unwrap_or_default() + "\n"
}

fn issue<'a>(finding: &Finding, subject: &Subject<'a>, seen: &mut BTreeMap<u64, u32>) -> Issue<'a> {
    // GitLab drops all but one issue of a fingerprint, so equal findings are numbered.
    let print = fingerprint(finding);
    let repeats = seen.entry(print).and_modify(|n| *n += 1).or_insert(0);
    let all = places(finding, subject);
    let at = all.iter().find(|place| place.line.is_some()).unwrap_or(&all[0]);
    Issue {
        description: format!("{}: {}", finding.id, finding.message),
        check_name: format!("{}-{}", finding.id, finding.id.slug()),
        fingerprint: format!("{print:016x}-{repeats}"),
        severity: if finding.allowed { "info" } else { "critical" },
        // GitLab demands a line; the first one stands for the file.
        location: Location { path: at.file, lines: Lines { begin: at.line.unwrap_or(1) } },
    }
}
