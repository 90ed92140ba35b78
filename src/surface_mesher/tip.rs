//! Tips: poles that a patch closes around as a cone does. However short the edges, fewer than three of
//! their length go around near such a pole, so the triangles there are laid first: a fan of five from
//! the pole to a ring, which the front then starts from.

use super::growth::Source;
use super::outline::{Node, Outline, Piece, Rim};
use crate::surface::Side;
use crate::vector::{Vector, distance};

/// Triangles of a fan; around a flat pole there would be six.
const FAN: usize = 5;
/// Points that measure a ring.
const AROUND: u32 = 24;
/// Rings that bound the spacing; each is so much farther from the pole than the one before.
const RINGS: i32 = 60;
const FARTHER: f64 = 1.25;
/// No ring is nearer to the pole than this fraction of the spacing, times the slope of the tip.
const NEAREST: f64 = 0.5;

/// Parts that a patch is cut into across, to find where it is a narrow tube.
const HOOPS: u32 = 256;
/// Edges around a narrow tube: with fewer, what the front sees as flat is not.
const AROUND_TUBE: f64 = 8.0;

/// How much farther from the pole the ring is in its middle than on the seam.
const BULGE: f64 = 0.1;

/// The triangles at a tip, by vertices of the model.
pub(super) struct TipFan {
    pub(super) piece: u32,
    pub(super) corners: [u32; 3],
}

/// Spacings around tips and narrow tubes: a fifth of the way around.
pub(super) fn sources(outline: &Outline, spacing: f64) -> Vec<Source> {
    let whole = outline.pieces.iter().filter(|piece| !piece.has_outline);
    let mut sources = Vec::new();
    for piece in whole {
        sources.extend(Side::ALL.map(|side| rings(piece, side, spacing)).into_iter().flatten());
        sources.extend(
            [Side::South, Side::West].map(|side| hoops(piece, side, spacing)).into_iter().flatten(),
        );
    }
    sources
}

/// Whether the sides next to this one are the two sides of a seam.
fn closes_along(piece: &Piece, side: Side) -> bool {
    let beside = [1, 3].map(|k| &piece.sides[(side as usize + k) % 4]);
    matches!(beside.map(Vec::as_slice), [[a], [b]] if a.curve == b.curve)
}

/// Spacings of a patch that closes around and has no pole at either end, where fewer than five edges of
/// the spacing go around.
fn hoops(piece: &Piece, side: Side, spacing: f64) -> Vec<Source> {
    let ends = [side, Side::ALL[(side as usize + 2) % 4]];
    if !closes_along(piece, side) || ends.iter().any(|&end| piece.sides[end as usize].is_empty()) {
        return Vec::new();
    }
    let hoop = |k: u32| ring(|t| across(piece, side, f64::from(k) / f64::from(HOOPS), t));
    let wanted = |hoop: &[Vector]| length(hoop) / AROUND_TUBE;
    let narrow = (0..=HOOPS).map(hoop).filter(|hoop| wanted(hoop) < spacing);
    let sources = |hoop: Vec<Vector>| {
        let spacing = wanted(&hoop);
        hoop.into_iter().map(move |at| Source { at, spacing })
    };
    narrow.flat_map(sources).collect()
}

fn rings(piece: &Piece, side: Side, spacing: f64) -> Vec<Source> {
    if !piece.sides[side as usize].is_empty() || !closes_along(piece, side) {
        return Vec::new();
    }
    let mut sources = Vec::new();
    let tip = across(piece, side, 0.0, 0.0);
    for k in 0..RINGS {
        let ring = ring(|t| across(piece, side, libm::pow(FARTHER, f64::from(k - RINGS)), t));
        let (far, around) = (distance(ring[0], tip), length(&ring));
        let wanted = around / FAN as f64;
        if is_narrow(around, far) && far >= NEAREST * spacing * (wanted / far) && wanted < spacing {
            sources.extend(ring.into_iter().map(|at| Source { at, spacing: wanted }));
        }
    }
    sources
}

