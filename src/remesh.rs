//! Remeshing: a triangulated surface anew, with edges of a wanted length, its features kept
//! (SPEC 19.2).
//!
//! ```text
//! mesh -> manifold input -> features -> curves cut anew -> split, collapse, flip, move -> mesh
//!         or an error       corners                        on the input as ground
//! ```

mod deviation;
mod feature;
mod input;
mod sizing;
mod tree;

pub use deviation::Deviation;

use crate::mesh::{MarkedEdge, MeshData};
use crate::skin::{Collected, Effort, Foot, Ground, Passes, Rank, Skin};
use crate::surface_mesher::growth::SpaceField;
use crate::triangulation::VertexId;
use crate::vector::{Vector, along, cross, dot, norm, sub};
use feature::{AT_VERTEX, Chain, Cut, Features};
use input::Input;
use std::collections::BTreeMap;
use tree::{Corners, Tree};

/// What is asked of a remeshing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RemeshOptions {
    /// Wanted edge length, in the unit of the mesh.
    pub spacing: f64,
    /// An edge across which the surface turns by more than this is a feature, in degrees.
    pub feature_angle_deg: f64,
    /// Largest slope of the wanted edge length.
    pub growth: f64,
    /// Edges are shorter where the surface bends: so that triangles leave it by less than this.
    pub chord_error: Option<f64>,
    /// Refuse, before any work, to make more triangles than about this.
    pub triangles_max: usize,
    /// How often what is done.
    pub effort: Effort,
}

impl RemeshOptions {
    /// The usual options with a wanted edge length.
    #[must_use]
    pub fn new(spacing: f64) -> Self {
        Self {
            spacing,
            feature_angle_deg: 40.0,
            growth: 0.25,
            chord_error: None,
            triangles_max: 20_000_000,
            effort: Effort::default(),
        }
    }
}

/// A remeshed surface and how it came about.
#[derive(Clone, Debug, PartialEq)]
pub struct Remeshed {
    /// The mesh, with the regions of the input and the marked edges of its features.
    pub mesh: MeshData,
    /// Feature curves.
    pub curves: usize,
    /// Corners of the features: kept to the bit.
    pub corners: usize,
    /// Smooth parts between the features.
    pub parts: usize,
    /// What was done.
    pub passes: Passes,
    /// How far the two surfaces are from each other.
    pub deviation: Deviation,
    /// Diagonal of the box around the input.
    pub diagonal: f64,
}

/// Why a surface is not remeshed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RemeshError {
    /// No triangles.
    #[error("the mesh has no triangle")]
    Empty,
    /// A reference to nothing.
    #[error("triangle {triangle} names point {value}, which does not exist")]
    BadReference {
        /// Index of the triangle.
        triangle: u32,
        /// What the file says.
        value: i64,
    },
    /// A coordinate that is no number.
    #[error("point {point} at {at:?} is not finite")]
    NotFinite {
        /// Index of the point.
        point: u32,
        /// Where.
        at: Vector,
    },
    /// A triangle with two equal corners.
    #[error("triangle {triangle} has two equal corners at {at:?}")]
    Collapsed {
        /// Index of the triangle.
        triangle: u32,
        /// Where.
        at: Vector,
    },
    /// An edge of more than two triangles.
    #[error("{count} triangles share the edge from {from:?} to {to:?}; a surface has at most two")]
    Crowded {
        /// How many.
        count: usize,
        /// One end.
        from: Vector,
        /// The other end.
        to: Vector,
    },
    /// Neighbours that face different sides.
    #[error("the two triangles at the edge from {from:?} to {to:?} face different sides")]
    Orientation {
        /// One end.
        from: Vector,
        /// The other end.
        to: Vector,
    },
    /// Two fans at a vertex.
    #[error("parts of the surface hang together by the vertex at {at:?} only")]
    Pinch {
        /// Where.
        at: Vector,
    },
    /// An option out of its range.
    #[error("{name} is {value}, but must be {rule}")]
    Option {
        /// As the command line names it.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is allowed.
        rule: &'static str,
    },
    /// The prediction is above the limit.
    #[error(
        "the spacing asks for about {predicted:.0} triangles, above the limit of {limit}: raise \
         --max-triangles, or take a larger --spacing"
    )]
    TooMany {
        /// Predicted number of triangles.
        predicted: f64,
        /// The limit.
        limit: usize,
    },
    /// The backstop.
    #[error(transparent)]
    Budget(#[from] crate::skin::TooManyVertices),
}

