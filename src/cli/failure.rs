//! Why a run did not end well, told the way a compiler tells it: what, where, which rule, what next.

use std::fmt;
use std::io;
use std::path::Path;

/// Exit code when everything asked for was done and every check held.
pub const EXIT_HOLDS: u8 = 0;
/// Exit code when an input was read and found wanting: findings, an invalid domain, a missed gate.
pub const EXIT_FINDINGS: u8 = 1;
/// Exit code when the work could not be done: usage, files, malformed input, a limit.
pub const EXIT_CANNOT_RUN: u8 = 2;
/// Exit code after an interrupt, as shells have it: 128 + SIGINT.
pub const EXIT_INTERRUPTED: u8 = 130;

/// One complaint: a sentence, where it applies, the rule it breaks and what to do about it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Diagnostic {
    /// Id of the SPEC invariant that is broken, when there is one.
    pub rule: Option<String>,
    /// One sentence in the user's terms, lower case, without a final full stop.
    pub message: String,
    /// Where: `file:line`, a JSON path, or a file; the first one is the primary place.
    pub places: Vec<String>,
    /// What would help.
    pub helps: Vec<String>,
}

impl Diagnostic {
    /// A complaint of the one sentence `message`.
    #[must_use]
    pub fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), ..Self::default() }
    }

    /// With one more place.
    #[must_use]
    pub fn at(mut self, place: impl fmt::Display) -> Self {
        self.places.push(place.to_string());
        self
    }

    /// With the SPEC id of the rule that is broken.
    #[must_use]
    pub fn rule(mut self, id: impl Into<String>) -> Self {
        self.rule = Some(id.into());
        self
    }

    /// With one more piece of advice.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.helps.push(help.into());
        self
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.rule {
            Some(rule) => write!(f, "error[{rule}]: {}", self.message)?,
            None => write!(f, "error: {}", self.message)?,
        }
        for place in &self.places {
            write!(f, "\n  --> {place}")?;
        }
        for help in &self.helps {
            write!(f, "\n  help: {help}")?;
        }
        if let Some(rule) = &self.rule {
            write!(f, "\n  rule: `trigrade explain {rule}`")?;
        }
        Ok(())
    }
}

/// The end of a run that did not go well.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// [`EXIT_FINDINGS`] or [`EXIT_CANNOT_RUN`].
    pub exit: u8,
    /// All complaints, the first one most important; empty when they are already printed.
    pub diagnostics: Vec<Diagnostic>,
}

impl Failure {
    /// The work could not be done.
    #[must_use]
    pub fn cannot_run(diagnostic: Diagnostic) -> Self {
        Self { exit: EXIT_CANNOT_RUN, diagnostics: vec![diagnostic] }
    }

    /// The input was understood, and it is wrong.
    #[must_use]
    pub fn findings(diagnostics: Vec<Diagnostic>) -> Self {
        Self { exit: EXIT_FINDINGS, diagnostics }
    }

    /// An operating system error on `path` while doing `what` ("read", "write").
    #[must_use]
    pub fn io(what: &str, path: &Path, error: &io::Error) -> Self {
        Self::cannot_run(
            Diagnostic::new(format!("cannot {what}: {}", reason(error))).at(path.display()),
        )
    }
}

/// The operating system's reason in plain words, without its number.
fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "no such file or directory".into(),
        io::ErrorKind::PermissionDenied => "permission denied".into(),
        io::ErrorKind::IsADirectory => "it is a directory".into(),
        io::ErrorKind::StorageFull => "the disk is full".into(),
        _ => {
            let text = error.to_string();
            let cut = text.find(" (os error").unwrap_or(text.len());
            text[..cut].to_lowercase()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // spec: K4
    #[test]
    fn a_diagnostic_names_what_where_rule_and_help() {
        let text = Diagnostic::new("loop 2 crosses loop 0")
            .rule("D4")
            .at("lake.poly:118")
            .at("lake.poly:31")
            .help("move one of the two vertices")
            .to_string();
        assert_eq!(
            text,
            "error[D4]: loop 2 crosses loop 0\n  --> lake.poly:118\n  --> lake.poly:31\n  \
             help: move one of the two vertices\n  rule: `trigrade explain D4`"
        );
    }

    #[test]
    fn a_diagnostic_without_a_rule_has_no_brackets() {
        assert_eq!(Diagnostic::new("no such verb").to_string(), "error: no such verb");
    }

    #[test]
    fn system_errors_are_told_in_plain_words() {
        let denied = io::Error::from_raw_os_error(13);
        let failure = Failure::io("write", Path::new("out/a.msh"), &denied);
        assert_eq!(failure.exit, EXIT_CANNOT_RUN);
        assert_eq!(
            failure.diagnostics[0].to_string(),
            "error: cannot write: permission denied\n  --> out/a.msh"
        );
        let other = Failure::io("read", Path::new("x"), &io::Error::from_raw_os_error(5));
        assert!(!other.diagnostics[0].message.contains("os error"), "the number is noise");
    }
}
