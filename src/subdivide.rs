//! Boundary points where the spacing jumps or a gap is narrow (`--split-boundary`, SPEC 18.4).
//!
//! A growth-limited field is made of the shorter of the edges at each boundary point and of the
//! distances across gaps, which the constrained Delaunay triangulation of the boundary knows; each
//! segment is cut into parts that follow the field, or a uniform bound where that is less, and then halved until no edge is more than
//! twice as long as a neighbour. Nothing is moved: new points lie on their segment, but for their
//! rounding, and only where the exact signs say that no other segment is in the way.

use crate::background::Background;
use crate::domain::validate::{Plc, PlcSegment};
use crate::point::Point2;
use crate::predicates::{Sign, orient2d};
use crate::refine::{SEGMENT_MIN, last_place};
use crate::size::{GrowthField, Source};
use crate::triangulation::{HalfEdgeId, VertexId};

/// How the boundary is split.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplitOptions {
    /// Largest slope of the length of boundary edges; more than [`SLOPE_MAX`] is taken for that.
    pub growth: f64,
    /// Parts follow this spacing where it is the smaller one; `None`: no such bound.
    pub spacing: Option<f64>,
    /// More new points than this are an error.
    pub points_max: usize,
    /// New coordinates are multiples of this power of two; `None`: any float.
    pub quantum: Option<f64>,
}

/// More new points than allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("splitting the boundary asks for more than {0} new points: raise --max-triangles")]
pub struct TooManyPoints(pub usize);

/// Edges of a field of this slope differ from their neighbours by less than a factor of two.
pub const SLOPE_MAX: f64 = 0.6;
/// No two neighbours on the boundary differ by more than this.
pub const RATIO_MAX: f64 = 2.0;
/// A gap asks for edges as short as this part of an edge beside it, but not for shorter ones.
const GAP_PARTS: f64 = 256.0;
/// Steps in a part when the field is integrated along a segment.
const STEPS: f64 = 8.0;
/// Parts are not shorter than as many units in the last place of the largest coordinate.
const LENGTH_MIN: f64 = 4096.0;

/// The domain with its boundary and constraints split; `background` is its triangulation.
///
/// Returns the domain and the number of new points, which follow the old ones. Pieces have the
/// marker of their segment and take its place in the order.
///
/// # Errors
/// [`TooManyPoints`].
///
/// # Complexity
/// O((n + m) log n) for n points and m new ones.
pub fn subdivide(
    plc: &Plc,
    background: &Background,
    options: SplitOptions,
) -> Result<(Plc, usize), TooManyPoints> {
    let field = GrowthField::new(&sources(background), options.growth.min(SLOPE_MAX));
    let mut splitter = Splitter::new(background, options);
    splitter.follow(&field)?;
    splitter.balance()?;
    Ok(splitter.split(plc))
}

/// A segment with the inside on one side or both.
struct Line {
    half_edge: HalfEdgeId,
    /// Index among the domain's segments.
    segment: usize,
    ends: [VertexId; 2],
    length: f64,
    /// Where it is cut: ascending places from its start (0) to its end (1), both included.
    places: Vec<f64>,
    /// Too short for nodes that rounding leaves on it.
    is_fixed: bool,
}

impl Line {
    /// Lengths of the first and the last part.
    fn end_parts(&self) -> [f64; 2] {
        let [first, second] = [self.places[0], self.places[1]];
        let [before, last] = [self.places.len() - 2, self.places.len() - 1].map(|i| self.places[i]);
        [(second - first) * self.length, (last - before) * self.length]
    }
}

struct Splitter<'a> {
    background: &'a Background,
    options: SplitOptions,
    lines: Vec<Line>,
    length_min: f64,
    /// New points so far.
    count: usize,
}

impl<'a> Splitter<'a> {
    fn new(background: &'a Background, options: SplitOptions) -> Self {
        let points = &background.points;
        let unit = last_place(points, options.quantum);
        let mut lines: Vec<Line> = Vec::with_capacity(background.edges.len());
        for edge in &background.edges {
            let segment = edge.segment as usize;
            // The second side of a constraint follows the first.
            if lines.last().is_none_or(|line| line.segment != segment) {
                let [a, b] = edge.vertices.map(|v| points[v.index()]);
                let (half_edge, ends, length) = (edge.half_edge, edge.vertices, a.distance(b));
                let is_fixed = length < SEGMENT_MIN * unit;
                let places = vec![0.0, 1.0];
                lines.push(Line { half_edge, segment, ends, length, places, is_fixed });
            }
        }
        Self { background, options, lines, length_min: LENGTH_MIN * unit, count: 0 }
    }

