//! `trigrade torture`: a mesher on adversarial boundaries, its failures shrunk.

use super::arguments::TortureArguments;
use super::console::Console;
use super::failure::{Diagnostic, EXIT_FINDINGS, EXIT_HOLDS, Failure};
use super::outcome::Outcome;
use super::output::{Cleanup, Outputs};
use super::words::did_you_mean;
use crate::torture::export::BoundaryForm;
use crate::torture::generate::{Selection, families};
use crate::torture::report;
use crate::torture::run::{
    Limits, PRESETS, Plan, Preset, Record, Run, RunError, Running, Tool, ToolError, read_corpus,
    replay, run as run_all,
};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

/// Runs the verb.
///
/// # Errors
/// Exit code 2: the mesher cannot be started, a name is unknown, a folder cannot be used.
pub fn run(
    arguments: &TortureArguments,
    console: &Console,
    cleanup: &Cleanup,
) -> Result<Outcome, Failure> {
    if arguments.list {
        return Ok(Outcome {
            exit: EXIT_HOLDS,
            text: list_text(),
            json: list_json(),
            checked: None,
        });
    }
    let plan = plan(arguments)?;
    cleanup.also(&plan.tool.running);
    let run = match &arguments.replay {
        Some(folder) => {
            let corpus = read_corpus(folder).map_err(|error| cannot_run(&error.into()))?;
            watched(console, corpus.cases.len() as u64, |progress| replay(&plan, &corpus, progress))
        }
        None => watched(console, plan.cases, |progress| run_all(&plan, progress)),
    };
    let run = run.map_err(|error| cannot_run(&error))?;
    if let Some(out) = &plan.out {
        write_reports(out, &run, &plan, cleanup)?;
    }
    let is_clean = run.failures().next().is_none();
    Ok(Outcome {
        exit: if is_clean { EXIT_HOLDS } else { EXIT_FINDINGS },
        text: report::text(&run, &plan),
        json: report::json(&run, &plan),
        checked: None,
    })
}

/// Runs with a progress bar that counts cases and failures.
fn watched(
    console: &Console,
    cases: u64,
    work: impl FnOnce(&(dyn Fn(&Record) + Sync)) -> Result<Run, RunError>,
) -> Result<Run, RunError> {
    let bar = console.bar();
    bar.set_length(cases);
    let failures = AtomicU64::new(0);
    let outcome = work(&|record| {
        if record.judgement.class.is_failure() {
            let count = failures.fetch_add(1, Ordering::Relaxed) + 1;
            bar.set_message(format!("{count} fail"));
        }
        bar.inc(1);
    });
    bar.finish_and_clear();
    outcome
}

fn plan(arguments: &TortureArguments) -> Result<Plan, Failure> {
    let wanted = arguments.family.clone();
    if let Some(unknown) = wanted.iter().find(|name| !is_family(name)) {
        let near = did_you_mean(unknown, families().map(|family| family.name));
        let message = format!("there is no family `{unknown}`{near}");
        let help = "`trigrade torture --list` names all of them";
        return Err(Failure::cannot_run(Diagnostic::new(message).help(help)));
    }
    let selection = Selection {
        seed: arguments.seed,
        families: wanted,
        size_max: arguments.max_size as usize,
        plain: arguments.plain,
    };
    let mut tool = tool(arguments)?;
    tool.allow.extend(&arguments.allow);
    Ok(Plan {
        selection,
        cases: arguments.cases,
        tool,
        limits: Limits { time: arguments.timeout, memory: arguments.memory },
        aspect_max: arguments.max_aspect,
        shrunk_max: arguments.shrink as usize,
        trials_max: arguments.trials,
        out: arguments.out.clone(),
    })
}

fn is_family(name: &str) -> bool {
    families().any(|family| family.name == name)
}

/// The mesher that is meant: a preset, or a command line; without either it is this program.
fn tool(arguments: &TortureArguments) -> Result<Tool, Failure> {
    let mut tool = match &arguments.mesher {
        Some(command) => Tool {
            name: command.split_whitespace().next().unwrap_or("mesher").to_owned(),
            command: command.clone(),
            form: BoundaryForm::Poly,
            answer: "msh".to_owned(),
            limit: None,
            allow: Vec::new(),
            install: None,
            running: Running::default(),
        },
        None => preset(&arguments.preset)?,
    };
    if !tool.command.contains("{in}") && !tool.command.contains("{stem}") {
        let message = "the mesher's command line has no {in} for the boundary";
        let help = "for instance --mesher 'gmsh -2 {in} -o {out}' --form geo";
        return Err(Failure::cannot_run(Diagnostic::new(message).help(help)));
    }
    if let Some(name) = &arguments.form {
        tool.form = BoundaryForm::from_extension(name).ok_or_else(|| {
            let message = format!("there is no form of boundary `{name}`");
            let known = BoundaryForm::ALL.map(BoundaryForm::extension).join(", ");
            Failure::cannot_run(Diagnostic::new(message).help(format!("there are {known}")))
        })?;
    }
    if let Some(answer) = &arguments.answer {
        tool.answer.clone_from(answer);
    }
    Ok(tool)
}

fn preset(name: &str) -> Result<Tool, Failure> {
    let preset = Preset::named(name).ok_or_else(|| {
        let known = PRESETS.map(|preset| preset.name).join(", ");
        let near = did_you_mean(name, PRESETS.map(|preset| preset.name));
        let message = format!("there is no preset `{name}`{near}");
        Failure::cannot_run(Diagnostic::new(message).help(format!("there are {known}")))
    })?;
    let program = std::env::current_exe()
        .map_err(|error| Failure::io("find", Path::new("this program"), &error))?;
    Ok(preset.tool(&program))
}

fn cannot_run(error: &RunError) -> Failure {
    let mut diagnostic = Diagnostic::new(error.to_string());
    if let RunError::Tool(ToolError::NotFound { install: Some(how), .. }) = error {
        diagnostic = diagnostic.help(format!("install it: {how}"));
    }
    Failure::cannot_run(diagnostic)
}

fn write_reports(out: &Path, run: &Run, plan: &Plan, cleanup: &Cleanup) -> Result<(), Failure> {
    fs::create_dir_all(out).map_err(|error| Failure::io("write", out, &error))?;
    let page = report::html(run, plan);
    let json = format!("{:#}\n", report::json(run, plan));
    let mut outputs =
        Outputs::prepare(&["report.html", "report.json"].map(|n| out.join(n)), cleanup)?;
    outputs.fill(0, |file| file.write_all(page.as_bytes()))?;
    outputs.fill(1, |file| file.write_all(json.as_bytes()))?;
    outputs.commit()?;
    Ok(())
}

fn list_text() -> String {
    let row = |family: &crate::torture::generate::Family| {
        format!("{:22} {:14} {}", family.name, family.claim.to_string(), family.about)
    };
    let presets = PRESETS.map(|preset| format!("{:22} {}", preset.name, preset.command));
    let families: Vec<String> = families().map(row).collect();
    format!("families\n{}\n\npresets\n{}", families.join("\n"), presets.join("\n"))
}

fn list_json() -> Value {
    let families = families().map(|family| {
        json!({ "name": family.name, "claim": family.claim.to_string(), "about": family.about })
    });
    let presets = PRESETS.map(|preset| {
        json!({ "name": preset.name, "command": preset.command, "install": preset.install })
    });
    json!({ "schema": "trigrade-torture-list/1", "families": families.collect::<Vec<_>>(), "presets": presets })
}
