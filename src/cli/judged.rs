//! What the verbs that make a mesh have in common: every mesh they write is read back from its bytes
//! and judged, and all files are handed out, or none.

use super::failure::{Diagnostic, EXIT_FINDINGS, EXIT_HOLDS, Failure};
use super::forms::OutputFile;
use super::input::Input;
use super::mesh_file::{parse, unreadable, written_meshes};
use super::outcome::{Checked, output_names};
use super::output::Outputs;
use super::verdict;
use super::watch::{stages, time, total};
use crate::check::certificate::{Certificate, FileHash};
use crate::check::{CheckOptions, Report};
use crate::format::{MeshForm, MeshView, WriteOptions, write_mesh};
use crate::mesh::MeshData;
use std::path::PathBuf;
use std::time::Duration;

/// A mesh that was read back, and what is said of it.
#[derive(Clone, Debug)]
pub struct Judged<T = ()> {
    /// The file.
    pub name: String,
    /// What the checker says.
    pub report: Report,
    /// What is wrong with it that the checker does not ask for.
    pub complaints: Vec<Diagnostic>,
    /// What else was measured.
    pub measured: T,
}

impl<T> Judged<T> {
    /// By the checker alone.
    #[must_use]
    pub fn new(name: &str, report: Report, measured: T) -> Self {
        Self { name: name.to_owned(), report, complaints: Vec::new(), measured }
    }

    /// Whether it may be handed out.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.report.passed() && self.complaints.is_empty()
    }

    /// For reports, with the name of what was meshed.
    #[must_use]
    pub fn checked(&self, domain: &str) -> Box<Checked> {
        let (report, mesh) = (self.report.clone(), self.name.clone());
        Box::new(Checked { report, mesh, domain: Some(domain.to_owned()) })
    }
}

/// Judges the meshes in their order: the first that does not pass, else the first.
///
/// # Panics
/// Without a mesh; [`read_back`] gives one at least.
pub fn judge<T>(
    meshes: &[(String, MeshData)],
    mut each: impl FnMut(&str, &MeshData) -> Judged<T>,
) -> Judged<T> {
    let mut first = None;
    for (name, mesh) in meshes {
        let judged = each(name, mesh);
        if !judged.passed() {
            return judged;
        }
        first.get_or_insert(judged);
    }
    first.expect("at least one mesh is read back")
}

/// The exit code of a run; a mesh that was not checked is handed out.
#[must_use]
pub fn exit<T>(judged: Option<&Judged<T>>) -> u8 {
    match judged {
        Some(judged) if !judged.passed() => judged.report.exit_code().max(EXIT_FINDINGS),
        _ => EXIT_HOLDS,
    }
}

/// The verdict on a run, for programs.
#[must_use]
pub fn word<T>(judged: Option<&Judged<T>>) -> &'static str {
    match judged {
        Some(judged) if judged.passed() => "passed",
        Some(_) => "failed",
        None => "not-checked",
    }
}

/// The lines that end the summary of a run: how long it took, what was written, or why nothing.
#[must_use]
pub fn closing<T>(
    judged: Option<&Judged<T>>,
    laps: &[(String, Duration)],
    timings: bool,
    written: &[PathBuf],
) -> Vec<String> {
    let mut lines = Vec::new();
    let mut line = |label: &str, text: String| lines.push(format!("  {label:<11}{text}"));
    if timings {
        line("time", stages(laps));
    }
    line("total", time(total(laps)));
    if !written.is_empty() {
        line("written", output_names(written));
    }
    if let Some(judged) = judged.filter(|judged| !judged.passed()) {
        line("written", "nothing: the mesh did not pass its check".into());
        let findings = verdict::findings(&judged.report, &judged.name);
        lines.extend((!findings.is_empty()).then_some(findings));
        lines.extend(judged.complaints.iter().map(ToString::to_string));
    }
    lines
}

/// The paths of files, which are the targets of their outputs.
#[must_use]
pub fn paths(files: &[OutputFile]) -> Vec<PathBuf> {
    files.iter().map(|file| file.path.clone()).collect()
}

/// Every written mesh that can be read, read from its bytes; where none can, the mesh written to
/// an MSH file and read from there.
///
/// # Errors
/// Exit code 1 when a file cannot be read back, 2 when the disk refuses.
pub fn read_back(
    outputs: &Outputs,
    files: &[OutputFile],
    mesh: MeshView<'_>,
) -> Result<Vec<(String, MeshData)>, Failure> {
    let mut meshes = written_meshes(outputs, files).collect::<Result<Vec<_>, _>>()?;
    if meshes.is_empty() {
        let name = "a temporary MSH file";
        meshes.push((name.to_owned(), through_msh(mesh, name)?));
    }
    Ok(meshes)
}