    fn ends(&self, line: &Line) -> [Point2; 2] {
        line.ends.map(|v| self.background.points[v.index()])
    }

    fn admit(&mut self, more: usize) -> Result<(), TooManyPoints> {
        self.count += more;
        let limit = self.options.points_max;
        if self.count > limit { Err(TooManyPoints(limit)) } else { Ok(()) }
    }

    /// Cuts every line into parts that follow the field.
    fn follow(&mut self, field: &GrowthField) -> Result<(), TooManyPoints> {
        for i in 0..self.lines.len() {
            let line = &self.lines[i];
            if line.is_fixed {
                continue;
            }
            let left = (self.options.points_max - self.count) as f64;
            let [a, b] = self.ends(line);
            let bound = self.options.spacing.unwrap_or(f64::INFINITY);
            let spacing = |at| field.at(between(a, b, at)).min(bound).max(self.length_min);
            let table = integral(line.length, spacing, left)
                .ok_or(TooManyPoints(self.options.points_max))?;
            let places = spread(&table);
            self.admit(places.len() - 2)?;
            self.lines[i].places = places;
        }
        Ok(())
    }

    /// Halves parts until none is more than [`RATIO_MAX`] times as long as one beside it. A half is
    /// longer than that neighbour, so no part gets shorter than the shortest: it ends.
    fn balance(&mut self) -> Result<(), TooManyPoints> {
        let mut shortest = vec![f64::INFINITY; self.background.points.len()];
        let mut is_settled = false;
        while !is_settled {
            is_settled = true;
            for line in &self.lines {
                for (v, part) in line.ends.into_iter().zip(line.end_parts()) {
                    let entry = &mut shortest[v.index()];
                    *entry = entry.min(part);
                }
            }
            for i in 0..self.lines.len() {
                let line = &mut self.lines[i];
                if line.is_fixed {
                    continue;
                }
                let limits = line.ends.map(|v| RATIO_MAX * shortest[v.index()] / line.length);
                let before = line.places.len();
                halve(&mut line.places, limits, 2.0 * self.length_min / line.length);
                let more = line.places.len() - before;
                is_settled &= more == 0;
                self.admit(more)?;
            }
        }
        Ok(())
    }

    /// The domain with its segments cut.
    fn split(self, plc: &Plc) -> (Plc, usize) {
        let mut new = Plc { segments: Vec::new(), ..plc.clone() };
        let mut sorted: Vec<&Line> = self.lines.iter().collect();
        sorted.sort_by_key(|line| line.segment);
        let mut sorted = sorted.into_iter().peekable();
        for (i, segment) in plc.segments.iter().enumerate() {
            match sorted.next_if(|line| line.segment == i) {
                Some(line) => self.split_line(&mut new, *segment, line),
                None => new.segments.push(*segment),
            }
        }
        let count = new.points.len() - plc.points.len();
        (new, count)
    }

    /// Appends the points and the parts of a line; one part if rounding puts a point in the way of
    /// another segment.
    fn split_line(&self, new: &mut Plc, segment: PlcSegment, line: &Line) {
        let [a, b] = self.ends(line);
        let inner = &line.places[1..line.places.len() - 1];
        let points: Vec<Point2> = inner.iter().map(|&at| self.rounded(between(a, b, at))).collect();
        if !points.iter().all(|&p| self.is_beside(line, p)) {
            new.segments.push(segment);
            return;
        }
        let mut from = line.ends[0].0;
        let first = new.points.len() as u32;
        let ends = (first..first + points.len() as u32).chain([line.ends[1].0]);
        for to in ends {
            new.segments.push(PlcSegment { vertices: [from, to], ..segment });
            from = to;
        }
        if !new.point_markers.is_empty() {
            new.point_markers.extend(points.iter().map(|_| segment.marker));
        }
        new.points.extend(points);
    }

    fn rounded(&self, p: Point2) -> Point2 {
        self.options.quantum.map_or(p, |quantum| p.rounded_to(quantum))
    }

