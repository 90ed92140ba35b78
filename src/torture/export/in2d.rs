//! Netgen's `.in2d` (version 2): points, and segments that name the domain on either side.

use super::nesting::{constraints_are_inside, levels};
use super::{BoundaryForm, ExportError};
use crate::domain::Domain;
use crate::domain::validate::loop_orientation;
use crate::predicates::Sign;
use std::fmt::Write;

/// The file: domain 1 is what is to be meshed, domain 0 is not.
pub fn write(domain: &Domain) -> Result<String, ExportError> {
    let what = "which of these touching loops lies in which";
    let levels = levels(domain).ok_or_else(|| BoundaryForm::In2d.cannot_say(what))?;
    if !constraints_are_inside(domain) {
        return Err(BoundaryForm::In2d.cannot_say("segments and points outside the domain"));
    }
    if !domain.isolated_points().is_empty() {
        return Err(BoundaryForm::In2d.cannot_say("isolated points"));
    }
    let mut out = String::from("splinecurves2dv2\n1\n\npoints\n");
    for (i, p) in domain.points.iter().enumerate() {
        // Writing to a string cannot fail.
        let _ = writeln!(out, "{} {:?} {:?}", i + 1, p.x, p.y);
    }
    out.push_str("\nsegments\n");
    for (of, level) in domain.loops.iter().zip(&levels) {
        let is_left = loop_orientation(&domain.points, &of.vertices) != Sign::Negative;
        let sides = if is_left == level.is_outer() { "1 0" } else { "0 1" };
        for [a, b] in of.edges() {
            let _ = writeln!(out, "{sides} 2 {} {} -bc=1", a + 1, b + 1);
        }
    }
    for segment in &domain.segments {
        let [a, b] = segment.vertices.map(|v| v + 1);
        let _ = writeln!(out, "1 1 2 {a} {b} -bc=2");
    }
    Ok(out)
}
