//! The report for people, as a compiler tells errors: what, where, which rule.

use super::render::{Place, Subject, findings_count, places, verdict};
use super::{Finding, Report};
use crate::check::quality::{Better, MetricSummary};
use crate::check::{GateOutcome, GateResult};
use std::fmt::Write as _;

/// Places shown of a finding; one may touch thousands of triangles.
const PLACES_MAX: usize = 8;

pub(super) fn text(report: &Report, subject: &Subject<'_>) -> String {
    let mut out = String::new();
    for finding in &report.findings {
        push_finding(&mut out, finding, subject);
    }
    for entry in report.counts.iter().filter(|entry| entry.count > entry.listed) {
        let rest = entry.count - entry.listed;
        let _ = writeln!(out, "... and {} more of {}\n", findings_count(rest), entry.id);
    }
    push_facts(&mut out, report, subject);
    push_quality(&mut out, report);
    for gate in &report.gates {
        let _ = writeln!(out, "  gate        {}", gate_line(gate));
    }
    push_checked(&mut out, report);
    let _ = writeln!(out, "  verdict     {}", verdict(report));
    out
}

fn push_finding(out: &mut String, finding: &Finding, subject: &Subject<'_>) {
    let id = finding.id;
    let level = if finding.allowed { "allowed" } else { "error" };
    let _ = writeln!(out, "{level}[{id}]: {}", finding.message);
    let all = places(finding, subject);
    for place in all.iter().take(PLACES_MAX) {
        push_place(out, place);
    }
    if all.len() > PLACES_MAX {
        let _ = writeln!(out, "  ... and {} more places", all.len() - PLACES_MAX);
    }
    if !finding.measured.is_empty() {
        let values = finding.measured.iter().map(|(name, value)| format!("{name} {value}"));
        let _ = writeln!(out, "  measured: {}", values.collect::<Vec<_>>().join(", "));
    }
    let _ = writeln!(out, "  rule: {}; see `trigrade explain {id}`\n", id.rule());
}

fn push_place(out: &mut String, place: &Place<'_>) {
    let _ = writeln!(out, "  --> {place}");
}

fn push_facts(out: &mut String, report: &Report, subject: &Subject<'_>) {
    let facts = &report.statistics;
    let (t, p) = (facts.triangles, facts.points);
    let _ = writeln!(out, "{}: {t} triangles, {p} points", subject.mesh);
    let _ = writeln!(
        out,
        "  boundary    {} edges, {} loops; {} components, Euler number {}",
        facts.boundary_edges, facts.boundary_loops, facts.components, facts.euler
    );
    if let Some(rounded) = facts.area.as_ref().and_then(|area| area.rounded) {
        let _ = writeln!(out, "  area        {rounded}");
    }
    if let Some(deviation) = facts.deviation.as_ref().filter(|d| d.nodes > 0) {
        let _ = writeln!(
            out,
            "  deviation   {} nodes on {} subdivided segments, at most {} ({:.3} ulps) off",
            deviation.nodes,
            deviation.subdivided_segments,
            deviation.length_max,
            deviation.ulps_max
        );
    }
    for other in &facts.other_cells {
        let _ = writeln!(out, "  not checked {} {}", other.count, other.kind);
    }
}

/// A line a metric: its name, its figures, its formula.
fn push_quality(out: &mut String, report: &Report) {
    let Some(quality) = &report.quality else { return };
    let _ = writeln!(
        out,
        "  {:<22} {:>12} {:>12} {:>12} {:>12}  formula",
        "quality", "min", "mean", "99 % within", "max"
    );
    for metric in &quality.metrics {
        let within = if metric.better == Better::Higher {
            metric.percentile_1
        } else {
            metric.percentile_99
        };
        let [min, mean, within, max] =
            [metric.min, metric.mean, within, bounded_max(metric)].map(figure);
        let _ = writeln!(
            out,
            "  {:<22} {min:>12} {mean:>12} {within:>12} {max:>12}  {}",
            metric.metric.name(),
            metric.formula
        );
    }
}

/// The largest value, `None` when some triangle's is infinite.
fn bounded_max(metric: &MetricSummary) -> Option<f64> {
    metric.max.filter(|_| metric.infinite == 0)
}

/// A value to five significant digits or so.
pub(super) fn figure(value: Option<f64>) -> String {
    match value {
        None => "infinite".to_owned(),
        Some(v) if v == 0.0 || (1e-3..1e6).contains(&v.abs()) => {
            let text = format!("{v:.4}");
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        }
        Some(v) => format!("{v:.4e}"),
    }
}

/// A gate and what became of it.
pub(super) fn gate_line(gate: &GateResult) -> String {
    let shares = format!("{} of {} triangles", gate.met, gate.total);
    match gate.outcome {
        GateOutcome::Held => format!("{}: holds for {shares}", gate.gate),
        GateOutcome::Missed => {
            format!("{}: MISSED, holds for only {shares}, worst {}", gate.gate, figure(gate.worst))
        }
        GateOutcome::CouldNotRun => format!("{}: could not be evaluated", gate.gate),
    }
}

/// The ids that were checked, and those that were not with the reason.
fn push_checked(out: &mut String, report: &Report) {
    let codes: Vec<_> = report.checked.iter().map(|id| id.code()).collect();
    let _ = writeln!(out, "  checked     {}", codes.join(" "));
    // Ids with one reason share a line, in the order of their first one.
    let mut reasons: Vec<(&str, Vec<&str>)> = Vec::new();
    for entry in &report.not_checked {
        match reasons.iter_mut().find(|reason| reason.0 == entry.why) {
            Some(reason) => reason.1.push(entry.id.code()),
            None => reasons.push((&entry.why, vec![entry.id.code()])),
        }
    }
    for (why, codes) in reasons {
        let _ = writeln!(out, "  not checked {} ({why})", codes.join(" "));
    }
}
