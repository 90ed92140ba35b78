//! Gmsh's `.geo` script: points, lines, curve loops (all counterclockwise), plane surfaces; constraints
//! are embedded.

use super::nesting::{constraints_are_inside, levels};
use super::{BoundaryForm, ExportError};
use crate::domain::Domain;
use crate::domain::validate::loop_orientation;
use crate::predicates::Sign;
use std::fmt::Write;

/// The script. Each point's mesh size is the mean length of its edges.
pub fn write(domain: &Domain) -> Result<String, ExportError> {
    let what = "which of these touching loops lies in which";
    let levels = levels(domain).ok_or_else(|| BoundaryForm::Geo.cannot_say(what))?;
    if !constraints_are_inside(domain) {
        return Err(BoundaryForm::Geo.cannot_say("segments and points outside the domain"));
    }
    let mut out = String::from("SetFactory(\"Built-in\");\n");
    let mut say = |text: std::fmt::Arguments| {
        // Writing to a string cannot fail.
        let _ = out.write_fmt(text);
    };
    for (i, (p, size)) in domain.points.iter().zip(sizes(domain)).enumerate() {
        say(format_args!("Point({}) = {{{:?}, {:?}, 0, {size:?}}};\n", i + 1, p.x, p.y));
    }
    for (i, [a, b]) in domain.edges().enumerate() {
        say(format_args!("Line({}) = {{{}, {}}};\n", i + 1, a + 1, b + 1));
    }
    let mut line = 1;
    for (i, of) in domain.loops.iter().enumerate() {
        let lines = line..line + of.vertices.len();
        line = lines.end;
        // Gmsh turns its triangles the way the surface's first loop runs.
        let lines = match loop_orientation(&domain.points, &of.vertices) {
            Sign::Negative => list(lines.rev().map(|n| format!("-{n}"))),
            _ => list(lines),
        };
        say(format_args!("Curve Loop({}) = {{{lines}}};\n", i + 1));
    }
    let mut surfaces = Vec::new();
    for i in (0..levels.len()).filter(|&i| levels[i].is_outer()) {
        let holes = (0..levels.len()).filter(|&j| levels[j].around == Some(i) && j != i);
        let loops = list(std::iter::once(i).chain(holes).map(|j| j + 1));
        surfaces.push(i + 1);
        say(format_args!("Plane Surface({}) = {{{loops}}};\n", i + 1));
    }
    let alone = domain.isolated_points();
    // The format wants the surface that an embedded line or point lies in: with one surface it is
    // that.
    if surfaces.len() > 1 && !(domain.segments.is_empty() && alone.is_empty()) {
        let what = "segments and points without naming their surface";
        return Err(BoundaryForm::Geo.cannot_say(what));
    }
    if !alone.is_empty() {
        let points = list(alone.into_iter().map(|v| v + 1));
        say(format_args!("Point{{{points}}} In Surface{{{}}};\n", list(surfaces.iter().copied())));
    }
    if !domain.segments.is_empty() {
        let lines = list(line..line + domain.segments.len());
        say(format_args!("Curve{{{lines}}} In Surface{{{}}};\n", list(surfaces.iter().copied())));
    }
    Ok(out)
}

fn list<N: ToString>(numbers: impl Iterator<Item = N>) -> String {
    numbers.map(|n| n.to_string()).collect::<Vec<_>>().join(", ")
}

fn sizes(domain: &Domain) -> Vec<f64> {
    let mut means = vec![(0.0, 0u32); domain.points.len()];
    for [a, b] in domain.edges() {
        let [p, q] = [a, b].map(|v| domain.points[v as usize]);
        let length = libm::hypot(q.x - p.x, q.y - p.y);
        for v in [a, b] {
            let (mean, count) = &mut means[v as usize];
            *count += 1;
            *mean += (length - *mean) / f64::from(*count);
        }
    }
    means.into_iter().map(|(mean, _)| if mean > 0.0 { mean.min(f64::MAX) } else { 1.0 }).collect()
}