    /// Whether a point of a line lies strictly inside its own part of the plane: left of the other
    /// sides of the two triangles beside the line, and where such a side is a segment too, on the
    /// line's side of the median between the two. Those parts are convex and disjoint, so whatever
    /// was rounded, no two split lines cross.
    fn is_beside(&self, line: &Line, p: Point2) -> bool {
        let mesh = &self.background.triangulation;
        let sides = [Some(line.half_edge), mesh.twin(line.half_edge)].into_iter().flatten();
        let finite = sides.filter(|e| !mesh.is_ghost(e.triangle()));
        finite.into_iter().all(|e| self.is_within(e, p))
    }

    /// The same on one side.
    fn is_within(&self, e: HalfEdgeId, p: Point2) -> bool {
        let mesh = &self.background.triangulation;
        let [a, b, c] =
            [mesh.origin(e), mesh.dest(e), mesh.apex(e)].map(|v| self.background.points[v.index()]);
        let middle =
            |u: Point2, w: Point2| Point2::new(0.5 * u.x + 0.5 * w.x, 0.5 * u.y + 0.5 * w.y);
        let beside = |e, v, far, side| !mesh.is_constrained(e) || orient2d(v, far, p) == side;
        orient2d(b, c, p) == Sign::Positive
            && orient2d(c, a, p) == Sign::Positive
            && beside(e.prev(), a, middle(b, c), Sign::Negative)
            && beside(e.next(), b, middle(c, a), Sign::Positive)
    }
}

/// The integral of 1 / spacing along a line of the given length: pairs of a place and the integral
/// up to it. `None` if it passes `limit`.
fn integral(length: f64, spacing: impl Fn(f64) -> f64, limit: f64) -> Option<Vec<(f64, f64)>> {
    let (mut at, mut sum) = (0.0, 0.0);
    let mut table = vec![(at, sum)];
    while at < 1.0 {
        let step = (spacing(at) / (STEPS * length)).max(f64::EPSILON);
        let next = if at + 1.5 * step < 1.0 { at + step } else { 1.0 };
        sum += (next - at) * length / spacing(0.5 * (at + next));
        at = next;
        table.push((at, sum));
        if sum > limit + 2.0 {
            return None;
        }
    }
    Some(table)
}

/// Places that cut a line into parts of equal integrals of about one.
fn spread(table: &[(f64, f64)]) -> Vec<f64> {
    let (_, sum) = table[table.len() - 1];
    // A quarter more than the field allows is better than two parts of five eighths.
    let parts = libm::ceil(sum - 0.25).max(1.0) as usize;
    let mut places = vec![0.0];
    let mut row = 1;
    for part in 1..parts {
        let wanted = sum * part as f64 / parts as f64;
        while table[row].1 < wanted {
            row += 1;
        }
        let ((from, below), (to, above)) = (table[row - 1], table[row]);
        places.push(from + (to - from) * ((wanted - below) / (above - below)));
    }
    places.push(1.0);
    places
}

/// Halves parts that are longer than allowed beside their neighbours; `limits` are those of the
/// first and the last part. Parts below `length_min` stay.
fn halve(places: &mut Vec<f64>, limits: [f64; 2], length_min: f64) {
    let mut i = 0;
    while i + 1 < places.len() {
        let part = |k: usize| places[k + 1] - places[k];
        let before = if i == 0 { limits[0] } else { RATIO_MAX * part(i - 1) };
        let after = if i + 2 == places.len() { limits[1] } else { RATIO_MAX * part(i + 1) };
        let limit = before.min(after) * (1.0 + 1e-9);
        if part(i) > limit && part(i) > length_min {
            places.insert(i + 1, places[i] + 0.5 * part(i));
            // The part before may now be too long beside it.
            i = i.saturating_sub(1);
        } else {
            i += 1;
        }
    }
}

fn between(a: Point2, b: Point2, at: f64) -> Point2 {
    let (near, far, at) = if at <= 0.5 { (a, b, at) } else { (b, a, 1.0 - at) };
    Point2::new(near.x + at * (far.x - near.x), near.y + at * (far.y - near.y))
}

