//! SARIF 2.1.0 (OASIS, 2020), the subset that code scanning services read.
//!
//! A line of a text file is a `region`; triangles and points of binary files have only a logical
//! location.

use super::render::{Place, Subject, findings_count, fingerprint, places};
use super::{Finding, Report, Verdict};
use crate::check::Id;
use serde_json::{Map, Value, json};

const SCHEMA: &str =
    "https://docs.oasis-open.org/sarif/sarif/v2.1.0/os/schemas/sarif-schema-2.1.0.json";

pub(super) fn sarif(report: &Report, subject: &Subject<'_>) -> String {
    let rules: Vec<Value> = Id::all().map(rule).collect();
    let results: Vec<Value> = report.findings.iter().map(|f| result(f, subject)).collect();
    let document = json!({
        "$schema": SCHEMA,
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": {
                "name": "trigrade",
                "version": env!("CARGO_PKG_VERSION"),
                "rules": rules,
            }},
            "artifacts": artifacts(subject),
            "invocations": [invocation(report)],
            "results": results,
            // Triangle and point numbers are the file's own; columns are never given.
            "columnKind": "unicodeCodePoints",
        }],
    });
    format!("{document:#}\n")
}

fn rule(id: Id) -> Value {
    json!({
        "id": id.code(),
        "name": id.slug(),
        "shortDescription": { "text": id.rule() },
        "help": { "text": format!("Run `trigrade explain {id}` for the rule in full.") },
        "defaultConfiguration": { "level": "error" },
    })
}

fn artifacts(subject: &Subject<'_>) -> Vec<Value> {
    let files = [Some(subject.mesh), subject.domain];
    files.into_iter().flatten().map(|f| json!({ "location": { "uri": uri(f) } })).collect()
}

/// How the run went: what could not be checked, and findings that are counted but not listed.
fn invocation(report: &Report) -> Value {
    let failures = report.could_not_run.iter().map(|why| notification("error", why));
    let unlisted = report.counts.iter().filter(|entry| entry.count > entry.listed).map(|entry| {
        let rest = findings_count(entry.count - entry.listed);
        notification("note", &format!("{rest} of {} are counted but not listed", entry.id))
    });
    json!({
        "executionSuccessful": report.verdict != Verdict::CouldNotRun,
        "exitCode": report.exit_code(),
        "toolExecutionNotifications": failures.chain(unlisted).collect::<Vec<_>>(),
    })
}

fn notification(level: &str, text: &str) -> Value {
    json!({ "level": level, "message": { "text": text } })
}

fn result(finding: &Finding, subject: &Subject<'_>) -> Value {
    let all = places(finding, subject);
    let (first, rest) = all.split_first().expect("places gives at least the file");
    let related = rest.iter().enumerate().map(|(i, place)| {
        let mut location = location(place);
        location.insert("id".into(), json!(i + 1));
        location.insert("message".into(), json!({ "text": place.what }));
        location
    });
    let mut result = json!({
        "ruleId": finding.id.code(),
        "ruleIndex": finding.id as usize,
        "level": if finding.allowed { "note" } else { "error" },
        "message": { "text": finding.message },
        "locations": [location(first)],
        "relatedLocations": related.collect::<Vec<_>>(),
        "partialFingerprints": { "trigradeFinding/v1": format!("{:016x}", fingerprint(finding)) },
        "properties": { "measured": finding.measured },
    });
    if finding.allowed {
        let why = "allowed by the caller";
        result["suppressions"] = json!([{ "kind": "external", "justification": why }]);
    }
    result
}

fn location(place: &Place<'_>) -> Map<String, Value> {
    let mut physical = json!({ "artifactLocation": { "uri": uri(place.file) } });
    if let Some(line) = place.line {
        physical["region"] = json!({ "startLine": line });
    }
    let mut location = Map::new();
    location.insert("physicalLocation".into(), physical);
    if !place.what.is_empty() {
        location.insert("logicalLocations".into(), json!([{ "fullyQualifiedName": place.what }]));
    }
    location
}

/// A path as a URI reference (RFC 3986): every byte but unreserved ones and slashes is escaped.
fn uri(path: &str) -> String {
    let mut out = String::new();
    let path = path.replace('\\', "/");
    // "//host/..." and "c:/..." must not read as an authority or a scheme.
    if path.starts_with('/') || path.as_bytes().get(1) == Some(&b':') {
        out.push_str("file:///");
    }
    for byte in path.trim_start_matches('/').bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' => {
                out.push(char::from(byte));
            }
            _ => out.push_str(&format!("%{byte:02X}")),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::uri;

    #[test]
    fn paths_become_uri_references() {
        for (path, expected) in [
            ("wing.msh", "wing.msh"),
            ("a dir/größe#1.msh", "a%20dir/gr%C3%B6%C3%9Fe%231.msh"),
            ("/tmp/a.msh", "file:///tmp/a.msh"),
            ("//host/a.msh", "file:///host/a.msh"),
            (r"C:\meshes\a.msh", "file:///C%3A/meshes/a.msh"),
            ("100%.msh", "100%25.msh"),
            ("", ""),
        ] {
            assert_eq!(uri(path), expected, "{path}");
        }
    }
}
