//! `trigrade voronoi`: points in, the tessellation of the plane by the nearest point out.

use super::arguments::{DomainReading, VoronoiArguments};
use super::console::Console;
use super::domain_file::{invalid, load_domain};
use super::failure::{Diagnostic, EXIT_HOLDS, Failure};
use super::outcome::{Outcome, file_names};
use super::output::{Cleanup, Outputs};
use super::point_file::{Points, repetitions};
use super::watch::{Watch, stages, time, total};
use super::words::count;
use crate::domain::validate::validate;
use crate::draw;
use crate::format::{voronoi_json, voronoi_obj};
use crate::voronoi::{ClipBox, Clipped, Voronoi, voronoi};
use serde_json::json;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// A form that tessellations are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Json,
    Obj,
    Svg,
    Png,
}

/// What the cells are clipped to.
#[derive(Clone, Debug, PartialEq)]
enum Clip {
    Nothing,
    /// A box around the sites.
    Around,
    Box(ClipBox),
    Domain(PathBuf),
}

impl Form {
    fn named(name: &str) -> Option<Self> {
        Some(match name.to_ascii_lowercase().as_str() {
            "json" => Self::Json,
            "obj" => Self::Obj,
            "svg" => Self::Svg,
            "png" => Self::Png,
            _ => return None,
        })
    }

    fn of(path: &Path, said: Option<&str>) -> Result<Self, Failure> {
        let help = "there are json, obj, svg and png; --form says it where no extension does";
        let found = match said {
            Some(name) => Self::named(name),
            None => path.extension().and_then(|e| Self::named(e.to_str()?)),
        };
        found.ok_or_else(|| {
            let diagnostic = Diagnostic::new("this names no form that tessellations have");
            Failure::cannot_run(diagnostic.at(said.unwrap_or(&path.to_string_lossy())).help(help))
        })
    }
}

impl Clip {
    /// `box`, four numbers, or a domain file.
    fn of(text: Option<&str>) -> Result<Self, Failure> {
        let Some(text) = text else { return Ok(Self::Nothing) };
        if text == "box" {
            return Ok(Self::Around);
        }
        let is_numbers =
            text.contains(',') && text.split(',').all(|n| n.trim().parse::<f64>().is_ok());
        if !is_numbers {
            return Ok(Self::Domain(text.into()));
        }
        text.parse().map(Self::Box).map_err(|e: String| Failure::cannot_run(Diagnostic::new(e)))
    }
}

/// Runs the verb.
///
/// # Errors
/// Exit code 1: the domain to clip to is invalid. Exit code 2: files, forms.
pub fn run(
    arguments: &VoronoiArguments,
    console: &Console,
    cleanup: &Cleanup,
) -> Result<Outcome, Failure> {
    let mut watch = Watch::new(console);
    let said = arguments.form.as_deref();
    let forms: Vec<Form> =
        arguments.outputs.iter().map(|path| Form::of(path, said)).collect::<Result<_, _>>()?;
    let clip = clip_for(&forms, arguments.clip.as_deref())?;
    let mut outputs = Outputs::prepare(&arguments.outputs, cleanup)?;
    watch.begin("read");
    let points = Points::load(&arguments.input)?;
    watch.begin("tessellate");
    let cells = voronoi(points.points(), true)
        .map_err(|e| Failure::cannot_run(Diagnostic::new(e.to_string()).at(&points.input.name)))?;
    watch.begin("clip");
    let clipped = clip_cells(&cells, &clip, &arguments.clip_reading())?;
    watch.begin("write");
    for (i, form) in forms.iter().enumerate() {
        write(&mut outputs, i, *form, &cells, clipped.as_ref())?;
    }
    outputs.commit()?;
    let summary = Summary { points, cells, clipped, laps: watch.finish() };
    Ok(summary.outcome(arguments))
}

/// Pictures are of bounded cells, so they clip by themselves; OBJ must be told.
fn clip_for(forms: &[Form], said: Option<&str>) -> Result<Clip, Failure> {
    let clip = Clip::of(said)?;
    if clip == Clip::Nothing && forms.contains(&Form::Obj) {
        let diagnostic = Diagnostic::new("OBJ has no rays: unbounded cells cannot be written");
        return Err(Failure::cannot_run(
            diagnostic.help("bound them: --clip box, --clip XMIN,YMIN,XMAX,YMAX or --clip DOMAIN"),
        ));
    }
    let is_picture = |form: &Form| matches!(form, Form::Svg | Form::Png);
    match clip {
        Clip::Nothing if forms.iter().any(is_picture) => Ok(Clip::Around),
        clip => Ok(clip),
    }
}

fn clip_cells(
    cells: &Voronoi,
    clip: &Clip,
    reading: &DomainReading,
) -> Result<Option<Clipped>, Failure> {
    let bounds = match clip {
        Clip::Nothing => return Ok(None),
        Clip::Around => ClipBox::around(&cells.sites),
        Clip::Box(bounds) => Some(*bounds),
        Clip::Domain(path) => {
            let (input, domain) = load_domain(path, reading)?;
            let plc = validate(&domain).map_err(|faults| invalid(&input.name, &faults))?;
            let clipped = cells
                .clip_to_domain(&plc)
                .map_err(|e| Failure::cannot_run(Diagnostic::new(e.to_string()).at(&input.name)))?;
            return Ok(Some(clipped));
        }
    };
    // Without a site there is nothing to clip.
    Ok(Some(bounds.map_or_else(Clipped::default, |bounds| cells.clip_to_box(bounds))))
}

