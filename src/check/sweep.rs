//! A plane sweep over segments that should meet at common ends only: it finds out whether they do,
//! and if so, which faces lie on their two sides and how often directed segments wind around each.
//!
//! After Shamos and Hoey (1976): the first two segments that meet improperly become neighbours on
//! the sweep line before it reaches the point where they meet. Events are points in lexicographic
//! order, which is the order of a sweep line tilted by an infinitesimal angle, so vertical segments
//! need no special case. All signs are exact. O(n log n).

use super::exact::{P2, lexicographic, orient2d};
use super::status::{NONE, Status};
use std::cmp::Ordering;

/// A directed segment between points given by index.
#[derive(Clone, Copy, Debug)]
pub(super) struct Directed {
    pub(super) from: u32,
    pub(super) to: u32,
    /// How much the winding number on its left exceeds that on its right.
    pub(super) weight: i32,
}

/// Two segments that meet elsewhere than at a common end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Conflict(pub(super) [u32; 2]);

/// One side of a segment, or the surroundings of a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Side {
    /// The face; 0 is the unbounded one.
    pub(super) face: u32,
    /// How often the segments wind around it.
    pub(super) winding: i32,
}

/// What lies beside the segments.
pub(super) struct Faces {
    /// The left side of each segment as directed.
    pub(super) left: Vec<Side>,
    /// The right side.
    pub(super) right: Vec<Side>,
    /// Where each query point lies; `None` on a segment.
    pub(super) queries: Vec<Option<Side>>,
}

/// Sweeps over `segments` between different `points`; locates the `queries`, points that are no
/// ends of segments.
///
/// # Errors
/// The first improper meeting found. Equal points must have one index, and no segment two equal ends.
pub(super) fn sweep(
    points: &[P2],
    segments: &[Directed],
    queries: &[u32],
) -> Result<Faces, Conflict> {
    let mut sweep = Sweep::new(points, segments);
    let events = sweep.events(queries);
    let mut located = vec![None; queries.len()];
    for event in events.chunk_by(|a, b| a.point == b.point) {
        match event[0].kind {
            Kind::Query(query) => located[query as usize] = sweep.surroundings(event[0].point),
            _ => sweep.pass(event)?,
        }
    }
    Ok(sweep.finish(located))
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    End(u32),
    Start(u32),
    Query(u32),
}

#[derive(Clone, Copy)]
struct Event {
    point: u32,
    kind: Kind,
}

struct Sweep<'a> {
    points: &'a [P2],
    segments: &'a [Directed],
    /// Ends of each segment, the lexicographically lower first.
    ends: Vec<[u32; 2]>,
    status: Status,
    below: Vec<Side>,
    above: Vec<Side>,
    /// Faces that turned out to be one: a union-find forest.
    parents: Vec<u32>,
}

impl<'a> Sweep<'a> {
    fn new(points: &'a [P2], segments: &'a [Directed]) -> Self {
        let sorted =
            |s: &Directed| match lexicographic(points[s.from as usize], points[s.to as usize]) {
                Ordering::Greater => [s.to, s.from],
                _ => [s.from, s.to],
            };
        let sides = vec![Side::default(); segments.len()];
        Self {
            points,
            segments,
            ends: segments.iter().map(sorted).collect(),
            status: Status::new(segments.len()),
            below: sides.clone(),
            above: sides,
            parents: vec![0],
        }
    }

    fn point(&self, index: u32) -> P2 {
        self.points[index as usize]
    }

    fn events(&self, queries: &[u32]) -> Vec<Event> {
        let mut events = Vec::with_capacity(2 * self.ends.len() + queries.len());
        for (s, &[low, high]) in (0u32..).zip(&self.ends) {
            events.push(Event { point: low, kind: Kind::Start(s) });
            events.push(Event { point: high, kind: Kind::End(s) });
        }
        for (q, &point) in (0u32..).zip(queries) {
            events.push(Event { point, kind: Kind::Query(q) });
        }
        events.sort_unstable_by(|a, b| {
            lexicographic(self.point(a.point), self.point(b.point))
                .then(a.point.cmp(&b.point))
                .then(a.kind.cmp(&b.kind))
        });
        events
    }

