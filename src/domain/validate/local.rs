//! Faults that show in one loop, segment or point alone; and the graph of what is left.

use super::fault::{Fault, LoopRef, Name, Owner, SeedKind, SeedRef};
use super::graph::{Edge, NONE, Ranks};
use crate::domain::{Domain, Inside, Place};
use crate::point::Point2;
use crate::predicates::{Sign, orient2d};

/// A domain under validation.
#[derive(Debug)]
pub(super) struct Draft<'a> {
    pub domain: &'a Domain,
    pub ranks: Ranks,
    /// Edges with length between points that exist: those of each loop in order, then segments.
    pub edges: Vec<Edge>,
    /// Pairs of edges whose overlap only repeats a spike, sorted.
    pub arms: Vec<[u32; 2]>,
    /// Loops whose shape has a fault, so that nothing can be said of what is inside them.
    pub bad_loops: Vec<bool>,
    /// The same for free segments.
    pub bad_segments: Vec<bool>,
    pub faults: Vec<Fault>,
}

impl<'a> Draft<'a> {
    /// Runs all checks that need no other item.
    pub fn new(domain: &'a Domain) -> Self {
        let mut draft = Self {
            domain,
            ranks: Ranks::new(domain),
            edges: Vec::new(),
            arms: Vec::new(),
            bad_loops: vec![false; domain.loops.len()],
            bad_segments: vec![false; domain.segments.len()],
            faults: Vec::new(),
        };
        draft.check_points();
        draft.check_seeds();
        for index in 0..domain.loops.len() {
            draft.check_loop(index);
        }
        for index in 0..domain.segments.len() {
            draft.check_segment(index);
        }
        draft.arms.sort_unstable();
        draft
    }

    fn check_points(&mut self) {
        let points = &self.domain.points;
        for (index, _) in points.iter().enumerate().filter(|(_, p)| !p.is_finite()) {
            self.faults.push(Fault::NotFinite { vertex: self.domain.vertex_ref(index as u32) });
        }
        let found = self.domain.point_markers.len();
        if found != 0 && found != points.len() {
            self.faults.push(Fault::MarkerCount { of: None, found, expected: points.len() });
        }
        let mut in_loop = vec![false; points.len()];
        for &vertex in self.domain.loops.iter().flat_map(|l| &l.vertices) {
            if let Some(slot) = in_loop.get_mut(vertex as usize) {
                *slot = true;
            }
        }
        for &pair in &self.ranks.equal {
            if pair.iter().any(|&v| !in_loop[v as usize]) {
                let vertices = pair.map(|v| self.domain.vertex_ref(v));
                self.faults.push(Fault::DuplicatePoint { vertices });
            }
        }
    }

    fn check_seeds(&mut self) {
        for seed in seeds(self.domain).filter(|seed| !seed.at.is_finite()) {
            self.faults.push(Fault::SeedNotFinite { seed });
        }
    }

    /// Whether all points exist and are finite; names those that do not exist.
    fn points_exist(&mut self, owner: impl Fn(usize) -> Owner, vertices: &[u32]) -> bool {
        let count = self.domain.points.len();
        for (i, &value) in vertices.iter().enumerate().filter(|(_, v)| **v as usize >= count) {
            let owner = owner(i);
            let place = self.domain.owner_place(owner);
            self.faults.push(Fault::NoSuchPoint { owner, value, count, place });
        }
        vertices.iter().all(|&v| self.ranks.rank_of.get(v as usize).is_some_and(|&r| r != NONE))
    }

    fn check_loop(&mut self, index: usize) {
        let of = &self.domain.loops[index];
        if of.markers.len() != of.vertices.len() {
            let (found, expected) = (of.markers.len(), of.vertices.len());
            let of = Some(self.domain.loop_ref(index));
            self.faults.push(Fault::MarkerCount { of, found, expected });
        }
        self.bad_loops[index] = !self
            .points_exist(|edge| Owner::Loop { index, edge }, &of.vertices)
            || self.check_shape(index);
    }

