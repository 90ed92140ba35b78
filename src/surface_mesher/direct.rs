//! The method direct-surface: the front advances in space, and what it lays is brought back to the
//! surface; nothing is triangulated in (u, v).

mod foot;
mod front;
mod near;
mod tangent;

use super::lift::Weld;
use super::outline::{Node, Rim};
use super::{Plan, SurfaceMeshError, SurfaceMeshed};
use crate::front::FrontError;
use crate::mesher::{Observer, Options, Stage};
use crate::metric::FirstForm;
use crate::model::Model;
use crate::size::Prediction;
use crate::skin::{Foot, Ground, Passes, Rank, Skin, linked};
use crate::surface::Surface;
use crate::triangulation::VertexId;
use crate::vector::{Vector, dot};
use front::{Laid, Over, SpaceFront, Stuck};
use std::collections::{BTreeMap, BTreeSet};

/// Parameters of the new vertices of a patch.
type Places = BTreeMap<u32, [f64; 2]>;

/// Samples in each direction of a patch for the prediction.
const SAMPLES: u32 = 40;
/// The backstop over the prediction.
const BACKSTOP: f64 = 3.0;

impl Plan {
    /// Meshes all patches by fronts in space.
    pub(super) fn direct(
        &self,
        model: &Model,
        rims: &[Rim],
        options: &Options,
        observer: &mut dyn Observer,
    ) -> Result<SurfaceMeshed, SurfaceMeshError> {
        if let Some(piece) = self.outline.pieces.iter().find(|piece| !piece.loops.is_empty()) {
            let name = model.patches[piece.patch].name.clone();
            let reason = "the front in space takes whole patches only".to_owned();
            return Err(SurfaceMeshError::Trim { name, reason });
        }
        observer.stage(Stage::Size);
        let limit = options.triangles_max;
        let predicted: Vec<f64> = (0..rims.len()).map(|i| self.predicted(i)).collect();
        let triangles = predicted.iter().sum::<f64>();
        if triangles > limit as f64 {
            return Err(SurfaceMeshError::TooMany { predicted: triangles, stopped: false, limit });
        }
        let prediction = Prediction { triangles, stopped: false };
        if !observer.predicted(prediction) {
            return Err(FrontError::Stopped.into());
        }
        observer.stage(Stage::Front);
        let mut weld = Weld::new(&self.outline);
        let mut meshed = self.nothing_yet(prediction);
        for (i, rim) in rims.iter().enumerate() {
            let name = &model.patches[self.outline.pieces[i].patch].name;
            let budget = (BACKSTOP * predicted[i]) as usize + 1000;
            let (laid, places) = self.lay(i, &rim.nodes, (&mut weld, budget), observer, name)?;
            meshed.front.inserted += places.len() as u64;
            meshed.front.accepted_existing += laid.len().saturating_sub(places.len()) as u64;
            let rounds = options.improve.sweeps;
            let (laid, passes) = self.improve(i, laid, &places, (&mut weld, rounds), name)?;
            meshed.improved[0] += passes.flips;
            meshed.improved[1] += passes.moves;
            let marker = model.patches[self.outline.pieces[i].patch].marker;
            laid.into_iter().for_each(|corners| weld.push(i as u32, marker, corners));
        }
        observer.stage(Stage::Collect);
        (meshed.mesh, _) = weld.finish(model, &self.outline, rims);
        Ok(meshed)
    }

    /// Triangles of a patch, from its area and the spacings on a lattice.
    fn predicted(&self, piece: usize) -> f64 {
        let chart = self.chart(piece);
        let surface = &self.outline.pieces[piece].surface;
        let [[u0, u1], [v0, v1]] = surface.domain();
        let step = |k: u32| (f64::from(k) + 0.5) / f64::from(SAMPLES);
        let cell = (u1 - u0) * (v1 - v0) / f64::from(SAMPLES * SAMPLES);
        let at = |k: u32| {
            let (u, v) = (u0 + step(k % SAMPLES) * (u1 - u0), v0 + step(k / SAMPLES) * (v1 - v0));
            let tangents = surface.tangents(u, v);
            let h = chart.spacing_at(chart.sheet.scaled(u, v), tangents.point);
            FirstForm::new(&tangents).area() * cell / (0.25 * 3.0_f64.sqrt() * h * h)
        };
        (0..SAMPLES * SAMPLES).map(at).sum()
    }

