//! GitHub: workflow commands that become annotations, and Markdown for a job's summary page.

use super::render::{Subject, findings_count, places, verdict};
use super::text::{figure, gate_line};
use super::{Finding, Report, Verdict};
use crate::check::quality::MetricSummary;
use crate::check::{GateOutcome, Metric};
use std::fmt::Write as _;

/// Annotations of one level that GitHub shows for a step; further ones are lost silently.
const ANNOTATIONS_MAX: usize = 10;
/// Rows of the summary's table of findings.
const ROWS_MAX: usize = 50;

/// Workflow commands, one a line: an `error` for each finding, a `notice` with the verdict.
pub(super) fn annotations(report: &Report, subject: &Subject<'_>) -> String {
    let mut out = String::new();
    for why in report.could_not_run.iter().take(ANNOTATIONS_MAX) {
        let file = property(subject.mesh);
        let _ = writeln!(out, "::error file={file},title=could not run::{}", data(why));
    }
    let room = ANNOTATIONS_MAX.saturating_sub(report.could_not_run.len());
    let failing = report.findings.iter().filter(|finding| !finding.allowed);
    for finding in failing.take(room) {
        push_command(&mut out, finding, subject);
    }
    let file = property(subject.mesh);
    let _ = writeln!(out, "::notice file={file},title=trigrade check::{}", data(&verdict(report)));
    out
}

fn push_command(out: &mut String, finding: &Finding, subject: &Subject<'_>) {
    let all = places(finding, subject);
    let at = all.iter().find(|place| place.line.is_some()).unwrap_or(&all[0]);
    let _ = write!(out, "::error file={}", property(at.file));
    if let Some(line) = at.line {
        let _ = write!(out, ",line={line}");
    }
    let title = format!("{} {}", finding.id, finding.id.slug());
    let _ = writeln!(out, ",title={}::{}", property(&title), data(&finding.message));
}

/// Text behind the `::` of a command.
fn data(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

/// A property of a command, which also must not hold its separators.
fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

/// Markdown for the file that `GITHUB_STEP_SUMMARY` names.
pub(super) fn summary(report: &Report, subject: &Subject<'_>) -> String {
    let mut out = String::new();
    let sign = match report.verdict {
        Verdict::Passed => "✅",
        Verdict::Failed => "❌",
        Verdict::CouldNotRun => "⚠️",
    };
    let _ = writeln!(out, "## {sign} {}: {}\n", cell(subject.mesh), cell(&verdict(report)));
    let facts = &report.statistics;
    let _ = writeln!(
        out,
        "{} triangles, {} points, {} boundary edges in {} loops.\n",
        facts.triangles, facts.points, facts.boundary_edges, facts.boundary_loops
    );
    push_findings(&mut out, report, subject);
    push_quality(&mut out, report);
    push_gates(&mut out, report);
    out
}

fn push_findings(out: &mut String, report: &Report, subject: &Subject<'_>) {
    if report.counts.is_empty() {
        return;
    }
    out.push_str("| rule | finding | place |\n|---|---|---|\n");
    for finding in report.findings.iter().take(ROWS_MAX) {
        let place = places(finding, subject).first().map(ToString::to_string).unwrap_or_default();
        let allowed = if finding.allowed { " (allowed)" } else { "" };
        let (message, place) = (cell(&finding.message), cell(&place));
        let _ = writeln!(out, "| {}{allowed} | {message} | {place} |", finding.id);
    }
    let total: u64 = report.counts.iter().map(|entry| entry.count).sum();
    let shown = report.findings.len().min(ROWS_MAX) as u64;
    if total > shown {
        let _ = writeln!(out, "| | and {} more | |", findings_count(total - shown));
    }
    out.push('\n');
}

fn push_quality(out: &mut String, report: &Report) {
    let Some(quality) = &report.quality else { return };
    out.push_str("| quality | min | mean | max | formula |\n|---|---:|---:|---:|---|\n");
    let shown = [Metric::RadiusRatio, Metric::MinAngle, Metric::MaxAngle, Metric::AreaSpread];
    for metric in shown.into_iter().filter_map(|metric| quality.summary(metric)) {
        push_metric(out, metric);
    }
    out.push('\n');
}

fn push_metric(out: &mut String, metric: &MetricSummary) {
    let max = metric.max.filter(|_| metric.infinite == 0);
    let [min, mean, max] = [metric.min, metric.mean, max].map(figure);
    let (name, formula) = (metric.metric.name(), cell(&metric.formula));
    let _ = writeln!(out, "| {name} | {min} | {mean} | {max} | {formula} |");
}

fn push_gates(out: &mut String, report: &Report) {
    for gate in &report.gates {
        let sign = match gate.outcome {
            GateOutcome::Held => "✅",
            GateOutcome::Missed => "❌",
            GateOutcome::CouldNotRun => "⚠️",
        };
        let _ = writeln!(out, "- {sign} {}", cell(&gate_line(gate)));
    }
}

/// Text inside a cell: nothing in it is Markdown or HTML, and it has one line.
fn cell(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '\n' | '\r' => out.push(' '),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            '|' | '\\' | '`' | '*' | '_' | '[' | ']' | '#' | '~' => {
                out.push('\\');
                out.push(c);
            }
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn separators_of_commands_are_escaped() {
        assert_eq!(data("100% of\r\nx:y,z"), "100%25 of%0D%0Ax:y,z");
        assert_eq!(property("C:\\a,b\n%"), "C%3A\\a%2Cb%0A%25");
    }

    #[test]
    fn cells_hold_no_markup() {
        assert_eq!(cell("a|b\n<img>`x`"), "a\\|b &lt;img&gt;\\`x\\`");
    }
}
