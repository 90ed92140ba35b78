//! A mesher behind a command line: a boundary in, an answer out.

use super::command::{Ended, Ending, Limits, execute, quoted};
use super::running::Running;
use crate::check::Id;
use crate::domain::Domain;
use crate::format::{MeshForm, ReadOptions, read_mesh};
use crate::mesh::MeshData;
use crate::torture::export::{BoundaryForm, ExportError, export};
use crate::torture::generate::Claim;
use crate::torture::judge::Answer;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A mesher and how it is called.
#[derive(Clone, Debug)]
pub struct Tool {
    /// Its name in reports.
    pub name: String,
    /// Command line for the shell: `{in}` is the boundary, `{out}` the answer, `{stem}` the
    /// boundary's path without its extension.
    pub command: String,
    /// What it reads.
    pub form: BoundaryForm,
    /// Its answer: an extension for `{out}`, or a path that starts with `{stem}`.
    pub answer: String,
    /// Words by which it says that it stopped at a limit that its documentation announces.
    pub limit: Option<&'static str>,
    /// Findings that do not count against it.
    pub allow: Vec<Id>,
    /// How to install it, if that is known.
    pub install: Option<&'static str>,
    /// Its runs that are under way.
    pub running: Running,
}

/// Why no answer could be had: not the mesher's fault, so the run ends.
#[derive(Debug, thiserror::Error)]
pub enum ToolError {
    /// The shell did not find the program.
    #[error("the mesher cannot be started: {said}")]
    NotFound {
        /// What the shell said.
        said: String,
        /// How to install it.
        install: Option<&'static str>,
    },
    /// Files could not be written or the shell not started.
    #[error("the mesher cannot be run: {0}")]
    Io(#[from] io::Error),
}

/// An answer with its circumstances.
#[derive(Clone, Debug, PartialEq)]
pub struct Asked {
    /// The answer.
    pub answer: Answer,
    /// How long it took.
    pub seconds: f64,
    /// The command line as it was run.
    pub command: String,
}

impl Tool {
    /// Path of the boundary in a folder.
    #[must_use]
    pub fn input(&self, folder: &Path) -> PathBuf {
        folder.join(format!("boundary.{}", self.form.extension()))
    }

    /// Path of the answer in a folder.
    #[must_use]
    pub fn output(&self, folder: &Path) -> PathBuf {
        match self.answer.strip_prefix("{stem}") {
            Some(rest) => folder.join(format!("boundary{rest}")),
            None => folder.join(format!("answer.{}", self.answer)),
        }
    }

    /// The command line for a folder.
    #[must_use]
    pub fn command_in(&self, folder: &Path) -> String {
        self.command
            .replace("{in}", &quoted(&self.input(folder)))
            .replace("{out}", &quoted(&self.output(folder)))
            .replace("{stem}", &quoted(&folder.join("boundary")))
    }

    /// Has a boundary meshed in an empty folder.
    ///
    /// # Errors
    /// [`ToolError`]: the mesher could not be asked at all.
    pub fn ask(
        &self,
        domain: &Domain,
        claim: Claim,
        limits: &Limits,
        folder: &Path,
    ) -> Result<Asked, ToolError> {
        let command = self.command_in(folder);
        let not_asked = |why: String| Asked {
            answer: Answer::NotAsked(why),
            seconds: 0.0,
            command: command.clone(),
        };
        if let Claim::Invalid(fault) = claim
            && !self.form.carries(fault)
        {
            let form = self.form.extension();
            return Ok(not_asked(format!("a .{form} file cannot break rule {fault}")));
        }
        let bytes = match export(domain, self.form) {
            Ok(bytes) => bytes,
            // Where no hole point can be found in an invalid boundary, the fault is still there.
            Err(error @ (ExportError::NotExpressible { .. } | ExportError::Write(_))) => {
                return Ok(not_asked(error.to_string()));
            }
        };
        fs::write(self.input(folder), bytes)?;
        let ended = execute(&command, folder, limits, &self.running)?;
        if matches!(ended.ending, Ending::Exit(126 | 127)) {
            return Err(ToolError::NotFound { said: ended.said, install: self.install });
        }
        let seconds = ended.time.as_secs_f64();
        Ok(Asked { answer: self.interpret(&ended, limits, folder), seconds, command })
    }

