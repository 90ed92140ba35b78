//! What a verb hands back, and where the reports of a run go.

use super::arguments::{Global, ReportTarget};
use super::failure::{Diagnostic, EXIT_FINDINGS, Failure};
use super::input::is_dash;
use super::output::{Cleanup, Outputs};
use crate::check::Report;
use crate::check::report::{Form, Subject, render};
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
    /// The verdict that the other forms of report tell, for verbs that check a mesh.
    pub checked: Option<Box<Checked>>,
}

/// A checked mesh, as reports name it.
#[derive(Clone, Debug, PartialEq)]
pub struct Checked {
    /// What the checker said.
    pub report: Report,
    /// The mesh file.
    pub mesh: String,
    /// The domain file.
    pub domain: Option<String>,
}

impl Checked {
    fn render(&self, form: Form) -> String {
        let subject = Subject { mesh: &self.mesh, domain: self.domain.as_deref() };
        render(&self.report, form, &subject)
    }
}

/// The names of the files written, for programs: standard output is none.
#[must_use]
pub fn file_names(paths: &[PathBuf]) -> Vec<String> {
    let files = paths.iter().filter(|path| !is_dash(path));
    files.map(|path| path.display().to_string()).collect()
}

/// The names of all outputs, for people.
#[must_use]
pub fn output_names(paths: &[PathBuf]) -> String {
    let names: Vec<String> = paths.iter().map(|path| path.display().to_string()).collect();
    names.join(", ")
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
    forms: Vec<Form>,
    outputs: Outputs,
}

impl Reports {
    /// Stages the reports of `global`.
    ///
    /// # Errors
    /// Exit code 2 when a report cannot be written where it is wanted, or the verb has no verdict
    /// that a report of this form could tell.
    pub fn prepare(global: &Global, has_verdict: bool, cleanup: &Cleanup) -> Result<Self, Failure> {
        let targets = wanted(global);
        let verdicts_only = |form| !matches!(form, Form::Text | Form::Json);
        if let Some(target) = targets.iter().find(|t| !has_verdict && verdicts_only(t.form)) {
            let message = format!("this verb has no {} report", target.form.name());
            let help = "`check` and `mesh` have; every verb has text and json";
            return Err(Failure::cannot_run(Diagnostic::new(message).help(help)));
        }
        let paths: Vec<PathBuf> = targets.iter().map(|target| target.path.clone()).collect();
        let outputs = Outputs::prepare(&paths, cleanup)?;
        Ok(Self { forms: targets.iter().map(|target| target.form).collect(), outputs })
    }

    /// Writes them.
    ///
    /// # Errors
    /// Exit code 2 when the disk refuses.
    pub fn write(
        mut self,
        text: &str,
        json: &Value,
        checked: Option<&Checked>,
    ) -> Result<(), Failure> {
        for (i, form) in self.forms.iter().enumerate() {
            self.outputs.fill(i, |out| match (form, checked) {
                (Form::Json, _) => writeln!(out, "{json:#}"),
                (Form::Text, _) | (_, None) => writeln!(out, "{text}"),
                (form, Some(checked)) => out.write_all(checked.render(*form).as_bytes()),
            })?;
        }
        self.outputs.commit()
    }

    /// Writes them for a run that failed before there was a verdict: each form says so in its own
    /// way, so that whoever collects reports sees a failure and no gap.
    ///
    /// # Errors
    /// Exit code 2 when the disk refuses.
    pub fn write_failure(self, failure: &Failure, mesh: &str) -> Result<(), Failure> {
        let text = failure_text(failure);
        let checked =
            Checked { report: Report::not_run(&text), mesh: mesh.to_owned(), domain: None };
        self.write(&text, &failure_json(failure), Some(&checked))
    }
}

/// All reports asked for; `--json` is `--report json=-`.
fn wanted(global: &Global) -> Vec<ReportTarget> {
    let mut targets = global.report.clone();
    if global.json {
        targets.push(ReportTarget { form: Form::Json, path: "-".into() });
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
        let target = |form, name: &str| ReportTarget { form, path: folder.path().join(name) };
        let report = vec![target(Form::Text, "a.txt"), target(Form::Json, "a.json")];
        let global = Global { report, ..Global::default() };
        let reports = Reports::prepare(&global, false, &Cleanup::default()).expect("writable");
        reports.write("words", &json!({"verdict": "passed"}), None).expect("written");
        let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).expect("there");
        assert_eq!(read("a.txt"), "words\n");
        assert!(read("a.json").contains("\"verdict\": \"passed\""));
    }

    #[test]
    fn verdict_reports_are_refused_by_verbs_without_a_verdict() {
        let folder = tempfile::tempdir().expect("a temporary directory");
        let target = ReportTarget { form: Form::Junit, path: folder.path().join("a.xml") };
        let global = Global { report: vec![target], ..Global::default() };
        let refused = Reports::prepare(&global, false, &Cleanup::default());
        assert_eq!(refused.expect_err("no verdict").exit, 2);
    }

    #[test]
    fn a_run_that_failed_still_leaves_a_junit_error() {
        let folder = tempfile::tempdir().expect("a temporary directory");
        let path = folder.path().join("a.xml");
        let target = ReportTarget { form: Form::Junit, path: path.clone() };
        let global = Global { report: vec![target], ..Global::default() };
        let reports = Reports::prepare(&global, true, &Cleanup::default()).expect("writable");
        let failure = Failure::cannot_run(Diagnostic::new("the file is empty"));
        reports.write_failure(&failure, "a.msh").expect("written");
        let xml = std::fs::read_to_string(path).expect("there");
        assert!(xml.contains("the file is empty"), "{xml}");
    }
}
