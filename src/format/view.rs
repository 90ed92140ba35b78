//! A mesh to be written, borrowed from whoever has it.

use crate::format::MeshForm;
use crate::format::error::WriteError;
use crate::mesh::{MarkedEdge, Mesh, MeshData};
use crate::point::Point2;

/// Points in the plane or in space.
#[derive(Clone, Copy, Debug)]
enum Points<'a> {
    Plane(&'a [Point2]),
    Space(&'a [[f64; 3]]),
}

/// A borrowed mesh, plane or in space.
///
/// # Shapes and units
/// As [`Mesh`] and [`MeshData`], which both convert into it.
#[derive(Clone, Copy, Debug)]
pub struct MeshView<'a> {
    points: Points<'a>,
    triangles: &'a [[u32; 3]],
    edges: &'a [MarkedEdge],
    regions: &'a [i32],
    parameters: &'a [[f64; 2]],
    /// How many quadrilaterals the first triangles are, two each.
    quads: usize,
}

/// A face to be written.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Face {
    corners: [u32; 4],
    count: usize,
}

impl Face {
    /// Its corners in order.
    pub(crate) fn corners(&self) -> &[u32] {
        &self.corners[..self.count]
    }
}

impl<'a> From<&'a Mesh> for MeshView<'a> {
    fn from(mesh: &'a Mesh) -> Self {
        Self {
            points: Points::Plane(&mesh.points),
            triangles: &mesh.triangles,
            edges: &mesh.edges,
            regions: &mesh.regions,
            parameters: &[],
            quads: 0,
        }
    }
}

impl<'a> From<&'a MeshData> for MeshView<'a> {
    fn from(mesh: &'a MeshData) -> Self {
        Self {
            points: Points::Space(&mesh.points),
            triangles: &mesh.triangles,
            edges: &mesh.edges,
            regions: &mesh.regions,
            parameters: &[],
            quads: 0,
        }
    }
}

impl<'a> MeshView<'a> {
    /// The same mesh with the parameters (u, v) of each point, which VTK files carry as point data;
    /// left out unless there is one for each.
    #[must_use]
    pub fn with_parameters(mut self, parameters: &'a [[f64; 2]]) -> Self {
        self.parameters = if parameters.len() == self.point_count() { parameters } else { &[] };
        self
    }

    /// The same mesh with two triangles (a, b, c) and (a, c, d) each as the quadrilateral (a, b, c, d);
    /// `None` when they are not so paired (see [`crate::structured::pair_up`]).
    #[must_use]
    pub fn with_quads(self) -> Option<Self> {
        let (count, is_even) = (self.triangles.len() / 2, self.triangles.len().is_multiple_of(2));
        if is_even { self.with_first_quads(count) } else { None }
    }

    /// The same mesh with the first `count` pairs of triangles as quadrilaterals, all others as they
    /// are; `None` when those are not so paired.
    #[must_use]
    pub fn with_first_quads(mut self, count: usize) -> Option<Self> {
        let is_pair =
            |pair: &[[u32; 3]]| matches!(pair, [[a, _, c], [d, e, _]] if (a, c) == (d, e));
        let paired = self.triangles.get(..count.checked_mul(2)?)?;
        let regions = self.regions.get(..2 * count).unwrap_or_default();
        let is_one = regions.chunks(2).all(|pair| pair.len() == 2 && pair[0] == pair[1]);
        let all = paired.chunks(2).all(is_pair) && is_one;
        self.quads = count;
        all.then_some(self)
    }

    /// Whether some of its faces are quadrilaterals.
    #[must_use]
    pub const fn has_quads(&self) -> bool {
        self.quads > 0
    }

    /// Number of quadrilaterals, which come before the triangles.
    pub(crate) const fn quad_count(&self) -> usize {
        self.quads
    }

    /// Number of quadrilaterals and triangles.
    pub(crate) const fn face_count(&self) -> usize {
        self.triangles.len() - self.quads
    }

    /// Number of corners of all faces together.
    pub(crate) const fn corner_count(&self) -> usize {
        4 * self.quads + 3 * (self.triangles.len() - 2 * self.quads)
    }

