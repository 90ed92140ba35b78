//! The command line: arguments, printing and exit codes. All work is done by the library below.

pub mod arguments;
pub mod check;
pub mod compare;
pub mod console;
pub mod convert;
pub mod delaunay;
pub mod demo;
pub mod domain_file;
pub mod explain;
pub mod failure;
pub mod forms;
pub mod input;
pub mod judged;
pub mod mesh;
pub mod mesh_file;
pub mod outcome;
pub mod output;
pub mod plot;
pub mod point_file;
pub mod quads;
pub mod refinement;
pub mod remesh;
pub mod size_file;
pub mod size_layers;
pub mod study;
pub mod surface;
mod surface_options;
pub mod torture;
pub mod verdict;
pub mod voronoi;
pub mod watch;
pub mod words;

use arguments::{Arguments, Verb};
use clap::{CommandFactory, Parser};
use console::Console;
use failure::{Diagnostic, EXIT_HOLDS, Failure};
use outcome::{Outcome, Reports};
use output::Cleanup;
use serde_json::Value;
use std::path::PathBuf;
use std::process::ExitCode;

/// Runs the program on the process's arguments.
#[must_use]
pub fn main() -> ExitCode {
    // Usage errors and help end here, with clap's exit codes: 2 and 0.
    let mut arguments = Arguments::parse();
    if arguments.global.verbose > 0 {
        print_timings(&mut arguments.verb);
    }
    let exit = run(&arguments).unwrap_or_else(|failure| {
        Console::new(&arguments.global, true).complain(&failure);
        failure.exit
    });
    ExitCode::from(exit)
}

/// Carries the arguments out; the exit code, unless the reports themselves failed.
fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let global = &arguments.global;
    let is_stdout_taken = outcome::is_stdout_taken(global, outputs(&arguments.verb))?;
    let console = Console::new(global, is_stdout_taken);
    let cleanup = Cleanup::default();
    cleanup.on_interrupt()?;
    set_threads(global.threads)?;
    let reports = Reports::prepare(global, has_verdict(&arguments.verb), &cleanup)?;
    match run_verb(&arguments.verb, &console, &cleanup) {
        Ok(outcome) => {
            if !outcome.text.is_empty() {
                console.say(&outcome.text);
            }
            reports.write(&outcome.text, &outcome.json, outcome.checked.as_deref())?;
            Ok(outcome.exit)
        }
        Err(failure) => {
            console.complain(&failure);
            reports.write_failure(&failure, &subject(&arguments.verb))?;
            Ok(failure.exit)
        }
    }
}

fn run_verb(verb: &Verb, console: &Console, cleanup: &Cleanup) -> Result<Outcome, Failure> {
    match verb {
        Verb::Mesh(mesh) => return mesh::run(mesh, console, cleanup),
        Verb::Check(check) => return check::run(check, console, cleanup),
        Verb::Remesh(remesh) => return remesh::run(remesh, console, cleanup),
        Verb::Delaunay(delaunay) => return delaunay::run(delaunay, console, cleanup),
        Verb::Voronoi(arguments) => return voronoi::run(arguments, console, cleanup),
        Verb::Demo(demo) => return demo::run(demo, console, cleanup),
        Verb::Convert(convert) => return convert::run(convert, console, cleanup),
        Verb::Plot(plot) => return plot::run(plot, cleanup),
        Verb::Torture(torture) => return torture::run(torture, console, cleanup),
        Verb::Compare(compare) => return compare::run(compare, cleanup),
        Verb::Study(study) => return study::run(study, console, cleanup),
        Verb::Explain(explain) => explain::run(explain.id.as_deref(), console)?,
        Verb::Completions(completions) => print_completions(completions.shell, console),
        Verb::Man => print_manual(console)?,
    }
    Ok(Outcome { exit: EXIT_HOLDS, text: String::new(), json: Value::Null, checked: None })
}

/// What `--verbose` means for verbs that can print the time of each stage.
fn print_timings(verb: &mut Verb) {
    match verb {
        Verb::Mesh(mesh) => mesh.timings = true,
        Verb::Check(check) => check.timings = true,
        Verb::Remesh(remesh) => remesh.timings = true,
        Verb::Delaunay(delaunay) => delaunay.timings = true,
        Verb::Voronoi(voronoi) => voronoi.timings = true,
        _ => {}
    }
}

/// Whether a verb ends in a verdict on a mesh, which reports of every form can tell.
fn has_verdict(verb: &Verb) -> bool {
    match verb {
        Verb::Mesh(_) | Verb::Check(_) | Verb::Remesh(_) => true,
        Verb::Delaunay(delaunay) => delaunay.check,
        _ => false,
    }
}

/// The file that a report of a failed run is about.
fn subject(verb: &Verb) -> String {
    match verb {
        Verb::Mesh(mesh) => mesh.domain.display().to_string(),
        Verb::Check(check) => check.mesh.display().to_string(),
        Verb::Remesh(remesh) => remesh.mesh.display().to_string(),
        Verb::Delaunay(delaunay) => delaunay.input.points.display().to_string(),
        _ => String::new(),
    }
}

/// The outputs of a verb that may go to standard output.
fn outputs(verb: &Verb) -> &[PathBuf] {
    match verb {
        Verb::Mesh(mesh) => &mesh.outputs,
        Verb::Remesh(remesh) => &remesh.outputs,
        Verb::Delaunay(delaunay) => &delaunay.outputs,
        Verb::Voronoi(voronoi) => &voronoi.outputs,
        Verb::Convert(convert) => &convert.outputs,
        Verb::Plot(plot) => &plot.outputs,
        Verb::Compare(compare) => &compare.outputs,
        _ => &[],
    }
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
