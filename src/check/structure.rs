//! What can be said of a mesh before its geometry is looked at: references, repeated corners,
//! finite coordinates, duplicate and unused points. What remains are the sound triangles.

use super::id::Id;
use super::points::PointIndex;
use super::report::{Collector, Draft, show_triangle, show_vertex};
use crate::mesh::{MeshData, NO_POINT};
use std::borrow::Cow;

/// The triangles whose geometry can be looked at.
pub(super) struct Sound<'a> {
    /// The file's mesh.
    pub(super) mesh: &'a MeshData,
    /// Triangles with different, finite corners; duplicate points are one vertex.
    pub(super) triangles: Cow<'a, [[u32; 3]]>,
    /// Index in the file of each sound triangle, unless all are sound.
    origin: Option<Vec<u32>>,
    /// Corners of the triangles left out, [`NO_POINT`] where there is none.
    pub(super) dropped: Vec<[u32; 3]>,
    /// The vertex that stands for each point, unless no two are equal.
    pub(super) canonical: Option<Vec<u32>>,
    /// Whether a triangle of the file uses the point.
    pub(super) used: Vec<bool>,
    /// The points in use by coordinates.
    index: PointIndex<'a, 3>,
    /// The other finite points by coordinates, if there are any.
    unused_index: Option<PointIndex<'a, 3>>,
}

impl Sound<'_> {
    /// Index in the file of a sound triangle.
    pub(super) fn origin(&self, triangle: u32) -> u32 {
        self.origin.as_ref().map_or(triangle, |origin| origin[triangle as usize])
    }

    /// The point of the mesh at these coordinates: one in use if there is one.
    pub(super) fn point_at(&self, point: &[f64; 3]) -> Option<u32> {
        let unused = || self.unused_index.as_ref()?.find(point);
        self.index.find(point).or_else(unused)
    }

    /// Leaves out triangles (sorted indices) that another finding has dealt with.
    pub(super) fn remove(&mut self, triangles: &[u32]) {
        let gone = |t: u32| triangles.binary_search(&t).is_ok();
        let count = self.triangles.len() as u32;
        let kept: Vec<u32> = (0..count).filter(|&t| !gone(t)).collect();
        self.origin = Some(kept.iter().map(|&t| self.origin(t)).collect());
        self.triangles = kept.iter().map(|&t| self.triangles[t as usize]).collect();
    }

    /// The vertex that stands for a point.
    pub(super) fn vertex(&self, point: u32) -> u32 {
        self.canonical.as_ref().map_or(point, |canonical| canonical[point as usize])
    }
}

/// Checks M2 to M5 and gathers the sound triangles; unused points are reported later, when it is
/// known which of them another finding explains.
pub(super) fn survey<'a>(mesh: &'a MeshData, out: &mut Collector<'_>) -> Sound<'a> {
    let finite = find_not_finite(mesh, out);
    report_bad_edges(mesh, out);
    let mut used = vec![false; mesh.points.len()];
    let faulty = find_faulty_triangles(mesh, &finite, &mut used, out);
    let (index, canonical) = find_duplicate_points(mesh, &finite, &used, out);
    let is_finite = |v: u32| finite.get(v as usize).copied().unwrap_or(true);
    let is_unused = |v: u32| !used[v as usize] && is_finite(v);
    let unused_index = (0..mesh.points.len() as u32)
        .any(is_unused)
        .then(|| PointIndex::new(&mesh.points, is_unused).0);
    let mut sound = Sound {
        mesh,
        triangles: Cow::Borrowed(&mesh.triangles),
        origin: None,
        dropped: faulty.iter().map(|&t| known_corners(mesh, t)).collect(),
        canonical,
        used,
        index,
        unused_index,
    };
    if !faulty.is_empty() {
        sound.remove(&faulty);
    }
    if sound.canonical.is_some() {
        merge_duplicates(&mut sound);
    }
    sound
}

/// Points with a coordinate that is no number; empty when there is none.
fn find_not_finite(mesh: &MeshData, out: &mut Collector<'_>) -> Vec<bool> {
    let finite = |p: &[f64; 3]| p.iter().all(|c| c.is_finite());
    if mesh.points.iter().all(finite) {
        return Vec::new();
    }
    for (v, point) in (0u32..).zip(&mesh.points) {
        if !finite(point) {
            out.add(Id::NotFinite, || {
                let text =
                    format!("point {} has a coordinate that is not finite", show_vertex(mesh, v));
                Draft::new(Id::NotFinite, text).vertices([v])
            });
        }
    }
    mesh.points.iter().map(finite).collect()
}

/// Triangles with a bad reference, a repeated corner or a corner that is not finite, sorted.
fn find_faulty_triangles(
    mesh: &MeshData,
    finite: &[bool],
    used: &mut [bool],
    out: &mut Collector<'_>,
) -> Vec<u32> {
    let mut faulty = Vec::new();
    for (t, &[a, b, c]) in (0u32..).zip(&mesh.triangles) {
        let mut known = true;
        for v in [a, b, c] {
            match used.get_mut(v as usize) {
                Some(flag) => *flag = true,
                None => known = false,
            }
        }
        if !known {
            report_references(mesh, t, out);
            faulty.push(t);
        } else if a == b || b == c || c == a {
            out.add(Id::RepeatedVertex, || repeated_vertex(mesh, t));
            faulty.push(t);
        } else if !finite.is_empty() && [a, b, c].iter().any(|&v| !finite[v as usize]) {
            faulty.push(t);
        }
    }
    faulty
}