    /// Whether `p` lies above (`Greater`), on or below a segment of the status.
    fn side(&self, segment: u32, p: P2) -> Ordering {
        let [low, high] = self.ends[segment as usize];
        orient2d(self.point(low), self.point(high), p)
    }

    fn surroundings(&self, point: u32) -> Option<Side> {
        let p = self.point(point);
        let below = self.status.locate(|s| self.side(s, p)).ok()?;
        Some(self.side_above(below))
    }

    fn side_above(&self, segment: u32) -> Side {
        if segment == NONE { Side::default() } else { self.above[segment as usize] }
    }

    /// Passes a point where segments end or start.
    fn pass(&mut self, event: &[Event]) -> Result<(), Conflict> {
        let point = event[0].point;
        let (mut ended, mut started) = (Vec::new(), Vec::new());
        for e in event {
            match e.kind {
                Kind::End(s) => ended.push(s),
                Kind::Start(s) => started.push(s),
                Kind::Query(_) => {}
            }
        }
        let (below, low, high) = match ended.first() {
            Some(&first) => self.pass_ended(point, first, ended.as_slice())?,
            None => self.pass_start(point, started[0])?,
        };
        let above = self.status.above(below);
        if started.is_empty() {
            self.join(low.face, high.face);
            return self.demand_apart(below, above);
        }
        self.sort_by_slope(point, &mut started)?;
        self.start(&started, below, [low, high]);
        self.demand_apart(below, started[0])?;
        self.demand_apart(started[started.len() - 1], above)
    }

    /// The segment below a point where nothing ends, and what lies around it.
    fn pass_start(&self, point: u32, starting: u32) -> Result<(u32, Side, Side), Conflict> {
        let p = self.point(point);
        let below =
            self.status.locate(|s| self.side(s, p)).map_err(|on| Conflict([on, starting]))?;
        let side = self.side_above(below);
        Ok((below, side, side))
    }

    /// Takes the segments that end here out of the status; gives the segment below and what lies
    /// below and above the point to its left.
    fn pass_ended(
        &mut self,
        point: u32,
        first: u32,
        ended: &[u32],
    ) -> Result<(u32, Side, Side), Conflict> {
        let p = self.point(point);
        let ends_here = |s: u32| s != NONE && self.ends[s as usize][1] == point;
        let (mut lowest, mut highest, mut count) = (first, first, 1);
        while ends_here(self.status.below(lowest)) {
            lowest = self.status.below(lowest);
            count += 1;
        }
        while ends_here(self.status.above(highest)) {
            highest = self.status.above(highest);
            count += 1;
        }
        let (below, above) = (self.status.below(lowest), self.status.above(highest));
        if below != NONE && self.side(below, p) != Ordering::Greater {
            return Err(Conflict([below, lowest]));
        }
        if above != NONE && self.side(above, p) != Ordering::Less {
            return Err(Conflict([above, highest]));
        }
        if count != ended.len() {
            return Err(Conflict([lowest, highest]));
        }
        let sides = (self.below[lowest as usize], self.above[highest as usize]);
        ended.iter().for_each(|&s| self.status.remove(s));
        Ok((below, sides.0, sides.1))
    }

    /// Sorts segments that start at a point from low to high.
    fn sort_by_slope(&self, point: u32, started: &mut [u32]) -> Result<(), Conflict> {
        let p = self.point(point);
        let end = |s: u32| self.point(self.ends[s as usize][1]);
        started.sort_unstable_by(|&s, &t| orient2d(p, end(t), end(s)).then(s.cmp(&t)));
        let overlap = started.windows(2).find(|w| orient2d(p, end(w[0]), end(w[1])).is_eq());
        overlap.map_or(Ok(()), |w| Err(Conflict([w[0], w[1]])))
    }