    /// The triangles of a patch and the parameters of its new vertices.
    fn lay(
        &self,
        piece: usize,
        nodes: &[Node],
        (weld, budget): (&mut Weld, usize),
        observer: &mut dyn Observer,
        name: &str,
    ) -> Result<(Vec<Laid>, Places), SurfaceMeshError> {
        let chart = self.chart(piece);
        let spacing = |p: Vector, [u, v]: [f64; 2]| chart.spacing_at(chart.sheet.scaled(u, v), p);
        let over = Over { surface: &self.outline.pieces[piece].surface, spacing: &spacing };
        let nodes: Vec<(u32, [f64; 2])> = nodes.iter().map(|n| (n.vertex, [n.u, n.v])).collect();
        let mut places = Places::new();
        let done = weld.mesh.triangles.len();
        let mut is_stopped = false;
        let mut progress = |n: usize| {
            is_stopped = !observer.progress(done + n);
            !is_stopped
        };
        let front = SpaceFront::new(over, &mut weld.mesh.points, &mut places, &nodes);
        let laid = front.advance(budget, &mut progress);
        match laid {
            Ok(laid) => Ok((laid, places)),
            Err(_) if is_stopped => Err(FrontError::Stopped.into()),
            Err(Stuck { at, edges }) => {
                Err(SurfaceMeshError::Stuck { name: name.to_owned(), at, edges })
            }
        }
    }

    /// Flips and moves on the surface; nodes of curves stay, and curves are not flipped.
    fn improve(
        &self,
        piece: usize,
        laid: Vec<Laid>,
        places: &Places,
        (weld, rounds): (&mut Weld, u32),
        name: &str,
    ) -> Result<(Vec<Laid>, Passes), SurfaceMeshError> {
        let used: BTreeSet<u32> = laid.iter().flatten().copied().collect();
        let global: Vec<u32> = used.into_iter().collect();
        let local: BTreeMap<u32, u32> = global.iter().copied().zip(0..).collect();
        let triangles: Vec<[u32; 3]> = laid.iter().map(|t| t.map(|v| local[&v])).collect();
        let points: Vec<Vector> = global.iter().map(|&v| weld.mesh.points[v as usize]).collect();
        let mut topology = linked(&triangles).map_err(|bad| SurfaceMeshError::Stuck {
            name: name.to_owned(),
            at: points[bad.vertices[0] as usize],
            edges: bad.count,
        })?;
        let curves = self.curve_edges();
        let edges: Vec<_> = topology.triangles().flat_map(|t| t.half_edges()).collect();
        for e in edges {
            let [a, b] = [topology.origin(e), topology.dest(e)].map(|v| global[v.index()]);
            if curves.contains(&[a.min(b), a.max(b)]) {
                topology.set_constrained(e, true);
            }
        }
        let rank = |v: &u32| if places.contains_key(v) { Rank::Free } else { Rank::Fixed };
        let ranks = global.iter().map(rank).collect();
        let ground = OnPatch { surface: &self.outline.pieces[piece].surface, plan: self };
        let mut skin = Skin::new(&ground, topology, points, ranks);
        for (i, v) in (0..).zip(&global) {
            if let Some(&place) = places.get(v) {
                skin.set_place(VertexId(i), place);
            }
        }
        let mut passes = Passes::default();
        skin.improve(rounds, &mut passes);
        for (&v, &p) in global.iter().zip(&skin.points) {
            weld.mesh.points[v as usize] = p;
        }
        let collected = skin.collect();
        let back = |t: &[u32; 3]| t.map(|v| global[v as usize]);
        Ok((collected.triangles.iter().map(back).collect(), passes))
    }

    /// Edges of the model's curves, by their lower and upper vertex.
    fn curve_edges(&self) -> BTreeSet<[u32; 2]> {
        let used = self.outline.curves.iter().filter(|shared| shared.uses > 0);
        let pairs = used.flat_map(|shared| shared.vertices.windows(2));
        pairs.map(|pair| [pair[0].min(pair[1]), pair[0].max(pair[1])]).collect()
    }
}

/// A patch as the ground of its triangles.
struct OnPatch<'a> {
    surface: &'a Surface,
    plan: &'a Plan,
}

impl Ground for OnPatch<'_> {
    type Place = [f64; 2];

    fn foot(
        &self,
        p: Vector,
        _region: u32,
        facing: Vector,
        from: Option<[f64; 2]>,
    ) -> Option<Foot<[f64; 2]>> {
        foot::foot(self.surface, p, from?).filter(|foot| dot(foot.normal, facing) > 0.0)
    }

    fn spacing(&self, p: Vector) -> f64 {
        self.plan.field.at(p)
    }
}
