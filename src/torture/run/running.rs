//! Meshers that are under way, so that an interrupt can end them: each has a process group of its
//! own, which a terminal's Ctrl-C does not reach.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Child, Command};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The runs that are under way; clones share them.
#[derive(Clone, Debug, Default)]
pub struct Running {
    runs: Arc<Mutex<Runs>>,
}

#[derive(Debug, Default)]
struct Runs {
    is_over: bool,
    /// Folder of each run by the number of its process group.
    folders: BTreeMap<u32, PathBuf>,
}

impl Running {
    /// Starts a run that works in `folder`.
    ///
    /// # Errors
    /// When the command cannot be started, or all is over.
    pub(super) fn start(&self, command: &mut Command, folder: &Path) -> io::Result<Child> {
        // Locked across the start: an interrupt sees either no process or a registered one.
        let mut runs = self.lock();
        if runs.is_over {
            return Err(io::ErrorKind::Interrupted.into());
        }
        let child = command.spawn()?;
        runs.folders.insert(child.id(), folder.to_owned());
        Ok(child)
    }

    /// Ends what is left of a run whose first process was not waited for yet or only just now.
    pub(super) fn end(&self, child: &Child) {
        // Locked, so that no later run can have been given this number.
        let mut runs = self.lock();
        kill_group(child.id());
        runs.folders.remove(&child.id());
    }

    /// Ends all runs, removes the folders they work in, and lets no more start.
    pub fn end_all(&self) {
        let mut runs = self.lock();
        runs.is_over = true;
        for (group, folder) in std::mem::take(&mut runs.folders) {
            kill_group(group);
            let _ = fs::remove_dir_all(folder);
        }
    }

    fn lock(&self) -> MutexGuard<'_, Runs> {
        self.runs.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(unix)]
fn kill_group(number: u32) {
    use rustix::process::{Pid, Signal, kill_process_group};
    if let Some(group) = i32::try_from(number).ok().and_then(Pid::from_raw) {
        // The group may be gone already.
        let _ = kill_process_group(group, Signal::KILL);
    }
}

#[cfg(not(unix))]
fn kill_group(_number: u32) {}
