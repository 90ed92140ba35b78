//! Writing outputs whole or not at all.
//!
//! Every output is written to a temporary file beside its target; only when ALL outputs are
//! complete and on the disk are they renamed. Targets that cannot work (a directory, a missing
//! directory, no permission) are refused before the long work starts. An interrupt removes the
//! temporary files; it waits while the renames are under way, so that it never falls between two.

use super::failure::{Diagnostic, EXIT_INTERRUPTED, Failure};
use super::input::is_dash;
use crate::torture::run::Running;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

/// Temporary files that an interrupt must remove, shared with the signal handler.
#[derive(Clone, Debug, Default)]
pub struct Cleanup {
    paths: Arc<Mutex<Vec<PathBuf>>>,
    meshers: Arc<OnceLock<Running>>,
}

impl Cleanup {
    /// Installs the handler for SIGINT, SIGTERM and SIGHUP: remove what is unfinished, exit 130.
    ///
    /// # Errors
    /// Exit code 2 when the system refuses the handler.
    pub fn on_interrupt(&self) -> Result<(), Failure> {
        let cleanup = self.clone();
        ctrlc::set_handler(move || {
            // Holding the lock to the end keeps a commit from starting after the removal.
            let paths = cleanup.lock();
            if let Some(meshers) = cleanup.meshers.get() {
                meshers.end_all();
            }
            for path in paths.iter() {
                let _ = fs::remove_file(path);
            }
            std::process::exit(i32::from(EXIT_INTERRUPTED));
        })
        .map_err(|e| Failure::cannot_run(Diagnostic::new(format!("cannot catch interrupts: {e}"))))
    }

    /// Lets an interrupt end these runs of other programs too.
    pub fn also(&self, meshers: &Running) {
        // There is one run of torture in a process.
        let _ = self.meshers.set(meshers.clone());
    }

    fn lock(&self) -> MutexGuard<'_, Vec<PathBuf>> {
        self.paths.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Where an output goes, and where it is until it is complete.
#[derive(Debug)]
enum Stage {
    /// Standard output: kept in memory until the commit.
    Memory(Vec<u8>),
    /// A temporary file that will be renamed to the target.
    Beside { temporary: tempfile::TempPath, target: PathBuf },
    /// A device or pipe: nothing to rename, so kept in memory and written at the commit.
    Device { bytes: Vec<u8>, target: PathBuf },
}

/// A set of outputs that appear together or not at all.
#[derive(Debug)]
pub struct Outputs {
    stages: Vec<Stage>,
    cleanup: Cleanup,
}

impl Outputs {
    /// Stages one output per target; `-` is standard output.
    ///
    /// # Errors
    /// Exit code 2, naming the target: it is a directory, its directory does not exist or cannot
    /// be written to, or two targets are the same file.
    pub fn prepare(targets: &[PathBuf], cleanup: &Cleanup) -> Result<Self, Failure> {
        let mut outputs = Self { stages: Vec::new(), cleanup: cleanup.clone() };
        for target in targets {
            let stage = outputs.stage(target)?;
            if outputs.stages.iter().any(|other| same_target(other, &stage)) {
                return Err(Failure::cannot_run(
                    Diagnostic::new("two outputs go to the same place").at(target.display()),
                ));
            }
            outputs.stages.push(stage);
        }
        Ok(outputs)
    }

    fn stage(&self, target: &Path) -> Result<Stage, Failure> {
        if is_dash(target) {
            return Ok(Stage::Memory(Vec::new()));
        }
        // Through a symbolic link: the link stays, the file it names is replaced.
        let target = fs::canonicalize(target).unwrap_or_else(|_| target.to_owned());
        let old = fs::metadata(&target).ok();
        if target.as_os_str().to_string_lossy().ends_with('/')
            || old.as_ref().is_some_and(fs::Metadata::is_dir)
        {
            let error = io::Error::from(io::ErrorKind::IsADirectory);
            return Err(Failure::io("write", &target, &error));
        }
        if old.as_ref().is_some_and(|about| !about.is_file()) {
            return Ok(Stage::Device { bytes: Vec::new(), target });
        }
        let folder = folder_of(&target);
        if !folder.is_dir() {
            let message = "cannot write: the directory does not exist";
            let folder = folder.display();
            return Err(Failure::cannot_run(
                Diagnostic::new(message)
                    .at(target.display())
                    .help(format!("create it with `mkdir -p {folder}`")),
            ));
        }
        if old.is_some_and(|about| about.permissions().readonly()) {
            let error = io::Error::from(io::ErrorKind::PermissionDenied);
            return Err(Failure::io("write", &target, &error));
        }
        self.temporary(folder, &target)
    }