/// What the field grows from: the shorter edge at each boundary point, and gaps.
fn sources(background: &Background) -> Vec<Source> {
    let mut sources = Vec::new();
    let stars = Stars::new(background);
    for (i, &at) in background.points.iter().enumerate() {
        let lengths = stars.of(VertexId(i as u32)).map(|(_, length)| length);
        let shortest = lengths.fold(f64::INFINITY, f64::min);
        if shortest.is_finite() {
            sources.push(Source { at, spacing: shortest });
        }
    }
    let mesh = &background.triangulation;
    for t in mesh.triangles().filter(|&t| background.is_inside(t)) {
        for e in t.half_edges() {
            let is_once = mesh.twin(e).is_none_or(|f| e < f);
            if mesh.is_constrained(e) {
                gap_beside(background, &stars, e, &mut sources);
            } else if is_once {
                gap_along(background, &stars, e, &mut sources);
            }
        }
    }
    // Ties between sources go to the first: their order must not be the input's.
    sources.sort_by(|s, t| s.at.lexicographic(t.at).then_with(|| s.spacing.total_cmp(&t.spacing)));
    sources
}

/// The gap between a boundary edge and the vertex that sees it, if no edge joins the two.
fn gap_beside(background: &Background, stars: &Stars, e: HalfEdgeId, sources: &mut Vec<Source>) {
    let mesh = &background.triangulation;
    let ends = [mesh.origin(e), mesh.dest(e)];
    let apex = mesh.apex(e);
    if ends.iter().any(|&v| stars.are_joined(v, apex)) {
        return;
    }
    let [a, b, c] = [ends[0], ends[1], apex].map(|v| background.points[v.index()]);
    let (dx, dy) = (b.x - a.x, b.y - a.y);
    let square = dx * dx + dy * dy;
    let at = ((c.x - a.x) * dx + (c.y - a.y) * dy) / square;
    let foot = between(a, b, at.clamp(0.0, 1.0));
    let gap = foot.distance(c);
    let floor = |length: f64| gap.max(length / GAP_PARTS);
    if gap.is_finite() {
        sources.push(Source { at: foot, spacing: floor(square.sqrt()) });
        sources.push(Source { at: c, spacing: floor(stars.shortest(apex)) });
    }
}

/// The gap between two vertices that see each other, if neither an edge nor two join them.
fn gap_along(background: &Background, stars: &Stars, e: HalfEdgeId, sources: &mut Vec<Source>) {
    let mesh = &background.triangulation;
    let ends = [mesh.origin(e), mesh.dest(e)];
    let [u, w] = ends;
    if stars.are_joined(u, w) || stars.of(u).any(|(v, _)| stars.are_joined(v, w)) {
        return;
    }
    let [p, q] = ends.map(|v| background.points[v.index()]);
    for (v, at) in ends.into_iter().zip([p, q]) {
        let floor = stars.shortest(v) / GAP_PARTS;
        sources.push(Source { at, spacing: p.distance(q).max(floor) });
    }
}

/// The boundary edges and constraints at each vertex.
struct Stars {
    first: Vec<u32>,
    list: Vec<(VertexId, f64)>,
}

impl Stars {
    fn new(background: &Background) -> Self {
        let points = &background.points;
        let mut ends: Vec<(u32, VertexId, f64)> = Vec::new();
        for edge in background.edges.iter().filter(|e| !e.interior || e.vertices[0] < e.vertices[1])
        {
            let [a, b] = edge.vertices;
            let length = points[a.index()].distance(points[b.index()]);
            ends.extend([(a.0, b, length), (b.0, a, length)]);
        }
        ends.sort_unstable_by_key(|&(v, other, _)| (v, other));
        let mut first = vec![0_u32; points.len() + 1];
        for &(v, ..) in &ends {
            first[v as usize + 1] += 1;
        }
        for v in 0..points.len() {
            first[v + 1] += first[v];
        }
        Self { first, list: ends.into_iter().map(|(_, other, length)| (other, length)).collect() }
    }

    fn of(&self, v: VertexId) -> impl Iterator<Item = (VertexId, f64)> + '_ {
        let range = self.first[v.index()] as usize..self.first[v.index() + 1] as usize;
        self.list[range].iter().copied()
    }

    fn shortest(&self, v: VertexId) -> f64 {
        let shortest = self.of(v).map(|(_, length)| length).fold(f64::INFINITY, f64::min);
        // An isolated point asks for no more than it has.
        if shortest.is_finite() { shortest } else { 0.0 }
    }

    fn are_joined(&self, u: VertexId, w: VertexId) -> bool {
        self.of(u).any(|(v, _)| v == w)
    }
}