fn write(
    outputs: &mut Outputs,
    index: usize,
    form: Form,
    cells: &Voronoi,
    clipped: Option<&Clipped>,
) -> Result<(), Failure> {
    let nothing = Clipped::default();
    let pieces = clipped.unwrap_or(&nothing);
    let options = draw::Options::default();
    let refused = |e: draw::DrawError| Failure::cannot_run(Diagnostic::new(e.to_string()));
    match form {
        Form::Json => outputs.fill(index, |out| voronoi_json::write(cells, clipped, out)),
        Form::Obj => outputs.fill(index, |out| voronoi_obj::write(pieces, out)),
        Form::Svg => {
            let svg = draw::cells_svg(pieces, &cells.sites, &options).map_err(refused)?;
            outputs.fill(index, |out| out.write_all(svg.as_bytes()))
        }
        Form::Png => {
            let png = draw::cells_png(pieces, &cells.sites, &options).map_err(refused)?;
            outputs.fill(index, |out| out.write_all(&png))
        }
    }
}

/// What is told of a run.
struct Summary {
    points: Points,
    cells: Voronoi,
    clipped: Option<Clipped>,
    laps: Vec<(String, Duration)>,
}

impl Summary {
    fn outcome(self, arguments: &VoronoiArguments) -> Outcome {
        let json = json!({
            "schema": "trigrade-voronoi-run/1",
            "input": self.points.input.name,
            "given": self.cells.sites.len(),
            "repeated": self.cells.repeated.len(),
            "cells": self.cell_count(),
            "unbounded": self.unbounded(),
            "vertices": self.cells.vertices.len(),
            "edges": self.cells.edges.len(),
            "pieces": self.clipped.as_ref().map(|clipped| clipped.pieces.len()),
            "written": file_names(&arguments.outputs),
        });
        Outcome { exit: EXIT_HOLDS, text: self.text(arguments), json, checked: None }
    }

    fn cell_count(&self) -> usize {
        self.cells.sites.len() - self.cells.repeated.len()
    }

    fn unbounded(&self) -> usize {
        let sites = 0..self.cells.sites.len() as u32;
        sites.filter(|&s| self.cells.has_cell(s) && self.cells.is_unbounded(s)).count()
    }

    fn text(&self, arguments: &VoronoiArguments) -> String {
        let given = count(self.cells.sites.len() as u64);
        let mut lines = vec![format!("{}: {given} points", self.points.input.name)];
        let mut line = |label: &str, text: String| lines.push(format!("  {label:<11}{text}"));
        if !self.points.left_out().is_empty() {
            line("left out", self.points.left_out().join("; "));
        }
        if self.points.domain().is_some() {
            line("left out", "loops and segments: sites are points".into());
        }
        if let Some(text) = repetitions(&self.points, &self.cells.repeated) {
            line("repeated", text);
        }
        let numbers = [
            self.cell_count(),
            self.unbounded(),
            self.cells.vertices.len(),
            self.cells.edges.len(),
        ];
        let [cells, unbounded, vertices, edges] = numbers.map(|n| count(n as u64));
        line(
            "cells",
            format!("{cells}, {unbounded} unbounded; {vertices} vertices, {edges} edges"),
        );
        if let Some(clipped) = &self.clipped {
            line("clipped", format!("{} pieces", count(clipped.pieces.len() as u64)));
        }
        if arguments.timings {
            line("time", stages(&self.laps));
        }
        line("total", time(total(&self.laps)));
        line("written", file_names(&arguments.outputs).join(", "));
        lines.join("\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_to_clip_to_is_told_from_one_word() {
        assert_eq!(Clip::of(None), Ok(Clip::Nothing));
        assert_eq!(Clip::of(Some("box")), Ok(Clip::Around));
        assert!(matches!(Clip::of(Some("-1,0, 2,1e3")), Ok(Clip::Box(_))));
        assert_eq!(Clip::of(Some("a,b.poly")), Ok(Clip::Domain("a,b.poly".into())));
        for wrong in ["1,2,3", "0,0,0,1", "1,0,0,1", "0,0,inf,1", "nan,0,1,1"] {
            assert_eq!(Clip::of(Some(wrong)).expect_err(wrong).exit, 2);
        }
    }

    #[test]
    fn pictures_clip_by_themselves_and_obj_must_be_told() {
        assert_eq!(clip_for(&[Form::Json], None), Ok(Clip::Nothing));
        assert_eq!(clip_for(&[Form::Json, Form::Svg], None), Ok(Clip::Around));
        assert_eq!(clip_for(&[Form::Obj], None).expect_err("rays").exit, 2);
        assert_eq!(clip_for(&[Form::Obj], Some("box")), Ok(Clip::Around));
    }

    #[test]
    fn forms_by_word_and_by_name() {
        assert_eq!(Form::of(Path::new("a.OBJ"), None), Ok(Form::Obj));
        assert_eq!(Form::of(Path::new("-"), Some("json")), Ok(Form::Json));
        for (path, said) in [("-", None), ("a.off", None), ("a.json", Some("vtu"))] {
            assert_eq!(Form::of(Path::new(path), said).expect_err(path).exit, 2);
        }
    }
}