    /// The faces in order: quadrilaterals, then triangles.
    pub(crate) fn faces(self) -> impl Iterator<Item = Face> + 'a {
        let (paired, single) = self.triangles.split_at(2 * self.quads);
        let quad = |pair: &[[u32; 3]]| {
            let ([a, b, c], [.., d]) = (pair[0], pair[1]);
            Face { corners: [a, b, c, d], count: 4 }
        };
        let triangle = |&[a, b, c]: &[u32; 3]| Face { corners: [a, b, c, 0], count: 3 };
        paired.chunks_exact(2).map(quad).chain(single.iter().map(triangle))
    }

    /// Region of face `index`, or `default` when the mesh has none.
    #[inline]
    pub(crate) fn face_region(&self, index: usize, default: i32) -> i32 {
        self.region(index + index.min(self.quads), default)
    }

    /// The parameters (u, v) of the points; empty where there are none.
    #[must_use]
    pub const fn parameters(&self) -> &'a [[f64; 2]] {
        self.parameters
    }

    /// Number of points.
    #[must_use]
    pub fn point_count(&self) -> usize {
        match self.points {
            Points::Plane(points) => points.len(),
            Points::Space(points) => points.len(),
        }
    }

    /// Point `index`; z = 0 in the plane.
    #[must_use]
    #[inline]
    pub fn point(&self, index: usize) -> [f64; 3] {
        match self.points {
            Points::Plane(points) => [points[index].x, points[index].y, 0.0],
            Points::Space(points) => points[index],
        }
    }

    /// The points in order.
    pub fn points(self) -> impl Iterator<Item = [f64; 3]> + 'a {
        (0..self.point_count()).map(move |index| self.point(index))
    }

    /// The triangles.
    #[must_use]
    pub const fn triangles(&self) -> &'a [[u32; 3]] {
        self.triangles
    }

    /// The marked edges.
    #[must_use]
    pub const fn edges(&self) -> &'a [MarkedEdge] {
        self.edges
    }

    /// Whether the triangles have region markers.
    #[must_use]
    pub const fn has_regions(&self) -> bool {
        !self.regions.is_empty()
    }

    /// Region of triangle `index`, or `default` when the mesh has none.
    #[must_use]
    #[inline]
    pub fn region(&self, index: usize, default: i32) -> i32 {
        self.regions.get(index).copied().unwrap_or(default)
    }

    /// Whether every z is +0.0, so that a form with two coordinates loses nothing.
    #[must_use]
    pub fn is_plane(&self) -> bool {
        match self.points {
            Points::Plane(_) => true,
            Points::Space(points) => points.iter().all(|p| p[2].to_bits() == 0),
        }
    }

    /// The first reference to a point that does not exist, or a list of wrong length.
    ///
    /// # Errors
    /// [`WriteError::BadReference`], [`WriteError::Regions`].
    pub fn validate(&self) -> Result<(), WriteError> {
        let count = self.point_count();
        let bad = |vertices: &[u32]| vertices.iter().any(|&vertex| vertex as usize >= count);
        let (regions, triangles) = (self.regions.len(), self.triangles.len());
        if regions != 0 && regions != triangles {
            return Err(WriteError::Regions { regions, triangles });
        }
        if let Some(index) = self.triangles.iter().position(|triangle| bad(triangle)) {
            return Err(WriteError::BadReference { item: "triangle", index });
        }
        if let Some(index) = self.edges.iter().position(|edge| bad(&edge.vertices)) {
            return Err(WriteError::BadReference { item: "edge", index });
        }
        Ok(())
    }

    /// What `form` drops of this mesh, in words for a warning; empty when it keeps everything.
    #[must_use]
    pub fn dropped_by(&self, form: MeshForm) -> Vec<&'static str> {
        let mut dropped = Vec::new();
        if !self.edges.is_empty() && !form.carries_edges() {
            dropped.push("marked edges");
        }
        if self.has_regions() && !form.carries_regions() {
            dropped.push("regions");
        }
        dropped
    }
}
