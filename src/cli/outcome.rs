//! What a verb hands back, and where the reports of a run go.

use super::arguments::{Global, ReportKind, ReportTarget};
use super::failure::{Diagnostic, EXIT_FINDINGS, Failure};
use super::input::is_dash;
use super::output::{Cleanup, Outputs};
use serde_json::{Value, json};
use std::path::PathBuf;

/// The end of a run that could be carried out.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// 0 or 1.
    pub exit: u8,
    /// For people, without a final line end; empty for verbs whose result is printed already.
    pub text: String,
    /// For programs.
    pub json: Value,
}

/// A failure as programs read it.
#[must_use]
pub fn failure_json(failure: &Failure) -> Value {
    let complaint = |d: &Diagnostic| json!({ "rule": d.rule, "message": d.message, "places": d.places, "help": d.helps });
    json!({
        "schema": "trigrade-failure/1",
        "verdict": if failure.exit == EXIT_FINDINGS { "invalid" } else { "could-not-run" },
        "errors": failure.diagnostics.iter().map(complaint).collect::<Vec<_>>(),
    })
}

/// A failure as people read it.
#[must_use]
pub fn failure_text(failure: &Failure) -> String {
    let texts: Vec<String> = failure.diagnostics.iter().map(Diagnostic::to_string).collect();
    texts.join("\n")
}

/// The reports that a run must write, staged before its work begins.
#[derive(Debug)]
pub struct Reports {
    kinds: Vec<ReportKind>,
    outputs: Outputs,
}

impl Reports {
    /// Stages the reports of `global`.
    ///
    /// # Errors
    /// Exit code 2 when a report cannot be written where it is wanted.
    pub fn prepare(global: &Global, cleanup: &Cleanup) -> Result<Self, Failure> {
        let targets = wanted(global);
        let paths: Vec<PathBuf> = targets.iter().map(|target| target.path.clone()).collect();
        let outputs = Outputs::prepare(&paths, cleanup)?;
        Ok(Self { kinds: targets.iter().map(|target| target.kind).collect(), outputs })
    }

    /// Writes them.
    ///
    /// # Errors
    /// Exit code 2 when the disk refuses.
    pub fn write(mut self, text: &str, json: &Value) -> Result<(), Failure> {
        for (i, kind) in self.kinds.iter().enumerate() {
            self.outputs.fill(i, |out| match kind {
                ReportKind::Text => writeln!(out, "{text}"),
                ReportKind::Json => writeln!(out, "{json:#}"),
            })?;
        }
        self.outputs.commit()
    }
}

/// All reports asked for; `--json` is `--report json=-`.
fn wanted(global: &Global) -> Vec<ReportTarget> {
    let mut targets = global.report.clone();
    if global.json {
        targets.push(ReportTarget { kind: ReportKind::Json, path: "-".into() });
    }
    targets
}

/// Whether anything but text for people goes to standard output.
///
/// # Errors
/// Exit code 2 when two things would.
pub fn is_stdout_taken(global: &Global, outputs: &[PathBuf]) -> Result<bool, Failure> {
    let reports = wanted(global);
    let dashes = reports.iter().map(|report| &report.path).chain(outputs).filter(|p| is_dash(p));
    match dashes.count() {
        0 => Ok(false),
        1 => Ok(true),
        _ => Err(Failure::cannot_run(
            Diagnostic::new("two things cannot both go to standard output")
                .help("send the report to a file: --report json=FILE"),
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_one_thing_goes_to_standard_output() {
        let json = Global { json: true, ..Global::default() };
        let (file, dash) = ([PathBuf::from("a.off")], [PathBuf::from("-")]);
        assert_eq!(is_stdout_taken(&Global::default(), &file), Ok(false));
        assert_eq!(is_stdout_taken(&Global::default(), &dash), Ok(true));
        assert_eq!(is_stdout_taken(&json, &file), Ok(true));
        assert_eq!(is_stdout_taken(&json, &dash).expect_err("both").exit, 2);
    }

    #[test]
    fn a_failure_is_json_with_its_rules_and_places() {
        let diagnostic = Diagnostic::new("loops cross").rule("D8").at("a.poly:3");
        let json = failure_json(&Failure::findings(vec![diagnostic]));
        assert_eq!(json["verdict"], "invalid");
        assert_eq!(json["errors"][0]["rule"], "D8");
        assert_eq!(json["errors"][0]["places"][0], "a.poly:3");
    }

    #[test]
    fn reports_are_written_where_they_are_wanted() {
        let folder = tempfile::tempdir().expect("a temporary directory");
        let target = |kind, name: &str| ReportTarget { kind, path: folder.path().join(name) };
        let report = vec![target(ReportKind::Text, "a.txt"), target(ReportKind::Json, "a.json")];
        let global = Global { report, ..Global::default() };
        let reports = Reports::prepare(&global, &Cleanup::default()).expect("writable");
        reports.write("words", &json!({"verdict": "passed"})).expect("written");
        let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).expect("there");
        assert_eq!(read("a.txt"), "words\n");
        assert!(read("a.json").contains("\"verdict\": \"passed\""));
    }
}
