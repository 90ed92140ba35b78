//! Where loops run in the parameters of a surface that comes round or has poles.

use super::boundary::Ring;
use crate::vector::Vector;
use std::f64::consts::TAU;

/// Angles nearer than this (radians) are one.
pub(super) const SAME: f64 = 1e-6;

/// How a surface gives places to points. The first parameter runs along a profile, the second is an
/// angle about the axis, or a height.
pub(super) struct Places<'f> {
    /// The place of a point; its second number is not finite at a pole.
    pub(super) of: &'f dyn Fn(Vector) -> [f64; 2],
    /// After how much each parameter comes round.
    pub(super) periods: [Option<f64>; 2],
    /// Whether a pole of this first parameter is where the profile ends, and not where it starts.
    pub(super) is_end: &'f dyn Fn(f64) -> bool,
    /// Whether (u, v) is a mirror image of the surface seen from where its normal points.
    pub(super) is_mirrored: bool,
}

/// Where a loop runs: for each edge the places of its samples, in the direction of the loop.
pub(super) struct Path {
    pub(super) edges: Vec<Vec<[f64; 2]>>,
    /// How far it ends from where it starts.
    pub(super) winding: [f64; 2],
}

/// Points along an edge, in the direction of the loop, and the record of the edge.
pub(super) type Trail = (u64, Vec<Vector>);

impl Path {
    /// Follows a loop without jumps, but for those along a pole, where it turns with the surface at
    /// its left or right hand; `None` where a pole lies inside an edge.
    pub(super) fn along(places: &Places, ring: &Ring, trails: &[Trail]) -> Option<Self> {
        let mut edges: Vec<Vec<[f64; 2]>> = Vec::new();
        let mut last: Option<(u64, [f64; 2], bool)> = None;
        let mut first: Option<(u64, [f64; 2], bool)> = None;
        for (id, points) in trails {
            let (list, poles) = raw(places, points)?;
            first.get_or_insert((*id, list[0], poles[0]));
            let mut done: Vec<[f64; 2]> = Vec::new();
            for place in list {
                let placed = match (done.last(), last) {
                    (Some(&before), _) => places.nearby(place, before),
                    (None, Some((_, before, true))) if poles[0] => {
                        let back = last.is_some_and(|(other, ..)| other == *id);
                        places.around_pole(place, before, (ring.is_left, back))
                    }
                    (None, Some((_, before, _))) => places.nearby(place, before),
                    (None, None) => place,
                };
                done.push(placed);
            }
            last = Some((*id, *done.last()?, poles[1]));
            edges.push(done);
        }
        let ((first_id, start, starts_at_pole), (last_id, end, ends_at_pole)) = (first?, last?);
        let back = match starts_at_pole && ends_at_pole {
            true => places.around_pole(start, end, (ring.is_left, first_id == last_id)),
            false => end,
        };
        let winding = [back[0] - start[0], back[1] - start[1]];
        Some(Self { edges, winding })
    }

    /// From the least to the greatest of one of the numbers.
    pub(super) fn range(&self, i: usize) -> [f64; 2] {
        let all = self.edges.iter().flatten().map(|place| place[i]);
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    }

    /// Whether it ends where it starts.
    pub(super) fn is_closed(&self) -> bool {
        let [u, v] = self.range(0);
        self.winding[0].abs() <= SAME * (v - u).max(1.0) && self.winding[1].abs() <= SAME
    }

    /// Twice the area that it goes around.
    pub(super) fn area(&self) -> f64 {
        let places: Vec<[f64; 2]> = self.edges.iter().flatten().copied().collect();
        let next = places.iter().cycle().skip(1);
        places.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum()
    }
}

/// Places of the points of an edge, and whether its ends lie on poles; these take the second
/// parameter of their neighbours.
fn raw(places: &Places, points: &[Vector]) -> Option<(Vec<[f64; 2]>, [bool; 2])> {
    let mut list: Vec<[f64; 2]> = points.iter().map(|&p| (places.of)(p)).collect();
    let last = list.len().checked_sub(1).filter(|&last| last >= 2)?;
    let poles = [0, last].map(|i| list[i][1].is_nan());
    list[0][1] = if poles[0] { list[1][1] } else { list[0][1] };
    list[last][1] = if poles[1] { list[last - 1][1] } else { list[last][1] };
    list.iter().all(|place| place[1].is_finite()).then_some((list, poles))
}

impl Places<'_> {
    /// The place by full turns nearest to another.
    fn nearby(&self, place: [f64; 2], other: [f64; 2]) -> [f64; 2] {
        std::array::from_fn(|i| match self.periods[i] {
            Some(period) => place[i] + period * libm::round((other[i] - place[i]) / period),
            None => place[i],
        })
    }

    /// Where a loop leaves a pole that it has come to: the surface lies between the two edges, all
    /// around where they are one.
    fn around_pole(
        &self,
        place: [f64; 2],
        before: [f64; 2],
        (is_left, is_back): (bool, bool),
    ) -> [f64; 2] {
        let Some(period) = self.periods[1] else { return place };
        let mut turn = (place[1] - before[1]).rem_euclid(period);
        // With the surface at the left hand in (u, v), a loop runs down where u is least.
        let is_up = (self.is_end)(before[0]) == (is_left != self.is_mirrored);
        if !is_up {
            turn = (period - turn) % period;
        }
        if is_back && (turn <= SAME || turn >= period - SAME) {
            turn = period;
        }
        [place[0], before[1] + if is_up { turn } else { -turn }]
    }
}

/// The loop that bounds the surface from outside: as it has the surface at its left hand, its area is
/// positive, or negative where (u, v) is a mirror image.
pub(super) fn outline(places: &Places, paths: &[Path], loops: &[Ring]) -> Option<usize> {
    let outer = |i: &usize| {
        let is_positive = paths[*i].area() > 0.0;
        is_positive == (loops[*i].is_left != places.is_mirrored)
    };
    let areas = |&i: &usize, &j: &usize| paths[i].area().abs().total_cmp(&paths[j].area().abs());
    (0..paths.len()).filter(outer).max_by(areas)
}

/// Where the surface should come round: at the loop's first angle if it goes all around, opposite to its
/// middle otherwise, or beside it if it is a hole.
pub(super) fn beginning([low, high]: [f64; 2], is_hole: bool) -> f64 {
    let middle = 0.5 * (low + high);
    let is_full = high - low >= TAU - SAME;
    if is_full && !is_hole { low } else { middle - TAU / 2.0 }
}

/// A place on an end of the range where it is as near as angles are told apart.
pub(super) fn snapped(x: f64, end: f64) -> f64 {
    if x.abs() <= SAME {
        0.0
    } else if (x - end).abs() <= SAME {
        end
    } else {
        x
    }
}
