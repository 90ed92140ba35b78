//! Loops as Triangle has them: segments, and a point in every hole.

use super::nesting::{is_inside, levels};
use super::{BoundaryForm, ExportError};
use crate::background::Background;
use crate::domain::validate::validate;
use crate::domain::{Domain, Inside, Segment};
use crate::point::Point2;
use std::collections::BTreeSet;

/// The same domain by Triangle's rule: a hole point inside every loop that the domain does not lie
/// in.
pub fn carved(domain: &Domain) -> Result<Domain, ExportError> {
    let mut carved = domain.clone();
    carved.loops.clear();
    let loops = domain.loops.iter().flat_map(|l| l.edges().zip(l.markers.iter().copied()));
    carved.segments = loops.map(|(vertices, marker)| Segment { vertices, marker }).collect();
    carved.segments.extend(&domain.segments);
    if let Inside::EvenOdd = domain.inside {
        carved.inside = Inside::Carve(holes(domain)?);
        if loops_touch(domain) && inside_triangles(domain) != inside_triangles(&carved) {
            return Err(BoundaryForm::Poly.cannot_say("an outside closed in by touching loops"));
        }
    }
    Ok(carved)
}

/// Whether any two loops, or a loop and itself, share a point.
fn loops_touch(domain: &Domain) -> bool {
    let Ok(plc) = validate(domain) else { return false };
    let mut edges = vec![0; plc.points.len()];
    let ends = plc.segments.iter().filter(|s| s.in_loop).flat_map(|s| s.vertices);
    ends.for_each(|v| edges[v as usize] += 1);
    edges.into_iter().any(|count: u32| count > 2)
}

/// How many triangles of the domain's triangulation lie inside; the same segments give the same
/// triangulation, so equal counts of nested insides mean the same inside.
fn inside_triangles(domain: &Domain) -> Option<usize> {
    let background = Background::new(&validate(domain).ok()?).ok()?;
    Some(background.triangulation.triangles().filter(|&t| background.is_inside(t)).count())
}

fn holes(domain: &Domain) -> Result<Vec<Point2>, ExportError> {
    let cannot = |what| BoundaryForm::Poly.cannot_say(what);
    let levels = levels(domain).ok_or(cannot("which of these touching loops lies in which"))?;
    let mut points = Vec::new();
    for hole in (0..levels.len()).filter(|&i| !levels[i].is_outer()) {
        let inner: Vec<usize> =
            (0..levels.len()).filter(|&i| levels[i].around == Some(hole)).collect();
        let before = points.len();
        if inner.is_empty() && !touches_itself(domain, hole) {
            points.extend(points_in(domain, hole, &[], hole).next());
        } else {
            // Islands that touch may cut the hole in several faces: a point at every corner. More
            // than one in a face does no harm.
            for of in inner.iter().copied().chain([hole]) {
                points.extend(points_in(domain, hole, &inner, of));
            }
        }
        if points.len() == before {
            return Err(cannot("a hole with no point in it"));
        }
    }
    Ok(points)
}

/// Whether a loop comes to a point twice: then its inside may be several faces.
fn touches_itself(domain: &Domain, index: usize) -> bool {
    let vertices = &domain.loops[index].vertices;
    let places: BTreeSet<[u64; 2]> =
        vertices.iter().map(|&v| domain.points[v as usize].key()).collect();
    places.len() < vertices.len()
}

/// Points inside a loop and outside the loops directly in it, one near each corner of loop `of`
/// where one is found.
fn points_in<'a>(
    domain: &'a Domain,
    hole: usize,
    inner: &'a [usize],
    of: usize,
) -> impl Iterator<Item = Point2> + 'a {
    let is_good = move |p: &Point2| {
        is_inside(domain, hole, *p) == Some(true)
            && inner.iter().all(|&i| is_inside(domain, i, *p) == Some(false))
    };
    let vertices = &domain.loops[of].vertices;
    let n = vertices.len();
    let at = move |i: usize| domain.points[vertices[i % n] as usize];
    let middle = |p: f64, q: f64| p / 2.0 + q / 2.0;
    (0..n).filter_map(move |i| {
        let (a, b, c) = (at(i), at(i + 1), at(i + 2));
        let between = Point2::new(middle(a.x, c.x), middle(a.y, c.y));
        let opposite = Point2::new(b.x + (b.x - between.x), b.y + (b.y - between.y));
        [between, opposite].into_iter().find_map(|mut p| {
            // Ever nearer to the corner, until nothing else is between.
            (0..60).find_map(|_| {
                p = Point2::new(middle(p.x, b.x), middle(p.y, b.y));
                is_good(&p).then_some(p)
            })
        })
    })
}