    /// Puts sorted segments into the status, with new faces between them.
    fn start(&mut self, started: &[u32], mut below: u32, [low, high]: [Side; 2]) {
        let mut side = low;
        for (i, &s) in started.iter().enumerate() {
            let Directed { from, weight, .. } = self.segments[s as usize];
            let rightward = from == self.ends[s as usize][0];
            let winding = side.winding + if rightward { weight } else { -weight };
            let face = if i + 1 == started.len() { high.face } else { self.new_face() };
            self.below[s as usize] = side;
            side = Side { face, winding };
            self.above[s as usize] = side;
            self.status.insert(s, below);
            below = s;
        }
    }

    fn new_face(&mut self) -> u32 {
        let face = self.parents.len() as u32;
        self.parents.push(face);
        face
    }

    /// Paths are halved on the way.
    fn root(&mut self, mut face: u32) -> u32 {
        while self.parents[face as usize] != face {
            let grandparent = self.parents[self.parents[face as usize] as usize];
            self.parents[face as usize] = grandparent;
            face = grandparent;
        }
        face
    }

    /// The lower number stays, so the unbounded face stays 0.
    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.parents[a.max(b) as usize] = a.min(b);
    }

    /// Neighbours in the status must not meet but at common ends.
    fn demand_apart(&self, s: u32, t: u32) -> Result<(), Conflict> {
        if s == NONE || t == NONE || !self.meet_improperly(s, t) {
            return Ok(());
        }
        Err(Conflict([s, t]))
    }

    fn meet_improperly(&self, s: u32, t: u32) -> bool {
        let (s, t) = (self.ends[s as usize], self.ends[t as usize]);
        segments_conflict(|v| self.point(v), s, t)
    }

    fn finish(mut self, queries: Vec<Option<Side>>) -> Faces {
        // Parents have lower numbers, so one pass in rising order flattens the forest.
        for face in 0..self.parents.len() {
            self.parents[face] = self.parents[self.parents[face] as usize];
        }
        let flat = |side: Side| Side { face: self.parents[side.face as usize], ..side };
        let rightward = |s: usize| self.segments[s].from == self.ends[s][0];
        let pick = |s: usize, left: bool| {
            flat(if rightward(s) == left { self.above[s] } else { self.below[s] })
        };
        let count = self.segments.len();
        Faces {
            left: (0..count).map(|s| pick(s, true)).collect(),
            right: (0..count).map(|s| pick(s, false)).collect(),
            queries: queries.into_iter().map(|side| side.map(flat)).collect(),
        }
    }
}

