//! The report as JSON: everything that is known, with the names of the files.

use super::Report;
use super::render::Subject;
use serde::Serialize;

/// The document: the report's own fields, then what it is about.
#[derive(Serialize)]
struct Document<'a> {
    #[serde(flatten)]
    report: &'a Report,
    mesh: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    domain: Option<&'a str>,
    generator: &'static str,
}

pub(super) fn json(report: &Report, subject: &Subject<'_>) -> String {
    let generator = concat!("trigrade ", env!("CARGO_PKG_VERSION"));
    let document = Document { report, mesh: subject.mesh, domain: subject.domain, generator };
    // Serialisation of plain data to a string can only fail for maps without text keys.
    let text = serde_json::to_string_pretty(&document);
    text.unwrap_or_else(|error| format!("{{\"error\": \"{error}\"}}")) + "\n"
}