    /// Checks a loop all of whose points exist; returns whether its shape has a fault.
    fn check_shape(&mut self, index: usize) -> bool {
        let vertices = &self.domain.loops[index].vertices;
        let rank = |v: &u32| self.ranks.rank_of[*v as usize];
        let edges: Vec<Edge> = self.domain.loops[index]
            .edges()
            .enumerate()
            .map(|(edge, ends)| Edge {
                ends: ends.map(|v| rank(&v)),
                owner: Owner::Loop { index, edge },
            })
            .collect();
        let (long, short): (Vec<Edge>, Vec<Edge>) =
            edges.iter().partition(|e| e.ends[0] != e.ends[1]);
        if long.len() < 3 {
            let of = self.domain.loop_ref(index);
            self.faults
                .push(Fault::TooFewPoints { of, distinct: long.len().max(vertices.len().min(1)) });
            return true;
        }
        for edge in short {
            self.faults.push(Fault::EqualNeighbours { edge: self.domain.edge_ref(edge.owner) });
        }
        if self.is_collinear(&long) {
            let of = self.domain.loop_ref(index);
            self.faults.push(Fault::ZeroArea { of, vertices: vertices.len() });
            return true;
        }
        let spiked = self.check_spikes(self.domain.loop_ref(index), &long);
        self.edges.extend(long);
        spiked
    }

    fn point(&self, rank: u32) -> Point2 {
        self.ranks.points[rank as usize]
    }

    fn is_collinear(&self, ring: &[Edge]) -> bool {
        let [a, b] = ring[0].ends.map(|rank| self.point(rank));
        ring.iter().all(|e| orient2d(a, b, self.point(e.ends[1])) == Sign::Zero)
    }

    /// Names the vertices at which a loop turns back on itself, and notes the pairs of edges that
    /// overlap because of that: the two at the tip, and those further back on the same two paths.
    fn check_spikes(&mut self, of: LoopRef, ring: &[Edge]) -> bool {
        let (count, first) = (ring.len(), self.edges.len());
        let mut found = false;
        for tip in 0..count {
            let (arriving, leaving) = (ring[(tip + count - 1) % count], ring[tip]);
            let [a, v, b] = [arriving.ends[0], leaving.ends[0], leaving.ends[1]];
            let back = (a < v) == (b < v)
                && orient2d(self.point(a), self.point(v), self.point(b)) == Sign::Zero;
            if !back {
                continue;
            }
            found = true;
            let tip_ref = self.domain.edge_ref(leaving.owner).ends[0].clone();
            self.faults.push(Fault::Spike { of: of.clone(), tip: tip_ref });
            for step in 1..=count / 2 {
                let (i, j) = ((tip + count - step) % count, (tip + step - 1) % count);
                self.arms.push([(first + i.min(j)) as u32, (first + i.max(j)) as u32]);
                if ring[i].ends[0] != ring[j].ends[1] {
                    break;
                }
            }
        }
        found
    }

    fn check_segment(&mut self, index: usize) {
        let owner = Owner::Segment(index);
        let vertices = self.domain.segments[index].vertices;
        if !self.points_exist(|_| owner, &vertices) {
            self.bad_segments[index] = true;
            return;
        }
        let ends = vertices.map(|v| self.ranks.rank_of[v as usize]);
        if ends[0] == ends[1] {
            self.faults.push(Fault::EqualNeighbours { edge: self.domain.edge_ref(owner) });
        } else {
            self.edges.push(Edge { ends, owner });
        }
    }

    /// Whether the shape of everything that bounds faces is known.
    pub fn is_sound(&self) -> bool {
        !self.bad_loops.contains(&true) && !self.bad_segments.contains(&true)
    }

    /// Whether an edge belongs to nothing whose shape has a fault.
    pub fn is_edge_sound(&self, edge: &Edge) -> bool {
        match edge.owner {
            Owner::Loop { index, .. } => !self.bad_loops[index],
            Owner::Segment(index) => !self.bad_segments[index],
        }
    }

    /// Notes that the shape of what an edge belongs to has a fault.
    pub fn mark_bad(&mut self, owner: Owner) {
        match owner {
            Owner::Loop { index, .. } => self.bad_loops[index] = true,
            Owner::Segment(index) => self.bad_segments[index] = true,
        }
    }
}

/// Hole points, then region seeds.
pub(super) fn seeds(domain: &Domain) -> impl Iterator<Item = SeedRef> + '_ {
    let holes = match &domain.inside {
        Inside::EvenOdd => &[][..],
        Inside::Carve(points) => points,
    };
    let name = |kind, places: &[Place], (index, at)| SeedRef {
        kind,
        index,
        at,
        place: places.get(index).cloned().unwrap_or(Place::Made),
    };
    let regions = domain.regions.iter().map(|region| region.seed).enumerate();
    let holes = holes.iter().copied().enumerate();
    let holes = holes.map(move |seed| name(SeedKind::Hole, &domain.places.holes, seed));
    holes.chain(regions.map(move |seed| name(SeedKind::Region, &domain.places.regions, seed)))
}
