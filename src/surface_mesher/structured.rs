//! The methods transfinite and elliptic on the patches of a model: a structured grid in (u, v),
//! measured in space.

use super::lift::Weld;
use super::outline::{Node, Piece, Rim};
use super::{Plan, SurfaceMeshError};
use crate::curve::discretize::EDGES_MAX;
use crate::metric::FirstForm;
use crate::model::Model;
use crate::point::Point2;
use crate::structured::{
    Chart, Folded, Grid, GridMethod, GridStats, Relaxed, Sides, fractions, relax, transfinite,
};
use crate::surface::{Side, Surface};
use crate::vector::{Vector, distance, dot};

/// Why a patch has no structured grid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PatchGridError {
    /// The outline is not that of the four sides.
    #[error(
        "patch {name} has no structured grid: it is trimmed, and a grid needs a patch that ends in \
         the four sides of its (u, v); take another --method (rule W7)"
    )]
    Trimmed {
        /// The patch.
        name: String,
    },
    /// Opposite sides of different length.
    #[error(
        "patch {name} has {} and {} edges on its south and north sides, {} and {} on east and west: \
         opposite sides of a structured grid need equal numbers; give their curves a `count`",
        .counts[0], .counts[2], .counts[1], .counts[3]
    )]
    Counts {
        /// The patch.
        name: String,
        /// Edges of south, east, north, west.
        counts: [usize; 4],
    },
    /// Cells turned over.
    #[error(
        "the grid of patch {name} folds: {count} of its cells have no diagonal with both triangles \
         counterclockwise in (u, v), the first in column {column} and row {row} near {at:?}"
    )]
    Folded {
        /// The patch.
        name: String,
        /// How many.
        count: usize,
        /// Column of the first, from 0.
        column: usize,
        /// Row of the first, from 0.
        row: usize,
        /// A corner of it in space.
        at: Vector,
    },
}

/// A patch as a chart of its parameters.
struct OnSurface<'a>(&'a Surface);

impl Chart for OnSurface<'_> {
    fn form(&self, p: Point2) -> FirstForm {
        FirstForm::new(&self.0.tangents(p.x, p.y))
    }

    fn beltrami(&self, p: Point2) -> [f64; 2] {
        let jet = self.0.jet(p.x, p.y);
        let (xu, xv) = (jet.tangents.u, jet.tangents.v);
        let FirstForm { e, f, g } = FirstForm::new(&jet.tangents);
        let [eu, ev] = [2.0 * dot(xu, jet.uu), 2.0 * dot(xu, jet.uv)];
        let [gu, gv] = [2.0 * dot(xv, jet.uv), 2.0 * dot(xv, jet.vv)];
        let [fu, fv] = [dot(jet.uu, xv) + dot(xu, jet.uv), dot(jet.uv, xv) + dot(xu, jet.vv)];
        let square = e * g - f * f;
        // W_u / W and W_v / W of the unit of area W.
        let turn = |eu: f64, fu: f64, gu: f64| (eu * g + e * gu - 2.0 * f * fu) / (2.0 * square);
        let (wu, wv) = (turn(eu, fu, gu), turn(ev, fv, gv));
        let both = [gu - fv - (g * wu - f * wv), ev - fu - (e * wv - f * wu)];
        both.map(|x| if square > 0.0 { x / square } else { 0.0 })
    }
}

/// A patch between its four sides, ready to be gridded.
pub(super) struct Quarters<'a> {
    piece: usize,
    surface: &'a Surface,
    name: &'a str,
    marker: i32,
    /// A pole has the nodes of the side that it faces, all of one vertex.
    sides: Sides<Node>,
    /// By [`Side::ALL`]: which sides are poles.
    poles: [bool; 4],
}

/// A triangle at a pole: the cell there has no fourth corner.
pub(super) struct Fan {
    pub(super) piece: u32,
    pub(super) marker: i32,
    pub(super) corners: [u32; 3],
}

impl<'a> Quarters<'a> {
    /// All patches of a plan, with their four sides.
    pub(super) fn all(
        plan: &'a Plan,
        model: &'a Model,
        rims: &[Rim],
    ) -> Result<Vec<Self>, PatchGridError> {
        let pieces = plan.outline.pieces.iter().enumerate().zip(rims);
        pieces.map(|((i, piece), rim)| Self::new((i, piece), model, (plan, &rim.nodes))).collect()
    }

