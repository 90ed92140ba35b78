//! What goes to the terminal: results on standard output, everything else on standard error.

use super::arguments::Global;
use super::failure::Failure;
use super::words::count;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, IsTerminal, Write};
use std::time::Duration;

/// At most this many complaints are printed; reports have all of them.
const COMPLAINTS_PRINTED: usize = 40;

/// Where text for people goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum People {
    /// Standard output is theirs.
    Stdout,
    /// Standard output carries a mesh or a report.
    Stderr,
    /// They asked for silence.
    Nowhere,
}

/// Prints; a closed pipe is never an error.
#[derive(Debug)]
pub struct Console {
    people: People,
    verbose: u8,
    json: bool,
}

impl Console {
    /// As the flags ask; `stdout_taken` when an output or a report goes to standard output.
    #[must_use]
    pub fn new(global: &Global, stdout_taken: bool) -> Self {
        let people = match (global.quiet, stdout_taken || global.json) {
            (true, _) => People::Nowhere,
            (false, true) => People::Stderr,
            (false, false) => People::Stdout,
        };
        Self { people, verbose: global.verbose, json: global.json }
    }

    /// Prints text for people: summaries, tables.
    pub fn say(&self, text: &str) {
        match self.people {
            People::Stdout => print(&mut io::stdout().lock(), text),
            // With --json the report says it all.
            People::Stderr if !self.json => print(&mut io::stderr().lock(), text),
            People::Stderr | People::Nowhere => {}
        }
    }

    /// Prints detail that `-v` asks for, on standard error.
    pub fn detail(&self, text: &str) {
        if self.verbose > 0 {
            print(&mut io::stderr().lock(), text);
        }
    }

    /// Prints what was asked for: even `--quiet` does not mean to hide it.
    pub fn result(&self, text: &str) {
        print(&mut io::stdout().lock(), text);
    }

    /// Prints the complaints of a failure on standard error.
    pub fn complain(&self, failure: &Failure) {
        let mut out = io::stderr().lock();
        let colour = out.is_terminal() && std::env::var_os("NO_COLOR").is_none();
        for diagnostic in failure.diagnostics.iter().take(COMPLAINTS_PRINTED) {
            let text = diagnostic.to_string();
            print(&mut out, &if colour { coloured(&text) } else { text });
        }
        let rest = failure.diagnostics.len().saturating_sub(COMPLAINTS_PRINTED);
        if rest > 0 {
            let rest = count(rest as u64);
            print(&mut out, &format!("... and {rest} more: `--report json=FILE` has all of them"));
        }
    }

    /// A progress bar on standard error, hidden unless that is a terminal; it shows itself after
    /// half a second, for short work needs none.
    #[must_use]
    pub fn bar(&self) -> ProgressBar {
        if self.people == People::Nowhere || self.json || !io::stderr().is_terminal() {
            return ProgressBar::hidden();
        }
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr_with_hz(5));
        let style = ProgressStyle::with_template("{msg:12} {wide_bar} {human_pos}/{human_len}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar.enable_steady_tick(Duration::from_millis(500));
        bar
    }
}

fn print(out: &mut dyn Write, text: &str) {
    // A reader that went away (`| head`) has had enough.
    let _ = writeln!(out, "{text}").and_then(|()| out.flush());
}

/// `error` and its rule in bold red.
fn coloured(text: &str) -> String {
    match text.split_once(':') {
        Some((head, rest)) => format!("\x1b[1;31m{head}\x1b[0m:{rest}"),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn standard_output_is_for_people_only_when_nothing_else_needs_it() {
        let flags = |quiet, json| Global { quiet, json, ..Global::default() };
        let people = |quiet, json, taken| Console::new(&flags(quiet, json), taken).people;
        assert_eq!(people(false, false, false), People::Stdout);
        assert_eq!(people(false, false, true), People::Stderr);
        assert_eq!(people(false, true, false), People::Stderr);
        assert_eq!(people(true, false, false), People::Nowhere);
    }

    #[test]
    fn only_the_head_of_a_complaint_is_coloured() {
        assert_eq!(coloured("error[D4]: a: b"), "\x1b[1;31merror[D4]\x1b[0m: a: b");
    }
}