/// Remeshes a surface. Its topology stays: closed stays closed, the Euler number is the same.
/// That the result does not cross itself is for [`check`](crate::check) to say.
///
/// # Errors
/// [`RemeshError`]: what is no manifold surface, options out of range, too many triangles.
///
/// # Complexity
/// O((n + m) log n) for n triangles in and m out, times the rounds of the effort; at a vertex of the
/// input with k neighbours O(k^2) more.
pub fn remesh(mesh: &MeshData, options: &RemeshOptions) -> Result<Remeshed, RemeshError> {
    options.check()?;
    let mut input = Input::new(mesh)?;
    let Features { chains, corners, ranks } = feature::find(&mut input, options.feature_angle_deg);
    let part = input::parts(&input.mesh);
    let parts = part.iter().max().map_or(0, |last| *last as usize + 1);
    let field = sizing::field(&input, options.spacing, options.growth, options.chord_error);
    let predicted = predict(&input, &field);
    if predicted > options.triangles_max as f64 {
        return Err(RemeshError::TooMany { predicted, limit: options.triangles_max });
    }
    let ground = Facets::new(&input, &part, field);
    let mut topology = input.mesh.clone();
    let triangles: Vec<_> = topology.triangles().collect();
    triangles.iter().for_each(|&t| topology.set_tag(t, part[t.index()]));
    let mut skin = Skin::new(&ground, topology, input.points.clone(), ranks);
    for (v, t) in first_triangles(&input).into_iter().enumerate() {
        skin.set_place(VertexId(v as u32), t);
    }
    let limit = options.triangles_max;
    let cuts = feature::cuts(&input, &chains, &|p| ground.spacing(p), limit);
    let cuts = cuts.map_err(|predicted| RemeshError::TooMany { predicted, limit })?;
    let owners = cut_chains(&mut skin, &chains, &cuts);
    // A triangle mesh has half as many vertices as triangles; the backstop is four times that.
    let vertices_max = skin.points.len() + (2.0 * predicted) as usize + 1000;
    let passes = skin.remesh(options.effort, vertices_max)?;
    let collected = skin.collect();
    let deviation = {
        let corners = Corners { points: &collected.points, triangles: &collected.triangles };
        deviation::measure((&ground.tree, ground.corners()), corners)
    };
    let (curves, diagonal) = (chains.len(), input.diagonal());
    let mesh = assemble(&input, collected, &part, (&chains, &owners));
    Ok(Remeshed { mesh, curves, corners, parts, passes, deviation, diagonal })
}

impl RemeshOptions {
    fn check(&self) -> Result<(), RemeshError> {
        let demand = |name, value: f64, holds: bool, rule| {
            if holds { Ok(()) } else { Err(RemeshError::Option { name, value, rule }) }
        };
        let is_length = |x: f64| x > 0.0 && x.is_finite();
        demand("spacing", self.spacing, is_length(self.spacing), "positive and finite")?;
        let angle = self.feature_angle_deg;
        let in_range = (0.0..=180.0).contains(&angle);
        demand("feature-angle", angle, in_range, "from 0 to 180 degrees")?;
        demand("growth", self.growth, (0.0..=10.0).contains(&self.growth), "from 0 to 10")?;
        let error = self.chord_error.unwrap_or(1.0);
        demand("chord-error", error, is_length(error), "positive and finite")
    }
}

/// Triangles of the wanted size that fit the input's area.
fn predict(input: &Input, field: &SpaceField) -> f64 {
    let wanted = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| input.points[v as usize]);
        let centre = std::array::from_fn(|k| (a[k] + b[k] + c[k]) / 3.0);
        let h = field.at(centre);
        let area = 0.5 * norm(cross(sub(b, a), sub(c, a)));
        area / (0.25 * 3.0_f64.sqrt() * h * h)
    };
    input.triangles.iter().map(wanted).sum()
}

/// A triangle at each vertex.
fn first_triangles(input: &Input) -> Vec<u32> {
    let mut first = vec![u32::MAX; input.points.len()];
    for (t, corners) in (0..).zip(&input.triangles) {
        for &v in corners {
            first[v as usize] = first[v as usize].min(t);
        }
    }
    first
}

/// The input as the ground of the new triangles.
struct Facets<'a> {
    input: &'a Input,
    /// Smooth part of each triangle.
    part: &'a [u32],
    tree: Tree,
    field: SpaceField,
}

impl<'a> Facets<'a> {
    fn new(input: &'a Input, part: &'a [u32], field: SpaceField) -> Self {
        let corners = Corners { points: &input.points, triangles: &input.triangles };
        Self { input, part, tree: Tree::new(corners), field }
    }

    fn corners(&self) -> Corners<'_> {
        Corners { points: &self.input.points, triangles: &self.input.triangles }
    }
}