    fn interpret(&self, ended: &Ended, limits: &Limits, folder: &Path) -> Answer {
        let said = &ended.said;
        let out_of_memory = || {
            Answer::OutOfMemory(format!("it asked for more than {} bytes: {said}", limits.memory))
        };
        match ended.ending {
            Ending::TimedOut => {
                Answer::Hang(format!("still running after its time of {:?}", limits.time))
            }
            Ending::Exit(0) => read_answer(&self.output(folder), said),
            Ending::Exit(_) if self.limit.is_some_and(|words| said.contains(words)) => {
                Answer::Limit(said.clone())
            }
            _ if is_out_of_memory(said) => out_of_memory(),
            Ending::Signal(signal) => Answer::Crash(format!("ended by signal {signal}: {said}")),
            Ending::Exit(code) if said.contains("panicked at") => {
                Answer::Crash(format!("panicked with exit code {code}: {said}"))
            }
            Ending::Exit(code) => Answer::Refused(format!("exit code {code}: {said}")),
        }
    }
}

/// Whether a program that failed said that memory was short, in one of the usual ways.
fn is_out_of_memory(said: &str) -> bool {
    const WORDS: [&str; 5] =
        ["memory allocation of", "bad_alloc", "out of memory", "memoryerror", "cannot allocate"];
    let said = said.to_lowercase();
    WORDS.iter().any(|word| said.contains(word))
}

fn read_answer(path: &Path, said: &str) -> Answer {
    let Ok(bytes) = fs::read(path) else {
        return Answer::Refused(format!("it ended well, but left no mesh: {said}"));
    };
    match read_any(path, &bytes) {
        Ok(mesh) => Answer::Mesh(Box::new(mesh)),
        Err(why) => Answer::Unreadable(why),
    }
}

/// Reads a mesh whose form its name tells, with the files beside it.
fn read_any(path: &Path, bytes: &[u8]) -> Result<MeshData, String> {
    let form = MeshForm::from_path(path).or_else(|| MeshForm::sniff(bytes));
    let form = form.ok_or("neither name nor content tells the form of the answer")?;
    let beside = |extension| fs::read(path.with_extension(extension)).ok();
    let companions: Vec<Option<Vec<u8>>> =
        form.companions().iter().map(|companion| beside(companion.extension())).collect();
    let companion = |i: usize| companions.get(i).and_then(|bytes| bytes.as_deref());
    let options =
        ReadOptions { nodes: companion(0), edges: companion(1), ..ReadOptions::default() };
    read_mesh(bytes, form, &options).map_err(|error| error.to_string())
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use crate::torture::generate::Selection;
    use std::time::Duration;

    fn ask(command: &str) -> Result<Asked, ToolError> {
        let tool = Tool {
            name: "a test".into(),
            command: command.into(),
            form: BoundaryForm::Json,
            answer: "off".into(),
            limit: Some("too many"),
            allow: Vec::new(),
            install: Some("by hand"),
            running: Running::default(),
        };
        let selection = Selection { families: vec!["spiral".into()], ..Selection::new(1) };
        let case = selection.case(0).expect("a family");
        let folder = tempfile::tempdir().expect("a temporary directory");
        let limits = Limits { time: Duration::from_secs(20), memory: 1 << 30 };
        tool.ask(&case.domain, case.claim, &limits, folder.path())
    }

    fn answer(command: &str) -> Answer {
        ask(command).expect("sh is there").answer
    }

    // spec: R6
    #[test]
    fn answers_are_told_apart() {
        assert!(matches!(answer("test -s {in} && exit 1"), Answer::Refused(_)));
        assert!(matches!(answer("echo too many; exit 2"), Answer::Limit(_)));
        assert!(matches!(answer("exit 0"), Answer::Refused(_)), "no file is no mesh");
        assert!(matches!(answer("echo junk > {out}"), Answer::Unreadable(_)));
        assert!(matches!(answer("kill -SEGV $$"), Answer::Crash(_)));
        assert!(matches!(answer("echo thread panicked at x; exit 101"), Answer::Crash(_)));
        assert!(matches!(answer("echo std::bad_alloc; kill -ABRT $$"), Answer::OutOfMemory(_)));
        let off = "printf 'OFF\\n3 1 0\\n0 0 0\\n1 0 0\\n0 1 0\\n3 0 1 2\\n' > {out}";
        match answer(off) {
            Answer::Mesh(mesh) => assert_eq!(mesh.triangles, [[0, 1, 2]]),
            other => panic!("{other:?}"),
        }
    }

    // spec: R6
    #[test]
    fn a_mesher_that_is_not_there_ends_the_run() {
        let error = ask("no-such-program-as-this {in} {out}").expect_err("not there");
        assert!(matches!(error, ToolError::NotFound { install: Some("by hand"), .. }), "{error}");
    }
}