    fn temporary(&self, folder: &Path, target: &Path) -> Result<Stage, Failure> {
        // Locked across the creation: an interrupt sees either no file or a registered one.
        let mut paths = self.cleanup.lock();
        let mut builder = tempfile::Builder::new();
        builder.prefix(".trigrade-").suffix(".tmp");
        permissions(&mut builder, target);
        let file =
            builder.tempfile_in(folder).map_err(|error| Failure::io("write", target, &error))?;
        let temporary = file.into_temp_path();
        paths.push(temporary.to_path_buf());
        Ok(Stage::Beside { temporary, target: target.to_owned() })
    }

    /// Fills output `index` with what `write` produces.
    ///
    /// # Errors
    /// Exit code 2 with the target's name when the disk is full or fails.
    pub fn fill(
        &mut self,
        index: usize,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), Failure> {
        match &mut self.stages[index] {
            Stage::Memory(bytes) => {
                write(bytes).map_err(|e| Failure::io("write", Path::new("<stdout>"), &e))
            }
            Stage::Device { bytes, target } => {
                write(bytes).map_err(|e| Failure::io("write", target, &e))
            }
            Stage::Beside { temporary, target } => {
                write_synced(temporary, write).map_err(|e| Failure::io("write", target, &e))
            }
        }
    }

    /// Reads back what output `index` holds, from the disk if that is where it is.
    ///
    /// # Errors
    /// Exit code 2 when the temporary file cannot be read.
    pub fn read_back(&self, index: usize) -> Result<Vec<u8>, Failure> {
        match &self.stages[index] {
            Stage::Memory(bytes) | Stage::Device { bytes, .. } => Ok(bytes.clone()),
            Stage::Beside { temporary, target } => {
                fs::read(temporary).map_err(|e| Failure::io("read back", target, &e))
            }
        }
    }

