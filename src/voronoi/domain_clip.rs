//! Cells clipped to a domain, which need not be convex and may have holes.
//!
//! The edges, cut to a box around the domain, and the domain's segments are laid over each other:
//! where they cross they are cut at rounded crossings, again and again until none cross
//! ([`split_crossings`]), and what comes out is triangulated with all pieces as constraints. So the
//! result is a subdivision in the strict sense whatever the rounding did: pieces meet in common
//! edges and corners only, exactly. What is inside follows the domain's rule on its own pieces; a
//! connected set of inside triangles that no edge of the tessellation divides is a piece of a cell.
//!
//! What is rounded are places: Voronoi vertices and crossings lie within a float or so of where they
//! should be, and the domain's sloped segments go through the crossings on them.

use super::Voronoi;
use super::box_clip::ClipBox;
use super::clipped::{Clipped, Corners, Piece, proper};
use crate::delaunay::{Cdt, CdtError, Split, cdt, split_crossings};
use crate::domain::validate::{Plc, PlcInside};
use crate::point::Point2;
use crate::predicates::{Sign, nearer};
use crate::triangulation::locate::Location;
use crate::triangulation::{HalfEdgeId, TriangleId, Triangulation};

/// Why a tessellation could not be clipped to a domain.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DomainClipError {
    /// Cutting what crosses did not come to an end, or there are too many points.
    #[error("the cells cannot be cut along the domain: {0}")]
    Cut(#[from] CdtError),
    /// There is no site, so the domain is in no cell.
    #[error("there are no sites whose cells could cover the domain")]
    NoSites,
}

impl Voronoi {
    /// The cells within a validated domain; a cell may fall in several pieces, and a piece may have
    /// holes.
    ///
    /// # Guarantees
    /// V7: the pieces cover the domain (its segments led through their rounded crossings with the
    /// edges) without gap or overlap.
    ///
    /// # Errors
    /// See [`DomainClipError`].
    ///
    /// # Complexity
    /// That of [`split_crossings`] for the edges near the domain and its segments.
    pub fn clip_to_domain(&self, domain: &Plc) -> Result<Clipped, DomainClipError> {
        let Some(start) = (0..self.sites.len() as u32).find(|&site| self.has_cell(site)) else {
            return Err(DomainClipError::NoSites);
        };
        // A little larger than the domain, so that edges end outside it.
        let Some(bounds) = ClipBox::around(&domain.points) else { return Ok(Clipped::default()) };
        let overlay = Overlay::new(self, domain, bounds)?;
        let mut faces = Faces::new(self, domain, &overlay)?;
        faces.flood(domain);
        Ok(faces.pieces(start))
    }
}

/// The domain's segments and the tessellation's edges, cut until none cross.
struct Overlay {
    split: Split,
    /// How many of the segments given to the split are the domain's.
    domain_segments: u32,
    /// For the others, the edge of the tessellation, and whether it runs from its first end to its
    /// second in lexicographic order, which its pieces then do.
    edges: Vec<(u32, bool)>,
}

impl Overlay {
    fn new(voronoi: &Voronoi, domain: &Plc, bounds: ClipBox) -> Result<Self, CdtError> {
        let mut corners = Corners::default();
        let given: Vec<u32> = domain.points.iter().map(|&p| corners.at(p)).collect();
        let mut segments: Vec<[u32; 2]> =
            domain.segments.iter().map(|s| s.vertices.map(|v| given[v as usize])).collect();
        let domain_segments = segments.len() as u32;
        let mut edges = Vec::new();
        for (edge, ends) in voronoi.edges_in(bounds) {
            let [a, b] = ends.map(|p| corners.at(p));
            // An edge shorter than the distance of floats is a point.
            if a != b {
                segments.push([a, b]);
                edges.push((edge, ends[0].lexicographic(ends[1]).is_lt()));
            }
        }
        let split = split_crossings(&corners.points, &segments)?;
        Ok(Self { split, domain_segments, edges })
    }
}

/// What a piece of the overlay is part of.
#[derive(Clone, Copy, Default)]
struct Wall {
    /// A segment of the domain.
    is_domain: bool,
    /// An odd number of loop segments.
    switches: bool,
    /// An edge of the tessellation.
    divides: bool,
}

struct Faces<'a> {
    voronoi: &'a Voronoi,
    overlay: &'a Overlay,
    triangulation: Triangulation,
    /// Wall of each half-edge, by triangle slot and corner.
    walls: Vec<[Wall; 3]>,
    /// Sites that edges of the tessellation name on the left of a half-edge.
    labels: Vec<(HalfEdgeId, u32)>,
    inside: Vec<bool>,
}