/// The point at a fraction of the way from a side to the one that it faces, and at one along it.
fn across(piece: &Piece, side: Side, s: f64, t: f64) -> Vector {
    let [[u0, u1], [v0, v1]] = piece.surface.domain();
    let mix = |a: f64, b: f64, t: f64| a + t * (b - a);
    let [u, v] = match side {
        Side::West => [mix(u0, u1, s), mix(v0, v1, t)],
        Side::East => [mix(u1, u0, s), mix(v0, v1, t)],
        Side::South => [mix(u0, u1, t), mix(v0, v1, s)],
        Side::North => [mix(u0, u1, t), mix(v1, v0, s)],
    };
    piece.surface.at(u, v)
}

fn ring(at: impl Fn(f64) -> Vector) -> Vec<Vector> {
    (0..=AROUND).map(|k| at(f64::from(k) / f64::from(AROUND))).collect()
}

fn length(points: &[Vector]) -> f64 {
    points.windows(2).map(|pair| distance(pair[0], pair[1])).sum()
}

/// Whether less goes around a pole than five times the way to it.
fn is_narrow(around: f64, far: f64) -> bool {
    around < FAN as f64 * far
}

/// Puts rings in the place of tips, and gives the triangles between.
pub(super) fn fans(outline: &mut Outline, rims: &mut [Rim]) -> Vec<TipFan> {
    let mut fans = Vec::new();
    for (i, rim) in rims.iter_mut().enumerate() {
        // A ring may shift the place of the next pole.
        for _ in 0..2 {
            let sides = rim.loops().next().map_or(0, |range| range.len());
            let tip = (0..sides).find_map(|k| tip_at(&outline.pieces[i], outline, rim, (k, sides)));
            let Some((k, nodes)) = tip else { break };
            let pole = rim.nodes[k].vertex;
            let [a, b] = [(k + sides - 1) % sides, (k + 2) % sides].map(|k| rim.nodes[k].vertex);
            let first = outline.points.len() as u32;
            let inner = |(j, [u, v]): (usize, [f64; 2])| Node { u, v, vertex: first + j as u32 };
            let new: Vec<Node> = nodes.iter().copied().enumerate().map(inner).collect();
            let surface = &outline.pieces[i].surface;
            let points: Vec<Vector> = new.iter().map(|node| surface.at(node.u, node.v)).collect();
            outline.points.extend(points);
            let ring: Vec<u32> =
                [a].into_iter().chain(new.iter().map(|node| node.vertex)).chain([b]).collect();
            let piece = i as u32;
            fans.extend(ring.windows(2).map(|e| TipFan { piece, corners: [e[1], e[0], pole] }));
            rim.replace_pair(k, new);
        }
    }
    fans
}

/// The places of the ring's inner nodes, if a tip lies between node `k` of the sides and the next.
fn tip_at(
    piece: &Piece,
    outline: &Outline,
    rim: &Rim,
    (k, sides): (usize, usize),
) -> Option<(usize, Vec<[f64; 2]>)> {
    let node = |j: usize| rim.nodes[(k + sides + j - 1) % sides];
    let [before, pole, other, after] = [0, 1, 2, 3].map(node);
    let is_closed = pole.vertex == other.vertex && before.vertex == after.vertex;
    // Beyond the ring something of the seam must be left for the front.
    let goes_on = sides > 6 && node(sides - 1).vertex == node(4).vertex;
    if !is_closed || before.vertex == pole.vertex || !goes_on {
        return None;
    }
    let mix = |a: f64, b: f64, t: f64| a + t * (b - a);
    // The ring bulges away from the pole, so that no edge goes straight from one end to the other.
    let at = |t: f64| {
        let out = 1.0 + 4.0 * BULGE * t * (1.0 - t);
        [
            mix(mix(pole.u, other.u, t), mix(before.u, after.u, t), out),
            mix(mix(pole.v, other.v, t), mix(before.v, after.v, t), out),
        ]
    };
    let ring = ring(|t| {
        let [u, v] = at(t);
        piece.surface.at(u, v)
    });
    let [tip, seam] = [pole, before].map(|node| outline.points[node.vertex as usize]);
    let is_tip = is_narrow(length(&ring), distance(tip, seam));
    let inner = (1..FAN).map(|j| at(j as f64 / FAN as f64)).collect();
    is_tip.then_some((k, inner))
}