    fn new(
        (index, piece): (usize, &'a Piece),
        model: &'a Model,
        (plan, nodes): (&Plan, &[Node]),
    ) -> Result<Self, PatchGridError> {
        let patch = &model.patches[piece.patch];
        let name = || patch.name.clone();
        if !piece.loops.is_empty() {
            return Err(PatchGridError::Trimmed { name: name() });
        }
        let corners = corners(&piece.surface, nodes);
        let corners = corners.ok_or_else(|| PatchGridError::Trimmed { name: name() })?;
        let mut sides = Sides::of_loop(nodes, corners);
        let poles = Side::ALL.map(|side| piece.sides[side as usize].is_empty());
        let points = &plan.outline.points;
        spread_poles(&mut sides, poles, |west, east| between(&piece.surface, points, (west, east)));
        let counts = sides.counts();
        if counts[0] != counts[2] || counts[1] != counts[3] {
            return Err(PatchGridError::Counts { name: name(), counts });
        }
        let (surface, marker) = (&piece.surface, patch.marker);
        Ok(Self { piece: index, surface, name: &patch.name, marker, sides, poles })
    }

    /// Triangles of the grid.
    pub(super) fn triangles(&self) -> usize {
        let [columns, rows, ..] = self.sides.counts();
        let at_poles = self.poles.iter().zip([columns, rows, columns, rows]);
        let fewer: usize = at_poles.filter(|(pole, _)| **pole).map(|(_, edges)| edges).sum();
        (2 * columns * rows).saturating_sub(fewer)
    }

    /// Lays the grid and welds it to the rest; the triangles at poles are handed back.
    pub(super) fn lay(
        &self,
        method: GridMethod,
        weld: &mut Weld,
        fans: &mut Vec<Fan>,
    ) -> Result<GridStats, SurfaceMeshError> {
        let at = |node: Node| weld.mesh.points[node.vertex as usize];
        let along = self.fractions(at);
        let mut grid = transfinite(&self.sides.map(|n| Point2::new(n.u, n.v)), &along);
        let relaxed = (method == GridMethod::Elliptic).then(|| self.relax(&mut grid));
        let new: Vec<Vector> = grid.points.iter().map(|p| self.surface.at(p.x, p.y)).collect();
        let space = grid.with_sides(&self.sides.map(at), &new);
        let triangles =
            grid.triangles(&space).map_err(|folded| self.folded(folded, &grid, &space))?;
        let numbers = self.number(&grid, &space, weld);
        for (&v, place) in numbers.iter().zip(&grid.points) {
            weld.place(v, [place.x, place.y]);
        }
        for pair in triangles.chunks_exact(2) {
            let cell = [pair[0], pair[1]].map(|corners| corners.map(|v| numbers[v as usize]));
            let (piece, marker) = (self.piece as u32, self.marker);
            match (is_triangle(cell[0]), is_triangle(cell[1])) {
                (true, true) => cell.into_iter().for_each(|t| weld.push(piece, marker, t)),
                (false, false) => return Err(self.coarse(cell[0], weld)),
                (first, _) => {
                    let (kept, left_out) = if first { (0, 1) } else { (1, 0) };
                    if !self.is_at_pole(&grid, pair[left_out]) {
                        return Err(self.coarse(cell[left_out], weld));
                    }
                    fans.push(Fan { piece, marker, corners: cell[kept] });
                }
            }
        }
        Ok(GridStats { columns: grid.columns, rows: grid.rows, relaxed })
    }

    /// Fractions of arc length; a pole takes those of the side that it faces.
    fn fractions(&self, at: impl Fn(Node) -> Vector) -> Sides<f64> {
        let of = |side: &[Node]| fractions(side, |a, b| distance(at(a), at(b)));
        let Sides { south, east, north, west } = &self.sides;
        let mut along =
            Sides { south: of(south), east: of(east), north: of(north), west: of(west) };
        let [s, e, n, w] = self.poles;
        match (s, n) {
            (true, false) => along.south.clone_from(&along.north),
            (false, true) => along.north.clone_from(&along.south),
            _ => {}
        }
        match (w, e) {
            (true, false) => along.west.clone_from(&along.east),
            (false, true) => along.east.clone_from(&along.west),
            _ => {}
        }
        along
    }

    /// Smooths the grid but for the cells at poles: no harmonic function tells a point of a boundary
    /// from the rest, and rows would crowd there without end.
    fn relax(&self, grid: &mut Grid) -> Relaxed {
        let [south, east, north, west] = self.poles.map(usize::from);
        let (columns, rows) = ([west, grid.columns - east], [south, grid.rows - north]);
        if columns[0] >= columns[1] || rows[0] >= rows[1] {
            return Relaxed::default();
        }
        let mut inner = grid.part(columns, rows);
        let relaxed = relax(&mut inner, &OnSurface(self.surface));
        grid.put([columns[0], rows[0]], &inner);
        relaxed
    }

    /// Whether two of three corners lie on one side that is a pole.
    fn is_at_pole(&self, grid: &Grid, corners: [u32; 3]) -> bool {
        let (width, places) = (grid.columns + 1, corners.map(|v| v as usize));
        let on: [&dyn Fn(usize) -> bool; 4] = [
            &|v| v / width == 0,
            &|v| v % width == grid.columns,
            &|v| v / width == grid.rows,
            &|v| v % width == 0,
        ];
        let both = |on: &dyn Fn(usize) -> bool| places.iter().filter(|v| on(**v)).count() >= 2;
        self.poles.iter().zip(on).any(|(&pole, on)| pole && both(on))
    }

    fn coarse(&self, [a, b, c]: [u32; 3], weld: &Weld) -> SurfaceMeshError {
        let at = weld.mesh.points[if a == b { a } else { c } as usize];
        SurfaceMeshError::Coarse { name: self.name.to_owned(), at }
    }

    /// The model's vertex of each grid point; inner ones are new.
    fn number(&self, grid: &Grid, space: &[Vector], weld: &mut Weld) -> Vec<u32> {
        let known = grid.with_sides(&self.sides.map(|n| n.vertex), &vec![u32::MAX; space.len()]);
        let mut new = |at: Vector| {
            weld.mesh.points.push(at);
            weld.mesh.points.len() as u32 - 1
        };
        let number = |(v, &at): (u32, &Vector)| if v == u32::MAX { new(at) } else { v };
        known.into_iter().zip(space).map(number).collect()
    }

    fn folded(&self, folded: Folded, grid: &Grid, space: &[Vector]) -> PatchGridError {
        let Folded { count, column, row } = folded;
        let at = space[grid.cell(column, row)[0]];
        PatchGridError::Folded { name: self.name.to_owned(), count, column, row, at }
    }
}

/// Whether three vertices are different.
fn is_triangle([a, b, c]: [u32; 3]) -> bool {
    a != b && b != c && c != a
}

/// Gives poles, of which the outline has the two corners alone, as many nodes as the sides that they
/// face; where both are poles, as `edges` says for the two sides between them.
fn spread_poles(
    sides: &mut Sides<Node>,
    [south, east, north, west]: [bool; 4],
    edges: impl Fn(&[Node], &[Node]) -> usize,
) {
    if south && north {
        let count = edges(&sides.west, &sides.east);
        (sides.south, sides.north) = (evenly(&sides.south, count), evenly(&sides.north, count));
    } else if south {
        sides.south = facing(&sides.south, &sides.north);
    } else if north {
        sides.north = facing(&sides.north, &sides.south);
    }
    if west && east {
        let count = edges(&sides.south, &sides.north);
        (sides.west, sides.east) = (evenly(&sides.west, count), evenly(&sides.east, count));
    } else if west {
        sides.west = facing(&sides.west, &sides.east);
    } else if east {
        sides.east = facing(&sides.east, &sides.west);
    }
}

/// A pole cut at equal steps of its parameter.
fn evenly(pole: &[Node], count: usize) -> Vec<Node> {
    let (first, last) = (pole[0], pole[pole.len() - 1]);
    let node = |k: usize| {
        let mix = |a: f64, b: f64| a + k as f64 / count as f64 * (b - a);
        Node { u: mix(first.u, last.u), v: mix(first.v, last.v), vertex: first.vertex }
    };
    let inner = (1..count).map(node);
    [first].into_iter().chain(inner).chain([last]).collect()
}

/// A pole cut where the side is that it faces: along that side one parameter stays as it is.
fn facing(pole: &[Node], side: &[Node]) -> Vec<Node> {
    let (first, last) = (pole[0], pole[pole.len() - 1]);
    let node = |n: &Node| match first.u == last.u {
        true => Node { u: first.u, v: n.v, vertex: first.vertex },
        false => Node { u: n.u, v: first.v, vertex: first.vertex },
    };
    let inner = side[1..side.len() - 1].iter().map(node);
    [first].into_iter().chain(inner).chain([last]).collect()
}

/// Points along a line between two sides.
const ACROSS: u32 = 64;

/// Edges of the longest of the lines that join the nodes of two sides, each measured in edges of the
/// sides there; at least three.
fn between(surface: &Surface, points: &[Vector], (from, to): (&[Node], &[Node])) -> usize {
    let at = |n: &Node| points[n.vertex as usize];
    let mut most: f64 = 3.0;
    for i in 1..from.len().min(to.len()).saturating_sub(1) {
        let (a, b) = (from[i], to[i]);
        let place = |k: u32| {
            let t = f64::from(k) / f64::from(ACROSS);
            surface.at(a.u + t * (b.u - a.u), a.v + t * (b.v - a.v))
        };
        let length: f64 = (0..ACROSS).map(|k| distance(place(k), place(k + 1))).sum();
        let edge = |side: &[Node]| distance(at(&side[i - 1]), at(&side[i + 1])) / 2.0;
        most = most.max(length / (0.5 * (edge(from) + edge(to))));
    }
    if most < EDGES_MAX as f64 { libm::round(most) as usize } else { EDGES_MAX }
}

/// Positions of the corners of (u, v) among the nodes, if all nodes lie on the four sides.
fn corners(surface: &Surface, nodes: &[Node]) -> Option<[usize; 4]> {
    let [[u0, u1], [v0, v1]] = surface.domain();
    let on_side = |n: &Node| n.u == u0 || n.u == u1 || n.v == v0 || n.v == v1;
    let find = |u: f64, v: f64| nodes.iter().position(|n| n.u == u && n.v == v);
    let corners = [find(u0, v0)?, find(u1, v0)?, find(u1, v1)?, find(u0, v1)?];
    nodes.iter().all(on_side).then_some(corners)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::Curve;
    use crate::surface::{Revolution, Tensor};

    /// Differences of the surface's own metric.
    fn by_differences(surface: &Surface, p: Point2) -> [f64; 2] {
        let h = 1e-5;
        let flux = |u: f64, v: f64| {
            let form = FirstForm::new(&surface.tangents(u, v));
            let w = form.area();
            [form.g / w, form.f / w, form.e / w]
        };
        let [east, west] = [flux(p.x + h, p.y), flux(p.x - h, p.y)];
        let [north, south] = [flux(p.x, p.y + h), flux(p.x, p.y - h)];
        let du = |k: usize| (east[k] - west[k]) / (2.0 * h);
        let dv = |k: usize| (north[k] - south[k]) / (2.0 * h);
        let w = FirstForm::new(&surface.tangents(p.x, p.y)).area();
        [(du(0) - dv(1)) / w, (dv(2) - du(1)) / w]
    }

    // spec: W7
    #[test]
    fn the_laplacian_of_the_parameters_is_that_of_the_metric() {
        let rows = vec![
            vec![[0.0, 0.0, 0.0], [0.2, 1.0, 1.0], [0.0, 2.0, 0.0]],
            vec![[1.0, 0.1, 0.5], [1.1, 1.3, 1.0], [1.0, 2.2, -0.5]],
            vec![[2.5, 0.0, 0.0], [2.0, 1.0, -1.0], [3.0, 2.0, 0.3]],
        ];
        let bent = Surface::Tensor(Tensor::bezier(&rows).expect("a patch"));
        let profile = Curve::arc([0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]).expect("ok");
        let sphere = Revolution::new(profile, [0.0; 3], [0.0, 0.0, 1.0], [0.0, 360.0]);
        let sphere = Surface::Revolution(sphere.expect("a sphere"));
        for surface in [bent, sphere] {
            let [[u0, u1], [v0, v1]] = surface.domain();
            for (s, t) in [(0.3, 0.4), (0.45, 0.71), (0.62, 0.2)] {
                let p = Point2::new(u0 + s * (u1 - u0), v0 + t * (v1 - v0));
                let (found, expected) =
                    (OnSurface(&surface).beltrami(p), by_differences(&surface, p));
                for k in 0..2 {
                    let scale = 1.0 + expected[k].abs();
                    assert!(
                        (found[k] - expected[k]).abs() < 1e-5 * scale,
                        "{found:?} {expected:?}"
                    );
                }
            }
        }
    }
}