impl<'a> Faces<'a> {
    fn new(voronoi: &'a Voronoi, domain: &Plc, overlay: &'a Overlay) -> Result<Self, CdtError> {
        let Cdt { triangulation, segments, .. } =
            cdt(&overlay.split.points, &overlay.split.segments)?;
        let slots = triangulation.slot_count();
        let mut faces = Self {
            voronoi,
            overlay,
            triangulation,
            walls: vec![[Wall::default(); 3]; slots],
            labels: Vec::new(),
            inside: vec![false; slots],
        };
        for &[piece, parent] in &overlay.split.covered {
            let e = segments[piece as usize];
            let f = faces.triangulation.twin(e).expect("ghosts surround the hull");
            match parent.checked_sub(overlay.domain_segments) {
                Some(i) => faces.add_edge([e, f], overlay.edges[i as usize]),
                None => {
                    let in_loop = domain.segments[parent as usize].in_loop;
                    for wall in [e, f] {
                        let wall = faces.wall(wall);
                        wall.is_domain = true;
                        wall.switches ^= in_loop;
                    }
                }
            }
        }
        faces.labels.sort_unstable();
        Ok(faces)
    }

    fn wall(&mut self, e: HalfEdgeId) -> &mut Wall {
        &mut self.walls[e.triangle().index()][e.corner()]
    }

    fn at(&self, e: HalfEdgeId) -> Point2 {
        self.overlay.split.points[self.triangulation.origin(e).index()]
    }

    /// Notes that an edge of the tessellation runs along the two halves of an edge.
    fn add_edge(&mut self, [e, f]: [HalfEdgeId; 2], (edge, is_rising): (u32, bool)) {
        let [left, right] = self.voronoi.edges[edge as usize].sites;
        let runs_up = self.at(e).lexicographic(self.at(f)).is_lt();
        let sites = if is_rising == runs_up { [left, right] } else { [right, left] };
        for (half, site) in [e, f].into_iter().zip(sites) {
            self.wall(half).divides = true;
            self.labels.push((half, site));
        }
    }

    /// Marks the triangles that are inside the domain.
    fn flood(&mut self, domain: &Plc) {
        let ghosts = self.triangulation.triangles().find(|&t| self.triangulation.is_ghost(t));
        let Some(ghost) = ghosts else { return };
        match &domain.inside {
            PlcInside::EvenOdd => self.spread(ghost, |wall| Some(wall.switches)),
            PlcInside::Carve(holes) => {
                self.inside.fill(true);
                self.spread(ghost, |wall| (!wall.is_domain).then_some(false));
                for &hole in holes {
                    let place = self.triangulation.locate(&self.overlay.split.points, hole, ghost);
                    let t = match place {
                        Location::Inside(t) => t,
                        Location::OnEdge(e) | Location::OnVertex(e) | Location::Outside(e) => {
                            e.triangle()
                        }
                    };
                    self.spread(t, |wall| (!wall.is_domain).then_some(false));
                }
            }
        }
    }

    /// From a triangle that is not inside to all it reaches; `step` says whether an edge can be passed
    /// and whether passing it switches sides.
    fn spread(&mut self, from: TriangleId, step: impl Fn(Wall) -> Option<bool>) {
        let mut seen = vec![false; self.inside.len()];
        (seen[from.index()], self.inside[from.index()]) = (true, false);
        let mut todo = vec![from];
        while let Some(t) = todo.pop() {
            for e in t.half_edges() {
                let wall = self.walls[t.index()][e.corner()];
                let Some((switches, f)) = step(wall).zip(self.triangulation.twin(e)) else {
                    continue;
                };
                let u = f.triangle();
                if !std::mem::replace(&mut seen[u.index()], true) {
                    self.inside[u.index()] = self.inside[t.index()] ^ switches;
                    todo.push(u);
                }
            }
        }
    }

    fn pieces(&self, start: u32) -> Clipped {
        let mut component = vec![0_u32; self.inside.len()];
        let mut result = Vec::new();
        let mut corners = Corners::default();
        let mut number = 0;
        let is_inside = |t: &TriangleId| self.inside[t.index()] && !self.triangulation.is_ghost(*t);
        for t in self.triangulation.triangles().filter(is_inside) {
            if component[t.index()] == 0 {
                number += 1;
                let triangles = self.collect(t, number, &mut component);
                let site = self.site_of(&triangles, start);
                let rings = self.rings(&triangles, &component, &mut corners);
                result.push(Piece { site, rings });
            }
        }
        // By site, then by the corner that comes first: not by slots.
        let points = &corners.points;
        let least = |piece: &Piece| {
            let all = piece.rings.iter().flatten().map(|&i| points[i as usize]);
            all.min_by(|p, q| p.lexicographic(*q)).unwrap_or(Point2::new(0.0, 0.0))
        };
        result.retain(|piece| !piece.rings.is_empty());
        result.sort_by(|p, q| p.site.cmp(&q.site).then(least(p).lexicographic(least(q))));
        Clipped { points: corners.points, pieces: result }
    }