/// Whether two segments, given by their ends in lexicographic order, meet elsewhere than at a
/// common end. Points with different indices are different.
pub(super) fn segments_conflict(
    at: impl Fn(u32) -> P2,
    [a, b]: [u32; 2],
    [c, d]: [u32; 2],
) -> bool {
    let orient = |p: u32, q: u32, r: u32| orient2d(at(p), at(q), at(r));
    if a == c || b == d {
        // They overlap when they leave the common end in the same direction.
        return orient(a, b, if a == c { d } else { c }).is_eq();
    }
    if a == d || b == c {
        // One ends where the other starts, so they lie on different sides of that point.
        return false;
    }
    let (c_side, d_side) = (orient(a, b, c), orient(a, b, d));
    if c_side.is_eq() && d_side.is_eq() {
        let before = |p: u32, q: u32| lexicographic(at(p), at(q)).is_lt();
        return before(a, d) && before(c, b);
    }
    if c_side == d_side {
        return false;
    }
    orient(c, d, a) != orient(c, d, b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::beside::Beside;

    /// Segments between points of a small lattice; `degree` of them are a closed polygon.
    fn random_segments(seed: u32, points: u32, count: u32, closed: bool) -> Vec<[u32; 2]> {
        let mut state = seed.wrapping_mul(2_654_435_761).wrapping_add(12_345);
        let mut next = |bound: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) % bound
        };
        if closed {
            let mut ring: Vec<u32> = (0..count).map(|_| next(points)).collect();
            ring.dedup();
            let n = ring.len();
            return (0..n).map(|i| [ring[i], ring[(i + 1) % n]]).filter(|[a, b]| a != b).collect();
        }
        (0..count).map(|_| [next(points), next(points)]).filter(|[a, b]| a != b).collect()
    }

    fn brute_conflict(points: &[P2], segments: &[[u32; 2]]) -> bool {
        let at = |v: u32| points[v as usize];
        let sorted =
            |[a, b]: [u32; 2]| if lexicographic(at(a), at(b)).is_gt() { [b, a] } else { [a, b] };
        (0..segments.len()).any(|i| {
            (0..i).any(|j| segments_conflict(at, sorted(segments[i]), sorted(segments[j])))
        })
    }

    // spec: C11
    #[test]
    fn the_sweep_finds_a_conflict_exactly_when_two_segments_conflict() {
        let points: Vec<P2> = (0..36).map(|i| [f64::from(i % 6), f64::from(i / 6)]).collect();
        let mut clean = 0;
        for seed in 0..6000 {
            let segments = random_segments(seed, 36, 2 + seed % 7, false);
            let directed: Vec<Directed> =
                segments.iter().map(|&[from, to]| Directed { from, to, weight: 1 }).collect();
            let found = sweep(&points, &directed, &[]).is_err();
            assert_eq!(found, brute_conflict(&points, &segments), "{segments:?}");
            clean += u32::from(!found);
        }
        assert!(clean > 500, "{clean} sets without conflict");
    }

    // spec: C11
    #[test]
    fn windings_and_faces_are_those_of_rays() {
        let points: Vec<P2> = (0..25).map(|i| [f64::from(i % 5), f64::from(i / 5)]).collect();
        let mut compared = 0;
        for seed in 0..20_000 {
            let segments = random_segments(seed, 25, 3 + seed % 5, true);
            if segments.len() < 3 || brute_conflict(&points, &segments) {
                continue;
            }
            let directed: Vec<Directed> =
                segments.iter().map(|&[from, to]| Directed { from, to, weight: 1 }).collect();
            let faces = sweep(&points, &directed, &[]).expect("no conflict");
            for (i, &[from, to]) in segments.iter().enumerate() {
                for (left, side) in [(true, faces.left[i]), (false, faces.right[i])] {
                    let q = Beside { u: points[from as usize], v: points[to as usize], left };
                    let at = |v: u32| points[v as usize];
                    let winding: i32 = segments.iter().map(|&[s, t]| q.winding(at(s), at(t))).sum();
                    assert_eq!(side.winding, winding, "{segments:?}");
                    assert!(side.face != 0 || winding == 0, "{segments:?}");
                    compared += 1;
                }
            }
        }
        assert!(compared > 1000, "{compared} sides compared");
    }

    #[test]
    fn queries_say_which_face_they_lie_in() {
        let points =
            [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [1.0, 1.0], [9.0, 1.0], [2.0, 0.0]];
        let ring = [[0, 1], [1, 2], [2, 3], [3, 0]];
        let directed = ring.map(|[from, to]| Directed { from, to, weight: 1 });
        let faces = sweep(&points, &directed, &[4, 5, 6]).expect("no conflict");
        assert_eq!(faces.queries[0].map(|s| s.winding), Some(1));
        assert_eq!(faces.queries[1].map(|s| (s.winding, s.face)), Some((0, 0)));
        assert_eq!(faces.queries[2], None);
    }

    #[test]
    fn a_dangling_segment_separates_nothing() {
        let points = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [2.0, 2.0]];
        let all = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 4]];
        let directed = all.map(|[from, to]| Directed { from, to, weight: 0 });
        let faces = sweep(&points, &directed, &[]).expect("no conflict");
        assert_eq!(faces.left[4].face, faces.right[4].face);
        assert_ne!(faces.left[4].face, 0);
        assert_eq!(faces.left[0].face, faces.left[4].face);
    }
}
