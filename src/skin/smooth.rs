//! Moves of free vertices on the surface.

use super::fold::{is_kept, shape};
use super::{Foot, Ground, Rank, Skin};
use crate::triangulation::{HalfEdgeId, VertexId};
use crate::vector::{Vector, add, along, cross, distance, dot, norm, scale, sub, unit};

/// Fractions of the way to the wanted place that are tried.
const STEPS: [f64; 3] = [1.0, 0.5, 0.2];
/// A move below this fraction of the spacing is none.
const STILL: f64 = 1e-3;
/// Even sweeps leave no triangle worse than this, unless it was worse before.
const SHAPE_MIN: f64 = 0.2;

impl<G: Ground> Skin<'_, G> {
    /// Moves every free vertex towards the mean of its neighbours; returns the number of moves.
    pub(super) fn even_out(&mut self) -> u64 {
        let mut moves = 0;
        for v in (0..self.points.len() as u32).map(VertexId) {
            if self.is_movable(v) {
                let wanted = self.mean_place(v);
                moves += u64::from(self.move_towards(v, wanted, |before, after| {
                    after.worst >= SHAPE_MIN.min(before.worst)
                }));
            }
        }
        moves
    }

    /// Moves free vertices where that makes the shapes around them better.
    pub(super) fn polish(&mut self) -> u64 {
        let mut moves = 0;
        for v in (0..self.points.len() as u32).map(VertexId) {
            if self.is_movable(v) && self.awake[v.index()] {
                let is_better = |before: Worth, after: Worth| after.sum < before.sum;
                let ideal = self.ideal_place(v);
                let moved = self.move_towards(v, ideal, is_better) || {
                    let mean = self.mean_place(v);
                    self.move_towards(v, mean, is_better)
                };
                self.awake[v.index()] = moved;
                moves += u64::from(moved);
            }
        }
        moves
    }

    fn is_movable(&self, v: VertexId) -> bool {
        self.is_there(v.index()) && self.ranks[v.index()] == Rank::Free
    }

    /// The mean of the neighbours; those that want shorter edges around them count more.
    fn mean_place(&self, v: VertexId) -> Vector {
        let mut sum = [0.0; 3];
        let mut weights = 0.0;
        for e in self.mesh.star(self.out(v)) {
            let x = self.mesh.dest(e);
            let weight = 1.0 / self.spacing[x.index()];
            sum = along(sum, weight, self.at(x));
            weights += weight;
        }
        scale(1.0 / weights, sum)
    }

    /// The mean of the apexes of equilateral triangles on the edges opposite.
    fn ideal_place(&self, v: VertexId) -> Vector {
        let height = 0.5 * 3.0_f64.sqrt();
        let normal = self.normal_at(v);
        let mut sum = [0.0; 3];
        let mut count = 0.0;
        for e in self.mesh.star(self.out(v)) {
            let [x, y] = [self.mesh.dest(e), self.mesh.apex(e)].map(|w| self.at(w));
            let middle = scale(0.5, add(x, y));
            let inwards = cross(normal, sub(y, x));
            sum = add(sum, along(middle, height, inwards));
            count += 1.0;
        }
        scale(1.0 / count, sum)
    }

    /// Moves a vertex some of the way, along the surface, if the new star is sound and accepted.
    fn move_towards(
        &mut self,
        v: VertexId,
        wanted: Vector,
        is_accepted: impl Fn(Worth, Worth) -> bool,
    ) -> bool {
        let old = self.at(v);
        let normal = self.normal_at(v);
        let step = sub(wanted, old);
        let step = along(step, -dot(step, normal), normal);
        if norm(step) < STILL * self.spacing[v.index()] {
            return false;
        }
        let star: Vec<HalfEdgeId> = self.mesh.star(self.out(v)).collect();
        let before = self.worth(&star, old);
        let region = self.mesh.tag(star[0].triangle());
        for by in STEPS {
            let place = self.places[v.index()];
            let foot = self.ground.foot(along(old, by, step), region, normal, place);
            let Some(Foot { point, place, .. }) = foot else { continue };
            if distance(point, old) > 2.0 * norm(step) {
                continue;
            }
            let after = self.worth(&star, point);
            if after.is_sound && is_accepted(before, after) {
                self.points[v.index()] = point;
                self.places[v.index()] = Some(place);
                self.spacing[v.index()] = self.ground.spacing(point);
                for e in star {
                    self.awake[self.mesh.dest(e).index()] = true;
                    self.awake[self.mesh.apex(e).index()] = true;
                }
                return true;
            }
        }
        false
    }

    /// What a star is worth with its centre at `at`.
    fn worth(&self, star: &[HalfEdgeId], at: Vector) -> Worth {
        let mut worth = Worth { sum: 0.0, worst: 1.0, is_sound: true };
        for &e in star {
            let corners = [at, self.at(self.mesh.dest(e)), self.at(self.mesh.apex(e))];
            let quality = shape(corners);
            worth.sum += 1.0 / (quality * quality).max(1e-9);
            worth.worst = worth.worst.min(quality);
            if let Some(facing) = unit(self.normal(e.triangle())) {
                worth.is_sound &= is_kept(corners, facing);
            }
        }
        worth
    }
}

/// What the triangles around a vertex are worth.
#[derive(Clone, Copy)]
struct Worth {
    /// Sum of the squared inverse shapes: less is better.
    sum: f64,
    /// The worst shape.
    worst: f64,
    is_sound: bool,
}
