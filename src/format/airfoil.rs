//! Airfoil coordinates as the UIUC collection has them: a name, then points, in one of two layouts.
//!
//! Selig's runs from the trailing edge over one side to the leading edge and back on the other.
//! Lednicer's gives the numbers of points of the upper and lower side, then each side from the
//! leading edge to the trailing edge. A closed trailing edge's repeated point and the leading edge
//! that Lednicer's sides share are dropped; an open trailing edge is closed by a straight segment.

use super::domain_builder::{Builder, open_ring};
use super::domain_file::{DomainReadError, Problem, TextLines, number};
use crate::domain::{BoundingBox, Domain, Loop, LoopRole, Place};
use crate::point::Point2;

/// Marker of the airfoil's edges.
pub const AIRFOIL_MARKER: i32 = 1;

/// Marker of the far field's edges.
pub const FAR_FIELD_MARKER: i32 = 2;

/// A circle around an airfoil: the outer boundary of the air to be meshed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FarField {
    /// Radius in chord lengths; the centre is the middle of the airfoil's bounding box, whose
    /// width is the chord.
    pub chords: f64,
    /// Number of points on the circle, at least 3.
    pub points: u32,
}

impl FarField {
    /// More points on the circle than this are refused.
    pub const POINTS_MAX: u32 = 1_000_000;
}

type Line = (u64, [f64; 2]);

/// Reads an airfoil; with a far field, as a hole in that.
///
/// # Errors
/// What keeps the file from being understood, with its line.
pub fn read(bytes: &[u8], far_field: Option<FarField>) -> Result<Domain, DomainReadError> {
    let lines = read_lines(bytes)?;
    let mut ring = match sides(&lines)? {
        Some((upper, lower)) => join(upper, lower),
        None => points(&lines),
    };
    open_ring(&mut ring);
    let mut builder = Builder::new();
    let bounds = BoundingBox::of(ring.iter().map(|(at, _)| *at));
    let place = ring.first().map_or(Place::Made, |(_, place)| place.clone());
    let vertices = ring.into_iter().map(|(at, place)| builder.point(at, place)).collect();
    let role = far_field.map_or(LoopRole::Outer, |_| LoopRole::HoleOf(1));
    builder.add_loop(Loop::new(vertices, AIRFOIL_MARKER, role), place);
    if let (Some(far_field), Some(bounds)) = (far_field, bounds) {
        add_far_field(&mut builder, far_field, bounds)?;
    }
    Ok(builder.domain)
}

/// The lines with two numbers; the first line may be a name instead.
fn read_lines(bytes: &[u8]) -> Result<Vec<Line>, DomainReadError> {
    let mut text = TextLines::new(bytes);
    let mut lines = Vec::new();
    let mut first = true;
    for (line, tokens) in text.by_ref() {
        match two_numbers(&tokens) {
            Ok(numbers) => lines.push((line, numbers)),
            Err(_) if first => {}
            Err(problem) => return Err(problem.at(Place::Line(line))),
        }
        first = false;
    }
    if lines.is_empty() {
        let found = "no line with two numbers".to_owned();
        let problem = Problem::Expected { what: "a name and then points x y", found };
        return Err(problem.at(Place::Line(text.number())));
    }
    Ok(lines)
}

fn two_numbers(text: &str) -> Result<[f64; 2], Problem> {
    const WHAT: &str = "a point: two numbers x y";
    let tokens: Vec<&str> = text.split_whitespace().take(3).collect();
    if let [x, y] = tokens[..] {
        return Ok([number(x, WHAT)?, number(y, WHAT)?]);
    }
    if let Some(Err(problem @ Problem::DecimalComma(_))) = tokens.first().map(|t| number(t, WHAT)) {
        return Err(problem);
    }
    Err(Problem::Expected { what: WHAT, found: format!("'{}'", super::domain_file::excerpt(text)) })
}

type Sides<'a> = (&'a [Line], &'a [Line]);

/// The two sides of Lednicer's layout, which the first line announces: two whole numbers above 1.
fn sides(lines: &[Line]) -> Result<Option<Sides<'_>>, DomainReadError> {
    let (line, counts) = lines[0];
    if !counts.iter().all(|count| *count > 1.0 && count.fract() == 0.0) {
        return Ok(None);
    }
    let points = &lines[1..];
    let [upper, lower] = counts;
    if upper + lower == points.len() as f64 {
        return Ok(Some(points.split_at(upper as usize)));
    }
    let (what, found) = ("points on both sides", points.len());
    // Saturates for absurd counts; it is only printed.
    let stated = (upper + lower) as u64;
    Err(if stated > found as u64 {
        Problem::Truncated { what, stated, found: found as u64 }
    } else {
        Problem::Length { what, found, expected: stated as usize }
    }
    .at(Place::Line(line)))
}

fn points(lines: &[Line]) -> Vec<(Point2, Place)> {
    lines.iter().map(|&(line, at)| (at.into(), Place::Line(line))).collect()
}

/// Trailing edge, upper side, leading edge, lower side.
fn join(upper: &[Line], lower: &[Line]) -> Vec<(Point2, Place)> {
    let (mut ring, lower) = (points(upper), points(lower));
    ring.reverse();
    let shared = match (ring.last(), lower.first()) {
        (Some((upper, _)), Some((lower, _))) => upper.key() == lower.key(),
        _ => false,
    };
    ring.extend(lower.into_iter().skip(usize::from(shared)));
    ring
}

fn add_far_field(
    builder: &mut Builder,
    FarField { chords, points }: FarField,
    BoundingBox { min, max }: BoundingBox,
) -> Result<(), DomainReadError> {
    if !(3..=FarField::POINTS_MAX).contains(&points) {
        return Err(
            Problem::Option("a far field has between 3 and 1,000,000 points").at(Place::Made)
        );
    }
    let radius = chords * (max.x - min.x);
    if !(radius > 0.0 && radius.is_finite()) {
        let message =
            "a far field needs a radius above 0 and an airfoil with a finite chord above 0";
        return Err(Problem::Option(message).at(Place::Made));
    }
    let centre = Point2::new(min.x / 2.0 + max.x / 2.0, min.y / 2.0 + max.y / 2.0);
    let on_circle = |i: u32| {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(points);
        Point2::new(centre.x + radius * libm::cos(angle), centre.y + radius * libm::sin(angle))
    };
    let vertices = (0..points).map(|i| builder.point(on_circle(i), Place::Made)).collect();
    builder.add_loop(Loop::new(vertices, FAR_FIELD_MARKER, LoopRole::Outer), Place::Made);
    Ok(())
}