    /// Makes all outputs appear under their names.
    ///
    /// # Errors
    /// Exit code 2 when a rename fails; the renames already done are taken back where the target
    /// did not exist before.
    pub fn commit(self) -> Result<(), Failure> {
        let cleanup = self.cleanup.clone();
        let mut paths = cleanup.lock();
        let mut created = Vec::new();
        let mut streams = Vec::new();
        for stage in self.stages {
            match stage {
                Stage::Memory(bytes) => streams.push((None, bytes)),
                Stage::Device { bytes, target } => streams.push((Some(target), bytes)),
                Stage::Beside { temporary, target } => {
                    let is_new = !target.exists();
                    if let Err(e) = temporary.persist(&target) {
                        created.iter().for_each(|path: &PathBuf| drop(fs::remove_file(path)));
                        return Err(Failure::io("write", &target, &e.error));
                    }
                    if is_new {
                        created.push(target);
                    }
                }
            }
        }
        // The temporary names are free again: an interrupt has nothing to remove.
        paths.clear();
        drop(paths);
        streams.into_iter().try_for_each(|(target, bytes)| flush(target.as_deref(), &bytes))
    }
}

fn same_target(a: &Stage, b: &Stage) -> bool {
    match (a, b) {
        (Stage::Memory(_), Stage::Memory(_)) => true,
        (Stage::Beside { target: a, .. }, Stage::Beside { target: b, .. }) => a == b,
        _ => false,
    }
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// The mode an ordinary program would give the file, or the one the target already has.
#[cfg(unix)]
fn permissions(builder: &mut tempfile::Builder<'_, '_>, target: &Path) {
    use std::os::unix::fs::PermissionsExt;
    let ordinary = || fs::Permissions::from_mode(0o666);
    builder.permissions(fs::metadata(target).map_or_else(|_| ordinary(), |m| m.permissions()));
}

#[cfg(not(unix))]
fn permissions(_: &mut tempfile::Builder<'_, '_>, _: &Path) {}

fn write_synced(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut buffered = io::BufWriter::with_capacity(1 << 16, File::create(path)?);
    write(&mut buffered)?;
    buffered.into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()
}

fn flush(target: Option<&Path>, bytes: &[u8]) -> Result<(), Failure> {
    let written = match target {
        Some(device) => fs::OpenOptions::new()
            .write(true)
            .open(device)
            .and_then(|mut file| file.write_all(bytes)),
        None => {
            let mut out = io::stdout().lock();
            out.write_all(bytes).and_then(|()| out.flush())
        }
    };
    match written {
        // The reader has what it wanted (`| head`): not our failure.
        Err(e) if e.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        Err(e) => Err(Failure::io("write", target.unwrap_or(Path::new("<stdout>")), &e)),
        Ok(()) => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(folder)
            .expect("a directory")
            .map(|entry| entry.expect("an entry").file_name().into_string().expect("UTF-8"))
            .collect();
        names.sort();
        names
    }

    fn prepare(targets: &[PathBuf]) -> Result<Outputs, Failure> {
        Outputs::prepare(targets, &Cleanup::default())
    }

    fn complaint(targets: &[PathBuf]) -> String {
        prepare(targets).expect_err("must be refused").diagnostics[0].to_string()
    }

    // spec: K2
    #[test]
    fn nothing_appears_before_the_commit_and_all_after_it() {
        let folder = tempfile::tempdir().expect("a temporary directory");
        let targets = [folder.path().join("a.off"), folder.path().join("b.svg")];
        let mut outputs = prepare(&targets).expect("both can be written");
        outputs.fill(0, |w| w.write_all(b"first")).expect("written");
        outputs.fill(1, |w| w.write_all(b"second")).expect("written");
        assert!(names(folder.path()).iter().all(|name| name.starts_with(".trigrade-")));
        assert_eq!(outputs.read_back(1).expect("readable"), b"second");
        outputs.commit().expect("renamed");
        assert_eq!(names(folder.path()), ["a.off", "b.svg"]);
        assert_eq!(fs::read(&targets[0]).expect("readable"), b"first");
    }

    // spec: K2
    #[test]
    fn outputs_dropped_without_a_commit_leave_nothing() {
        let folder = tempfile::tempdir().expect("a temporary directory");
        let mut outputs = prepare(&[folder.path().join("a.off")]).expect("can be written");
        outputs.fill(0, |w| w.write_all(b"half")).expect("written");
        drop(outputs);
        assert_eq!(names(folder.path()), [""; 0]);
    }

    // spec: K2
    #[test]
    fn a_failed_output_leaves_the_old_files_alone() {
        let folder = tempfile::tempdir().expect("a temporary directory");
        let old = folder.path().join("a.off");
        fs::write(&old, b"old").expect("written");
        let mut outputs = prepare(std::slice::from_ref(&old)).expect("can be written");
        let error = outputs.fill(0, |_| Err(io::Error::from(io::ErrorKind::StorageFull)));
        assert!(error.expect_err("the disk is full").diagnostics[0].message.contains("full"));
        drop(outputs);
        assert_eq!((names(folder.path()), fs::read(&old).expect("there")), {
            (vec!["a.off".to_owned()], b"old".to_vec())
        });
    }

    // spec: K5
    #[test]
    fn impossible_targets_are_refused_at_once() {
        let folder = tempfile::tempdir().expect("a temporary directory");
        let missing = folder.path().join("no/such/a.off");
        assert!(complaint(&[missing]).contains("does not exist"));
        assert!(complaint(&[folder.path().to_owned()]).contains("directory"));
        let twice = folder.path().join("a.off");
        assert!(complaint(&[twice.clone(), twice]).contains("same place"));
        assert_eq!(names(folder.path()), [""; 0], "the refusal leaves nothing either");
    }

    // spec: K5
    #[test]
    fn a_read_only_target_is_refused() {
        let folder = tempfile::tempdir().expect("a temporary directory");
        let target = folder.path().join("a.off");
        fs::write(&target, b"old").expect("written");
        let mut mode = fs::metadata(&target).expect("there").permissions();
        mode.set_readonly(true);
        fs::set_permissions(&target, mode).expect("set");
        assert!(complaint(&[target]).contains("permission denied"));
    }

    #[cfg(unix)]
    #[test]
    fn a_symbolic_link_stays_and_a_device_is_written_through() {
        let folder = tempfile::tempdir().expect("a temporary directory");
        let (real, link) = (folder.path().join("real.off"), folder.path().join("link.off"));
        fs::write(&real, b"old").expect("written");
        std::os::unix::fs::symlink(&real, &link).expect("linked");
        let targets = [link.clone(), PathBuf::from("/dev/null")];
        let mut outputs = prepare(&targets).expect("can be written");
        outputs.fill(0, |w| w.write_all(b"new")).expect("written");
        outputs.fill(1, |w| w.write_all(b"new")).expect("written");
        outputs.commit().expect("renamed");
        assert!(fs::symlink_metadata(&link).expect("there").is_symlink());
        assert_eq!(fs::read(&real).expect("there"), b"new");
        assert!(!fs::metadata("/dev/null").expect("there").is_file(), "a device stays a device");
    }

    #[cfg(unix)]
    #[test]
    fn a_new_file_gets_ordinary_permissions() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().expect("a temporary directory");
        let target = folder.path().join("a.off");
        let plain = folder.path().join("plain");
        fs::write(&plain, b"").expect("written");
        prepare(std::slice::from_ref(&target)).expect("ok").commit().expect("renamed");
        let mode = |path: &Path| fs::metadata(path).expect("there").permissions().mode() & 0o777;
        assert_eq!(mode(&target), mode(&plain));
    }
}