/// One finding for each corner that names no point.
fn report_references(mesh: &MeshData, t: u32, out: &mut Collector<'_>) {
    for (corner, &v) in (0u8..).zip(&mesh.triangles[t as usize]) {
        if (v as usize) < mesh.points.len() {
            continue;
        }
        let stated = mesh.bad_references.iter().find(|r| r.triangle == t && r.corner == corner);
        out.add(Id::BadReference, || {
            let value = stated.map_or(i64::from(v), |r| r.value);
            let (number, n) = (show_triangle(mesh, t), mesh.points.len());
            let text = format!(
                "corner {corner} of triangle {number} names point {value}; the mesh has {n} points"
            );
            #[expect(clippy::cast_precision_loss, reason = "a value for the reader")]
            let value = value as f64;
            let known = mesh.triangles[t as usize].into_iter().filter(|&v| (v as usize) < n);
            Draft::new(Id::BadReference, text)
                .triangles([t])
                .vertices(known)
                .measured("value", value)
        });
    }
}

/// One finding for each marked edge that names a point that does not exist.
fn report_bad_edges(mesh: &MeshData, out: &mut Collector<'_>) {
    let n = mesh.points.len();
    for bad in &mesh.bad_edges {
        out.add(Id::BadReference, || {
            let text = format!(
                "marked edge {} names point {}; the mesh has {n} points",
                bad.edge, bad.value
            );
            Draft::new(Id::BadReference, text)
        });
    }
    for (i, edge) in mesh.edges.iter().enumerate() {
        if let Some(v) = edge.vertices.into_iter().find(|&v| v as usize >= n) {
            out.add(Id::BadReference, || {
                let text = format!("marked edge {i} names point {v}; the mesh has {n} points");
                Draft::new(Id::BadReference, text)
            });
        }
    }
}

fn repeated_vertex(mesh: &MeshData, t: u32) -> Draft {
    let [a, b, c] = mesh.triangles[t as usize];
    let twice = if a == b || a == c { a } else { b };
    let text = format!(
        "triangle {} names point {} more than once",
        show_triangle(mesh, t),
        show_vertex(mesh, twice)
    );
    Draft::new(Id::RepeatedVertex, text).triangles([t]).vertices([a, b, c])
}

fn known_corners(mesh: &MeshData, t: u32) -> [u32; 3] {
    let known = |v: u32| if (v as usize) < mesh.points.len() { v } else { NO_POINT };
    mesh.triangles[t as usize].map(known)
}

/// The vertex standing for each point when some points in use are equal: the first of them.
fn find_duplicate_points<'a>(
    mesh: &'a MeshData,
    finite: &[bool],
    used: &[bool],
    out: &mut Collector<'_>,
) -> (PointIndex<'a, 3>, Option<Vec<u32>>) {
    let eligible = |v: u32| used[v as usize] && finite.get(v as usize).copied().unwrap_or(true);
    let (index, pairs) = PointIndex::new(&mesh.points, eligible);
    if pairs.is_empty() {
        return (index, None);
    }
    let mut canonical: Vec<u32> = (0u32..).take(mesh.points.len()).collect();
    for (first, again) in pairs {
        canonical[again as usize] = first;
        out.add(Id::DuplicateVertex, || {
            let (a, b) = (show_vertex(mesh, first), show_vertex(mesh, again));
            let text = format!("points {a} and {b} are the same place");
            Draft::new(Id::DuplicateVertex, text).vertices([first, again])
        });
    }
    (index, Some(canonical))
}

/// Puts one vertex in the place of equal points, and leaves out triangles that collapse by it.
fn merge_duplicates(sound: &mut Sound<'_>) {
    let canonical = sound.canonical.take().unwrap_or_default();
    let merged: Vec<[u32; 3]> =
        sound.triangles.iter().map(|t| t.map(|v| canonical[v as usize])).collect();
    let collapsed: Vec<u32> = (0u32..)
        .zip(&merged)
        .filter(|(_, [a, b, c])| a == b || b == c || c == a)
        .map(|(t, _)| t)
        .collect();
    sound.triangles = Cow::Owned(merged);
    sound.canonical = Some(canonical);
    if !collapsed.is_empty() {
        sound.remove(&collapsed);
    }
}

/// Reports M6, but for points that another finding concerns: the corner of a missing triangle is
/// unused because the triangle is missing.
pub(super) fn report_unused(
    sound: &Sound<'_>,
    concerned: &std::collections::BTreeSet<u32>,
    out: &mut Collector<'_>,
) {
    for (v, _) in (0u32..).zip(&sound.used).filter(|(_, used)| !**used) {
        let mesh = sound.mesh;
        let finite = mesh.points[v as usize].iter().all(|c| c.is_finite());
        if finite && !concerned.contains(&v) {
            out.add(Id::UnusedVertex, || {
                let text = format!("no triangle uses point {}", show_vertex(mesh, v));
                Draft::new(Id::UnusedVertex, text).vertices([v])
            });
        }
    }
}
