//! The log of a run: a line for each case that is done, so that a run can be taken up again.

use super::Record;
use serde_json::Value;
use std::fs::{File, OpenOptions};
use std::io::{self, BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// Why a log cannot be taken up.
#[derive(Debug, thiserror::Error)]
pub enum StateError {
    /// The log is that of a run with another plan.
    #[error("{} is the log of another run: give another --out, or the same options", .0.display())]
    OtherRun(PathBuf),
    /// It cannot be read or written.
    #[error("the log {} cannot be used: {source}", path.display())]
    Io {
        /// The log.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
}

/// An open log.
#[derive(Debug)]
pub struct State {
    file: Mutex<File>,
}

impl State {
    /// Opens a log, and hands out what it already holds. `plan` must be what it begins with.
    ///
    /// # Errors
    /// [`StateError`].
    pub fn open(path: &Path, plan: &Value) -> Result<(Self, Vec<Record>), StateError> {
        let told = |source| StateError::Io { path: path.to_owned(), source };
        let mut lines = match File::open(path) {
            Ok(file) => {
                BufReader::new(file).lines().collect::<io::Result<Vec<_>>>().map_err(told)?
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => Vec::new(),
            Err(error) => return Err(told(error)),
        };
        let is_new = lines.is_empty();
        if !is_new && serde_json::from_str::<Value>(&lines[0]).ok().as_ref() != Some(plan) {
            return Err(StateError::OtherRun(path.to_owned()));
        }
        // The last line of a run that was killed may be cut short: that case is run again.
        let records: Vec<Record> =
            lines.drain(..).skip(1).filter_map(|line| serde_json::from_str(&line).ok()).collect();
        let mut file = OpenOptions::new().create(true).append(true).open(path).map_err(told)?;
        match is_new {
            true => writeln!(file, "{plan}").map_err(told)?,
            false => writeln!(file).map_err(told)?,
        }
        Ok((Self { file: Mutex::new(file) }, records))
    }

    /// Adds a case.
    ///
    /// # Errors
    /// Those of the file.
    pub fn add(&self, record: &Record) -> io::Result<()> {
        let mut line = serde_json::to_string(record)?;
        line.push('\n');
        let mut file = self.file.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        file.write_all(line.as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::torture::judge::{Class, Judgement};
    use serde_json::json;

    fn record(index: u64) -> Record {
        Record {
            index,
            family: "stars".into(),
            dress: "plain".into(),
            claim: "valid".into(),
            judgement: Judgement {
                class: Class::Passed,
                findings: Vec::new(),
                reason: String::new(),
                triangles: 7,
                radius_ratio_max: Some(1.25),
            },
            seconds: 0.5,
        }
    }

    // spec: R7
    #[test]
    fn a_log_gives_back_what_was_added_even_when_its_end_is_cut() {
        let folder = tempfile::tempdir().expect("a temporary directory");
        let (path, plan) = (folder.path().join("state.jsonl"), json!({"seed": 1}));
        let (state, records) = State::open(&path, &plan).expect("a new log");
        assert!(records.is_empty());
        state.add(&record(4)).expect("added");
        state.add(&record(2)).expect("added");
        let text = std::fs::read_to_string(&path).expect("readable");
        std::fs::write(&path, &text[..text.len() - 9]).expect("cut");
        let (state, records) = State::open(&path, &plan).expect("the same plan");
        assert_eq!(records, [record(4)]);
        state.add(&record(2)).expect("added");
        let (_, records) = State::open(&path, &plan).expect("the same plan");
        assert_eq!(records, [record(4), record(2)]);
    }

    // spec: R7
    #[test]
    fn the_log_of_another_run_is_refused() {
        let folder = tempfile::tempdir().expect("a temporary directory");
        let path = folder.path().join("state.jsonl");
        State::open(&path, &json!({"seed": 1})).expect("a new log");
        let error = State::open(&path, &json!({"seed": 2})).expect_err("another plan");
        assert!(error.to_string().contains("another run"), "{error}");
    }
}
