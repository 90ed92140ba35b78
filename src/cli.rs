//! The command line: arguments, printing and exit codes. All work is done by the library below.

pub mod arguments;
pub mod console;
pub mod explain;
pub mod failure;
pub mod input;
pub mod output;

use arguments::{Arguments, Verb};
use clap::{CommandFactory, Parser};
use console::Console;
use failure::{Diagnostic, EXIT_HOLDS, Failure};
use output::Cleanup;
use std::process::ExitCode;

/// Runs the program on the process's arguments.
#[must_use]
pub fn main() -> ExitCode {
    // Usage errors and help end here, with clap's exit codes: 2 and 0.
    let arguments = Arguments::parse();
    let mut console = Console::new(&arguments.global, false);
    match run(&arguments, &mut console) {
        Ok(exit) => ExitCode::from(exit),
        Err(failure) => {
            console.complain(&failure);
            ExitCode::from(failure.exit)
        }
    }
}

fn run(arguments: &Arguments, console: &mut Console) -> Result<u8, Failure> {
    let cleanup = Cleanup::default();
    cleanup.on_interrupt()?;
    set_threads(arguments.global.threads)?;
    match &arguments.verb {
        Verb::Explain(explain) => explain::run(explain.id.as_deref(), console)?,
        Verb::Completions(completions) => print_completions(completions.shell, console),
        Verb::Man => print_manual(console)?,
        _ => todo!(),
    }
    Ok(EXIT_HOLDS)
}

fn set_threads(threads: Option<u16>) -> Result<(), Failure> {
    let Some(threads) = threads else { return Ok(()) };
    rayon::ThreadPoolBuilder::new().num_threads(usize::from(threads)).build_global().map_err(|e| {
        Failure::cannot_run(Diagnostic::new(format!("cannot start {threads} threads: {e}")))
    })
}

fn print_completions(shell: clap_complete::Shell, console: &Console) {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "trigrade", &mut script);
    console.result(String::from_utf8_lossy(&script).trim_end());
}

fn print_manual(console: &Console) -> Result<(), Failure> {
    let mut page = Vec::new();
    clap_mangen::Man::new(Arguments::command())
        .render(&mut page)
        .map_err(|e| Failure::io("write", std::path::Path::new("<stdout>"), &e))?;
    console.result(String::from_utf8_lossy(&page).trim_end());
    Ok(())
}