fn through_msh(mesh: MeshView<'_>, name: &str) -> Result<MeshData, Failure> {
    let mut bytes = Vec::new();
    write_mesh(mesh, MeshForm::Msh, WriteOptions::default(), &mut bytes)
        .map_err(|e| Failure::cannot_run(Diagnostic::new(e.to_string())))?;
    parse(&bytes, MeshForm::Msh, &[], true).map_err(|e| unreadable(name, &e))
}

/// The certificate of a mesh that was read back and judged.
///
/// # Errors
/// Exit code 2 when that is none of the files written.
pub fn certify<T>(
    outputs: &Outputs,
    files: &[OutputFile],
    judged: &Judged<T>,
    domain: Option<&Input>,
) -> Result<Certificate, Failure> {
    let Judged { name, report, .. } = judged;
    let is_judged =
        |file: &OutputFile| file.companion.is_none() && file.path.display().to_string() == *name;
    let index = files.iter().position(is_judged).ok_or_else(|| {
        let message = "none of the outputs is a mesh that can be read back and certified";
        Failure::cannot_run(Diagnostic::new(message))
    })?;
    // Companions stand before their main file, in the order in which readers take them.
    let before = files[..index].iter().rev().take_while(|file| file.companion.is_some()).count();
    let parts = [index].into_iter().chain(index - before..index).map(|i| outputs.read_back(i));
    let parts: Vec<Vec<u8>> = parts.collect::<Result<_, _>>()?;
    let parts: Vec<&[u8]> = parts.iter().map(Vec::as_slice).collect();
    let mesh = FileHash::of(name, &parts);
    let domain = domain.map(|domain| FileHash::of(&domain.name, &[&domain.bytes]));
    Ok(Certificate::new(report, &CheckOptions::default(), mesh, domain))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::verdict::check_mesh;

    /// A triangle that is sound, and one that is clockwise.
    fn meshes() -> Vec<(String, MeshData)> {
        let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let mesh = |triangle| MeshData {
            points: points.clone(),
            triangles: vec![triangle],
            ..MeshData::default()
        };
        vec![
            ("good.off".into(), mesh([0, 1, 2])),
            ("fine.off".into(), mesh([1, 2, 0])),
            ("bad.off".into(), mesh([0, 2, 1])),
        ]
    }

    fn by_check(name: &str, mesh: &MeshData) -> Judged {
        Judged::new(name, check_mesh(mesh, None), ())
    }

    // spec: K2 K41
    #[test]
    fn the_first_mesh_that_does_not_pass_is_told_else_the_first() {
        let meshes = meshes();
        let all = judge(&meshes, by_check);
        assert_eq!(
            (all.name.as_str(), exit(Some(&all)), word(Some(&all))),
            ("bad.off", 1, "failed")
        );
        let sound = judge(&meshes[..2], by_check);
        assert_eq!((sound.name.as_str(), exit(Some(&sound))), ("good.off", EXIT_HOLDS));
        assert_eq!((exit::<()>(None), word::<()>(None)), (EXIT_HOLDS, "not-checked"));
    }

    #[test]
    fn meshes_after_a_failure_are_not_judged() {
        let mut seen = Vec::new();
        let judged = judge(&meshes(), |name, _| {
            seen.push(name.to_owned());
            let complaints = vec![Diagnostic::new("too round")];
            Judged { complaints, ..by_check(name, &meshes()[0].1) }
        });
        assert_eq!(seen, ["good.off"]);
        assert!(judged.report.passed() && !judged.passed());
        let told = closing(Some(&judged), &[], false, &[]).join("\n");
        assert!(
            told.ends_with("written    nothing: the mesh did not pass its check\nerror: too round"),
            "{told}"
        );
        assert_eq!(
            exit(Some(&judged)),
            EXIT_FINDINGS,
            "the checker found nothing, but the verb did"
        );
    }

    #[test]
    fn a_mesh_without_a_file_goes_through_one() {
        let (_, mesh) = &meshes()[0];
        let outputs = Outputs::prepare(&[], &super::super::output::Cleanup::default());
        let outputs = outputs.expect("nothing to prepare");
        let back = read_back(&outputs, &[], MeshView::from(mesh)).expect("written and read");
        assert_eq!((back.len(), &back[0].1.triangles), (1, &mesh.triangles));
        let judged = judge(&back, by_check);
        assert_eq!(certify(&outputs, &[], &judged, None).expect_err("no file").exit, 2);
    }
}
