//! The plain JSON layout of polygons: outer ring, holes, segments and points as coordinates.

use super::domain_builder::Builder;
use super::domain_file::{DomainReadError, Problem};
use super::domain_json::{Item, carve};
use crate::domain::{Domain, Inside, LoopRole};

/// Reads `{"outer": [[x, y], ..], "holes": [[[x, y], ..], ..]}` or several of these in an array
/// `polygons`, with optional `segments` (pairs of points), `points` and `hole_seeds`. Other keys are
/// names and notes, and ignored. Without any ring, or with hole seeds, Triangle's rule says what is
/// inside; else the even-odd rule does.
pub(super) fn read(root: Item) -> Result<Domain, DomainReadError> {
    let known = ["outer", "polygons", "segments", "points"];
    let keys = root.object("an object with the domain")?;
    if !known.iter().any(|&key| keys.contains_key(key)) {
        return Err(root.error(Problem::MissingKey("loops")));
    }
    if keys.contains_key("outer") && keys.contains_key("polygons") {
        return Err(root.error(Problem::Excluded("'outer'", "'polygons'")));
    }
    let mut builder = Builder::new();
    read_polygon(root, &mut builder)?;
    root.key("polygons", |item| {
        item.each("an array of polygons", |item| {
            item.object("a polygon {\"outer\": .., \"holes\": ..}")?;
            if read_polygon(item, &mut builder)? {
                return Ok(());
            }
            Err(item.error(Problem::MissingKey("outer")))
        })
    })?;
    root.key("segments", |item| {
        item.each("an array of segments", |item| read_segment(item, &mut builder))
    })?;
    root.key("points", |item| {
        for (at, place) in item.positions("an array of points")? {
            builder.point(at, place);
        }
        Ok(())
    })?;
    let has_holes = builder.domain.loops.iter().any(|l| matches!(l.role, LoopRole::HoleOf(_)));
    if builder.domain.loops.is_empty() {
        builder.domain.inside = Inside::Carve(Vec::new());
    }
    root.key("hole_seeds", |item| match &item.positions("an array of hole points")?[..] {
        [] => Ok(()),
        _ if has_holes => Err(item.error(Problem::Excluded("'hole_seeds'", "'holes'"))),
        _ => carve(item, &mut builder.domain),
    })?;
    Ok(builder.domain)
}

/// Reads the outer ring and the holes of an object; returns whether there is an outer ring.
fn read_polygon(item: Item, builder: &mut Builder) -> Result<bool, DomainReadError> {
    let outer = item.key("outer", |item| {
        Ok(builder.ring(item.positions("a ring of points")?, LoopRole::Outer, item.place()))
    })?;
    item.key("holes", |item| {
        item.each("an array of rings", |item| {
            let outer = outer.ok_or_else(|| item.error(Problem::MissingKey("outer")))?;
            let ring = item.positions("a ring of points")?;
            builder.ring(ring, LoopRole::HoleOf(outer), item.place());
            Ok(())
        })
    })?;
    Ok(outer.is_some())
}

fn read_segment(item: Item, builder: &mut Builder) -> Result<(), DomainReadError> {
    let ends = item.positions("a segment [[x, y], [x, y]]")?;
    let found = ends.len();
    let Ok([a, b]) = <[_; 2]>::try_from(ends) else {
        return Err(item.error(Problem::Length { what: "ends of a segment", found, expected: 2 }));
    };
    let ends = [a, b].map(|(at, place)| builder.segment_point(at, || place));
    builder.segment(ends, 0, item.place());
    Ok(())
}
