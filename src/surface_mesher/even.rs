//! Equal numbers of edges on opposite sides of patches, for structured grids.

use super::SurfaceMeshError;
use super::outline::{Outline, Piece, root};
use crate::curve::CurveJet;
use crate::curve::discretize::by_count_and_spacing;
use crate::surface::Side;

/// The sides of a patch that face each other.
const OPPOSITE: [[Side; 2]; 2] = [[Side::South, Side::North], [Side::West, Side::East]];

impl Outline {
    /// Gives curves that face each other across patches, through any number of them, the number of
    /// edges of the one that has most. Where some of them have a rule of their own, that decides: the
    /// others take the most of theirs.
    pub(super) fn even(
        &mut self,
        spacing: &impl Fn(&CurveJet) -> f64,
    ) -> Result<(), SurfaceMeshError> {
        let class = self.classes();
        let mut wanted = vec![(false, 0); self.curves.len()];
        for (i, shared) in self.curves.iter().enumerate().filter(|(_, s)| s.uses > 0) {
            let most = &mut wanted[root(&class, i as u32) as usize];
            *most = (*most).max((shared.has_rule, shared.nodes.len() - 1));
        }
        for (i, shared) in self.curves.iter_mut().enumerate() {
            let (_, count) = wanted[root(&class, i as u32) as usize];
            if shared.uses == 0 || shared.has_rule || shared.nodes.len() == count + 1 {
                continue;
            }
            shared.nodes = by_count_and_spacing(&shared.curve, count, |jet, _| spacing(jet))
                .map_err(|error| SurfaceMeshError::Curve { name: shared.name.clone(), error })?;
        }
        Ok(())
    }

    /// For each curve one that must have as many edges; itself for one of each class.
    fn classes(&self) -> Vec<u32> {
        let mut same: Vec<u32> = (0..self.curves.len() as u32).collect();
        for [a, b] in self.pieces.iter().flat_map(facing) {
            let (a, b) = (root(&same, a as u32), root(&same, b as u32));
            same[a.max(b) as usize] = a.min(b);
        }
        same
    }
}

/// Pairs of curves that face each other across a piece: where opposite sides have as many.
fn facing(piece: &Piece) -> Vec<[usize; 2]> {
    let mut pairs = Vec::new();
    for [a, b] in OPPOSITE.map(|sides| sides.map(|side| &piece.sides[side as usize])) {
        if a.len() == b.len() {
            pairs.extend(a.iter().zip(b).map(|(a, b)| [a.curve, b.curve]));
        }
    }
    pairs
}