impl Ground for Facets<'_> {
    /// A triangle of the input.
    type Place = u32;

    /// The nearest point of the part's triangles that face the same half of space.
    fn foot(&self, p: Vector, region: u32, facing: Vector, from: Option<u32>) -> Option<Foot<u32>> {
        let is_wanted = |t: u32| {
            self.part[t as usize] == region && dot(self.input.normals[t as usize], facing) > 0.0
        };
        let seed = from.filter(|&t| is_wanted(t));
        let nearest = self.tree.nearest(self.corners(), p, seed, is_wanted)?;
        let normal = self.input.normals[nearest.triangle as usize];
        Some(Foot { point: nearest.point, normal, place: nearest.triangle })
    }

    fn spacing(&self, p: Vector) -> f64 {
        self.field.at(p)
    }
}

/// Puts the new nodes on the chains; gives the chain of each vertex inside one.
fn cut_chains(
    skin: &mut Skin<'_, Facets<'_>>,
    chains: &[Chain],
    cuts: &[Vec<Cut>],
) -> BTreeMap<u32, u32> {
    let mut owners = BTreeMap::new();
    for (i, (chain, cuts)) in (0_u32..).zip(chains.iter().zip(cuts)) {
        let inner = &chain.vertices[1..chain.vertices.len() - 1];
        owners.extend(inner.iter().map(|&v| (v, i)));
        // The last vertex on the way to the end of the edge that is being cut.
        let (mut edge, mut last) = (usize::MAX, 0);
        for cut in cuts {
            let [a, b] = [chain.vertices[cut.edge], chain.vertices[cut.edge + 1]];
            if cut.edge != edge {
                (edge, last) = (cut.edge, a);
            }
            let near = [(a, cut.at), (b, 1.0 - cut.at)];
            if let Some(&(v, _)) = near.iter().find(|(_, away)| *away < AT_VERTEX) {
                skin.ranks[v as usize] = Rank::Fixed;
                continue;
            }
            let [from, to] = [a, b].map(|v| skin.points[v as usize]);
            let at = along(from, cut.at, sub(to, from));
            let out = skin.out(VertexId(last));
            let e = feature::between(&skin.mesh, out, VertexId(b)).expect("an edge of the chain");
            let new = skin.split(e, at, Rank::Fixed).0;
            owners.insert(new, i);
            last = new;
        }
    }
    owners
}

/// Vertices that triangles use, minus edges, plus triangles.
#[must_use]
pub fn euler_number(triangles: &[[u32; 3]]) -> i64 {
    let mut vertices: Vec<u32> = triangles.iter().flatten().copied().collect();
    let sides = |t: &[u32; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
    let mut edges: Vec<[u32; 2]> =
        triangles.iter().flat_map(sides).map(|[a, b]| [a.min(b), a.max(b)]).collect();
    vertices.sort_unstable();
    vertices.dedup();
    edges.sort_unstable();
    edges.dedup();
    vertices.len() as i64 - edges.len() as i64 + triangles.len() as i64
}

/// Plain arrays with the regions and markers of the input.
fn assemble(
    input: &Input,
    collected: Collected,
    part: &[u32],
    (chains, owners): (&[Chain], &BTreeMap<u32, u32>),
) -> MeshData {
    let mut marker_of_part = BTreeMap::new();
    for (t, &region) in input.regions.iter().enumerate() {
        marker_of_part.entry(part[t]).or_insert(region);
    }
    // An edge between two corners is a chain of its own: chains beside it have inner nodes.
    let mut direct = BTreeMap::new();
    for chain in chains {
        let (a, b) = (chain.vertices[0], chain.vertices[chain.vertices.len() - 1]);
        direct.entry([a.min(b), a.max(b)]).or_insert(chain.marker);
    }
    let marker = |[a, b]: [u32; 2]| {
        let owner = owners.get(&a).or_else(|| owners.get(&b));
        match owner {
            Some(&chain) => chains[chain as usize].marker,
            None => direct.get(&[a.min(b), a.max(b)]).copied().flatten(),
        }
    };
    let edge = |&vertices: &[u32; 2]| {
        let marker = marker(vertices.map(|v| collected.origin[v as usize]))?;
        Some(MarkedEdge { vertices, marker })
    };
    let mut edges: Vec<MarkedEdge> = collected.features.iter().filter_map(edge).collect();
    edges.sort_unstable_by_key(|e| (e.marker, e.vertices));
    let regions = match marker_of_part.is_empty() {
        true => Vec::new(),
        false => collected.tags.iter().map(|tag| marker_of_part[tag]).collect(),
    };
    let Collected { points, triangles, .. } = collected;
    MeshData { points, triangles, edges, regions, ..MeshData::default() }
}
