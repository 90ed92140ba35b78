//! Bounds of faces: loops of edges.

use super::{Read, Reader};
use crate::model::TrimCurve;

/// An edge as a part of a loop.
#[derive(Clone, Copy)]
pub(super) struct Use {
    pub(super) id: u64,
    pub(super) reversed: bool,
}

/// A loop of edges.
pub(super) struct Ring {
    pub(super) edges: Vec<Use>,
    /// Whether it is said to be the outer one.
    pub(super) is_outer: bool,
    /// Whether the surface is at the left hand of the loop, seen from where its normal points.
    pub(super) is_left: bool,
}

impl Reader<'_> {
    /// The loop of a bound; `None` for a vertex alone, which bounds nothing.
    pub(super) fn bound(&mut self, id: u64, is_forward: bool) -> Read<Option<Ring>> {
        let bound = self.records.entity(id)?;
        if !["FACE_BOUND", "FACE_OUTER_BOUND"].contains(&bound.kind()) {
            return Err(bound.fail("a FACE_BOUND or FACE_OUTER_BOUND should be here"));
        }
        let fields = bound.fields(None)?;
        let path = self.records.entity(fields.reference(1, "the loop")?)?;
        let is_left = fields.flag(2, "the orientation")? == is_forward;
        match path.kind() {
            "VERTEX_LOOP" => return Ok(None),
            "EDGE_LOOP" => {}
            _ => {
                return Err(
                    path.fail("a loop of this kind is not read: EDGE_LOOP and VERTEX_LOOP are")
                );
            }
        }
        let mut edges = Vec::new();
        for id in path.fields(None)?.references(1, "the edges")? {
            let oriented = self.records.entity(id)?;
            if oriented.kind() != "ORIENTED_EDGE" {
                return Err(oriented.fail("an ORIENTED_EDGE should be here"));
            }
            let fields = oriented.fields(None)?;
            let edge = fields.reference(3, "the edge")?;
            self.edge(edge)?;
            edges.push(Use { id: edge, reversed: !fields.flag(4, "the orientation")? });
        }
        if edges.is_empty() {
            return Err(path.fail("the loop has no edge"));
        }
        Ok(Some(Ring { edges, is_outer: bound.kind() == "FACE_OUTER_BOUND", is_left }))
    }

    /// The curves of a loop, without their places in (u, v).
    pub(super) fn plain(&self, ring: &Ring) -> Vec<TrimCurve> {
        let curve = |edge: &Use| TrimCurve::Space { curve: self.oriented(*edge), parameters: None };
        ring.edges.iter().map(curve).collect()
    }

    /// The curve of an edge in the direction of its loop.
    pub(super) fn oriented(&self, edge: Use) -> crate::curve::Curve {
        let curve = &self.edges[&edge.id];
        if edge.reversed { curve.reversed() } else { curve.clone() }
    }
}