    /// All inside triangles reached without crossing an edge of the tessellation or the boundary.
    fn collect(&self, from: TriangleId, number: u32, component: &mut [u32]) -> Vec<TriangleId> {
        component[from.index()] = number;
        let mut found = vec![from];
        let mut next = 0;
        while let Some(&t) = found.get(next) {
            next += 1;
            for e in t.half_edges().into_iter().filter(|&e| !self.is_divided(e)) {
                let u = self.triangulation.twin(e).expect("ghosts surround the hull").triangle();
                if self.inside[u.index()] && component[u.index()] == 0 {
                    component[u.index()] = number;
                    found.push(u);
                }
            }
        }
        found
    }

    fn is_divided(&self, e: HalfEdgeId) -> bool {
        self.walls[e.triangle().index()][e.corner()].divides
    }

    /// The site of a piece: of those that the edges around it name, the nearest to the middle of its
    /// largest triangle; if they name none, of all. Where nothing was rounded they name but one.
    fn site_of(&self, triangles: &[TriangleId], start: u32) -> u32 {
        let middle = self.middle(triangles);
        let at = |site: u32| self.voronoi.sites[site as usize];
        let is_nearer = |a: u32, b: u32| nearer(middle, at(a), at(b)) == Sign::Positive;
        let halves = triangles.iter().flat_map(|t| t.half_edges());
        let named = halves.filter(|&e| self.is_divided(e)).flat_map(|e| {
            let first = self.labels.partition_point(|label| label.0 < e);
            self.labels[first..].iter().take_while(move |label| label.0 == e).map(|label| label.1)
        });
        let mut named: Vec<u32> = named.collect();
        named.sort_unstable();
        let best = named.into_iter().reduce(|a, b| if is_nearer(b, a) { b } else { a });
        best.unwrap_or_else(|| {
            let mut site = start;
            // A site that is not the nearest has a neighbour that is nearer.
            while let Some(side) = self.voronoi.cell(site).find(|s| is_nearer(s.neighbour, site)) {
                site = side.neighbour;
            }
            site
        })
    }

    /// The middle of the largest triangle, in floats.
    fn middle(&self, triangles: &[TriangleId]) -> Point2 {
        let corners = |t: TriangleId| t.half_edges().map(|e| self.at(e));
        let size = |t: TriangleId| {
            let [a, b, c] = corners(t);
            ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)).abs()
        };
        let largest = triangles.iter().copied().max_by(|&t, &u| size(t).total_cmp(&size(u)));
        let [a, b, c] = corners(largest.expect("a piece has triangles"));
        Point2::new(a.x / 3.0 + b.x / 3.0 + c.x / 3.0, a.y / 3.0 + b.y / 3.0 + c.y / 3.0)
    }

    /// The rims of a piece: each with the piece on its left, the outer one first.
    fn rings(
        &self,
        triangles: &[TriangleId],
        component: &[u32],
        corners: &mut Corners,
    ) -> Vec<Vec<u32>> {
        let number = component[triangles[0].index()];
        let is_rim = |e: HalfEdgeId| {
            let f = self.triangulation.twin(e).expect("ghosts surround the hull");
            component[f.triangle().index()] != number || self.is_divided(e)
        };
        let rim = triangles.iter().flat_map(|t| t.half_edges()).filter(|&e| is_rim(e));
        let mut todo: std::collections::BTreeSet<HalfEdgeId> = rim.collect();
        // From the lexicographically first corner, which is on the outer ring.
        let first = todo.iter().copied().min_by(|&e, &f| self.at(e).lexicographic(self.at(f)));
        let mut next_start = first;
        let mut rings = Vec::new();
        while let Some(start) = next_start {
            let mut ring = Vec::new();
            let mut e = start;
            while todo.remove(&e) {
                ring.push(corners.at(self.at(e)));
                e = e.next();
                while !is_rim(e) {
                    e = self.triangulation.twin(e).expect("not on the rim").next();
                }
            }
            rings.extend(proper(ring));
            next_start = todo.first().copied();
        }
        rings
    }
}
