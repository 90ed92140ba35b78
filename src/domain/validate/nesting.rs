//! Which loop lies directly inside which, and what is inside the domain.

use super::faces::{Faces, UNBOUNDED};
use super::fault::{Fault, Name, Owner};
use super::graph::Edge;
use super::sweep::Sweep;
use crate::domain::{Domain, LoopRole};
use std::collections::VecDeque;

/// The loops as a forest, and the loops around each face.
///
/// Loops that do not cross have interiors that are disjoint or nested, so each face has an
/// innermost loop, and crossing an edge of a loop leads into it or, if it is the innermost, out of it.
#[derive(Debug)]
pub(super) struct Nesting {
    /// The innermost loop around each loop.
    pub parent: Vec<Option<usize>>,
    /// How many loops there are around each face.
    pub depth: Vec<u32>,
}

impl Nesting {
    /// Walks over all faces from the unbounded one; linear time.
    pub fn new(loops: usize, edges: &[Edge], sweep: &Sweep, faces: &Faces) -> Self {
        let borders = Borders::new(faces);
        let mut nesting = Self { parent: vec![None; loops], depth: vec![u32::MAX; faces.count] };
        let mut innermost = vec![None; faces.count];
        nesting.depth[UNBOUNDED as usize] = 0;
        let mut queue = VecDeque::from([UNBOUNDED]);
        while let Some(face) = queue.pop_front() {
            let (around, depth) = (innermost[face as usize], nesting.depth[face as usize]);
            for &h in borders.of(face) {
                let beyond = faces.of_half_edge[h as usize ^ 1] as usize;
                if nesting.depth[beyond] != u32::MAX {
                    continue;
                }
                let edge = sweep.pieces[h as usize / 2].edge;
                (innermost[beyond], nesting.depth[beyond]) = match edges[edge as usize].owner {
                    Owner::Segment(_) => (around, depth),
                    Owner::Loop { index, .. } if around == Some(index) => {
                        (nesting.parent[index], depth - 1)
                    }
                    Owner::Loop { index, .. } => {
                        nesting.parent[index] = around;
                        (Some(index), depth + 1)
                    }
                };
                queue.push_back(beyond as u32);
            }
        }
        nesting
    }

    /// Whether `outer` lies around `inner`.
    fn is_around(&self, outer: usize, inner: usize) -> bool {
        let mut around = self.parent[inner];
        while around.is_some_and(|index| index != outer) {
            around = around.and_then(|index| self.parent[index]);
        }
        around.is_some()
    }

    fn loop_depth(&self, index: usize) -> usize {
        std::iter::successors(self.parent[index], |&around| self.parent[around]).count()
    }
}

/// Half-edges by the face on their left.
struct Borders {
    first: Vec<u32>,
    half_edges: Vec<u32>,
}

impl Borders {
    fn new(faces: &Faces) -> Self {
        let mut first = vec![0_u32; faces.count + 1];
        for &face in &faces.of_half_edge {
            first[face as usize + 1] += 1;
        }
        for face in 0..faces.count {
            first[face + 1] += first[face];
        }
        let mut half_edges: Vec<u32> = (0..faces.of_half_edge.len() as u32).collect();
        half_edges.sort_by_key(|&h| faces.of_half_edge[h as usize]);
        Self { first, half_edges }
    }

    fn of(&self, face: u32) -> &[u32] {
        let face = face as usize;
        &self.half_edges[self.first[face] as usize..self.first[face + 1] as usize]
    }
}

/// Names the loops that lie elsewhere than they claim. Each claim is compared with the loop
/// directly around alone, so that one loop in the wrong place is one fault. Loops in `bad` have
/// another fault and are not judged.
pub(super) fn check_claims(domain: &Domain, nesting: &Nesting, bad: &[bool]) -> Vec<Fault> {
    let sound = (0..domain.loops.len()).filter(|&index| !bad[index]);
    sound.filter_map(|index| check_claim(domain, nesting, bad, index)).collect()
}

fn check_claim(domain: &Domain, nesting: &Nesting, bad: &[bool], index: usize) -> Option<Fault> {
    let around = nesting.parent[index];
    match domain.loops[index].role {
        LoopRole::Any => None,
        LoopRole::Outer => {
            let around = around?;
            let is_hole = match domain.loops[around].role {
                LoopRole::HoleOf(_) => true,
                LoopRole::Outer => false,
                // Even depth is outer, but a loop that is left out would turn even to odd.
                LoopRole::Any => bad.contains(&true) || nesting.loop_depth(around) % 2 == 1,
            };
            (!is_hole).then(|| Fault::OuterInsideOuter {
                inner: domain.loop_ref(index),
                around: domain.loop_ref(around),
            })
        }
        LoopRole::HoleOf(outer) => {
            if around == Some(outer)
                || bad.get(outer) != Some(&false)
                || !may_have_holes(domain, index, outer)
            {
                return None;
            }
            let (hole, outer_ref) = (domain.loop_ref(index), domain.loop_ref(outer));
            Some(match around {
                Some(around) if nesting.is_around(outer, index) => Fault::HoleInsideOther {
                    hole,
                    outer: outer_ref,
                    around: domain.loop_ref(around),
                },
                _ => Fault::HoleOutside { hole, outer: outer_ref },
            })
        }
    }
}

/// Names the loops that claim to be holes of something that has no holes.
pub(super) fn check_roles(domain: &Domain) -> Vec<Fault> {
    let roles = domain.loops.iter().enumerate().map(|(index, l)| (index, l.role));
    roles
        .filter_map(|(index, role)| match role {
            LoopRole::HoleOf(claimed) if !may_have_holes(domain, index, claimed) => {
                Some(Fault::NotAnOuterLoop { hole: domain.loop_ref(index), claimed })
            }
            _ => None,
        })
        .collect()
}

fn may_have_holes(domain: &Domain, hole: usize, outer: usize) -> bool {
    let role = domain.loops.get(outer).map(|l| l.role);
    outer != hole && matches!(role, Some(LoopRole::Outer | LoopRole::Any))
}
